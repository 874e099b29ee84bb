#include "delquad/fields.h"

#include <fmt/format.h>

#include "delquad/model.h"
#include "fields/fields.h"
#include "io/cases/expression.h"

namespace delquad {

std::unique_ptr<SizeField> make_expression_size(const std::string& text) {
  const Expression delta(text, {"x", "y", "z"});
  return make_function_size(
      [delta](const Vec3& x) {
        const double values[] = {x.x, x.y, x.z};
        return delta(values);
      },
      fmt::format("size field '{}'", delta.shown()));
}

std::unique_ptr<CrossField> make_expression_cross(const std::string& text) {
  const Expression theta(text, {"x", "y", "z"});
  return make_function_cross(
      [theta](Vec2 u) {
        const double values[] = {u.x, u.y, 0};
        return theta(values);
      },
      fmt::format("cross field '{}'", theta.shown()));
}

std::shared_ptr<const Curve> make_expression_curve(const std::string& x_text, const std::string& y_text,
                                                   double t0, double t1) {
  const Expression x(x_text, {"t"}), y(y_text, {"t"});
  return make_parametric_curve(
      [x, y](double t) {
        const double value[] = {t};
        return Vec2{x(value), y(value)};
      },
      t0, t1);
}

}  // namespace delquad
