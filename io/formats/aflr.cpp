// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "io/cell_view.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

constexpr UniqueLabels::Rules kAflrLabels{word_label, false, 70};

/// Numbers as text, or as bytes in the order of `.b8.ugrid`, the greatest first.
class AflrNumbers {
 public:
  AflrNumbers(TextWriter& out, bool are_bytes) : out_(out), are_bytes_(are_bytes) {}

  template <class Number>
  AflrNumbers& operator<<(Number number) {
    if (!are_bytes_) {
      out_ << number << ' ';
      return *this;
    }
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    if (std::endian::native == std::endian::little) std::ranges::reverse(bytes);
    out_ << std::string_view(bytes, sizeof number);
    return *this;
  }
  void end_line() {
    if (!are_bytes_) out_ << '\n';
  }

 private:
  TextWriter& out_;
  bool are_bytes_;
};

/// Writes nodes, faces on the boundary with the numbers of their groups, and cells; names go to a .mapbc file
/// beside it. Faces look inwards, as FUN3D wants them.
void write_aflr(const std::filesystem::path& path, const Mesh& mesh) {
  using enum CellShape;
  constexpr CellCode<int> kOrders[] = {{kTriangle, 3, 0, "021"},     {kQuad, 4, 0, "0321"},
                                       {kTetrahedron, 4, 0, "0123"}, {kPyramid, 5, 0, "10423"},
                                       {kPrism, 6, 0, "012345"},     {kHexahedron, 8, 0, "01234567"}};
  const CellSides sides(mesh);
  std::vector<MeshGroup> groups = mesh_groups(mesh, kAflrLabels);
  std::erase_if(groups, [](const MeshGroup& group) { return group.dim != 2; });
  const std::vector<int> group_of = group_numbers(mesh, groups, 2);
  std::array<std::vector<std::vector<int>>, kCellShapes> elements;
  std::array<std::vector<int>, kCellShapes> numbers;
  for (const CellBlock& cells : cell_blocks(mesh))
    for (std::size_t i = 0; i < cells.size() && cells.dim > 1; ++i) {
      const std::size_t at = cells.first + i;
      if (cells.dim == 2 && sides.at(static_cast<int>(at)).size() != 1) continue;
      elements[static_cast<std::size_t>(cells.shape)].push_back(nodes_of(cells, i, kOrders));
      if (cells.dim == 2) numbers[static_cast<std::size_t>(cells.shape)].push_back(group_of[at]);
    }
  const auto write = [&](TextWriter& text) {
    AflrNumbers out(text, path.stem().extension() == ".b8");
    out << static_cast<std::int32_t>(mesh.points.size());
    for (const auto& [shape, n, code, order] : kOrders)
      out << static_cast<std::int32_t>(elements[static_cast<std::size_t>(shape)].size());
    out.end_line();
    for (const Vec3& p : mesh.points) (out << p.x << p.y << p.z).end_line();
    for (const auto& [shape, n, code, order] : kOrders) {
      if (shape == kTetrahedron)  // numbers stand between faces and cells
        for (const CellShape face : {kTriangle, kQuad})
          for (const int number : numbers[static_cast<std::size_t>(face)]) (out << number).end_line();
      for (const std::vector<int>& nodes : elements[static_cast<std::size_t>(shape)]) {
        for (const int v : nodes) out << v + 1;
        out.end_line();
      }
    }
  };
  const auto write_names = [&](TextWriter& out) {
    out << groups.size() << '\n';
    for (const MeshGroup& group : groups) out << group.number << " 0 " << group.label << '\n';
  };
  write_files_atomically({{std::filesystem::path(path).replace_extension(".mapbc"), as_text(write_names)},
                          {path, as_text(write)}});
}

}  // namespace

MeshFormat aflr_format() {
  return {.extensions = {".ugrid"},
          .description = "UGRID of AFLR: FUN3D; .b8.ugrid in bytes",
          .write = write_by<write_aflr>,
          .has_faces = false,
          .has_cells = true,
          .labels = &kAflrLabels,
          .names = kBoundaryNames};
}

}  // namespace delquad
