// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/boundary_chains.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// A patch of OpenFOAM: so many faces from one on.
struct FoamPatch {
  std::string name, type;
  std::size_t first, size;
  std::string neighbour = {};  ///< of a cyclic one
};

/// Sides of the boundary that get a patch. Both patches of a periodic pair have faces in the same order.
struct PatchSides {
  std::string name;
  std::vector<BoundarySide> sides = {};
  int image = -1;  ///< the patch of the images; -1: none
  bool is_image = false;
};

/// Patches by group, periodic ones by pair. If a curve has several images, the first is in the pair.
std::vector<PatchSides> sides_of_patches(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  std::vector<BoundarySide> all = boundary_sides(mesh, groups);
  std::map<std::array<int, 2>, BoundarySide> by_run;
  for (const BoundarySide& side : all) by_run[side.run] = side;
  std::ranges::stable_sort(all, {}, &BoundarySide::group);
  std::map<std::array<int, 2>, std::pair<BoundarySide, std::size_t>> image_of;  // side and pair, by run
  std::set<std::array<int, 2>> paired;
  for (std::size_t p = 0; p < mesh.periodic.size(); ++p) {
    std::map<int, int> image;
    for (const auto& [here, there] : mesh.periodic[p].nodes) image[there] = here;
    for (const BoundarySide& side : all) {
      const auto [a, b] = side.run;
      if (!image.contains(a) || !image.contains(b)) continue;
      const auto other = by_run.find({image[b], image[a]});
      if (other == by_run.end() || paired.contains(side.run) || paired.contains(other->first)) continue;
      image_of[side.run] = {other->second, p};
      paired.insert(side.run), paired.insert(other->first);
    }
  }
  std::map<std::pair<int, std::string>, std::size_t> known;  // by group, and motion of the pair
  std::vector<PatchSides> patches;
  std::set<std::string> taken;
  const auto patch_of = [&](const BoundarySide& side, const std::string& motion) {
    const auto [at, is_new] = known.try_emplace({side.group, motion}, patches.size());
    if (!is_new) return at->second;
    const std::string label = side.group < 0 ? "defaultFaces" : groups[side.group].label;
    std::string name = label;
    for (int k = 2; !taken.insert(name).second; ++k) name = fmt::format("{}_{}", label, k);
    patches.push_back({name});
    return at->second;
  };
  for (const BoundarySide& side : all) {
    const auto found = image_of.find(side.run);
    if (found == image_of.end()) {
      if (!paired.contains(side.run)) patches[patch_of(side, "")].sides.push_back(side);
      continue;
    }
    const auto& [other, p] = found->second;
    const std::string motion = fmt::format("{:.6g}", fmt::join(mesh.periodic[p].motion.matrix(), " "));
    const std::size_t from = patch_of(side, motion), to = patch_of(other, "to " + motion);
    patches[from].sides.push_back(side), patches[to].sides.push_back(other);
    patches[from].image = static_cast<int>(to), patches[to].image = static_cast<int>(from);
    patches[to].is_image = true;
  }
  return patches;
}

/// The lists of polyMesh.
struct FoamMesh {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;  ///< they look out of their owner
  std::vector<int> owner, neighbour;
  std::vector<FoamPatch> patches;
  std::map<std::string, std::vector<int>> zones;  ///< named faces inside

  void add(std::vector<int> face, int cell) {
    faces.push_back(std::move(face));
    owner.push_back(cell);
  }
  /// Begins a patch, whose faces are added next. A name that contains "wall" makes a wall.
  void begin_patch(const std::string& name, std::size_t size) {
    patches.push_back({name, name_contains(name, "wall") ? "wall" : "patch", faces.size(), size});
  }
};

