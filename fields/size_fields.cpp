#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"
#include "fields/check_size.h"
#include "fields/fields.h"

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
    throw InputError(fmt::format("size source {}: sizes {} and {}; a size must be finite and positive",
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
      fmt::format("{} is {} at {}; a size must be finite and positive", field, shown, show_point(x)));
}

std::unique_ptr<SizeField> make_constant_size(double delta) {
  if (!is_size(delta))
    throw InputError(fmt::format("the size is {}; a size must be finite and positive", delta));
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
    throw InputError(fmt::format("the largest size is {}; a size must be finite and positive", most));
  return std::make_unique<CappedSize>(std::move(base), most);
}

void check_size_limits(double curvature, double min, double max, const std::string& where) {
  if (min > 0 && !(curvature > 0))
    throw InputError(where + ": a least size is for sizes that follow curvature: expected 'curvature' too");
  if (min > 0 && max > 0 && min > max)
    throw InputError(fmt::format("{}: the least size {} is larger than the largest, {}", where, min, max));
}

}  // namespace delquad
