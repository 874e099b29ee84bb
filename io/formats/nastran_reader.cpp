// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "base/located.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "io/entity_names.h"
#include "io/face_reader.h"
#include "io/formats/deck.h"
#include "io/formats/nastran_card.h"
#include "io/text_scanner.h"

namespace delquad {
namespace {

bool is_among(const std::string& name, std::string_view names) {
  return names.find('|' + name + '|') != std::string_view::npos;
}

/// Names between bars. The first cards have no numbers of nodes and elements, the second ones of nodes alone.
constexpr std::string_view
    kWithoutNumbers =
        "|PSHELL|PCOMP|PCOMPG|PBAR|PBARL|PBEAM|PBEAML|PBCOMP|PROD|PTUBE|PSOLID|PLSOLID|PBUSH|PBUSHT|PELAS|"
        "PELAST|PMASS|PSHEAR|PGAP|PDAMP|PVISC|PWELD|PFAST|PARAM|LOAD|SPCADD|MPCADD|GRAV|DLOAD|TEMPD|NLPARM|"
        "TSTEP|TSTEPNL|MDLPRM|ENDDATA|",
    kOfNodesAlone =
        "|SPC1|MPC|RBE1|RBE3|ASET|ASET1|BSET|BSET1|CSET|CSET1|OMIT|OMIT1|QSET|QSET1|USET|USET1|SUPORT|"
        "SUPORT1|"
        "SPOINT|EPOINT|DAREA|CORD1R|CORD1C|CORD1S|SPCOFF|SPCOFF1|";

/// The fields of a card in which nodes stand, from 0. The last one stands for all further ones, too.
std::span<const int> fields_of_nodes(const std::string& name) {
  static const std::map<std::string, std::vector<int>> fields = {
      {"FORCE", {1}},      {"MOMENT", {1}},        {"FORCE1", {1, 3, 4}}, {"MOMENT1", {1, 3, 4}},
      {"SPC", {1, 4}},     {"SPCD", {1, 4}},       {"RBAR", {1, 2}},      {"RBE2", {1, 3, -1}},
      {"TEMP", {1, 3, 5}}, {"CONM2", {1}},         {"CBUSH", {2, 3, 4}},  {"CELAS1", {2, 4}},
      {"CELAS2", {2, 4}},  {"PLOAD", {2, 3, 4, 5}}};
  const auto found = fields.find(name);
  return found == fields.end() ? std::span<const int>() : std::span<const int>(found->second);
}

/// Whether SETs that a request of case control names are of nodes (0) or elements (1); -1: it is another one.
int kind_of_request(std::string_view request) {
  for (const char* of_nodes :
       {"DISP", "VECT", "VELO", "ACCE", "SPCF", "OLOA", "MPCF", "GPFO", "THER", "PRES"})
    if (request.starts_with(of_nodes)) return 0;
  for (const char* of_elements : {"STRE", "ELST", "STRA", "FORC", "ELFO", "ESE", "EDE", "EKE"})
    if (request.starts_with(of_elements)) return 1;
  return -1;
}

class NastranReader {
 public:
  NastranReader(const std::filesystem::path& path, bool as_deck) : in_(path), as_deck_(as_deck) {
    refuse_other_kinds(in_, "Nastran");
    const std::string text = upper(in_.text());
    in_bulk_ = !text.starts_with("BEGIN") && text.find("\nBEGIN") == std::string::npos;
    deck_.source = path.string();
  }

  Deck read() {
    do take_line(in_.rest_of_line());
    while (!is_over_ && in_.next_line());
    end_card();
    if (deck_.elements.empty() && unread_.line > 0)
      in_.fail_at(unread_.line, "{}: expected a mesh of lines, CTRIA3, CQUAD4 and CQUAD8", unread_.name);
    if (deck_.elements.empty()) in_.fail("the file holds no lines, triangles or quads, such as CQUAD4");
    deck_.text = in_.text();
    find_nodes();
    if (as_deck_) {
      take_sets();
      for (const NastranCard& card : cards_) take_others(card);
      deck_.unread.merge(rigid_);
      for (auto* sets : {&deck_.node_sets, &deck_.element_sets})
        for (auto& [name, members] : *sets) sort_unique(members);
      for (const auto& [name, members] : deck_.element_sets)
        for (const int e : members) deck_.elements[e].sets.push_back(name);
      part_elements(deck_);
    }
    make_mesh();
    if (as_deck_) name_points(deck_);
    drop_unused_points(deck_.mesh);
    return std::move(deck_);
  }

