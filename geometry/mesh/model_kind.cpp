// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/model_kind.h"

#include <cmath>
#include <limits>
#include <variant>

#include "geometry/mesh/half_edges.h"

namespace delquad {
namespace {

/// Given elements whose z differ by less, in parts of the diagonal, lie in the plane.
constexpr double kGivenRounding = 1e-9;

ModelKind kind(const PlanarModel&) { return {.in_plane = true}; }
ModelKind kind(const LineModel& lines) { return {.in_plane = true, .kept = &lines.source}; }
ModelKind kind(const GivenMesh& given) { return {!is_in_space(given.mesh), true, &given.source}; }
ModelKind kind(const auto&) { return {}; }

}  // namespace

ModelKind kind_of(const Model& model) {
  return std::visit([](const auto& m) { return kind(m); }, model);
}

bool is_in_space(const Mesh& mesh) {
  const double tolerance = kGivenRounding * diagonal(mesh);
  bool differs = false;
  double z = std::numeric_limits<double>::quiet_NaN();
  for_each_element(mesh, [&](int, const auto& v) {
    for (const int i : v) {
      if (std::isnan(z)) z = mesh.points[i].z;
      differs = differs || std::abs(mesh.points[i].z - z) > tolerance;
    }
  });
  return differs;
}

}  // namespace delquad
