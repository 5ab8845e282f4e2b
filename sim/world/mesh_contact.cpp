#include "sim/world/mesh_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {
namespace {

enum class Feature { face = 0, edge = 1, vertex = 2 };

struct ClosestPoint {
  Vec3 point;
  Feature feature;
};

// Closest point of a triangle to p, with the feature it lies on. Ericson, Real-Time Collision Detection
// (2005), 5.1.5.
ClosestPoint closest_point(const Vec3& p, const Facet& f) {
  const Vec3 ab = f.b - f.a, ac = f.c - f.a, ap = p - f.a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {f.a, Feature::vertex};
  const Vec3 bp = p - f.b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {f.b, Feature::vertex};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {f.a + ab * (d1 / (d1 - d3)), Feature::edge};
  const Vec3 cp = p - f.c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {f.c, Feature::vertex};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {f.a + ac * (d2 / (d2 - d6)), Feature::edge};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {f.b + (f.c - f.b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), Feature::edge};
  const double inverse = 1.0 / (va + vb + vc);
  return {f.a + ab * (vb * inverse) + ac * (vc * inverse), Feature::face};
}

struct Touch {
  Vec3 foot;    // on the surface, mesh frame
  Vec3 normal;  // towards the sphere, mesh frame
  double overlap;
  Feature feature;
  int facet;
};

constexpr double kSameContact = 0.5;  // cosine of the largest turn over which a contact goes on
constexpr double kSameSide = 0.7;     // cosine within which a remembered normal tells the side of a face
constexpr double kSamePlane =
    0.5;  // of the radius: distance within which a remembered plane is that of a face
constexpr double kBornDeep = 0.5;  // of the radius: overlap of a contact whose sphere comes out of a solid
constexpr double kPlaneTolerance = 1e-7;  // of the radius

double square(double x) {
  return x * x;
}

// A contact of the step before, mesh frame.
struct Remembered {
  Vec3 normal;
  double depth;  // how far the sphere reached behind the surface, m
};

// All features of one body that the sphere overlaps.
void collect(const MeshBody& body, std::span<const FacetRef> facets, const Vec3& centre, double radius,
             std::span<const Remembered> remembered, std::vector<Touch>& touches) {
  for (const FacetRef& ref : facets) {
    const Facet& f = body.facets()[ref.facet];
    const double height = (centre - f.a).dot(f.normal);
    if (height >= radius || !f.box_within(centre, radius)) continue;
    // +1: the contact began in front of the face, -1: behind, 0: none remembered. Another wall of the same
    // mesh may have the same normal, or the opposite one, but not at this distance from the centre.
    double side = 0, nearest = kSamePlane * radius;
    bool pressed_through = false;  // another face, that looks the other way
    for (const Remembered& r : remembered) {
      const double c = r.normal.dot(f.normal);
      if (std::abs(c) <= kSameSide) continue;
      if (c < 0 && r.depth > radius) pressed_through = true;
      const double sign = c > 0 ? 1.0 : -1.0, off = std::abs(sign * height - (radius - r.depth));
      if (off < nearest) nearest = off, side = sign;
    }
    if (height <= -radius && side == 0) continue;
    const ClosestPoint closest = closest_point(centre, f);
    const Vec3 away = centre - closest.point;
    const double aside2 =
        away.squaredNorm() -
        height * height;  // a foot on the rim, straight below the centre, is one of the face
    if (closest.feature == Feature::face || aside2 <= square(kPlaneTolerance * radius)) {
      if (body.mesh().closed) {
        if (side <= 0 && (height < 0 || pressed_through)) continue;
        side = 1.0;
      } else if (side == 0) {
        side = height >= 0 ? 1.0 : -1.0;
      }
      const double overlap = radius - side * height;
      if (overlap > 0) touches.push_back({closest.point, side * f.normal, overlap, Feature::face, ref.facet});
      continue;
    }
    if (body.mesh().closed && height < 0)
      continue;  // the neighbour in front of which the centre lies has this feature too
    const double distance = away.norm();
    if (distance >= radius || distance == 0) continue;
    touches.push_back({closest.point, away / distance, radius - distance, closest.feature, ref.facet});
  }
}

bool hidden(const Touch& touch, const Touch& by, double radius) {
  const double ahead = (touch.foot - by.foot).dot(by.normal);
  if (touch.feature == Feature::face)  // a second face in the same plane, overlapping or on the seam
    return std::abs(ahead) <= kPlaneTolerance * radius && touch.normal.dot(by.normal) > 1 - 1e-9;
  return ahead <= kPlaneTolerance * radius;
}

}  // namespace

