#include "sim/io/mesh_orient.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <utility>

namespace scree {
namespace {

/// One side of a triangle, filed under its two vertices in rising order.
struct Side {
  int low, high;  ///< vertices
  int face;
  bool rising;  ///< the face runs from low to high
};

/// All sides, those of one edge in a row and by face.
std::vector<Side> sorted_sides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      const int from = mesh.triangles[face][corner];
      const int to = mesh.triangles[face][(corner + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), static_cast<int>(face), from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.face, a.rising) < std::tie(b.low, b.high, b.face, b.rising);
  });
  return sides;
}

/// Calls visit(first side, number of sides) for every edge.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) {
      ++end;
    }
    visit(&sides[begin], static_cast<int>(end - begin));
    begin = end;
  }
}

/// The other face over an edge of exactly two faces.
struct Neighbour {
  int face = -1;
  bool agrees =
      false;  ///< runs along the edge in the opposite direction, as neighbours of one orientation do
};

/// Faces connected over edges of two faces.
struct Part {
  std::vector<int> faces;
  bool closed = true;  ///< no open, crowded or twisted edge
  double volume = 0;   ///< m^3, signed; of closed parts only
  Eigen::AlignedBox3d box;
};

void turn(std::array<int, 3>& triangle) {
  std::swap(triangle[1], triangle[2]);
}

/// Six times the volume is the sum of the triple products; taken from a corner of the part so that a mesh
/// far from its origin loses no digits.
double signed_volume(const TriangleMesh& mesh, const Part& part) {
  const Vec3 origin = part.box.min();
  double sum = 0;
  for (const int face : part.faces) {
    const auto& [a, b, c] = mesh.triangles[face];
    sum +=
        (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(Vec3(mesh.vertices[c] - origin)));
  }
  return sum / 6;
}