/// A planar mesh one cell thick: the points of the plane, then the points of its copy above. The thickness is
/// the mean size of cells.
FoamMesh planar_foam(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  FoamMesh foam;
  const int above = static_cast<int>(mesh.points.size());
  const auto wall = [&](const std::array<int, 2>& run) {
    return std::vector{run[0], run[1], run[1] + above, run[0] + above};
  };
  // In OpenFOAM's order: by owner, then by neighbor.
  std::vector<std::pair<std::array<int, 2>, std::array<int, 2>>> inside;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> sides) {
    if (sides.size() > 1) inside.push_back({{sides[0].element, sides[1].element}, sides[0].run()});
  });
  std::ranges::sort(inside);
  const std::map<std::array<int, 2>, int> group_of = groups_of_lines(mesh, groups);
  for (const auto& [cells, run] : inside) {
    const auto [lo, hi] = std::minmax(run[0], run[1]);
    if (const auto group = group_of.find({lo, hi}); group != group_of.end())
      foam.zones[groups[group->second].label].push_back(static_cast<int>(foam.faces.size()));
    foam.add(wall(run), cells[0]), foam.neighbour.push_back(cells[1]);
  }
  const std::vector<PatchSides> sides = sides_of_patches(mesh, groups);
  for (const PatchSides& patch : sides) {
    foam.begin_patch(patch.name, patch.sides.size());
    if (patch.image >= 0)
      foam.patches.back().type = "cyclic", foam.patches.back().neighbour = sides[patch.image].name;
    for (const BoundarySide& side : patch.sides) {
      std::vector<int> face = wall(side.run);
      // A face and its image begin at the same node, and run round in opposite ways.
      if (patch.is_image) std::ranges::rotate(face, face.begin() + 1);
      foam.add(std::move(face), side.element);
    }
  }
  const std::size_t n_cells = mesh.triangles.size() + mesh.quads.size();
  foam.patches.push_back({"frontAndBack", "empty", foam.faces.size(), 2 * n_cells});
  double area = 0;
  for_each_element(mesh, [&](int e, const auto& v) {
    foam.add({v.rbegin(), v.rend()}, e);
    std::vector<int> front(v.begin(), v.end());
    for (int& i : front) i += above;
    foam.add(std::move(front), e);
    for (std::size_t k = 0; k < v.size(); ++k)
      area += cross(mesh.points[v[k]], mesh.points[v[(k + 1) % v.size()]]).z / 2;
  });
  foam.points = mesh.points;
  for (const Vec3& p : mesh.points)
    foam.points.push_back(p + Vec3{0, 0, std::sqrt(area / static_cast<double>(n_cells))});
  return foam;
}

/// Returns the nodes of a side, counterclockwise seen from outside.
std::vector<int> nodes_of(const Mesh& mesh, const CellSide& side) {
  const std::array<int, 4> nodes = solid_at(mesh, side.element).side(side.side);
  return {nodes.begin(), nodes.end() - (nodes[3] < 0 ? 1 : 0)};
}

/// Returns the index of the group of each triangle and quad, see side_key().
std::map<std::array<int, 4>, int> groups_of_faces(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  const std::vector<CellBlock> blocks = cell_blocks(mesh);
  std::map<std::array<int, 4>, int> group_of;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const CellBlock& cells : blocks)
      if (groups[g].dim == 2)
        for (const std::size_t i : items_in_block(groups[g], cells))
          group_of.emplace(side_key(cells.nodes(i)), static_cast<int>(g));
  return group_of;
}

/// Whether the cells are one layer between flat ends, across a coordinate axis: flow there has no third
/// dimension. `ends`: patches of faces named "... start" and "... end".
bool is_slice(const FoamMesh& foam, std::size_t n_cells, const std::vector<std::size_t>& ends) {
  std::size_t n_faces = 0;
  for (const std::size_t end : ends) n_faces += foam.patches[end].size;
  if (n_faces != 2 * n_cells) return false;
  for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    std::set<double> heights;
    for (const std::size_t end : ends)
      for (std::size_t k = 0; k < foam.patches[end].size && heights.size() < 3; ++k)
        for (const int v : foam.faces[foam.patches[end].first + k]) heights.insert(foam.points[v].*axis);
    if (heights.size() == 2) return true;
  }
  return false;
}

