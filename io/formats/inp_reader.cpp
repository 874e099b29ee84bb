// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"
#include "io/cell_view.h"
#include "io/entity_names.h"
#include "io/face_reader.h"
#include "io/formats/deck.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"

namespace delquad {

namespace {

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (size_t at = 0; at <= line.size();) {
    const size_t comma = std::min(line.find(',', at), line.size());
    fields.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

/// The keyword of a card and its parameters.
Deck::Card card_of(std::string_view line) {
  Deck::Card keyword;
  const auto fields = fields_of(line.substr(1));
  if (fields.empty()) return keyword;
  keyword.name = upper(fields[0]);
  for (size_t k = 1; k < fields.size(); ++k) {
    const size_t equals = std::min(fields[k].find('='), fields[k].size());
    std::string_view value = trimmed(fields[k].substr(std::min(equals + 1, fields[k].size())));
    if (value.size() > 1 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    keyword.parameters[upper(trimmed(fields[k].substr(0, equals)))] = value;
  }
  return keyword;
}

/// Nodes of an element type; 0: not one of lines, triangles, quads, hexahedra, prisms and tetrahedra.
int nodes_of_type(const std::string& type) {
  static const std::pair<const char*, int> kinds[] = {
      {"S4", 4},     {"CPS4", 4},    {"CPE4", 4},   {"CPEG4", 4},   {"CAX4", 4},   {"M3D4", 4},
      {"R3D4", 4},   {"SFM3D4", 4},  {"DS4", 4},    {"DC2D4", 4},   {"S3", 3},     {"STRI3", 3},
      {"CPS3", 3},   {"CPE3", 3},    {"S8", 8},     {"CPS8", 8},    {"CPE8", 8},   {"CPEG8", 8},
      {"CAX8", 8},   {"M3D8", 8},    {"SFM3D8", 8}, {"DS8", 8},     {"DC2D8", 8},  {"CPEG3", 3},
      {"CAX3", 3},   {"M3D3", 3},    {"R3D3", 3},   {"SFM3D3", 3},  {"DS3", 3},    {"DC2D3", 3},
      {"T2D2", 2},   {"T3D2", 2},    {"B21", 2},    {"B31", 2},     {"R2D2", 2},   {"RAX2", 2},
      {"C3D8", 8},   {"DC3D8", 8},   {"C3D20", 20}, {"DC3D20", 20}, {"C3D4", 4},   {"DC3D4", 4},
      {"C3D10", 10}, {"DC3D10", 10}, {"C3D6", 6},   {"DC3D6", 6},   {"C3D15", 15}, {"DC3D15", 15}};
  for (const auto& [name, n] : kinds) {
    const std::string_view rest =
        std::string_view(type).substr(std::min(type.size(), std::string_view(name).size()));
    if (type.starts_with(name) && (rest.empty() || !(rest[0] >= '0' && rest[0] <= '9') || rest == "5"))
      return n;
  }
  return 0;
}

/// Keywords between bars. Data of kNoNumbers holds no numbers of nodes and elements. Data of kOfNodes holds
/// no numbers of elements. kRefused make nodes, elements or coordinates. --weld may join nodes of kMayJoin.
/// Sets of kMayGrow may get new nodes.
constexpr std::string_view
    kNoNumbers =
        "|AMPLITUDE|BEAM SECTION|BUCKLE|CONDUCTIVITY|CONTROLS|DAMPING|DENSITY|DYNAMIC|EL FILE|EL PRINT|"
        "ELASTIC|ELEMENT OUTPUT|EXPANSION|FREQUENCY|FRICTION|HEADING|HEAT TRANSFER|MATERIAL|"
        "MEMBRANE SECTION|NODE FILE|NODE OUTPUT|NODE PRINT|OUTPUT|PLASTIC|SHELL GENERAL SECTION|"
        "SHELL SECTION|SOLID SECTION|SPECIFIC HEAT|STATIC|STEP|SURFACE BEHAVIOR|SURFACE INTERACTION|VISCO|",
    kRead = "|HEADING|NODE|ELEMENT|NSET|ELSET|SURFACE|",
    kRefused = "|ELCOPY|ELGEN|INCLUDE|NCOPY|NFILL|NGEN|NMAP|SYSTEM|",
    kOfNodes =
        "|BOUNDARY|CFLUX|CLOAD|ELEMENT|EQUATION|FIELD|MPC|NODAL THICKNESS|SURFACE|TEMPERATURE|TRANSFORM|",
    kMayJoin = "|DFLUX|DLOAD|FILM|FOUNDATION|RADIATE|SURFACE|TRANSFORM|",
    kMayGrow = "|BOUNDARY|FIELD|INITIAL CONDITIONS|NODAL THICKNESS|SURFACE|TEMPERATURE|TRANSFORM|";

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)); }

/// "P2", "EDNOR1"
bool is_side(std::string_view label) {
  return !label.empty() && begins_name(label.front()) &&
         std::isdigit(static_cast<unsigned char>(label.back()));
}

bool is_solid_type(const std::string& type) { return type.find("C3D") != std::string::npos; }

class InpReader {
 public:
  InpReader(const std::filesystem::path& path, bool as_deck) : in_(path), as_deck_(as_deck) {
    refuse_other_kinds(in_, "INP");
    deck_.source = path.string();
  }

