// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/symmetry_planes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "algorithms/fields/size_by.h"
#include "delquad/error.h"

namespace delquad {

SymmetryPlanes::SymmetryPlanes(const std::vector<SymmetryPlane>& planes) {
  assert(planes.size() <= 3);
  assert(std::ranges::all_of(planes, [](const SymmetryPlane& p) { return norm(p.normal) > 0; }));
  for (const SymmetryPlane& p : planes) planes_.push_back({p.point, (1 / norm(p.normal)) * p.normal});
}

std::vector<SymmetryPlane> SymmetryPlanes::all() const {
  std::vector<SymmetryPlane> all;
  for (const Plane& p : planes_) all.push_back({p.at, p.normal});
  return all;
}

Vec3 SymmetryPlanes::put_on(int plane, const Vec3& x) const { return x - height(plane, x) * normal(plane); }

Vec3 SymmetryPlanes::put_on_all(int mask, Vec3 x) const {
  assert(mask >= 0 && mask < 1 << count());
  for (int k = 0; k < count(); ++k)
    if (mask >> k & 1) x = put_on(k, x);
  return x;
}

Vec3 SymmetryPlanes::reflect(int plane, const Vec3& x) const {
  return x - (2 * height(plane, x)) * normal(plane);
}

Vec3 SymmetryPlanes::reflect_all(int mask, Vec3 x) const {
  assert(mask >= 0 && mask < 1 << count());
  for (int k = 0; k < count(); ++k)
    if (mask >> k & 1) x = reflect(k, x);
  return x;
}

int SymmetryPlanes::folds_of(const Vec3& x, double tolerance) const {
  int mask = 0;
  for (int k = 0; k < count(); ++k)
    if (height(k, x) < -tolerance) mask |= 1 << k;
  return mask;
}

SymmetryPlanes given_planes(const std::vector<SymmetryPlane>& planes, const std::string& where) {
  constexpr double kPerpendicular = 1e-9;  // cosine
  constexpr std::size_t kMost = 3;
  bool good = planes.size() <= kMost;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      good &= std::abs(dot(planes[i].normal, planes[j].normal)) <=
              kPerpendicular * norm(planes[i].normal) * norm(planes[j].normal);
  if (!good)
    throw InputError(
        where + ": expected one plane of symmetry, or two or three that are perpendicular to each other");
  return SymmetryPlanes(planes);
}

namespace {

/// Sizes that differ by a smaller part are the same: places of images have rounding.
constexpr double kSameSize = 1e-9;

}  // namespace

std::shared_ptr<const SizeField> least_of_images(std::shared_ptr<const SizeField> size,
                                                 const SymmetryPlanes& planes) {
  return size_by([size = std::move(size), planes](const Vec3& x, int& hint) {
    const double own = size->at(x, hint);
    double least = own;
    for (int mask = 1; mask < 1 << planes.count(); ++mask) {
      int far_hint = -1;
      least = std::min(least, size->at(planes.reflect_all(mask, x), far_hint));
    }
    return least < (1 - kSameSize) * own ? least : own;
  });
}

std::shared_ptr<const SizeField> folded_size(std::shared_ptr<const SizeField> size,
                                             const SymmetryPlanes& planes) {
  return size_by(
      [size = std::move(size), planes](const Vec3& x, int& hint) { return size->at(planes.fold(x), hint); });
}

}  // namespace delquad
