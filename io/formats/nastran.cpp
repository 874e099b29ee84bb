#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/face_reader.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// A line with blanks for its tabs, without what stands behind a "$".
std::string without_tabs(std::string_view line) {
  constexpr size_t kField = 8;
  std::string result;
  for (const char c : line.substr(0, line.find('$')))
    if (c == '\t')
      result.resize((result.size() / kField + 1) * kField, ' ');
    else
      result += c;
  return result;
}

/// The name of a card and its fields, from one line or several.
struct NastranCard {
  std::string name;  ///< in capitals, without the star
  std::vector<std::string> fields;
  int line = 0;  ///< of the file
};

/// What the file says of an element.
struct NastranElement {
  int dim;
  long long property;
  std::vector<long long> nodes;  ///< numbers
  int line;
};

class NastranReader {
 public:
  explicit NastranReader(const std::filesystem::path& path) : in_(path) {
    refuse_other_kinds(in_, "Nastran");
    const std::string text = upper(in_.text());
    in_bulk_ = !text.starts_with("BEGIN") && text.find("\nBEGIN") == std::string::npos;
  }

  Mesh read() {
    do take_line(in_.rest_of_line());
    while (!is_over_ && in_.next_line());
    end_card();
    make_mesh();
    return std::move(mesh_);
  }
  /// Names of cards that read() left out.
  const std::set<std::string>& others() const { return others_; }

 private:
  void take_line(std::string_view line) {
    if (line.starts_with('$')) return take_comment(line);
    const std::string text = without_tabs(line);
    if (trimmed(text).empty()) return;
    const std::string title = upper(trimmed(text));
    if (title.starts_with("INCLUDE")) in_.fail("INCLUDE: expected a file that holds the whole mesh");
    if (title.starts_with("ENDDATA")) is_over_ = true;
    if (title.starts_with("BEGIN")) in_bulk_ = true;
    if (is_over_ || title.starts_with("BEGIN")) return;
    if (in_bulk_) return take_bulk(text);
    take_set(title);
  }

  /// Names that write_nastran() leaves.
  void take_comment(std::string_view line) {
    if (entities_.take_name(line, "$ property ", ": ", 2)) return;
    if (const std::string unit = unit_in_comment(line, "$"); !unit.empty()) mesh_.unit = unit;
    constexpr std::string_view kPoint = ", nodes of point ";
    const size_t at = line.find(kPoint);
    if (line.starts_with("$ set ") && at != std::string_view::npos)
      point_name_ = trimmed(line.substr(at + kPoint.size()));
  }

  /// "SET 3 = 7, 8," and lines after it.
  void take_set(std::string_view title) {
    if (point_name_.empty()) return;
    title.remove_prefix(title.starts_with("SET") ? std::min(title.find('='), title.size() - 1) + 1 : 0);
    const bool goes_on = title.ends_with(',');
    while (!title.empty()) {
      const size_t comma = std::min(title.find(','), title.size());
      const std::string_view number = trimmed(title.substr(0, comma));
      if (!number.empty())
        point_names_.push_back({integer(number, "a node's number", in_.line()), point_name_, in_.line()});
      title.remove_prefix(std::min(comma + 1, title.size()));
    }
    if (!goes_on) point_name_.clear();
  }

  /// A line of the bulk data: a card, or what goes on with one.
  void take_bulk(const std::string& text) {
    const bool is_free = text.find(',') != std::string::npos;
    constexpr size_t kSmall = 8, kLarge = 16;
    std::string head = is_free ? text.substr(0, text.find(',')) : text.substr(0, kSmall);
    head = upper(trimmed(head));
    const bool goes_on = head.empty() || head[0] == '+' || head[0] == '*';
    const bool is_large = head.find('*') != std::string::npos;
    if (!goes_on) {
      end_card();
      std::erase(head, '*');
      card_ = {head, {}, in_.line()};
    } else if (card_.name.empty()) {
      in_.fail("a line that goes on with a card stands before all cards");
    }
    const size_t n_fields = is_large ? 4 : 8, width = is_large ? kLarge : kSmall;
    size_t at = is_free ? std::min(text.find(',') + 1, text.size()) : kSmall;
    for (size_t k = 0; k < n_fields; ++k) {
      const size_t end =
          is_free ? std::min(text.find(',', std::min(at, text.size())), text.size()) : at + width;
      card_.fields.emplace_back(at < text.size() ? trimmed(std::string_view(text).substr(at, end - at)) : "");
      at = is_free ? end + 1 : end;
    }
  }

