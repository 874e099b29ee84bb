// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "io/cell_view.h"
#include "io/face_reader.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

// CGAL's reader sets aside whatever memory a damaged length asks for, and does not say where it stopped.

namespace delquad {

namespace {

enum class Coding { kText, kLittle, kBig };

struct Scalar {
  const char *name, *old_name;
  int bytes;
  bool is_signed, is_real;
};
constexpr std::array<Scalar, 8> kScalars = {{{"int8", "char", 1, true, false},
                                             {"uint8", "uchar", 1, false, false},
                                             {"int16", "short", 2, true, false},
                                             {"uint16", "ushort", 2, false, false},
                                             {"int32", "int", 4, true, false},
                                             {"uint32", "uint", 4, false, false},
                                             {"float32", "float", 4, true, true},
                                             {"float64", "double", 8, true, true}}};

struct Property {
  std::string name;
  const Scalar* type;
  const Scalar* count = nullptr;  ///< of a list
  std::string shown = {};         ///< in messages
};

struct Element {
  std::string name;
  long long number;
  std::vector<Property> properties;

  /// Bytes that one of it takes at the least: in a text a digit and what ends it.
  long long least_bytes(Coding coding) const {
    long long sum = 0;
    for (const Property& p : properties)
      sum += coding == Coding::kText ? 2 : (p.count != nullptr ? p.count : p.type)->bytes;
    return sum;
  }
};

class PlyReader : FaceReader {
 public:
  PlyReader(const std::filesystem::path& path, Strays strays) : FaceReader(path, "PLY", strays) {}

  Mesh read(ReadNotes* notes) {
    read_header();
    for (const Element& element : elements_) {
      const bool fits = element.number <= static_cast<long long>(in_.bytes_left() + 1) /
                                              std::max(1LL, element.least_bytes(coding_));
      if (!fits)
        in_.fail("{} elements {} do not fit in the {} bytes that follow", element.number,
                 TextScanner::printable(element.name), in_.bytes_left());
      for (long long i = 0; i < element.number; ++i) read_element(element, i);
    }
    check_end();
    if (mesh_.triangles.empty() && mesh_.quads.empty())
      in_.fail("the file holds no faces: expected triangles, not points alone");
    colours_.finish(mesh_, notes);
    return finished(notes);
  }

 private:
  void read_header() {
    if (in_.at_end() || in_.token("'ply'") != "ply") in_.fail("expected a PLY file, which begins with 'ply'");
    bool has_format = false;
    while (true) {
      const std::string keyword(in_.token("'end_header'"));
      if (keyword == "format") {
        read_format();
        has_format = true;
      } else if (keyword == "element") {
        const std::string name(in_.token("the element's name"));
        elements_.push_back({name, in_.integer("the number of elements", 0, INT_MAX), {}});
      } else if (keyword == "property") {
        read_property();
      } else if (keyword == "end_header") {
        break;
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.starts_with('#')) {
        in_.fail("expected 'element', 'property' or 'end_header', found {}", TextScanner::printable(keyword));
      }
      in_.rest_of_line();
    }
    if (!has_format) in_.fail("the header has no line 'format': expected a whole PLY file");
    check_vertices();
    if (coding_ == Coding::kText) return;
    if (!in_.skip_past("\n")) in_.fail("the file ends too early: expected its numbers");
    in_.bytes(0, "");
  }

  void read_format() {
    const std::string_view format = in_.token("the format");
    if (format == "ascii")
      coding_ = Coding::kText;
    else if (format == "binary_little_endian")
      coding_ = Coding::kLittle;
    else if (format == "binary_big_endian")
      coding_ = Coding::kBig;
    else
      in_.fail("expected 'ascii', 'binary_little_endian' or 'binary_big_endian', found {}",
               TextScanner::printable(format));
  }

  const Scalar* read_type() {
    const std::string_view name = in_.token("a type");
    const auto at =
        std::ranges::find_if(kScalars, [&](const Scalar& s) { return name == s.name || name == s.old_name; });
    if (at == kScalars.end())
      in_.fail("expected a type such as 'float' or 'int', found {}", TextScanner::printable(name));
    return &*at;
  }

  void read_property() {
    if (elements_.empty()) in_.fail("a property stands before any element: expected a line 'element' first");
    Property property{};
    if (in_.next_is('l')) {
      in_.token("'list'");
      property.count = read_type();
      if (property.count->is_real) in_.fail("expected an integer type for the length of a list");
    }
    property.type = read_type();
    property.name = in_.token("the property's name");
    property.shown = "property " + TextScanner::printable(property.name);
    elements_.back().properties.push_back(std::move(property));
  }

  /// Faces name vertices by number, so that these come first.
  void check_vertices() {
    const auto vertex = std::ranges::find(elements_, "vertex", &Element::name);
    if (vertex == elements_.end()) in_.fail("the header has no element 'vertex': expected points");
    for (const char* name : {"x", "y", "z"})
      if (std::ranges::find(vertex->properties, name, &Property::name) == vertex->properties.end())
        in_.fail("the vertices have no property '{}'", name);
    n_vertices_ = vertex->number;
    if (std::ranges::find(elements_, "tristrips", &Element::name) != elements_.end())
      in_.fail("triangle strips: expected an element 'face'");
  }

  template <class T>
  double number_of(std::string_view bytes) const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes.data(), sizeof(T));
    if ((coding_ == Coding::kBig) != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
    return static_cast<double>(std::bit_cast<T>(raw));
  }

