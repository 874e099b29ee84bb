// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/sampled_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/fields/check_size.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {

namespace {

class SampledSize final : public SizeField {
 public:
  SampledSize(SampleTree tree, std::string name) : tree_(std::move(tree)), name_(std::move(name)) {}
  double at(const Vec3& x, int&) const override {
    double delta = 0;
    if (const auto bad = tree_.interpolate(x, {&delta, 1})) throw bad_size(name_, bad->at, bad->value);
    return delta;
  }

 private:
  SampleTree tree_;
  std::string name_;
};

/// Returns the size; infinity where there is none, outside of the domain.
double size_or_any(const SizeField& size, const Vec3& at) {
  try {
    int hint = -1;
    return size.at(at, hint);
  } catch (const InputError&) {
    return INFINITY;
  }
}

InputError bad_angle(const std::string& name, const Vec3& at) {
  return InputError(fmt::format("{} is not a finite number at {}; an angle must be one", name,
                                show_point(Vec2{at.x, at.y})));
}

class SampledCross final : public CrossField {
 public:
  SampledCross(SampleTree tree, std::string name) : tree_(std::move(tree)), name_(std::move(name)) {}
  Cross at(Vec2 u, int&) const override {
    double cross[2];
    if (const auto bad = tree_.interpolate({u.x, u.y, 0}, cross)) throw bad_angle(name_, bad->at);
    return {cross[0], cross[1]};
  }

 private:
  SampleTree tree_;
  std::string name_;
};

void warn_if_cut_short(const SampleTree& tree, const std::string& name, std::vector<Warning>& warnings) {
  if (!tree.is_cut_short()) return;
  warnings.push_back(
      fmt::format("{} varies so much everywhere that {} samples do not show it well: between "
                  "them it is interpolated [rough-size]",
                  name, tree.points().size()));
}

}  // namespace

std::shared_ptr<const SizeField> sample_size(const SizeFunction& function, const SampleDomain& domain,
                                             const std::string& name, std::vector<Warning>& warnings) {
  const SampleRules rules = {1, function, [](const double* delta) { return is_size(*delta); },
                             [](const double* delta) { return kSampledSizeError * *delta; },
                             [](const Vec3&, const double* delta) { return kClosestSamples * *delta; }};
  SampleTree tree(domain, rules);
  const std::span<const double> values = tree.values();
  if (std::ranges::none_of(values, is_size)) {
    double none = 0;
    const auto bad = tree.interpolate(0.5 * (domain.box.low + domain.box.high), {&none, 1});
    throw bad_size(name, bad->at, bad->value);
  }
  if (std::ranges::all_of(values, [&](double delta) { return delta == values[0]; }))
    return make_constant_size(values[0]);
  warn_if_cut_short(tree, name, warnings);
  return std::make_shared<SampledSize>(std::move(tree), name);
}

std::shared_ptr<const CrossField> sample_cross(const CrossFunction& function, const SampleDomain& domain,
                                               const SizeField& size, const std::string& name,
                                               std::vector<Warning>& warnings) {
  const auto crosses = [&](std::span<const Vec3> points, std::span<double> values) {
    std::vector<Vec2> plane;
    for (const Vec3& p : points) plane.push_back({p.x, p.y});
    std::vector<double> theta(points.size(), NAN);
    function(plane, theta);
    for (std::size_t i = 0; i < theta.size(); ++i) {
      const Cross cross = Cross::from_angle(theta[i]);
      values[2 * i] = cross.c;
      values[2 * i + 1] = cross.s;
    }
  };
  const SampleRules rules = {
      2, crosses, [](const double* cross) { return std::isfinite(cross[0]); },
      [](const double*) { return kSampledCrossError; },
      [&](const Vec3& at, const double*) { return kClosestSamples * size_or_any(size, at); }};
  SampleTree tree(domain, rules);
  if (std::ranges::all_of(tree.values(), [](double v) { return std::isnan(v); })) {
    double none[2];
    throw bad_angle(name, tree.interpolate(0.5 * (domain.box.low + domain.box.high), none)->at);
  }
  warn_if_cut_short(tree, name, warnings);
  return std::make_shared<SampledCross>(std::move(tree), name);
}

}  // namespace delquad