  void end_card() {
    if (card_.name.empty()) return;
    static const std::map<std::string, std::array<int, 3>> kinds = {
        // nodes, where they begin, where the property stands (-1: nowhere)
        {"CQUAD4", {4, 2, 1}}, {"CQUADR", {4, 2, 1}},  {"CTRIA3", {3, 2, 1}}, {"CTRIAR", {3, 2, 1}},
        {"CQUAD8", {8, 2, 1}}, {"CBAR", {2, 2, 1}},    {"CBEAM", {2, 2, 1}},  {"CROD", {2, 2, 1}},
        {"CTUBE", {2, 2, 1}},  {"CONROD", {2, 1, -1}}, {"PLOTEL", {2, 1, -1}}};
    const auto kind = kinds.find(card_.name);
    if (card_.name == "GRID") {
      grid();
    } else if (kind != kinds.end()) {
      element(kind->second[0], kind->second[1], kind->second[2]);
    } else if (card_.name == "GRDSET" && !field(1).empty() && field(1) != "0") {
      in_.fail_at(card_.line, "GRDSET with a coordinate system: expected nodes in the basic one (0)");
    } else {
      if (card_.name != "GRDSET") others_.insert(card_.name);
      for (const char* other : {"CTRIA6", "CTETRA", "CHEXA", "CPENTA", "CPYRAM"})
        if (card_.name == other)
          in_.fail_at(card_.line, "{}: expected a mesh of lines, CTRIA3, CQUAD4 and CQUAD8", other);
    }
    card_ = {};
  }

  std::string_view field(size_t k) const {
    return k < card_.fields.size() ? card_.fields[k] : std::string_view();
  }

  long long integer(std::string_view text, const char* what, int line) const {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1 ||
        value > NumberedEntities::kMostNumber)
      in_.fail_at(line, "expected {} (an integer from 1 to {}), found {}", what,
                  NumberedEntities::kMostNumber, TextScanner::printable(text));
    return value;
  }

  /// "1.5-3" and "1.5D-3" are 0.0015, and nothing is 0.
  double real(std::string_view text) const {
    std::string digits;
    for (const char c : text) {
      const bool is_sign = c == '+' || c == '-';
      if (is_sign && !digits.empty() && digits.back() != 'e') digits += 'e';
      if (c != '+') digits += c == 'D' || c == 'd' || c == 'E' ? 'e' : c;
    }
    if (digits.empty() && text.empty()) return 0;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      in_.fail_at(card_.line, "expected a coordinate (a finite number), found {}",
                  TextScanner::printable(text));
    return value;
  }

  void grid() {
    const long long number = integer(field(0), "a node's number", card_.line);
    if (!field(1).empty() && field(1) != "0")
      in_.fail_at(card_.line, "node {} in the coordinate system {}: expected the basic one (0)", number,
                  TextScanner::printable(field(1)));
    if (!node_of_.emplace(number, static_cast<int>(mesh_.points.size())).second)
      in_.fail_at(card_.line, "node {} is there twice", number);
    const double x = real(field(2)), y = real(field(3)), z = real(field(4));
    mesh_.points.push_back({x, y, z});
  }

  void element(int n_nodes, int first, int property) {
    const long long number = integer(field(0), "an element's number", card_.line);
    NastranElement e{n_nodes == 2 ? 1 : 2, 0, {}, card_.line};
    if (property >= 0) {
      const std::string_view text = field(static_cast<size_t>(property));
      e.property = text.empty() ? number : integer(text, "a property's number", card_.line);
    }
    for (int k = 0; k < n_nodes; ++k)
      e.nodes.push_back(integer(field(static_cast<size_t>(first + k)), "a node's number", card_.line));
    elements_.push_back(std::move(e));
  }

  int node(long long number, int line) const {
    const auto found = node_of_.find(number);
    if (found == node_of_.end()) in_.fail_at(line, "there is no node {}", number);
    return found->second;
  }

  /// Nodes may stand behind the elements that have them.
  void make_mesh() {
    if (elements_.empty()) in_.fail("the file holds no lines, triangles or quads, such as CQUAD4");
    std::vector<int> nodes;
    for (const NastranElement& e : elements_) {
      nodes.clear();
      for (const long long number : e.nodes) nodes.push_back(node(number, e.line));
      const std::string wrong = add_element(mesh_, static_cast<int>(std::min<size_t>(nodes.size(), 4)), nodes,
                                            entities_.index(e.dim, e.property, mesh_));
      if (!wrong.empty()) in_.fail_at(e.line, "{}", wrong);
    }
    NamedPoints named;
    for (const PointName& point : point_names_) named.add(mesh_, node(point.number, point.line), point.name);
    drop_unused_points(mesh_);
  }

  struct PointName {
    long long number;
    std::string name;
    int line;
  };

  TextScanner in_;
  Mesh mesh_;
  NumberedEntities entities_;
  bool in_bulk_ = false, is_over_ = false;
  NastranCard card_;
  std::string point_name_;  ///< of the set that comes next, or goes on
  std::vector<PointName> point_names_;
  std::vector<NastranElement> elements_;
  std::unordered_map<long long, int> node_of_;
  std::set<std::string> others_;
};

