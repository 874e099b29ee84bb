#include "metrics/solve/critical_step.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/shape.h"
#include "metrics/solve/discretisation.h"
#include "metrics/solve/linear_system.h"

namespace delquad {
namespace {

using StepVector = Eigen::VectorXd;

/// The stiffness of an element between its nodes; triangles have their third one twice.
struct StiffElement {
  std::array<int, 4> nodes;
  std::array<std::array<double, 4>, 4> stiffness{};
};

/// In the plane through its middle that its diagonals are parallel to.
std::array<Vec3, 4> flattened(std::array<Vec3, 4> p) {
  const Vec3 normal = area_vector(p), middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  const double n2 = dot(normal, normal);
  if (n2 > 0)
    for (Vec3& x : p) x = x - (dot(x - middle, normal) / n2) * normal;
  return p;
}

/// Adds its mass to those of its nodes. False where it is inverted at a point.
bool add_element(const std::array<Vec3, 4>& corners, StiffElement& element, StepVector& mass) {
  const std::array<Vec3, 4> flat = flattened(corners);
  const Vec3 normal = area_vector(flat);
  for (const ElementPoint& p : element_points(flat, 2)) {
    if (!(p.weight > 0) || !(dot(p.normal, normal) > 0)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      mass[element.nodes[i]] += p.weight * p.value[i];
      for (std::size_t j = 0; j < 4; ++j)
        element.stiffness[i][j] += p.weight * dot(p.gradient[i], p.gradient[j]);
    }
  }
  return true;
}

}  // namespace

double critical_step(const Mesh& mesh) {
  const auto n = static_cast<Eigen::Index>(mesh.points.size());
  StepVector mass = StepVector::Zero(n);
  std::vector<StiffElement> elements;
  bool is_sound = true;
  for_each_element(mesh, [&](int, const auto& v) {
    const std::array<int, 4> nodes = {v[0], v[1], v[2], v.back()};
    elements.push_back({nodes});
    is_sound &= add_element(corners_of(mesh, nodes), elements.back(), mass);
  });
  if (!is_sound) return 0;
  const StepVector scale =
      mass.unaryExpr([](double m) { return m > 0 ? 1 / std::sqrt(m) : 0.0; });  // 0: of no element
  const auto apply = [&](const StepVector& x) -> StepVector {
    const StepVector scaled = scale.cwiseProduct(x);
    StepVector y = StepVector::Zero(n);
    for (const auto& [v, stiffness] : elements)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) y[v[i]] += stiffness[i][j] * scaled[v[j]];
    return scale.cwiseProduct(y);
  };
  try {
    return 2 / std::sqrt(largest_eigenvalue(n, apply));
  } catch (const InputError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace delquad