 private:
  using Numbers = std::vector<long long>;

  void take_line(std::string_view line) {
    if (line.starts_with('$')) return take_comment(line);
    const std::string text = without_tabs(line);
    if (trimmed(text).empty()) return;
    const std::string title = upper(trimmed(text));
    if (title.starts_with("INCLUDE"))
      in_.fail("INCLUDE: expected a file that holds the whole mesh [deck-in-parts]");
    if (title.starts_with("ENDDATA")) is_over_ = true;
    if (title.starts_with("BEGIN")) in_bulk_ = true;
    if (is_over_ || title.starts_with("BEGIN")) return;
    const std::size_t begin = static_cast<std::size_t>(line.data() - in_.text().data()),
                      end = std::min(in_.text().find('\n', begin), in_.text().size() - 1) + 1;
    if (in_bulk_) return take_bulk(text, begin, end);
    take_request(title, begin, end);
  }

  /// Names that write_nastran() leaves.
  void take_comment(std::string_view line) {
    if (entities_.take_name(line, "$ property ", ": ", 2)) return;
    if (const std::string unit = unit_in_comment(line, "$"); !unit.empty()) deck_.mesh.unit = unit;
    if (const std::size_t at = line.find(", nodes of ");
        line.starts_with("$ set ") && at != std::string_view::npos)
      told_ = trimmed(line.substr(at + std::string_view(", nodes of ").size()));
  }

  struct Set {
    std::string number;
    std::vector<std::string> members = {};
    std::string from_comment = {};  ///< "point tip", by the comment of our files before it
    int line = 0;
    std::size_t begin = 0, end = 0;
  };

  static bool is_of_point(const Set& set) { return set.from_comment.starts_with("point "); }

  /// "SET 3 = 7, 8," and lines after it, or a request that names a set.
  void take_request(std::string_view title, std::size_t begin, std::size_t end) {
    const std::size_t equals = title.find('=');
    if (!set_goes_on_ && equals == std::string_view::npos) return;
    if (!set_goes_on_) {
      const std::string_view key = trimmed(title.substr(0, equals));
      title.remove_prefix(equals + 1);
      if (!key.starts_with("SET")) {
        if (const int kind = kind_of_request(key); kind >= 0) requests_.emplace(trimmed(title), kind);
        return;
      }
      sets_.push_back({std::string(trimmed(key.substr(3))), {}, std::exchange(told_, ""), in_.line(), begin});
    }
    sets_.back().end = end;
    set_goes_on_ = title.ends_with(',');
    while (!title.empty()) {
      const std::size_t comma = std::min(title.find(','), title.size());
      sets_.back().members.emplace_back(trimmed(title.substr(0, comma)));
      if (const std::string& member = sets_.back().members.back();
          is_of_point(sets_.back()) && !member.empty())
        integer(member, "a node's number", in_.line());
      title.remove_prefix(std::min(comma + 1, title.size()));
    }
  }

  /// A line of the bulk data: a card, or what goes on with one.
  void take_bulk(const std::string& text, std::size_t begin, std::size_t end) {
    if (!continues_card(text)) {
      end_card();
      card_ = {"", {}, in_.line(), begin};
    } else if (card_.name.empty()) {
      in_.fail("a continuation line stands before the first card");
    }
    card_.end = end;
    if (const std::string wrong = card_.take(text); !wrong.empty()) in_.fail("{}", wrong);
  }

