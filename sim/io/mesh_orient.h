#pragma once
// The edges of a mesh: which are open, which way the faces look, which parts bound a solid. Inside sim/io
// only.
#include <array>
#include <vector>

#include "sim/io/mesh.h"

namespace scree {

/// What a look at the edges found, after the faces were turned.
struct EdgeFindings {
  int open_edges = 0;                        ///< edges of one face only
  std::array<int, 2> first_open{-1, -1};     ///< vertices of the open edge of the lowest face
  int crowded_edges = 0;                     ///< edges shared by three or more faces
  std::array<int, 2> first_crowded{-1, -1};  ///< vertices
  int twisted_edges = 0;  ///< edges whose two faces cannot be made to agree (a Moebius strip)
  std::array<int, 2> first_twisted{-1, -1};  ///< vertices
  int turned_faces = 0;                      ///< faces turned because they disagreed with their neighbours
  int turned_parts = 0;                      ///< closed parts that were inside out and were turned as a whole
};

/// Makes the faces of each connected part agree (flood fill over edges of two faces) and turns closed parts
/// outwards (positive signed volume). A closed part that lies wholly inside another and looks inwards is a
/// hollow and stays. In a part that is not closed the majority of faces keeps its side. Neither adds nor
/// removes faces.
EdgeFindings orient_faces(TriangleMesh& mesh);

}  // namespace scree
