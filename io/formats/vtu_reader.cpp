// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <charconv>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

#include "base/located.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"
#include "io/face_reader.h"
#include "io/formats/vtu.h"
#include "io/mesh_io.h"
#include "io/nodal_values.h"
#include "io/text_scanner.h"

namespace delquad {

namespace {

/// Numbers of entities of all dimensions in one array, as meshio calls them.
constexpr const char* kTagsOfGmsh = "gmsh:physical";

using Tree = boost::property_tree::ptree;

/// Boost's parser calls itself for each element in another.
constexpr int kDeepest = 100;

/// Levels of elements in elements, or more: comments and texts are taken for elements, too.
int depth_of(std::string_view xml) {
  int depth = 0, deepest = 0;
  for (size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at + 1)) {
    const std::string_view rest = xml.substr(at + 1, 1);
    if (rest == "?" || rest == "!") continue;
    depth += rest == "/" ? -1 : 1;
    deepest = std::max(deepest, depth);
    const size_t end = xml.find('>', at);
    if (end != std::string_view::npos && xml[end - 1] == '/') --depth;
  }
  return deepest;
}

/// 0, which is no type of cell and no tag, for numbers that are no int.
int as_int(double value) { return value > INT_MIN && value < INT_MAX ? static_cast<int>(value) : 0; }

/// Bytes of base64 digits up to the first character that is none; blanks between them are skipped.
std::string from_base64(std::string_view text, size_t* used = nullptr) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t held = 0;
  int bits = 0;
  size_t at = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
    const size_t value = digits.find(c);
    if (value == std::string::npos) break;
    held = held << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 255);
  }
  while (at < text.size() && text[at] == '=') ++at;
  if (used) *used = at;
  return bytes;
}

class VtuReader {
 public:
  explicit VtuReader(const std::filesystem::path& path, ReadNotes* notes = nullptr)
      : path_(path.string()), in_(path), notes_(notes) {
    refuse_other_kinds(in_, "VTU");
  }

  Mesh read() {
    parse();
    const Tree& file = child(tree_, "VTKFile");
    if (attribute(file, "type") != "UnstructuredGrid")
      fail("a VTK file of type {}: expected an UnstructuredGrid", shown(attribute(file, "type")));
    swapped_ = attribute(file, "byte_order", "LittleEndian") !=
               (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian");
    wide_header_ = attribute(file, "header_type", "UInt32") == "UInt64";
    const std::string compressor = attribute(file, "compressor", "");
    packed_ = compressor == "vtkZLibDataCompressor";
    if (!compressor.empty() && !packed_)
      fail("compressed by {}: expected vtkZLibDataCompressor or none", shown(compressor));
    const Tree& grid = child(file, "UnstructuredGrid");
    for (const auto& [name, piece] : grid)
      if (name == "Piece") read_piece(piece);
    if (mesh_.lines.empty() && mesh_.triangles.empty() && mesh_.quads.empty() && !is_solid(mesh_))
      fail("the file holds no lines, triangles, quads or cells");
    if (notes_ != nullptr && has_curved_cells_) notes_->push_back(kCornersOfCells);
    for (const auto& [name, data] : grid)
      if (name == "FieldData") read_names(data);
    if (choice_ == nullptr) drop_unused_points(mesh_);
    return std::move(mesh_);
  }

  /// Points that no element uses stay.
  MeshWithFields read_fields(const FieldChoice& choice) {
    choice_ = &choice;
    MeshWithFields result{read(), {}};
    require_own_points(result.mesh, n_points_, path_);
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      for (std::size_t s = 0; s < kCellShapes && !fields_[k].is_of_points; ++s)
        if (dimension_of(static_cast<CellShape>(s)) == (is_solid(result.mesh) ? 3 : 2))
          fields_[k].values.insert(fields_[k].values.end(), of_shapes_[k][s].begin(), of_shapes_[k][s].end());
    }
    result.fields = std::move(fields_);
    return result;
  }

