// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "features/curved/curved_geometry.h"
#include "features/curved/jacobian_bounds.h"

// This header repairs curved quads. Curved meshes use it.

namespace delquad {

/// A curved quad with a smaller scaled Jacobian is optimized, unless its straight form is hardly better.
inline constexpr double kPoorJacobian = 0.2;

/// Elements should have at least this scaled Jacobian unless a corner of the model forbids it.
inline constexpr double kLowJacobian = 0.1;
/// A corner of the model explains an element that has this share of the value that the corner allows.
inline constexpr double kPartOfAllowed = 0.7;

struct UntanglingSummary {
  int poor = 0;                 ///< quads that were optimized
  int improved = 0;             ///< elements whose proven scaled Jacobian grew
  bool moved_vertices = false;  ///< vertices of the straight mesh moved, too
};

/// Limits of untangling.
struct UntanglingLimits {
  std::vector<double> allowed;  ///< by quad: largest scaled Jacobian that its corners allow
  std::vector<int> stay = {};   ///< nodes that may not move
};

/// Returns the bounds of all quads of a curved mesh, by element_bounds().
std::vector<JacobianBounds> jacobian_bounds(const Mesh& mesh);

/// Moves nodes of curved quads that are inverted or poor, and nodes around them. The maps of elements
/// approach the maps of the straight elements, see DistortionEnergy [knupp2001; escobar2003]. Nodes inside of
/// faces slide on these, nodes between the ends of a line slide on its curve. If quads stay below
/// kLowJacobian, more rings of quads and their vertices move, too. Vertices may slide along curves as
/// ModelGeometry::slides() says. `bounds` has the bounds of all quads and is kept up to date. A step that
/// does not improve the quads of a neighborhood as a whole is undone. No other quad loses its positive bound.
UntanglingSummary untangle_curved(Mesh& mesh, const ModelGeometry& geometry, const UntanglingLimits& limits,
                                  std::vector<JacobianBounds>& bounds);

}  // namespace delquad