  void end_card() {
    if (card_.name.empty()) return;
    card_.fields.resize(std::max<std::size_t>(card_.fields.size(), 8));
    static const std::map<std::string, std::array<int, 2>> kinds = {
        // nodes and where they begin
        {"CQUAD4", {4, 2}}, {"CQUADR", {4, 2}}, {"CTRIA3", {3, 2}}, {"CTRIAR", {3, 2}},
        {"CQUAD8", {8, 2}}, {"CBAR", {2, 2}},   {"CBEAM", {2, 2}},  {"CROD", {2, 2}},
        {"CTUBE", {2, 2}},  {"CONROD", {2, 1}}, {"PLOTEL", {2, 1}}};
    const auto kind = kinds.find(card_.name);
    if (card_.name == "GRID") {
      grid();
    } else if (kind != kinds.end()) {
      element(static_cast<std::size_t>(kind->second[0]), static_cast<std::size_t>(kind->second[1]));
    } else if (card_.name[0] == '=') {
      in_.fail_at(card_.line, "a card that repeats the one before: expected cards of their own");
    } else if (card_.name == "GRDSET") {
      if (!card_.field(1).empty() && card_.field(1) != "0")
        in_.fail_at(card_.line, "GRDSET with a coordinate system: expected nodes in the basic one (0)");
    } else {
      ++deck_.others[card_.name];
      const bool has_nodes_of_meshes = is_among(card_.name, "|CTRIA6|CTETRA|CHEXA|CPENTA|CPYRAM|");
      if (has_nodes_of_meshes && unread_.line == 0) unread_ = card_;
      deck_.has_directions |= is_among(card_.name, "|MAT2|MAT8|PCOMP|PCOMPG|");
      if (is_among(card_.name, "|PSHELL|MAT1|")) property();
      if (is_nastran_element(card_.name))
        deck_.unread.insert(as_nastran_integer(card_.fields[0]).value_or(0));
      if (card_.name.starts_with("RB")) rigid_.insert(as_nastran_integer(card_.fields[0]).value_or(0));
      if (as_deck_) cards_.push_back(std::move(card_));
    }
    card_ = {};
  }

  long long integer(std::string_view text, const char* what, int line) const {
    const auto value = as_nastran_integer(text);
    if (!value || *value > NumberedEntities::kMostNumber)
      in_.fail_at(line, "expected {} (an integer from 1 to {}), found {}", what,
                  NumberedEntities::kMostNumber, TextScanner::printable(text));
    return *value;
  }

  double real(std::string_view text) const {
    const auto value = as_nastran_real(text);
    if (!value)
      in_.fail_at(card_.line, "expected a coordinate (a finite number), found {}",
                  TextScanner::printable(text));
    return *value;
  }

  void property() {
    deck_.properties.push_back({card_.name, {}});
    Deck::Property& property = deck_.properties.back();
    for (const std::string& field : card_.fields)
      property.fields.push_back(as_nastran_real(field).value_or(std::nan("")));
    property.fields.resize(std::max<std::size_t>(property.fields.size(), 16), 0);
  }

  /// The card that stands for all those with the same properties.
  int block(const std::string& name, const std::string& type, const std::string& set) {
    const auto [at, is_new] = block_of_.emplace(type + set, static_cast<int>(deck_.cards.size()));
    if (is_new) {
      Deck::Card& card = deck_.cards.emplace_back();
      card.name = name;
      card.parameters = {{"TYPE", type}, {name == "NODE" ? "NSET" : "ELSET", set}};
      card.line = card_.line;
      card.begin = card.data = card_.begin;
    }
    deck_.cards[at->second].end = card_.end;
    return at->second;
  }

  /// The last fields of a GRID, its displacements' system and constraints, make a set.
  void grid() {
    const long long number = integer(card_.field(0), "a node's number", card_.line);
    if (!card_.field(1).empty() && card_.field(1) != "0")
      in_.fail_at(card_.line, "node {} in the coordinate system {}: expected the basic one (0)", number,
                  TextScanner::printable(card_.field(1)));
    const int index = static_cast<int>(deck_.nodes.size());
    if (!deck_.node_of.emplace(number, index).second)
      in_.fail_at(card_.line, "node {} is there twice", number);
    const double x = real(card_.field(2)), y = real(card_.field(3)), z = real(card_.field(4));
    deck_.nodes.push_back({number, {x, y, z}, card_.begin, card_.end});
    deck_.mesh.points.push_back({x, y, z});
    if (!as_deck_) return;
    std::string last = fmt::format("{},{},{}", card_.field(5), card_.field(6), card_.field(7));
    last = last == ",," ? "" : "#GRID " + last;
    block("NODE", "GRID", last);
    if (!last.empty()) deck_.node_sets[last].push_back(index);
  }

