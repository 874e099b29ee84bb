#include <algorithm>
#include <cerrno>

#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/library_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

#ifdef DELQUAD_HAS_EXODUS
#include <exodusII.h>
#endif

namespace delquad {

#ifdef DELQUAD_HAS_EXODUS

namespace {

constexpr int kExodusNameLength = 80;

/// Elements of one shape and name.
struct ExodusBlock {
  std::string name, type;
  std::vector<int> elements;
  std::size_t nodes_each;
};

class ExodusWriter {
 public:
  ExodusWriter(const std::filesystem::path& path, const std::filesystem::path& temporary, const Mesh& mesh)
      : path_(path), mesh_(mesh), groups_(mesh_groups(mesh, kExodusLabels)) {
    int real_in_memory = sizeof(double), real_in_file = sizeof(double);
    ex_opts(0);  // errors are told by what is returned
    file_ = ex_create(temporary.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &real_in_memory, &real_in_file);
    check(file_ >= 0, "the file");
    ex_set_max_name_length(file_, kExodusNameLength);
  }
  ~ExodusWriter() {
    if (file_ >= 0) ex_close(file_);
  }
  ExodusWriter(const ExodusWriter&) = delete;
  ExodusWriter& operator=(const ExodusWriter&) = delete;

  void write() {
    make_blocks();
    const bool planar = is_planar(mesh_);
    const auto n_sets = [&](int dim) { return std::ranges::count(groups_, dim, &MeshGroup::dim); };
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh_);
    check(ex_put_init(file_, "Quad mesh by Delquad", planar ? 2 : 3,
                      static_cast<int64_t>(mesh_.points.size()), static_cast<int64_t>(number_of_.size()),
                      static_cast<int64_t>(blocks_.size()), n_sets(0) + n_sets(1), n_sets(1)) >= 0,
          "the header");
    std::vector<double> x, y, z;
    for (const Vec3& p : mesh_.points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    check(ex_put_coord(file_, x.data(), y.data(), planar ? nullptr : z.data()) >= 0, "coordinates");
    write_blocks();
    write_sets(sides);
    const int closed = ex_close(file_);
    file_ = -1;
    check(closed >= 0, "the end of the file");
  }

 private:
  void check(bool done, const char* what) const {
    if (exerrval > 0) errno = exerrval;  // NetCDF's codes are negative, the system's positive
    require_written(done, path_, "the Exodus library", what);
  }

  void make_blocks() {
    const int n_triangles = static_cast<int>(mesh_.triangles.size());
    for (const MeshGroup& group : groups_) {
      if (group.dim != 2) continue;
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
    number_of_.resize(mesh_.triangles.size() + mesh_.quads.size());
    int n = 0;
    for (const ExodusBlock& block : blocks_)
      for (const int e : block.elements) number_of_[e] = ++n;
  }

  void write_blocks() {
    const std::vector<int> places = gmsh_places(mesh_.order);
    std::vector<std::string> names;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const ExodusBlock& block = blocks_[b];
      const auto id = static_cast<ex_entity_id>(b + 1);
      check(ex_put_block(file_, EX_ELEM_BLOCK, id, block.type.c_str(),
                         static_cast<int64_t>(block.elements.size()), static_cast<int64_t>(block.nodes_each),
                         0, 0, 0) >= 0,
            "a block");
      std::vector<int> nodes;
      for (const int e : block.elements) {
        const auto add = [&](const auto& of_element) {
          for (const int v : of_element) nodes.push_back(v + 1);
        };
        const auto n_triangles = mesh_.triangles.size();
        if (static_cast<std::size_t>(e) < n_triangles)
          add(mesh_.triangles[e]);
        else
          add(nodes_of_quad(mesh_, static_cast<std::size_t>(e) - n_triangles, places));
      }
      check(ex_put_conn(file_, EX_ELEM_BLOCK, id, nodes.data(), nullptr, nullptr) >= 0, "elements");
      names.push_back(block.name);
    }
    put_names(EX_ELEM_BLOCK, names);
  }

  /// Node sets of curves and points, side sets of curves.
  void write_sets(std::span<const HalfEdge> sides) {
    std::vector<std::string> node_sets, side_sets;
    for (const MeshGroup& group : groups_) {
      if (group.dim == 2) continue;
      std::vector<int> nodes = nodes_of_group(mesh_, group);
      for (int& v : nodes) ++v;
      put_set(EX_NODE_SET, group.label, nodes, {}, node_sets);
      if (group.dim == 0) continue;
      std::vector<int> elements, which;
      for (const int line : group.items)
        for (const ElementSide& side : sides_at_line(mesh_, sides, line)) {
          elements.push_back(number_of_[side.element]);
          which.push_back(side.side + 1);
        }
      put_set(EX_SIDE_SET, group.label, elements, which, side_sets);
    }
    put_names(EX_NODE_SET, node_sets);
    put_names(EX_SIDE_SET, side_sets);
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
  const Mesh& mesh_;
  const std::vector<MeshGroup> groups_;
  int file_ = -1;
  std::vector<ExodusBlock> blocks_;
  std::vector<int> number_of_;  ///< in the file, of each element
};

/// Exodus II: a block for each name of regions, node and side sets of curves, node sets of points.
void write_exodus(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(
      path, [&](const std::filesystem::path& temporary) { ExodusWriter(path, temporary, mesh).write(); });
}

}  // namespace

#endif

MeshFormat exodus_format() {
  MeshFormat format{
      .extensions = {".e", ".exo", ".ex2"},
      .description = "Exodus II: MOOSE, Cubit",
      .most_order = 2,
      .package = "libexodusii-dev",
      .renamed = [](const Mesh& mesh) { return renamed_groups(mesh_groups(mesh, kExodusLabels)); }};
#ifdef DELQUAD_HAS_EXODUS
  format.write = write_by<write_exodus>, format.package = "";
#endif
  return format;
}

}  // namespace delquad
