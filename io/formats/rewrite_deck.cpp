// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "base/located.h"
#include "base/sort_unique.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/mesh/weld.h"
#include "io/formats/deck.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

/// Joins nodes as weld_open_edges() joins their points. Refuses lines for which that has another meaning.
void join_nodes(Deck& deck, double weld) {
  const PointNames names = names_at_open_edges(deck.mesh, weld * diagonal(deck.mesh));
  std::vector<int> node_at(names.size());
  for (std::size_t v = 0; v < deck.nodes.size(); ++v)
    if (const int p = deck.point_of[v]; p >= 0) node_at[p] = static_cast<int>(v);
  for (std::size_t v = 0; v < deck.nodes.size(); ++v)
    if (const int p = deck.point_of[v]; p >= 0 && names[p] != p) deck.nodes[v].joined = node_at[names[p]];
  const auto check = [&](int line, int v, const std::string& why) {
    const Deck::Node& node = deck.nodes[v];
    if (node.joined >= 0)
      refuse("{}:{}: --weld would join node {} to node {}, but {}; change this line, or leave --weld out",
             deck.source, line, node.number, deck.nodes[node.joined].number, why);
  };
  for (const Deck::Word& word : deck.words) {
    const std::string& card = deck.cards[word.card].name;
    if (const auto v = deck.node_of.find(word.number); v != deck.node_of.end() && word.forbids_join)
      check(word.line, v->second, fmt::format("this line of {} names {}", card, word.number));
    const auto set = deck.node_sets.find(word.set());
    if (set == deck.node_sets.end() || !word.counts_nodes) continue;
    for (const int v : set->second)
      if (std::ranges::binary_search(set->second, deck.nodes[v].joined))
        check(word.line, v, fmt::format("{} counts each node of the set {}", card, set->first));
  }
}

/// Writes a deck again, edit by edit.
class DeckRewriter {
 public:
  DeckRewriter(const Deck& deck, const DeckText& writes, const Mesh& mesh)
      : deck_(deck), writes_(writes), mesh_(mesh) {
    number_nodes();
    place_elements();
    find_gone_nodes();
  }

  std::string text() {
    edit_nodes();
    edit_elements();
    edit_surfaces();
    edit_node_surfaces();
    edit_sets();
    std::ranges::stable_sort(edits_, {}, [](const Edit& e) { return std::pair(e.begin, e.end); });
    std::string result;
    std::size_t at = 0;
    const bool has_returns = deck_.text.find("\r\n") != std::string::npos;
    for (const Edit& edit : edits_) {
      result.append(deck_.text, at, edit.begin - at);
      if (!edit.text.empty() && !result.empty() && result.back() != '\n') result += '\n';
      for (const char c : edit.text) result.append(c == '\n' && has_returns ? 1 : 0, '\r') += c;
      at = edit.end;
    }
    return result.append(deck_.text, at);
  }

 private:
  using Numbers = std::vector<long long>;
  struct Edit {
    std::size_t begin, end;
    std::string text;
  };

  void number_nodes() {
    const auto place = [](const Vec3& p) { return std::array{p.x, p.y, p.z}; };
    std::map<std::array<double, 3>, long long> number_at;
    for (const Deck::Element& e : deck_.elements)
      for (const int v : e.nodes) number_at[place(deck_.nodes[v].at)] = kept(v).number;
    for (const Vec3& p : mesh_.points) {
      const auto at = number_at.find(place(p));
      number_.push_back(at == number_at.end() ? 0 : at->second);
    }
    for (const NamedPoint& named : mesh_.named_points) number_[named.point] = kept_number(named.entity.tag);
    largest_node_ = deck_.node_of.rbegin()->first;
    for (const Deck::Word& word : deck_.words) largest_node_ = std::max(largest_node_, word.number);
    for (std::size_t p = 0; p < number_.size(); ++p)
      if (number_[p] == 0) number_[p] = add_node(mesh_.points[p]);
  }
  long long add_node(const Vec3& at) {
    new_nodes_.emplace_back(largest_node_ + static_cast<long long>(new_nodes_.size()) + 1, at);
    return new_nodes_.back().first;
  }

  /// A node, or the one that takes its place.
  const Deck::Node& kept(int v) const {
    const int joined = deck_.nodes[v].joined;
    return deck_.nodes[joined < 0 ? v : joined];
  }
  long long kept_number(long long number) const {
    const auto v = deck_.node_of.find(number);
    return v == deck_.node_of.end() ? number : kept(v->second).number;
  }

