// SPDX-License-Identifier: GPL-3.0-or-later

#include <map>

#include "io/cell_view.h"
#include "io/face_reader.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

class ObjReader : FaceReader {
 public:
  ObjReader(const std::filesystem::path& path, Strays strays) : FaceReader(path, "OBJ", strays) {
    in_.join_continued_lines();
  }

  Mesh read(ReadNotes* notes) {
    while (!in_.at_end()) {
      const std::string keyword(in_.token("a keyword"));
      if (keyword == "v") {
        read_point();
      } else if (keyword == "l") {
        read_line();
      } else if (keyword == "f") {
        read_face();
      } else if (keyword == "g") {
        names_.clear();
        while (!in_.at_end_of_line()) names_.emplace_back(in_.token("a group's name"));
      }
      in_.rest_of_line();
    }
    if (mesh_.lines.empty() && mesh_.triangles.empty() && mesh_.quads.empty()) {
      in_.fail("the file holds no lines and no faces");
    }
    return finished(notes);
  }

 private:
  /// Whether the numbers on the line end.
  bool ends() { return in_.at_end_of_line() || in_.next_is('#'); }

  /// In a file of the plane all points have two coordinates; a lone one that has may have lost its third.
  void read_point() {
    const double x = coordinate(), y = coordinate();
    const bool is_planar = ends();
    if (mesh_.points.empty()) is_planar_ = is_planar;
    if (is_planar != is_planar_)
      in_.fail("expected {} coordinates, as the points before have", is_planar_ ? "two" : "three");
    const double z = is_planar ? 0 : coordinate();
    add_point({x, y, z});
  }

  /// The vertices on the rest of the line, each "v", "v/vt" or "v/vt/vn"; a negative v counts from the last
  /// one.
  std::vector<int> vertices() {
    std::vector<int> result;
    const long long n = static_cast<long long>(mesh_.points.size());
    while (!ends()) {
      const std::string_view token = in_.token("a vertex");
      long long v = 0;
      const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), v);
      const bool is_number = error == std::errc() && (end == token.data() + token.size() || *end == '/');
      if (!is_number || v == 0 || v > n || v < -n) {
        in_.fail("expected a vertex from 1 to {}, found {}", n, TextScanner::printable(token));
      }
      result.push_back(static_cast<int>(v > 0 ? v - 1 : n + v));
    }
    return result;
  }

  void read_line() {
    const std::vector<int> v = vertices();
    if (v.size() < 2) in_.fail("expected two vertices or more");
    const int curve = entity(mesh_.curves, curve_of_);
    for (size_t k = 0; k + 1 < v.size(); ++k) {
      mesh_.lines.push_back({v[k], v[k + 1]});
      mesh_.line_curve.push_back(curve);
    }
  }

  void read_face() {
    const std::vector<int> v = vertices();
    const int region = entity(mesh_.regions, region_of_);
    add_face(v, region);
  }

  using Index = std::map<std::vector<std::string>, int>;
  int entity(std::vector<Entity>& entities, Index& index) const {
    const auto [it, is_new] = index.emplace(names_, static_cast<int>(entities.size()));
    if (is_new) entities.push_back({it->second + 1, names_});
    return it->second;
  }

  bool is_planar_ = false;
  std::vector<std::string> names_;
  Index curve_of_, region_of_;
};

/// Groups are separated by white space.
std::string without_blanks(const std::string& name) {
  std::string label = name.empty() ? "_" : name;
  for (char& c : label)
    if (c == ' ' || (c >= '\t' && c <= '\r')) c = '_';
  return label;
}

/// A group of lines and one of faces may have the same name.
UniqueLabels label_groups(const Mesh& mesh) {
  std::vector<UniqueLabels::Key> keys;
  for (const auto* entities : {&mesh.curves, &mesh.regions})
    for (const Entity& entity : *entities)
      for (const std::string& name : entity.names) keys.emplace_back(0, name);
  constexpr size_t kLongestLabel = 200;  // lines of more than 256 characters are too long for some programs
  return UniqueLabels(keys, {without_blanks, false, kLongestLabel});
}

void write_group(TextWriter& out, const Entity& entity, const UniqueLabels& labels) {
  out << 'g';
  for (const std::string& name : entity.names) out << ' ' << labels.of({0, name});
  out << '\n';
}

/// Reads Wavefront OBJ: v, l, f; g names the region of the faces and the curve of the lines after it. Faces
/// of more than four vertices are split into triangles. In a file of the plane all points have two
/// coordinates.
Mesh read_obj(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  return ObjReader(path, strays).read(notes);
}

/// Wavefront OBJ; names of curves and regions become groups, their white space underscores; names that would
/// be one then get numbers, and comments say so.
void write_obj(const std::filesystem::path& path, const Mesh& mesh) {
  write_text_file(path, [&](TextWriter& out) {
    const UniqueLabels labels = label_groups(mesh);
    for (const auto& [key, label] : labels.renamed())
      out << "# group " << label << " is \"" << one_line(key.second) << "\"\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    for (const Vec3& p : mesh.points) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (const CellBlock& cells : cell_blocks(mesh))
      for (size_t i = 0; i < cells.size(); ++i) {
        const std::vector<int>& entity_of = *cells.entity_of;
        if (i == 0 || entity_of[i] != entity_of[i - 1]) write_group(out, cells.entity(i), labels);
        out << (cells.dim == 1 ? 'l' : 'f');
        for (const int v : cells.nodes(i)) out << ' ' << v + 1;
        out << '\n';
      }
  });
}

}  // namespace

MeshFormat obj_format() {
  return {.extensions = {".obj"},
          .description = "Wavefront",
          .read = read_obj,
          .write = write_by<write_obj>,
          .names = (kAllNames & ~kPointNames) | kFurtherNames};
}

}  // namespace delquad
