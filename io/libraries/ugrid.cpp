// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <climits>
#include <sstream>
#include <utility>
#include <variant>

#include "base/located.h"
#include "geometry/mesh/drop_unused_points.h"
#include "io/boundary_chains.h"
#include "io/face_reader.h"
#include "io/library_file.h"
#include "io/library_format.h"
#include "io/mesh_io.h"

#include <netcdf.h>

namespace delquad {

namespace {

using NetcdfValues = std::variant<std::vector<int>, std::vector<double>>;

/// A netCDF file of 64-bit offsets, which has no times in it.
class NetcdfFile {
 public:
  NetcdfFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    check(nc_create(temporary.c_str(), NC_CLOBBER | NC_64BIT_OFFSET, &file_.id));
  }

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
    check(file_.close_now());
  }

 private:
  void check(int status) const {
    if (status > 0) errno = status;  // netCDF's codes are negative, the system's positive
    require_written(status == NC_NOERR, path_, "the netCDF library", "it");
  }
  const std::filesystem::path& path_;
  OpenFile<int, nc_close> file_;
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
  for (const char axis : {'x', 'y', 'z'}) {
    std::vector<double> values;
    for (const Vec3& p : mesh.points) values.push_back(axis == 'x' ? p.x : axis == 'y' ? p.y : p.z);
    if (axis == 'z' && std::ranges::all_of(values, [](double z) { return z == 0; })) continue;
    file.variable(
        fmt::format("mesh2d_node_{}", axis).c_str(), {nodes},
        {{"standard_name", axis == 'z' ? "altitude" : fmt::format("projection_{}_coordinate", axis)},
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
  names(2, "mesh2d_face_region", "face", faces, group_numbers(mesh, groups, 2));
  names(1, "mesh2d_edge_curve", "edge", edges, topology.edge_group);
  names(0, "mesh2d_node_point", "node", nodes, group_numbers(mesh, groups, 0));
}

/// The contents of a netCDF file, as text and numbers.
class NetcdfInput {
 public:
  explicit NetcdfInput(const std::filesystem::path& path) : path_(path) {
    check(nc_open(path.c_str(), NC_NOWRITE, &file_.id), "the file");
  }

  int variables() const {
    int n = 0;
    check(nc_inq_nvars(file_, &n), "the variables");
    return n;
  }
  int variable(const std::string& name) const {
    int id = -1;
    check(nc_inq_varid(file_, name.c_str(), &id), name);
    return id;
  }
  /// Empty where there is none.
  std::string text(int variable, const char* key) const {
    std::size_t length = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(file_, variable, key, &type, &length) != NC_NOERR || type != NC_CHAR) return "";
    std::string value(length, ' ');
    check(nc_get_att_text(file_, variable, key, value.data()), key);
    return value;
  }
  int number(int variable, const char* key, int otherwise) const {
    int value = otherwise;
    std::size_t length = 0;
    if (nc_inq_attlen(file_, variable, key, &length) == NC_NOERR && length == 1)
      check(nc_get_att_int(file_, variable, key, &value), key);
    return value;
  }
  std::vector<std::size_t> shape(int variable) const {
    int n = 0;
    std::array<int, NC_MAX_VAR_DIMS> ids;
    check(nc_inq_var(file_, variable, nullptr, nullptr, &n, ids.data(), nullptr), "a variable");
    std::vector<std::size_t> sizes(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < sizes.size(); ++i)
      check(nc_inq_dimlen(file_, ids[i], &sizes[i]), "a dimension");
    return sizes;
  }
  std::vector<double> values(int variable) const {
    std::size_t n = 1;
    for (const std::size_t size : shape(variable)) n *= size;
    std::vector<double> all(n);
    check(nc_get_var_double(file_, variable, all.data()), "the values");
    return all;
  }

 private:
  void check(int status, const std::string& what) const {
    if (status != NC_NOERR) refuse("{}: {} cannot be read: {}", path_.string(), what, nc_strerror(status));
  }
  const std::filesystem::path& path_;
  OpenFile<int, nc_close> file_;
};

/// The first two-dimensional mesh of a UGRID file [UGRID 1.0]: nodes and faces; names are left out.
Mesh read_ugrid(const std::filesystem::path& path, ReadNotes* notes, Strays) {
  const NetcdfInput file(path);
  int topology = 0;
  while (topology < file.variables() && (file.text(topology, "cf_role") != "mesh_topology" ||
                                         file.number(topology, "topology_dimension", 0) != 2))
    ++topology;
  if (topology == file.variables())
    refuse("{}: no UGRID mesh of topology_dimension 2: expected faces in a plane", path.string());
  std::istringstream names(file.text(topology, "node_coordinates"));
  std::string x_name, y_name;
  names >> x_name >> y_name;
  const std::vector<double> x = file.values(file.variable(x_name)), y = file.values(file.variable(y_name));
  const int faces = file.variable(file.text(topology, "face_node_connectivity"));
  const std::vector<std::size_t> shape = file.shape(faces);
  if (x.size() != y.size() || shape.size() != 2)
    refuse("{}: expected as many x as y, and rows of the nodes of faces", path.string());
  Mesh mesh;
  mesh.regions = {{1, {}}};
  for (std::size_t i = 0; i < x.size(); ++i) mesh.points.push_back({x[i], y[i], 0});
  const std::vector<double> nodes = file.values(faces);
  const int start = file.number(faces, "start_index", 0);
  const std::size_t n_faces = shape[0], widest = shape[1];
  const double none = file.number(faces, "_FillValue", INT_MIN);
  for (std::size_t f = 0; f < n_faces; ++f) {
    std::vector<int> corners;
    for (std::size_t k = 0; k < widest; ++k) {
      const double node = nodes[f * widest + k];
      if (node == none) continue;
      if (!(node >= start) || node - start >= static_cast<double>(x.size()))
        refuse("{}: face {} has node {}, and there are {}", path.string(), f + 1, node, x.size());
      corners.push_back(static_cast<int>(node) - start);
    }
    if (corners.size() != 3 && corners.size() != 4)
      refuse("{}: face {} has {} corners: expected triangles and quads", path.string(), f + 1,
             corners.size());
    add_element(mesh, static_cast<int>(corners.size()), corners, 0);
  }
  if (notes != nullptr) notes->push_back("names are left out");
  drop_unused_points(mesh);
  return mesh;
}

void write_ugrid(const std::filesystem::path& path, const Mesh& mesh) {
  require_terrain(path, "UGRID's 2D mesh", mesh);
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    NetcdfFile file(path, temporary);
    put_ugrid(file, mesh);
    file.close();
  });
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {delquad::read_ugrid, delquad::write_ugrid};