  Numbers numbers_of(const Deck::Element& e) const {
    Numbers numbers;
    for (const int v : e.nodes) numbers.push_back(kept(v).number);
    return numbers;
  }

  void place_elements() {
    std::map<Numbers, std::size_t> old;
    const auto sorted = [](Numbers numbers) {
      numbers.resize(std::min<std::size_t>(numbers.size(), 4));
      sort_unique(numbers);
      return numbers;
    };
    for (std::size_t e = 0; e < deck_.elements.size(); ++e) {
      kept_.push_back(deck_.elements[e].corners() == 2);
      if (kept_[e]) continue;
      const Numbers numbers = numbers_of(deck_.elements[e]);
      old[sorted(numbers)] = e;
      for (std::size_t k = 0; k < 4 && numbers.size() == 8; ++k)
        middle_[std::minmax(numbers[k], numbers[(k + 1) % 4])] = numbers[4 + k];
      models_.try_emplace({deck_.elements[e].region, deck_.elements[e].nodes.size()}, &deck_.elements[e]);
      add_facets(deck_.elements[e]);
    }
    long long largest = deck_.element_of.rbegin()->first;
    if (!deck_.unread.empty()) largest = std::max(largest, *deck_.unread.rbegin());
    for_each_element(mesh_, [&](int element, const auto& v) {
      const int region = region_of(mesh_, element);
      Numbers numbers;
      for (const int i : v) numbers.push_back(number_[i]);
      const auto found = old.find(sorted(numbers));
      if (found != old.end() && deck_.elements[found->second].region == region) {
        const Deck::Element& e = deck_.elements[found->second];
        kept_[found->second] = 1;
        return add_sides(e.number, numbers_of(e), e.corners(), region);
      }
      std::vector<Vec3> corners;
      for (const int i : v) corners.push_back(mesh_.points[i]);
      const Deck::Element& near = nearest(corners, region);
      if (dot(normal_of(corners_of(near)), normal_of(corners)) < 0) {
        std::reverse(numbers.begin() + 1, numbers.end());
        std::reverse(corners.begin() + 1, corners.end());
      }
      const auto model = models_.contains({region, v.size()}) ? models_[{region, v.size()}]
                                                              : models_.lower_bound({region, 0})->second;
      if (model->nodes.size() == 8) add_middles(corners, *model, numbers);
      add_sides(++largest, numbers, v.size(), region);
      new_elements_[region].push_back({largest, model, std::move(numbers), angle_as(near, corners)});
    });
  }

  /// Adds the nodes on the sides of a new quad. Nodes on sides of the deck stay, others lie halfway.
  void add_middles(const std::vector<Vec3>& corners, const Deck::Element& model, Numbers& numbers) {
    if (deck_.has_directions)
      refuse("{}:{}: element {} has eight nodes and a material's direction: expected elements of four nodes",
             deck_.source, model.line, model.number);
    for (std::size_t k = 0; k < 4; ++k) {
      long long& middle = middle_[std::minmax(numbers[k], numbers[(k + 1) % 4])];
      if (middle == 0) middle = add_node(0.5 * (corners[k] + corners[(k + 1) % 4]));
      numbers.push_back(middle);
    }
  }

  static Vec3 normal_of(const std::vector<Vec3>& p) { return cross(p[2] - p[0], p.back() - p[1]); }

