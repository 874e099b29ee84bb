// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "base/context.h"
#include "base/located.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/hexahedra.h"
#include "experiments/console/progress.h"
#include "geometry/mesh/cell_shapes.h"
#include "io/cases/case_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/mesh_options.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

struct VolumeArguments : MeshArguments {
  std::filesystem::path from;  ///< file of a skin; empty: the skin of the model
  VolumeOptions volume;
};

/// Returns the quads of the model, and tells warnings.
Mesh mesh_skin(const VolumeArguments& arguments, Progress& progress) {
  Case c = read_model_case(arguments.model);
  set_problem(arguments, c);
  if (c.order > 1) refuse("--order {}: volumes have cells of order 1: expected 1", c.order);
  MeshResult result = mesh(std::move(c), arguments.pipeline.value_or(arguments.quality),
                           {.progress = [&](const ProgressReport& report) { progress.step(report.stage); }});
  progress.warn(result.warnings);
  return std::move(result.mesh);
}

/// Cells below this scaled Jacobian slow solvers down, or stop them.
constexpr double kPoorJacobian = 0.02;

void warn_of_poor_cells(const Mesh& cells, const CellMeasures& measures, Progress& progress) {
  const auto n = std::ranges::count_if(measures.jacobian, [](double j) { return j < kPoorJacobian; });
  if (n == 0) return;
  const std::size_t worst = std::ranges::min_element(measures.jacobian) - measures.jacobian.begin();
  progress.message(
      fmt::format("warning: the scaled Jacobian is below {} in {}, the least {:.2g} at {}: the quads there "
                  "are flat or long: try another size",
                  kPoorJacobian, counted(n, "cell"), measures.jacobian[worst],
                  show_point(cells.points[solid_at(cells, worst).nodes[0]])));
}

int volume_command(const VolumeArguments& arguments) {
  const Stopwatch command;
  const RunScope run({.threads = arguments.threads});
  check_cell_format(arguments.output, arguments.msh);
  if (arguments.model.empty() == arguments.from.empty())
    throw InputError("expected a model, or --from with a file of its quads");
  if (const VolumeOptions& options = arguments.volume;
      options.cells != VolumeCells::kHexDominant && options.strategy != VolumeOptions().strategy)
    refuse("--strategy {} goes with --cells hex-dominant only", options.strategy);
  check_distinct({{"the model", arguments.model},
                  {"--from", arguments.from},
                  {"-o", arguments.output},
                  {"--json", arguments.json}});
  check_output(arguments.output);
  if (!arguments.json.empty()) check_output(arguments.json);
  const std::string name = arguments.from.empty() ? arguments.model.string() : arguments.from.string();
  Progress progress;
  ReadNotes notes;
  const Mesh skin =
      arguments.from.empty() ? mesh_skin(arguments, progress) : read_mesh(arguments.from, &notes);
  VolumeOptions options = arguments.volume;
  options.max_elements = arguments.max_elements;
  const Mesh cells = located(name, [&] { return fill_skin(skin, options, &notes); });
  for (const std::string& lost : renamed_in_file(arguments.output, cells))
    notes.push_back(arguments.output.string() + " cannot hold all names as they are: " + lost);
  for (const std::string& note : notes) progress.message("note: " + note);
  const CellMeasures measures = measure(cells);
  warn_of_poor_cells(cells, measures, progress);
  write_mesh(arguments.output, cells, arguments.msh);
  if (!arguments.json.empty()) write_text_file(arguments.json, cells_record(name, cells, measures));
  progress.finish();
  fmt::print("{}: {} in {:.2f} s\n", arguments.output.string(), show_counts(cells), command.seconds());
  print_cells(cells, measures);
  print_names(cells);
  return kDone;
}

}  // namespace

void add_volume(CLI::App& app, Commands& commands) {
  const auto [volume, arguments] = add_command(
      app, commands, "volume", "Fill a closed model: hexahedra, pyramids, tetrahedra", volume_command, true);
  add_model(volume, arguments);
  CLI::Option* from =
      volume->add_option("--from", arguments.from, "fill these closed quads instead, which stay as they are");
  for (CLI::Option* of_model :
       volume->get_options([&](CLI::Option* o) { return o != from && !o->check_lname("help"); }))
    from->excludes(of_model);
  volume->add_option("-o,--output", arguments.output, "cells to write ('delquad formats' lists files)")
      ->required();
  volume->add_option_function<std::string>(
      "--cells", [&cells = arguments.volume.cells](const std::string& name) { cells = volume_cells(name); },
      "'hex-dominant' (the default) and 'pyramids-and-tets' keep the quads; 'tets' split each");
  volume->add_option_function<std::string>(
      "--strategy",
      [&strategy = arguments.volume.strategy](const std::string& text) { check_strategy(strategy = text); },
      "of hex-dominant: F or D (points), B (recombination), C (clean-up), O (optimization); default: DBCO");
  volume->add_flag("--binary", arguments.msh.binary, "write .msh as bytes");
  volume->add_option(
      "--element", arguments.msh.element,
      "of .inp: C3D4, C3D10 with nodes in the middle of edges, DC3D4, DC3D10, or of hexahedra");
  volume->add_option("--json", arguments.json, "record to write");
  add_max_elements(*volume, arguments.max_elements, "refuse to make more cells than this");
  add_threads(*volume, arguments.threads);
}

}  // namespace delquad
