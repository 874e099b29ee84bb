#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <vector>

#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/hex_sides.h"
#include "io/library_file.h"
#include "io/library_format.h"
#include "io/mesh_io.h"

#include <exodusII.h>

namespace delquad {

namespace {

constexpr int kExodusNameLength = 80;

/// Elements of one shape and name.
struct ExodusBlock {
  std::string name, type;
  std::vector<int> elements;
  std::size_t nodes_each;
};

/// A file that is being written.
class ExodusFile {
 public:
  ExodusFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    int real_in_memory = sizeof(double), real_in_file = sizeof(double);
    ex_opts(0);  // errors are told by what is returned
    file_ = ex_create(temporary.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &real_in_memory, &real_in_file);
    check(file_ >= 0, "the file");
    ex_set_max_name_length(file_, kExodusNameLength);
  }
  ~ExodusFile() {
    if (file_ >= 0) ex_close(file_);
  }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

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
    const int closed = ex_close(file_);
    file_ = -1;
    check(closed >= 0, "the end of the file");
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
  int file_ = -1;
  std::vector<std::string> block_names_, node_sets_, side_sets_;
};

class ExodusWriter {
 public:
  ExodusWriter(ExodusFile& file, const Mesh& mesh)
      : file_(file),
        mesh_(mesh),
        groups_(mesh_groups(mesh, kExodusLabels)),
        dim_(mesh.hexahedra.empty() ? 2 : 3) {}

  void write() {
    make_blocks();
    const auto n_sets = [&](int most) {
      return std::ranges::count_if(groups_, [&](const MeshGroup& g) { return g.dim <= most; });
    };
    file_.put_head(dim_ == 3 ? "Mesh of hexahedra by Delquad" : "Quad mesh by Delquad",
                   dim_ == 2 && is_planar(mesh_) ? 2 : 3, mesh_.points, number_of_.size(), blocks_.size(),
                   n_sets(dim_ - 1), n_sets(dim_ - 1) - n_sets(dim_ - 2));
    write_blocks();
    write_sets(sorted_half_edges(mesh_), sorted_hex_sides(mesh_));
    file_.close();
  }

 private:
  void make_blocks() {
    const int n_triangles = static_cast<int>(mesh_.triangles.size());
    for (const MeshGroup& group : groups_) {
      if (group.dim != dim_) continue;
      if (dim_ == 3) {
        blocks_.push_back({group.label, "HEX8", group.items, 8U});
        continue;
      }
      for (const bool triangles : {true, false}) {
        ExodusBlock block{group.label,
                          triangles          ? "TRI3"
                          : mesh_.order == 2 ? "QUAD9"
                                             : "QUAD4",
                          {},
                          triangles          ? 3U
                          : mesh_.order == 2 ? 9U
                                             : 4U};
        for (const int e : group.items)
          if ((e < n_triangles) == triangles) block.elements.push_back(e);
        if (block.elements.empty()) continue;
        if (!blocks_.empty() && blocks_.back().name == block.name) block.name += "_quads";
        blocks_.push_back(std::move(block));
      }
    }
    number_of_.resize(dim_ == 3 ? mesh_.hexahedra.size() : mesh_.triangles.size() + mesh_.quads.size());
    int n = 0;
    for (const ExodusBlock& block : blocks_)
      for (const int e : block.elements) number_of_[e] = ++n;
  }

  void write_blocks() {
    const std::vector<int> places = gmsh_places(mesh_.order);
    const auto n_triangles = mesh_.triangles.size();
    for (const ExodusBlock& block : blocks_) {
      std::vector<int> nodes;
      const auto add = [&](const auto& of_element) {
        for (const int v : of_element) nodes.push_back(v + 1);
      };
      for (const int e : block.elements)
        if (dim_ == 3)
          add(mesh_.hexahedra[e]);
        else if (static_cast<std::size_t>(e) < n_triangles)
          add(mesh_.triangles[e]);
        else
          add(nodes_of_quad(mesh_, static_cast<std::size_t>(e) - n_triangles, places));
      file_.put_block(block.name, block.type.c_str(), block.nodes_each, nodes);
    }
  }

  /// Node sets of all below the highest dimension, side sets of those next to it.
  void write_sets(std::span<const HalfEdge> sides, const std::vector<HexSide>& hex_sides) {
    constexpr std::array kSideOf = {5, 6, 1, 2, 3, 4};  // of Abaqus's S1, S2, ...
    for (const MeshGroup& group : groups_) {
      if (group.dim == dim_) continue;
      file_.put_node_set(group.label, nodes_of_group(mesh_, group));
      if (group.dim < dim_ - 1) continue;
      std::vector<int> elements, which;
      const auto add = [&](int element, int side) {
        elements.push_back(number_of_[element]);
        which.push_back(side);
      };
      for (const int i : group.items)
        if (dim_ == 3)
          for (const HexSide& side : sides_at_quad(mesh_, hex_sides, i))
            add(side.hexahedron, kSideOf[side.side - 1]);
        else
          for (const ElementSide& side : sides_at_line(mesh_, sides, i)) add(side.element, side.side + 1);
      file_.put_side_set(group.label, elements, which);
    }
  }

  ExodusFile& file_;
  const Mesh& mesh_;
  const std::vector<MeshGroup> groups_;
  const int dim_;  ///< of the elements
  std::vector<ExodusBlock> blocks_;
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
