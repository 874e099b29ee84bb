// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <utility>

#include "delquad/fields.h"

/// Fields given by functions, for tests.
namespace delquad::testing_support {

class FunctionSize final : public ParametricSize {
 public:
  explicit FunctionSize(std::function<double(Vec2)> f) : f_(std::move(f)) {}
  explicit FunctionSize(double constant) : f_([constant](Vec2) { return constant; }) {}
  double at(Vec2 u, int&) const override { return f_(u); }

 private:
  std::function<double(Vec2)> f_;
};

class FunctionCross final : public CrossField {
 public:
  explicit FunctionCross(std::function<double(Vec2)> theta) : theta_(std::move(theta)) {}
  explicit FunctionCross(double theta) : theta_([theta](Vec2) { return theta; }) {}
  Cross at(Vec2 u, int&) const override { return Cross::from_angle(theta_(u)); }

 private:
  std::function<double(Vec2)> theta_;
};

}  // namespace delquad::testing_support
