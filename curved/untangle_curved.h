#pragma once

#include <vector>

#include "curved/jacobian_bounds.h"
#include "curved/model_geometry.h"
#include "delquad/mesh.h"

namespace delquad {

/// A curved quad with a lesser scaled Jacobian is worked on, unless its straight form is hardly better.
inline constexpr double kPoorJacobian = 0.2;

struct UntanglingSummary {
  int poor = 0;      ///< quads that were worked on
  int improved = 0;  ///< those of a greater proven scaled Jacobian after it
};

/// Bounds of all quads of a curved mesh, by element_bounds().
std::vector<JacobianBounds> jacobian_bounds(const Mesh& mesh);

/// Moves nodes of curved quads that are inverted or poor, and of those around, to where the elements' maps
/// are nearest to those of the straight ones [distortion |T|^2 / (2 det T), as Knupp 2001 has it for corners;
/// regularised where det T <= 0, as Escobar et al. 2003 do]. Nodes inside of faces slide on these; nodes on
/// lines stay. `bounds`: of all quads, kept up to date. No quad's proven bound falls below the least one of
/// its neighbourhood before.
UntanglingSummary untangle_curved(Mesh& mesh, const ModelGeometry& geometry,
                                  std::vector<JacobianBounds>& bounds);

}  // namespace delquad
