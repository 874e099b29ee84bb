// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "io/face_reader.h"
#include "io/formats/msh.h"
#include "io/formats/msh_raw.h"
#include "io/mesh_io.h"
#include "io/nodal_values.h"

namespace delquad {

namespace msh {

namespace {

/// Groups of each element that is kept (ascending tags); elements listed once more for another group are
/// marked.
std::vector<std::vector<int>> groups_of_elements(const std::vector<Element>& elements,
                                                 std::vector<char>& repeats) {
  std::vector<Element> keys = elements;
  for (Element& e : keys) std::sort(e.nodes.begin(), e.nodes.begin() + e.n_nodes());
  const auto key = [&](int i) { return std::tie(keys[i].shape, keys[i].entity, keys[i].nodes); };
  std::vector<int> order(elements.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](int i, int j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });

  std::vector<std::vector<int>> groups(elements.size());
  repeats.assign(elements.size(), 0);
  for (size_t at = 0; at < order.size();) {
    const int first = order[at];
    std::vector<int>& all = groups[first];
    for (; at < order.size() && key(order[at]) == key(first); ++at) {
      const int physical = elements[order[at]].physical;
      if (std::find(all.begin(), all.end(), physical) == all.end()) {
        all.push_back(physical);
        repeats[order[at]] = order[at] != first;
      } else {
        groups[order[at]] = {physical};  // a true twin, which stays for others to complain about
      }
    }
    std::sort(all.begin(), all.end());
  }
  for (auto& all : groups) std::erase(all, 0);
  return groups;
}

int node_index(const std::vector<Node>& sorted, long long tag) {
  // Tags mostly run without gaps.
  const long long guess = tag - sorted.front().tag;
  if (guess >= 0 && guess < static_cast<long long>(sorted.size()) && sorted[guess].tag == tag) {
    return static_cast<int>(guess);
  }
  const auto it = std::lower_bound(sorted.begin(), sorted.end(), tag,
                                   [](const Node& node, long long t) { return node.tag < t; });
  return it != sorted.end() && it->tag == tag ? static_cast<int>(it - sorted.begin()) : -1;
}

/// Names of a point element's entity, or of its own group.
std::vector<std::string> point_names(const Contents& contents, const Point& point) {
  if (point.physical == 0) return names_of(contents, DimTag{0, point.entity});
  const auto name = contents.physical_names.find({0, point.physical});
  return {name != contents.physical_names.end() ? name->second : std::to_string(point.physical)};
}

/// Curves, regions and volumes in the order in which elements first name them.
class EntityTable {
 public:
  EntityTable(const Contents& contents, Mesh& mesh) : contents_(contents), mesh_(mesh) {}

  int index(int dim, int tag) {
    if (dim == last_.first && tag == last_.second) return last_index_;
    std::vector<Entity>& entities = entities_of(mesh_, dim);
    const auto [it, is_new] = index_.emplace(DimTag{dim, tag}, static_cast<int>(entities.size()));
    if (is_new) entities.push_back({tag, names_of(contents_, {dim, tag})});
    last_ = {dim, tag};
    last_index_ = it->second;
    return last_index_;
  }

