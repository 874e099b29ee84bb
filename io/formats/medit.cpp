// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <climits>

#include "geometry/mesh/drop_unused_points.h"
#include "io/cell_view.h"
#include "io/face_reader.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

class MeditReader {
 public:
  explicit MeditReader(const std::filesystem::path& path) : in_(path) {}

  /// Whose files often have the same extension.
  bool is_mfem() const { return content_kind(in_.text()) == kMfemFile; }

  Mesh read() {
    refuse_other_kinds(in_, "Medit");
    if (word("MeshVersionFormatted") != "MeshVersionFormatted")
      in_.fail("not a Medit file: expected MeshVersionFormatted");
    in_.integer("the version", 0, 4);
    while (true) {
      skip_comments();
      if (in_.at_end()) break;
      const std::string keyword = word("a keyword");
      if (keyword == "End") break;
      section(keyword);
    }
    if (mesh_.lines.empty() && mesh_.triangles.empty() && mesh_.quads.empty())
      in_.fail("the file holds no edges, triangles or quadrilaterals");
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  void section(const std::string& keyword) {
    if (keyword == "Dimension") {
      skip_comments();
      dimension_ = in_.integer("the dimension", 2, 3);
    } else if (keyword == "Vertices") {
      for (long long n = count(keyword); n > 0; --n) vertex();
    } else if (const int corners = keyword == "Edges"            ? 2
                                   : keyword == "Triangles"      ? 3
                                   : keyword == "Quadrilaterals" ? 4
                                                                 : 0;
               corners > 0) {
      elements(keyword, corners);
    } else if (!(keyword[0] >= 'A' && keyword[0] <= 'Z')) {
      in_.fail("expected a keyword{}, found {}", section_, TextScanner::printable(keyword));
    } else if (keyword == "Tetrahedra" || keyword == "Hexahedra") {
      in_.fail("{}: expected a mesh of lines, triangles and quadrilaterals", keyword);
    } else {
      skip_section();
    }
  }

  /// Numbers up to the next keyword.
  void skip_section() {
    while (!in_.at_end() && !next_is_letter()) {
      if (in_.next_is('#'))
        take_name();
      else
        in_.token("a number");
    }
  }

  bool next_is_letter() {
    for (char c = 'A'; c <= 'Z'; ++c)
      if (in_.next_is(c)) return true;
    return false;
  }

  /// Comments may be names: "# curve 3: north".
  void skip_comments() {
    while (in_.next_is('#')) take_name();
  }

  void take_name() {
    const std::string_view line = in_.rest_of_line();
    if (!entities_.take_name(line, "# curve ", ": ", 1)) entities_.take_name(line, "# region ", ": ", 2);
  }

  std::string word(std::string_view what) {
    skip_comments();
    return std::string(in_.token(what));
  }

  long long count(const std::string& keyword) {
    skip_comments();
    const long long n = in_.integer("a count", 0, INT_MAX);
    section_ = fmt::format(" after the {} {} that are announced", n, keyword);
    if (n > static_cast<long long>(in_.bytes_left()))
      in_.fail("{} items do not fit in the {} bytes that follow", n, in_.bytes_left());
    return n;
  }

  void vertex() {
    skip_comments();
    const double x = in_.real("a coordinate"), y = in_.real("a coordinate");
    const double z = dimension_ == 3 ? in_.real("a coordinate") : 0;
    reference();
    mesh_.points.push_back({x, y, z});
  }

  long long reference() {
    constexpr long long kLargestNumber = NumberedEntities::kMostNumber;
    return in_.integer("a reference", -kLargestNumber, kLargestNumber);
  }

  void elements(const std::string& keyword, int corners) {
    std::vector<int> v(static_cast<size_t>(corners));
    for (long long n = count(keyword); n > 0; --n) {
      skip_comments();
      for (int& i : v)
        i = static_cast<int>(in_.integer("a vertex", 1, static_cast<long long>(mesh_.points.size()))) - 1;
      add_element(mesh_, corners, v, entities_.index(corners == 2 ? 1 : 2, reference(), mesh_));
    }
  }

  TextScanner in_;
  Mesh mesh_;
  long long dimension_ = 3;
  std::string section_;  ///< the last one, for messages
  NumberedEntities entities_;
};

void write_names(TextWriter& out, const char* kind, const std::vector<Entity>& entities) {
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names)
      out << "# " << kind << ' ' << entity.tag << ": " << one_line(name) << '\n';
}

/// Medit text (version 2): the references are tags of curves and regions; names stand in comments.
void write_medit(const std::filesystem::path& path, const Mesh& mesh) {
  using enum CellShape;
  constexpr CellCode<const char*> kKeywords[] = {
      {kLine, 2, "Edges"}, {kTriangle, 3, "Triangles"}, {kQuad, 4, "Quadrilaterals"}};
  write_text_file(path, [&](TextWriter& out) {
    out << "MeshVersionFormatted 2\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    write_names(out, "curve", mesh.curves);
    write_names(out, "region", mesh.regions);
    out << "Dimension\n3\nVertices\n" << mesh.points.size() << '\n';
    for (const Vec3& p : mesh.points) out << p.x << ' ' << p.y << ' ' << p.z << " 0\n";
    for (const CellBlock& cells : cell_blocks(mesh)) {
      out << code_of(cells, kKeywords) << '\n' << cells.size() << '\n';
      for (size_t i = 0; i < cells.size(); ++i) {
        for (const int v : cells.nodes(i)) out << v + 1 << ' ';
        out << cells.entity(i).tag << '\n';
      }
    }
    out << "End\n";
  });
}

}  // namespace

Mesh read_medit(const std::filesystem::path& path) {
  MeditReader reader(path);
  return reader.is_mfem() ? read_mfem(path) : reader.read();
}

MeshFormat medit_format() {
  return {.extensions = {".mesh"},
          .description = "Medit",
          .read = read_by<read_medit>,
          .write = write_by<write_medit>,
          .names = (kAllNames & ~kPointNames) | kFurtherNames};
}

}  // namespace delquad
