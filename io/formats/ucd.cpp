#include <fmt/format.h>

#include <climits>
#include <unordered_map>

#include "geometry/mesh/drop_unused_points.h"
#include "io/entity_names.h"
#include "io/face_reader.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

class UcdReader {
 public:
  explicit UcdReader(const std::filesystem::path& path) : in_(path) { refuse_other_kinds(in_, "UCD"); }

  Mesh read() {
    skip_comments();
    const long long n_points = in_.count("the number of nodes"), n_cells = in_.count("the number of cells");
    long long n_values = 0;
    for (const char* what : {"nodes", "cells", "the model"})
      n_values += in_.integer(fmt::format("the number of values of {}", what), 0, INT_MAX);
    for (long long i = 0; i < n_points; ++i) node();
    for (long long i = 0; i < n_cells; ++i) cell();
    if (mesh_.lines.empty() && mesh_.triangles.empty() && mesh_.quads.empty())
      in_.fail("the file holds no lines, triangles or quads");
    // Values follow, where they are announced, which are no part of the mesh.
    skip_comments();
    if (n_values == 0 && !in_.at_end())
      in_.fail("expected the end of the file after {} nodes and {} cells, as the header says, found {}",
               n_points, n_cells, TextScanner::printable(in_.token("the end")));
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  void skip_comments() {
    while (in_.next_is('#')) {
      const std::string_view line = in_.rest_of_line();
      if (!entities_.take_name(line, "# material ", ": ", 2))
        entities_.take_name(line, "# material ", " of lines: ", 1);
      if (const std::string unit = unit_in_comment(line, "#"); !unit.empty()) mesh_.unit = unit;
    }
  }

  void node() {
    const long long number = in_.integer("a node's number", 0, LLONG_MAX);
    if (!node_of_.emplace(number, static_cast<int>(mesh_.points.size())).second)
      in_.fail("node {} is there twice", number);
    const double x = in_.real("a coordinate"), y = in_.real("a coordinate"), z = in_.real("a coordinate");
    mesh_.points.push_back({x, y, z});
  }

  void cell() {
    constexpr long long kLargestNumber = NumberedEntities::kMostNumber;
    in_.integer("a cell's number", 0, LLONG_MAX);
    const long long material = in_.integer("a material", -kLargestNumber, kLargestNumber);
    const std::string_view type = in_.token("a type of cell");
    static const std::map<std::string_view, int> corners = {{"pt", 1}, {"line", 2}, {"tri", 3}, {"quad", 4}};
    const auto known = corners.find(type);
    if (known == corners.end())
      in_.fail("a cell of type {}: expected pt, line, tri or quad", TextScanner::printable(type));
    std::vector<int> v;
    for (int k = 0; k < known->second; ++k) {
      const long long number = in_.integer("a node's number", 0, LLONG_MAX);
      const auto found = node_of_.find(number);
      if (found == node_of_.end()) in_.fail("there is no node {}", number);
      v.push_back(found->second);
    }
    const int n = known->second;
    if (n > 1) add_element(mesh_, n, v, entities_.index(n == 2 ? 1 : 2, material, mesh_));
  }

  TextScanner in_;
  Mesh mesh_;
  NumberedEntities entities_;
  std::unordered_map<long long, int> node_of_;
};

/// Unstructured cell data of AVS, as deal.II reads it, too: the material of a cell is the number of its name,
/// which comments tell.
void write_ucd(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::size_t n_elements = mesh.triangles.size() + mesh.quads.size();
  const std::vector<int> of_lines = group_numbers(groups, 1, mesh.lines.size());
  const std::vector<int> of_elements = group_numbers(groups, 2, n_elements);
  std::size_t n_lines = 0;
  for (const int g : of_lines) n_lines += g > 0;
  write_text_file(path, [&](TextWriter& out) {
    out << "# quad mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    for (const MeshGroup& group : groups)
      if (group.dim > 0)
        out << "# material " << group.number << (group.dim == 1 ? " of lines: " : ": ")
            << one_line(group.name) << '\n';
    out << mesh.points.size() << ' ' << n_lines + n_elements << " 0 0 0\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3& p = mesh.points[i];
      out << i + 1 << ' ' << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    int n = 0;
    const auto write = [&](int material, const char* type, const auto& nodes) {
      out << ++n << ' ' << material << ' ' << type;
      for (const int v : nodes) out << ' ' << v + 1;
      out << '\n';
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) write(of_elements[t], "tri", mesh.triangles[t]);
    for (std::size_t q = 0; q < mesh.quads.size(); ++q)
      write(of_elements[mesh.triangles.size() + q], "quad", mesh.quads[q]);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      if (of_lines[l] > 0) write(of_lines[l], "line", mesh.lines[l]);
  });
}

}  // namespace

Mesh read_ucd(const std::filesystem::path& path) { return UcdReader(path).read(); }

MeshFormat ucd_format() {
  return {.extensions = {".ucd", ".avs"},
          .description = "AVS unstructured cell data: deal.II",
          .read = read_by<read_ucd>,
          .write = write_by<write_ucd>,
          .names = kAllNames & ~kPointNames};
}

}  // namespace delquad
