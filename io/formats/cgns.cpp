#include <algorithm>
#include <array>
#include <limits>

#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/library_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

#ifdef DELQUAD_HAS_CGNS
#include <cgnslib.h>
#endif

namespace delquad {

#ifdef DELQUAD_HAS_CGNS

namespace {

class CgnsWriter {
 public:
  CgnsWriter(const std::filesystem::path& path, const std::filesystem::path& temporary, const Mesh& mesh)
      : path_(path), mesh_(mesh), groups_(mesh_groups(mesh, kCgnsLabels)) {
    check(cg_open(temporary.c_str(), CG_MODE_WRITE, &file_), "the file");
  }
  ~CgnsWriter() {
    if (file_ >= 0) cg_close(file_);
  }
  CgnsWriter(const CgnsWriter&) = delete;
  CgnsWriter& operator=(const CgnsWriter&) = delete;

  void write() {
    const bool planar = is_planar(mesh_);
    check(cg_base_write(file_, "Base", 2, planar ? 2 : 3, &base_), "the base");
    const auto n_elements = static_cast<cgsize_t>(mesh_.triangles.size() + mesh_.quads.size());
    const cgsize_t sizes[3] = {static_cast<cgsize_t>(mesh_.points.size()), n_elements, 0};
    check(cg_zone_write(file_, base_, "Zone1", sizes, CGNS_ENUMV(Unstructured), &zone_), "the zone");
    write_coordinates(planar ? 2 : 3);
    for (const MeshGroup& group : groups_)
      if (group.dim == 2) write_elements(group);
    for (const MeshGroup& group : groups_)
      if (group.dim == 1) write_lines(group);
    for (const MeshGroup& group : groups_)
      if (group.dim == 0) write_points(group);
    const int closed = cg_close(file_);
    file_ = -1;
    check(closed, "the end of the file");
  }

 private:
  void check(int error, const char* what) const {
    require_written(error == CG_OK, path_, "the CGNS library", what);
  }

  void write_coordinates(int dimensions) {
    constexpr std::array kNames = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (int k = 0; k < dimensions; ++k) {
      std::vector<double> values;
      for (const Vec3& p : mesh_.points) values.push_back(k == 0 ? p.x : k == 1 ? p.y : p.z);
      int index = 0;
      check(cg_coord_write(file_, base_, zone_, CGNS_ENUMV(RealDouble), kNames[k], values.data(), &index),
            "coordinates");
    }
  }

  /// Returns the range of numbers that the elements got.
  std::array<cgsize_t, 2> write_section(const std::string& name, CGNS_ENUMT(ElementType_t) type,
                                        cgsize_t count, const std::vector<cgsize_t>& nodes) {
    require_fits(path_, "CGNS", nodes.size(), "nodes of elements", std::numeric_limits<cgsize_t>::max());
    const std::array<cgsize_t, 2> range{next_, next_ + count - 1};
    int index = 0;
    check(cg_section_write(file_, base_, zone_, name.c_str(), type, range[0], range[1], 0, nodes.data(),
                           &index),
          "elements");
    next_ += count;
    return range;
  }

  void write_elements(const MeshGroup& group) {
    const auto n_triangles = mesh_.triangles.size();
    const std::vector<int> places = gmsh_places(mesh_.order);
    std::vector<cgsize_t> triangles, quads;
    cgsize_t count[2] = {0, 0};
    for (const int e : group.items) {
      const auto add = [](const auto& of_element, std::vector<cgsize_t>& nodes) {
        for (const int v : of_element) nodes.push_back(v + 1);
      };
      const auto i = static_cast<std::size_t>(e);
      ++count[i < n_triangles ? 0 : 1];
      if (i < n_triangles)
        add(mesh_.triangles[i], triangles);
      else
        add(nodes_of_quad(mesh_, i - n_triangles, places), quads);
    }
    if (count[0] > 0)
      write_section(count[1] > 0 ? group.label + "_tri" : group.label, CGNS_ENUMV(TRI_3), count[0],
                    triangles);
    if (count[1] > 0)
      write_section(group.label, mesh_.order == 2 ? CGNS_ENUMV(QUAD_9) : CGNS_ENUMV(QUAD_4), count[1], quads);
  }

  /// Lines, and a boundary condition on them.
  void write_lines(const MeshGroup& group) {
    std::vector<cgsize_t> nodes;
    for (const int l : group.items)
      for (const int v : nodes_ends_first(mesh_, static_cast<std::size_t>(l))) nodes.push_back(v + 1);
    const std::string name = of_other_name(group.label);
    const auto range = write_section(name, mesh_.order == 2 ? CGNS_ENUMV(BAR_3) : CGNS_ENUMV(BAR_2),
                                     static_cast<cgsize_t>(group.items.size()), nodes);
    int index = 0;
    check(cg_boco_write(file_, base_, zone_, name.c_str(), CGNS_ENUMV(BCTypeUserDefined),
                        CGNS_ENUMV(PointRange), 2, range.data(), &index),
          "a boundary condition");
    check(cg_boco_gridlocation_write(file_, base_, zone_, index, CGNS_ENUMV(EdgeCenter)),
          "a boundary condition");
  }

  void write_points(const MeshGroup& group) {
    std::vector<cgsize_t> nodes;
    for (const int v : group.items) nodes.push_back(v + 1);
    int index = 0;
    check(
        cg_boco_write(file_, base_, zone_, of_other_name(group.label).c_str(), CGNS_ENUMV(BCTypeUserDefined),
                      CGNS_ENUMV(PointList), static_cast<cgsize_t>(nodes.size()), nodes.data(), &index),
        "a point");
  }

  /// Sections have names of their own.
  std::string of_other_name(const std::string& label) const {
    const bool taken =
        std::ranges::any_of(groups_, [&](const MeshGroup& g) { return g.dim == 2 && g.label == label; });
    return taken ? label + "_curve" : label;
  }

  const std::filesystem::path& path_;
  const Mesh& mesh_;
  const std::vector<MeshGroup> groups_;
  int file_ = -1, base_ = 0, zone_ = 0;
  cgsize_t next_ = 1;
};

/// CGNS: one zone, a section for each name of regions and curves, boundary conditions on curves and points.
void write_cgns(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(
      path, [&](const std::filesystem::path& temporary) { CgnsWriter(path, temporary, mesh).write(); });
}

}  // namespace

#endif

MeshFormat cgns_format() {
  MeshFormat format{
      .extensions = {".cgns"},
      .description = "CGNS",
      .most_order = 2,
      .package = "libcgns-dev",
      .renamed = [](const Mesh& mesh) { return renamed_groups(mesh_groups(mesh, kCgnsLabels)); }};
#ifdef DELQUAD_HAS_CGNS
  format.write = write_by<write_cgns>, format.package = "";
#endif
  return format;
}

}  // namespace delquad
