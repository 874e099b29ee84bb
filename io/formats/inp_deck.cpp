#include "io/formats/inp_deck.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <climits>
#include <iterator>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

#include "base/located.h"
#include "base/sort_unique.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/mesh/turn_to_agree.h"
#include "geometry/mesh/weld.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"

namespace delquad {

int InpDeck::side_of(const Element& element, const std::string& label) const {
  if (label.size() != 2 || label[1] < '1' || label[1] > '6') return -1;
  const int number = label[1] - '1';
  const std::string type = type_of(element);
  // As CalculiX has it: the first two faces of a shell are its bottom and its top.
  const bool is_shell =
      type.size() > 1 && type[0] == 'S' && std::isdigit(static_cast<unsigned char>(type[1]));
  if (label[0] == 'E') return number;
  return label[0] != 'S' ? -1 : is_shell ? number - 2 : number;
}

std::vector<int> InpDeck::elements_of(const Side& row) const {
  if (const auto set = element_sets.find(row.elements); set != element_sets.end()) return set->second;
  long long number = 0;
  std::from_chars(row.elements.data(), row.elements.data() + row.elements.size(), number);
  if (const auto element = element_of.find(number); element != element_of.end()) return {element->second};
  if (!unread.contains(number))
    refuse("{}:{}: there is no element or set {}", source, row.line, TextScanner::printable(row.elements));
  return {};
}

InpSets InpDeck::filled_regions() const {
  std::vector<std::vector<int>> regions_at(nodes.size());
  for (const Element& e : elements)
    for (const int v : e.nodes)
      if (e.corners() > 2) regions_at[v].push_back(e.region);
  std::map<int, int> n_nodes;
  for (std::vector<int>& regions : regions_at) {
    sort_unique(regions);
    for (const int r : regions) ++n_nodes[r];
  }
  InpSets filled;
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

namespace {

/// Keywords between bars. The numbers in the data of the first ones are numbers of nodes alone; the second
/// ones may get new nodes in their sets.
constexpr std::string_view
    kOfNodes =
        "|BOUNDARY|CFLUX|CLOAD|ELEMENT|EQUATION|FIELD|MPC|NODAL THICKNESS|SURFACE|TEMPERATURE|TRANSFORM|",
    kMayGrow = "|BOUNDARY|FIELD|INITIAL CONDITIONS|NODAL THICKNESS|SURFACE|TEMPERATURE|TRANSFORM|";

bool names_side(const InpDeck& deck, const InpDeck::Side& row) {
  const std::vector<int> elements = deck.elements_of(row);
  return !elements.empty() && deck.side_of(deck.elements[elements[0]], row.label) >= 0;
}

/// Sets of elements that have a side on a curve: they are made again from these sides.
std::set<std::string, LessBlindToCase> sets_of_sides(const InpDeck& deck) {
  std::set<std::string, LessBlindToCase> names;
  for (const InpDeck::Side& row : deck.sides)
    if (row.elements[0] == '_' && names_side(deck, row)) names.insert(row.elements);
  return names;
}

/// "P-1.TOP" is the set TOP.
std::string without_instance(const std::string& name) { return name.substr(name.rfind('.') + 1); }

/// Keeps the elements that lines name by number, or by one of their sides.
void pin_elements(InpDeck& deck) {
  const auto of_sides = sets_of_sides(deck);
  const auto is_side = [](const std::string& label) {  // "P2", "EDNOR1"
    return !label.empty() && std::isalpha(static_cast<unsigned char>(label.front())) &&
           std::isdigit(static_cast<unsigned char>(label.back()));
  };
  for (const InpDeck::Word& word : deck.words) {
    if (deck.cards[word.card].is_among(kOfNodes)) continue;
    if (const auto e = deck.element_of.find(word.number); word.is_first && e != deck.element_of.end())
      deck.elements[e->second].pin = word.line;
    const auto set = deck.element_sets.find(without_instance(word.text));
    if (set == deck.element_sets.end() || !(of_sides.contains(set->first) || is_side(word.next))) continue;
    for (const int e : set->second) deck.elements[e].pin = word.line;
  }
  for (const InpDeck::Side& row : deck.sides)
    if (!deck.element_sets.contains(row.elements) && !names_side(deck, row))
      for (const int e : deck.elements_of(row)) deck.elements[e].pin = row.line;
  for (const InpDeck::Element& e : deck.elements) deck.n_named += e.pin >= 0;
}

/// Keeps the nodes that other elements, lines and sets name.
void pin_nodes(InpDeck& deck) {
  InpSets fixed;  // with the line
  for (const InpDeck::Word& word : deck.words) {
    if (const auto v = deck.node_of.find(word.number); v != deck.node_of.end())
      deck.nodes[v->second].pin = word.line;
    if (!deck.cards[word.card].is_among(kMayGrow)) fixed[without_instance(word.text)] = {word.line};
  }
  deck.growing = deck.filled_regions();
  std::erase_if(deck.growing, [&](const auto& set) { return fixed.contains(set.first); });
  for (const auto& [name, nodes] : deck.node_sets)
    for (const int v : nodes)
      if (!deck.growing.contains(name))
        deck.nodes[v].pin = std::max(deck.nodes[v].pin, fixed.contains(name) ? fixed[name][0] : 0);
  for (const InpDeck::Element& e : deck.elements)
    for (const int v : e.nodes)
      if (e.corners() == 2) deck.nodes[v].pin = e.line;
}

/// The type of quads beside triangles of a type, or the other way round: S3 and S4.
std::string type_with(std::string type, std::size_t corners) {
  const char digit = corners == 3 ? '4' : '3', other = corners == 3 ? '3' : '4';
  if (type.starts_with("STRI")) type = "S3";
  const std::size_t at = type.rfind(digit);
  if (at == std::string::npos) return type;
  type[at] = other;
  return corners == 3 ? type.substr(0, at + 1) : type;  // there is no S3R5
}

/// Joins nodes as weld_open_edges() joins their points. Refuses lines for which that has another meaning.
void join_nodes(InpDeck& deck, double weld) {
  const PointNames names = names_at_open_edges(deck.mesh, weld * diagonal(deck.mesh));
  std::vector<int> node_at(names.size());
  for (std::size_t v = 0; v < deck.nodes.size(); ++v)
    if (const int p = deck.point_of[v]; p >= 0) node_at[p] = static_cast<int>(v);
  for (std::size_t v = 0; v < deck.nodes.size(); ++v)
    if (const int p = deck.point_of[v]; p >= 0 && names[p] != p) deck.nodes[v].joined = node_at[names[p]];
  const auto check = [&](int line, int v, const std::string& why) {
    const InpDeck::Node& node = deck.nodes[v];
    if (node.joined >= 0)
      refuse("{}:{}: --weld would join node {} to node {}, but {}; change this line, or leave --weld out",
             deck.source, line, node.number, deck.nodes[node.joined].number, why);
  };
  for (const InpDeck::Word& word : deck.words) {
    const InpDeck::Card& card = deck.cards[word.card];
    const bool may_be_node = !card.is_among("|DFLUX|DLOAD|FILM|FOUNDATION|RADIATE|SURFACE|TRANSFORM|") &&
                             (word.is_first || !(card.is_among(kMayGrow) || card.is_among("|CFLUX|CLOAD|")));
    if (const auto v = deck.node_of.find(word.number); v != deck.node_of.end() && may_be_node)
      check(word.line, v->second, fmt::format("this line of *{} names {}", card.name, word.number));
    const auto set = deck.node_sets.find(without_instance(word.text));
    if (set == deck.node_sets.end() || !card.is_among(kOfNodes) || card.is_among(kMayGrow)) continue;
    for (const int v : set->second)
      if (std::ranges::binary_search(set->second, deck.nodes[v].joined))
        check(word.line, v, fmt::format("*{} counts each node of the set {}", card.name, set->first));
  }
}

int region_of(const Mesh& mesh, int element) {
  const auto e = static_cast<std::size_t>(element), n = mesh.triangles.size();
  return e < n ? mesh.triangle_region[e] : mesh.quad_region[e - n];
}

/// Writes a deck again, edit by edit.
class InpRewriter {
 public:
  InpRewriter(const InpDeck& deck, const Mesh& mesh) : deck_(deck), mesh_(mesh) {
    if (mesh.regions.size() != deck.mesh.regions.size())
      refuse("{}: a kept deck gets no new regions: expected no --failing-sets", deck.source);
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
    for (const Edit& edit : edits_) {
      result.append(deck_.text, at, edit.begin - at);
      if (!edit.text.empty() && result.back() != '\n') result += '\n';
      result += edit.text;
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
    for (const InpDeck::Element& e : deck_.elements)
      for (const int v : e.nodes) number_at[place(deck_.nodes[v].at)] = kept(v).number;
    for (const Vec3& p : mesh_.points) {
      const auto at = number_at.find(place(p));
      number_.push_back(at == number_at.end() ? 0 : at->second);
    }
    for (const NamedPoint& named : mesh_.named_points) number_[named.point] = kept_number(named.entity.tag);
    long long largest = deck_.node_of.rbegin()->first;
    for (std::size_t p = 0; p < number_.size(); ++p) {
      if (number_[p] > 0 || mesh_.order > 1) continue;  // middles of eight nodes are in no deck
      number_[p] = ++largest;
      new_nodes_.push_back(p);
    }
  }

  /// A node, or the one that takes its place.
  const InpDeck::Node& kept(int v) const {
    const int joined = deck_.nodes[v].joined;
    return deck_.nodes[joined < 0 ? v : joined];
  }
  long long kept_number(long long number) const {
    const auto v = deck_.node_of.find(number);
    return v == deck_.node_of.end() ? number : kept(v->second).number;
  }

  Numbers numbers_of(const InpDeck::Element& e) const {
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
      old[sorted(numbers_of(deck_.elements[e]))] = e;
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
        const InpDeck::Element& e = deck_.elements[found->second];
        kept_[found->second] = 1;
        return add_sides(e.number, numbers_of(e), e.corners(), region);
      }
      if (mesh_.order > 1) refuse("{}: elements of order {} stay as they are", deck_.source, mesh_.order);
      std::vector<Vec3> corners;
      for (const int i : v) corners.push_back(mesh_.points[i]);
      if (is_turned(corners, region)) std::reverse(numbers.begin() + 1, numbers.end());
      add_sides(++largest, numbers, v.size(), region);
      const auto model = models_.contains({region, v.size()}) ? models_[{region, v.size()}]
                                                              : models_.lower_bound({region, 0})->second;
      new_elements_[region].push_back({largest, model, std::move(numbers)});
    });
  }

  static Vec3 normal_of(const std::vector<Vec3>& p) { return cross(p[2] - p[0], p.back() - p[1]); }

  /// Whether an element runs the other way round than the deck's nearest one of its region.
  bool is_turned(const std::vector<Vec3>& corners, int region) {
    Facets& facets = facets_.at(region);
    if (!facets.tree) facets.tree = std::make_unique<NearestTriangle>(facets.points, facets.triangles);
    Vec3 middle;
    for (const Vec3& p : corners) middle = middle + (1.0 / static_cast<double>(corners.size())) * p;
    std::vector<Vec3> nearest;
    for (const int v : facets.triangles[facets.tree->find(middle).triangle])
      nearest.push_back(facets.points[v]);
    return dot(normal_of(nearest), normal_of(corners)) < 0;
  }
  void add_facets(const InpDeck::Element& e) {
    auto& [points, triangles, tree] = facets_[e.region];
    for (std::size_t k = 2; k < e.corners(); ++k) {
      const int n = static_cast<int>(points.size());
      for (const int v : {e.nodes[0], e.nodes[k - 1], e.nodes[k]}) points.push_back(deck_.nodes[v].at);
      triangles.push_back({n, n + 1, n + 2});
    }
  }

  /// Remembers each side by its ends, as the element runs.
  void add_sides(long long element, const Numbers& nodes, std::size_t corners, int region) {
    for (std::size_t k = 0; k < corners; ++k)
      side_at_[{nodes[k], nodes[(k + 1) % corners], region}] = {element, static_cast<int>(k)};
    used_.insert(nodes.begin(), nodes.end());
  }

  void find_gone_nodes() {
    const auto require_free = [&](int pin, const char* what, long long number) {
      if (pin > 0) refuse("{}:{}: {} {} is named and would be gone", deck_.source, pin, what, number);
    };
    for (const InpDeck::Node& node : deck_.nodes)
      if (node.joined >= 0) gone_nodes_.insert(node.number);
    for (std::size_t e = 0; e < kept_.size(); ++e) {
      if (kept_[e]) continue;
      require_free(deck_.elements[e].pin, "element", deck_.elements[e].number);
      gone_elements_.insert(deck_.elements[e].number);
      for (const int v : deck_.elements[e].nodes)
        if (const InpDeck::Node& node = kept(v); !used_.contains(node.number)) {
          require_free(node.pin, "node", node.number);
          gone_nodes_.insert(node.number);
        }
    }
  }

  static std::string lines_of(const Numbers& numbers) {
    constexpr std::size_t kPerLine = 16;
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      text +=
          fmt::format("{}{}", numbers[i], i + 1 == numbers.size() || (i + 1) % kPerLine == 0 ? "\n" : ", ");
    return text;
  }
  std::size_t end_of_line(std::size_t at) const {
    return std::min(deck_.text.find('\n', at), deck_.text.size() - 1) + 1;
  }
  void replace(std::size_t begin, std::size_t end, std::string text = "") {
    if (begin < end || !text.empty()) edits_.push_back({begin, end, std::move(text)});
  }
  static std::string keyword_line(const InpDeck::Card& card, const std::string& type) {
    std::string line = "*" + card.name;
    for (const auto& [key, value] : card.parameters)
      if (key != "GENERATE")
        line += ", " + key + (value.empty() ? "" : "=" + (key == "TYPE" && !type.empty() ? type : value));
    return line + '\n';
  }

  void edit_nodes() {
    for (const InpDeck::Node& node : deck_.nodes)
      if (gone_nodes_.contains(node.number)) replace(node.begin, end_of_line(node.begin));
    std::string text = new_nodes_.empty() ? "" : "*NODE\n";
    for (const std::size_t p : new_nodes_) {
      const Vec3& x = mesh_.points[p];
      text += fmt::format("{}, {}, {}, {}\n", number_[p], inp_number(x.x, 0), inp_number(x.y, 0),
                          inp_number(x.z, 0));
    }
    const long long largest = deck_.node_of.rbegin()->first;
    for (const auto& [name, regions] : deck_.growing) {
      Numbers added;
      for (const int r : regions)
        for (const NewElement& e : new_elements_[r])
          std::ranges::copy_if(e.nodes, std::back_inserter(added), [&](long long v) { return v > largest; });
      sort_unique(added);
      const auto home = std::ranges::find_if(deck_.cards, [&](const InpDeck::Card& card) {
        return (card.name == "NODE" || !card.numbers.empty()) && upper(card.parameter("NSET")) == upper(name);
      });
      if (home == deck_.cards.end() || added.empty()) continue;
      if (home->name == "NODE") text += fmt::format("*NSET, NSET={}\n{}", name, lines_of(added));
      if (home->name == "NSET") added_[&*home] = std::move(added);
    }
    const std::size_t end = std::ranges::find(deck_.cards, "NODE", &InpDeck::Card::name)->end;
    replace(end, end, text);
    std::size_t last = end;  // all nodes are there
    for (const InpDeck::Card& card : deck_.cards)
      if (card.name == "NODE") last = card.end;
    for (const InpDeck::Card& card : deck_.cards) {
      if (card.name != "NODE" || card.parameter("NSET").empty()) continue;
      Numbers kept_nodes;
      for (const InpDeck::Node& node : deck_.nodes)
        if (node.joined >= 0 && node.begin >= card.data && node.begin < card.end &&
            !gone_nodes_.contains(deck_.nodes[node.joined].number))
          kept_nodes.push_back(deck_.nodes[node.joined].number);
      sort_unique(kept_nodes);
      if (!kept_nodes.empty())
        replace(last, last, fmt::format("*NSET, NSET={}\n{}", card.parameter("NSET"), lines_of(kept_nodes)));
    }
  }

  void edit_elements() {
    std::map<int, bool> has_some;
    for (std::size_t e = 0; e < kept_.size(); ++e) {
      has_some[deck_.elements[e].card] |= kept_[e] != 0;
      const InpDeck::Element& element = deck_.elements[e];
      const bool changes =
          std::ranges::any_of(element.nodes, [&](int v) { return deck_.nodes[v].joined >= 0; });
      if (!kept_[e]) replace(element.begin, element.end);
      if (kept_[e] && changes)
        replace(element.begin, element.end,
                fmt::format("{}, {}\n", element.number, fmt::join(numbers_of(element), ", ")));
    }
    for (const auto& [card, some] : has_some)
      if (!some) replace(deck_.cards[card].begin, deck_.cards[card].data);
    std::map<std::pair<int, std::string>, std::string> blocks;  // by card and type
    for (const auto& [region, elements] : new_elements_)
      for (const NewElement& e : elements) {
        const std::string type = deck_.type_of(*e.model);
        const std::size_t n = e.nodes.size();
        blocks[{e.model->card, e.model->nodes.size() == n ? type : type_with(type, n)}] +=
            fmt::format("{}, {}\n", e.number, fmt::join(e.nodes, ", "));
      }
    for (const auto& [block, lines] : blocks) {
      const InpDeck::Card& card = deck_.cards[block.first];
      replace(card.end, card.end, keyword_line(card, block.second) + lines);
    }
  }

  /// Names sides of surfaces by the numbers of elements if any of these is gone. Makes sets "_NAME_E1" of our
  /// files again, in the place of the first one.
  void edit_surfaces() {
    std::map<std::pair<int, std::string>, std::vector<const InpDeck::Side*>> surfaces;
    for (const InpDeck::Side& row : deck_.sides)
      surfaces[{row.card, row.card < 0 ? row.surface : ""}].push_back(&row);
    for (const auto& [surface, rows] : surfaces) {
      std::string text;
      std::map<std::string, Numbers> by_label;
      bool changes = false;
      std::set<std::string, LessBlindToCase> sets;
      for (const InpDeck::Side* row : rows)
        if (names_side(deck_, *row))
          changes |= move_sides(*row, by_label), sets.insert(row->elements);
        else
          text += row->elements + ", " + row->label + '\n';
      if (!changes) continue;
      for (auto& [label, numbers] : by_label) {
        sort_unique(numbers);
        text += surface.first < 0
                    ? fmt::format("*ELSET, ELSET=_{}_{}\n{}", surface.second, label, lines_of(numbers))
                    : fmt::format("{}, {}\n", fmt::join(numbers, fmt::format(", {}\n", label)), label);
      }
      if (surface.first >= 0) replace(deck_.cards[surface.first].data, deck_.cards[surface.first].end, text);
      for (const InpDeck::Card& card : deck_.cards)
        if (surface.first < 0 && card.name == "ELSET" && sets.contains(card.parameter("ELSET"))) {
          replace(card.begin, card.end, std::exchange(text, ""));
          replaced_.insert(&card);
        }
    }
  }

  /// Renames joined nodes in the rows of surfaces of nodes.
  void edit_node_surfaces() {
    for (const InpDeck::Card& card : deck_.cards) {
      if (card.name != "SURFACE" || upper(card.parameter("TYPE")) != "NODE") continue;
      std::set<long long> known;
      for (const bool is_first_pass : {true, false})
        for (std::size_t at = card.data, next = 0; at < card.end; at = next) {
          next = end_of_line(at);
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
  bool move_sides(const InpDeck::Side& row, std::map<std::string, Numbers>& by_label) const {
    bool changes = false;
    for (const int index : deck_.elements_of(row)) {
      const InpDeck::Element& e = deck_.elements[index];
      const int side = deck_.side_of(e, row.label);
      const auto number = [&](int k) {
        return kept(e.nodes[static_cast<std::size_t>(k) % e.corners()]).number;
      };
      const auto at = side_at_.find({number(side), number(side + 1), e.region});
      if (at == side_at_.end())
        refuse("{}:{}: side {} of element {} would be gone", deck_.source, row.line, row.label, e.number);
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
    const auto of_sides = sets_of_sides(deck_);
    std::set<std::pair<std::string, long long>> done;  // sets with new elements
    for (const auto& [region, elements] : new_elements_)
      for (const NewElement& e : elements)
        done.emplace(upper(deck_.cards[e.model->card].parameter("ELSET")), e.number);
    for (const InpDeck::Card& card : deck_.cards) {
      if (card.numbers.empty() || replaced_.contains(&card)) continue;
      Numbers& added = added_[&card];
      const std::string set = upper(card.parameter("ELSET"));
      std::set<int> regions;
      for (const long long number : card.numbers)
        if (const auto e = deck_.element_of.find(number); card.name == "ELSET" && e != deck_.element_of.end())
          if (deck_.elements[e->second].corners() > 2) regions.insert(deck_.elements[e->second].region);
      for (const int r : regions)
        if (const auto found = new_elements_.find(r); found != new_elements_.end() && !of_sides.contains(set))
          for (const NewElement& e : found->second)
            if (done.emplace(set, e.number).second) added.push_back(e.number);
      edit_set(card, card.name == "NSET" ? gone_nodes_ : gone_elements_, added);
    }
  }

  void edit_set(const InpDeck::Card& card, const std::set<long long>& gone, const Numbers& added) {
    Numbers numbers;
    std::set<long long> known(card.numbers.begin(), card.numbers.end());
    for (const long long i : card.numbers) {
      const long long number = card.name == "NSET" ? kept_number(i) : i;
      if (!gone.contains(number) && (number == i || known.insert(number).second)) numbers.push_back(number);
    }
    if (numbers == card.numbers && added.empty()) return;
    numbers.insert(numbers.end(), added.begin(), added.end());
    if (numbers.empty() && card.names.empty()) return replace(card.begin, card.end);
    const bool has_keyword = card.parameters.contains("GENERATE");
    std::string text = has_keyword ? keyword_line(card, "") : "";
    for (const std::string& name : card.names) text += name + '\n';
    replace(has_keyword ? card.begin : card.data, card.end, text + lines_of(numbers));
  }

  struct NewElement {
    long long number;
    const InpDeck::Element* model;  ///< of its region; gives it type and block
    Numbers nodes;
  };
  struct Facets {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::unique_ptr<NearestTriangle> tree = nullptr;
  };
  const InpDeck& deck_;
  const Mesh& mesh_;
  Numbers number_;                                       ///< of each point of the mesh
  std::vector<std::size_t> new_nodes_;                   ///< points of the mesh
  std::vector<char> kept_;                               ///< by element of the deck
  std::map<int, std::vector<NewElement>> new_elements_;  ///< by region
  std::map<std::tuple<long long, long long, int>, std::pair<long long, int>>
      side_at_;                                                            ///< by ends and region
  std::map<std::pair<int, std::size_t>, const InpDeck::Element*> models_;  ///< by region and number of nodes
  std::map<int, Facets> facets_;                                           ///< by region
  std::set<long long> used_, gone_nodes_, gone_elements_;
  std::map<const InpDeck::Card*, Numbers> added_;
  std::set<const InpDeck::Card*> replaced_;
  std::vector<Edit> edits_;
};

}  // namespace

void part_elements(InpDeck& deck) {
  std::map<std::pair<bool, std::string>, std::string> instances;
  for (const InpDeck::Card& card : deck.cards) {
    const bool of_nodes = card.is_among("|NODE|NSET|");
    const std::string name = upper(card.parameter(of_nodes ? "NSET" : "ELSET")),
                      of = card.parameter("INSTANCE");
    const bool has_set = !name.empty() && (of_nodes || card.is_among("|ELEMENT|ELSET|"));
    if (has_set && instances.try_emplace({of_nodes, name}, of).first->second != of)
      refuse("{}:{}: set {} is in a part and in its assembly: expected two names", deck.source, card.line,
             name);
  }
  const auto of_sides = sets_of_sides(deck);
  for (const auto& [name, members] : deck.element_sets)
    for (const int e : members)
      if (name[0] == '_' && !of_sides.contains(name)) deck.elements[e].sets.push_back(name);
  pin_elements(deck);
  Mesh flat;
  flat.points.resize(deck.nodes.size());
  std::vector<InpDeck::Element*> shells;  // triangles first
  for (const std::size_t corners : {3, 4})
    for (InpDeck::Element& e : deck.elements) {
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

void name_points(InpDeck& deck) {
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
  std::vector<char> is_told(mesh.points.size(), 0);  // not by its place alone
  for (std::size_t v = 0; v < names.size(); ++v) {
    if (used[v] && names[v] != static_cast<int>(v)) is_told[v] = is_told[names[v]] = 1;
    if (used[v] && !stays[v] && deck.nodes[v].pin >= 0) is_told[v] = 1, ++deck.n_named;
  }
  for (std::size_t v = 0; v < is_told.size(); ++v) {
    if (!is_told[v] || !used[v]) continue;
    const long long number = deck.nodes[v].number;
    if (number > INT_MAX) refuse("{}: node {}: expected a number up to {}", deck.source, number, INT_MAX);
    mesh.named_points.push_back({static_cast<int>(v), {static_cast<int>(number), {}}});
  }
  deck.point_of = drop_unused_points(mesh);
}

void rewrite_inp(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                 double weld) {
  InpDeck deck = read_inp_deck(source, true);
  join_nodes(deck, weld);
  write_text_file(path, std::string_view(InpRewriter(deck, mesh).text()));
}

}  // namespace delquad
