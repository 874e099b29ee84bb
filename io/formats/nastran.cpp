#include <algorithm>
#include <charconv>

#include "geometry/mesh/element_nodes.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_groups.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

constexpr std::size_t kSmallField = 8, kLargeField = 16;

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

/// Nastran's bulk data: CQUAD4, CQUAD8 and CTRIA3, a property for each name of regions, SETs of the nodes of
/// curves and points; comments tell the names.
void write_nastran(const std::filesystem::path& path, const Mesh& mesh) {
  require_numbers(path, "Nastran", mesh, 99'999'999);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<int> property = group_numbers(groups, 2, mesh.triangles.size() + mesh.quads.size());
  std::vector<char> inside(mesh.points.size(), 0);
  for (std::size_t q = 0; q < mesh.quads.size() && mesh.order == 2; ++q)
    inside[nodes_of_quad(mesh, q)[4]] = 1;
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    out << "$ quad mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "$ lengths in " << mesh.unit << '\n';
    std::size_t set = 0;
    for (const MeshGroup& group : groups) {
      if (group.dim == 2) {
        out << "$ property " << group.number << ": " << one_line(group.name) << '\n';
        continue;
      }
      out << "$ set " << ++set << ", nodes of " << (group.dim == 0 ? "point " : "curve ")
          << one_line(group.name) << '\n';
      write_set(out, set, nodes_of_group(mesh, group));
    }
    out << "BEGIN BULK\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      if (inside[i]) continue;
      const Vec3& p = mesh.points[i];
      std::string id = std::to_string(i + 1);
      out << "GRID*   " << id << std::string(kLargeField - id.size(), ' ') << std::string(kLargeField, ' ')
          << real(p.x) << real(p.y) << "\n*       " << real(p.z) << '\n';
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
    out.flush();
  });
}

}  // namespace

MeshFormat nastran_format() {
  return {.extensions = {".bdf", ".nas"},
          .description = "Nastran bulk data",
          .read = read_by<read_nastran>,
          .write = write_by<write_nastran>,
          .most_order = 2,
          .eight_nodes = EightNodes::kAlways};
}

}  // namespace delquad
