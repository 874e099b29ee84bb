// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/box.h"
#include "delquad/extend.h"
#include "features/symmetry/symmetry_planes.h"
#include "geometry/patches/curve_nodes.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/planar_model.h"

// This header has the symmetry of planar models. The pipeline and features use it.

namespace delquad {

/// One or two planes of symmetry of a planar model.
class Symmetry : public SymmetryPlanes {
 public:
  /// `planes`: of find_symmetry(), and so perpendicular to each other.
  Symmetry(std::vector<SymmetryPlane> planes, const PlanarModel& model);

  /// Returns the bits of the planes behind which x lies by more than the tolerance.
  int folds_of(Vec2 x) const { return SymmetryPlanes::folds_of({x.x, x.y, 0}, tolerance_); }
  /// Returns x mirrored at all planes whose bits are set.
  Vec2 reflect(int folds, Vec2 x) const;
  bool is_on(int plane, Vec2 x) const { return std::abs(height(plane, {x.x, x.y, 0})) <= tolerance_; }
  Vec2 put_on(int plane, Vec2 x) const;
  double tolerance() const { return tolerance_; }
  /// Returns the line in which the plane crosses the box.
  std::array<Vec2, 2> axis(int plane, const Box<Vec2>& box) const;

 private:
  double tolerance_;
};

/// Returns the planes of a problem in the plane, or none, see find_symmetry_planes(). `domain`: of the model,
/// with edges of any length.
std::vector<SymmetryPlane> find_symmetry(const PlanarModel& model, const PlanarDomain& domain,
                                         SymmetrySpec spec, std::vector<Warning>& warnings);

/// Returns the model with the axes of the planes as last curves, and with last points where its nodes have
/// their images.
PlanarModel with_axes(const PlanarModel& model, const Symmetry& symmetry);

/// Removes the parts of axes, the curves from `first_axis` on, that lie outside of all regions. `lines` has
/// the lines of the pieces.
void drop_axes_outside(const Mesh& lines, int first_axis, ModelChain& chain, std::vector<CurvePiece>& pieces);

/// Removes axes from the curves of the domain; a curve that lies on an axis stays.
void drop_axes(int first_axis, PlanarDomain& domain);

/// Gives pieces behind a plane the images of the pieces before it, and returns the pairs. Throws InputError,
/// beginning with `where`, for pieces without one.
std::vector<ChainPair> pair_symmetric(const PlanarModel& model, const Symmetry& symmetry,
                                      const std::string& where, ModelChain& chain,
                                      std::vector<CurvePiece>& pieces);

/// Returns for each patch that is a mirror image its original and its reflection. Throws InputError,
/// beginning with `where`, for patches behind a plane that are no images.
std::vector<PatchImage> patch_images(const std::vector<PatchBoundary>& patches, const Symmetry& symmetry,
                                     const std::string& where);

/// Returns the mirror image of a patch's mesh. Points of `boundary`, the boundary of the image, stay.
PatchMesh image_of(const PatchMesh& master, const PatchBoundary& boundary, const PatchImage& image);

/// Moves ends of edges at single points of images, as they moved on the boundary of the master. `points` has
/// the nodes of all boundaries.
void move_image_nodes(const MeshingSetup& prepared, const PatchImage& image, std::vector<Vec3>& points);

}  // namespace delquad