  Deck read() {
    while (!in_.at_end()) {
      const std::string_view line = trimmed(in_.rest_of_line());
      const size_t place = place_of(line);
      if (line.starts_with("**")) continue;
      if (line.starts_with("*")) {
        begin(whole_keyword(line), place);
      } else {
        data(line, place);
        deck_.cards.back().end = line_end();
      }
    }
    if (!pending_.empty()) in_.fail("the file ends within an element: expected a whole file");
    if (deck_.elements.empty() && unread_line_ > 0) fail_type(unread_line_);
    if (deck_.elements.empty()) in_.fail("the file holds no *ELEMENT of lines, triangles, quads or cells");
    add_sides_of_shells();
    name_elements();
    check_instances();
    if (as_deck_) part_elements(deck_);
    make_mesh();
    as_deck_ ? name_points(deck_) : add_node_sets();
    deck_.text = in_.text();
    drop_unused_points(mesh_);
    return std::move(deck_);
  }

 private:
  using Card = Deck::Card;
  using Element = Deck::Element;

  /// Where the line begins that a text of it is from.
  size_t place_of(std::string_view line) const {
    return in_.text().rfind('\n', static_cast<size_t>(line.data() - in_.text().data())) + 1;
  }
  /// Behind the line that was read last.
  size_t line_end() const {
    const size_t at = in_.text().size() - in_.bytes_left();
    return std::min(in_.text().find('\n', at), in_.text().size() - 1) + 1;
  }

  /// With the lines that it goes on in, which begin with a letter.
  std::string whole_keyword(std::string_view line) {
    std::string whole(line);
    while (whole.ends_with(',') && !in_.at_end() &&
           begins_name(in_.text()[in_.text().size() - in_.bytes_left()]))
      whole += trimmed(in_.rest_of_line());
    return whole;
  }

  [[noreturn]] void fail_type(int line) const {
    in_.fail_at(line,
                "element type {}: expected lines or triangles of first order, quads{}, such as S4, CPS4, S3, "
                "S8R{}",
                TextScanner::printable(unread_type_), as_deck_ ? "" : ", hexahedra, prisms or tetrahedra",
                as_deck_ ? "" : ", C3D8, C3D6, C3D4");
  }

  void begin(const std::string& line, size_t place) {
    if (!pending_.empty()) in_.fail("an element ends too early: expected more nodes");
    Card& card = deck_.cards.emplace_back(card_of(line));
    card.line = in_.line();
    card.begin = place;
    card.data = card.end = line_end();
    goes_on_ = false;
    if (card.is_among(kRefused) || (card.name == "NODE" && card.parameters.contains("SYSTEM")) ||
        (card.is_among(kRead) && card.parameters.contains("INPUT")))
      in_.fail(
          "*{}: expected a file that holds the whole mesh, with Cartesian coordinates of all nodes "
          "[deck-in-parts]",
          card.name);
    if (!card.is_among(kRead)) {
      ++deck_.others['*' + card.name];
      for (const auto& [key, value] : card.parameters) other({value});  // REF NODE=17
    }
    const std::string nset = card.parameter("NSET"), elset = card.parameter("ELSET"),
                      type = upper(card.parameter("TYPE"));
    const bool of_nodes = card.name == "NODE" || card.name == "NSET";
    std::vector<int>& set = of_nodes ? deck_.node_sets[nset] : deck_.element_sets[elset];
    set_ = (of_nodes ? nset : elset).empty() ? nullptr : &set;
    if (card.name == "NSET" && !elset.empty()) {
      for (const int e : deck_.element_sets[elset])
        set.insert(set.end(), deck_.elements[e].nodes.begin(), deck_.elements[e].nodes.end());
      sort_unique(set);
    }
    if (card.name != "ELEMENT") return;
    n_nodes_ = as_deck_ && is_solid_type(type) ? 0 : nodes_of_type(type);
    if (n_nodes_ > 0) return;
    ++deck_.others["*ELEMENT, TYPE=" + type];
    if (unread_line_ == 0) unread_line_ = in_.line(), unread_type_ = type;
  }

