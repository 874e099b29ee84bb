#include "io/entity_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <tuple>

#include "base/located.h"
#include "base/sort_unique.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// UTF-8 text cut to so many bytes, not within a character.
std::string cut(const std::string& text, size_t longest) {
  if (text.size() <= longest) return text;
  size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

std::string_view without_return(std::string_view line) {
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

}  // namespace

std::string tag_label(int dim, int tag) {
  constexpr std::array kKinds = {"point_", "curve_", "region_", "volume_"};
  return kKinds.at(static_cast<size_t>(dim)) + std::to_string(tag);
}

std::map<std::string, std::vector<std::int32_t>> tags_of_names(const std::vector<Entity>& entities) {
  std::map<std::string, std::vector<std::int32_t>> tags;
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names) tags[name].push_back(entity.tag);
  return tags;
}

bool name_says(std::string name, std::string_view word) {
  for (char& c : name)
    if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return name.find(word) != std::string::npos;
}

std::string one_line(std::string_view name) {
  std::string text;
  for (const char c : name) text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  constexpr size_t kLongest = 200;
  return cut(text, kLongest);
}

std::vector<std::string> group_names(const std::vector<Entity>& entities, int dim) {
  std::map<std::string, size_t> holders;
  for (const Entity& entity : entities)
    for (const std::string& name : std::set(entity.names.begin(), entity.names.end())) ++holders[name];
  const auto says_little = [&](const std::string& name) {
    const size_t n = holders.at(name);
    return std::tuple(entities.size() > 1 && n == entities.size(), name.starts_with(kColourName), n);
  };
  std::vector<std::string> result;
  for (const Entity& entity : entities) {
    const auto best = std::ranges::min_element(
        entity.names, [&](const auto& a, const auto& b) { return says_little(a) < says_little(b); });
    result.push_back(best == entity.names.end() ? "" : *best);
  }
  for (size_t i = 0; i < entities.size(); ++i) {
    if (!entities[i].names.empty()) continue;
    const std::string label = tag_label(dim, entities[i].tag);
    result[i] = label;
    for (int k = 2; !holders.emplace(result[i], 1).second; ++k) result[i] = label + "_" + std::to_string(k);
  }
  return result;
}

UniqueLabels::UniqueLabels(const std::vector<Key>& keys, const Rules& rules) {
  const auto plain = [&](const Key& key) { return cut(rules.plain(key.second), rules.longest); };
  for (const Key& key : keys)
    if (plain(key) == key.second && !label_of_.contains(key) && take(key.second, rules.blind_to_case))
      label_of_[key] = key.second;
  for (const Key& key : keys) {
    if (label_of_.contains(key)) continue;
    const std::string label = plain(key);
    std::string candidate = label;
    for (int k = 2; !take(candidate, rules.blind_to_case); ++k) candidate = label + "_" + std::to_string(k);
    label_of_[key] = candidate;
    renamed_.emplace_back(key, candidate);
  }
}

bool UniqueLabels::take(const std::string& label, bool blind_to_case) {
  std::string text = label;
  for (char& c : text)
    if (blind_to_case && c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return taken_.insert(text).second;
}

bool NumberedEntities::take_name(std::string_view comment, std::string_view before, std::string_view after,
                                 int dim) {
  if (!comment.starts_with(before)) return false;
  comment.remove_prefix(before.size());
  long long number = 0;
  const auto [end, error] = std::from_chars(comment.data(), comment.data() + comment.size(), number);
  if (error != std::errc()) return false;
  comment.remove_prefix(static_cast<std::size_t>(end - comment.data()));
  if (!comment.starts_with(after)) return false;
  names_[{dim, number}].emplace_back(without_return(comment.substr(after.size())));
  return true;
}

int NumberedEntities::index(int dim, long long number, Mesh& mesh) {
  std::vector<Entity>& entities = dim == 1 ? mesh.curves : mesh.regions;
  const auto [it, is_new] = index_.emplace(std::pair{dim, number}, static_cast<int>(entities.size()));
  if (is_new) {
    const long long tag = number > 0 ? number : kMostNumber + 1 - number;
    entities.push_back({static_cast<int>(tag), names_[{dim, number}]});
  }
  return it->second;
}

std::string unit_in_comment(std::string_view comment, std::string_view mark) {
  const std::string before = std::string(mark) + " lengths in ";
  return comment.starts_with(before) ? std::string(without_return(comment.substr(before.size()))) : "";
}

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

std::vector<MeshGroup> with_labels(std::vector<MeshGroup> groups, const UniqueLabels::Rules& rules) {
  std::vector<UniqueLabels::Key> keys;
  for (const MeshGroup& group : groups) keys.emplace_back(group.dim, group.name);
  const UniqueLabels labels(keys, rules);
  for (MeshGroup& group : groups) group.label = labels.of({group.dim, group.name});
  return groups;
}

}  // namespace

