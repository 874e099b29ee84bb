#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "fields/fields.h"
#include "geometry/expression.h"
#include "mesh/error.h"

namespace delquad {

namespace {

class ExpressionCross final : public CrossField {
 public:
  explicit ExpressionCross(const std::string& text) : theta_(text, {"x", "y", "z"}) {}
  Cross at(Vec2 u, int&) const override {
    const double values[] = {u.x, u.y, 0};
    const double theta = theta_(values);
    if (!std::isfinite(theta)) {
      throw InputError(fmt::format("cross field '{}' is {} at ({:.6g}, {:.6g}); an angle must be finite",
                                   theta_.shown(), theta, u.x, u.y));
    }
    return Cross::from_angle(theta);
  }

 private:
  Expression theta_;
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

std::unique_ptr<CrossField> make_expression_cross(const std::string& expression) {
  return std::make_unique<ExpressionCross>(expression);
}

std::unique_ptr<CrossField> make_gradient_cross(std::shared_ptr<const SizeField> size, double step) {
  if (!std::isfinite(step) || step <= 0) {
    throw InputError(fmt::format("the gradient cross field's step is {}; expected a length > 0", step));
  }
  return std::make_unique<GradientCross>(std::move(size), step);
}

}  // namespace delquad