  void data(std::string_view line, size_t place) {
    const Card& card = deck_.cards.back();
    const auto fields = fields_of(line);
    const bool is_side = card.name == "SURFACE" && upper(card.parameter("TYPE")) != "NODE" && !fields.empty();
    if (card.name == "NODE") {
      node(fields, place);
    } else if (card.name == "ELEMENT" && n_nodes_ > 0) {
      element(fields, place);
    } else if (card.name == "ELSET") {
      members(fields, deck_.element_sets, deck_.element_of);
    } else if (card.name == "NSET") {
      members(fields, deck_.node_sets, deck_.node_of);
    } else if (is_side) {
      deck_.sides.push_back({card.parameter("NAME"), std::string(fields[0]),
                             std::string(fields.size() > 1 ? fields[1] : ""), in_.line(),
                             static_cast<int>(deck_.cards.size()) - 1});
    } else {
      other(fields);
    }
    goes_on_ = line.ends_with(',');
  }

  /// Keeps what may name nodes and elements.
  void other(const std::vector<std::string_view>& fields) {
    const Card& card = deck_.cards.back();
    for (size_t k = 0; k < fields.size() && !card.is_among(kNoNumbers); ++k) {
      const std::string_view text = fields[k];
      Deck::Word word{std::string(text), in_.line(), static_cast<int>(deck_.cards.size()) - 1};
      word.has_side = k + 1 < fields.size() && is_side(fields[k + 1]);
      word.may_grow = card.is_among(kMayGrow);
      word.counts_nodes = card.is_among(kOfNodes) && !word.may_grow;
      word.forbids_join =
          !card.is_among(kMayJoin) && (k == 0 || !(word.may_grow || card.is_among("|CFLUX|CLOAD|")));
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), word.number);
      if (error != std::errc() || end != text.data() + text.size()) word.number = 0;
      word.of_element = !card.is_among(kOfNodes) && (k == 0 || word.number == 0);
      if (card.name == "ELEMENT" && k == 0 && !goes_on_)
        deck_.unread.insert(word.number);
      else if (as_deck_ && !text.empty() && (word.number > 0 || begins_name(text[0]) || text[0] == '_'))
        deck_.words.push_back(std::move(word));
    }
  }

  long long integer(std::string_view text, const char* what) const {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1)
      in_.fail("expected {} (an integer > 0), found {}", what, TextScanner::printable(text));
    return value;
  }

  double real(std::string_view text) const {
    if (text.empty()) return 0;  // as Abaqus has it
    double value = 0;
    const std::string_view digits = text[0] == '+' ? text.substr(1) : text;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      in_.fail("expected a coordinate (a finite number), found {}", TextScanner::printable(text));
    return value;
  }

  void node(const std::vector<std::string_view>& fields, size_t place) {
    if (fields.empty()) return;
    const long long number = integer(fields[0], "a node's number");
    const auto x = [&](size_t k) { return fields.size() > k ? real(fields[k]) : 0; };
    const int index = static_cast<int>(deck_.nodes.size());
    if (!deck_.node_of.emplace(number, index).second)
      in_.fail("node {} is there twice; files of several parts cannot be read [deck-in-parts]", number);
    deck_.nodes.push_back({number, {x(1), x(2), x(3)}, place, line_end()});
    mesh_.points.push_back(deck_.nodes.back().at);
    if (set_ != nullptr) set_->push_back(index);
  }

  void element(const std::vector<std::string_view>& fields, size_t place) {
    if (pending_.empty()) begin_of_element_ = place;
    for (const std::string_view field : fields) pending_.push_back(integer(field, "a node's number"));
    if (pending_.size() < static_cast<size_t>(n_nodes_) + 1) return;
    if (pending_.size() > static_cast<size_t>(n_nodes_) + 1)
      in_.fail("an element of {} nodes has {}", n_nodes_, pending_.size() - 1);
    Element e{pending_[0],       {},        in_.line(), static_cast<int>(deck_.cards.size()) - 1,
              begin_of_element_, line_end()};
    for (size_t k = 1; k < pending_.size(); ++k) {
      const auto found = deck_.node_of.find(pending_[k]);
      if (found == deck_.node_of.end())
        in_.fail("there is no node {} yet: expected *NODE before it", pending_[k]);
      e.nodes.push_back(found->second);
    }
    const int index = static_cast<int>(deck_.elements.size());
    if (!deck_.element_of.emplace(pending_[0], index).second)
      in_.fail("element {} is there twice; files of several parts cannot be read [deck-in-parts]",
               pending_[0]);
    if (set_ != nullptr) set_->push_back(index);
    e.is_solid = is_solid_type(deck_.type_of(e));
    deck_.elements.push_back(std::move(e));
    pending_.clear();
  }

  /// Numbers, or names of other sets. Elements of types that are not read count for no set.
  void members(const std::vector<std::string_view>& fields, DeckSets& sets,
               const std::map<long long, int>& index_of) {
    Card& card = deck_.cards.back();
    const bool of_elements = &sets == &deck_.element_sets;
    const char* const what = of_elements ? "an element's number" : "a node's number";
    std::vector<int>& all = sets[card.parameter(card.name)];
    const auto add = [&](long long number) {
      if (as_deck_) card.numbers.push_back(number);
      if (const auto found = index_of.find(number); found != index_of.end())
        all.push_back(found->second);
      else if (of_elements && !deck_.unread.contains(number))
        in_.fail("there is no element {} yet: expected *ELEMENT before it", number);
    };
    const bool generates = card.parameters.contains("GENERATE");
    if (generates && fields.size() < 2) in_.fail("expected the first and the last {}", what);
    if (generates) {
      const long long last = integer(fields[1], what),
                      step = fields.size() > 2 ? integer(fields[2], "a step") : 1;
      for (long long number = integer(fields[0], what); number <= last; number += step) {
        const auto next = index_of.lower_bound(number);  // sets of nodes may have gaps
        if (!of_elements && next == index_of.end()) break;
        if (!of_elements) number += (next->first - number) / step * step;
        if (of_elements || index_of.contains(number)) add(number);
        if (number > last - step) break;
      }
    }
    for (std::size_t k = 0; k < fields.size() && !generates; ++k) {
      const std::string_view field = fields[k];
      if (!field.empty() && field[0] >= '0' && field[0] <= '9') {
        add(integer(field, what));
        continue;
      }
      card.names.emplace_back(field);
      const auto other = sets.find(std::string(field));
      if (other == sets.end() && of_elements)
        in_.fail("there is no element set {} yet: expected *ELSET before it", TextScanner::printable(field));
      if (other == sets.end()) continue;
      const std::vector<int> copy = other->second;
      all.insert(all.end(), copy.begin(), copy.end());
    }
    // Sets that hold themselves, or what they generate, would double each time.
    if (all.size() > index_of.size()) sort_unique(all);
    if (card.numbers.size() > index_of.size() + deck_.unread.size()) sort_unique(card.numbers);
  }

  /// A set named by a leading underscore is a part of something else, and "Eall" names the whole.
  void name_elements() {
    for (DeckSets* sets : {&deck_.element_sets, &deck_.node_sets})
      for (auto& [name, members] : *sets) sort_unique(members);
    for (const auto& [name, members] : deck_.element_sets)
      for (const int e : members)
        if (!name.empty() && name[0] != '_' && (name != "Eall" || members.size() != deck_.elements.size()))
          deck_.elements[e].sets.push_back(name);
    for (Element& e : deck_.elements) std::ranges::sort(e.sets);
  }

  void check_instances() const {
    if (!as_deck_) return;
    std::map<std::pair<bool, std::string>, std::string> instances;
    for (const Deck::Card& card : deck_.cards) {
      const bool of_nodes = card.is_among("|NODE|NSET|");
      const std::string name = upper(card.parameter(of_nodes ? "NSET" : "ELSET")),
                        of = card.parameter("INSTANCE");
      const bool has_set = !name.empty() && (of_nodes || card.is_among("|ELEMENT|ELSET|"));
      if (has_set && instances.try_emplace({of_nodes, name}, of).first->second != of)
        in_.fail_at(card.line, "set {} is in a part and in its assembly: expected two names", name);
    }
  }

  void make_mesh() {
    std::map<std::pair<int, std::vector<std::string>>, int> index;
    for (Element& e : deck_.elements) {
      const int dim = dimension_of(e.shape());
      std::vector<Entity>& entities = entities_of(mesh_, dim);
      const auto [it, is_new] = index.emplace(std::pair{dim, e.sets}, static_cast<int>(entities.size()));
      if (is_new) entities.push_back({it->second + 1, e.sets});
      std::erase_if(entities.back().names,
                    [](const std::string& name) { return name[0] == '_' || name[0] == '#'; });
      e.region = it->second;
      const std::string wrong = add_element(mesh_, e.shape(), e.nodes, e.region);
      if (!wrong.empty()) in_.fail_at(e.line, "{}", wrong);
    }
    add_surfaces();
    take_numbers(mesh_);
  }

  /// Adds the sides of shells along curves. Our writer has them in sets "_NAME_E2", without surfaces.
  void add_sides_of_shells() {
    const auto is_used = [&](const std::string& set) {
      return std::ranges::find(deck_.sides, set, &Deck::Side::elements) != deck_.sides.end();
    };
    for (const auto& [set, members] : deck_.element_sets) {
      const size_t n = set.size();
      if (n > 4 && set[0] == '_' && set[n - 3] == '_' && set[n - 2] == 'E' && !members.empty() &&
          !is_used(set))
        deck_.sides.push_back(
            {set.substr(1, n - 4), set, set.substr(n - 2), deck_.elements[members[0]].line, -1});
    }
  }

  /// Sides "S2" or "E2" of elements become lines, or faces of cells. Sides on several surfaces are of a
  /// curve or face of all their names. Surfaces of whole elements are no curves.
  void add_surfaces() {
    // By dimension, and the nodes of a line, its ends first, or of a face, the least first.
    std::map<std::pair<int, std::vector<int>>, std::vector<std::string>> names_of;
    for (const Deck::Side& s : deck_.sides) {
      for (const int e : deck_.elements_of(s)) {
        const int side = deck_.side_of(deck_.elements[e], s.label);
        if (side < 0) continue;
        const std::vector<int>& v = deck_.elements[e].nodes;
        const bool is_cell = deck_.elements[e].is_solid;
        const CellShape shape = deck_.elements[e].shape();
        const size_t k = static_cast<size_t>(side),
                     n = is_cell ? solid_shape(shape).sides.size() : corners_of(shape);
        if (k >= n || n < 3) in_.fail_at(s.line, "an element has no side {}", s.label);
        std::vector<int> nodes = {v[k % v.size()], v[(k + 1) % n]}, other = {nodes[1], nodes[0]};
        if (!is_cell && v.size() == 8) nodes.push_back(v[4 + k]);
        if (is_cell) {
          const std::array<int, 4> face = Solid{&solid_shape(shape), v}.side(side);
          nodes.assign(face.begin(), face.end() - (face[3] < 0 ? 1 : 0));
          std::ranges::rotate(nodes, std::ranges::min_element(nodes));
          other = nodes;
          std::reverse(other.begin() + 1, other.end());
        }
        const int dim = is_cell ? 2 : 1;
        if (names_of.contains({dim, other})) nodes = other;  // of a neighbor
        std::vector<std::string>& names = names_of[{dim, nodes}];
        if (std::find(names.begin(), names.end(), s.surface) == names.end()) names.push_back(s.surface);
      }
    }
    std::map<std::pair<int, std::vector<std::string>>, int> index;
    for (const auto& [key, names] : names_of) {
      const auto& [dim, nodes] = key;
      std::vector<Entity>& entities = entities_of(mesh_, dim);
      const auto [it, is_new] = index.emplace(std::pair{dim, names}, static_cast<int>(entities.size()));
      if (is_new) entities.push_back({it->second + 1, names});
      if (dim == 1) add_line(mesh_, nodes, it->second);
      if (dim == 2) add_element(mesh_, static_cast<int>(nodes.size()), nodes, it->second);
    }
  }

  /// Nodes of a set are named points, unless it is one of a volume, a region or a curve.
  void add_node_sets() {
    std::set<std::string, LessBlindToCase> known = {""};
    for (const auto* entities : {&mesh_.curves, &mesh_.regions, &mesh_.volumes})
      for (const Entity& entity : *entities) known.insert(entity.names.begin(), entity.names.end());
    const DeckSets filled = deck_.filled_regions();
    NamedPoints points;
    for (const auto& [name, nodes] : deck_.node_sets)
      if (!known.contains(name) && !filled.contains(name) && name[0] != '_' && !name.starts_with("curve_"))
        for (const int v : nodes) points.add(mesh_, v, name);
  }

  TextScanner in_;
  const bool as_deck_;
  Deck deck_;
  Mesh& mesh_ = deck_.mesh;
  int n_nodes_ = 0;                  ///< of the elements of a card; 0: they are not read
  std::vector<int>* set_ = nullptr;  ///< of a card with nodes or elements; null: they are in none
  std::vector<long long> pending_;   ///< of an element that goes on in the next line
  size_t begin_of_element_ = 0;
  bool goes_on_ = false;  ///< a line of data that is not read, in the next one
  int unread_line_ = 0;   ///< of the first type that is not read
  std::string unread_type_;
};