  std::vector<Vec3> corners_of(const Deck::Element& e) const {
    std::vector<Vec3> corners;
    for (std::size_t k = 0; k < e.corners(); ++k) corners.push_back(deck_.nodes[e.nodes[k]].at);
    return corners;
  }
  /// The deck's element of a region that is nearest to a new one.
  const Deck::Element& nearest(const std::vector<Vec3>& corners, int region) {
    Facets& facets = facets_.at(region);
    if (!facets.tree) facets.tree = std::make_unique<NearestTriangle>(facets.points, facets.triangles);
    Vec3 middle;
    for (const Vec3& p : corners) middle = middle + (1.0 / static_cast<double>(corners.size())) * p;
    return *facets.elements[facets.tree->find(middle).triangle];
  }
  void add_facets(const Deck::Element& e) {
    Facets& facets = facets_[e.region];
    const std::vector<Vec3> corners = corners_of(e);
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const int n = static_cast<int>(facets.points.size());
      facets.points.insert(facets.points.end(), {corners[0], corners[k - 1], corners[k]});
      facets.triangles.push_back({n, n + 1, n + 2});
      facets.elements.push_back(&e);
    }
  }
  /// The angle at which the direction of an element lies in another one.
  double angle_as(const Deck::Element& e, const std::vector<Vec3>& corners) const {
    if (!deck_.has_directions) return e.angle;
    constexpr double kDegree = std::numbers::pi / 180;
    const auto axes_of = [](const std::vector<Vec3>& p) {
      const Vec3 x = p[1] - p[0], n = normal_of(p);
      return std::pair(x, (1 / norm(n)) * cross(n, x));
    };
    const auto [old_x, old_y] = axes_of(corners_of(e));
    const auto [x, y] = axes_of(corners);
    const Vec3 direction = std::cos(e.angle * kDegree) * old_x + std::sin(e.angle * kDegree) * old_y;
    return std::atan2(dot(direction, y), dot(direction, x)) / kDegree;
  }

  /// Remembers each side by its ends, as the element runs.
  void add_sides(long long element, const Numbers& nodes, std::size_t corners, int region) {
    for (std::size_t k = 0; k < corners; ++k)
      side_at_[{nodes[k], nodes[(k + 1) % corners], region}] = {element, static_cast<int>(k)};
    used_.insert(nodes.begin(), nodes.end());
  }

  void find_gone_nodes() {
    const auto require_free = [&](int pin, const char* what, long long number) {
      if (pin > 0)
        refuse("{}:{}: {} {} is named and would be removed [deck-names-an-element]", deck_.source, pin, what,
               number);
    };
    for (const Deck::Node& node : deck_.nodes)
      if (node.joined >= 0) gone_nodes_.insert(node.number);
    for (std::size_t e = 0; e < kept_.size(); ++e) {
      if (kept_[e]) continue;
      require_free(deck_.elements[e].pin, "element", deck_.elements[e].number);
      gone_elements_.insert(deck_.elements[e].number);
      for (const int v : deck_.elements[e].nodes)
        if (const Deck::Node& node = kept(v); !used_.contains(node.number)) {
          require_free(node.pin, "node", node.number);
          if (node.pin == 0 && deck_.elements[e].nodes.size() == 8)  // on a side, as corners stay
            refuse("{}: node {} on a side is in a set and would be removed: take it out of the set",
                   deck_.source, node.number);
          gone_nodes_.insert(node.number);
        }
    }
  }

  void replace(std::size_t begin, std::size_t end, std::string text = "") {
    if (begin < end || !text.empty()) edits_.push_back({begin, end, std::move(text)});
  }
  void edit_nodes() {
    for (const Deck::Node& node : deck_.nodes)
      if (gone_nodes_.contains(node.number)) replace(node.begin, node.end);
    const Deck::Card& first = *std::ranges::find(deck_.cards, "NODE", &Deck::Card::name);
    std::map<long long, const Deck::Card*> card_of;
    std::string sets;
    for (const auto& [name, regions] : deck_.growing) {
      Numbers added;
      for (const int r : regions)
        for (const NewElement& e : new_elements_[r])
          std::ranges::copy_if(e.nodes, std::back_inserter(added),
                               [&](long long v) { return v > largest_node_; });
      sort_unique(added);
      const auto home = std::ranges::find_if(deck_.cards, [&](const Deck::Card& card) {
        return (card.name == "NODE" || !card.numbers.empty()) && upper(card.parameter("NSET")) == upper(name);
      });
      if (home == deck_.cards.end() || added.empty()) continue;
      if (home->name == "NODE") {
        for (const long long v : added) card_of[v] = &*home;
        sets += writes_.as_in(*home, added, true);
      } else {
        added_[&*home] = std::move(added);
      }
    }
    std::string text = new_nodes_.empty() ? "" : writes_.head_of_nodes();
    for (const auto& [number, at] : new_nodes_) {
      const auto card = card_of.find(number);
      text += writes_.node(number, at, card == card_of.end() ? nullptr : card->second);
    }
    replace(first.end, first.end, text + sets);
    std::size_t last = first.end;  // all nodes are there
    for (const Deck::Card& card : deck_.cards)
      if (card.name == "NODE") last = std::max(last, card.end);
    for (const Deck::Card& card : deck_.cards) {
      if (card.name != "NODE" || card.parameter("NSET").empty()) continue;
      const std::vector<int>& members = deck_.node_sets.at(card.parameter("NSET"));
      Numbers joined;
      for (const int v : members)
        if (const int to = deck_.nodes[v].joined; to >= 0 && !std::ranges::binary_search(members, to))
          joined.push_back(deck_.nodes[to].number);
      sort_unique(joined);
      if (!joined.empty()) replace(last, last, writes_.as_in(card, joined, false));
    }
  }

  void edit_elements() {
    std::map<int, bool> has_some;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const Deck::Element& e = deck_.elements[i];
      has_some[e.card] |= kept_[i] != 0;
      if (!kept_[i])
        replace(e.begin, e.end);
      else if (std::ranges::any_of(e.nodes, [&](int v) { return deck_.nodes[v].joined >= 0; }))
        replace(e.begin, e.end, writes_.element(e.number, e, deck_.type_of(e), numbers_of(e), e.angle));
    }
    for (const auto& [card, some] : has_some)
      if (!some) replace(deck_.cards[card].begin, deck_.cards[card].data);
    std::map<std::pair<int, std::string>, std::string> blocks;  // by card and type
    for (const auto& [region, elements] : new_elements_)
      for (const NewElement& e : elements) {
        std::string type = deck_.type_of(*e.model);
        if (e.model->nodes.size() != e.nodes.size()) type = writes_.type_with(type, e.nodes.size());
        blocks[{e.model->card, type}] += writes_.element(e.number, *e.model, type, e.nodes, e.angle);
      }
    for (const auto& [block, lines] : blocks) {
      const Deck::Card& card = deck_.cards[block.first];
      replace(card.end, card.end, writes_.head(card, block.second) + lines);
    }
  }

  /// Names sides of surfaces by the numbers of elements if any of these is gone. Makes sets "_NAME_E1" of our
  /// files again, in the place of the first one.
  void edit_surfaces() {
    std::map<std::pair<int, std::string>, std::vector<const Deck::Side*>> surfaces;
    for (const Deck::Side& row : deck_.sides)
      surfaces[{row.card, row.card < 0 ? row.surface : ""}].push_back(&row);
    for (const auto& [surface, rows] : surfaces) {
      std::string text;
      std::map<std::string, Numbers> by_label;
      bool changes = false;
      std::set<std::string, LessBlindToCase> sets;
      for (const Deck::Side* row : rows)
        if (deck_.names_side(*row))
          changes |= move_sides(*row, by_label), sets.insert(row->elements);
        else
          text += row->elements + ", " + row->label + '\n';
      if (!changes) continue;
      for (auto& [label, numbers] : by_label) {
        sort_unique(numbers);
        text += surface.first < 0
                    ? fmt::format("*ELSET, ELSET=_{}_{}\n{}", surface.second, label, inp_lines(numbers))
                    : fmt::format("{}, {}\n", fmt::join(numbers, fmt::format(", {}\n", label)), label);
      }
      if (surface.first >= 0) replace(deck_.cards[surface.first].data, deck_.cards[surface.first].end, text);
      for (const Deck::Card& card : deck_.cards)
        if (surface.first < 0 && card.name == "ELSET" && sets.contains(card.parameter("ELSET"))) {
          replace(card.begin, card.end, std::exchange(text, ""));
          replaced_.insert(&card);
        }
    }
  }

  /// Renames joined nodes in the rows of surfaces of nodes.
  void edit_node_surfaces() {
    for (const Deck::Card& card : deck_.cards) {
      if (card.name != "SURFACE" || upper(card.parameter("TYPE")) != "NODE") continue;
      std::set<long long> known;
      for (const bool is_first_pass : {true, false})
        for (std::size_t at = card.data, next = 0; at < card.end; at = next) {
          next = std::min(deck_.text.find('\n', at), deck_.text.size() - 1) + 1;
          const std::size_t begin = std::min(deck_.text.find_first_not_of(" \t", at), next);
          long long number = 0;
          const char* const end =
              std::from_chars(deck_.text.data() + begin, deck_.text.data() + next, number).ptr;
          const long long now = kept_number(number);
          if (is_first_pass && now == number) known.insert(number);
          if (is_first_pass || now == number) continue;
          const bool is_new = known.insert(now).second;
          replace(at, is_new ? static_cast<std::size_t>(end - deck_.text.data()) : next,
                  is_new ? fmt::format("{}", now) : "");
        }
    }
  }

  /// Finds the sides that stand for a row; returns whether any is of a new element.
  bool move_sides(const Deck::Side& row, std::map<std::string, Numbers>& by_label) const {
    bool changes = false;
    for (const int index : deck_.elements_of(row)) {
      const Deck::Element& e = deck_.elements[index];
      const int side = deck_.side_of(e, row.label);
      const auto number = [&](int k) {
        return kept(e.nodes[static_cast<std::size_t>(k) % e.corners()]).number;
      };
      const auto at = side_at_.find({number(side), number(side + 1), e.region});
      if (at == side_at_.end())
        refuse("{}:{}: side {} of element {} would be removed", deck_.source, row.line, row.label, e.number);
      std::string label = row.label;
      label[1] = static_cast<char>(label[1] + at->second.second - side);
      by_label[label].push_back(at->second.first);
      changes |= !kept_[index];
    }
    return changes;
  }

  /// Takes out what is gone of the sets, and adds new elements to the first card that names some of their
  /// region.
  void edit_sets() {
    const auto of_sides = deck_.sets_of_sides();
    std::set<std::pair<std::string, int>> done;  // sets with the new elements of a region
    for (const Deck::Card& card : deck_.cards) {
      if (card.numbers.empty() || replaced_.contains(&card)) continue;
      Numbers& added = added_[&card];
      const std::string set = upper(card.parameter("ELSET"));
      for (const long long number : card.numbers) {
        const auto found = deck_.element_of.find(number);
        if (card.name != "ELSET" || of_sides.contains(set) || found == deck_.element_of.end()) continue;
        const int region = deck_.elements[found->second].region;
        if (deck_.elements[found->second].corners() == 2 || !done.emplace(set, region).second) continue;
        for (const NewElement& e : new_elements_[region])
          if (upper(deck_.cards[e.model->card].parameter("ELSET")) != set) added.push_back(e.number);
      }
      edit_set(card, card.name == "NSET" ? gone_nodes_ : gone_elements_, added);
    }
  }

  void edit_set(const Deck::Card& card, const std::set<long long>& gone, const Numbers& added) {
    Numbers numbers;
    std::set<long long> known(card.numbers.begin(), card.numbers.end());
    for (const long long i : card.numbers) {
      const long long number = card.name == "NSET" ? kept_number(i) : i;
      if (!gone.contains(number) && (number == i || known.insert(number).second)) numbers.push_back(number);
    }
    if (numbers == card.numbers && added.empty()) return;
    numbers.insert(numbers.end(), added.begin(), added.end());
    const bool is_empty = numbers.empty() && card.names.empty();
    replace(card.begin, card.end, is_empty ? "" : writes_.set(card, numbers));
  }

  struct NewElement {
    long long number;
    const Deck::Element* model;  ///< of its region; gives it type and block
    Numbers nodes;
    double angle;
  };
  struct Facets {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<const Deck::Element*> elements;  ///< by triangle
    std::unique_ptr<NearestTriangle> tree = nullptr;
  };
  const Deck& deck_;
  const DeckText& writes_;
  const Mesh& mesh_;
  long long largest_node_ = 0;
  Numbers number_;                                               ///< of each point of the mesh
  std::vector<std::pair<long long, Vec3>> new_nodes_;            ///< with their numbers
  std::map<std::pair<long long, long long>, long long> middle_;  ///< node on the side between two corners
  std::vector<char> kept_;                                       ///< by element of the deck
  std::map<int, std::vector<NewElement>> new_elements_;          ///< by region
  std::map<std::tuple<long long, long long, int>, std::pair<long long, int>>
      side_at_;                                                         ///< by ends and region
  std::map<std::pair<int, std::size_t>, const Deck::Element*> models_;  ///< by region and number of nodes
  std::map<int, Facets> facets_;                                        ///< by region
  std::set<long long> used_, gone_nodes_, gone_elements_;
  std::map<const Deck::Card*, Numbers> added_;
  std::set<const Deck::Card*> replaced_;
  std::vector<Edit> edits_;
};

}  // namespace

void rewrite_deck(Deck& deck, const DeckText& text, const std::filesystem::path& path, const Mesh& mesh,
                  double weld) {
  require_straight(weld > 0 ? deck.mesh : mesh, deck.source);
  join_nodes(deck, weld);
  write_text_file(path, std::string_view(DeckRewriter(deck, text, mesh).text()));
}

}  // namespace delquad
