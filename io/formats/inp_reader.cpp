
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/face_reader.h"
#include "io/formats/readers.h"
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

/// A keyword line: "*ELSET, ELSET=name, GENERATE".
struct Keyword {
  std::string name;                               ///< in capitals, without the star
  std::map<std::string, std::string> parameters;  ///< by name in capitals; empty: a flag
};

Keyword keyword_of(std::string_view line) {
  Keyword keyword;
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

/// Nodes of an element type; 0: not one of lines, triangles and quads.
int nodes_of_type(const std::string& type) {
  static const std::pair<const char*, int> kinds[] = {
      {"S4", 4},   {"CPS4", 4},   {"CPE4", 4},   {"CPEG4", 4},  {"CAX4", 4},  {"M3D4", 4},
      {"R3D4", 4}, {"SFM3D4", 4}, {"DS4", 4},    {"DC2D4", 4},  {"S3", 3},    {"STRI3", 3},
      {"CPS3", 3}, {"CPE3", 3},   {"S8", 8},     {"CPS8", 8},   {"CPE8", 8},  {"CPEG8", 8},
      {"CAX8", 8}, {"M3D8", 8},   {"SFM3D8", 8}, {"DS8", 8},    {"DC2D8", 8}, {"CPEG3", 3},
      {"CAX3", 3}, {"M3D3", 3},   {"R3D3", 3},   {"SFM3D3", 3}, {"DS3", 3},   {"DC2D3", 3},
      {"T2D2", 2}, {"T3D2", 2},   {"B21", 2},    {"B31", 2},    {"R2D2", 2},  {"RAX2", 2}};
  for (const auto& [name, n] : kinds) {
    const std::string_view rest =
        std::string_view(type).substr(std::min(type.size(), std::string_view(name).size()));
    if (type.starts_with(name) && (rest.empty() || !(rest[0] >= '0' && rest[0] <= '9') || rest == "5"))
      return n;
  }
  return 0;
}

/// A side "S2" or "E2" of elements, by their number or set.
struct InpSurface {
  std::string name, elements, side;
  int line;
};

struct InpElement {
  std::vector<int> nodes;  ///< indices
  int line;                ///< of the file
  std::vector<std::string> sets;
};

class InpReader {
 public:
  explicit InpReader(const std::filesystem::path& path) : in_(path) { refuse_other_kinds(in_, "INP"); }

  Mesh read() {
    while (!in_.at_end()) {
      const std::string_view line = trimmed(in_.rest_of_line());
      if (line.starts_with("**")) continue;
      if (line.starts_with("*"))
        begin(keyword_of(line));
      else
        data(fields_of(line));
    }
    if (!pending_.empty()) in_.fail("the file ends within an element: is it whole?");
    if (elements_.empty()) in_.fail("the file holds no *ELEMENT of two, three, four or eight nodes");
    make_mesh();
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  void begin(Keyword keyword) {
    if (!pending_.empty()) in_.fail("an element ends without its last nodes");
    if (keyword.name == "INCLUDE") in_.fail("*INCLUDE: expected a file that holds the whole mesh");
    keyword_ = std::move(keyword);
    if (keyword_.name != "ELEMENT") return;
    const std::string type = upper(keyword_.parameters["TYPE"]);
    n_nodes_ = nodes_of_type(type);
    if (n_nodes_ == 0)
      in_.fail(
          "element type {}: expected lines or triangles of first order or quads, such as S4, "
          "CPS4, S3, S8R",
          TextScanner::printable(type));
  }

  void data(const std::vector<std::string_view>& fields) {
    const auto parameter = [&](const char* name) { return keyword_.parameters[name]; };
    if (keyword_.name == "NODE") node(fields);
    if (keyword_.name == "ELEMENT") element(fields, parameter("ELSET"));
    if (keyword_.name == "ELSET") members(fields, parameter("ELSET"));
    if (keyword_.name == "SURFACE" && upper(parameter("TYPE")) != "NODE" && fields.size() == 2)
      surfaces_.push_back({parameter("NAME"), std::string(fields[0]), std::string(fields[1]), in_.line()});
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

  void node(const std::vector<std::string_view>& fields) {
    if (fields.empty()) return;
    const long long number = integer(fields[0], "a node's number");
    const auto x = [&](size_t k) { return fields.size() > k ? real(fields[k]) : 0; };
    if (!node_of_.emplace(number, static_cast<int>(mesh_.points.size())).second)
      in_.fail("node {} is there twice; files of several parts cannot be read", number);
    mesh_.points.push_back({x(1), x(2), x(3)});
  }

  void element(const std::vector<std::string_view>& fields, const std::string& set) {
    for (const std::string_view field : fields) pending_.push_back(integer(field, "a node's number"));
    if (pending_.size() < static_cast<size_t>(n_nodes_) + 1) return;
    if (pending_.size() > static_cast<size_t>(n_nodes_) + 1)
      in_.fail("an element of {} nodes has {}", n_nodes_, pending_.size() - 1);
    InpElement e{{}, in_.line(), {}};
    for (size_t k = 1; k < pending_.size(); ++k) {
      const auto found = node_of_.find(pending_[k]);
      if (found == node_of_.end()) in_.fail("there is no node {} yet", pending_[k]);
      e.nodes.push_back(found->second);
    }
    if (!element_of_.emplace(pending_[0], static_cast<int>(elements_.size())).second)
      in_.fail("element {} is there twice; files of several parts cannot be read", pending_[0]);
    if (!set.empty()) sets_[set].push_back(static_cast<int>(elements_.size()));
    elements_.push_back(std::move(e));
    pending_.clear();
  }

  /// Element numbers, or names of other sets. Elements that are not there are of a kind that is not read.
  void members(const std::vector<std::string_view>& fields, const std::string& set) {
    std::vector<int>& all = sets_[set];
    const auto add = [&](long long number) {
      const auto found = element_of_.find(number);
      if (found == element_of_.end()) in_.fail("there is no element {} yet", number);
      all.push_back(found->second);
    };
    if (keyword_.parameters.contains("GENERATE")) {
      if (fields.size() < 2) in_.fail("expected the first and the last element");
      const long long first = integer(fields[0], "an element's number"),
                      last = integer(fields[1], "an element's number"),
                      step = fields.size() > 2 ? integer(fields[2], "a step") : 1;
      if (last < first) return;
      for (long long number = first;; number += step) {
        add(number);
        if (number > last - step) return;
      }
      return;
    }
    for (const std::string_view field : fields) {
      if (!field.empty() && field[0] >= '0' && field[0] <= '9') {
        add(integer(field, "an element's number"));
      } else if (const auto other = sets_.find(std::string(field)); other != sets_.end()) {
        const std::vector<int> copy = other->second;
        all.insert(all.end(), copy.begin(), copy.end());
        if (all.size() > elements_.size())
          sort_unique(all);  // sets that hold themselves would double each time
      } else {
        in_.fail("there is no element set {} yet", TextScanner::printable(field));
      }
    }
  }

  /// A set named by a leading underscore is a part of something else, and "Eall" names the whole.
  void make_mesh() {
    for (auto& [name, members] : sets_) {
      if (name.empty() || name[0] == '_') continue;
      sort_unique(members);
      if (name == "Eall" && members.size() == elements_.size()) continue;
      for (const int e : members) elements_[e].sets.push_back(name);
    }
    std::map<std::pair<int, std::vector<std::string>>, int> index;
    for (const InpElement& e : elements_) {
      const int dim = e.nodes.size() == 2 ? 1 : 2;
      std::vector<Entity>& entities = dim == 1 ? mesh_.curves : mesh_.regions;
      const auto [it, is_new] = index.emplace(std::pair{dim, e.sets}, static_cast<int>(entities.size()));
      if (is_new) entities.push_back({it->second + 1, e.sets});
      add(e, it->second);
    }
    add_sides_of_shells();
    add_surfaces();
    take_numbers(mesh_.curves, 1);
    take_numbers(mesh_.regions, 2);
  }

  /// Of shells our writer has the sides along curves in sets "_NAME_E2", and no surfaces of them.
  void add_sides_of_shells() {
    const auto is_used = [&](const std::string& set) {
      return std::ranges::find(surfaces_, set, &InpSurface::elements) != surfaces_.end();
    };
    for (const auto& [set, members] : sets_) {
      const size_t n = set.size();
      if (n > 4 && set[0] == '_' && set[n - 3] == '_' && set[n - 2] == 'E' && !members.empty() &&
          !is_used(set))
        surfaces_.push_back({set.substr(1, n - 4), set, set.substr(n - 2), elements_[members[0]].line});
    }
  }

  /// What is called by a number of its own, as in our files ("curve_7"), has it again.
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

  void add(const InpElement& e, int entity) {
    const auto& v = e.nodes;
    const bool is_triangle = v.size() == 4 && v[2] == v[3];  // some programs write them so
    const int corners = is_triangle ? 3 : static_cast<int>(std::min<size_t>(v.size(), 4));
    const std::string wrong = add_element(mesh_, corners, v, entity);
    if (!wrong.empty()) in_.fail_at(e.line, "{}", wrong);
  }

  /// Sides "S2" or "E2" of elements become lines; those on several surfaces are lines of a curve of all their
  /// names. Surfaces of whole elements are no curves.
  void add_surfaces() {
    std::map<std::vector<int>, std::vector<std::string>> names_of;  // by the nodes of a line, its ends first
    for (const InpSurface& s : surfaces_) {
      const bool is_side = s.side.size() == 2 && (s.side[0] == 'S' || s.side[0] == 'E') && s.side[1] >= '1' &&
                           s.side[1] <= '4';
      if (!is_side) continue;
      for (const int e : elements_named(s)) {
        const std::vector<int>& v = elements_[e].nodes;
        const size_t k = static_cast<size_t>(s.side[1] - '1'), n = std::min<size_t>(v.size(), 4);
        if (k >= n || n < 3) in_.fail_at(s.line, "an element has no side {}", s.side);
        std::vector<int> nodes = {v[k], v[(k + 1) % n]};
        if (v.size() == 8) nodes.push_back(v[4 + k]);
        if (names_of.contains({nodes[1], nodes[0]})) nodes = {nodes[1], nodes[0]};  // of a neighbour
        std::vector<std::string>& names = names_of[nodes];
        if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
      }
    }
    std::map<std::vector<std::string>, int> index;
    for (const auto& [line, names] : names_of) {
      const auto [it, is_new] = index.emplace(names, static_cast<int>(mesh_.curves.size()));
      if (is_new) mesh_.curves.push_back({it->second + 1, names});
      add_line(mesh_, line, it->second);
    }
  }

  std::vector<int> elements_named(const InpSurface& surface) const {
    const auto set = sets_.find(surface.elements);
    if (set != sets_.end()) return set->second;
    long long number = 0;
    const std::string& text = surface.elements;
    std::from_chars(text.data(), text.data() + text.size(), number);
    const auto element = element_of_.find(number);
    if (element == element_of_.end())
      in_.fail_at(surface.line, "there is no element or set {}", TextScanner::printable(text));
    return {element->second};
  }

  TextScanner in_;
  Mesh mesh_;
  Keyword keyword_;
  int n_nodes_ = 0;
  std::vector<long long> pending_;  ///< of an element that goes on in the next line
  std::map<long long, int> node_of_, element_of_;
  std::vector<InpElement> elements_;
  std::map<std::string, std::vector<int>> sets_;
  std::vector<InpSurface> surfaces_;
};

}  // namespace

Mesh read_inp(const std::filesystem::path& path) { return InpReader(path).read(); }

}  // namespace delquad