 private:
  const Contents& contents_;
  Mesh& mesh_;
  std::map<DimTag, int> index_;
  DimTag last_{-1, -1};
  int last_index_ = -1;
};

/// Some programs write elements without an entity: these get the first free number.
void check_tags(Contents& contents, const TextScanner& scanner) {
  for (size_t i = 1; i < contents.nodes.size(); ++i) {
    const Node &a = contents.nodes[i - 1], &b = contents.nodes[i];
    if (a.tag != b.tag) continue;
    scanner.fail_at(std::max(a.line, b.line), "node tag {} is used twice (first on line {})", a.tag,
                    std::min(a.line, b.line));
  }
  int largest = 0;
  for (const Element& e : contents.elements) {
    if (e.entity < 0) scanner.fail_at(e.line, "entity tag {}: expected a positive one", e.entity);
    largest = std::max(largest, e.entity);
  }
  for (Element& e : contents.elements)
    if (e.entity == 0) e.entity = largest + 1;
}

/// Tags of nodes become places in their sorted list. 0 for those that something needs, -1 for others.
std::vector<int> find_nodes(Contents& contents, const TextScanner& scanner) {
  std::vector<int> is_needed(contents.nodes.size(), -1);
  const auto find = [&](long long& tag, int line) {
    const int i = node_index(contents.nodes, tag);
    if (i < 0) scanner.fail_at(line, "there is no node with tag {}", tag);
    tag = i;
    is_needed[i] = 0;
  };
  for (Element& e : contents.elements) {
    for (int k = 0; k < e.n_nodes(); ++k) find(e.nodes[k], e.line);
    for (int k = 0; k < e.n_further; ++k)
      find(contents.further_nodes[e.first_further + static_cast<size_t>(k)], e.line);
  }
  for (Point& point : contents.points) find(point.node, point.line);
  return is_needed;
}

void add_elements(const Contents& contents, const std::vector<int>& new_index, const TextScanner& scanner,
                  Mesh& mesh, MeshTags* tags) {
  EntityTable entities(contents, mesh);
  std::vector<int> nodes;
  for (const Element& e : contents.elements) {
    nodes.clear();
    for (int k = 0; k < e.n_nodes(); ++k) nodes.push_back(new_index[e.nodes[k]]);
    for (int k = 0; k < e.n_further; ++k)
      nodes.push_back(new_index[contents.further_nodes[e.first_further + static_cast<size_t>(k)]]);
    const std::string wrong = add_element(mesh, e.shape, nodes, entities.index(e.dim(), e.entity));
    if (!wrong.empty()) scanner.fail_at(e.line, "{}", wrong);
    if (tags) tags->elements[static_cast<size_t>(e.shape)].push_back(e.tag);
  }
}

DeclaredSurfaces surfaces_of(const Contents& contents) {
  DeclaredSurfaces result;
  for (const auto& [group, name] : contents.physical_names)
    if (group.first == 2) result.group_names.push_back(name);
  for (const auto& [tag, curves] : contents.surface_curves)
    if (!curves.empty()) result.surfaces.push_back({{tag, names_of(contents, {2, tag})}, curves});
  return result;
}

}  // namespace

std::vector<std::string> names_of(const Contents& contents, DimTag entity) {
  std::vector<std::string> names;
  const auto physicals = contents.entity_physicals.find(entity);
  if (physicals != contents.entity_physicals.end()) {
    for (const int physical : physicals->second) {
      const auto name = contents.physical_names.find({entity.first, physical});
      names.push_back(name != contents.physical_names.end() ? name->second : std::to_string(physical));
    }
  }
  const auto more = contents.more_names.find(entity);
  if (more != contents.more_names.end()) names.insert(names.end(), more->second.begin(), more->second.end());
  return names;
}

void settle_physicals(Contents& contents) {
  int greatest[4] = {};
  for (Element& e : contents.elements) {
    if (e.entity == 0) e.entity = e.physical > 0 ? e.physical : 1;
    greatest[e.dim()] = std::max(greatest[e.dim()], e.entity);
  }
  std::vector<char> repeats;
  const auto groups = groups_of_elements(contents.elements, repeats);
  std::map<std::pair<DimTag, std::vector<int>>, int> tag_of;
  for (size_t i = 0; i < groups.size(); ++i) {
    Element& e = contents.elements[i];
    if (repeats[i]) continue;
    const DimTag own = {e.dim(), e.entity};
    if (contents.entity_physicals.emplace(own, groups[i]).first->second == groups[i]) continue;
    const auto [it, is_new] = tag_of.emplace(std::pair{own, groups[i]}, 0);
    if (is_new) it->second = ++greatest[e.dim()];
    e.entity = it->second;
    contents.entity_physicals[{e.dim(), e.entity}] = groups[i];
  }
  size_t kept = 0;
  for (size_t i = 0; i < groups.size(); ++i) {
    if (!repeats[i]) contents.elements[kept++] = contents.elements[i];
  }
  contents.elements.resize(kept);
}

Mesh to_mesh(Contents contents, const TextScanner& scanner, MeshTags* tags) {
  if (contents.elements.empty()) scanner.fail("the file holds no lines, triangles, quads or cells");
  if (contents.nodes.empty()) scanner.fail("the file holds no nodes");
  const bool has_cells = std::ranges::count(contents.elements, 3, &Element::dim) > 0;
  for (Element& e : contents.elements) {
    if (has_cells) e.n_further = 0;  // see complete_faces()
    if (e.shape == CellShape::kTriangle && e.n_further > 0)
      scanner.fail_at(e.line, "a second-order triangle: expected straight ones, but beside cells of volumes");
  }
  std::ranges::stable_sort(contents.nodes, [](const Node& a, const Node& b) { return a.tag < b.tag; });
  check_tags(contents, scanner);
  // Programs list all points of a model: those without a group say nothing.
  std::erase_if(contents.points, [&](const Point& point) { return point_names(contents, point).empty(); });

  Mesh mesh;
  mesh.unit = contents.unit;
  std::vector<int> new_index = find_nodes(contents, scanner);
  for (size_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] < 0) continue;
    new_index[i] = static_cast<int>(mesh.points.size());
    mesh.points.push_back(contents.nodes[i].at);
    if (tags) tags->points.push_back(contents.nodes[i].tag);
  }
  NamedPoints named;
  for (const Point& point : contents.points)
    for (const std::string& name : point_names(contents, point)) named.add(mesh, new_index[point.node], name);
  add_elements(contents, new_index, scanner, mesh, tags);
  return mesh;
}