 private:
  static std::string shown(const std::string& text) { return TextScanner::printable(text); }
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
    refuse("{}: {}", path_, fmt::format(text, std::forward<Args>(args)...));
  }

  /// Raw appended data is no XML and is cut out before.
  void parse() {
    std::string text(in_.text());
    const size_t open = text.find("<AppendedData"), first = text.find('_', std::min(open, text.size()));
    const size_t close = text.rfind("</AppendedData>");
    if (open != std::string::npos && first != std::string::npos && close != std::string::npos &&
        first < close) {
      appended_ = text.substr(first + 1, close - first - 1);
      text.erase(first, close - first);
      has_appended_ = true;
    }
    if (depth_of(text) > kDeepest)
      fail("elements within elements to more than {} levels: expected a VTU file", kDeepest);
    std::istringstream stream(std::move(text));
    try {
      read_xml(stream, tree_);
    } catch (const boost::property_tree::xml_parser_error& error) {
      refuse("{}:{}: {}: expected a VTU file, which is XML", path_, error.line(), error.message());
    }
    if (!has_appended_) return;
    const std::string encoding = attribute(child(child(tree_, "VTKFile"), "AppendedData"), "encoding", "raw");
    raw_ = encoding == "raw";
  }

  const Tree& child(const Tree& tree, const std::string& name) const {
    const auto found = tree.find(name);
    if (found == tree.not_found()) fail("expected an element <{}>", name);
    return found->second;
  }

  static std::string attribute(const Tree& tree, const std::string& name, const std::string& otherwise = "") {
    return tree.get("<xmlattr>." + name, otherwise);
  }

  const Tree* array_named(const Tree& parent, const std::string& name) const {
    for (const auto& [tag, data] : parent)
      if (tag == "DataArray" && (name.empty() || attribute(data, "Name") == name)) return &data;
    return nullptr;
  }

  const Tree& needed_array(const Tree& parent, const std::string& name) const {
    const Tree* array = array_named(parent, name);
    if (!array) fail("expected a data array '{}'", name);
    return *array;
  }

  template <class T>
  T from_bytes(const char* data) const {
    char bytes[sizeof(T)];
    std::memcpy(bytes, data, sizeof bytes);
    if (swapped_) std::reverse(bytes, bytes + sizeof bytes);
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  std::uint64_t header_number(std::string_view bytes, size_t k) const {
    const size_t width = wide_header_ ? 8 : 4;
    if (bytes.size() < (k + 1) * width) fail("a data array ends within its header: expected a whole file");
    return wide_header_ ? from_bytes<std::uint64_t>(bytes.data() + k * width)
                        : from_bytes<std::uint32_t>(bytes.data() + k * width);
  }

  /// The bytes of an array: after their number as they are, or after a table of blocks, packed.
  std::string payload(std::string_view text, bool is_raw) const {
    const size_t width = wide_header_ ? 8 : 4;
    if (!packed_) {
      size_t used = 0;
      std::string bytes = is_raw ? std::string(text) : from_base64(text, &used);
      const std::uint64_t n = header_number(bytes, 0);
      // Some programs encode the number apart from the data.
      if (!is_raw && bytes.size() == width) bytes += from_base64(text.substr(used));
      if (bytes.size() - width < n)
        fail("a data array of {} bytes has only {}: expected a whole file", n, bytes.size() - width);
      return bytes.substr(width, n);
    }
    size_t used = 0;
    std::string head = is_raw ? std::string(text) : from_base64(text, &used);
    const std::uint64_t n_blocks = header_number(head, 0);
    if (n_blocks > head.size()) fail("a compressed data array has a damaged header: expected a whole file");
    const size_t header = (3 + n_blocks) * width;
    std::string data = head.substr(std::min(header, head.size()));
    if (!is_raw && data.empty()) data = from_base64(text.substr(used));
    std::string result;
    size_t at = 0;
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      const std::uint64_t n = header_number(head, 3 + b), whole = header_number(head, 1),
                          last = header_number(head, 2);
      const std::uint64_t size = b + 1 == n_blocks && last > 0 ? last : whole;
      result += unpacked(data, at, n, size);
      at += n;
    }
    return result;
  }

  std::string unpacked(const std::string& data, size_t at, std::uint64_t n, std::uint64_t size) const {
    constexpr std::uint64_t kMostRatio = 2000;  // zlib packs no more than 1032 times
    if (at > data.size() || n > data.size() - at || size > kMostRatio * (n + 1))
      fail("a compressed data array is damaged: expected a whole file");
    std::string bytes(size, '\0');
    uLongf length = size;
    const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                                  reinterpret_cast<const Bytef*>(data.data() + at), n);
    if (status != Z_OK || length != size) fail("a compressed data array is damaged: expected a whole file");
    return bytes;
  }

  template <class T>
  std::vector<double> values(const std::string& bytes) const {
    std::vector<double> result;
    for (size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T))
      result.push_back(static_cast<double>(from_bytes<T>(bytes.data() + at)));
    return result;
  }

  /// Whole numbers stay exact up to 2^53.
  std::vector<double> read_array(const Tree& array) const {
    const std::string format = attribute(array, "format", "ascii"), name = attribute(array, "Name"),
                      type = attribute(array, "type");
    if (format == "ascii") return read_text(array.data(), name);
    std::string bytes;
    if (format == "appended") {
      const auto offset = array.get<std::uint64_t>("<xmlattr>.offset", appended_.size() + 1);
      if (offset > appended_.size())
        fail("data array {} lies behind the appended data: expected a whole file", shown(name));
      bytes = payload(std::string_view(appended_).substr(offset), raw_);
    } else {
      bytes = payload(array.data(), false);
    }
    if (type == "Float64") return values<double>(bytes);
    if (type == "Float32") return values<float>(bytes);
    if (type == "Int64") return values<std::int64_t>(bytes);
    if (type == "UInt64") return values<std::uint64_t>(bytes);
    if (type == "Int32") return values<std::int32_t>(bytes);
    if (type == "UInt32") return values<std::uint32_t>(bytes);
    if (type == "Int16") return values<std::int16_t>(bytes);
    if (type == "UInt16") return values<std::uint16_t>(bytes);
    if (type == "Int8") return values<std::int8_t>(bytes);
    if (type == "UInt8") return values<std::uint8_t>(bytes);
    fail("data array {} of type {}: expected numbers", shown(name), shown(type));
  }

  std::vector<double> read_text(const std::string& text, const std::string& name) const {
    std::vector<double> result;
    const char *at = text.data(), *end = text.data() + text.size();
    while (true) {
      while (at < end && (*at == ' ' || (*at >= '\t' && *at <= '\r'))) ++at;
      if (at == end) return result;
      double value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc()) fail("data array {}: expected numbers", shown(name));
      result.push_back(value);
      at = stop;
    }
  }

  void check_number(const Tree& piece, const std::string& name, size_t n) const {
    const auto announced = piece.get_optional<size_t>("<xmlattr>." + name);
    if (announced && *announced != n) fail("{} is {}, but there are {}", name, *announced, n);
  }

  void read_piece(const Tree& piece) {
    const Tree* coordinates = array_named(child(piece, "Points"), "");
    if (!coordinates) fail("expected an array of points");
    const std::vector<double> xyz = read_array(*coordinates);
    const size_t first = mesh_.points.size();
    for (size_t i = 0; i + 2 < xyz.size(); i += 3) {
      for (size_t k = 0; k < 3; ++k)
        if (!std::isfinite(xyz[i + k])) fail("point {}: expected finite coordinates", i / 3);
      mesh_.points.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
    }
    const size_t n_points = mesh_.points.size() - first;
    check_number(piece, "NumberOfPoints", n_points);
    const Tree& cells = child(piece, "Cells");
    const std::vector<double> corners = read_array(needed_array(cells, "connectivity")),
                              offsets = read_array(needed_array(cells, "offsets")),
                              types = read_array(needed_array(cells, "types"));
    if (types.size() != offsets.size())
      fail("{} types of cells and {} offsets", types.size(), offsets.size());
    check_number(piece, "NumberOfCells", types.size());
    // By dimension; of hexahedra our files have "face" in the place of "region".
    const std::array<std::vector<double>, 4> tags_of = {{{},
                                                         tags(piece, {"curve"}, types.size()),
                                                         tags(piece, {"region", "face"}, types.size()),
                                                         tags(piece, {"volume"}, types.size())}};
    std::vector<MeshField> fields;
    if (choice_ != nullptr) fields = read_fields_of(piece, n_points, types.size());
    double begin = 0;
    for (size_t c = 0; c < types.size(); ++c) {
      if (!(begin <= offsets[c] && offsets[c] <= static_cast<double>(corners.size())))
        fail("cell {} lies outside of the connectivity: expected a whole file", c);
      std::vector<int> v;
      for (auto k = static_cast<size_t>(begin); k < static_cast<size_t>(offsets[c]); ++k) {
        if (!(corners[k] >= 0 && corners[k] < static_cast<double>(n_points)))
          fail("cell {}: there is no point {}", c, corners[k]);
        v.push_back(static_cast<int>(first) + static_cast<int>(corners[k]));
      }
      begin = offsets[c];
      const CellType* const type = type_of(as_int(types[c]), v.size());
      if (type == nullptr) continue;
      const int dim = dimension_of(type->shape);
      add_cell(*type, v, tags_of[dim][c]);
      for (size_t k = 0; k < fields.size() && dim > 1; ++k) {
        if (fields[k].is_of_points) continue;
        auto& target = of_shapes_[k][static_cast<size_t>(type->shape)];
        const auto of_cell =
            fields[k].values.begin() + static_cast<std::ptrdiff_t>(c) * fields[k].n_components;
        target.insert(target.end(), of_cell, of_cell + fields[k].n_components);
      }
    }
    for (size_t k = 0; k < fields.size(); ++k)
      if (fields[k].is_of_points)
        fields_[k].values.insert(fields_[k].values.end(), fields[k].values.begin(), fields[k].values.end());
  }

  std::vector<MeshField> read_fields_of(const Tree& piece, size_t n_points, size_t n_cells) {
    std::vector<MeshField> all, chosen;
    std::vector<const Tree*> arrays;
    for (const char* kind : {"PointData", "CellData"}) {
      const auto data = piece.find(kind);
      if (data == piece.not_found()) continue;
      for (const auto& [tag, array] : data->second) {
        const std::string name = attribute(array, "Name");
        constexpr std::array<std::string_view, 5> kTags = {"curve", "region", "face", "volume", kTagsOfGmsh};
        if (tag != "DataArray" || std::ranges::find(kTags, name) != kTags.end()) continue;
        all.push_back({name,
                       std::string_view(kind) == "PointData",
                       array.get<int>("<xmlattr>.NumberOfComponents", 1),
                       {}});
        arrays.push_back(&array);
      }
    }
    for (const size_t i : (*choice_)(all)) {
      MeshField& field = chosen.emplace_back(all[i]);
      field.values = read_array(*arrays[i]);
      const size_t n = field.is_of_points ? n_points : n_cells;
      if (field.n_components < 1 || field.values.size() != n * static_cast<size_t>(field.n_components))
        fail("data array {}: {} values for {} {}", shown(field.name), field.values.size(), n,
             field.is_of_points ? "points" : "cells");
    }
    if (fields_.empty() && n_points_ == 0)
      for (const MeshField& field : chosen) {
        fields_.push_back({field.name, field.is_of_points, field.n_components, {}});
        of_shapes_.emplace_back();
      }
    const auto is_like = [](const MeshField& a, const MeshField& b) {
      return a.name == b.name && a.is_of_points == b.is_of_points && a.n_components == b.n_components;
    };
    if (!std::ranges::equal(chosen, fields_, is_like)) fail("its pieces have other fields each");
    n_points_ += n_points;
    return chosen;
  }

  /// Returns the first of these arrays that there is, or the tags of Gmsh; 0: there are none.
  std::vector<double> tags(const Tree& piece, std::vector<std::string> names, size_t n) const {
    const auto data = piece.find("CellData");
    names.emplace_back(kTagsOfGmsh);
    const Tree* array = nullptr;
    for (const std::string& name : names)
      if (!array && data != piece.not_found()) array = array_named(data->second, name);
    if (!array) return std::vector<double>(n, 0);
    std::vector<double> all = read_array(*array);
    if (all.size() != n) fail("data array '{}': {} values for {} cells", names[0], all.size(), n);
    for (const double tag : all)
      if (!(tag >= 0 && tag < INT_MAX && tag == std::floor(tag)))
        fail("data array '{}': {}: expected whole numbers", names[0], tag);
    return all;
  }

  /// A type of cells and the number of its points; 0: it has several orders.
  struct CellType {
    int number;
    CellShape shape;
    size_t n_points;
  };

  /// Null for vertices, which are skipped.
  const CellType* type_of(int number, size_t n_points) const {
    using enum CellShape;
    static constexpr CellType kTypes[] = {
        {3, kLine, 2},         {21, kLine, 3},        {68, kLine, 0},        {5, kTriangle, 3},
        {9, kQuad, 4},         {23, kQuad, 8},        {28, kQuad, 9},        {70, kQuad, 0},
        {12, kHexahedron, 8},  {25, kHexahedron, 20}, {29, kHexahedron, 27}, {13, kPrism, 6},
        {26, kPrism, 15},      {32, kPrism, 18},      {14, kPyramid, 5},     {27, kPyramid, 13},
        {10, kTetrahedron, 4}, {24, kTetrahedron, 10}};
    constexpr int kVertex = 1, kPolyVertex = 2;
    if (number == kVertex || number == kPolyVertex) return nullptr;
    const auto* const type = std::ranges::find(kTypes, number, &CellType::number);
    if (type == std::end(kTypes))
      fail("a cell of type {}: expected lines, triangles, quads, tetrahedra, pyramids, wedges or hexahedra",
           number);
    if (type->n_points > 0 && n_points != type->n_points)
      fail("a cell of type {} has {} points: expected {}", number, n_points, type->n_points);
    constexpr size_t kEight = 8;
    const int order = type->shape == kLine ? order_of_line(n_points) : order_of_quad(n_points);
    if (type->n_points == 0 && (order == 0 || n_points == kEight))
      fail("a cell of type {} has {} points: expected {}", number, n_points,
           type->shape == kLine ? "2 to 5" : "4, 9, 16 or 25");
    return type;
  }

  void add_cell(const CellType& type, std::vector<int>& v, double tag) {
    has_curved_cells_ |= has_further(type.shape, v.size());
    if (type.shape == CellShape::kPrism) turn_over(v);
    const int cell = entity(dimension_of(type.shape), tag);
    if (const auto wrong = add_element(mesh_, type.shape, v, cell, vtk_places); !wrong.empty())
      fail("{}", wrong);
  }

  /// In VTK the first triangle of a wedge looks outwards, but many programs write it inwards.
  void turn_over(std::vector<int>& v) const {
    const auto at = [&](int k) { return mesh_.points[v[k]]; };
    const Vec3 up = at(3) + at(4) + at(5) - at(0) - at(1) - at(2);
    if (dot(cross(at(1) - at(0), at(2) - at(0)), up) > 0) return;
    std::swap(v[1], v[2]);
    std::swap(v[4], v[5]);
  }

  /// 0, where a file has no tags, is entity 1.
  int entity(int dim, double tag) {
    std::vector<Entity>& entities = entities_of(mesh_, dim);
    const int number = std::max(1, static_cast<int>(tag));
    const auto [it, is_new] = index_.emplace(std::pair{dim, number}, static_cast<int>(entities.size()));
    if (is_new) entities.push_back({number, {}});
    return it->second;
  }

  /// "curve NAME", "region NAME", "face NAME" or "volume NAME": the tags of those that have it. "point NAME":
  /// their numbers, from 0.
  void read_names(const Tree& data) {
    for (const auto& [tag, array] : data) {
      if (tag != "DataArray") continue;
      const std::string title = attribute(array, "Name");
      if (const std::string kind = "point "; title.starts_with(kind))
        for (const double number : read_array(array)) name_point(number, title.substr(kind.size()));
      for (const auto& [kind, dim] : {std::pair{"curve ", 1}, std::pair{"region ", 2}, std::pair{"face ", 2},
                                      std::pair{"volume ", 3}}) {
        if (!title.starts_with(kind)) continue;
        const std::string name = title.substr(std::string_view(kind).size());
        for (const double number : read_array(array)) {
          const auto found = index_.find({dim, as_int(number)});
          if (found == index_.end()) continue;
          entities_of(mesh_, dim)[found->second].names.push_back(name);
        }
      }
    }
  }

  void name_point(double number, const std::string& name) {
    if (!(number >= 0 && number < static_cast<double>(mesh_.points.size()) && number == std::floor(number)))
      fail("the name {} is for point {}: there are {}, counted from 0", shown(name), number,
           mesh_.points.size());
    point_names_.add(mesh_, static_cast<int>(number), name);
  }

  std::string path_;
  TextScanner in_;
  Tree tree_;
  std::string appended_;
  bool has_appended_ = false, raw_ = true, swapped_ = false, wide_header_ = false, packed_ = false;
  Mesh mesh_;
  std::map<std::pair<int, int>, int> index_;  // by dimension and tag
  NamedPoints point_names_;
  const FieldChoice* choice_ = nullptr;                                  // of fields; null: none are read
  std::vector<MeshField> fields_;                                        // without the values of cells
  std::vector<std::array<std::vector<double>, kCellShapes>> of_shapes_;  // which these are
  ReadNotes* notes_;
  bool has_curved_cells_ = false;
  size_t n_points_ = 0;  // of the file
};

}  // namespace

Mesh read_vtu(const std::filesystem::path& path, ReadNotes* notes) { return VtuReader(path, notes).read(); }

MeshWithFields read_vtu_fields(const std::filesystem::path& path, const FieldChoice& choice) {
  return VtuReader(path).read_fields(choice);
}

}  // namespace delquad
