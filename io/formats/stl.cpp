// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/mesh/weld.h"
#include "io/face_reader.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

constexpr size_t kHeader = 80, kFirstFacet = kHeader + 4, kFacet = 50;  // bytes of a binary file

/// Whether the words are the same but for capitals.
bool same_word(std::string_view a, std::string_view b) { return upper(a) == upper(b); }

std::uint32_t little_endian(std::string_view bytes, size_t at) {
  std::uint32_t value = 0;
  for (size_t k = 0; k < 4; ++k) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + k])} << (8 * k);
  }
  return value;
}

/// Triangles that the binary file announces; none when it is a text. A binary header may begin with "solid"
/// too.
std::optional<std::uint32_t> binary_facets(std::string_view bytes) {
  if (bytes.size() >= kFirstFacet) {
    const std::uint32_t n = little_endian(bytes, kHeader);
    if (bytes.size() == kFirstFacet + n * kFacet) return n;
  }
  const size_t word = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  const std::string_view begin = bytes.substr(word);
  const bool is_text =
      (same_word(begin.substr(0, 5), "solid") || begin.starts_with('#') || begin.starts_with("//")) &&
      bytes.substr(0, kFirstFacet).find('\0') == std::string_view::npos;
  if (is_text) return std::nullopt;
  return bytes.size() < kFirstFacet ? 0 : little_endian(bytes, kHeader);
}

void add_triangle(Mesh& mesh, const std::array<Vec3, 3>& corners) {
  const int first = static_cast<int>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangle_region.push_back(static_cast<int>(mesh.regions.size()) - 1);
}

size_t byte_of(size_t facet, size_t number) {
  constexpr size_t kNormal = 12;
  return kFirstFacet + facet * kFacet + kNormal + 4 * number;
}

Mesh read_binary(const TextScanner& in, const std::string& path, std::uint32_t n, Strays strays) {
  const std::string_view bytes = in.text();
  if (bytes.size() < kFirstFacet) {
    refuse(
        "{}: {} bytes: expected an STL file, which begins with \"solid\" or has {} bytes before "
        "its triangles",
        path, bytes.size(), kFirstFacet);
  }
  const size_t expected = kFirstFacet + n * kFacet;
  if (bytes.size() != expected) {
    refuse("{}: {} bytes, but its {} triangles (byte {}) take {}: expected a whole STL file", path,
           bytes.size(), n, kHeader, expected);
  }
  Mesh mesh;
  mesh.regions = {{1, {}}};
  mesh.points.reserve(3 * size_t{n});
  for (size_t facet = 0; facet < n; ++facet) {
    const auto number = [&](size_t k) {
      const size_t byte = byte_of(facet, k);
      const float value = std::bit_cast<float>(little_endian(bytes, byte));
      if (strays == Strays::kRefused && !std::isfinite(value)) {
        refuse("{}: byte {}: coordinate {}: expected a finite number", path, byte, value);
      }
      return in.finite(double{value}, strays);
    };
    std::array<Vec3, 3> corners;
    for (size_t k = 0; k < 3; ++k) corners[k] = {number(3 * k), number(3 * k + 1), number(3 * k + 2)};
    add_triangle(mesh, corners);
  }
  return mesh;
}

/// Words in capitals or not, the words of an end in one or in two ("end solid"), lines of comments.
class TextReader {
 public:
  TextReader(TextScanner& in, Strays strays) : in_(in), strays_(strays) {}

  Mesh read() {
    for (in_.skip_comments(); !in_.at_end(); in_.skip_comments()) {
      expect("solid");
      const std::string name = rest_of_line();
      mesh_.regions.push_back({static_cast<int>(mesh_.regions.size()) + 1, {}});
      if (!name.empty()) mesh_.regions.back().names.push_back(name);
      while (read_facet()) continue;
      rest_of_line();
    }
    return std::move(mesh_);
  }

  /// Returns the line of the file for each corner.
  const std::vector<int>& lines() const { return lines_; }

