#pragma once

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

/// delta' of a planar patch, whose parameter plane is the plane z = 0 itself.
class PlanarSize final : public ParametricSize {
 public:
  explicit PlanarSize(const SizeField& size) : size_(size) {}
  double at(Vec2 u, int& hint) const override { return size_.at({u.x, u.y, 0}, hint); }

 private:
  const SizeField& size_;
};

}  // namespace delquad
