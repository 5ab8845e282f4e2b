#pragma once
// Four contacts side by side in vector registers: four doubles, or twice four floats.
//
// Vector types of the compiler (GCC, clang), so the same source runs everywhere: functions that use them
// are compiled for several instruction sets and the best is chosen when the program starts
// (SCREE_VECTORISED). Every lane does what one number would do, without fused operations, so the numbers are
// the same on all of them.
#include <cmath>

#include "sim/contact/quad.h"
#include "sim/material/vector.h"

/// Marks a function to be compiled for AVX-512, AVX2 and the base instruction set. All that it calls must be
/// inlined.
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
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
/// Two sets of four side by side, each in its half of a register.
typedef float TwinFloats __attribute__((vector_size(32)));
typedef int TwinMask __attribute__((vector_size(32)));

// The same words for one number and for several.
SCREE_INLINE double root(double a) {
  return std::sqrt(a);
}
SCREE_INLINE Lanes root(Lanes a) {
  Lanes r;
  for (int k = 0; k < kLanes; ++k) r[k] = __builtin_sqrt(a[k]);
  return r;
}
SCREE_INLINE TwinFloats root(TwinFloats a) {
  TwinFloats r;
  for (int k = 0; k < 2 * kLanes; ++k) r[k] = __builtin_sqrtf(a[k]);
  return r;
}
SCREE_INLINE double pick(bool which, double yes, double no) {
  return which ? yes : no;
}
SCREE_INLINE Lanes pick(LaneMask which, Lanes yes, Lanes no) {
  return which ? yes : no;
}
SCREE_INLINE TwinFloats pick(TwinMask which, TwinFloats yes, TwinFloats no) {
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

/// Several vectors side by side, with the few operations that the contact law needs.
template <class Real>
struct LaneVector {
  Real x_, y_, z_;
  SCREE_INLINE Real dot(const LaneVector& b) const { return x_ * b.x_ + y_ * b.y_ + z_ * b.z_; }
  SCREE_INLINE Real squaredNorm() const { return dot(*this); }
  SCREE_INLINE LaneVector cross(const LaneVector& b) const {
    return {y_ * b.z_ - z_ * b.y_, z_ * b.x_ - x_ * b.z_, x_ * b.y_ - y_ * b.x_};
  }
  SCREE_INLINE LaneVector operator+(const LaneVector& b) const { return {x_ + b.x_, y_ + b.y_, z_ + b.z_}; }
  SCREE_INLINE LaneVector operator-(const LaneVector& b) const { return {x_ - b.x_, y_ - b.y_, z_ - b.z_}; }
  SCREE_INLINE LaneVector operator*(Real b) const { return {x_ * b, y_ * b, z_ * b}; }
};
using LaneVec3 = LaneVector<Lanes>;

/// The vector type that goes with a number type, and back.
template <class Real>
struct VectorOf {
  using type = LaneVector<Real>;
};
template <>
struct VectorOf<double> {
  using type = Vec3;
};
template <class Vector>
struct RealOf {
  using type = double;
};
template <class Real>
struct RealOf<LaneVector<Real>> {
  using type = Real;
};

// Between single and double precision, and between halves and wholes.
SCREE_INLINE Lanes wide(LaneFloats v) {
  return __builtin_convertvector(v, Lanes);
}
SCREE_INLINE LaneFloats narrow(Lanes v) {
  return __builtin_convertvector(v, LaneFloats);
}
SCREE_INLINE LaneVector<LaneFloats> narrow(const LaneVec3& v) {
  return {narrow(v.x_), narrow(v.y_), narrow(v.z_)};
}
SCREE_INLINE TwinFloats twin(LaneFloats first, LaneFloats second) {
  return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7);
}
SCREE_INLINE LaneFloats first_half(TwinFloats v) {
  return __builtin_shufflevector(v, v, 0, 1, 2, 3);
}
SCREE_INLINE LaneFloats second_half(TwinFloats v) {
  return __builtin_shufflevector(v, v, 4, 5, 6, 7);
}
SCREE_INLINE LaneVec3 wide_first(const LaneVector<TwinFloats>& v) {
  return {wide(first_half(v.x_)), wide(first_half(v.y_)), wide(first_half(v.z_))};
}
SCREE_INLINE LaneVec3 wide_second(const LaneVector<TwinFloats>& v) {
  return {wide(second_half(v.x_)), wide(second_half(v.y_)), wide(second_half(v.z_))};
}

// Quads in memory and lanes in registers.
SCREE_INLINE Lanes load(const Quad& q) {
  Lanes v;
  __builtin_memcpy(&v, __builtin_assume_aligned(&q, sizeof(Quad)), sizeof v);
  return v;
}
SCREE_INLINE void store(Quad& q, Lanes v) {
  __builtin_memcpy(__builtin_assume_aligned(&q, sizeof(Quad)), &v, sizeof v);
}
/// Turns four quads into their x, y, z, w, or back; of twins both halves.
SCREE_INLINE void transpose(TwinFloats& a, TwinFloats& b, TwinFloats& c, TwinFloats& d) {
  const TwinFloats t0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
                   t1 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
                   t2 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
                   t3 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15);
}
SCREE_INLINE void transpose(LaneFloats& a, LaneFloats& b, LaneFloats& c, LaneFloats& d) {
  const LaneFloats t0 = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                   t1 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const LaneFloats t2 = __builtin_shufflevector(c, d, 0, 4, 1, 5),
                   t3 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  b = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  c = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  d = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}
SCREE_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes t0 = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Lanes t1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lanes t2 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes t3 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  b = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  c = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  d = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

}  // namespace scree
