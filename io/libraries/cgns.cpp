#include <algorithm>
#include <array>
#include <limits>

#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/library_file.h"
#include "io/library_format.h"
#include "io/mesh_io.h"

#include <cgnslib.h>

namespace delquad {

namespace {

/// A file of one zone that is being written.
class CgnsFile {
 public:
  CgnsFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    check(cg_open(temporary.c_str(), CG_MODE_WRITE, &file_), "the file");
  }
  ~CgnsFile() {
    if (file_ >= 0) cg_close(file_);
  }
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;

  /// `dim`: of cells, the largest elements.
  void put_head(int dim, bool planar, const std::vector<Vec3>& points, std::size_t n_cells) {
    const int dimensions = planar ? 2 : 3;
    check(cg_base_write(file_, "Base", dim, dimensions, &base_), "the base");
    const cgsize_t sizes[3] = {static_cast<cgsize_t>(points.size()), static_cast<cgsize_t>(n_cells), 0};
    check(cg_zone_write(file_, base_, "Zone1", sizes, CGNS_ENUMV(Unstructured), &zone_), "the zone");
    constexpr std::array kNames = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (int k = 0; k < dimensions; ++k) {
      std::vector<double> values;
      for (const Vec3& p : points) values.push_back(k == 0 ? p.x : k == 1 ? p.y : p.z);
      int index = 0;
      check(cg_coord_write(file_, base_, zone_, CGNS_ENUMV(RealDouble), kNames[k], values.data(), &index),
            "coordinates");
    }
  }

  /// Elements of one kind, by their nodes from 1. Returns the range of numbers that they got.
  std::array<cgsize_t, 2> put_section(const std::string& name, CGNS_ENUMT(ElementType_t) type,
                                      std::size_t count, const std::vector<cgsize_t>& nodes) {
    require_fits(path_, "CGNS", nodes.size(), "nodes of elements", std::numeric_limits<cgsize_t>::max());
    const std::array<cgsize_t, 2> range{next_, next_ + static_cast<cgsize_t>(count) - 1};
    int index = 0;
    check(cg_section_write(file_, base_, zone_, name.c_str(), type, range[0], range[1], 0, nodes.data(),
                           &index),
          "elements");
    next_ = range[1] + 1;
    return range;
  }

  /// Elements, and a boundary condition on them.
  void put_boundary(const std::string& name, CGNS_ENUMT(ElementType_t) type, std::size_t count,
                    const std::vector<cgsize_t>& nodes, CGNS_ENUMT(GridLocation_t) location) {
    const auto range = put_section(name, type, count, nodes);
    put_condition(name, CGNS_ENUMV(PointRange), {range.begin(), range.end()}, location);
  }
  void put_points(const std::string& name, const std::vector<cgsize_t>& nodes) {
    put_condition(name, CGNS_ENUMV(PointList), nodes, CGNS_ENUMV(Vertex));
  }

  void close() {
    const int closed = cg_close(file_);
    file_ = -1;
    check(closed, "the end of the file");
  }

 private:
  void check(int error, const char* what) const {
    require_written(error == CG_OK, path_, "the CGNS library", what);
  }

  void put_condition(const std::string& name, CGNS_ENUMT(PointSetType_t) kind,
                     const std::vector<cgsize_t>& where, CGNS_ENUMT(GridLocation_t) location) {
    int index = 0;
    check(cg_boco_write(file_, base_, zone_, name.c_str(), CGNS_ENUMV(BCTypeUserDefined), kind,
                        static_cast<cgsize_t>(where.size()), where.data(), &index),
          "a boundary condition");
    if (location != CGNS_ENUMV(Vertex))
      check(cg_boco_gridlocation_write(file_, base_, zone_, index, location), "a boundary condition");
  }

  const std::filesystem::path& path_;
  int file_ = -1, base_ = 0, zone_ = 0;
  cgsize_t next_ = 1;
};

template <class Nodes>
void add_cgns_nodes(const Nodes& of_element, std::vector<cgsize_t>& nodes) {
  for (const int v : of_element) nodes.push_back(v + 1);
}

void put_region(CgnsFile& file, const Mesh& mesh, const MeshGroup& group) {
  const auto n_triangles = mesh.triangles.size();
  const std::vector<int> places = gmsh_places(mesh.order);
  std::vector<cgsize_t> triangles, quads;
  std::size_t count[2] = {0, 0};
  for (const int e : group.items) {
    const auto i = static_cast<std::size_t>(e);
    ++count[i < n_triangles ? 0 : 1];
    if (i < n_triangles)
      add_cgns_nodes(mesh.triangles[i], triangles);
    else
      add_cgns_nodes(nodes_of_quad(mesh, i - n_triangles, places), quads);
  }
  if (count[0] > 0)
    file.put_section(count[1] > 0 ? group.label + "_tri" : group.label, CGNS_ENUMV(TRI_3), count[0],
                     triangles);
  if (count[1] > 0)
    file.put_section(group.label, mesh.order == 2 ? CGNS_ENUMV(QUAD_9) : CGNS_ENUMV(QUAD_4), count[1], quads);
}

/// CGNS: one zone, a section for each name, boundary conditions on all names below the highest dimension.
void write_cgns(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    CgnsFile file(path, temporary);
    const bool is_solid = !mesh.hexahedra.empty();
    file.put_head(is_solid ? 3 : 2, !is_solid && is_planar(mesh), mesh.points,
                  is_solid ? mesh.hexahedra.size() : mesh.triangles.size() + mesh.quads.size());
    for (const MeshGroup& group : mesh_groups(mesh, kCgnsLabels)) {
      std::vector<cgsize_t> nodes;
      if (group.dim == 3) {
        for (const int h : group.items) add_cgns_nodes(mesh.hexahedra[h], nodes);
        file.put_section(group.label, CGNS_ENUMV(HEXA_8), group.items.size(), nodes);
      } else if (group.dim == 2 && is_solid) {
        for (const int q : group.items) add_cgns_nodes(mesh.quads[q], nodes);
        file.put_boundary(group.label, CGNS_ENUMV(QUAD_4), group.items.size(), nodes, CGNS_ENUMV(FaceCenter));
      } else if (group.dim == 2) {
        put_region(file, mesh, group);
      } else if (group.dim == 1) {
        for (const int l : group.items)
          add_cgns_nodes(nodes_ends_first(mesh, static_cast<std::size_t>(l)), nodes);
        file.put_boundary(group.label, mesh.order == 2 ? CGNS_ENUMV(BAR_3) : CGNS_ENUMV(BAR_2),
                          group.items.size(), nodes, CGNS_ENUMV(EdgeCenter));
      } else {
        add_cgns_nodes(group.items, nodes);
        file.put_points(group.label, nodes);
      }
    }
    file.close();
  });
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {nullptr, delquad::write_cgns};