std::vector<MeshGroup> mesh_groups(const Mesh& mesh, const UniqueLabels::Rules& rules) {
  std::vector<MeshGroup> groups;
  add_groups(3, mesh.volumes, mesh.hex_volume, groups);
  std::vector<int> regions = mesh.triangle_region;
  regions.insert(regions.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  add_groups(2, mesh.regions, regions, groups);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<int> curves = mesh.line_curve;
  for (std::size_t l = 0; l < curves.size(); ++l)
    if (mesh.hexahedra.empty() && mesh.curves[curves[l]].names.empty() &&
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
  return with_labels(std::move(groups), rules);
}

std::vector<int> nodes_of_group(const Mesh& mesh, const MeshGroup& group) {
  std::vector<int> nodes;
  for (const int i : group.items) {
    if (group.dim == 0)
      nodes.push_back(i);
    else if (group.dim == 2)
      nodes.insert(nodes.end(), mesh.quads[i].begin(), mesh.quads[i].end());
    else
      for (const int v : nodes_of_line(mesh, static_cast<std::size_t>(i))) nodes.push_back(v);
  }
  sort_unique(nodes);
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
  const bool is_solid = std::ranges::count(groups, 3, &MeshGroup::dim) > 0;
  const std::array kKinds = {"point", "curve", is_solid ? "face" : "region", "volume"};
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

void require_planar(const std::filesystem::path& path, const std::string& format, const Mesh& mesh) {
  if (!is_planar(mesh))
    refuse("{}: {} is for planar meshes: this is a surface in space, or looks down", path.string(), format);
}

void require_terrain(const std::filesystem::path& path, const std::string& format, const Mesh& mesh) {
  if (is_planar(mesh)) return;
  for_each_element(mesh, [&](int e, const auto& v) {
    double area = 0;
    for (std::size_t k = 1; k + 1 < v.size(); ++k)
      area += cross(mesh.points[v[k]] - mesh.points[v[0]], mesh.points[v[k + 1]] - mesh.points[v[0]]).z;
    if (!(area > 0))
      refuse("{}: {} is for planar meshes and heights over the plane: element {} is upright or looks down",
             path.string(), format, e + 1);
  });
}

void require_quads(const std::filesystem::path& path, const std::string& format, const Mesh& mesh) {
  if (!mesh.triangles.empty())
    refuse("{}: {} has quads only, and there are {} triangles", path.string(), format, mesh.triangles.size());
}

void require_fits(const std::filesystem::path& path, const std::string& format, std::size_t n,
                  const std::string& what, std::size_t most) {
  if (n > most)
    refuse("{}: {} holds no numbers above {}: there are {} {}", path.string(), format, most, n, what);
}

void require_numbers(const std::filesystem::path& path, const std::string& format, const Mesh& mesh,
                     std::size_t most) {
  require_fits(path, format, mesh.points.size(), "nodes", most);
  require_fits(path, format,
               mesh.lines.size() + mesh.triangles.size() + mesh.quads.size() + mesh.hexahedra.size(),
               "elements", most);
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

namespace {

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

}  // namespace

std::string word_label(const std::string& name) {
  constexpr std::string_view kMore = "0123456789_-.+@";
  std::string label = name.empty() ? "_" : name;
  for (char& c : label)
    if (!is_letter(c) && kMore.find(c) == std::string_view::npos) c = '_';
  return label;
}

std::string plain_label(const std::string& name) {
  std::string label = name.empty() || !is_letter(name[0]) ? "SET_" : "";
  for (const char c : name) label += is_letter(c) || (c >= '0' && c <= '9') ? c : '_';
  return label;
}

}  // namespace delquad