  void element(std::size_t n_nodes, std::size_t first) {
    Deck::Element e{integer(card_.field(0), "an element's number", card_.line),
                    std::vector<int>(n_nodes),
                    card_.line,
                    0,
                    card_.begin,
                    card_.end};
    const std::string_view property = card_.field(1);
    property_.push_back(first == 1         ? 0
                        : property.empty() ? e.number
                                           : integer(property, "a property's number", card_.line));
    for (std::size_t k = 0; k < n_nodes; ++k)
      numbers_.push_back(integer(card_.field(first + k), "a node's number", card_.line));
    const std::span behind = std::span(card_.fields).subspan(std::min(first + n_nodes, card_.fields.size()));
    if (n_nodes > 2 && !std::ranges::all_of(behind, &std::string::empty))
      ++deck_.others["angles, offsets or thicknesses of " + card_.name];
    if (as_deck_) {
      if (!deck_.element_of.emplace(e.number, static_cast<int>(deck_.elements.size())).second)
        in_.fail_at(card_.line, "element {} is there twice", e.number);
      std::string set = fmt::format("#{}", property_.back());
      if (n_nodes == 8) {
        for (std::size_t k = 10; k < 16; ++k) set += fmt::format(",{}", card_.field(k));
        for (std::size_t k = 11; k < 14; ++k)
          if (card_.field(k) != card_.field(10)) e.pin = card_.line;  // a thickness for each corner
        deck_.has_directions |= card_.field(14).find('.') != std::string_view::npos;
      } else if (n_nodes > 2) {
        const std::string_view angle = card_.field(first + n_nodes);
        if (angle.find('.') != std::string_view::npos) e.angle = as_nastran_real(angle).value_or(0);
        deck_.has_directions |= e.angle != 0;
        set += fmt::format(",{},{}", angle.find('.') == std::string_view::npos ? angle : "",
                           card_.field(first + n_nodes + 1));
        set += fmt::format(",{},{}", card_.field(9), card_.field(10));
        for (std::size_t k = 11; k < 10 + n_nodes; ++k)
          if (card_.field(k) != card_.field(10)) e.pin = card_.line;  // a thickness for each corner
      }
      if (is_among(card_.name, "|CBAR|CBEAM|"))
        add_words(card_.name, std::span(card_.fields).subspan(4, 1), 0, card_.line);  // to which it looks
      e.card = block("ELEMENT", card_.name, set);
      deck_.element_sets[set].push_back(static_cast<int>(deck_.elements.size()));
    }
    deck_.elements.push_back(std::move(e));
  }

  int node(long long number, int line) const {
    const auto found = deck_.node_of.find(number);
    if (found == deck_.node_of.end()) in_.fail_at(line, "there is no node {}", number);
    return found->second;
  }

  /// Nodes may stand behind the elements that have them.
  void find_nodes() {
    for (std::size_t at = 0; Deck::Element & e : deck_.elements)
      for (int& v : e.nodes) v = node(numbers_[at++], e.line);
  }

  /// The numbers in a list, "1", "THRU", "9", "BY", "2" among them; nothing if it holds something else.
  /// Ranges have those that exist.
  std::optional<Numbers> list_of(std::span<const std::string> fields, bool of_nodes) const {
    Numbers numbers;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      if (fields[k].empty()) continue;
      const bool is_range = upper(fields[k]) == "THRU";
      const auto number = as_nastran_integer(fields[std::min(k + (is_range ? 1 : 0), fields.size() - 1)]);
      if (!number || (is_range && (numbers.empty() || (of_nodes && deck_.others.contains("SPOINT")))))
        return std::nullopt;
      if (!is_range) {
        numbers.push_back(*number);
        continue;
      }
      const bool has_step = k + 3 < fields.size() && upper(fields[k + 2]) == "BY";
      const auto step = has_step ? as_nastran_integer(fields[k + 3]) : 1;
      if (!step) return std::nullopt;
      const long long low = numbers.back();
      const auto add = [&](long long i) {
        if ((i - low) % *step == 0) numbers.push_back(i);
      };
      const auto& existing = of_nodes ? deck_.node_of : deck_.element_of;
      for (auto i = existing.upper_bound(low); i != existing.end() && i->first <= *number; ++i) add(i->first);
      for (auto i = deck_.unread.upper_bound(low); !of_nodes && i != deck_.unread.end() && *i <= *number; ++i)
        add(*i);
      k += has_step ? 3 : 1;
    }
    return numbers;
  }

