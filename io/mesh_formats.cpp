// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "base/utf8.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/split_polygon.h"
#include "io/cell_view.h"
#include "io/picture.h"

namespace delquad {

namespace {

void write_picture(const std::filesystem::path& path, const Mesh& mesh) {
  draw_mesh(path, mesh, path.stem().string());
}

MeshFormat svg_format() {
  return {.extensions = {".svg"},
          .description = "a picture",
          .write = write_by<write_picture>,
          .most_order = kMostOrder,
          .names = 0};
}

Mesh with_utf8(Mesh mesh) {
  const auto convert = [](Entity& entity) {
    for (std::string& name : entity.names) name = as_utf8(name);
  };
  for (auto* entities : {&mesh.curves, &mesh.regions, &mesh.volumes})
    std::ranges::for_each(*entities, convert);
  for (NamedPoint& point : mesh.named_points) convert(point.entity);
  return mesh;
}

/// kind_of_file() looks behind .gz, but nothing is written packed.
std::string kind_to_write(const std::filesystem::path& path) {
  const std::string kind = kind_of_file(path);
  return kind_of_file("x" + path.extension().string()) == kind ? kind : ".gz";
}

const MeshFormat* find_format(const std::string& kind) {
  for (const MeshFormat& format : mesh_formats())
    if (std::ranges::find(format.extensions, kind) != format.extensions.end()) return &format;
  return nullptr;
}

/// ".msh, .vtu or .obj": the first extension of all formats that can do it.
template <class Can>
std::string extensions_of(const Can& can) {
  std::vector<std::string> all;
  for (const MeshFormat& format : mesh_formats())
    if (can(format)) all.push_back(format.extensions[0]);
  if (all.size() < 2) return fmt::format("{}", fmt::join(all, ""));
  const std::string last = all.back();
  all.pop_back();
  return fmt::format("{} or {}", fmt::join(all, ", "), last);
}

/// Kinds of pictures that no writer has.
constexpr const char* kPictures[] = {".png", ".jpg", ".jpeg", ".gif", ".pdf", ".webp"};

[[noreturn]] void unknown(const std::filesystem::path& path, const std::string& known) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(path.string() + ": " + cannot_be_read("it is a folder"));
  std::vector<std::string> kinds;
  for (const MeshFormat& format : mesh_formats()) kinds.push_back(format.extensions[0]);
  const std::string kind = path.extension().string();
  const bool is_slip = std::ranges::find(kinds, kind) == kinds.end();
  const bool is_picture = std::ranges::count(kPictures, kind) > 0;
  refuse("{}: unknown kind of mesh file '{}': expected {}{} [unknown-format]", path.string(), kind, known,
         is_picture ? "; a picture is written as .svg, and a page by 'delquad view'"
         : is_slip  ? suggestion(kind, kinds)
                    : "");
}

}  // namespace

bool can_write(const MeshFormat& format) { return format.write != nullptr || !format.package.empty(); }

MeshFormat msh_format(), vtu_format(), obj_format(), inp_format(), medit_format(), vtk_format(),
    exodus_format(), cgns_format(), med_format(), xdmf_format(), mfem_format(), su2_format(),
    nastran_format(), unv_format(), ls_dyna_format(), sms_format(), gr3_format(), ugrid_format(),
    aflr_format(), ism_format(), hohqmesh_abaqus_format(), re2_format(), specfem_format(), foam_format(),
    off_format(), stl_format(), ply_format(), three_mf_format();

const std::vector<MeshFormat>& mesh_formats() {
  static const std::vector<MeshFormat> all = [] {
    std::vector<MeshFormat> formats;
    for (auto* const make : {msh_format,      vtu_format,     obj_format,
                             inp_format,      medit_format,   vtk_format,
                             exodus_format,   cgns_format,    med_format,
                             xdmf_format,     mfem_format,    su2_format,
                             nastran_format,  unv_format,     ls_dyna_format,
                             sms_format,      gr3_format,     ugrid_format,
                             aflr_format,     ism_format,     hohqmesh_abaqus_format,
                             re2_format,      specfem_format, foam_format,
                             off_format,      stl_format,     ply_format,
                             three_mf_format, svg_format})
      formats.push_back(make());
    return formats;
  }();
  return all;
}

Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes) {
  return read_mesh(path, notes, Strays::kRefused);
}

Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  const MeshFormat* format = find_format(kind_of_file(path));
  if (format == nullptr || format->read == nullptr)
    unknown(path, extensions_of([](const MeshFormat& f) { return f.read != nullptr; }));
  Mesh mesh = with_utf8(format->read(path, notes, strays));
  located(path.string(), [&] { complete_faces(mesh, notes); });
  return mesh;
}

