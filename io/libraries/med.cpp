#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/library_file.h"
#include "io/library_format.h"
#include "io/mesh_io.h"

#define OMPI_SKIP_MPICXX  // no C++ bindings, which warn
#include <med.h>

namespace delquad {

namespace {

constexpr const char* kMedMesh = "mesh";
/// Names of groups have at most 80 bytes, those of families 64.
constexpr std::size_t kGroupLength = MED_LNAME_SIZE, kFamilyLength = MED_NAME_SIZE;

/// A file that is being written. A family is what belongs to the same groups: here, to one.
class MedFile {
 public:
  MedFile(const std::filesystem::path& path, const std::filesystem::path& temporary,
          const std::vector<MeshGroup>& groups)
      : path_(path), groups_(groups) {
    file_ = MEDfileOpen(temporary.c_str(), MED_ACC_CREAT);
    require_written(file_ >= 0, path_, "the MED library", "the file");
  }
  ~MedFile() {
    if (file_ >= 0) MEDfileClose(file_);
  }
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  /// `dim`: of the largest elements.
  void put_head(const char* title, int dim, bool planar, const std::vector<Vec3>& points,
                const std::string& unit) {
    const int dimensions = planar ? 2 : 3;
    std::string axes, units;
    for (const char* axis : {"X", "Y", "Z"}) {
      axes += padded(axis, MED_SNAME_SIZE);
      units += padded(unit, MED_SNAME_SIZE);
    }
    check(MEDmeshCr(file_, kMedMesh, dimensions, dim, MED_UNSTRUCTURED_MESH, title, "", MED_SORT_DTIT,
                    MED_CARTESIAN,
                    axes.substr(0, MED_SNAME_SIZE * static_cast<std::size_t>(dimensions)).c_str(),
                    units.substr(0, MED_SNAME_SIZE * static_cast<std::size_t>(dimensions)).c_str()),
          "the mesh");
    put_families();
    std::vector<double> places;
    for (const Vec3& p : points) {
      places.insert(places.end(), {p.x, p.y});
      if (!planar) places.push_back(p.z);
    }
    check(MEDmeshNodeCoordinateWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_FULL_INTERLACE,
                                  static_cast<med_int>(points.size()), places.data()),
          "coordinates");
    const std::vector<med_int> families = families_of(0, points.size());
    check(MEDmeshEntityFamilyNumberWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_NODE, MED_NONE,
                                      static_cast<med_int>(families.size()), families.data()),
          "families");
  }

  /// Of each item of a dimension; 0: it is in no group.
  std::vector<med_int> families_of(int dim, std::size_t n_items) const {
    std::vector<med_int> families(n_items, 0);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (groups_[g].dim == dim)
        for (const int i : groups_[g].items) families[static_cast<std::size_t>(i)] = family(g);
    return families;
  }

  /// `nodes_of(i)` of element i, from 0, in MED's order.
  template <class NodesOf>
  void put_elements(med_geometry_type type, const std::vector<med_int>& families, const NodesOf& nodes_of) {
    if (families.empty()) return;
    std::vector<med_int> nodes;
    for (std::size_t i = 0; i < families.size(); ++i)
      for (const int v : nodes_of(i)) nodes.push_back(v + 1);
    const auto n = static_cast<med_int>(families.size());
    check(MEDmeshElementConnectivityWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_CELL, type,
                                       MED_NODAL, MED_FULL_INTERLACE, n, nodes.data()),
          "elements");
    check(MEDmeshEntityFamilyNumberWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_CELL, type, n,
                                      families.data()),
          "families");
  }

  void close() {
    const med_err closed = MEDfileClose(file_);
    file_ = -1;
    check(closed, "the end of the file");
  }

 private:
  void check(med_err error, const char* what) const {
    require_written(error >= 0, path_, "the MED library", what);
  }
  static std::string padded(std::string text, std::size_t length) {
    text.resize(length, ' ');
    return text;
  }
  /// Positive for nodes, negative for elements.
  med_int family(std::size_t group) const {
    return groups_[group].dim == 0 ? groups_[group].number : -1 - static_cast<med_int>(group);
  }

  void put_families() {
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
  const std::vector<MeshGroup>& groups_;
  med_idt file_ = -1;
};

/// MED 4: a family and a group for each name.
void write_med(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, kMedLabels);
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    MedFile file(path, temporary, groups);
    const bool is_solid = !mesh.hexahedra.empty();
    file.put_head(is_solid ? "Mesh of hexahedra by Delquad" : "Quad mesh by Delquad", is_solid ? 3 : 2,
                  !is_solid && is_planar(mesh), mesh.points, mesh.unit);
    std::vector<std::size_t> lines;  // with a group
    std::vector<med_int> of_lines;
    const std::vector<med_int> of_all = file.families_of(1, mesh.lines.size());
    for (std::size_t l = 0; l < of_all.size(); ++l)
      if (of_all[l] != 0) lines.push_back(l), of_lines.push_back(of_all[l]);
    file.put_elements(mesh.order == 2 ? MED_SEG3 : MED_SEG2, of_lines,
                      [&](std::size_t i) { return nodes_ends_first(mesh, lines[i]); });
    const auto n_triangles = static_cast<std::ptrdiff_t>(mesh.triangles.size());
    const std::vector<med_int> of_elements = file.families_of(2, mesh.triangles.size() + mesh.quads.size());
    file.put_elements(MED_TRIA3, {of_elements.begin(), of_elements.begin() + n_triangles},
                      [&](std::size_t i) { return mesh.triangles[i]; });
    const std::vector<int> places = gmsh_places(mesh.order);
    file.put_elements(mesh.order == 2 ? MED_QUAD9 : MED_QUAD4,
                      {of_elements.begin() + n_triangles, of_elements.end()},
                      [&](std::size_t i) { return nodes_of_quad(mesh, i, places); });
    // The first side counterclockwise seen from outside.
    file.put_elements(MED_HEXA8, file.families_of(3, mesh.hexahedra.size()), [&](std::size_t i) {
      const std::array<int, 8>& v = mesh.hexahedra[i];
      return std::array{v[0], v[3], v[2], v[1], v[4], v[7], v[6], v[5]};
    });
    file.close();
  });
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {nullptr, delquad::write_med};
