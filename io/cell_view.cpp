// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cell_view.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "base/located.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"
#include "io/mesh_formats.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

template <std::size_t N>
auto corners_in(const std::vector<std::array<int, N>>& elements) {
  return [&elements](std::size_t i) { return std::vector<int>(elements[i].begin(), elements[i].end()); };
}

/// Adds the groups of one dimension. `entity_of`: of each item; -1: it is in none.
void add_groups(int dim, const std::vector<Entity>& entities, const std::vector<int>& entity_of,
                std::vector<MeshGroup>& groups) {
  const std::vector<std::string> names = group_names(entities, dim);
  const std::size_t first = groups.size();
  std::map<std::string, std::size_t> at;
  for (std::size_t i = 0; i < entity_of.size(); ++i) {
    if (entity_of[i] < 0) continue;
    const std::string& name = names[entity_of[i]];
    const auto [found, is_new] = at.try_emplace(name, groups.size());
    if (is_new) groups.push_back({dim, static_cast<int>(groups.size() - first) + 1, name, "", {}});
    groups[found->second].items.push_back(static_cast<int>(i));
  }
}

std::vector<MeshGroup> with_labels(std::vector<MeshGroup> groups, const UniqueLabels::Rules& rules) {
  std::vector<UniqueLabels::Key> keys;
  for (const MeshGroup& group : groups) keys.emplace_back(group.dim, group.name);
  const UniqueLabels labels(keys, rules);
  for (MeshGroup& group : groups) group.label = labels.of({group.dim, group.name});
  return groups;
}

}  // namespace

bool has_eight_nodes(const Mesh& mesh) {
  return mesh.order == 2 && !mesh.quads.empty() && mesh.quad_nodes[4] == mesh.quads[0][0];
}

std::vector<int> places_on_sides(int order) {
  std::vector<int> places = gmsh_places(order);
  places.resize(4 * static_cast<std::size_t>(order));
  return places;
}

std::vector<char> are_in_middles(const Mesh& mesh) {
  std::vector<char> inside(mesh.points.size(), 0);
  for (std::size_t q = 0; q < mesh.quads.size() && mesh.order == 2; ++q)
    inside[nodes_of_quad(mesh, q)[4]] = 1;
  return inside;
}

void write_points_and_faces(TextWriter& out, const Mesh& mesh) {
  for (const Vec3& x : mesh.points) out << x.x << ' ' << x.y << ' ' << x.z << '\n';
  for_each_element(mesh, [&](int, const auto& v) {
    out << v.size();
    for (const int i : v) out << ' ' << i;
    out << '\n';
  });
}

std::vector<Entity> entities_of(const std::vector<NamedPoint>& points) {
  std::vector<Entity> entities;
  for (const NamedPoint& named : points) entities.push_back(named.entity);
  return entities;
}

int dimension_of(const Mesh& mesh) { return is_solid(mesh) ? 3 : 2; }

std::size_t n_cells(const Mesh& mesh, int dim) {
  return dim == 0   ? mesh.points.size()
         : dim == 1 ? mesh.lines.size()
         : dim == 2 ? mesh.triangles.size() + mesh.quads.size()
                    : n_solids(mesh);
}

std::vector<CellBlock> cell_blocks(const Mesh& mesh, std::vector<int> places) {
  if (places.empty()) places = gmsh_places(mesh.order);
  if (has_eight_nodes(mesh)) places.resize(8);
  const std::size_t of_line = static_cast<std::size_t>(mesh.order) + 1, of_quad = places.size();
  std::vector<CellBlock> blocks = {
      {CellShape::kLine, 1, of_line, 0, &mesh.line_curve, &mesh.curves,
       [&mesh](std::size_t i) { return nodes_ends_first(mesh, i); }},
      {CellShape::kTriangle, 2, 3, 0, &mesh.triangle_region, &mesh.regions, corners_in(mesh.triangles)},
      {CellShape::kQuad, 2, of_quad, mesh.triangles.size(), &mesh.quad_region, &mesh.regions,
       [&mesh, places = std::move(places)](std::size_t i) { return nodes_of_quad(mesh, i, places); }}};
  std::size_t first = 0;
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& cells, const auto& volumes) {
    blocks.push_back({shape.shape, 3, shape.n_corners, first, &volumes, &mesh.volumes, corners_in(cells)});
    first += cells.size();
  });
  std::erase_if(blocks, [](const CellBlock& cells) { return cells.size() == 0; });
  return blocks;
}

CellSide cell_side(const Mesh& mesh, const HalfEdge& edge) {
  const auto place = [&](const auto& v) {
    return static_cast<int>(std::ranges::find(v, edge.run()[0]) - v.begin());
  };
  const int quad = edge.element - static_cast<int>(mesh.triangles.size());
  return {edge.element, quad < 0 ? place(mesh.triangles[edge.element]) : place(mesh.quads[quad])};
}

