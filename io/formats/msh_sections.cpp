// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <vector>

#include "base/utf8.h"
#include "io/formats/msh_raw.h"
#include "io/mesh_io.h"
#include "io/nodal_values.h"
#include "io/text_scanner.h"

namespace delquad::msh {

namespace {

/// The numbers of an MSH file, which are text or bytes. All throw InputError as the scanner does.
class NumberReader {
 public:
  explicit NumberReader(TextScanner& in) : in_(in) {}

  /// From here on numbers are bytes. Reads the number 1, which tells the order of bytes.
  void expect_bytes();
  bool are_bytes() const { return are_bytes_; }
  /// Four bytes or text.
  long long integer(std::string_view what, long long low, long long high);
  /// Eight bytes or text.
  long long size(std::string_view what, long long low, long long high);
  /// A finite number. The greatest number stands for others if strays are kept.
  double real(std::string_view what, Strays strays = Strays::kRefused);

 private:
  template <class T>
  T raw(std::string_view what);
  long long checked(long long value, std::string_view what, long long low, long long high) const;

  TextScanner& in_;
  bool are_bytes_ = false, other_order_ = false;
};

template <class T>
T NumberReader::raw(std::string_view what) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, in_.bytes(sizeof bytes, what).data(), sizeof bytes);
  if (other_order_) std::reverse(bytes, bytes + sizeof bytes);
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

void NumberReader::expect_bytes() {
  constexpr std::int32_t kOneInOtherOrder = 1 << 24;
  in_.rest_of_line();
  in_.bytes(1, "the end of the line");
  are_bytes_ = true;
  const auto one = raw<std::int32_t>("the number 1");
  other_order_ = one == kOneInOtherOrder;
  if (one != 1 && !other_order_) in_.fail("expected the number 1 in four bytes, found {}", one);
}

long long NumberReader::checked(long long value, std::string_view what, long long low, long long high) const {
  if (value < low || value > high) in_.fail("expected {} from {} to {}, found {}", what, low, high, value);
  return value;
}

long long NumberReader::integer(std::string_view what, long long low, long long high) {
  if (!are_bytes_) return in_.integer(what, low, high);
  return checked(raw<std::int32_t>(what), what, low, high);
}

long long NumberReader::size(std::string_view what, long long low, long long high) {
  if (!are_bytes_) return in_.integer(what, low, high);
  return checked(static_cast<long long>(raw<std::uint64_t>(what)), what, low, high);
}

double NumberReader::real(std::string_view what, Strays strays) {
  if (!are_bytes_) return in_.real(what, strays);
  const auto value = raw<double>(what);
  if (std::isfinite(value)) return value;
  if (strays == Strays::kKept) return std::numeric_limits<double>::max();
  in_.fail("expected {} (a finite number), found {}", what, value);
}

constexpr long long kLargestTag = LLONG_MAX;      // of nodes and elements
constexpr int kLargestEntityTag = 2'000'000'000;  // leaves room for new ones

enum class Version { kUnknown, k22, k41 };

/// Room for as many as the file says, unless it cannot hold them.
template <class T>
void reserve(std::vector<T>& items, long long count, const TextScanner& scanner) {
  constexpr size_t kLeastBytes = 6;  // of a node or an element in the file
  items.reserve(items.size() + std::min(static_cast<size_t>(count), scanner.bytes_left() / kLeastBytes));
}

/// Shape and number of all nodes of an element.
struct NodeCount {
  CellShape shape;
  int all;
  int corners() const { return corners_of(shape); }
};

/// Straight and curved elements are known; triangles up to order 2.
NodeCount nodes_of_type(int type, const TextScanner& scanner) {
  using enum CellShape;
  static const std::map<int, NodeCount> counts = {
      {15, {kPoint, 1}},     {1, {kLine, 2}},         {8, {kLine, 3}},         {26, {kLine, 4}},
      {27, {kLine, 5}},      {2, {kTriangle, 3}},     {9, {kTriangle, 6}},     {3, {kQuad, 4}},
      {16, {kQuad, 8}},      {10, {kQuad, 9}},        {36, {kQuad, 16}},       {37, {kQuad, 25}},
      {5, {kHexahedron, 8}}, {17, {kHexahedron, 20}}, {12, {kHexahedron, 27}}, {6, {kPrism, 6}},
      {18, {kPrism, 15}},    {13, {kPrism, 18}},      {7, {kPyramid, 5}},      {19, {kPyramid, 13}},
      {14, {kPyramid, 14}},  {4, {kTetrahedron, 4}},  {11, {kTetrahedron, 10}}};
  if (const auto known = counts.find(type); known != counts.end()) return known->second;
  static const std::map<int, const char*> names = {{20, "third-order triangle"},
                                                   {21, "third-order triangle"},
                                                   {39, "third-order quad without inner nodes"}};
  const auto name = names.find(type);
  scanner.fail(
      "element type {}{}: expected points (15), lines (1, 8, 26, 27), triangles (2), quads (3, 10, 16, 36, "
      "37), hexahedra (5, 12, 17), prisms (6, 13, 18), pyramids (7, 14, 19) or tetrahedra (4, 11)",
      type, name == names.end() ? "" : fmt::format(" ({})", name->second));
}

class SectionReader {
 public:
  SectionReader(TextScanner& scanner, bool with_views)
      : in_(scanner), numbers_(scanner), with_views_(with_views) {}

