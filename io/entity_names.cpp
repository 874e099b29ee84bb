// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/entity_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <tuple>

#include "base/located.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/half_edges.h"

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

bool name_contains(std::string name, std::string_view word) {
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
    if (plain(key) == key.second && !label_of_.contains(key) && take(key.second, rules.ignores_case))
      label_of_[key] = key.second;
  for (const Key& key : keys) {
    if (label_of_.contains(key)) continue;
    const std::string label = plain(key);
    std::string candidate = label;
    for (int k = 2; !take(candidate, rules.ignores_case); ++k) candidate = label + "_" + std::to_string(k);
    label_of_[key] = candidate;
    renamed_.emplace_back(key, candidate);
  }
}

bool UniqueLabels::take(const std::string& label, bool ignores_case) {
  std::string text = label;
  for (char& c : text)
    if (ignores_case && c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
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
    refuse("{}: {} is for planar meshes: this is a surface in space, or looks down [planar-format]",
           path.string(), format);
}

void require_terrain(const std::filesystem::path& path, const std::string& format, const Mesh& mesh) {
  if (is_planar(mesh)) return;
  for_each_element(mesh, [&](int e, const auto& v) {
    double area = 0;
    for (std::size_t k = 1; k + 1 < v.size(); ++k)
      area += cross(mesh.points[v[k]] - mesh.points[v[0]], mesh.points[v[k + 1]] - mesh.points[v[0]]).z;
    if (!(area > 0))
      refuse(
          "{}: {} is for planar meshes and heights over the plane: element {} is upright or looks down "
          "[planar-format]",
          path.string(), format, e + 1);
  });
}

void require_quads(const std::filesystem::path& path, const std::string& format, const Mesh& mesh) {
  if (!mesh.triangles.empty())
    refuse("{}: {} has quads only, and there are {} triangles [quads-only]", path.string(), format,
           mesh.triangles.size());
}

void require_fits(const std::filesystem::path& path, const std::string& format, std::size_t n,
                  const std::string& what, std::size_t most) {
  if (n > most)
    refuse("{}: {} holds no numbers above {}: there are {} {}, expected a coarser mesh", path.string(),
           format, most, n, what);
}

void require_numbers(const std::filesystem::path& path, const std::string& format, const Mesh& mesh,
                     std::size_t most) {
  require_fits(path, format, mesh.points.size(), "nodes", most);
  require_fits(path, format, mesh.lines.size() + mesh.triangles.size() + mesh.quads.size() + n_solids(mesh),
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

namespace {

void take_numbers(std::vector<Entity>& entities, int dim) {
  std::map<std::string, std::vector<int>> holders;
  for (size_t i = 0; i < entities.size(); ++i)
    for (const std::string& name : entities[i].names) holders[name].push_back(static_cast<int>(i));
  std::map<int, int> of_tag;
  const std::string prefix = tag_label(dim, 0).substr(0, tag_label(dim, 0).size() - 1);
  for (const auto& [name, held] : holders) {
    if (held.size() != 1 || !name.starts_with(prefix)) continue;
    int tag = 0;
    const auto [end, error] = std::from_chars(name.data() + prefix.size(), name.data() + name.size(), tag);
    Entity& entity = entities[held[0]];
    const bool is_first = std::ranges::none_of(of_tag, [&](const auto& t) { return t.second == held[0]; });
    if (error != std::errc() || tag < 1 || name != tag_label(dim, tag) || !is_first) continue;
    of_tag[tag] = held[0];
    entity.tag = tag;
    std::erase(entity.names, name);
  }
  int next = of_tag.empty() ? 0 : of_tag.rbegin()->first;
  std::set<int> known;
  for (const auto& [tag, entity] : of_tag) known.insert(entity);
  for (size_t i = 0; i < entities.size() && !of_tag.empty(); ++i)
    if (!known.contains(static_cast<int>(i))) entities[i].tag = ++next;
}

}  // namespace

void take_numbers(Mesh& mesh) {
  take_numbers(mesh.curves, 1);
  take_numbers(mesh.regions, 2);
  take_numbers(mesh.volumes, 3);
}

}  // namespace delquad
