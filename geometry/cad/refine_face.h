#pragma once

#include <Geom_Surface.hxx>

#include "delquad/mesh.h"

namespace delquad::cad {

/// What the triangles of a face are to keep to.
struct FaceBounds {
  double deflection = 0;  ///< largest distance between a triangle and its surface, a length
  double angle = 0;       ///< between the normals at the ends of a side inside, radians
  int most_points = 0;    ///< no more are put inside
};

struct RefinedFace {
  TriPatch flat;             ///< in parameters times `scale`
  std::vector<Vec3> points;  ///< on the surface, but for those of the boundary
  bool is_complete = true;   ///< false: `most_points` were not enough
};

/// Puts points on the middles of sides inside a face, Delaunay in scaled parameters, until its triangles keep
/// to the bounds. `points`: of the triangulation's boundary, in space.
RefinedFace refine_face(const Geom_Surface& surface, const TriPatch& start, std::vector<Vec3> points,
                        Vec2 scale, const FaceBounds& bounds);

/// Factors by which parameters become about lengths: the mean speeds of the surface around these parameters.
Vec2 parameter_scale(const Geom_Surface& surface, const std::vector<Vec2>& uv);

}  // namespace delquad::cad
