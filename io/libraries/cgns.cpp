// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <limits>

#include "io/cell_view.h"
#include "io/library_file.h"
#include "io/library_format.h"

#include <cgnslib.h>

namespace delquad {

namespace {

/// A file of one zone that is being written.
class CgnsFile {
 public:
  CgnsFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    check(cg_open(temporary.c_str(), CG_MODE_WRITE, &file_.id), "the file");
  }

  void put_head(const Mesh& mesh) {
    const int dim = dimension_of(mesh), dimensions = dim == 2 && is_planar(mesh) ? 2 : 3;
    const std::vector<Vec3>& points = mesh.points;
    check(cg_base_write(file_, "Base", dim, dimensions, &base_), "the base");
    const cgsize_t sizes[3] = {static_cast<cgsize_t>(points.size()),
                               static_cast<cgsize_t>(n_cells(mesh, dim)), 0};
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

  /// Writes elements of a block. If they are sides, they get a boundary condition.
  void put_section(const std::string& name, const CellBlock& cells, const std::vector<std::size_t>& items,
                   bool are_sides) {
    using enum CellShape;
    constexpr CellCode<CGNS_ENUMT(ElementType_t)> kTypes[] = {
        {kLine, 2, CGNS_ENUMV(BAR_2)},         {kLine, 3, CGNS_ENUMV(BAR_3)},
        {kTriangle, 3, CGNS_ENUMV(TRI_3)},     {kQuad, 4, CGNS_ENUMV(QUAD_4)},
        {kQuad, 9, CGNS_ENUMV(QUAD_9)},        {kHexahedron, 8, CGNS_ENUMV(HEXA_8)},
        {kPrism, 6, CGNS_ENUMV(PENTA_6)},      {kPyramid, 5, CGNS_ENUMV(PYRA_5)},
        {kTetrahedron, 4, CGNS_ENUMV(TETRA_4)}};
    std::vector<cgsize_t> nodes;
    for (const std::size_t i : items)
      for (const int v : cells.nodes(i)) nodes.push_back(v + 1);
    require_fits(path_, "CGNS", nodes.size(), "nodes of elements", std::numeric_limits<cgsize_t>::max());
    const std::vector<cgsize_t> range{next_, next_ + static_cast<cgsize_t>(items.size()) - 1};
    int index = 0;
    check(cg_section_write(file_, base_, zone_, name.c_str(), code_of(cells, kTypes), range[0], range[1], 0,
                           nodes.data(), &index),
          "elements");
    next_ = range[1] + 1;
    if (are_sides)
      put_condition(name, CGNS_ENUMV(PointRange), range,
                    cells.dim == 2 ? CGNS_ENUMV(FaceCenter) : CGNS_ENUMV(EdgeCenter));
  }
  void put_points(const std::string& name, const std::vector<int>& points) {
    std::vector<cgsize_t> nodes;
    for (const int v : points) nodes.push_back(v + 1);
    put_condition(name, CGNS_ENUMV(PointList), nodes, CGNS_ENUMV(Vertex));
  }

  void close() { check(file_.close_now(), "the end of the file"); }

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
  OpenFile<int, cg_close> file_;
  int base_ = 0, zone_ = 0;
  cgsize_t next_ = 1;
};

/// Ends of names, which tell shapes apart that have one name.
constexpr CellCode<const char*> kSuffixes[] = {{CellShape::kTriangle, 3, "_tri"},
                                               {CellShape::kQuad, 4, ""},
                                               {CellShape::kQuad, 9, ""},
                                               {CellShape::kHexahedron, 8, ""},
                                               {CellShape::kPrism, 6, "_penta"},
                                               {CellShape::kPyramid, 5, "_pyra"},
                                               {CellShape::kTetrahedron, 4, "_tetra"}};

/// CGNS: one zone, a section for each name, boundary conditions on all names below the highest dimension.
void write_cgns(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<CellBlock> blocks = cell_blocks(mesh);
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    CgnsFile file(path, temporary);
    file.put_head(mesh);
    for (const MeshGroup& group : mesh_groups(mesh, kCgnsLabels)) {
      if (group.dim == 0) file.put_points(group.label, group.items);
      for (const CellBlock& cells : blocks) {
        const std::vector<std::size_t> items = items_in_block(group, cells);
        const bool is_mixed = items.size() < group.items.size();
        if (!items.empty())
          file.put_section(group.label + (is_mixed ? code_of(cells, kSuffixes) : ""), cells, items,
                           group.dim < dimension_of(mesh));
      }
    }
    file.close();
  });
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {nullptr, delquad::write_cgns};