Mesh read_given_mesh(const std::filesystem::path& path, ReadNotes* notes) {
  const MeshFormat* format = find_format(kind_of_file(path));
  if (format == nullptr || format->read_given == nullptr) return read_mesh(path, notes);
  return with_utf8(format->read_given(path, notes));
}

bool keeps_file(const std::filesystem::path& source, const std::filesystem::path& path) {
  const MeshFormat* format = find_format(kind_of_file(source));
  return format != nullptr && format->rewrite != nullptr && format == find_format(kind_to_write(path));
}

void rewrite_mesh(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                  double weld) {
  find_format(kind_to_write(path))->rewrite(source, path, mesh, weld);
}

MshOptions options_for_source(const std::filesystem::path& source, MshOptions options) {
  if (const MeshFormat* format = find_format(kind_of_file(source)); format != nullptr && format->has_shells)
    options.element = kShell;
  return options;
}

std::string ignored_keywords(const std::filesystem::path& path, const std::map<std::string, int>& carried) {
  const MeshFormat* format = find_format(kind_of_file(path));
  if (format == nullptr || format->others == nullptr) return "";
  std::vector<std::string> others;
  for (auto [name, count] : format->others(path)) {
    if (const auto some = carried.find(name); some != carried.end()) count -= some->second;
    if (count > 0) others.push_back(fmt::format("{} ({})", name, count));
  }
  return fmt::format("{}", fmt::join(others, ", "));
}

std::vector<std::string> carry_sections(const std::filesystem::path& source,
                                        const std::filesystem::path& path, const Mesh& mesh) {
  const MeshFormat *from = find_format(kind_of_file(source)), *to = find_format(kind_to_write(path));
  ShellSections sections;
  if (from != nullptr && from->sections != nullptr && to->add_sections != nullptr)
    sections = from->sections(source);
  if (!sections.sections.empty()) to->add_sections(path, mesh, sections);
  if (const auto others = ignored_keywords(source, sections.carried); !others.empty())
    sections.lost.push_back("keywords and how many: " + others);
  return std::move(sections.lost);
}

void check_mesh_format(const std::filesystem::path& path, const MshOptions& options, int order,
                       bool has_quads, bool may_have_cells) {
  const std::string kind = kind_to_write(path);
  const MeshFormat* format = find_format(kind);
  if (format == nullptr || !can_write(*format)) unknown(path, extensions_of(can_write));
  if (!format->package.empty())
    refuse(
        "{}: this program was built without the library for '{}': install Debian's package {} "
        "and build it again [missing-library]",
        path.string(), kind, format->package);
  if (!format->has_faces && !may_have_cells)
    refuse("{}: '{}' holds volumes alone, and this is a mesh of faces: expected {}", path.string(), kind,
           extensions_of([](const MeshFormat& f) { return can_write(f) && f.has_faces; }));
  if (order > format->most_order)
    refuse("{}: '{}' has no elements of order {} here: expected {}", path.string(), kind, order,
           extensions_of([&](const MeshFormat& f) { return can_write(f) && f.most_order >= order; }));
  if (options.triangles && order > 1)
    refuse("{}: quads of order {} are not split into triangles: expected order 1 with --triangles",
           path.string(), order);
  if (has_quads && !options.triangles && std::ranges::count(format->of_triangles, kind) > 0)
    refuse("{}: '{}' has triangles only: add --triangles, which splits each quad in two [triangles-only]",
           path.string(), kind);
  for (const auto& [is_set, option] :
       {std::pair(options.binary, "--binary"), std::pair(options.is_msh22, "--msh-version")})
    if (is_set && !format->has_binary)
      refuse("{}: {} is for .msh, and this is '{}'", path.string(), option, kind);
}