class InpText : public DeckText {
 public:
  using DeckText::DeckText;
  using Numbers = std::vector<long long>;

  std::string head_of_nodes() const override { return "*NODE\n"; }
  std::string node(long long number, const Vec3& at, const Deck::Card* /*card*/) const override {
    return fmt::format("{}, {}, {}, {}\n", number, inp_number(at.x, 0), inp_number(at.y, 0),
                       inp_number(at.z, 0));
  }
  std::string as_in(const Deck::Card& card, const Numbers& nodes, bool /*are_new*/) const override {
    return fmt::format("*NSET, NSET={}\n{}", card.parameter("NSET"), inp_lines(nodes));
  }
  std::string head(const Deck::Card& card, const std::string& type) const override {
    std::string line = "*" + card.name;
    for (const auto& [key, value] : card.parameters)
      if (key != "GENERATE")
        line += ", " + key + (value.empty() ? "" : "=" + (key == "TYPE" && !type.empty() ? type : value));
    return line + '\n';
  }
  std::string element(long long number, const Deck::Element& /*model*/, const std::string& /*type*/,
                      const Numbers& nodes, double /*angle*/) const override {
    return fmt::format("{}, {}\n", number, fmt::join(nodes, ", "));
  }
  std::string type_with(std::string type, std::size_t corners) const override {  // S3 and S4
    const char digit = corners == 3 ? '4' : '3', other = corners == 3 ? '3' : '4';
    if (type.starts_with("STRI")) type = "S3";
    const std::size_t at = type.rfind(digit);
    if (at == std::string::npos) return type;
    type[at] = other;
    return corners == 3 ? type.substr(0, at + 1) : type;  // there is no S3R5
  }
  std::string set(const Deck::Card& card, const Numbers& numbers) const override {
    std::string text = card.parameters.contains("GENERATE")
                           ? head(card, "")
                           : deck_.text.substr(card.begin, card.data - card.begin);
    std::erase(text, '\r');
    for (const std::string& name : card.names) text += name + '\n';
    return text + inp_lines(numbers);
  }
};

}  // namespace

Deck read_inp_deck(const std::filesystem::path& path, bool as_deck) {
  return InpReader(path, as_deck).read();
}

std::string inp_lines(const std::vector<long long>& numbers) {
  constexpr std::size_t kPerLine = 16;
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += fmt::format("{}{}", numbers[i], i + 1 == numbers.size() || (i + 1) % kPerLine == 0 ? "\n" : ", ");
  return text;
}

void rewrite_inp(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                 double weld) {
  Deck deck = read_inp_deck(source, true);
  rewrite_deck(deck, InpText(deck), path, mesh, weld);
}

}  // namespace delquad
