// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/formats/deck.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <climits>
#include <span>

#include "base/located.h"
#include "base/sort_unique.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/turn_to_agree.h"
#include "geometry/mesh/weld.h"
#include "io/mesh_formats.h"
#include "io/text_scanner.h"

namespace delquad {

int Deck::side_of(const Element& element, const std::string& label) const {
  if (label.size() != 2 || label[1] < '1' || label[1] > '6') return -1;
  const int number = label[1] - '1';
  const std::string type = type_of(element);
  // As CalculiX has it: the first two faces of a shell are its bottom and its top.
  const bool is_shell =
      type.size() > 1 && type[0] == 'S' && std::isdigit(static_cast<unsigned char>(type[1]));
  if (label[0] == 'E') return number;
  return label[0] != 'S' ? -1 : is_shell ? number - 2 : number;
}

std::vector<int> Deck::elements_of(const Side& row) const {
  if (const auto set = element_sets.find(row.elements); set != element_sets.end()) return set->second;
  long long number = 0;
  std::from_chars(row.elements.data(), row.elements.data() + row.elements.size(), number);
  if (const auto element = element_of.find(number); element != element_of.end()) return {element->second};
  if (!unread.contains(number))
    refuse("{}:{}: there is no element or set {}", source, row.line, TextScanner::printable(row.elements));
  return {};
}

DeckSets Deck::filled_regions() const {
  std::vector<std::vector<int>> regions_at(nodes.size());
  for (const Element& e : elements)
    for (const int v : e.nodes)
      if (e.corners() > 2) regions_at[v].push_back(e.region);
  std::map<int, int> n_nodes;
  for (std::vector<int>& regions : regions_at) {
    sort_unique(regions);
    for (const int r : regions) ++n_nodes[r];
  }
  DeckSets filled;
  for (const auto& [name, members] : node_sets) {
    std::map<int, int> count;
    for (const int v : members)
      for (const int r : regions_at[v]) ++count[r];
    std::erase_if(count, [&](const auto& c) { return c.second < n_nodes.at(c.first); });
    const bool has_others = std::ranges::any_of(members, [&](int v) {
      return !regions_at[v].empty() &&
             std::ranges::none_of(regions_at[v], [&](int r) { return count.contains(r); });
    });
    if (has_others) continue;
    for (const auto& [region, n] : count) filled[name].push_back(region);
  }
  return filled;
}

bool Deck::names_side(const Side& row) const {
  const std::vector<int> named = elements_of(row);
  return !named.empty() && side_of(elements[named[0]], row.label) >= 0;
}

std::set<std::string, LessBlindToCase> Deck::sets_of_sides() const {
  std::set<std::string, LessBlindToCase> names;
  for (const Side& row : sides)
    if (row.elements[0] == '_' && names_side(row)) names.insert(row.elements);
  return names;
}

namespace {

/// Keeps the elements that lines name by number, or by one of their sides.
void pin_elements(Deck& deck) {
  const auto of_sides = deck.sets_of_sides();
  for (const Deck::Word& word : deck.words) {
    if (!word.of_element) continue;
    if (const auto e = deck.element_of.find(word.number); e != deck.element_of.end())
      deck.elements[e->second].pin = word.line;
    const auto set = deck.element_sets.find(word.set());
    if (set == deck.element_sets.end() || !(word.has_side || of_sides.contains(set->first))) continue;
    for (const int e : set->second) deck.elements[e].pin = word.line;
  }
  for (const Deck::Side& row : deck.sides)
    if (!deck.element_sets.contains(row.elements) && !deck.names_side(row))
      for (const int e : deck.elements_of(row)) deck.elements[e].pin = row.line;
  for (const Deck::Element& e : deck.elements) deck.n_named += e.pin >= 0;
}

/// Keeps the nodes that other elements, lines and sets name.
void pin_nodes(Deck& deck) {
  DeckSets fixed;  // with the line
  for (const Deck::Word& word : deck.words) {
    if (const auto v = deck.node_of.find(word.number); v != deck.node_of.end())
      deck.nodes[v->second].pin = word.line;
    if (!word.may_grow && word.number == 0) fixed[word.set()] = {word.line};
  }
  deck.growing = deck.filled_regions();
  std::erase_if(deck.growing, [&](const auto& set) { return fixed.contains(set.first); });
  for (const auto& [name, nodes] : deck.node_sets)
    for (const int v : nodes)
      if (!deck.growing.contains(name))
        deck.nodes[v].pin = std::max(deck.nodes[v].pin, fixed.contains(name) ? fixed[name][0] : 0);
  for (const Deck::Element& e : deck.elements)
    for (const int v : e.nodes)
      if (e.corners() == 2) deck.nodes[v].pin = e.line;
}

}  // namespace

void part_elements(Deck& deck) {
  const auto of_sides = deck.sets_of_sides();
  for (const auto& [name, members] : deck.element_sets)
    for (const int e : members)
      if (name[0] == '_' && !of_sides.contains(name)) deck.elements[e].sets.push_back(name);
  pin_elements(deck);
  Mesh flat;
  flat.points.resize(deck.nodes.size());
  std::vector<Deck::Element*> shells;  // triangles first
  for (const std::size_t corners : {3, 4})
    for (Deck::Element& e : deck.elements) {
      if (e.corners() != corners) continue;
      const auto& v = e.nodes;
      if (corners == 3) flat.triangles.push_back({v[0], v[1], v[2]});
      if (corners == 4) flat.quads.push_back({v[0], v[1], v[2], v[3]});
      shells.push_back(&e);
    }
  std::vector<Neighbours> neighbours;
  for_each_edge(sorted_half_edges(flat), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2)
      neighbours.push_back({edge[0].element, edge[1].element, edge[0].forward != edge[1].forward});
  });
  const Turned turned = turn_to_agree(shells.size(), neighbours);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (turned.is_turned[s]) shells[s]->sets.emplace_back("#");
    if (shells[s]->pin >= 0) shells[s]->sets.push_back(fmt::format("#{}", shells[s]->number));
  }
}

