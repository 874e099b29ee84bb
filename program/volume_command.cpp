// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/context.h"
#include "base/located.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/hexahedra.h"
#include "experiments/console/progress.h"
#include "geometry/mesh/cell_shapes.h"
#include "io/cases/case_file.h"
#include "io/entity_names.h"
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
  std::string layers;  ///< "FIRST,GROWTH,NUMBER"; empty: none
  std::vector<std::string> layers_on;
};

std::optional<LayerSpec> read_layers(const VolumeArguments& arguments) {
  if (arguments.layers.empty()) {
    if (!arguments.layers_on.empty()) throw InputError("--layers-on goes with --layers only");
    return {};
  }
  const auto numbers = read_list("--layers", arguments.layers, 3, "0.1,1.2,5: first height, growth, number");
  if (const double number = numbers[2]; !(number >= 1 && number < 1e9) || number != std::floor(number))
    refuse("--layers: {} layers: expected a whole number from 1", number);
  return LayerSpec{.on = arguments.layers_on,
                   .first = numbers[0],
                   .growth = numbers[1],
                   .number = static_cast<int>(numbers[2]),
                   .where = "--layers"};
}

bool has_curved_cells(const VolumeArguments& arguments) {
  return arguments.volume.cells == VolumeCells::kTets && has_middle_nodes(arguments.msh.element);
}

/// Returns the quads of the model, and tells warnings.
Mesh mesh_skin(const VolumeArguments& arguments, const std::optional<LayerSpec>& layers, Progress& progress) {
  Case c = read_model_case(arguments.model);
  set_problem(arguments, c);
  if (has_curved_cells(arguments))
    c.order = 2;
  else if (c.order > 1)
    refuse("--order {}: volumes have cells of order 1: expected 1, or --cells tets --element C3D10", c.order);
  const auto make = [&](const Case& of) {
    return mesh(of, arguments.pipeline.value_or(arguments.quality),
                {.progress = [&](const ProgressReport& report) { progress.step(report.stage); }});
  };
  MeshResult result = make(c);
  if (layers && !layers->on.empty() && c.layers.empty()) {
    Case layered = c;
    layered.layers = {layers_beside(*layers, result.mesh)};
    try {
      if (!layered.layers[0].on.empty()) result = make(layered);
    } catch (const InputError& error) {
      progress.message(
          fmt::format("note: layers end by prisms at other faces, which get none: {}", error.what()));
    }
  }
  progress.warn(result.warnings);
  return std::move(result.mesh);
}

/// Cells below this scaled Jacobian slow solvers down, or stop them.
constexpr double kPoorJacobian = 0.02;

void warn_of_poor_cells(const Mesh& cells, const CellMeasures& measures, bool has_layers,
                        Progress& progress) {
  const auto n = std::ranges::count_if(measures.jacobian, [](double j) { return j < kPoorJacobian; });
  if (n == 0) return;
  const std::size_t worst = std::ranges::min_element(measures.jacobian) - measures.jacobian.begin();
  progress.message(fmt::format(
      "warning: the scaled Jacobian is below {} in {}, the least {:.2g} at {}: the quads there "
      "are flat or long: try another size{}",
      kPoorJacobian, counted(n, "cell"), measures.jacobian[worst],
      show_point(cells.points[solid_at(cells, worst).nodes[0]]), has_layers ? ", or lower layers" : ""));
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
  VolumeOptions options = arguments.volume;
  options.max_elements = arguments.max_elements;
  options.layers = read_layers(arguments);
  const Mesh skin = arguments.from.empty() ? mesh_skin(arguments, options.layers, progress)
                                           : read_mesh(arguments.from, &notes);
  if (skin.order == 2 && !has_curved_cells(arguments))
    refuse("{}: the skin has order 2: expected --cells tets --element C3D10, or quads of order 1", name);
  if (has_curved_cells(arguments))
    notes.push_back(skin.order == 2 ? "volumes and Jacobians count straight cells"
                                    : "the skin has order 1: middle nodes lie on straight edges");
  const Mesh cells = located(name, [&] { return fill_skin(skin, options, &notes); });
  for (const std::string& lost : renamed_in_file(arguments.output, cells))
    notes.push_back(arguments.output.string() + " cannot hold all names as they are: " + lost);
  for (const std::string& note : notes) progress.message("note: " + note);
  const CellMeasures measures = measure(cells);
  warn_of_poor_cells(cells, measures, options.layers.has_value(), progress);
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
  volume->add_option("--layers", arguments.layers,
                     "FIRST,GROWTH,NUMBER: layers of hexahedra on faces: first height, growth, number");
  volume
      ->add_option("--layers-on", arguments.layers_on,
                   "name of faces with layers; may be repeated; default: all")
      ->allow_extra_args(false);
  add_msh_file(*volume, arguments.msh);
  volume->add_option("--element", arguments.msh.element,
                     "of .inp: C3D4, C3D10 with middle nodes on the model, DC3D4, DC3D10, or of hexahedra");
  volume->add_option("--json", arguments.json, "record to write");
  add_max_elements(*volume, arguments.max_elements, "refuse to make more cells than this");
  add_threads(*volume, arguments.threads);
}

}  // namespace delquad
