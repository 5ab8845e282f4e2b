#pragma once
// Four contacts side by side in one vector register.
//
// Vector types of the compiler (GCC), so the same source runs everywhere: functions that use them
// are compiled for several instruction sets and the best is chosen when the program starts
// (SCREE_VECTORISED). Every lane does what one double would do, without fused operations, so the numbers are
// the same on all of them.
#include <cmath>

#include "sim/contact/quad.h"
#include "sim/material/vector.h"

/// Marks a function to be compiled for AVX-512, AVX2 and the base instruction set. All that it calls must be
/// inlined.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SCREE_VECTORISED __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define SCREE_VECTORISED
#endif
#define SCREE_INLINE [[gnu::always_inline]] inline

namespace scree {

inline constexpr int kLanes = 4;
typedef double Lanes __attribute__((vector_size(32)));
typedef long LaneMask __attribute__((vector_size(32)));
typedef float LaneFloats __attribute__((vector_size(16)));

// The same words for one double and for four.
SCREE_INLINE double root(double a) {
  return std::sqrt(a);
}
SCREE_INLINE Lanes root(Lanes a) {
  Lanes r;
  for (int k = 0; k < kLanes; ++k) r[k] = __builtin_sqrt(a[k]);
  return r;
}
SCREE_INLINE double pick(bool which, double yes, double no) {
  return which ? yes : no;
}
SCREE_INLINE Lanes pick(LaneMask which, Lanes yes, Lanes no) {
  return which ? yes : no;
}
/// Bit k: lane k is negative.
SCREE_INLINE unsigned signs(Lanes a) {
#if defined(__SSE2__)
  typedef double Half __attribute__((vector_size(16)));
  Half low, high;
  __builtin_memcpy(&low, &a, sizeof low);
  __builtin_memcpy(&high, reinterpret_cast<const char*>(&a) + sizeof low, sizeof high);
  return static_cast<unsigned>(__builtin_ia32_movmskpd(low)) |
         static_cast<unsigned>(__builtin_ia32_movmskpd(high)) << 2;
#else
  return (a[0] < 0 ? 1u : 0u) | (a[1] < 0 ? 2u : 0u) | (a[2] < 0 ? 4u : 0u) | (a[3] < 0 ? 8u : 0u);
#endif
}
template <class Real>
SCREE_INLINE Real smaller(Real a, Real b) {
  return pick(b < a, b, a);
}
template <class Real>
SCREE_INLINE Real larger(Real a, Real b) {
  return pick(a < b, b, a);
}
template <class Real>
SCREE_INLINE Real all_lanes(double a) {
  return Real{} + a;
}

/// Four vectors side by side, with the few operations that the contact law needs.
struct LaneVec3 {
  Lanes x_, y_, z_;
  SCREE_INLINE const Lanes& x() const { return x_; }
  SCREE_INLINE const Lanes& y() const { return y_; }
  SCREE_INLINE const Lanes& z() const { return z_; }
  SCREE_INLINE Lanes dot(const LaneVec3& b) const { return x_ * b.x_ + y_ * b.y_ + z_ * b.z_; }
  SCREE_INLINE Lanes squaredNorm() const { return dot(*this); }
  SCREE_INLINE LaneVec3 cross(const LaneVec3& b) const {
    return {y_ * b.z_ - z_ * b.y_, z_ * b.x_ - x_ * b.z_, x_ * b.y_ - y_ * b.x_};
  }
};
SCREE_INLINE LaneVec3 operator+(const LaneVec3& a, const LaneVec3& b) {
  return {a.x_ + b.x_, a.y_ + b.y_, a.z_ + b.z_};
}
SCREE_INLINE LaneVec3 operator-(const LaneVec3& a, const LaneVec3& b) {
  return {a.x_ - b.x_, a.y_ - b.y_, a.z_ - b.z_};
}
SCREE_INLINE LaneVec3 operator*(const LaneVec3& a, Lanes b) {
  return {a.x_ * b, a.y_ * b, a.z_ * b};
}
SCREE_INLINE LaneVec3 operator*(Lanes b, const LaneVec3& a) {
  return a * b;
}

/// The vector type that goes with a number type, and back.
template <class Real>
struct VectorOf {
  using type = Vec3;
};
template <>
struct VectorOf<Lanes> {
  using type = LaneVec3;
};
template <class Vector>
struct RealOf {
  using type = double;
};
template <>
struct RealOf<LaneVec3> {
  using type = Lanes;
};

// Quads in memory and lanes in registers.
SCREE_INLINE Lanes load(const Quad& q) {
  Lanes v;
  __builtin_memcpy(&v, __builtin_assume_aligned(&q, sizeof(Quad)), sizeof v);
  return v;
}
SCREE_INLINE void store(Quad& q, Lanes v) {
  __builtin_memcpy(__builtin_assume_aligned(&q, sizeof(Quad)), &v, sizeof v);
}
/// Turns four quads into their x, y, z, w, or back.
SCREE_INLINE void transpose(LaneFloats& a, LaneFloats& b, LaneFloats& c, LaneFloats& d) {
  typedef int Index __attribute__((vector_size(16)));
  const LaneFloats t0 = __builtin_shuffle(a, b, Index{0, 4, 1, 5}),
                   t1 = __builtin_shuffle(a, b, Index{2, 6, 3, 7});
  const LaneFloats t2 = __builtin_shuffle(c, d, Index{0, 4, 1, 5}),
                   t3 = __builtin_shuffle(c, d, Index{2, 6, 3, 7});
  a = __builtin_shuffle(t0, t2, Index{0, 1, 4, 5});
  b = __builtin_shuffle(t0, t2, Index{2, 3, 6, 7});
  c = __builtin_shuffle(t1, t3, Index{0, 1, 4, 5});
  d = __builtin_shuffle(t1, t3, Index{2, 3, 6, 7});
}
SCREE_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes t0 = __builtin_shuffle(a, b, LaneMask{0, 4, 2, 6});
  const Lanes t1 = __builtin_shuffle(a, b, LaneMask{1, 5, 3, 7});
  const Lanes t2 = __builtin_shuffle(c, d, LaneMask{0, 4, 2, 6});
  const Lanes t3 = __builtin_shuffle(c, d, LaneMask{1, 5, 3, 7});
  a = __builtin_shuffle(t0, t2, LaneMask{0, 1, 4, 5});
  b = __builtin_shuffle(t1, t3, LaneMask{0, 1, 4, 5});
  c = __builtin_shuffle(t0, t2, LaneMask{2, 3, 6, 7});
  d = __builtin_shuffle(t1, t3, LaneMask{2, 3, 6, 7});
}

}  // namespace scree