std::vector<std::string> missing_in_file(const std::filesystem::path& path, const Mesh& mesh,
                                         bool gets_depths) {
  const MeshFormat* format = find_format(kind_to_write(path));
  const bool is_flat = std::ranges::all_of(mesh.points, [](const Vec3& p) { return p.z == 0; });
  bool is_open = false;
  for (const Entity& curve : mesh.curves)
    for (const std::string& name : curve.names) is_open |= name_contains(name, "open");
  std::vector<std::string> missing;
  if (format->has_depths && !gets_depths && is_flat)
    missing.push_back(fmt::format(
        "{}: all depths are 0: 'delquad mesh --depth FILE' takes the depths from a raster", path.string()));
  if (format->has_open_sides && !is_open)
    missing.push_back(
        fmt::format("{}: no side is open: where water comes and goes, give the side a name with 'open' in it",
                    path.string()));
  return missing;
}

void check_depths(const std::filesystem::path& path) {
  const MeshFormat* format = find_format(kind_to_write(path));
  if (format == nullptr || !format->has_depths)
    refuse("{}: no depths are written there: expected {}, or fort.14 of ADCIRC", path.string(),
           extensions_of([](const MeshFormat& f) { return f.has_depths; }));
}

void check_cell_format(const std::filesystem::path& path, const MshOptions& options, const Mesh& mesh) {
  const std::string kind = kind_to_write(path);
  const MeshFormat* format = find_format(kind);
  const auto can = [](const MeshFormat& f) { return f.has_cells; };
  if (format == nullptr) unknown(path, extensions_of(can));
  if (!can(*format))
    refuse("{}: '{}' is not written with cells of volumes here: expected {}", path.string(), kind,
           extensions_of(can));
  check_mesh_format(path, options, 1, false, true);
  if (!format->has_pyramids && !mesh.pyramids.empty())
    refuse(
        "{}: '{}' has no pyramids, and there are {} (the first at {}): expected {}, or cells without them "
        "(volume --cells tets)",
        path.string(), kind, mesh.pyramids.size(), show_point(mesh.points[mesh.pyramids[0][4]]),
        extensions_of([](const MeshFormat& f) { return f.has_cells && f.has_pyramids; }));
  if (options.element.empty()) return;
  if (kind != ".inp")
    refuse("{}: '{}' has no kinds of cells: expected .inp with --element", path.string(), kind);
  if (std::ranges::find(inp_cells(), options.element) == inp_cells().end())
    refuse("{}: unknown kind of cells '{}': expected one of {}{}", path.string(), options.element,
           fmt::join(inp_cells(), ", "), suggestion(options.element, inp_cells()));
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  if (!is_solid(mesh))
    check_mesh_format(path, options, mesh.order, !mesh.quads.empty());
  else
    check_cell_format(path, options, mesh);
  std::optional<Mesh> split;
  if (ReadNotes notes; options.triangles) split_quads(split.emplace(mesh), notes);
  find_format(kind_to_write(path))->write(path, split ? *split : mesh, options);
}

void check_serendipity(const std::filesystem::path& path, const MshOptions& options, int order) {
  check_mesh_format(path, options, order);
  if (order != 2)
    refuse(
        "{}: quads of 8 nodes have order 2, these have order {}: expected --order 2 with "
        "--serendipity",
        path.string(), order);
  const std::string kind = kind_to_write(path);
  const auto can = [](const MeshFormat& f) { return f.eight_nodes != EightNodes::kNever; };
  if (!can(*find_format(kind)))
    refuse("{}: '{}' has no quads of 8 nodes here: expected {}", path.string(), kind, extensions_of(can));
}

void write_serendipity(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  check_serendipity(path, options, mesh.order);
  const MeshFormat& format = *find_format(kind_to_write(path));
  if (format.eight_nodes == EightNodes::kAlways) return write_mesh(path, mesh, options);
  Mesh eight = mesh;  // a corner stands for each middle node, which so is no node any more
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) eight.quad_nodes[5 * q + 4] = mesh.quads[q][0];
  drop_unused_points(eight);
  format.write(path, eight, options);
}

int most_order_of(const std::filesystem::path& path) {
  check_mesh_format(path, {}, 1, false, true);
  return find_format(kind_to_write(path))->most_order;
}