 private:
  std::string next_word(std::string_view what) {
    in_.skip_comments();
    std::string word(in_.token(what));
    if (same_word(word, "end")) word += in_.token(what);
    return word;
  }

  void expect(std::string_view word) {
    const std::string found = next_word(fmt::format("'{}'", word));
    if (!same_word(found, word)) {
      in_.fail("expected '{}', found {}", word, TextScanner::printable(found));
    }
  }

  std::string rest_of_line() { return std::string(trimmed(in_.rest_of_line())); }

  /// False at the end of the solid.
  bool read_facet() {
    const std::string word = next_word("'facet' or 'endsolid'");
    if (same_word(word, "endsolid")) return false;
    if (!same_word(word, "facet")) {
      in_.fail("expected 'facet' or 'endsolid', found {}", TextScanner::printable(word));
    }
    expect("normal");
    for (int k = 0; k < 3; ++k) in_.token("a normal");  // some programs write nan; it is not needed
    expect("outer");
    expect("loop");
    std::array<Vec3, 3> corners;
    for (Vec3& p : corners) {
      expect("vertex");
      for (double* x : {&p.x, &p.y, &p.z}) *x = in_.real("a coordinate", strays_);
      lines_.push_back(in_.line());
    }
    expect("endloop");
    expect("endfacet");
    add_triangle(mesh_, corners);
    return true;
  }

  TextScanner& in_;
  Strays strays_;
  Mesh mesh_;
  std::vector<int> lines_;
};

/// Reads STL, text or binary, by content. Points with the same coordinates become one. Each solid of a text
/// file is a region with its name.
Mesh read_stl(const std::filesystem::path& path, ReadNotes*, Strays strays) {
  TextScanner scanner(path);
  const std::optional<std::uint32_t> n = binary_facets(scanner.text());
  const bool is_whole = n && scanner.text().size() == kFirstFacet + *n * kFacet;
  if (!is_whole) refuse_other_kinds(scanner, "STL");
  TextReader text(scanner, strays);
  Mesh mesh = n ? read_binary(scanner, path.string(), *n, strays) : text.read();
  if (mesh.triangles.empty())
    throw InputError(path.string() + ": the file holds no triangles: expected a surface");
  rename_points(mesh, names_of_equal_points(mesh));
  check_strays(mesh, strays, [&](int i) {
    const auto corner = static_cast<size_t>(i);
    return n ? fmt::format("{}: byte {}", path.string(), byte_of(corner / 3, 3 * (corner % 3)))
             : scanner.place(static_cast<size_t>(text.lines()[corner]));
  });
  drop_unused_points(mesh);
  return mesh;
}

/// Writes STL as text, a solid for each region, with the region's first name.
void write_stl(const std::filesystem::path& path, const Mesh& mesh) {
  std::vector<std::vector<std::size_t>> of_region(mesh.regions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) of_region[mesh.triangle_region[t]].push_back(t);
  write_text_file(path, [&](TextWriter& out) {
    const auto write = [&out](const char* word, const Vec3& x) {
      out << word << ' ' << x.x << ' ' << x.y << ' ' << x.z << '\n';
    };
    for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
      const Entity& region = mesh.regions[r];
      const std::string name =
          region.names.empty() ? fmt::format("region_{}", region.tag) : one_line(region.names[0]);
      out << "solid " << name << '\n';
      for (const std::size_t t : of_region[r]) {
        const Vec3 area = area_vector(mesh.points, mesh.triangles[t]);
        write("facet normal", norm(area) > 0 ? 1 / norm(area) * area : area);
        out << "outer loop\n";
        for (const int v : mesh.triangles[t]) write("vertex", mesh.points[v]);
        out << "endloop\nendfacet\n";
      }
      out << "endsolid " << name << '\n';
    }
  });
}

}  // namespace

MeshFormat stl_format() {
  return {.extensions = {".stl"},
          .description = "stereolithography, written as text",
          .read = read_stl,
          .write = write_by<write_stl>,
          .names = kRegionNames,
          .of_triangles = {".stl"}};
}

}  // namespace delquad