  Contents read() {
    if (in_.at_end()) in_.fail("the file is empty: expected an MSH file, which starts with $MeshFormat");
    while (!in_.at_end()) {
      const std::string_view token = in_.token("a section");
      if (token.size() < 2 || token[0] != '$') {
        in_.fail("{}", version_ == Version::kUnknown ? "not an MSH file: expected $MeshFormat"
                                                     : "expected a section, which starts with $");
      }
      section(std::string(token.substr(1)));
    }
    if (version_ == Version::kUnknown) in_.fail("not an MSH file: expected $MeshFormat");
    for (const char* needed : {"Nodes", "Elements"}) {
      if (!seen_.contains(needed)) in_.fail("the file ends without a ${} section", needed);
    }
    if (version_ == Version::k22) settle_physicals(contents_);
    return std::move(contents_);
  }

 private:
  void section(const std::string& name) {
    static const std::map<std::string, void (SectionReader::*)()> readers = {
        {"MeshFormat", &SectionReader::mesh_format},
        {"PhysicalNames", &SectionReader::physical_names},
        {"Entities", &SectionReader::entities},
        {"Nodes", &SectionReader::nodes},
        {"Elements", &SectionReader::elements},
        {"MoreNames", &SectionReader::more_names},
        {"Unit", &SectionReader::unit},
        {"PartitionedEntities", &SectionReader::partitioned}};
    const bool is_view = name == "NodeData" || name == "ElementData";
    if (is_view) return view(name);
    const auto reader = readers.find(name);
    contents_.has_periodic |= name == "Periodic";
    if (reader == readers.end()) return skip(name);
    if (!seen_.insert(name).second) in_.fail("a second ${} section", name);
    if (version_ == Version::kUnknown && name != "MeshFormat") {
      in_.fail("expected $MeshFormat before ${}", name);
    }
    (this->*reader->second)();
    expect_end(name);
  }

  void expect_end(const std::string& name) {
    const std::string end = "$End" + name;
    if (const std::string_view found = in_.token(end); found != end)
      in_.fail("expected {} after as many as are announced, found {}", end, in_.printable(found));
  }