/// Winding number of a closed part about a point: 1 inside, 0 outside. Solid angles after Van Oosterom and
/// Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125.
double winding_number(const TriangleMesh& mesh, const Part& part, const Vec3& point) {
  double angle = 0;
  for (const int face : part.faces) {
    const Vec3 a = mesh.vertices[mesh.triangles[face][0]] - point;
    const Vec3 b = mesh.vertices[mesh.triangles[face][1]] - point;
    const Vec3 c = mesh.vertices[mesh.triangles[face][2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

/// Whether `inner` lies wholly inside `outer`, judged by at most about 64 of its vertices.
bool lies_inside(const TriangleMesh& mesh, const Part& inner, const Part& outer) {
  if (!outer.box.contains(inner.box)) return false;
  const std::size_t stride = inner.faces.size() / 64 + 1;
  for (std::size_t i = 0; i < inner.faces.size(); i += stride) {
    const Vec3& vertex = mesh.vertices[mesh.triangles[inner.faces[i]][0]];
    if (winding_number(mesh, outer, vertex) < 0.5) return false;
  }
  return true;
}

class Orienter {
 public:
  explicit Orienter(TriangleMesh& mesh)
      : mesh_(mesh),
        before_(mesh.triangles),
        neighbours_(mesh.triangles.size()),
        border_(mesh.triangles.size(), false) {}

  EdgeFindings run() {
    survey_edges();
    find_parts();
    turn_outwards();
    count_turned();
    return findings_;
  }

 private:
  void survey_edges() {
    int open_face = -1;
    for_each_edge(sorted_sides(mesh_), [&](const Side* side, int count) {
      if (count == 2) {
        const bool agrees = side[0].rising != side[1].rising;
        add_neighbour(side[0].face, {side[1].face, agrees});
        add_neighbour(side[1].face, {side[0].face, agrees});
        return;
      }
      for (int i = 0; i < count; ++i) border_[side[i].face] = true;
      if (count == 1) {
        ++findings_.open_edges;
        if (open_face < 0 || side->face < open_face) {
          open_face = side->face;
          findings_.first_open = {side->low, side->high};
        }
      } else if (findings_.crowded_edges++ == 0) {
        findings_.first_crowded = {side->low, side->high};
      }
    });
  }

  void add_neighbour(int face, Neighbour neighbour) {
    for (Neighbour& slot : neighbours_[face]) {
      if (slot.face < 0) {
        slot = neighbour;
        return;
      }
    }
  }

  void find_parts() {
    std::vector<std::int8_t> turned(mesh_.triangles.size(), -1);  // -1: not reached yet
    for (std::size_t seed = 0; seed < mesh_.triangles.size(); ++seed) {
      if (turned[seed] >= 0) continue;
      Part part;
      turned[seed] = 0;
      part.faces.push_back(static_cast<int>(seed));
      for (std::size_t next = 0; next < part.faces.size(); ++next) {
        const int face = part.faces[next];
        if (border_[face]) part.closed = false;
        for (const Neighbour& neighbour : neighbours_[face]) {
          if (neighbour.face < 0) continue;
          const std::int8_t wanted =
              neighbour.agrees ? turned[face] : static_cast<std::int8_t>(1 - turned[face]);
          if (turned[neighbour.face] < 0) {
            turned[neighbour.face] = wanted;
            part.faces.push_back(neighbour.face);
          } else if (turned[neighbour.face] != wanted) {
            part.closed = false;
          }
        }
      }
      finish_part(part, turned);
      parts_.push_back(std::move(part));
    }
    // After the flood, neighbours that still run the same way along their edge lie on a one-sided surface.
    for_each_edge(sorted_sides(mesh_), [&](const Side* side, int count) {
      if (count == 2 && side[0].rising == side[1].rising && findings_.twisted_edges++ == 0) {
        findings_.first_twisted = {side->low, side->high};
      }
    });
  }

  void finish_part(Part& part, const std::vector<std::int8_t>& turned) {
    const auto turned_count =
        std::count_if(part.faces.begin(), part.faces.end(), [&](int f) { return turned[f] == 1; });
    const std::int8_t minority = 2 * static_cast<std::size_t>(turned_count) > part.faces.size() ? 0 : 1;
    for (const int face : part.faces) {
      if (turned[face] == minority) turn(mesh_.triangles[face]);
      for (const int vertex : mesh_.triangles[face]) part.box.extend(mesh_.vertices[vertex]);
    }
    if (part.closed) part.volume = signed_volume(mesh_, part);
  }

  void turn_part(Part& part) {
    for (const int face : part.faces) turn(mesh_.triangles[face]);
    part.volume = -part.volume;
  }

  void turn_outwards() {
    double total = 0;
    for (const Part& part : parts_) total += part.volume;
    if (total < 0) {  // the whole file is inside out, hollows included
      for (Part& part : parts_) turn_part_if_closed(part);
    }
    for (Part& part : parts_) {
      if (!part.closed || part.volume >= 0) continue;
      const bool hollow = std::any_of(parts_.begin(), parts_.end(), [&](const Part& outer) {
        return outer.closed && outer.volume > -part.volume && lies_inside(mesh_, part, outer);
      });
      if (!hollow) turn_part(part);
    }
  }

  void turn_part_if_closed(Part& part) {
    if (part.closed) turn_part(part);
  }

  void count_turned() {
    for (const Part& part : parts_) {
      const auto count = std::count_if(part.faces.begin(), part.faces.end(),
                                       [&](int f) { return mesh_.triangles[f] != before_[f]; });
      if (static_cast<std::size_t>(count) == part.faces.size()) {
        ++findings_.turned_parts;
      } else {
        findings_.turned_faces += static_cast<int>(count);
      }
    }
  }

  TriangleMesh& mesh_;
  std::vector<std::array<int, 3>> before_;
  std::vector<std::array<Neighbour, 3>> neighbours_;
  std::vector<bool> border_;  ///< the face has an open or crowded edge
  std::vector<Part> parts_;
  EdgeFindings findings_;
};

}  // namespace

EdgeFindings orient_faces(TriangleMesh& mesh) {
  return Orienter(mesh).run();
}

bool update_closed(TriangleMesh& mesh) {
  mesh.closed = !mesh.triangles.empty();
  for_each_edge(sorted_sides(mesh), [&](const Side* side, int count) {
    if (count != 2 || side[0].rising == side[1].rising) mesh.closed = false;
  });
  return mesh.closed;
}

}  // namespace scree
