#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"
#include "fields/fields.h"

namespace delquad {

namespace {

class FunctionCross final : public CrossField {
 public:
  FunctionCross(std::function<double(Vec2)> theta, std::string name)
      : theta_(std::move(theta)), name_(std::move(name)) {}
  Cross at(Vec2 u, int&) const override {
    const double theta = theta_(u);
    if (!std::isfinite(theta))
      throw InputError(fmt::format("{} is {} at {}; an angle must be finite", name_, theta, show_point(u)));
    return Cross::from_angle(theta);
  }

 private:
  std::function<double(Vec2)> theta_;
  std::string name_;
};

/// Where the gradient vanishes, the crosses lie along the axes.
class GradientCross final : public CrossField {
 public:
  GradientCross(std::shared_ptr<const SizeField> size, double step) : size_(std::move(size)), step_(step) {}
  Cross at(Vec2 u, int& hint) const override {
    const double dx = size_->at({u.x + step_, u.y, 0}, hint) - size_->at({u.x - step_, u.y, 0}, hint);
    const double dy = size_->at({u.x, u.y + step_, 0}, hint) - size_->at({u.x, u.y - step_, 0}, hint);
    return dx == 0 && dy == 0 ? Cross{} : Cross::along({dx, dy});
  }

 private:
  std::shared_ptr<const SizeField> size_;
  double step_;
};

}  // namespace

std::unique_ptr<CrossField> make_function_cross(std::function<double(Vec2)> theta, std::string name) {
  return std::make_unique<FunctionCross>(std::move(theta), std::move(name));
}

std::unique_ptr<CrossField> make_gradient_cross(std::shared_ptr<const SizeField> size, double step) {
  if (!std::isfinite(step) || step <= 0) {
    throw InputError(fmt::format("the gradient cross field's step is {}; expected a length > 0", step));
  }
  return std::make_unique<GradientCross>(std::move(size), step);
}

}  // namespace delquad