  /// Titles, times and counts are text in binary files, too. A value that is no number counts as none: so
  /// other programs write fields that some elements lack.
  void view(const std::string& section) {
    View view{"", section == "NodeData", 1, {}, {}};
    std::vector<double> row;
    const long long n_texts = in_.integer("the number of a view's texts", 0, INT_MAX);
    for (long long k = 0; k < n_texts; ++k) {
      std::string line(in_.token("a view's text"));
      line += in_.rest_of_line();
      const size_t open = line.find('"'), close = line.rfind('"');
      if (open == close) in_.fail("expected a view's text in double quotes");
      if (k == 0) view.name = line.substr(open + 1, close - open - 1);
    }
    if (!with_views_ && !is_thickness({view.name, view.is_of_nodes, 1, {}})) return skip(section);
    const long long n_reals = in_.integer("the number of a view's real numbers", 0, INT_MAX);
    for (long long k = 0; k < n_reals; ++k) in_.real("a view's real number");
    const long long n_integers = in_.integer("the number of a view's integers, at least 3", 3, INT_MAX);
    long long count = 0;
    for (long long k = 0; k < n_integers; ++k) {
      const long long number = in_.integer("a view's integer", 0, INT_MAX);
      if (k == 1) view.n_components = static_cast<int>(number);
      if (k == 2) count = number;
    }
    if (view.n_components < 1) in_.fail("a view without components");
    if (numbers_.are_bytes()) next_line();
    reserve(view.values, count, in_);
    for (long long i = 0; i < count; ++i) {
      const long long tag = numbers_.integer("the tag of a value", 1, kLargestTag);
      row.clear();
      for (int k = 0; k < view.n_components; ++k) row.push_back(numbers_.real("a value", Strays::kKept));
      if (std::ranges::count(row, std::numeric_limits<double>::max()) > 0) continue;
      view.values.emplace_back(tag, row[0]);
      view.further.insert(view.further.end(), row.begin() + 1, row.end());
    }
    contents_.views.push_back(std::move(view));
    expect_end(section);
  }

  void skip(const std::string& name) {
    const int first = in_.line();
    const std::string end = "$End" + name;
    if (numbers_.are_bytes() && in_.skip_past("\n" + end)) return;
    while (!numbers_.are_bytes() && !in_.at_end()) {
      if (in_.token(end) == end) return;
      in_.rest_of_line();
    }
    in_.fail_at(first, "section {} is not closed by {}", in_.printable("$" + name), in_.printable(end));
  }

  void mesh_format() {
    const std::string_view version = in_.token("the version");
    if (version == "2.2") {
      version_ = Version::k22;
    } else if (version == "4.1") {
      version_ = Version::k41;
    } else {
      in_.fail("MSH version {}: expected 2.2 or 4.1 (in Gmsh: Mesh.MshFileVersion = 4.1) [format-version]",
               in_.printable(version));
    }
    const bool binary = in_.integer("the file type", 0, 1) == 1;
    const long long bytes = in_.integer("the data size", 1, 64);
    if (!binary) return;
    if (bytes != 8) in_.fail("binary MSH file with numbers of {} bytes: expected 8", bytes);
    numbers_.expect_bytes();
  }

  void physical_names() {
    const long long count = in_.integer("the number of physical names", 0, INT_MAX);
    for (long long i = 0; i < count; ++i) {
      const auto [key, name] = named();
      contents_.physical_names[key] = as_utf8(name);
    }
  }

  void more_names() {
    const long long count = in_.integer("the number of names", 0, INT_MAX);
    for (long long i = 0; i < count; ++i) {
      const auto [key, name] = named();
      contents_.more_names[key].push_back(name);
    }
  }

  void unit() { contents_.unit = in_.token("a unit of lengths"); }

  /// Dimension, tag and name in quotes.
  std::pair<DimTag, std::string> named() {
    const int dim = static_cast<int>(in_.integer("the dimension of a physical name", 0, 3));
    const int tag =
        static_cast<int>(in_.integer("the tag of a physical name", -kLargestEntityTag, kLargestEntityTag));
    const std::string_view rest = in_.rest_of_line();
    const size_t open = rest.find('"'), close = rest.rfind('"');
    if (open == close) in_.fail("expected a physical name in double quotes");
    const std::string_view name = rest.substr(open + 1, close - open - 1);
    if (!fits_msh(name))
      in_.fail("the physical name {} has a double quote or a character that is not text",
               in_.printable(name));
    return {{dim, std::abs(tag)}, as_utf8(name)};
  }

  /// Bytes begin on the line after the section's title; in 2.2 after the line of their number, which is text.
  void begin_numbers() {
    if (!numbers_.are_bytes() || version_ == Version::k22) return;
    next_line();
  }

  void next_line() {
    in_.rest_of_line();
    in_.bytes(1, "the end of the line");
  }