  double scalar(const Property& property, const Scalar& type) {
    if (coding_ == Coding::kText) {
      if (!property_counts_) return in_.token(property.shown), 0;
      return type.is_real ? in_.real(property.shown, strays_)
                          : static_cast<double>(in_.integer(property.shown, LLONG_MIN, LLONG_MAX));
    }
    const std::string_view bytes = in_.bytes(static_cast<std::size_t>(type.bytes), property.shown);
    if (type.is_real) return type.bytes == 4 ? number_of<float>(bytes) : number_of<double>(bytes);
    if (type.bytes == 1)
      return type.is_signed ? number_of<std::int8_t>(bytes) : number_of<std::uint8_t>(bytes);
    if (type.bytes == 2)
      return type.is_signed ? number_of<std::int16_t>(bytes) : number_of<std::uint16_t>(bytes);
    return type.is_signed ? number_of<std::int32_t>(bytes) : number_of<std::uint32_t>(bytes);
  }

  void read_list(const Property& property, std::vector<int>* corners) {
    property_counts_ = true;
    const double count = scalar(property, *property.count);
    property_counts_ = corners != nullptr;
    if (!(count >= 0 && count <= static_cast<double>(in_.bytes_left())))
      in_.fail("{} lists {} values, which do not follow", property.shown, count);
    for (long long k = 0; k < static_cast<long long>(count); ++k) {
      const double v = scalar(property, *property.type);
      if (corners == nullptr) continue;
      if (!(v >= 0 && v < static_cast<double>(n_vertices_)))
        in_.fail("expected a vertex from 0 to {}, found {}", n_vertices_ - 1, v);
      corners->push_back(static_cast<int>(v));
    }
  }

  /// "'vertex': 8, 'face': 12"
  std::string announced() const {
    std::string text;
    for (const Element& e : elements_)
      text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", TextScanner::printable(e.name), e.number);
    return text;
  }

  /// Files of bytes may end with white space or zeros, which are nothing.
  void check_end() {
    if (coding_ == Coding::kText) in_.skip_comments();
    const std::string_view rest = in_.text().substr(in_.text().size() - in_.bytes_left());
    if (rest.find_first_not_of(std::string_view(" \t\r\n\0", 5)) != std::string_view::npos)
      in_.fail(
          "expected the end of the file after the elements that the header announces ({}): {} bytes follow",
          announced(), rest.size());
  }

  /// Texts have one element on each line: else their number in the header is wrong.
  void check_line(const Element& element, long long i, int line) {
    if (coding_ != Coding::kText) return;
    if (in_.line() != line || !(in_.at_end_of_line() || in_.next_is('#')))
      in_.fail_at(line,
                  "element {} of {} {}: expected its values, and no others, on a line; are the numbers of "
                  "elements in the header right ({})?",
                  i + 1, element.number, TextScanner::printable(element.name), announced());
    in_.rest_of_line();
  }

  /// The element with index i of its kind.
  void read_element(const Element& element, long long i) {
    if (element.properties.empty()) return;
    if (coding_ == Coding::kText) {
      in_.skip_comments();
      if (in_.at_end())
        in_.fail("the header announces {} elements {}, but {} follow", element.number,
                 TextScanner::printable(element.name), i);
    }
    const int line = in_.line();
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    Vec3 point;
    std::vector<int> corners;
    std::array<int, 3> rgb = {-1, -1, -1};
    for (const Property& property : element.properties) {
      const std::string& name = property.name;
      if (property.count != nullptr) {
        const bool are_corners = is_face && (name == "vertex_indices" || name == "vertex_index");
        read_list(property, are_corners ? &corners : nullptr);
        continue;
      }
      const int axis = is_vertex && name.size() == 1 && name[0] >= 'x' && name[0] <= 'z' ? name[0] - 'x' : -1;
      const int channel = !is_face ? -1 : name == "red" ? 0 : name == "green" ? 1 : name == "blue" ? 2 : -1;
      property_counts_ = axis >= 0 || channel >= 0;
      const double value = scalar(property, *property.type);
      if (axis >= 0) (axis == 0 ? point.x : axis == 1 ? point.y : point.z) = in_.finite(value, strays_);
      if (channel >= 0) rgb[channel] = part_of_255(property.type->is_real ? 255 * value : value);
    }
    check_line(element, i, line);
    if (is_vertex) add_point(point);
    if (is_face) {
      if (static_cast<long long>(mesh_.points.size()) < n_vertices_)
        in_.fail("the faces stand before the vertices: expected them behind");
      add_face(corners, colours_.region("", std::ranges::min(rgb) < 0 ? "" : colour_text(rgb)));
    }
  }

  /// Not-a-number is no color.
  static int part_of_255(double value) {
    return std::isnan(value) ? -1 : static_cast<int>(std::clamp(value, 0.0, 255.0));
  }

  Coding coding_ = Coding::kText;
  std::vector<Element> elements_;
  long long n_vertices_ = 0;
  bool property_counts_ = true;  ///< whether the value that is read next is used
  FaceColours colours_;
};

/// Reads the Polygon File Format (Stanford), text or binary of either byte order. Faces of one color are a
/// region with its name ("color #rrggbb"), unless there are more than 64 colors; other properties are left
/// out. Faces of more than four vertices are split into triangles.
Mesh read_ply(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  return PlyReader(path, strays).read(notes);
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  write_text_file(path, [&](TextWriter& out) {
    out << "ply\nformat ascii 1.0\nelement vertex " << mesh.points.size();
    for (const char* name : {"x", "y", "z"}) out << "\nproperty double " << name;
    out << "\nelement face " << mesh.triangles.size() + mesh.quads.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    write_points_and_faces(out, mesh);
  });
}

}  // namespace

MeshFormat ply_format() {
  return {.extensions = {".ply"},
          .description = "Polygon File Format, written as text",
          .read = read_ply,
          .write = write_by<write_ply>,
          .names = 0};
}

}  // namespace delquad