  /// Adds a set that is written again if members go or come.
  void add_set(bool of_nodes, const std::string& name, int line, std::size_t begin, std::size_t end,
               Numbers numbers) {
    Deck::Card& card = deck_.cards.emplace_back();
    card.name = of_nodes ? "NSET" : "ELSET";
    card.parameters = {{card.name, name}};
    card.line = line;
    card.begin = card.data = begin;
    card.end = end;
    const auto& index = of_nodes ? deck_.node_of : deck_.element_of;
    std::vector<int>& members = (of_nodes ? deck_.node_sets : deck_.element_sets)[name];
    for (const long long number : numbers)
      if (const auto at = index.find(number); at != index.end()) members.push_back(at->second);
    card.numbers = std::move(numbers);
  }

  void take_sets() {
    for (const Set& set : sets_) {
      std::set<int> kinds;
      if (!set.from_comment.empty()) kinds.insert(0);
      for (auto [at, end] = requests_.equal_range(set.number); at != end; ++at) kinds.insert(at->second);
      std::vector<std::string> fields;
      for (const std::string& member : set.members)
        for (std::size_t at = 0; at < member.size();) {  // "7 THRU 9"
          const std::size_t end = std::min(member.find(' ', at), member.size());
          if (end > at) fields.push_back(member.substr(at, end - at));
          at = end + 1;
        }
      const bool of_nodes = kinds == std::set{0}, of_elements = kinds == std::set{1};
      const auto numbers = list_of(fields, of_nodes);
      if (numbers && (of_nodes || of_elements))
        add_set(of_nodes, "#SET " + set.number, set.line, set.begin, set.end, *numbers);
      else
        add_words("SET", fields, 0, set.line);
    }
  }

  void take_others(const NastranCard& card) {
    if (is_among(card.name, kWithoutNumbers) || card.name.starts_with("MAT") ||
        card.name.starts_with("CORD2") || card.name.starts_with("EIG") || card.name.starts_with("TABLE"))
      return;
    const std::span<const std::string> fields = card.fields;
    const std::size_t n = fields.size();
    const auto add = [&](bool of_nodes, const std::string& name, std::span<const std::string> members) {
      const auto numbers = list_of(members, of_nodes);
      const auto exists = [&](long long number) {
        return of_nodes ? deck_.node_of.contains(number)
                        : deck_.element_of.contains(number) || deck_.unread.contains(number);
      };
      if (!numbers || !std::ranges::all_of(*numbers, exists)) return false;
      std::string set = name;
      while (!of_nodes && std::ranges::any_of(*numbers, [&](long long e) {
        return !loaded_.emplace(set, e).second;  // the same load once more
      }))
        set += '+';
      add_set(of_nodes, set, card.line, card.begin, card.end, *numbers);
      return true;
    };
    if (card.name == "SPC1" && add(true, fmt::format("#SPC1 {},{}", fields[0], fields[1]), fields.subspan(2)))
      return;
    if (card.name == "PLOAD2" &&
        add(false, fmt::format("#PLOAD2 {},{}", fields[0], fields[1]), fields.subspan(2)))
      return;
    if (card.name == "PLOAD4" && is_even(card)) {
      const std::vector<std::string> members = {fields[1], fields[6], fields[7]};
      if (add(false,
              fmt::format("#PLOAD4 {},{},{}", fields[0], fields[2],
                          fmt::join(fields.subspan(std::min<std::size_t>(8, n)), ",")),
              members))
        return;
    }
    add_words(card.name, fields, card.name.starts_with("RB") || is_nastran_element(card.name) ? 1 : 0,
              card.line);
  }

  /// Whether a PLOAD4 has the same pressure everywhere, on shells.
  static bool is_even(const NastranCard& card) {
    for (const std::size_t k : {3, 4, 5})
      if (!card.field(k).empty() && card.field(k) != card.field(2)) return false;
    return upper(card.fields[6]) == "THRU" || (card.fields[6] + card.fields[7]).empty();
  }

