// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <vector>

#include "io/cell_view.h"
#include "io/library_file.h"
#include "io/library_format.h"

#include <exodusII.h>

namespace delquad {

namespace {

constexpr int kExodusNameLength = 80;

/// A file that is being written.
class ExodusFile {
 public:
  ExodusFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    int real_in_memory = sizeof(double), real_in_file = sizeof(double);
    ex_opts(0);  // errors are told by what is returned
    file_.id = ex_create(temporary.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &real_in_memory, &real_in_file);
    check(file_ >= 0, "the file");
    ex_set_max_name_length(file_, kExodusNameLength);
  }

  void put_head(const char* title, int dim, const std::vector<Vec3>& points, std::size_t n_elements,
                std::size_t n_blocks, int64_t n_node_sets, int64_t n_side_sets) {
    check(
        ex_put_init(file_, title, dim, static_cast<int64_t>(points.size()), static_cast<int64_t>(n_elements),
                    static_cast<int64_t>(n_blocks), n_node_sets, n_side_sets) >= 0,
        "the header");
    std::vector<double> x, y, z;
    for (const Vec3& p : points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    check(ex_put_coord(file_, x.data(), y.data(), dim == 2 ? nullptr : z.data()) >= 0, "coordinates");
  }

  /// `nodes`: of all its elements, from 1.
  void put_block(const std::string& name, const char* type, std::size_t nodes_each,
                 const std::vector<int>& nodes) {
    block_names_.push_back(name);
    const auto id = static_cast<ex_entity_id>(block_names_.size());
    check(ex_put_block(file_, EX_ELEM_BLOCK, id, type, static_cast<int64_t>(nodes.size() / nodes_each),
                       static_cast<int64_t>(nodes_each), 0, 0, 0) >= 0,
          "a block");
    check(ex_put_conn(file_, EX_ELEM_BLOCK, id, nodes.data(), nullptr, nullptr) >= 0, "elements");
  }

  /// `nodes`: from 0.
  void put_node_set(const std::string& name, std::vector<int> nodes) {
    for (int& v : nodes) ++v;
    put_set(EX_NODE_SET, name, nodes, {}, node_sets_);
  }
  void put_side_set(const std::string& name, const std::vector<int>& elements,
                    const std::vector<int>& sides) {
    put_set(EX_SIDE_SET, name, elements, sides, side_sets_);
  }

  void close() {
    put_names(EX_ELEM_BLOCK, block_names_);
    put_names(EX_NODE_SET, node_sets_);
    put_names(EX_SIDE_SET, side_sets_);
    check(file_.close_now() >= 0, "the end of the file");
  }

 private:
  void check(bool done, const char* what) const {
    if (exerrval > 0) errno = exerrval;  // NetCDF's codes are negative, the system's positive
    require_written(done, path_, "the Exodus library", what);
  }

  void put_set(ex_entity_type type, const std::string& name, const std::vector<int>& entries,
               const std::vector<int>& extra, std::vector<std::string>& names) {
    names.push_back(name);
    const auto id = static_cast<ex_entity_id>(names.size());
    check(ex_put_set_param(file_, type, id, static_cast<int64_t>(entries.size()), 0) >= 0, "a set");
    check(ex_put_set(file_, type, id, entries.data(), extra.empty() ? nullptr : extra.data()) >= 0, "a set");
  }

  void put_names(ex_entity_type type, std::vector<std::string>& names) {
    if (names.empty()) return;
    std::vector<char*> texts;
    for (std::string& name : names) texts.push_back(name.data());
    check(ex_put_names(file_, type, texts.data()) >= 0, "names");
  }

  const std::filesystem::path& path_;
  OpenFile<int, ex_close> file_;
  std::vector<std::string> block_names_, node_sets_, side_sets_;
};

/// The elements of one name in a block of cells.
struct ExodusBlock {
  std::string name;
  const CellBlock* cells;
  std::vector<std::size_t> items;
};

class ExodusWriter {
 public:
  ExodusWriter(ExodusFile& file, const Mesh& mesh)
      : file_(file),
        mesh_(mesh),
        dim_(dimension_of(mesh)),
        groups_(mesh_groups(mesh, kExodusLabels)),
        cells_(cell_blocks(mesh)),
        number_of_(n_cells(mesh, dim_)) {}

  void write() {
    make_blocks();
    const auto n_sets = [&](int most) {
      return std::ranges::count_if(groups_, [&](const MeshGroup& g) { return g.dim <= most; });
    };
    file_.put_head(dim_ == 3 ? "Mesh of hexahedra by Delquad" : "Quad mesh by Delquad",
                   dim_ == 2 && is_planar(mesh_) ? 2 : 3, mesh_.points, number_of_.size(), blocks_.size(),
                   n_sets(dim_ - 1), n_sets(dim_ - 1) - n_sets(dim_ - 2));
    write_blocks();
    write_sets();
    file_.close();
  }

 private:
  void make_blocks() {
    int n = 0;
    for (const MeshGroup& group : groups_)
      for (const CellBlock& cells : cells_) {
        if (group.dim != dim_) continue;
        ExodusBlock block{group.label, &cells, items_in_block(group, cells)};
        if (block.items.empty()) continue;
        if (!blocks_.empty() && blocks_.back().name == block.name) block.name += "_quads";
        for (const std::size_t i : block.items) number_of_[cells.first + i] = ++n;
        blocks_.push_back(std::move(block));
      }
  }

  void write_blocks() {
    using enum CellShape;
    constexpr CellCode<const char*> kTypes[] = {
        {kTriangle, 3, "TRI3"}, {kQuad, 4, "QUAD4"}, {kQuad, 9, "QUAD9"}, {kHexahedron, 8, "HEX8"}};
    for (const ExodusBlock& block : blocks_) {
      std::vector<int> nodes;
      for (const std::size_t i : block.items)
        for (const int v : block.cells->nodes(i)) nodes.push_back(v + 1);
      file_.put_block(block.name, code_of(*block.cells, kTypes), block.cells->n_nodes, nodes);
    }
  }

  /// Node sets of all below the highest dimension, side sets of those next to it.
  void write_sets() {
    constexpr std::array kSideOf = {5, 6, 1, 2, 3, 4};  // of Abaqus's S1, S2, ...
    const CellSides sides(mesh_);
    for (const MeshGroup& group : groups_) {
      if (group.dim == dim_) continue;
      file_.put_node_set(group.label, nodes_of_group(mesh_, group));
      if (group.dim < dim_ - 1) continue;
      std::vector<int> elements, which;
      for (const int i : group.items)
        for (const auto& [element, side] : sides.at(i)) {
          elements.push_back(number_of_[element]);
          which.push_back(dim_ == 3 ? kSideOf[side] : side + 1);
        }
      file_.put_side_set(group.label, elements, which);
    }
  }

  ExodusFile& file_;
  const Mesh& mesh_;
  const int dim_;  ///< of the elements
  const std::vector<MeshGroup> groups_;
  const std::vector<CellBlock> cells_;
  std::vector<ExodusBlock> blocks_ = {};
  std::vector<int> number_of_;  ///< in the file, of each element
};

/// Exodus II: a block for each name of the highest dimension, node and side sets of others.
void write_exodus(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    ExodusFile file(path, temporary);
    ExodusWriter(file, mesh).write();
  });
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {nullptr, delquad::write_exodus};