constexpr std::size_t kSmallField = 8, kLargeField = 16, kMostNastran = 99'999'999;

/// Left-aligned in a field of eight characters.
std::string field(const std::string& text) {
  return text + std::string(kSmallField - std::min(text.size(), kSmallField), ' ');
}
std::string field(std::size_t number) { return field(std::to_string(number)); }

/// As many digits as sixteen characters hold, with the point that Nastran wants in every real number.
std::string real(double x) {
  char digits[48];
  for (int n = 16; n > 0; --n) {
    std::string text(digits,
                     std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr);
    const std::size_t exponent = text.find('e');
    if (text.find('.') == std::string::npos)
      text.insert(exponent == std::string::npos ? text.size() : exponent, ".");
    if (text.size() <= kLargeField) return text + std::string(kLargeField - text.size(), ' ');
  }
  return std::string("0.") + std::string(kLargeField - 2, ' ');
}

/// Eight fields to a line; further ones on continuations.
void write_card(TextWriter& out, const char* name, const std::vector<std::size_t>& numbers) {
  out << field(name);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && i % 8 == 0) out << '\n' << field("");
    out << field(numbers[i]);
  }
  out << '\n';
}

/// "SET 5 = 1, 2, 3," in lines of at most 72 characters.
void write_set(TextWriter& out, std::size_t number, const std::vector<int>& nodes) {
  std::string line = "SET " + std::to_string(number) + " = ";
  constexpr std::size_t kLongestLine = 70;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string id = std::to_string(nodes[i] + 1) + (i + 1 < nodes.size() ? "," : "");
    if (line.size() + id.size() > kLongestLine) {
      out << line << '\n';
      line = "        ";
    }
    line += id;
  }
  out << line << '\n';
}

void write_grid(TextWriter& out, std::size_t i, const Vec3& p) {
  const std::string id = std::to_string(i + 1);
  out << "GRID*   " << id << std::string(kLargeField - id.size(), ' ') << std::string(kLargeField, ' ')
      << real(p.x) << real(p.y) << "\n*       " << real(p.z) << '\n';
}

