// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_mesh.h"

#include <fmt/format.h>

#include <cmath>

#include "delquad/error.h"
#include "geometry/mesh/cell_shapes.h"

namespace delquad {

namespace {

template <std::size_t N>
void check_elements(const std::vector<std::array<int, N>>& elements, const std::vector<int>& entity_of,
                    std::size_t n_points, std::size_t n_entities, const char* kind, const char* entity,
                    const std::string& where) {
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (const int v : elements[i])
      if (v < 0 || v >= static_cast<int>(n_points))
        throw InputError(
            fmt::format("{}: {} {} has point {}: there are {}, counted from 0", where, kind, i, v, n_points));
  if (entity_of.size() != elements.size())
    throw InputError(fmt::format("{}: {} {}s, but {} numbers that say of which {} they are", where,
                                 elements.size(), kind, entity_of.size(), entity));
  for (std::size_t i = 0; i < entity_of.size(); ++i)
    if (entity_of[i] < 0 || entity_of[i] >= static_cast<int>(n_entities))
      throw InputError(fmt::format("{}: {} {} is of {} {}: there are {}, counted from 0", where, kind, i,
                                   entity, entity_of[i], n_entities));
}

/// Checks the further nodes of curved elements, `each` for every element.
void check_further(const std::vector<int>& nodes, std::size_t n_elements, int each, std::size_t n_points,
                   const char* kind, const std::string& where) {
  if (nodes.size() != n_elements * static_cast<std::size_t>(each))
    throw InputError(fmt::format("{}: {} {}s of a higher order, but {} further nodes: expected {} for each",
                                 where, n_elements, kind, nodes.size(), each));
  for (const int v : nodes)
    if (v < 0 || v >= static_cast<int>(n_points))
      throw InputError(
          fmt::format("{}: a {} has point {}: there are {}, counted from 0", where, kind, v, n_points));
}

}  // namespace

void require_straight(const Mesh& mesh, const std::string& where) {
  if (is_solid(mesh))
    throw InputError(fmt::format(
        "{}: the mesh has {}: expected quads and triangles alone; 'metrics', 'convert' and 'view' take cells",
        where, solid_at(mesh, 0).shape->plural));
  if (mesh.order > 1)
    throw InputError(
        fmt::format("{}: the mesh has elements of order {}: expected straight ones, of order 1; 'delquad "
                    "convert' to .obj writes their corners alone [curved-elements]",
                    where, mesh.order));
}

void require_readable(const Mesh& mesh, const std::string& where) {
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw InputError(
          fmt::format("{}: point {} is ({}, {}, {}): expected finite coordinates", where, i, p.x, p.y, p.z));
  }
  const std::size_t n = mesh.points.size();
  check_elements(mesh.lines, mesh.line_curve, n, mesh.curves.size(), "line", "curve", where);
  check_elements(mesh.triangles, mesh.triangle_region, n, mesh.regions.size(), "triangle", "region", where);
  check_elements(mesh.quads, mesh.quad_region, n, mesh.regions.size(), "quad", "region", where);
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& cells, const auto& volumes) {
    check_elements(cells, volumes, n, mesh.volumes.size(), shape.name, "volume", where);
  });
  if (mesh.order < 1 || mesh.order > kMostOrder || (mesh.order > 1 && !mesh.triangles.empty()))
    throw InputError(
        fmt::format("{}: elements of order {} and {} triangles: expected orders 1 to {}, above 1 of "
                    "lines and quads alone",
                    where, mesh.order, mesh.triangles.size(), kMostOrder));
  check_further(mesh.line_nodes, mesh.lines.size(), mesh.order - 1, n, "line", where);
  check_further(mesh.quad_nodes, mesh.quads.size(), (mesh.order + 1) * (mesh.order + 1) - 4, n, "quad",
                where);
  for (const NamedPoint& named : mesh.named_points)
    if (named.point < 0 || named.point >= static_cast<int>(n))
      throw InputError(
          fmt::format("{}: a name is for point {}: there are {}, counted from 0", where, named.point, n));
}

}  // namespace delquad