std::vector<double> in_order(const View& view, const std::vector<long long>& tags) {
  std::unordered_map<long long, std::size_t> place;
  for (std::size_t i = 0; i < view.values.size(); ++i) place[view.values[i].first] = i;
  const auto further = static_cast<std::size_t>(view.n_components - 1);
  std::vector<double> result;
  for (const long long tag : tags) {
    const auto found = place.find(tag);
    result.push_back(found == place.end() ? std::numeric_limits<double>::quiet_NaN()
                                          : view.values[found->second].second);
    for (std::size_t k = 0; k < further; ++k)
      result.push_back(found == place.end() ? std::numeric_limits<double>::quiet_NaN()
                                            : view.further[found->second * further + k]);
  }
  return result;
}

}  // namespace msh

bool fits_msh(std::string_view name) {
  return name.find_first_of(std::string_view("\"\r\n\0", 4)) == std::string_view::npos;
}

Mesh read_msh(const std::filesystem::path& path, DeclaredSurfaces* surfaces, ReadNotes* notes) {
  TextScanner scanner(path);
  refuse_other_kinds(scanner, "MSH");
  msh::Contents contents = msh::read_contents(scanner);
  if (surfaces) *surfaces = msh::surfaces_of(contents);
  if (notes != nullptr && contents.has_periodic)
    notes->push_back(
        "the periodic pairs of the file ($Periodic) are not read: nothing keeps their nodes alike");
  const bool is_curved = std::ranges::any_of(
      contents.elements, [](const msh::Element& e) { return e.dim() == 3 && e.n_further > 0; });
  if (notes != nullptr && is_curved) notes->push_back(kCornersOfCells);
  const std::vector<msh::View> views = std::move(contents.views);
  msh::MeshTags tags;
  Mesh mesh = msh::to_mesh(std::move(contents), scanner, &tags);
  std::vector<long long> faces = tags.elements[static_cast<size_t>(CellShape::kTriangle)];
  const std::vector<long long>& quads = tags.elements[static_cast<size_t>(CellShape::kQuad)];
  faces.insert(faces.end(), quads.begin(), quads.end());
  for (const msh::View& view : views) set_thickness(msh::in_order(view, faces), mesh);
  return mesh;
}

}  // namespace delquad
