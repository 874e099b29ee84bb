// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>

#include "delquad/fields.h"

// This header makes a size field of a function. Features use it.

namespace delquad {

/// Returns a size field by a function of place and hint, as SizeField::at() has them.
template <class F>
std::shared_ptr<const SizeField> size_by(F size) {
  struct SizeBy final : SizeField {
    explicit SizeBy(F f) : size(std::move(f)) {}
    double at(const Vec3& x, int& hint) const override { return size(x, hint); }
    F size;
  };
  return std::make_shared<SizeBy>(std::move(size));
}

/// Returns `factor` times a size.
inline std::shared_ptr<const SizeField> scaled(double factor, std::shared_ptr<const SizeField> size) {
  return size_by(
      [factor, size = std::move(size)](const Vec3& x, int& hint) { return factor * size->at(x, hint); });
}

}  // namespace delquad
