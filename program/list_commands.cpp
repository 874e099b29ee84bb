// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <ostream>

#include "delquad/error.h"
#include "experiments/sweep/schema.h"
#include "geometry/cad/example_models.h"
#include "io/cases/case_keys.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "metrics/anisotropic_measures.h"
#include "metrics/judgement/criteria.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/result_records.h"
#include "program/commands.h"
#include "program/options.h"

namespace delquad {
namespace {

struct SchemaArguments {
  bool options = false, measures = false;
};

std::string measure_table_text() {
  std::vector<Metric> all(metric_registry().begin(), metric_registry().end());
  const auto add = [&](const std::vector<Metric>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(anisotropic_measures());
  add(criteria_metrics());
  for (const std::string& solver : solver_names()) add(metrics_of_solver(solver));
  add(columns_of_records());
  constexpr const char* kBetter[] = {"higher", "lower", "-"};
  std::string text = "| measure | unit | better | meaning |\n|---|---|---|---|\n";
  for (const Metric& metric : all)
    text += fmt::format("| `{}` | {} | {} | {} |\n", metric.key, metric.unit.empty() ? "-" : metric.unit,
                        kBetter[static_cast<int>(metric.better)], metric.source);
  return text;
}

int schema_command(const SchemaArguments& arguments) {
  fmt::print("{}", arguments.options    ? option_table_text()
                   : arguments.measures ? measure_table_text()
                                        : experiment_schema());
  return kDone;
}

int formats_command() {
  constexpr const char* kRow = "{:<18}{:<7}{:<8}{:<7}{}\n";
  fmt::print(kRow, "extension", "reads", "writes", "order", "what it is");
  for (const MeshFormat& format : mesh_formats()) {
    const bool written = can_write(format);
    std::string what = format.description;
    if (format.has_cells) what += format.has_faces ? "; volumes, too" : "; volumes alone";
    if (format.has_cells && !format.has_pyramids) what += " (no pyramids)";
    if (!format.package.empty())
      what += fmt::format(" (not in this program: install {} and build it again)", format.package);
    fmt::print(kRow, fmt::format("{}", fmt::join(format.extensions, " ")), format.read ? "yes" : "-",
               written ? "yes" : "-",
               !written                ? "-"
               : format.most_order > 1 ? fmt::format("1-{}", format.most_order)
                                       : "1",
               what);
  }
  return kDone;
}

struct ExampleArguments {
  std::string name;  ///< empty: none
  std::filesystem::path output;
  bool list = false;
};

CadFormat format_of(const std::filesystem::path& path) {
  const std::string extension = kind_of_file(path);
  if (extension == ".step" || extension == ".stp") return CadFormat::kStep;
  if (extension == ".brep") return CadFormat::kBrep;
  throw InputError(path.string() + ": unknown CAD format '" + extension + "'; known: .step, .stp, .brep");
}

int example_command(const ExampleArguments& arguments) {
  if (arguments.list) {
    for (const Example& example : example_models())
      fmt::print("{:<10} {}\n", example.name, example.description);
    return kDone;
  }
  if (arguments.name.empty()) throw InputError("example: expected a name, or --list to see all");
  check_example(arguments.name);
  if (arguments.output.empty()) throw InputError("example: expected -o and a CAD file to write");
  const CadFormat format = format_of(arguments.output);
  check_output(arguments.output);
  write_file_atomically(arguments.output,
                        [&](std::ostream& out) { write_example(arguments.name, format, out); });
  fmt::print("{}\n", arguments.output.string());
  return kDone;
}

}  // namespace

void add_lists(CLI::App& app, Commands& commands) {
  const auto [schema, arguments] =
      add_command(app, commands, "schema",
                  "Print the JSON Schema of experiment files, for editors and checkers", schema_command);
  CLI::Option* options = schema->add_flag("--options", arguments.options,
                                          "print the options of the stages as a table (Markdown) instead");
  schema->add_flag("--measures", arguments.measures, "print the measures as a table (Markdown) instead")
      ->excludes(options);
  commands.back().only_prints = [] { return true; };
  CLI::App* formats = app.add_subcommand(
      "formats", "List the kinds of mesh files: what is read, what is written, up to which order");
  commands.push_back({formats, formats_command});
}

void add_example(CLI::App& app, Commands& commands) {
  const auto [example, arguments] = add_command(
      app, commands, "example", "Write a CAD model that the program makes itself", example_command, true);
  CLI::Option* list = example->add_flag("--list", arguments.list, "names of the examples");
  example->add_option("name", arguments.name, "which one")->excludes(list);
  example->add_option("-o,--output", arguments.output, "CAD file to write (.step, .stp or .brep)")
      ->excludes(list);
  commands.back().only_prints = [&given = arguments] { return given.list; };
}

}  // namespace delquad
