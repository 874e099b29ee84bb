// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <vector>

#include "io/cell_view.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

/// Names have at most 40 characters.
constexpr UniqueLabels::Rules kUnvLabels{word_label, false, 30};

/// A file that is being written: nodes, elements and groups, each a dataset of lines of fixed width.
class UnvWriter {
 public:
  UnvWriter(TextWriter& out, const std::vector<MeshGroup>& groups) : out_(out), groups_(groups) {}

  void write_nodes(const std::vector<Vec3>& points) {
    begin(2411);
    for (std::size_t i = 0; i < points.size(); ++i)
      out_ << fmt::format("{:>10}{:>10}{:>10}{:>10}\n{:>25.16E}{:>25.16E}{:>25.16E}\n", i + 1, 1, 1, 11,
                          points[i].x, points[i].y, points[i].z);
    end();
    begin(2412);
  }

  void write_elements(const CellBlock& cells, const std::vector<int>& property) {
    using enum CellShape;
    constexpr CellCode<int> kTypes[] = {{kLine, 2, 11},        {kTriangle, 3, 91}, {kQuad, 4, 94},
                                        {kHexahedron, 8, 115}, {kPrism, 6, 112},   {kTetrahedron, 4, 111}};
    if (cells.first == 0) first_[cells.dim] = n_;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      write_numbers({static_cast<int>(++n_), code_of(cells, kTypes), property[cells.first + i], 1, 7,
                     static_cast<int>(cells.n_nodes)});
      if (cells.shape == kLine) write_numbers({0, 1, 1});
      std::vector<int> nodes = cells.nodes(i);
      for (int& v : nodes) ++v;
      write_numbers(nodes);
    }
  }

  void write_groups() {
    end();
    begin(2467);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const MeshGroup& group = groups_[g];
      write_numbers({static_cast<int>(g) + 1, 0, 0, 0, 0, 0, 0, static_cast<int>(group.items.size())});
      out_ << group.label << '\n';
      std::vector<int> entities;
      for (const int i : group.items)
        entities.insert(entities.end(),
                        {group.dim == 0 ? 7 : 8, static_cast<int>(first_[group.dim]) + i + 1, 0, 0});
      write_numbers(entities);
    }
    end();
  }

 private:
  void begin(int dataset) { out_ << fmt::format("    -1\n{:>6}\n", dataset); }
  void end() { out_ << "    -1\n"; }

  void write_numbers(const std::vector<int>& numbers) {
    constexpr std::size_t kPerLine = 8;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      out_ << fmt::format("{:>10}", numbers[i])
           << (i + 1 == numbers.size() || i % kPerLine == kPerLine - 1 ? "\n" : "");
  }

  TextWriter& out_;
  const std::vector<MeshGroup>& groups_;
  std::size_t n_ = 0;  ///< elements so far
  std::array<std::size_t, 4>
      first_{};  ///< elements before the elements of a dimension; nodes have numbers of their own
};

/// I-DEAS universal: thin shells or solids, a group for each name.
void write_unv(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, kUnvLabels);
  write_text_file(path, [&](TextWriter& text) {
    UnvWriter out(text, groups);
    out.write_nodes(mesh.points);
    const std::vector<CellBlock> blocks = cell_blocks(mesh);
    for (const int dim : {3, 2, 1})
      for (const CellBlock& cells : blocks)
        if (cells.dim == dim) out.write_elements(cells, group_numbers(mesh, groups, dim));
    out.write_groups();
  });
}

}  // namespace

MeshFormat unv_format() {
  return {.extensions = {".unv"},
          .description = "I-DEAS universal: Salome, Elmer, OpenFOAM",
          .write = write_by<write_unv>,
          .has_cells = true,
          .has_pyramids = false,
          .labels = &kUnvLabels};
}

}  // namespace delquad
