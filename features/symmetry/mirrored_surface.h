#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "delquad/mesher.h"
#include "geometry/surface/symmetric_half.h"
#include "patches/prepared.h"

namespace delquad {

/// A symmetric surface, cut at its planes.
struct CutSurface {
  SurfaceModel whole;
  SymmetryPlanes planes;
  std::vector<MirrorMatch> matches;
  SymmetricHalf half;
};

/// Cuts a surface at the planes of the problem; none: no planes are asked for, or none are found, which a
/// warning of the model says then. `size` becomes the least of those at the images of a place. Throws
/// InputError for planes at which it is not symmetric, naming what has no image and how far off it is, and
/// where periodic sides are asked for, too.
std::optional<CutSurface> cut_at_planes(const MeshProblem& problem, SurfaceModel& model,
                                        std::shared_ptr<const SizeField>& size);

/// The divisions of the curves of the part: those of curves that go through a plane are shared by both sides.
/// Throws InputError for numbers that cannot be, naming one that can, and for curves that are divided
/// otherwise than their images.
std::vector<CurveDivision> divisions_of_part(const std::vector<CurveDivision>& divisions,
                                             const CutSurface& surface);

/// The most of these values, of the faces or curves of the whole, at their images; of the part.
std::vector<double> most_of_faces(std::vector<double> values, const CutSurface& surface);
std::vector<double> most_of_curves(const std::vector<double>& values, const CutSurface& surface);

/// `surface` has the domain of the part, its model and its cuts.
MirroredSurface mirrored_surface(CutSurface cut, const PreparedSurface& surface);

}  // namespace delquad
