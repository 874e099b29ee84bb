// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "features/symmetry/symmetry_planes.h"
#include "geometry/surface/surface_model.h"

// This header finds planes of symmetry of a surface. Features use it.

namespace delquad {

/// A symmetric model's places have their images on it to this part of the diagonal of the model. On a
/// triangulation, the distance of its triangles from the surface is added. On faces that are narrow, and on
/// their curves, it is this part of the width.
inline constexpr double kSymmetric = 1e-4, kSymmetricOfWidth = 0.05;

/// Images of the parts of a model at one plane.
struct MirrorMatch {
  std::string failure;       ///< why the model is not symmetric; empty: it is
  std::vector<int> face;     ///< of each face, its image
  std::vector<char> turned;  ///< of each face: its image looks to the other side
  /// For each curve the curves that its image lies on, ascending. Curves that need no image have none:
  /// dangling curves, and nameless seams, which have the same face on both sides.
  std::vector<std::vector<int>> curves;
  std::vector<char> is_loose_seam;  ///< of each curve: such a seam, without an image
  bool by_embedded = false;         ///< all but embedded curves and single points is symmetric
};

/// Compares a model with its images.
class MirrorMatcher {
 public:
  /// `tolerance`: in place of kSymmetric.
  explicit MirrorMatcher(const SurfaceModel& model, double tolerance = kSymmetric);
  ~MirrorMatcher();

  MirrorMatch match(const SymmetryPlanes& planes, int plane) const;
  /// Returns whether a few places have images, ten times as far off as they may be in the end.
  bool can_match(const SymmetryPlanes& planes, int plane) const;
  /// Returns the plane that fits the model best, near one that nearly does.
  SymmetryPlane adjusted(const SymmetryPlane& plane) const;
  /// Returns the mean distance of images from the model, over some places.
  double misfit(const SymmetryPlane& plane) const;

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

struct FoundPlanes {
  std::vector<SymmetryPlane> planes;  ///< perpendicular to each other
  std::vector<MirrorMatch> matches;   ///< of each
};

/// Returns the planes at which a model is symmetric: those that are given, or those that are found. These go
/// through the middle of the model or the centroid of its surface. If several are equally good, planes
/// perpendicular to x, y and z come first. A warning says that there is none, and which item that is embedded
/// spoils one. `is_flat`: the model is a flat_model(), so that planes are perpendicular to z = 0 and pieces
/// match to kTouch. Throws InputError for given planes at which it is not symmetric, naming the part without
/// an image and its distance.
FoundPlanes find_symmetry_planes(const SymmetrySpec& spec, const SurfaceModel& model, bool is_flat,
                                 std::vector<Warning>& warnings);

}  // namespace delquad
