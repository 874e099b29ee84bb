// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "algorithms/fields/check_size.h"
#include "algorithms/fields/fields.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/fields.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {

namespace {

/// Returns the triangles of a mesh, and each quad as two.
std::vector<std::array<int, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<int, 3>> triangles = mesh.triangles;
  for (const auto& [a, b, c, d] : mesh.quads) triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
  return triangles;
}

/// Finds points in the mesh with the data.
class Nodes {
 public:
  explicit Nodes(const Mesh& mesh) : triangles_(mesh.points, triangles_of(mesh)) {}

  struct Found {
    const std::array<int, 3>& nodes;
    std::array<double, 3> weights;
  };
  Found at(const Vec3& x, int& hint) const {
    const auto found = triangles_.find_from(hint, x);
    hint = found.triangle;
    return {triangles_.triangle(found.triangle), found.weights};
  }

 private:
  NearestTriangle triangles_;
};

class NodalSize final : public SizeField {
 public:
  NodalSize(const Mesh& mesh, std::vector<double> delta) : nodes_(mesh), delta_(std::move(delta)) {}
  double at(const Vec3& x, int& hint) const override {
    const auto [v, w] = nodes_.at(x, hint);
    return w[0] * delta_[v[0]] + w[1] * delta_[v[1]] + w[2] * delta_[v[2]];
  }

 private:
  Nodes nodes_;
  std::vector<double> delta_;
};

class NodalCross final : public CrossField {
 public:
  NodalCross(const Mesh& mesh, std::vector<Cross> crosses) : nodes_(mesh), crosses_(std::move(crosses)) {}
  Cross at(Vec2 u, int& hint) const override {
    const auto [v, w] = nodes_.at({u.x, u.y, 0}, hint);
    Cross sum{0, 0};
    for (int k = 0; k < 3; ++k) {
      const Cross& cross = crosses_[v[k]];
      sum = sum + Cross{w[k] * cross.c, w[k] * cross.s};
    }
    return sum;
  }

 private:
  Nodes nodes_;
  std::vector<Cross> crosses_;
};

/// Throws InputError unless the mesh has elements, and a value for each point. `what` is "size", "cross" or
/// "metric".
void check_nodal(const Mesh& mesh, std::size_t n_values, const std::string& what) {
  const std::string where = "the mesh of the nodal " + what;
  require_readable(mesh, where);
  if (mesh.triangles.empty() && mesh.quads.empty())
    throw InputError(where + " has neither triangles nor quads");
  if (n_values != mesh.points.size())
    throw InputError(fmt::format("{} has {} points, but there are {} values: expected one for each", where,
                                 mesh.points.size(), n_values));
}

}  // namespace

std::unique_ptr<SizeField> make_nodal_size(const Mesh& mesh, std::vector<double> delta) {
  check_nodal(mesh, delta.size(), "size");
  for (std::size_t i = 0; i < delta.size(); ++i)
    if (!is_size(delta[i])) throw bad_size(fmt::format("the nodal size {}", i), mesh.points[i], delta[i]);
  return std::make_unique<NodalSize>(mesh, std::move(delta));
}

std::unique_ptr<CrossField> make_nodal_cross(const Mesh& mesh, std::vector<double> theta) {
  check_nodal(mesh, theta.size(), "cross");
  Mesh flat = mesh;
  std::vector<Cross> crosses;
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const Vec3 p = mesh.points[i];
    if (p.z != mesh.points[0].z)
      throw InputError(
          fmt::format("the mesh of the nodal cross is not planar: point {} has z = {}, point 0 {}", i, p.z,
                      mesh.points[0].z));
    if (!std::isfinite(theta[i]))
      throw InputError(fmt::format("the nodal angle {} is {} at {}: expected a finite angle", i, theta[i],
                                   show_point(Vec2{p.x, p.y})));
    flat.points[i].z = 0;
    crosses.push_back(Cross::from_angle(theta[i]));
  }
  return std::make_unique<NodalCross>(flat, std::move(crosses));
}

SpaceMetricFunction make_nodal_space_metric(const Mesh& mesh, std::vector<Tensor3> metric) {
  check_nodal(mesh, metric.size(), "metric");
  const auto matrix = [](const Tensor3& m) {
    Eigen::Matrix3d a;
    a << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
    return a;
  };
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  std::vector<Eigen::Matrix3d> logs;
  for (std::size_t i = 0; i < metric.size(); ++i) {
    if (!matrix(metric[i]).allFinite() || !(Solver(matrix(metric[i])).eigenvalues()[0] > 0))
      throw InputError(fmt::format(
          "the nodal metric {} at {} is not finite and positive definite: expected eigenvalues above 0", i,
          show_point(mesh.points[i])));
    const Solver solver(matrix(metric[i]));
    logs.emplace_back(solver.eigenvectors() * solver.eigenvalues().array().log().matrix().asDiagonal() *
                      solver.eigenvectors().transpose());
  }
  return [nodes = std::make_shared<const Nodes>(mesh), logs = std::move(logs)](std::span<const Vec3> points,
                                                                               std::span<Tensor3> at) {
    int hint = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [v, w] = nodes->at(points[i], hint);
      const Solver solver(w[0] * logs[v[0]] + w[1] * logs[v[1]] + w[2] * logs[v[2]]);
      const Eigen::Matrix3d m = solver.eigenvectors() *
                                solver.eigenvalues().array().exp().matrix().asDiagonal() *
                                solver.eigenvectors().transpose();
      at[i] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    }
  };
}

MetricFunction make_nodal_metric(const Mesh& mesh, std::vector<Tensor2> metric) {
  check_nodal(mesh, metric.size(), "metric");
  Mesh flat = mesh;
  for (Vec3& p : flat.points) p.z = 0;
  for (std::size_t i = 0; i < metric.size(); ++i)
    if (!is_metric(metric[i]))
      throw InputError(
          fmt::format("the nodal metric {} is [{:.6g}, {:.6g}, {:.6g}] (m11, m12, m22) at {}: expected a "
                      "finite, positive "
                      "definite tensor whose lengths differ by a factor of less than {:g}",
                      i, metric[i].xx, metric[i].xy, metric[i].yy,
                      show_point(Vec2{mesh.points[i].x, mesh.points[i].y}), kMostAspect));
  return [nodes = std::make_shared<const Nodes>(flat), metric = std::move(metric)](
             std::span<const Vec2> points, std::span<Tensor2> at) {
    int hint = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [v, w] = nodes->at({points[i].x, points[i].y, 0}, hint);
      at[i] = log_mean(std::array{metric[v[0]], metric[v[1]], metric[v[2]]}, w);
    }
  };
}

}  // namespace delquad
