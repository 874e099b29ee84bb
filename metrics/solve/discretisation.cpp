#include "metrics/solve/discretisation.h"

#include <fmt/format.h>

#include <cmath>

#include "base/disjoint_sets.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/shape.h"

namespace delquad {
namespace {

/// Their map from the square or triangle is not one to one, or has no inverse somewhere.
void check_elements(const Mesh& mesh) {
  const ElementSides sides(mesh);
  std::size_t quads = 0, triangles = 0;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    quads += quad_shape(mesh, static_cast<int>(q), sides).scaled_jacobian > 0 ? 0 : 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    triangles += triangle_shape(mesh, static_cast<int>(t), sides).scaled_jacobian > 0 ? 0 : 1;
  if (quads + triangles == 0) return;
  throw InputError(fmt::format("{} of {} quads and {} of {} triangles are inverted or degenerate", quads,
                               mesh.quads.size(), triangles, mesh.triangles.size()));
}

/// For each point one of its part of the mesh, the same for all of that part.
std::vector<int> parts_of(const Mesh& mesh) {
  DisjointSets parts(mesh.points.size());
  for_each_element(mesh, [&](int, const auto& v) {
    for (const int i : v) parts.join(v[0], i);
  });
  return parts.roots();
}

struct GaussPoint {
  double at, weight;
};

const std::vector<GaussPoint>& gauss_rule(int n) {
  static const std::vector<GaussPoint> two = {{-1 / std::sqrt(3.0), 1}, {1 / std::sqrt(3.0), 1}};
  static const std::vector<GaussPoint> three = {
      {-std::sqrt(0.6), 5.0 / 9}, {0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}};
  return n == 2 ? two : three;
}

ElementPoint point_of(const std::array<Vec3, 4>& corners, const GaussPoint& r, const GaussPoint& s) {
  constexpr std::array<std::array<int, 2>, 4> kSigns = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  ElementPoint p{0, {}, {}, {}, {}};
  std::array<double, 4> by_r, by_s;
  Vec3 along_r, along_s;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [i, j] = kSigns[k];
    p.value[k] = (1 + i * r.at) * (1 + j * s.at) / 4;
    by_r[k] = i * (1 + j * s.at) / 4;
    by_s[k] = j * (1 + i * r.at) / 4;
    p.at = p.at + p.value[k] * corners[k];
    along_r = along_r + by_r[k] * corners[k];
    along_s = along_s + by_s[k] * corners[k];
  }
  const Vec3 area = cross(along_r, along_s);
  const double density = norm(area);
  p.weight = r.weight * s.weight * density;
  p.normal = (1 / density) * area;
  // The dual basis of the tangents.
  const Vec3 dual_r = (1 / density) * cross(along_s, p.normal),
             dual_s = (1 / density) * cross(p.normal, along_r);
  for (std::size_t k = 0; k < 4; ++k) p.gradient[k] = by_r[k] * dual_r + by_s[k] * dual_s;
  return p;
}

}  // namespace

Discretisation::Discretisation(const Mesh& mesh)
    : mesh_(mesh),
      fixed_(mesh.points.size(), 0),
      row_(mesh.points.size(), -1),
      floating_part_(mesh.points.size(), -1) {
  if (mesh.triangles.empty() && mesh.quads.empty()) throw InputError("there are no elements to compute with");
  check_elements(mesh);
  for (const Vec3& p : mesh.points) planar_ = planar_ && p.z == mesh.points[0].z;
  number_nodes();
  if (n_free_ == 0) throw InputError("all nodes are on the boundary: there is nothing to solve for");
  find_floating();
}

void Discretisation::number_nodes() {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh_);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) fixed_[edge[0].lo] = fixed_[edge[0].hi] = 1;
  });
  std::vector<char> used(n_nodes(), 0);
  for_each_element(mesh_, [&](int, const auto& v) {
    for (const int i : v) used[i] = 1;
  });
  for (std::size_t i = 0; i < n_nodes(); ++i)
    if (used[i] && !fixed_[i]) row_[i] = static_cast<int>(n_free_++);
}

void Discretisation::find_floating() {
  const std::vector<int> part = parts_of(mesh_);
  std::vector<char> held(n_nodes(), 0);
  for (std::size_t i = 0; i < n_nodes(); ++i)
    if (fixed_[i]) held[part[i]] = 1;
  std::vector<int> number(n_nodes(), -1);
  for (std::size_t i = 0; i < n_nodes(); ++i) {
    if (row_[i] < 0 || held[part[i]]) continue;
    int& k = number[part[i]];
    if (k < 0) {
      k = static_cast<int>(floating_.size());
      floating_.emplace_back();
    }
    floating_[k].push_back(row_[i]);
    floating_part_[i] = k;
  }
}

std::vector<ElementPoint> element_points(const std::array<Vec3, 4>& corners, int n) {
  std::vector<ElementPoint> points;
  for (const GaussPoint& s : gauss_rule(n))
    for (const GaussPoint& r : gauss_rule(n)) points.push_back(point_of(corners, r, s));
  return points;
}

}  // namespace delquad
