// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "features/symmetry/symmetry_planes.h"
#include "geometry/surface/surface_model.h"

// This header finds planes of symmetry of a surface. Features use it.

namespace delquad {

/// Largest distance of images from a symmetric model, in its diagonals. On a triangulation, the distance of
/// its triangles from the surface is added. On narrow faces and their curves it is kSymmetricOfWidth of the
/// width.
inline constexpr double kSymmetric = 1e-4, kSymmetricOfWidth = 0.05;

/// Images of the parts of a model at one plane.
struct MirrorMatch {
  std::string failure;       ///< why the model is not symmetric; empty: it is
  std::vector<int> face;     ///< image of each face
  std::vector<char> turned;  ///< by face: its image has the opposite orientation
  /// For each curve the curves that its image lies on, ascending. Curves that need no image have none. These
  /// are dangling curves, and nameless seams with the same face on both sides.
  std::vector<std::vector<int>> curves;
  std::vector<char> is_loose_seam;  ///< by curve: such a seam, without an image
  bool by_embedded = false;         ///< only embedded curves and single points are not symmetric
};

/// Compares a model with its mirror images.
class MirrorMatcher {
 public:
  /// `tolerance`: in place of kSymmetric.
  explicit MirrorMatcher(const SurfaceModel& model, double tolerance = kSymmetric);
  ~MirrorMatcher();

  /// Returns the images of faces and curves at a plane, or the reason why there are none.
  MirrorMatch match(const SymmetryPlanes& planes, int plane) const;
  /// Returns whether a few places have images within ten times the final tolerance.
  bool can_match(const SymmetryPlanes& planes, int plane) const;
  /// Returns the plane near a given one that fits the model best.
  SymmetryPlane adjusted(const SymmetryPlane& plane) const;
  /// Returns the mean distance of images from the model, over some places; a length.
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
/// spoils one. `is_flat`: the model is a flat_surface(), so that planes are perpendicular to z = 0 and pieces
/// match to kTouch. Throws InputError for given planes at which it is not symmetric, naming the part without
/// an image and its distance.
FoundPlanes find_symmetry_planes(const SymmetrySpec& spec, const SurfaceModel& model, bool is_flat,
                                 std::vector<Warning>& warnings);

}  // namespace delquad
