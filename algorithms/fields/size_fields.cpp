// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "algorithms/fields/check_size.h"
#include "algorithms/fields/laplace.h"
#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {

namespace {

class ConstantSize final : public SizeField {
 public:
  explicit ConstantSize(double delta) : delta_(delta) {}
  double at(const Vec3&, int&) const override { return delta_; }

 private:
  double delta_;
};

class CappedSize final : public SizeField {
 public:
  CappedSize(std::shared_ptr<const SizeField> base, double most) : base_(std::move(base)), most_(most) {}
  double at(const Vec3& x, int& hint) const override { return std::min(base_->at(x, hint), most_); }

 private:
  std::shared_ptr<const SizeField> base_;
  double most_;
};

class FunctionSize final : public SizeField {
 public:
  FunctionSize(std::function<double(const Vec3&)> delta, std::string name)
      : delta_(std::move(delta)), name_(std::move(name)) {}
  double at(const Vec3& x, int&) const override {
    const double delta = delta_(x);
    if (!is_size(delta)) throw bad_size(name_, x, delta);
    return delta;
  }

 private:
  std::function<double(const Vec3&)> delta_;
  std::string name_;
};

class SourceSize final : public SizeField {
 public:
  SourceSize(std::shared_ptr<const SizeField> base, std::vector<SizeSource> sources)
      : base_(std::move(base)), sources_(std::move(sources)) {}

  double at(const Vec3& x, int& hint) const override {
    double delta = base_ ? base_->at(x, hint) : INFINITY;
    for (const SizeSource& s : sources_) delta = std::min(delta, size_by(s, x));
    if (!is_size(delta)) throw bad_size("size field of sources", x, delta);
    return delta;
  }

 private:
  static double size_by(const SizeSource& s, const Vec3& x) {
    const double r = norm(x - s.a - nearest_part(x, s.a, s.b) * (s.b - s.a));
    if (r <= s.radius_near) return s.size_near;
    if (r >= s.radius_far) return s.size_far;
    const double t = (r - s.radius_near) / (s.radius_far - s.radius_near);
    return (1 - t) * s.size_near + t * s.size_far;
  }

  std::shared_ptr<const SizeField> base_;
  std::vector<SizeSource> sources_;
};

void check_source(const SizeSource& s, std::size_t index) {
  if (!is_size(s.size_near) || !is_size(s.size_far)) {
    throw InputError(fmt::format("size source {}: sizes {} and {}: expected a finite length > 0 [bad-size]",
                                 index + 1, s.size_near, s.size_far));
  }
  if (!(s.radius_near >= 0) || !(s.radius_far >= s.radius_near) || !std::isfinite(s.radius_far)) {
    throw InputError(fmt::format("size source {}: radii {} and {}; expected 0 <= near <= far", index + 1,
                                 s.radius_near, s.radius_far));
  }
  if (!std::isfinite(dot(s.a, s.a)) || !std::isfinite(dot(s.b, s.b))) {
    throw InputError(fmt::format("size source {}: its points must be finite", index + 1));
  }
}

}  // namespace

bool is_size(double delta) { return std::isfinite(delta) && delta > 0; }

InputError bad_size(const std::string& field, const Vec3& x, double delta) {
  const double shown = std::isnan(delta) ? std::abs(delta) : delta;  // not "-nan"
  return InputError(
      fmt::format("{} is {} at {}: expected a finite length > 0 [bad-size]", field, shown, show_point(x)));
}

std::unique_ptr<SizeField> make_constant_size(double delta) {
  if (!is_size(delta))
    throw InputError(fmt::format("the size is {}: expected a finite length > 0 [bad-size]", delta));
  return std::make_unique<ConstantSize>(delta);
}

std::unique_ptr<SizeField> make_function_size(std::function<double(const Vec3&)> delta, std::string name) {
  return std::make_unique<FunctionSize>(std::move(delta), std::move(name));
}

std::unique_ptr<SizeField> make_source_size(std::shared_ptr<const SizeField> base,
                                            std::vector<SizeSource> sources) {
  if (!base && sources.empty()) throw InputError("a size field needs a base or a source");
  for (std::size_t i = 0; i < sources.size(); ++i) check_source(sources[i], i);
  return std::make_unique<SourceSize>(std::move(base), std::move(sources));
}

std::unique_ptr<SizeField> make_capped_size(std::shared_ptr<const SizeField> base, double most) {
  if (!is_size(most))
    throw InputError(fmt::format("the largest size is {}: expected a finite length > 0 [bad-size]", most));
  return std::make_unique<CappedSize>(std::move(base), most);
}

double least_by_curvature(double base, double min) {
  constexpr double kLeastPart = 1.0 / 20;
  return min > 0 ? min : kLeastPart * base;
}

double size_by_curvature(double base, double k, double per_turn, double min) {
  if (!(k > 0) || !(per_turn > 0)) return base;
  return std::min(base, std::max(least_by_curvature(base, min), 2 * std::numbers::pi / (k * per_turn)));
}

bool follows_curvature(const SizeSpec& size) {
  return size.curvature > 0 ||
         std::ranges::any_of(size.named, [](const NamedSize& n) { return n.curvature > 0; });
}

namespace {

/// Size field with log delta linear on the background's triangles.
class BoundarySize final : public SizeField {
 public:
  BoundarySize(std::shared_ptr<const BackgroundMesh> background, std::vector<double> log_delta)
      : background_(std::move(background)), log_delta_(std::move(log_delta)) {}

  double at(const Vec3& x, int& hint) const override {
    const auto [t, b] = background_->locate({x.x, x.y}, hint);
    const auto& v = background_->triangles().triangles[t];
    return std::exp(b[0] * log_delta_[v[0]] + b[1] * log_delta_[v[1]] + b[2] * log_delta_[v[2]]);
  }

 private:
  std::shared_ptr<const BackgroundMesh> background_;
  std::vector<double> log_delta_;
};

/// Returns the mean length of the lines at each point; NaN without lines.
std::vector<double> mean_lengths(const Mesh& boundary) {
  std::vector<double> sum(boundary.points.size(), 0);
  std::vector<int> count(boundary.points.size(), 0);
  for (const auto& [a, b] : boundary.lines) {
    const double length = norm(boundary.points[b] - boundary.points[a]);
    for (const int v : {a, b}) {
      sum[v] += length;
      ++count[v];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
  return sum;
}

}  // namespace

std::unique_ptr<SizeField> make_boundary_size(std::shared_ptr<const BackgroundMesh> background,
                                              const Mesh& boundary) {
  const std::vector<double> length = mean_lengths(boundary);
  const auto& points = background->boundary_points();
  std::vector<char> fixed(points.size(), 0);
  std::vector<double> columns[] = {std::vector<double>(points.size(), 0)};
  std::vector<double>& log_delta = columns[0];
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto& p = points[v];
    if (p.from < 0) continue;
    for (const int node : {p.from, p.to}) {
      if (!is_size(length[node]))
        throw bad_size("the boundary's edge length", boundary.points[node], length[node]);
    }
    fixed[v] = 1;
    log_delta[v] = (1 - p.t) * std::log(length[p.from]) + p.t * std::log(length[p.to]);
  }
  solve_laplace(background->triangles(), background->triangles().triangles, fixed, columns);
  return std::make_unique<BoundarySize>(std::move(background), std::move(log_delta));
}

}  // namespace delquad
