#include "metrics/solve/discretisation.h"

#include <fmt/format.h>

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

}  // namespace delquad