void complete_faces(Mesh& mesh, ReadNotes* notes) {
  if (!is_solid(mesh)) return;
  if (mesh.order > 1) mesh = straightened(std::move(mesh));
  const std::vector<SolidSide> sides = sorted_sides(mesh);
  const auto outward = [&](const SolidSide& side) {
    return solid_at(mesh, static_cast<std::size_t>(side.side.element)).side(side.side.side);
  };
  std::vector<char> has_face(sides.size(), 0);
  const std::size_t n_faces = n_cells(mesh, 2);
  const auto keep = [&](auto& faces, std::vector<int>& regions) {
    std::size_t kept = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto at = std::ranges::equal_range(sides, side_key(faces[f]), {}, &SolidSide::nodes);
      if (at.empty()) continue;
      has_face[at.begin() - sides.begin()] = 1;
      std::array<int, 4> nodes{-1, -1, -1, -1};
      std::ranges::copy(faces[f], nodes.begin());
      faces[kept] = faces[f];
      if (at.size() == 1 && !same_turn(outward(at.front()), nodes))
        std::reverse(faces[kept].begin() + 1, faces[kept].end());
      regions[kept++] = regions[f];
    }
    faces.resize(kept);
    regions.resize(kept);
  };
  keep(mesh.triangles, mesh.triangle_region);
  keep(mesh.quads, mesh.quad_region);
  const std::size_t kept = n_cells(mesh, 2);
  if (notes != nullptr && kept < n_faces)
    notes->push_back(
        fmt::format("triangles and quads that are no sides of cells are left out: {}", n_faces - kept));
  int tag = 0;
  for (const Entity& region : mesh.regions) tag = std::max(tag, region.tag);
  const int region = static_cast<int>(mesh.regions.size());
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].nodes == sides[i].nodes) ++end;
    const auto [a, b, c, d] = outward(sides[i]);
    if (end - i > 2)
      refuse("{} cells share the side at {}: expected two at most", end - i, show_point(mesh.points[a]));
    if (end - i == 2 || has_face[i]) continue;
    if (d < 0) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangle_region.push_back(region);
    } else {
      mesh.quads.push_back({a, b, c, d});
      mesh.quad_region.push_back(region);
    }
  }
  if (n_cells(mesh, 2) > kept) mesh.regions.push_back({tag + 1, {}});
  drop_unused_points(mesh);
}

CellSides::CellSides(const Mesh& mesh) : mesh_(mesh), of_cells_(sorted_sides(mesh)) {
  if (!is_solid(mesh)) of_faces_ = sorted_half_edges(mesh);
}

std::vector<CellSide> CellSides::at(int item) const {
  std::vector<CellSide> sides;
  if (is_solid(mesh_)) {
    const int quad = item - static_cast<int>(mesh_.triangles.size());
    const auto key = quad < 0 ? side_key(mesh_.triangles[item]) : side_key(mesh_.quads[quad]);
    for (const SolidSide& side : std::ranges::equal_range(of_cells_, key, {}, &SolidSide::nodes))
      sides.push_back(side.side);
    return sides;
  }
  for (const HalfEdge& edge : sides_of_edge(of_faces_, mesh_.lines[item][0], mesh_.lines[item][1]))
    sides.push_back(cell_side(mesh_, edge));
  return sides;
}

std::vector<MeshGroup> mesh_groups(const Mesh& mesh, const UniqueLabels::Rules& rules) {
  std::vector<MeshGroup> groups;
  std::vector<int> of_cells;
  for_each_shape(mesh, [&](const SolidShape&, const auto&, const auto& volumes) {
    of_cells.insert(of_cells.end(), volumes.begin(), volumes.end());
  });
  add_groups(3, mesh.volumes, of_cells, groups);
  std::vector<int> regions = mesh.triangle_region;
  regions.insert(regions.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  add_groups(2, mesh.regions, regions, groups);
  std::vector<int> curves = mesh.line_curve;
  if (!is_solid(mesh)) {
    const CellSides sides(mesh);
    for (std::size_t l = 0; l < curves.size(); ++l)
      if (mesh.curves[curves[l]].names.empty() && sides.at(static_cast<int>(l)).size() > 1) curves[l] = -1;
  }
  add_groups(1, mesh.curves, curves, groups);
  std::vector<int> of_point(mesh.points.size(), -1);
  for (std::size_t i = 0; i < mesh.named_points.size(); ++i)
    of_point[mesh.named_points[i].point] = static_cast<int>(i);
  add_groups(0, entities_of(mesh.named_points), of_point, groups);
  return with_labels(std::move(groups), rules);
}

std::vector<int> nodes_of_group(const Mesh& mesh, const MeshGroup& group) {
  std::vector<int> nodes = group.dim == 0 ? group.items : std::vector<int>();
  for (const CellBlock& cells : cell_blocks(mesh))
    for (const std::size_t i : items_in_block(group, cells))
      for (const int v : cells.nodes(i)) nodes.push_back(v);
  sort_unique(nodes);
  return nodes;
}

std::vector<std::size_t> items_in_block(const MeshGroup& group, const CellBlock& cells) {
  std::vector<std::size_t> items;
  for (const int item : group.items)
    if (const std::size_t i = static_cast<std::size_t>(item) - cells.first;
        group.dim == cells.dim && i < cells.size())
      items.push_back(i);
  return items;
}

std::vector<int> group_numbers(const Mesh& mesh, const std::vector<MeshGroup>& groups, int dim) {
  std::vector<int> numbers(n_cells(mesh, dim), 0);
  for (const MeshGroup& group : groups)
    if (group.dim == dim)
      for (const int i : group.items) numbers[i] = group.number;
  return numbers;
}

std::vector<std::string> renamed_groups(const std::vector<MeshGroup>& groups) {
  const bool is_solid = std::ranges::count(groups, 3, &MeshGroup::dim) > 0;
  const std::array kKinds = {"point", "curve", is_solid ? "face" : "region", "volume"};
  std::vector<std::string> lines;
  for (const MeshGroup& group : groups)
    if (group.label != group.name)
      lines.push_back(fmt::format("{} \"{}\" is {}", kKinds[group.dim], one_line(group.name), group.label));
  return lines;
}

}  // namespace delquad
