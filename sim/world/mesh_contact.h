#pragma once
// Where a sphere touches a mesh: one contact a surface, whatever the triangulation.
#include <span>
#include <vector>

#include "sim/contact/rrlinear.h"
#include "sim/world/mesh_body.h"

namespace scree {

/// A contact of a sphere with a mesh body, with its memory. World axes.
struct MeshContact {
  int body = -1;               ///< index of the mesh body; -1: slot is free
  Vec3 normal = Vec3::Zero();  ///< from the surface to the sphere, unit
  double overlap = 0;          ///< m; above the radius when the centre has been pressed through the surface
  double excess = 0;  ///< m; overlap that is not counted: a sphere that comes out of a solid is not shot off
  ContactHistory history;
};

/// Largest number of contacts one sphere may have with all meshes together.
inline constexpr int kMeshContactSlots = 8;

/// A facet that a sphere may touch.
struct FacetRef {
  int body;
  int facet;
};

/// What update_mesh_contacts found new, and what it could not do as it should.
struct MeshContactChanges {
  int begun = 0;         ///< contacts that began: the last ones
  unsigned went_on = 0;  ///< bit k: the contact in slot k before did not end
  int without_slot = 0;  ///< contacts left out because the sphere has too many
  int born_inside =
      0;  ///< contacts that began inside a closed mesh: the sphere was squeezed through or put there
};

/// Finds the contacts of a sphere with the facets listed (sorted by body) and updates its slots: a contact
/// that goes on keeps its memory, one that has ended is freed. Contacts come first in `slots`; the first with
/// body -1 ends them.
///
/// Priority is face, edge, vertex. An accepted contact with foot p and normal n hides every edge or vertex
/// whose closest point lies in or behind the plane (p, n): so seams of coplanar triangles, and the neighbours
/// across a convex edge, are felt once, with conforming and with non-conforming triangulations. A contact
/// goes on if its normal turned by less than 60 degrees. Closed meshes push from the outside only; a centre
/// that was pressed through a face from the outside is still pushed back out, one that came from the inside
/// is left alone: a contact that begins with more than half of the radius inside counts only what it presses
/// deeper than at its least. Sheets push on the side where the contact began.
MeshContactChanges update_mesh_contacts(const std::vector<std::unique_ptr<MeshBody>>& bodies,
                                        std::span<const FacetRef> facets, const Vec3& centre, double radius,
                                        std::span<MeshContact> slots);

}  // namespace scree