void name_points(Deck& deck) {
  pin_nodes(deck);
  Mesh& mesh = deck.mesh;
  std::vector<char> used(mesh.points.size(), 0), stays(mesh.points.size(), 0);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const bool bounds =
        edge.size() != 2 || region_of(mesh, edge[0].element) != region_of(mesh, edge[1].element);
    for (const int v : {edge[0].lo, edge[0].hi}) used[v] = 1, stays[v] |= static_cast<char>(bounds);
  });
  drop_stray_lines(mesh, sides);
  for (const auto& line : mesh.lines)
    for (const int v : line) stays[v] = 1;
  const PointNames names = names_of_equal_points(mesh);
  std::vector<char> is_reported(mesh.points.size(), 0);  // not by its place alone
  for (std::size_t v = 0; v < names.size(); ++v) {
    if (used[v] && names[v] != static_cast<int>(v)) is_reported[v] = is_reported[names[v]] = 1;
    if (used[v] && !stays[v] && deck.nodes[v].pin >= 0) is_reported[v] = 1, ++deck.n_named;
  }
  for (std::size_t v = 0; v < is_reported.size(); ++v) {
    if (!is_reported[v] || !used[v]) continue;
    const long long number = deck.nodes[v].number;
    if (number > INT_MAX) refuse("{}: node {}: expected a number up to {}", deck.source, number, INT_MAX);
    mesh.named_points.push_back({static_cast<int>(v), {static_cast<int>(number), {}}});
  }
  deck.point_of = drop_unused_points(mesh);
}

Mesh given_mesh(Deck deck, ReadNotes* notes) {
  if (notes != nullptr && deck.n_named > 0)
    notes->push_back(fmt::format("{}: inner nodes and elements that stay, as lines or sets name them: {}",
                                 deck.source, deck.n_named));
  return deck.mesh.order > 1 ? straightened(std::move(deck.mesh)) : std::move(deck.mesh);
}

}  // namespace delquad