MeshContactChanges update_mesh_contacts(const std::vector<std::unique_ptr<MeshBody>>& bodies,
                                        std::span<const FacetRef> facets, const Vec3& centre, double radius,
                                        std::span<MeshContact> slots) {
  thread_local std::vector<Touch> touches, accepted;
  std::array<bool, kMeshContactSlots> goes_on{};
  int known = 0;  // contacts of the step before
  while (known < static_cast<int>(slots.size()) && slots[known].body >= 0) ++known;
  struct Fresh {
    int body;
    Vec3 normal;
    double overlap, excess;
  };
  std::array<Fresh, kMeshContactSlots> fresh;
  MeshContactChanges changes;
  int fresh_count = 0;

  for (std::size_t first = 0; first < facets.size();) {
    const int b = facets[first].body;
    std::size_t last = first;
    while (last < facets.size() && facets[last].body == b) ++last;
    const MeshBody& body = *bodies[b];
    const Pose& pose = body.state().pose;
    const bool turned = pose.rotation.w() != 1.0;  // most bodies are not
    std::array<Remembered, kMeshContactSlots> remembered;
    std::size_t remembered_count = 0;
    for (int k = 0; k < known; ++k)
      if (slots[k].body == b)
        remembered[remembered_count++] = {
            turned ? Vec3(pose.rotation.conjugate() * slots[k].normal) : slots[k].normal,
            slots[k].overlap + slots[k].excess};

    touches.clear();
    accepted.clear();
    collect(body, facets.subspan(first, last - first),
            turned ? pose.to_local(centre) : Vec3(centre - pose.position), radius,
            std::span(remembered.data(), remembered_count), touches);
    first = last;
    if (touches.empty()) continue;
    if (touches.size() > 1)
      std::sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& c) {
        if (a.feature != c.feature) return a.feature < c.feature;
        if (a.overlap != c.overlap) return a.overlap > c.overlap;
        return a.facet < c.facet;
      });
    for (const Touch& touch : touches)
      if (std::none_of(accepted.begin(), accepted.end(),
                       [&](const Touch& by) { return hidden(touch, by, radius); }))
        accepted.push_back(touch);

    for (const Touch& touch : accepted) {
      const Vec3 normal = turned ? Vec3(pose.rotation * touch.normal) : touch.normal;
      int best = -1;
      double best_cosine = kSameContact;
      for (int k = 0; k < known; ++k) {
        if (slots[k].body != b || goes_on[k]) continue;
        if (const double c = slots[k].normal.dot(normal); c > best_cosine) best = k, best_cosine = c;
      }
      if (best >= 0) {
        goes_on[best] = true;
        slots[best].normal = normal;
        slots[best].excess = std::min(slots[best].excess, touch.overlap);
        slots[best].overlap = touch.overlap - slots[best].excess;
      } else if (fresh_count < kMeshContactSlots) {
        const double excess = body.mesh().closed && touch.overlap > kBornDeep * radius ? touch.overlap : 0.0;
        if (excess > 0) ++changes.born_inside;
        fresh[fresh_count++] = {b, normal, touch.overlap - excess, excess};
      } else {
        ++changes.without_slot;
      }
    }
  }

  int count = 0;
  for (int k = 0; k < known; ++k) {
    if (!goes_on[k]) continue;
    changes.went_on |= 1u << k;
    if (count != k) slots[count] = slots[k];
    ++count;
  }
  for (int m = 0; m < fresh_count; ++m) {
    if (count == static_cast<int>(slots.size()))
      ++changes.without_slot;
    else
      ++changes.begun,
          slots[count++] = {fresh[m].body, fresh[m].normal, fresh[m].overlap, fresh[m].excess, {}};
  }
  if (count < static_cast<int>(slots.size())) slots[count].body = -1;
  return changes;
}

}  // namespace scree
