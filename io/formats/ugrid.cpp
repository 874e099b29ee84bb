#include <fmt/format.h>

#include <cerrno>
#include <utility>
#include <variant>

#include "io/boundary_chains.h"
#include "io/entity_names.h"
#include "io/library_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

#ifdef DELQUAD_HAS_NETCDF
#include <netcdf.h>
#endif

namespace delquad {

#ifdef DELQUAD_HAS_NETCDF

namespace {

using NetcdfValues = std::variant<std::vector<int>, std::vector<double>>;

/// A netCDF file of 64-bit offsets, which has no times in it.
class NetcdfFile {
 public:
  NetcdfFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    check(nc_create(temporary.c_str(), NC_CLOBBER | NC_64BIT_OFFSET, &file_));
  }
  ~NetcdfFile() {
    if (file_ >= 0) nc_close(file_);
  }
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  int dimension(const char* name, std::size_t n) {
    int id = -1;
    check(nc_def_dim(file_, name, n, &id));
    return id;
  }
  /// The values are written by close().
  int variable(const char* name, const std::vector<int>& dimensions,
               const std::vector<std::pair<const char*, std::string>>& texts, NetcdfValues values) {
    int id = -1;
    check(nc_def_var(file_, name, values.index() == 0 ? NC_INT : NC_DOUBLE,
                     static_cast<int>(dimensions.size()), dimensions.data(), &id));
    for (const auto& [key, text] : texts) attribute(id, key, text);
    values_.emplace_back(id, std::move(values));
    return id;
  }
  void attribute(int variable, const char* key, const std::string& text) {
    check(nc_put_att_text(file_, variable, key, text.size(), text.data()));
  }
  void attribute(int variable, const char* key, const std::vector<int>& values) {
    check(nc_put_att_int(file_, variable, key, NC_INT, values.size(), values.data()));
  }
  void close() {
    check(nc_enddef(file_));
    for (const auto& [variable, values] : values_)
      check(std::visit([&](const auto& all) { return nc_put_var(file_, variable, all.data()); }, values));
    check(nc_close(std::exchange(file_, -1)));
  }

 private:
  void check(int status) const {
    if (status > 0) errno = status;  // netCDF's codes are negative, the system's positive
    require_written(status == NC_NOERR, path_, "the netCDF library", "it");
  }
  const std::filesystem::path& path_;
  int file_ = -1;
  std::vector<std::pair<int, NetcdfValues>> values_;
};

constexpr int kNoIndex = -999;  ///< Delft3D FM's fill value

/// Nodes of faces and edges, and the faces beside edges, numbered from 1.
struct UgridTopology {
  int widest;
  std::vector<int> face_nodes, edge_nodes, edge_faces, edge_group;

  UgridTopology(const Mesh& mesh, const std::vector<MeshGroup>& groups) : widest(mesh.quads.empty() ? 3 : 4) {
    for_each_element(mesh, [&](int, const auto& v) {
      for (const int i : v) face_nodes.push_back(i + 1);
      if (static_cast<int>(v.size()) < widest) face_nodes.push_back(kNoIndex);
    });
    const auto group_of = groups_of_lines(mesh, groups);
    for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> sides) {
      for (const int v : sides[0].run()) edge_nodes.push_back(v + 1);
      edge_faces.insert(edge_faces.end(),
                        {sides[0].element + 1, sides.size() > 1 ? sides[1].element + 1 : kNoIndex});
      const auto group = group_of.find({sides[0].lo, sides[0].hi});
      edge_group.push_back(group == group_of.end() ? 0 : groups[group->second].number);
    });
  }
};

