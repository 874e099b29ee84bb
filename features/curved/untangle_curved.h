// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "features/curved/curved_geometry.h"
#include "features/curved/jacobian_bounds.h"

// This header repairs curved quads. Curved meshes use it.

namespace delquad {

/// A curved quad with a lesser scaled Jacobian is worked on, unless its straight form is hardly better.
inline constexpr double kPoorJacobian = 0.2;

/// Elements should have at least so much where no corner of the model forbids it.
inline constexpr double kLowJacobian = 0.1;
/// A corner of the model explains an element that has so much of what it allows.
inline constexpr double kPartOfAllowed = 0.7;

struct UntanglingSummary {
  int poor = 0;                 ///< quads that were worked on
  int improved = 0;             ///< elements of a greater proven scaled Jacobian after it
  bool moved_vertices = false;  ///< elements of the straight mesh, too
};

/// Limits of untangling.
struct UntanglingLimits {
  std::vector<double> allowed;  ///< of each quad: corners of the model allow no more; 0: next to nothing
  std::vector<int> stay = {};   ///< nodes
};

/// Bounds of all quads of a curved mesh, by element_bounds().
std::vector<JacobianBounds> jacobian_bounds(const Mesh& mesh);

/// Moves nodes of curved quads that are inverted or poor, and nodes around them. The elements' maps approach
/// the maps of the straight elements, see DistortionEnergy. Nodes inside of faces slide on these, nodes
/// between the ends of a line slide on its curve. If quads stay below kLowJacobian, more rings of quads and
/// their vertices move, too. Vertices may slide along curves as ModelGeometry::slides() says. `bounds`: of
/// all quads, kept up to date. A step that does not improve the quads of a neighborhood as a whole is undone.
/// No other quad loses its positive bound.
UntanglingSummary untangle_curved(Mesh& mesh, const ModelGeometry& geometry, const UntanglingLimits& limits,
                                  std::vector<JacobianBounds>& bounds);

}  // namespace delquad