/// Comments that tell names: a property for each group of the highest dimension, SETs of the nodes of others.
template <class AnyMesh>
void write_names(TextWriter& out, const char* title, const AnyMesh& mesh,
                 const std::vector<MeshGroup>& groups) {
  constexpr const char* kKinds[] = {"point ", "curve ", "face "};
  out << "$ " << title << " by Delquad\n";
  if (!mesh.unit.empty()) out << "$ lengths in " << mesh.unit << '\n';
  std::size_t set = 0;
  for (const MeshGroup& group : groups) {
    if (group.dim == groups[0].dim) {
      out << "$ property " << group.number << ": " << one_line(group.name) << '\n';
      continue;
    }
    out << "$ set " << ++set << ", nodes of " << kKinds[group.dim] << one_line(group.name) << '\n';
    write_set(out, set, nodes_of_group(mesh, group));
  }
  out << "BEGIN BULK\n";
}

/// Nastran's bulk data: CQUAD4, CQUAD8 and CTRIA3, a property for each name of regions, SETs of the nodes of
/// curves and points; comments tell the names.
void write_nastran(const std::filesystem::path& path, const Mesh& mesh) {
  require_numbers(path, "Nastran", mesh, kMostNastran);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<int> property = group_numbers(groups, 2, mesh.triangles.size() + mesh.quads.size());
  std::vector<char> inside(mesh.points.size(), 0);
  for (std::size_t q = 0; q < mesh.quads.size() && mesh.order == 2; ++q)
    inside[nodes_of_quad(mesh, q)[4]] = 1;
  write_text_file(path, [&](TextWriter& out) {
    write_names(out, "quad mesh", mesh, groups);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      if (inside[i]) continue;
      write_grid(out, i, mesh.points[i]);
    }
    std::size_t n = 0;
    const auto write = [&](const char* name, const auto& nodes) {
      std::vector<std::size_t> numbers{n + 1, static_cast<std::size_t>(property[n])};
      for (const int v : nodes) numbers.push_back(static_cast<std::size_t>(v) + 1);
      write_card(out, name, numbers);
      ++n;
    };
    for (const auto& v : mesh.triangles) write("CTRIA3", v);
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      std::vector<int> nodes = nodes_of_quad(mesh, q, gmsh_places(mesh.order));
      if (mesh.order == 2) nodes.pop_back();
      write(mesh.order == 2 ? "CQUAD8" : "CQUAD4", nodes);
    }
    out << "ENDDATA\n";
  });
}

/// CHEXA, a property for each name of volumes, SETs of the nodes of faces and curves.
void write_hex_nastran(const std::filesystem::path& path, const HexMesh& mesh, const HexFileOptions&) {
  for (const auto& [n, what] :
       {std::pair(mesh.points.size(), "nodes"), std::pair(mesh.hexahedra.size(), "elements")})
    require_fits(path, "Nastran", n, what, kMostNastran);
  const std::vector<MeshGroup> groups = hex_groups(mesh, {one_line_label});
  const std::vector<int> property = group_numbers(groups, 3, mesh.hexahedra.size());
  write_text_file(path, [&](TextWriter& out) {
    write_names(out, "mesh of hexahedra", mesh, groups);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) write_grid(out, i, mesh.points[i]);
    for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h) {
      std::vector<std::size_t> numbers{h + 1, static_cast<std::size_t>(property[h])};
      for (const int v : mesh.hexahedra[h]) numbers.push_back(static_cast<std::size_t>(v) + 1);
      write_card(out, "CHEXA", numbers);
    }
    out << "ENDDATA\n";
  });
}

}  // namespace

Mesh read_nastran(const std::filesystem::path& path) { return NastranReader(path).read(); }

MeshFormat nastran_format() {
  return {.extensions = {".bdf", ".nas"},
          .description = "Nastran bulk data",
          .read = read_by<read_nastran>,
          .write = write_by<write_nastran>,
          .most_order = 2,
          .write_hexahedra = write_hex_nastran,
          .eight_nodes = EightNodes::kAlways,
          .others = [](const std::filesystem::path& path) {
            NastranReader reader(path);
            reader.read();
            return reader.others();
          }};
}

}  // namespace delquad
