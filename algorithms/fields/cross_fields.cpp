// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/fields.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "algorithms/fields/laplace.h"
#include "algorithms/fields/singularities.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {

namespace {

class FunctionCross final : public CrossField {
 public:
  FunctionCross(std::function<double(Vec2)> theta, std::string name)
      : theta_(std::move(theta)), name_(std::move(name)) {}
  Cross at(Vec2 u, int&) const override {
    const double theta = theta_(u);
    if (!std::isfinite(theta))
      throw InputError(fmt::format("{} is {} at {}: expected a finite angle", name_, theta, show_point(u)));
    return Cross::from_angle(theta);
  }

 private:
  std::function<double(Vec2)> theta_;
  std::string name_;
};

/// Cross field along the gradient of the size, or along the axes where the gradient vanishes.
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
    throw InputError(fmt::format("the gradient cross field's step is {}: expected a length > 0", step));
  }
  return std::make_unique<GradientCross>(std::move(size), step);
}

struct HarmonicCrossField::Data {
  std::shared_ptr<const BackgroundMesh> background;
  std::vector<std::array<Cross, 3>>
      crosses;  ///< crosses of each triangle at the middle of the side opposite to each vertex
};

HarmonicCrossField::HarmonicCrossField(std::shared_ptr<const BackgroundMesh> background)
    : data_(std::make_unique<Data>()) {
  const TriPatch& tri = background->triangles();
  const Sides sides = number_sides(tri);
  std::vector<char> fixed(sides.count, 0);
  std::vector<double> z[] = {std::vector<double>(sides.count, 0), std::vector<double>(sides.count, 0)};
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] >= 0) continue;
      const int side = sides.of_triangle[t][k], from = tri.triangles[t][(k + 1) % 3];
      const Cross along = Cross::along(background->boundary_points()[from].tangent);
      fixed[side] = 1;
      z[0][side] = along.c;
      z[1][side] = along.s;
    }
  }
  solve_laplace(tri, sides.of_triangle, fixed, z);

  std::vector<Cross> crosses;
  crosses.reserve(sides.count);
  for (int i = 0; i < sides.count; ++i) crosses.push_back({z[0][i], z[1][i]});
  topology_ = find_singularities(*background, sides, crosses, find_winding(*background, sides, crosses));
  data_->crosses.reserve(tri.triangles.size());
  for (const auto& [a, b, c] : sides.of_triangle)
    data_->crosses.push_back({crosses[a], crosses[b], crosses[c]});
  data_->background = std::move(background);
}

HarmonicCrossField::~HarmonicCrossField() = default;

Cross HarmonicCrossField::at(Vec2 u, int& hint) const {
  const auto [t, b] = data_->background->locate(u, hint);
  const auto& z = data_->crosses[t];
  Cross sum{0, 0};
  for (int k = 0; k < 3; ++k) {
    sum.c += (1 - 2 * b[k]) * z[k].c;
    sum.s += (1 - 2 * b[k]) * z[k].s;
  }
  return sum;
}

}  // namespace delquad