Mesh straightened(Mesh mesh) {
  mesh.order = 1;
  mesh.line_nodes.clear();
  mesh.quad_nodes.clear();
  drop_unused_points(mesh);
  return mesh;
}

std::vector<std::string> unsupported_in_file(const std::filesystem::path& path, const Mesh& mesh) {
  const std::string kind = kind_to_write(path);
  std::vector<std::string> lost;
  if (const int most = most_order_of(path); mesh.order > most)
    lost.push_back(fmt::format("the order of the elements, {}: '{}' has {} at most, corners are written",
                               mesh.order, kind, most));
  const unsigned names = find_format(kind)->names;
  const auto add = [&](NameKinds which, const char* of, const std::set<std::string>& all) {
    if ((names & which) == 0 && !all.empty())
      lost.push_back(
          fmt::format("names of {}, which '{}' does not hold: {}", of, kind, fmt::join(all, ", ")));
  };
  // Beside cells volumes and faces take the places of regions and curves.
  const bool is_volume = is_solid(mesh);
  const std::vector<Entity>&cells = is_volume ? mesh.volumes : mesh.regions,
        &sides_of = is_volume ? mesh.regions : mesh.curves;
  const char *const of_cells = is_volume ? "volumes" : "regions", *const of_sides =
                                                                      is_volume ? "faces" : "curves";
  std::set<std::string> of_regions, of_points, inside, around;
  for (const Entity& region : cells) of_regions.insert(region.names.begin(), region.names.end());
  of_regions.erase("domain");  // whose model has no name for it
  for (const NamedPoint& point : mesh.named_points)
    of_points.insert(point.entity.names.begin(), point.entity.names.end());
  const CellSides sides(mesh);
  std::vector<int> entity_of = is_volume ? mesh.triangle_region : mesh.line_curve;
  if (is_volume) entity_of.insert(entity_of.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  for (std::size_t i = 0; i < entity_of.size(); ++i) {
    const std::vector<std::string>& names_of = sides_of[entity_of[i]].names;
    (sides.at(static_cast<int>(i)).size() > 1 ? inside : around).insert(names_of.begin(), names_of.end());
  }
  add(kRegionNames, of_cells, of_regions);
  add(kBoundaryNames, fmt::format("{} of the boundary", of_sides).c_str(), around);
  add(kInnerNames, fmt::format("{} inside", of_sides).c_str(), inside);
  add(kPointNames, "points", of_points);
  if ((names & kPeriodicPairs) == 0 && !(mesh.periodic.empty() && mesh.periodic_faces.empty()))
    lost.push_back(fmt::format("which nodes are images of others, which '{}' does not hold", kind));
  if ((names & kFurtherNames) != 0) return lost;
  const int dim_of_cells = dimension_of(mesh);
  for (const auto& [which, of, entities, dim] :
       {std::tuple(kRegionNames, of_cells, &cells, dim_of_cells),
        std::tuple(kBoundaryNames, of_sides, &sides_of, dim_of_cells - 1)}) {
    const std::vector<std::string> own = group_names(*entities, dim);
    std::set<std::string> further;
    for (std::size_t i = 0; i < own.size(); ++i)
      for (const std::string& name : (*entities)[i].names)
        if (std::ranges::find(own, name) == own.end()) further.insert(name);
    if ((names & which) != 0 && !further.empty())
      lost.push_back(fmt::format("names of {} that have others, too, of which '{}' holds one each: {}", of,
                                 kind, fmt::join(further, ", ")));
  }
  return lost;
}

std::vector<std::string> renamed_in_file(const std::filesystem::path& path, const Mesh& mesh) {
  const MeshFormat* format = find_format(kind_to_write(path));
  if (format == nullptr) return {};
  if (format->labels != nullptr) {
    std::vector<MeshGroup> groups = mesh_groups(mesh, *format->labels);
    if ((format->names & kPointNames) == 0)
      std::erase_if(groups, [](const MeshGroup& g) { return g.dim == 0; });
    return renamed_groups(groups);
  }
  const bool tells = format->renamed != nullptr && !is_solid(mesh);
  return tells ? format->renamed(mesh) : std::vector<std::string>();
}

}  // namespace delquad
