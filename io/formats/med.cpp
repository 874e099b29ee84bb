
#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/library_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

#ifdef DELQUAD_HAS_MED
#define OMPI_SKIP_MPICXX  // no C++ bindings, which warn
#include <med.h>
#endif

namespace delquad {

#ifdef DELQUAD_HAS_MED

namespace {

constexpr const char* kMedMesh = "mesh";
/// Names of groups have at most 80 bytes, those of families 64.
constexpr std::size_t kGroupLength = MED_LNAME_SIZE, kFamilyLength = MED_NAME_SIZE;

/// A family is what belongs to the same groups: here, to one.
class MedWriter {
 public:
  MedWriter(const std::filesystem::path& path, const std::filesystem::path& temporary, const Mesh& mesh)
      : path_(path), mesh_(mesh), planar_(is_planar(mesh)), groups_(mesh_groups(mesh, kMedLabels)) {
    file_ = MEDfileOpen(temporary.c_str(), MED_ACC_CREAT);
    require_written(file_ >= 0, path_, "the MED library", "the file");
  }
  ~MedWriter() {
    if (file_ >= 0) MEDfileClose(file_);
  }
  MedWriter(const MedWriter&) = delete;
  MedWriter& operator=(const MedWriter&) = delete;

  void write() {
    const int dimensions = planar_ ? 2 : 3;
    std::string axes, units;
    for (const char* axis : {"X", "Y", "Z"}) {
      axes += padded(axis, MED_SNAME_SIZE);
      units += padded(mesh_.unit, MED_SNAME_SIZE);
    }
    check(MEDmeshCr(file_, kMedMesh, dimensions, 2, MED_UNSTRUCTURED_MESH, "Quad mesh by Delquad", "",
                    MED_SORT_DTIT, MED_CARTESIAN,
                    axes.substr(0, MED_SNAME_SIZE * static_cast<std::size_t>(dimensions)).c_str(),
                    units.substr(0, MED_SNAME_SIZE * static_cast<std::size_t>(dimensions)).c_str()),
          "the mesh");
    write_families();
    std::vector<double> places;
    for (const Vec3& p : mesh_.points) {
      places.insert(places.end(), {p.x, p.y});
      if (!planar_) places.push_back(p.z);
    }
    check(MEDmeshNodeCoordinateWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_FULL_INTERLACE,
                                  static_cast<med_int>(mesh_.points.size()), places.data()),
          "coordinates");
    const std::vector<int> of_points = group_numbers(groups_, 0, mesh_.points.size());
    std::vector<med_int> families;
    for (const int g : of_points) families.push_back(g > 0 ? family(0, g) : 0);
    check(MEDmeshEntityFamilyNumberWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_NODE, MED_NONE,
                                      static_cast<med_int>(families.size()), families.data()),
          "families");
    write_elements();
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
  static med_int family(int dim, int number) {
    return dim == 0 ? number : -(2 * number - (dim == 1 ? 1 : 0));
  }

  void write_families() {
    check(MEDfamilyCr(file_, kMedMesh, "FAMILLE_ZERO", 0, 0, ""), "families");
    for (const MeshGroup& group : groups_) {
      const med_int number = family(group.dim, group.number);
      const std::string name = "FAM_" + std::to_string(number);
      std::string groups = group.label;
      groups.resize(kGroupLength, '\0');
      check(MEDfamilyCr(file_, kMedMesh, name.substr(0, kFamilyLength).c_str(), number, 1, groups.c_str()),
            "families");
    }
  }

  void write_kind(med_geometry_type type, const std::vector<med_int>& nodes,
                  const std::vector<med_int>& families) {
    if (families.empty()) return;
    const auto n = static_cast<med_int>(families.size());
    check(MEDmeshElementConnectivityWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_CELL, type,
                                       MED_NODAL, MED_FULL_INTERLACE, n, nodes.data()),
          "elements");
    check(MEDmeshEntityFamilyNumberWr(file_, kMedMesh, MED_NO_DT, MED_NO_IT, MED_CELL, type, n,
                                      families.data()),
          "families");
  }

  void write_elements() {
    const std::vector<int> of_lines = group_numbers(groups_, 1, mesh_.lines.size());
    const std::vector<int> of_elements =
        group_numbers(groups_, 2, mesh_.triangles.size() + mesh_.quads.size());
    std::vector<med_int> nodes, families;
    const auto add = [&](const auto& of_element, med_int number) {
      for (const int v : of_element) nodes.push_back(v + 1);
      families.push_back(number);
    };
    const auto flush = [&](med_geometry_type type) {
      write_kind(type, nodes, families);
      nodes.clear();
      families.clear();
    };
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      if (of_lines[l] > 0) add(nodes_ends_first(mesh_, l), family(1, of_lines[l]));
    flush(mesh_.order == 2 ? MED_SEG3 : MED_SEG2);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      add(mesh_.triangles[t], family(2, of_elements[t]));
    flush(MED_TRIA3);
    const std::vector<int> places = gmsh_places(mesh_.order);
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
      add(nodes_of_quad(mesh_, q, places), family(2, of_elements[mesh_.triangles.size() + q]));
    flush(mesh_.order == 2 ? MED_QUAD9 : MED_QUAD4);
  }

  const std::filesystem::path& path_;
  const Mesh& mesh_;
  const bool planar_;
  const std::vector<MeshGroup> groups_;
  med_idt file_ = -1;
};

/// MED 4: a family and a group for each name.
void write_med(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(path,
                   [&](const std::filesystem::path& temporary) { MedWriter(path, temporary, mesh).write(); });
}

}  // namespace

#endif

MeshFormat med_format() {
  MeshFormat format{
      .extensions = {".med"},
      .description = "MED: Code_Aster, Salome",
      .most_order = 2,
      .package = "libmedc-dev",
      .renamed = [](const Mesh& mesh) { return renamed_groups(mesh_groups(mesh, kMedLabels)); }};
#ifdef DELQUAD_HAS_MED
  format.write = write_by<write_med>, format.package = "";
#endif
  return format;
}

}  // namespace delquad
