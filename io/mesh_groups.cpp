#include "io/mesh_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "delquad/error.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

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

}  // namespace

std::vector<MeshGroup> mesh_groups(const Mesh& mesh, const UniqueLabels::Rules& rules) {
  std::vector<MeshGroup> groups;
  std::vector<int> regions = mesh.triangle_region;
  regions.insert(regions.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  add_groups(2, mesh.regions, regions, groups);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<int> curves = mesh.line_curve;
  for (std::size_t l = 0; l < curves.size(); ++l)
    if (mesh.curves[curves[l]].names.empty() &&
        sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).size() > 1)
      curves[l] = -1;
  add_groups(1, mesh.curves, curves, groups);
  std::vector<Entity> points;
  std::vector<int> of_point(mesh.points.size(), -1);
  for (const NamedPoint& named : mesh.named_points) {
    of_point[named.point] = static_cast<int>(points.size());
    points.push_back(named.entity);
  }
  add_groups(0, points, of_point, groups);
  std::vector<UniqueLabels::Key> keys;
  for (const MeshGroup& group : groups) keys.emplace_back(group.dim, group.name);
  const UniqueLabels labels(keys, rules);
  for (MeshGroup& group : groups) group.label = labels.of({group.dim, group.name});
  return groups;
}

std::vector<int> nodes_of_group(const Mesh& mesh, const MeshGroup& group) {
  std::vector<int> nodes;
  for (const int i : group.items) {
    if (group.dim == 0)
      nodes.push_back(i);
    else
      for (const int v : nodes_of_line(mesh, static_cast<std::size_t>(i))) nodes.push_back(v);
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<int> group_numbers(const std::vector<MeshGroup>& groups, int dim, std::size_t n_items) {
  std::vector<int> numbers(n_items, 0);
  for (const MeshGroup& group : groups)
    if (group.dim == dim)
      for (const int i : group.items) numbers[i] = group.number;
  return numbers;
}

std::vector<std::string> renamed_groups(const std::vector<MeshGroup>& groups) {
  constexpr std::array kKinds = {"point", "curve", "region"};
  std::vector<std::string> lines;
  for (const MeshGroup& group : groups)
    if (group.label != group.name)
      lines.push_back(fmt::format("{} \"{}\" is {}", kKinds[group.dim], one_line(group.name), group.label));
  return lines;
}

std::vector<ElementSide> sides_at_line(const Mesh& mesh, std::span<const HalfEdge> sides, int line) {
  std::vector<ElementSide> result;
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  for (const HalfEdge& side : sides_of_edge(sides, mesh.lines[line][0], mesh.lines[line][1])) {
    const auto place = [&](const auto& v) {
      return static_cast<int>(std::ranges::find(v, side.forward ? side.lo : side.hi) - v.begin());
    };
    result.push_back({side.element, side.element < n_triangles
                                        ? place(mesh.triangles[side.element])
                                        : place(mesh.quads[side.element - n_triangles])});
  }
  return result;
}

bool is_planar(const Mesh& mesh) {
  if (!std::ranges::all_of(mesh.points, [&](const Vec3& p) { return p.z == mesh.points[0].z; })) return false;
  double area = 0;
  for_each_element(mesh, [&](int, const auto& v) {
    for (std::size_t k = 0; k < v.size(); ++k)
      area += cross(mesh.points[v[k]], mesh.points[v[(k + 1) % v.size()]]).z;
  });
  return area >= 0;
}

void require_fits(const std::filesystem::path& path, const std::string& format, std::size_t n,
                  const std::string& what, std::size_t most) {
  if (n > most)
    throw InputError(fmt::format("{}: {} holds no numbers above {}: there are {} {}", path.string(), format,
                                 most, n, what));
}

void require_numbers(const std::filesystem::path& path, const std::string& format, const Mesh& mesh,
                     std::size_t most) {
  require_fits(path, format, mesh.points.size(), "nodes", most);
  require_fits(path, format, mesh.lines.size() + mesh.triangles.size() + mesh.quads.size(), "elements", most);
}

std::string one_line_label(const std::string& name) { return one_line(name); }

std::string cgns_label(const std::string& name) {
  std::string label = one_line(name);
  std::ranges::replace(label, '/', '_');
  return label;
}

std::string ascii_label(const std::string& name) {
  std::string label = one_line(name);
  for (char& c : label)
    if (static_cast<unsigned char>(c) > '~') c = '_';
  return label;
}

std::string plain_label(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  std::string label = name.empty() || !is_letter(name[0]) ? "SET_" : "";
  for (const char c : name) label += is_letter(c) || (c >= '0' && c <= '9') ? c : '_';
  return label;
}

}  // namespace delquad
