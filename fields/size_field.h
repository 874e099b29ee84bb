#pragma once

#include <memory>
#include <utility>

#include "mesh/vec.h"

namespace delquad {

/// The wanted edge length delta at a point of space (physical length, finite, > 0).
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// `hint` remembers where the last point was found: start with -1 and carry it along between nearby points.
  /// It never changes the value. Throws InputError, naming the point, where delta is not finite and positive.
  virtual double at(const Vec3& x, int& hint) const = 0;
};

/// The wanted edge length delta' in the parameter plane of a patch.
class ParametricSize {
 public:
  virtual ~ParametricSize() = default;
  virtual double at(Vec2 u, int& hint) const = 0;
};

/// delta' of a planar patch, whose parameter plane is the plane z = constant itself.
class PlanarSize final : public ParametricSize {
 public:
  explicit PlanarSize(std::shared_ptr<const SizeField> size, double z = 0) : size_(std::move(size)), z_(z) {}
  double at(Vec2 u, int& hint) const override { return size_->at({u.x, u.y, z_}, hint); }

 private:
  std::shared_ptr<const SizeField> size_;
  double z_;
};

}  // namespace delquad
