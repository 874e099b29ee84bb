// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/model.h"

// This header reflects points at perpendicular planes. Features use it.

namespace delquad {

/// One to three perpendicular planes in space. The fundamental part of a symmetric model lies on their
/// positive sides. Masks have one bit for each plane.
class SymmetryPlanes {
 public:
  explicit SymmetryPlanes(const std::vector<SymmetryPlane>& planes);

  int count() const { return static_cast<int>(planes_.size()); }
  std::vector<SymmetryPlane> all() const;
  const Vec3& normal(int plane) const { return planes_[plane].normal; }
  double height(int plane, const Vec3& x) const { return dot(x - planes_[plane].at, planes_[plane].normal); }
  Vec3 put_on(int plane, const Vec3& x) const;
  /// Returns the point on all planes whose bits are set.
  Vec3 put_on_all(int mask, Vec3 x) const;
  Vec3 reflect(int plane, const Vec3& x) const;
  /// Reflects at all planes whose bits are set.
  Vec3 reflect_all(int mask, Vec3 x) const;
  /// Returns the bits of the planes behind which x lies by more than `tolerance`.
  int folds_of(const Vec3& x, double tolerance = 0) const;
  /// Returns the image of x on the positive sides of all planes.
  Vec3 fold(const Vec3& x) const { return reflect_all(folds_of(x), x); }

 private:
  struct Plane {
    Vec3 at, normal;  // unit length
  };
  std::vector<Plane> planes_;
};

/// Returns given planes. Throws InputError, beginning with `where`, for more than three and for planes that
/// are not perpendicular.
SymmetryPlanes given_planes(const std::vector<SymmetryPlane>& planes, const std::string& where);

/// Returns at each place the least size of the place and its mirror images. Sizes that are equal to rounding
/// stay.
std::shared_ptr<const SizeField> least_of_images(std::shared_ptr<const SizeField> size,
                                                 const SymmetryPlanes& planes);

/// Returns the size on the positive sides, and its mirror image.
std::shared_ptr<const SizeField> folded_size(std::shared_ptr<const SizeField> size,
                                             const SymmetryPlanes& planes);

/// Returns half a model of triangles with its mirror image, whose orientation agrees with it. Ends of open
/// edges within the tolerance are moved onto the plane and belong to both halves; lines there vanish. Both
/// images of a line are on its curve. Throws InputError, beginning with `source`, if points lie on both sides
/// of the plane beyond the tolerance. Also throws if no open edge lies in the plane, or if a triangle does.
Mesh add_mirror_image(Mesh half, const MirrorPlane& plane, const std::string& source);

}  // namespace delquad