  /// How many there are of what.
  long long count_of(const char* what) {
    const std::string title = fmt::format("the number of {}", what);
    if (version_ == Version::k41) return numbers_.size(title, 0, INT_MAX);
    const long long count = in_.integer(title, 0, INT_MAX);
    if (numbers_.are_bytes()) next_line();
    return count;
  }

  long long node_tag() {
    constexpr const char* kWhat = "a node's tag";
    return version_ == Version::k22 ? numbers_.integer(kWhat, 1, kLargestTag)
                                    : numbers_.size(kWhat, 1, kLargestTag);
  }

  void entities() {
    if (version_ == Version::k22) in_.fail("$Entities does not belong to MSH 2.2");
    begin_numbers();
    long long counts[4];
    for (int dim = 0; dim < 4; ++dim) counts[dim] = numbers_.size("the number of entities", 0, INT_MAX);
    for (int dim = 0; dim < 4; ++dim) {
      for (long long i = 0; i < counts[dim]; ++i) entity(dim);
    }
  }

  void entity(int dim) {
    const int tag =
        static_cast<int>(numbers_.integer("an entity's tag", -kLargestEntityTag, kLargestEntityTag));
    for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) numbers_.real("a bound of the entity");
    std::vector<int> physicals;
    const long long n_physicals = numbers_.size("the number of the entity's physical tags", 0, INT_MAX);
    for (long long k = 0; k < n_physicals; ++k) {
      physicals.push_back(std::abs(
          static_cast<int>(numbers_.integer("a physical tag", -kLargestEntityTag, kLargestEntityTag))));
    }
    if (dim > 0) {
      const long long n_bounding = numbers_.size("the number of bounding entities", 0, INT_MAX);
      std::vector<int> bounding;
      for (long long k = 0; k < n_bounding; ++k)
        bounding.push_back(std::abs(static_cast<int>(
            numbers_.integer("a bounding entity's tag", -kLargestEntityTag, kLargestEntityTag))));
      std::sort(bounding.begin(), bounding.end());
      if (dim == 2) contents_.surface_curves[tag] = std::move(bounding);
    }
    if (!contents_.entity_physicals.emplace(DimTag{dim, tag}, std::move(physicals)).second) {
      in_.fail("a second entity of dimension {} with tag {}", dim, tag);
    }
  }

  Vec3 position() {
    const double x = numbers_.real("coordinate x"), y = numbers_.real("coordinate y"),
                 z = numbers_.real("coordinate z");
    return {x, y, z};
  }

  void nodes() {
    begin_numbers();
    const bool blocks = version_ == Version::k41;
    const long long n_blocks = blocks ? numbers_.size("the number of node blocks", 0, INT_MAX) : 1;
    const long long count = count_of("nodes");
    reserve(contents_.nodes, count, in_);
    if (!blocks) {
      for (long long i = 0; i < count; ++i) {
        const long long tag = node_tag();
        const int line = in_.line();
        contents_.nodes.push_back({tag, position(), line});
      }
      return;
    }
    numbers_.size("the least node tag", 0, kLargestTag);
    numbers_.size("the greatest node tag", 0, kLargestTag);
    for (long long b = 0; b < n_blocks; ++b) node_block(count);
    if (static_cast<long long>(contents_.nodes.size()) != count) {
      in_.fail("the blocks hold {} nodes, but {} were announced", contents_.nodes.size(), count);
    }
  }

  void node_block(long long announced) {
    const int dim = static_cast<int>(numbers_.integer("the dimension of a node block", 0, 3));
    numbers_.integer("the entity of a node block", -kLargestEntityTag, kLargestEntityTag);
    const bool parametric = numbers_.integer("0 or 1 (parametric)", 0, 1) == 1;
    const size_t first = contents_.nodes.size();
    const long long count = numbers_.size("the number of nodes in the block", 0, INT_MAX);
    if (static_cast<long long>(first) + count > announced) {
      in_.fail("more nodes than the {} announced", announced);
    }
    for (long long i = 0; i < count; ++i) {
      const long long tag = node_tag();
      contents_.nodes.push_back({tag, {}, in_.line()});
    }
    for (size_t i = first; i < contents_.nodes.size(); ++i) {
      contents_.nodes[i].at = position();
      for (int k = 0; parametric && k < dim; ++k) numbers_.real("a node's parameter");
    }
  }