/// Named faces on the boundary are patches, named faces inside are zones.
FoamMesh solid_foam(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  const std::vector<SolidSide> sides = sorted_sides(mesh);
  const std::map<std::array<int, 4>, int> group_of = groups_of_faces(mesh, groups);
  std::vector<std::pair<std::array<int, 2>, const SolidSide*>> inside;  // by owner, then by neighbor
  std::map<int, std::vector<CellSide>> outside;                         // by group; -1: none
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i].nodes == sides[i + 1].nodes) {
      inside.push_back({{sides[i].side.element, sides[i + 1].side.element}, &sides[i]});
      ++i;
      continue;
    }
    const auto group = group_of.find(sides[i].nodes);
    outside[group == group_of.end() ? -1 : group->second].push_back(sides[i].side);
  }
  std::ranges::sort(inside, {}, [](const auto& face) { return face.first; });
  FoamMesh foam;
  foam.points = mesh.points;
  std::vector<std::size_t> ends;  // patches
  for (const auto& [cells, face] : inside) {
    if (const auto group = group_of.find(face->nodes); group != group_of.end())
      foam.zones[groups[group->second].label].push_back(static_cast<int>(foam.faces.size()));
    foam.add(nodes_of(mesh, face->side), cells[0]), foam.neighbour.push_back(cells[1]);
  }
  for (auto& [group, patch] : outside) {
    std::ranges::stable_sort(patch, {}, &CellSide::element);
    const std::string name = group < 0 ? "" : groups[group].name;
    if (name.ends_with(" start") || name.ends_with(" end")) ends.push_back(foam.patches.size());
    foam.begin_patch(group < 0 ? "defaultFaces" : groups[group].label, patch.size());
    for (const CellSide& side : patch) foam.add(nodes_of(mesh, side), side.element);
  }
  if (is_slice(foam, n_cells(mesh, 3), ends))
    for (const std::size_t end : ends) foam.patches[end].type = "empty";
  return foam;
}

template <class Items, class Write>
void write_foam_list(TextWriter& out, const Items& items, const Write& write) {
  out << items.size() << "\n(\n";
  for (const auto& item : items) write(item), out << '\n';
  out << ")\n";
}

/// The files of constant/polyMesh (OpenFOAM's user guide, "Mesh description"). All arguments must outlive
/// them.
std::vector<FileToWrite> foam_files(const std::filesystem::path& home, int dim,
                                    const std::vector<MeshGroup>& groups, const FoamMesh& foam) {
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
    write_foam_list(out, foam.points,
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
          << ";\n    startFace " << patch.first << ';';
      if (!patch.neighbour.empty())
        out << "\n    neighbourPatch " << patch.neighbour << ";\n    matchTolerance 0.0001;";
      out << "\n}";
    });
  });
  add("faceZones", "regIOobject", [&](TextWriter& out) {
    write_foam_list(out, foam.zones, [&](const auto& zone) {
      out << zone.first << "\n{\n    type faceZone;\n    faceLabels List<label> ";
      write_foam_list(out, zone.second, [&](int face) { out << face; });
      out << ";\n    flipMap List<bool> " << zone.second.size() << "{0};\n}";
    });
  });
  add("cellZones", "regIOobject", [&, dim](TextWriter& out) {
    std::vector<MeshGroup> regions = groups;
    std::erase_if(regions, [dim](const MeshGroup& group) { return group.dim != dim; });
    write_foam_list(out, regions, [&](const MeshGroup& region) {
      out << region.label << "\n{\n    type cellZone;\n    cellLabels List<label> ";
      write_foam_list(out, region.items, [&](int cell) { out << cell; });
      out << ";\n}";
    });
  });
  return files;
}

/// constant/polyMesh beside the file, which is the one that ParaView opens.
void write_foam(const std::filesystem::path& path, const Mesh& mesh) {
  const int dim = dimension_of(mesh);
  if (dim == 2) require_planar(path, "OpenFOAM's mesh of one cell's thickness", mesh);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {plain_label});
  const FoamMesh foam = dim == 2 ? planar_foam(mesh, groups) : solid_foam(mesh, groups);
  const std::filesystem::path constant = path.parent_path() / "constant", home = constant / "polyMesh";
  std::vector<FileToWrite> files = foam_files(home, dim, groups, foam);
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
          .description = "OpenFOAM: constant/polyMesh beside it, planar meshes one cell thick",
          .write = write_by<write_foam>,
          .has_cells = true,
          .labels = &kFoamLabels,
          .names = kRegionNames | kBoundaryNames | kInnerNames | kPeriodicPairs};
}

}  // namespace delquad
