#pragma once
// Triangulations of the same surfaces, coarse, fine, irregular and non-conforming.
#include <map>
#include <set>

#include "tests/verification/scene.h"

namespace scree::verification {

/// Collects triangles and welds their corners.
class MeshMaker {
 public:
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    mesh_.triangles.push_back({vertex(a), vertex(b), vertex(c)});
  }
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  /// Parallelogram at `corner`, spanned by u and v (u x v points outwards), cut into nu by nv cells.
  void patch(const Vec3& corner, const Vec3& u, const Vec3& v, int nu, int nv) {
    const auto at = [&](int i, int j) { return Vec3(corner + u * (double(i) / nu) + v * (double(j) / nv)); };
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j < nv; ++j) quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  TriangleMesh mesh() {
    update_closed(mesh_);
    return mesh_;
  }

 private:
  int vertex(const Vec3& p) {
    const std::array<long, 3> key{std::lround(p.x() * 1e9), std::lround(p.y() * 1e9),
                                  std::lround(p.z() * 1e9)};
    const auto [at, is_new] = numbers_.try_emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(p);
    return at->second;
  }
  TriangleMesh mesh_;
  std::map<std::array<long, 3>, int> numbers_;
};

/// The strip 0 <= x <= length, |y| <= width / 2, z = 0.
inline TriangleMesh coarse_strip(double length, double width) {
  MeshMaker m;
  m.patch({0, -0.5 * width, 0}, {length, 0, 0}, {0, width, 0}, 1, 1);
  return m.mesh();
}

inline TriangleMesh regular_strip(double length, double width, int nu, int nv) {
  MeshMaker m;
  m.patch({0, -0.5 * width, 0}, {length, 0, 0}, {0, width, 0}, nu, nv);
  return m.mesh();
}

/// Inner corners moved at random by up to 0.3 of a cell, diagonals at random.
inline TriangleMesh jittered_strip(double length, double width, int nu, int nv) {
  Random random(2, 0, RandomPurpose::positions);
  std::vector<Vec3> corner;
  for (int i = 0; i <= nu; ++i)
    for (int j = 0; j <= nv; ++j) {
      const bool inner = i > 0 && i < nu && j > 0 && j < nv;
      const double shift = inner ? 0.3 : 0.0;
      corner.emplace_back((i + random.uniform(-shift, shift)) * length / nu,
                          (j + random.uniform(-shift, shift)) * width / nv - 0.5 * width, 0.0);
    }
  MeshMaker m;
  const auto at = [&](int i, int j) { return corner[static_cast<std::size_t>(i * (nv + 1) + j)]; };
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      if (random.uniform() < 0.5)
        m.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      else
        m.quad(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), at(i, j));
    }
  return m.mesh();
}

/// Rows of triangles of different width side by side: corners of one row lie inside edges of the next
/// (T-junctions).
inline TriangleMesh mismatched_strip(double length, double width, int nu, int nv) {
  MeshMaker m;
  for (int j = 0; j < nv; ++j)
    m.patch({0, (double(j) / nv - 0.5) * width, 0}, {length, 0, 0}, {0, width / nv, 0}, nu + 3 * j, 1);
  return m.mesh();
}

/// Closed box under the same strip, its faces cut into cells.
inline TriangleMesh fine_box(double length, double width, double depth, int nu, int nv, int nz) {
  MeshMaker m;
  const Vec3 u(length, 0, 0), v(0, width, 0), w(0, 0, depth), low(0, -0.5 * width, -depth),
      high(length, 0.5 * width, 0);
  m.patch(low + w, u, v, nu, nv);       // top
  m.patch(low, v, u, nv, nu);           // bottom
  m.patch(low, u, w, nu, nz);           // y low
  m.patch(high - w, -u, w, nu, nz);     // y high
  m.patch(low, w, v, nz, nv);           // x low
  m.patch(high - w - v, v, w, nv, nz);  // x high
  return m.mesh();
}

/// Two rectangles that meet along the y axis at z = 0 and fall off on both sides, interior angle `angle`
/// (rad): a roof. Upwards is out.
inline TriangleMesh roof(double angle, double side, double width, int nu, int nv) {
  const double slope = 0.5 * (kPi - angle);
  const Vec3 left(-side * std::cos(slope), 0, -side * std::sin(slope)), along(0, width, 0);
  const Vec3 right(-left.x(), 0, left.z());
  MeshMaker m;
  m.patch(left - 0.5 * along, -left, along, nu, nv);
  m.patch(-0.5 * along, right, along, nu, nv);
  return m.mesh();
}

/// A floor (z = 0, x > 0) and a wall that rises from the y axis at `angle` (rad) to it: a concave corner.
inline TriangleMesh corner(double angle, double side, double width, int nu, int nv) {
  const Vec3 up(side * std::cos(angle), 0, side * std::sin(angle)), floor(side, 0, 0), along(0, width, 0);
  MeshMaker m;
  m.patch(-0.5 * along, floor, along, nu, nv);
  m.patch(up - 0.5 * along, -up, along, nu, nv);
  return m.mesh();
}

/// Mesh bodies for update_mesh_contacts alone, with every facet listed.
struct Surfaces {
  std::vector<std::unique_ptr<MeshBody>> bodies;
  std::vector<FacetRef> facets;
  std::vector<MeshContact> slots = std::vector<MeshContact>(kMeshContactSlots);

  explicit Surfaces(TriangleMesh mesh) {
    const int count = static_cast<int>(mesh.triangles.size());
    bodies.push_back(std::make_unique<MeshBody>(std::move(mesh), Surface{}, Motion::fixed(Pose{})));
    for (int f = 0; f < count; ++f) facets.push_back({0, f});
  }
  /// Contacts of a sphere there, with the memory of the call before.
  std::vector<MeshContact> touch(const Vec3& centre, double radius) {
    EXPECT_EQ(update_mesh_contacts(bodies, facets, centre, radius, slots).without_slot, 0);
    std::vector<MeshContact> contacts;
    for (const MeshContact& c : slots)
      if (c.body >= 0) contacts.push_back(c);
    return contacts;
  }
};

}  // namespace scree::verification