  /// Keeps what may be numbers of nodes and elements, from field `first` on.
  void add_words(const std::string& name, std::span<const std::string> fields, std::size_t first, int line) {
    const auto [at, is_new] = block_of_.emplace("words " + name, static_cast<int>(deck_.cards.size()));
    if (is_new) deck_.cards.emplace_back().name = name;
    const std::span<const int> places = fields_of_nodes(name);
    const bool joins = name.starts_with("PLOAD") || name == "SET",
               of_nodes = !places.empty() || is_among(name, kOfNodesAlone) ||
                          (is_nastran_element(name) && !is_among(name, "|CWELD|CFAST|CSEAM|"));
    const auto add = [&](long long number) {
      Deck::Word word{"", line, at->second, number};
      word.of_element = !of_nodes;
      word.forbids_join = !joins;
      deck_.words.push_back(std::move(word));
    };
    for (std::size_t k = first; k < fields.size(); ++k) {
      const bool is_place = places.empty() ||
                            std::ranges::find(places, static_cast<int>(k)) != places.end() ||
                            (places.back() < 0 && static_cast<int>(k) > places[places.size() - 2]);
      if (!is_place) continue;
      if (const auto number = as_nastran_integer(fields[k])) add(*number);
      if (upper(fields[k]) != "THRU" || k == 0 || k + 1 == fields.size()) continue;
      const long long low = as_nastran_integer(fields[k - 1]).value_or(0),
                      high = as_nastran_integer(fields[k + 1]).value_or(0);
      for (const auto* existing : {&deck_.node_of, &deck_.element_of})
        for (auto i = existing->upper_bound(low); i != existing->end() && i->first < high; ++i)
          if (!of_nodes || existing == &deck_.node_of) add(i->first);
    }
  }

  void make_mesh() {
    Mesh named;  // whose entities are the properties
    std::map<std::tuple<int, int, std::vector<std::string>>, int> index;
    for (std::size_t i = 0; i < deck_.elements.size(); ++i) {
      Deck::Element& e = deck_.elements[i];
      const int dim = e.nodes.size() == 2 ? 1 : 2, property = entities_.index(dim, property_[i], named);
      std::ranges::sort(e.sets);
      std::vector<Entity>& entities = dim == 1 ? deck_.mesh.curves : deck_.mesh.regions;
      const auto [at, is_new] =
          index.emplace(std::tuple(dim, property, e.sets), static_cast<int>(entities.size()));
      if (is_new) entities.push_back((dim == 1 ? named.curves : named.regions)[property]);
      e.region = at->second;
      const std::string wrong = add_element(
          deck_.mesh, static_cast<int>(as_deck_ ? e.corners() : std::min<std::size_t>(e.nodes.size(), 4)),
          e.nodes, e.region);
      if (!wrong.empty()) in_.fail_at(e.line, "{}", wrong);
    }
    for (std::vector<Entity>* entities : {&deck_.mesh.curves, &deck_.mesh.regions}) part_tags(*entities);
    if (as_deck_) return;
    NamedPoints points;
    for (const Set& set : sets_)
      for (const std::string& member : set.members)
        if (is_of_point(set) && !member.empty())
          points.add(deck_.mesh, node(as_nastran_integer(member).value_or(0), set.line),
                     set.from_comment.substr(6));
  }

  /// Gives the parts of a property tags of their own, and its name, so that they stay together.
  static void part_tags(std::vector<Entity>& entities) {
    std::map<int, std::vector<Entity*>> parts;
    for (Entity& entity : entities) parts[entity.tag].push_back(&entity);
    int last = parts.empty() ? 0 : parts.rbegin()->first;
    for (const auto& [tag, of_tag] : parts)
      for (std::size_t k = 0; k < of_tag.size() && of_tag.size() > 1; ++k) {
        if (of_tag[k]->names.empty()) of_tag[k]->names = {fmt::format("property {}", tag)};
        if (k > 0) of_tag[k]->tag = ++last;
      }
  }

  TextScanner in_;
  const bool as_deck_;
  Deck deck_;
  NumberedEntities entities_;
  bool in_bulk_ = false, is_over_ = false, set_goes_on_ = false;
  NastranCard card_, unread_;       ///< the one that is read, and the first element that is not
  std::vector<NastranCard> cards_;  ///< that are neither nodes nor elements of the mesh
  std::string told_;                ///< of the set that comes next
  std::vector<Set> sets_;
  std::multimap<std::string, int> requests_;  ///< kinds by the number of a set
  std::map<std::string, int> block_of_;
  std::vector<long long> property_, numbers_;  ///< of elements, and of their nodes one behind the other
  std::set<std::pair<std::string, long long>> loaded_;
  std::set<long long> rigid_;  ///< numbers of elements that no list means
};

class NastranText : public DeckText {
 public:
  using DeckText::DeckText;
  using Numbers = std::vector<long long>;