/// UGRID 1.0 with the names of Delft3D FM; names of curves, regions and points are flags.
void put_ugrid(NetcdfFile& file, const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {word_label});
  const UgridTopology topology(mesh, groups);
  const std::size_t n_faces = mesh.triangles.size() + mesh.quads.size();
  file.attribute(NC_GLOBAL, "Conventions", "CF-1.8 UGRID-1.0 Deltares-0.10");
  file.attribute(NC_GLOBAL, "institution", "quad mesh by Delquad");
  const int two = file.dimension("Two", 2), nodes = file.dimension("mesh2d_nNodes", mesh.points.size());
  const int edges = file.dimension("mesh2d_nEdges", topology.edge_group.size());
  const int faces = file.dimension("mesh2d_nFaces", n_faces);
  const int widest = file.dimension("mesh2d_nMax_face_nodes", static_cast<std::size_t>(topology.widest));
  const int mesh2d = file.variable("mesh2d", {},
                                   {{"cf_role", "mesh_topology"},
                                    {"long_name", "Topology data of 2D mesh"},
                                    {"node_coordinates", "mesh2d_node_x mesh2d_node_y"},
                                    {"node_dimension", "mesh2d_nNodes"},
                                    {"max_face_nodes_dimension", "mesh2d_nMax_face_nodes"},
                                    {"edge_node_connectivity", "mesh2d_edge_nodes"},
                                    {"edge_dimension", "mesh2d_nEdges"},
                                    {"face_node_connectivity", "mesh2d_face_nodes"},
                                    {"face_dimension", "mesh2d_nFaces"},
                                    {"edge_face_connectivity", "mesh2d_edge_faces"}},
                                   std::vector{0});
  file.attribute(mesh2d, "topology_dimension", std::vector{2});
  for (const char axis : {'x', 'y'}) {
    std::vector<double> values;
    for (const Vec3& p : mesh.points) values.push_back(axis == 'x' ? p.x : p.y);
    file.variable(fmt::format("mesh2d_node_{}", axis).c_str(), {nodes},
                  {{"standard_name", fmt::format("projection_{}_coordinate", axis)},
                   {"units", mesh.unit.empty() ? "m" : mesh.unit},
                   {"mesh", "mesh2d"},
                   {"location", "node"}},
                  std::move(values));
  }
  const auto connectivity = [&](const char* name, const char* role, int rows, int columns,
                                const std::vector<int>& values) {
    const int id = file.variable(name, {rows, columns}, {{"cf_role", role}}, values);
    file.attribute(id, "start_index", std::vector{1});
    file.attribute(id, "_FillValue", std::vector{kNoIndex});
  };
  connectivity("mesh2d_face_nodes", "face_node_connectivity", faces, widest, topology.face_nodes);
  connectivity("mesh2d_edge_nodes", "edge_node_connectivity", edges, two, topology.edge_nodes);
  connectivity("mesh2d_edge_faces", "edge_face_connectivity", edges, two, topology.edge_faces);
  const auto names = [&](int dim, const char* name, const char* location, int dimension,
                         std::vector<int> numbers) {
    std::vector<int> values{0};
    std::string meanings = "none";
    for (const MeshGroup& group : groups)
      if (group.dim == dim) values.push_back(group.number), meanings += ' ' + group.label;
    const int id = file.variable(name, {dimension},
                                 {{"mesh", "mesh2d"}, {"location", location}, {"flag_meanings", meanings}},
                                 std::move(numbers));
    file.attribute(id, "flag_values", values);
  };
  names(2, "mesh2d_face_region", "face", faces, group_numbers(groups, 2, n_faces));
  names(1, "mesh2d_edge_curve", "edge", edges, topology.edge_group);
  names(0, "mesh2d_node_point", "node", nodes, group_numbers(groups, 0, mesh.points.size()));
}

void write_ugrid(const std::filesystem::path& path, const Mesh& mesh) {
  require_planar(path, "UGRID's 2D mesh", mesh);
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    NetcdfFile file(path, temporary);
    put_ugrid(file, mesh);
    file.close();
  });
}

}  // namespace

#endif

MeshFormat ugrid_format() {
  MeshFormat format{
      .extensions = {".nc"},
      .description = "UGRID in netCDF: Delft3D FM, QGIS",
      .package = "libnetcdf-dev",
      .renamed = [](const Mesh& mesh) { return renamed_groups(mesh_groups(mesh, {word_label})); }};
#ifdef DELQUAD_HAS_NETCDF
  format.write = write_by<write_ugrid>, format.package = "";
#endif
  return format;
}

}  // namespace delquad