  void elements() {
    begin_numbers();
    if (version_ == Version::k22) return elements_22();
    const long long n_blocks = numbers_.size("the number of element blocks", 0, INT_MAX);
    const long long announced = count_of("elements");
    numbers_.size("the least element tag", 0, kLargestTag);
    numbers_.size("the greatest element tag", 0, kLargestTag);
    reserve(contents_.elements, announced, in_);
    long long total = 0;
    for (long long b = 0; b < n_blocks; ++b) total += element_block(announced - total);
    if (total != announced) {
      in_.fail("the blocks hold {} elements, but {} were announced", total, announced);
    }
  }

  long long element_block(long long most) {
    const int dim = static_cast<int>(numbers_.integer("the dimension of an element block", 0, 3));
    const int entity = static_cast<int>(
        numbers_.integer("the entity of an element block", -kLargestEntityTag, kLargestEntityTag));
    const NodeCount nodes =
        nodes_of_type(static_cast<int>(numbers_.integer("an element type", 1, INT_MAX)), in_);
    if (dim != dimension_of(nodes.shape)) {
      in_.fail("elements of {} corners in a block of dimension {}", nodes.corners(), dim);
    }
    const long long count = numbers_.size("the number of elements in the block", 0, INT_MAX);
    if (count > most) in_.fail("more elements than announced");
    for (long long i = 0; i < count; ++i) {
      const long long tag = numbers_.size("an element's tag", 1, kLargestTag);
      element(tag, nodes, entity, 0);
    }
    return count;
  }

  void elements_22() {
    const long long count = count_of("elements");
    reserve(contents_.elements, count, in_);
    const auto type = [&] { return static_cast<int>(numbers_.integer("an element type", 1, INT_MAX)); };
    const auto n_tags = [&] { return numbers_.integer("the number of an element's tags", 0, INT_MAX); };
    if (!numbers_.are_bytes()) {
      for (long long i = 0; i < count; ++i) {
        const long long tag = numbers_.integer("an element's tag", 1, kLargestTag);
        const NodeCount nodes = nodes_of_type(type(), in_);
        tagged_element(tag, nodes, n_tags());
      }
      return;
    }
    for (long long i = 0; i < count;) {
      const NodeCount nodes = nodes_of_type(type(), in_);
      const long long n = numbers_.integer("the number of elements that follow", 1, count - i);
      const long long tags = n_tags();
      for (const long long last = i + n; i < last; ++i) {
        const long long tag = numbers_.integer("an element's tag", 1, kLargestTag);
        tagged_element(tag, nodes, tags);
      }
    }
  }

  void tagged_element(long long own_tag, const NodeCount& nodes, long long n_tags) {
    int tags[2] = {0, 0};  // physical, elementary
    for (long long k = 0; k < n_tags; ++k) {
      const int tag = static_cast<int>(numbers_.integer("a tag", -kLargestEntityTag, kLargestEntityTag));
      if (k < 2) tags[k] = std::abs(tag);
    }
    element(own_tag, nodes, tags[1], tags[0]);
  }

  void element(long long tag, const NodeCount& nodes, int entity, int physical) {
    Element e{tag, nodes.shape, entity, physical, {}, in_.line(), nodes.all - nodes.corners()};
    e.first_further = contents_.further_nodes.size();
    for (int k = 0; k < nodes.corners(); ++k) e.nodes[k] = node_tag();
    for (int k = 0; k < e.n_further; ++k) contents_.further_nodes.push_back(node_tag());
    if (nodes.shape != CellShape::kPoint)
      contents_.elements.push_back(e);
    else
      contents_.points.push_back({entity, physical, e.nodes[0], e.line});
  }

  [[noreturn]] void partitioned() { in_.fail("partitioned mesh: expected one that is saved whole"); }

  TextScanner& in_;
  NumberReader numbers_;
  bool with_views_;
  Version version_ = Version::kUnknown;
  std::set<std::string> seen_;
  Contents contents_;
};

}  // namespace

Contents read_contents(TextScanner& scanner, bool with_views) {
  return SectionReader(scanner, with_views).read();
}

}  // namespace delquad::msh