  std::string node(long long number, const Vec3& at, const Deck::Card* card) const override {
    std::vector<std::string> fields = {text_of(number), "", nastran_number(at.x), nastran_number(at.y),
                                       nastran_number(at.z)};
    if (card != nullptr) {
      const NastranCard first = card_at(card->begin);
      for (const std::size_t k : {5, 6, 7}) fields.emplace_back(first.field(k));
    }
    return card_text("GRID", fields);
  }
  std::string as_in(const Deck::Card& card, const Numbers& nodes, bool are_new) const override {
    if (!are_new)
      refuse("{}:{}: --weld would join node {} to nodes with another system or constraint: leave --weld out",
             deck_.source, card.line, nodes[0]);
    return "";
  }
  std::string element(long long number, const Deck::Element& model, const std::string& type,
                      const Numbers& nodes, double angle) const override {
    NastranCard card = card_at(model.begin);
    card.fields.resize(std::max<std::size_t>(card.fields.size(), 16));
    std::vector<std::string>& fields = card.fields;
    const std::size_t first = card.name == "CONROD" || card.name == "PLOTEL" ? 1 : 2, n = nodes.size(),
                      n_old = model.nodes.size();
    if (n < n_old) fields.erase(fields.begin() + 5), fields.insert(fields.begin() + 7, ""), fields[13] = "";
    if (n > n_old)
      fields.insert(fields.begin() + 5, ""), fields.erase(fields.begin() + 8), fields[13] = fields[10];
    fields[0] = text_of(number);
    if (fields[1].empty()) fields[1] = text_of(model.number);  // what Nastran takes then
    for (std::size_t k = 0; k < n; ++k) fields[first + k] = text_of(nodes[k]);
    std::string& direction = fields[2 + n];
    if (deck_.has_directions && (n == 3 || n == 4) && std::isfinite(angle) &&
        (direction.empty() || direction.find('.') != std::string::npos))
      direction = fmt::format("{:.3f}", angle);
    return card_text(type, fields);
  }
  std::string type_with(std::string type, std::size_t corners) const override {
    return (corners == 4 ? "CQUAD" : "CTRIA") + (type.ends_with('R') ? std::string("R")
                                                 : corners == 4      ? "4"
                                                                     : "3");
  }
  std::string set(const Deck::Card& card, const Numbers& numbers) const override {
    const std::string name = card.parameter(card.name);
    if (name.starts_with("#SET ")) return nastran_set(name.substr(5), numbers);
    const NastranCard first = card_at(card.begin);
    std::vector<std::string> fields = first.fields;
    std::string text;
    if (first.name == "PLOAD4") {
      fields[6] = fields[7] = "";
      for (const long long number : numbers)
        fields[1] = text_of(number), text += card_text(first.name, fields);
      return text;
    }
    const std::size_t n_each = first.name == "PLOAD2" ? 6 : numbers.size();
    for (std::size_t at = 0; at < numbers.size(); at += n_each) {
      fields.resize(2);
      for (std::size_t k = at; k < std::min(at + n_each, numbers.size()); ++k)
        fields.push_back(text_of(numbers[k]));
      text += card_text(first.name, fields);
    }
    return text;
  }

 private:
  NastranCard card_at(std::size_t begin) const {
    return first_card(std::string_view(deck_.text).substr(begin));
  }
  std::string text_of(long long number) const {
    if (number > kMostNastran) refuse("{}: number {} has more than eight digits", deck_.source, number);
    return std::to_string(number);
  }
};

}  // namespace

Deck read_nastran_deck(const std::filesystem::path& path, bool as_deck) {
  return NastranReader(path, as_deck).read();
}

void rewrite_nastran(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                     double weld) {
  Deck deck = read_nastran_deck(source, true);
  rewrite_deck(deck, NastranText(deck), path, mesh, weld);
}

}  // namespace delquad
