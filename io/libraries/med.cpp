// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <string>
#include <vector>

#include "io/cell_view.h"
#include "io/library_file.h"
#include "io/library_format.h"

#define OMPI_SKIP_MPICXX  // no C++ bindings, which warn
#include <med.h>

namespace delquad {

namespace {

constexpr const char* kMedMesh = "mesh";
/// Names of groups have at most 80 bytes, and names of families 64.
constexpr std::size_t kGroupLength = MED_LNAME_SIZE, kFamilyLength = MED_NAME_SIZE;

/// A file that is being written. A family is what belongs to the same groups: here, to one.
class MedFile {
 public:
  MedFile(const std::filesystem::path& path, const std::filesystem::path& temporary, const Mesh& mesh)
      : path_(path), mesh_(mesh), groups_(mesh_groups(mesh, kMedLabels)) {
    file_.id = MEDfileOpen(temporary.c_str(), MED_ACC_CREAT);
    require_written(file_ >= 0, path_, "the MED library", "the file");
  }

  void put_head() {
    const int dim = dimension_of(mesh_), dimensions = dim == 2 && is_planar(mesh_) ? 2 : 3;
    std::string axes, units;
    for (const char* axis : {"X", "Y", "Z"}) {
      axes += padded(axis, MED_SNAME_SIZE);
      units += padded(mesh_.unit, MED_SNAME_SIZE);
    }
    check(MEDmeshCr(file_, kMedMesh, dimensions, dim, MED_UNSTRUCTURED_MESH,
                    dim == 3 ? "Volume mesh by Delquad" : "Quad mesh by Delquad", "", MED_SORT_DTIT,
                    MED_CARTESIAN,
                    axes.substr(0, MED_SNAME_SIZE * static_cast<std::size_t>(dimensions)).c_str(),
                    units.substr(0, MED_SNAME_SIZE * static_cast<std::size_t>(dimensions)).c_str()),
          "the mesh");
    create_families();
    std::vector<double> places;
    for (const Vec3& p : mesh_.points) {
      places.insert(places.end(), {p.x, p.y});
      if (dimensions == 3) places.push_back(p.z);
    }
    check(MEDmeshNodeCoordinateWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_FULL_INTERLACE,
                                  static_cast<med_int>(mesh_.points.size()), places.data()),
          "coordinates");
    put_families(MED_NODE, MED_NONE, families_of(0));
  }

  /// Writes the elements of a block that have a group.
  void put_elements(const CellBlock& cells) {
    using enum CellShape;
    // The first side of a cell is counterclockwise seen from outside.
    constexpr CellCode<med_geometry_type> kTypes[] = {{kLine, 2, MED_SEG2},
                                                      {kLine, 3, MED_SEG3},
                                                      {kTriangle, 3, MED_TRIA3},
                                                      {kQuad, 4, MED_QUAD4},
                                                      {kQuad, 9, MED_QUAD9},
                                                      {kHexahedron, 8, MED_HEXA8, "03214765"},
                                                      {kPrism, 6, MED_PENTA6, "021354"},
                                                      {kPyramid, 5, MED_PYRA5, "03214"},
                                                      {kTetrahedron, 4, MED_TETRA4, "0213"}};
    const std::vector<med_int> of_all = families_of(cells.dim);
    std::vector<med_int> nodes, families;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (of_all[cells.first + i] == 0) continue;
      families.push_back(of_all[cells.first + i]);
      for (const int node : nodes_of(cells, i, kTypes)) nodes.push_back(node + 1);
    }
    if (families.empty()) return;
    const med_geometry_type type = code_of(cells, kTypes);
    check(MEDmeshElementConnectivityWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_CELL, type,
                                       MED_NODAL, MED_FULL_INTERLACE, static_cast<med_int>(families.size()),
                                       nodes.data()),
          "elements");
    put_families(MED_CELL, type, families);
  }

  void close() { check(file_.close_now(), "the end of the file"); }

 private:
  void check(med_err error, const char* what) const {
    require_written(error >= 0, path_, "the MED library", what);
  }
  static std::string padded(std::string text, std::size_t length) {
    text.resize(length, ' ');
    return text;
  }
  /// Returns the family of each item of a dimension; 0: it is in no group.
  std::vector<med_int> families_of(int dim) const {
    std::vector<med_int> families(n_cells(mesh_, dim), 0);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (groups_[g].dim == dim)
        for (const int i : groups_[g].items) families[static_cast<std::size_t>(i)] = family(g);
    return families;
  }
  void put_families(med_entity_type entity, med_geometry_type type, const std::vector<med_int>& families) {
    check(MEDmeshEntityFamilyNumberWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, entity, type,
                                      static_cast<med_int>(families.size()), families.data()),
          "families");
  }
  /// Positive for nodes, negative for elements.
  med_int family(std::size_t group) const {
    return groups_[group].dim == 0 ? groups_[group].number : -1 - static_cast<med_int>(group);
  }

  void create_families() {
    check(MEDfamilyCr(file_, kMedMesh, "FAMILLE_ZERO", 0, 0, ""), "families");
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const std::string name = "FAM_" + std::to_string(family(g));
      std::string label = groups_[g].label;
      label.resize(kGroupLength, '\0');
      check(MEDfamilyCr(file_, kMedMesh, name.substr(0, kFamilyLength).c_str(), family(g), 1, label.c_str()),
            "families");
    }
  }

  const std::filesystem::path& path_;
  const Mesh& mesh_;
  const std::vector<MeshGroup> groups_;
  OpenFile<med_idt, MEDfileClose> file_;
};

/// MED 4: a family and a group for each name.
void write_med(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    MedFile file(path, temporary, mesh);
    file.put_head();
    for (const CellBlock& cells : cell_blocks(mesh)) file.put_elements(cells);
    file.close();
  });
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {nullptr, delquad::write_med};
