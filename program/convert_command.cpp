// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "delquad/error.h"
#include "experiments/console/progress.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/split_polygon.h"
#include "geometry/mesh/weld.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/mesh_options.h"
#include "program/options.h"

namespace delquad {
namespace {

struct ConvertArguments {
  std::filesystem::path mesh, output;
  double weld = 0;  ///< part of the diagonal
  MshOptions msh;
};

bool holds_fields(const std::filesystem::path& path) {
  return kind_of_file(path) == ".msh" || kind_of_file(path) == ".vtu";
}

/// The mesh with its fields, but for the quality of quads, which files of VTK have of any mesh. `lost` learns
/// why there are none of it.
MeshWithFields read_whole(const std::filesystem::path& path, ReadNotes& notes,
                          std::vector<std::string>& lost) {
  MeshWithFields whole = {read_mesh(path, &notes), {}};
  if (!holds_fields(path)) return whole;
  try {
    MeshWithFields read = read_fields(path);
    std::erase_if(read.fields, [](const MeshField& f) {
      return (f.name == "eta" || f.name == "scaled Jacobian") && !f.is_of_points;
    });
    if (!read.fields.empty()) return read;
  } catch (const InputError& error) {
    lost.push_back(fmt::format("fields: {}", error.what()));
  }
  return whole;
}

int convert_command(const ConvertArguments& arguments) {
  check_distinct({{"the mesh", arguments.mesh}, {"the other one", arguments.output}});
  check_mesh_format(arguments.output, arguments.msh, 1, false, true);
  check_triangles(arguments.mesh, arguments.output, arguments.msh);
  check_output(arguments.output);
  ReadNotes notes;
  std::vector<std::string> lost;
  const bool is_kept = keeps_file(arguments.mesh, arguments.output);
  auto [mesh, fields] =
      is_kept ? MeshWithFields{read_given_mesh(arguments.mesh), {}} : read_whole(arguments.mesh, notes, lost);
  if (!fields.empty() && (!holds_fields(arguments.output) || arguments.weld > 0 || arguments.msh.triangles)) {
    std::vector<std::string> names;
    for (const MeshField& field : fields) names.push_back(field.name);
    lost.push_back(fmt::format(
        "fields, which are written to .msh and .vtu alone, and not with --weld or --triangles: {}",
        fmt::join(names, ", ")));
    fields.clear();
    mesh = read_mesh(arguments.mesh);  // without points that carry fields alone
  }
  if (arguments.weld > 0) require_straight(mesh, arguments.mesh.string());
  std::string joined =
      arguments.weld > 0 ? weld_open_edges(mesh, arguments.weld * diagonal(mesh)) : describe_unjoined(mesh);
  if (!joined.empty()) notes.push_back(std::move(joined));
  for (const std::string& what : missing_in_file(arguments.output, mesh)) notes.push_back(what);
  if (!is_kept) {
    for (const std::string& what : unsupported_in_file(arguments.output, mesh)) lost.push_back(what);
    for (const std::string& name : renamed_in_file(arguments.output, mesh))
      lost.push_back("a name as it was: " + name);
  }
  if (mesh.order > most_order_of(arguments.output)) mesh = straightened(std::move(mesh));
  if (arguments.msh.triangles && mesh.order == 1) split_quads(mesh, notes);
  if (is_kept)
    rewrite_mesh(arguments.mesh, arguments.output, mesh, arguments.weld);
  else if (fields.empty())
    write_mesh(arguments.output, mesh, options_for_source(arguments.mesh, arguments.msh));
  else
    write_fields(arguments.output, mesh, fields, arguments.msh);
  if (!is_kept)
    for (std::string& what : carry_sections(arguments.mesh, arguments.output, mesh))
      lost.push_back(std::move(what));
  if (verbosity() != Verbosity::kQuiet) {
    for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
    for (const std::string& what : lost) fmt::print(stderr, "lost: {}\n", what);
  }
  fmt::print("{}: {}, {} lines, {} fields\n", arguments.output.string(), show_counts(mesh), mesh.lines.size(),
             fields.size());
  return kDone;
}

}  // namespace

void add_convert(CLI::App& app, Commands& commands) {
  const auto [convert, arguments] =
      add_command(app, commands, "convert",
                  "Write a mesh in another format, with names, order and fields; says what is lost",
                  convert_command, true);
  convert->add_option("mesh", arguments.mesh, "mesh file to read ('delquad formats' lists all)")->required();
  convert->add_option("output,-o,--output", arguments.output, "mesh file to write")->required();
  convert->add_option("--weld", arguments.weld, "join ends of open edges within this part of the diagonal")
      ->check(CLI::Range(0.0, 0.1));
  add_msh(*convert, arguments.msh);
}

}  // namespace delquad
