#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "io/boundary_chains.h"
#include "io/entity_names.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// A patch of OpenFOAM: so many faces from one on.
struct FoamPatch {
  std::string name, type;
  std::size_t first, size;
};

/// A mesh one cell thick: the points of the plane, then those of its copy above.
struct FoamMesh {
  double thickness = 0;                 ///< the mean size of cells
  std::vector<std::vector<int>> faces;  ///< they look out of their owner
  std::vector<int> owner, neighbour;
  std::vector<FoamPatch> patches;

  FoamMesh(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
    const int above = static_cast<int>(mesh.points.size());
    const auto add = [&](std::vector<int> face, int cell) {
      faces.push_back(std::move(face));
      owner.push_back(cell);
    };
    const auto wall = [&](const std::array<int, 2>& run) {
      return std::vector{run[0], run[1], run[1] + above, run[0] + above};
    };
    // In OpenFOAM's order: by owner, then by neighbour.
    std::vector<std::pair<std::array<int, 2>, std::array<int, 2>>> inside;
    for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> sides) {
      if (sides.size() > 1) inside.push_back({{sides[0].element, sides[1].element}, sides[0].run()});
    });
    std::ranges::sort(inside);
    for (const auto& [cells, run] : inside) add(wall(run), cells[0]), neighbour.push_back(cells[1]);
    std::vector<BoundarySide> sides = boundary_sides(mesh, groups);
    std::ranges::stable_sort(sides, {}, &BoundarySide::group);
    for (const BoundarySide& side : sides) {
      const std::string name = side.group < 0 ? "defaultFaces" : groups[side.group].label;
      if (patches.empty() || patches.back().name != name)
        patches.push_back({name, name_says(name, "wall") ? "wall" : "patch", faces.size(), 0});
      ++patches.back().size;
      add(wall(side.run), side.element);
    }
    patches.push_back({"frontAndBack", "empty", faces.size(), 0});
    double area = 0;
    for_each_element(mesh, [&](int e, const auto& v) {
      add({v.rbegin(), v.rend()}, e);
      std::vector<int> front(v.begin(), v.end());
      for (int& i : front) i += above;
      add(std::move(front), e);
      for (std::size_t k = 0; k < v.size(); ++k)
        area += cross(mesh.points[v[k]], mesh.points[v[(k + 1) % v.size()]]).z / 2;
    });
    patches.back().size = faces.size() - patches.back().first;
    thickness = std::sqrt(area / static_cast<double>(mesh.triangles.size() + mesh.quads.size()));
  }
};

template <class Items, class Write>
void write_foam_list(TextWriter& out, const Items& items, const Write& write) {
  out << items.size() << "\n(\n";
  for (const auto& item : items) write(item), out << '\n';
  out << ")\n";
}

/// constant/polyMesh beside the file (OpenFOAM's user guide, "Mesh description"); the file is what ParaView
/// opens.
void write_foam(const std::filesystem::path& path, const Mesh& mesh) {
  require_planar(path, "OpenFOAM's mesh of one cell's thickness", mesh);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {plain_label});
  const FoamMesh foam(mesh, groups);
  const std::filesystem::path constant = path.parent_path() / "constant", home = constant / "polyMesh";
  std::vector<FileToWrite> files;
  const auto add = [&](const std::string& name, const std::string& kind,
                       const std::function<void(TextWriter&)>& write) {
    files.push_back({home / name, as_text([=](TextWriter& out) {
                       out << "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " << kind
                           << ";\n    location \"constant/polyMesh\";\n    object " << name << ";\n}\n";
                       write(out);
                     })});
  };
  add("points", "vectorField", [&](TextWriter& out) {
    std::vector<Vec3> points = mesh.points;
    for (const Vec3& p : mesh.points) points.push_back(p + Vec3{0, 0, foam.thickness});
    write_foam_list(out, points,
                    [&](const Vec3& p) { out << '(' << p.x << ' ' << p.y << ' ' << p.z << ')'; });
  });
  add("faces", "faceList", [&](TextWriter& out) {
    write_foam_list(out, foam.faces, [&](const std::vector<int>& face) {
      out << face.size();
      for (std::size_t k = 0; k < face.size(); ++k) out << (k == 0 ? '(' : ' ') << face[k];
      out << ')';
    });
  });
  for (const auto& [name, cells] : {std::pair("owner", &foam.owner), {"neighbour", &foam.neighbour}})
    add(name, "labelList", [&out_cells = *cells](TextWriter& out) {
      write_foam_list(out, out_cells, [&](int cell) { out << cell; });
    });
  add("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
    write_foam_list(out, foam.patches, [&](const FoamPatch& patch) {
      out << patch.name << "\n{\n    type " << patch.type << ";\n    nFaces " << patch.size
          << ";\n    startFace " << patch.first << ";\n}";
    });
  });
  add("cellZones", "regIOobject", [&](TextWriter& out) {
    std::vector<MeshGroup> regions = groups;
    std::erase_if(regions, [](const MeshGroup& group) { return group.dim != 2; });
    write_foam_list(out, regions, [&](const MeshGroup& region) {
      out << region.label << "\n{\n    type cellZone;\n    cellLabels List<label> ";
      write_foam_list(out, region.items, [&](int cell) { out << cell; });
      out << ";\n}";
    });
  });
  files.push_back({path, [](std::ostream& out) { out << "quad mesh by Delquad\n"; }});
  std::error_code ignored;  // what is missing then is told by the first file
  std::filesystem::create_directory(constant, ignored);
  std::filesystem::create_directory(home, ignored);
  try {
    write_files_atomically(files);
  } catch (...) {
    for (const auto& folder : {home, constant})
      std::filesystem::remove(folder, ignored);  // where it is empty
    throw;
  }
}

constexpr UniqueLabels::Rules kFoamLabels{plain_label};

}  // namespace

MeshFormat foam_format() {
  return {.extensions = {".foam"},
          .description = "OpenFOAM: constant/polyMesh beside it, one cell thick",
          .write = write_by<write_foam>,
          .labels = &kFoamLabels,
          .names = kRegionNames | kBoundaryNames};
}

}  // namespace delquad
