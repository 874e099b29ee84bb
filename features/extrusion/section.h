#pragma once

#include <string>
#include <vector>

#include "delquad/hexahedra.h"

namespace delquad {

/// An edge of the section that a face grows from.
struct WallEdge {
  int a, b;   ///< the quad lies on the left
  int quad;   ///< the first that it is an edge of
  int curve;  ///< index into Mesh::curves; -1: no line lies there
  bool on_boundary;
};

/// What is swept: quads that run the same way round as their neighbours.
struct Section {
  Mesh mesh;              ///< quads, and points that they use
  std::vector<int> part;  ///< of each quad: those that hang together by edges
  int n_parts = 0;
  std::vector<WallEdge> walls;  ///< all edges on the boundary; those inside whose line has a name
};

/// Throws InputError with the place. `notes` learns what is left out.
Section make_section(const Mesh& mesh, ReadNotes* notes);

}  // namespace delquad
