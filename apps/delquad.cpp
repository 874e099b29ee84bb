#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "apps/commands.h"
#include "mesh/error.h"
#include "pipeline/interrupt.h"

namespace {

using namespace delquad;

constexpr const char* kSizeHelp = "wanted edge length: a number, an expression in x, y, z, or 'boundary'";
constexpr const char* kMaxElementsHelp = "refuse sizes that ask for more quads than this";
constexpr const char* kAllowHelp = "exit with 0 although triangles are left among the quads";

void add_run(CLI::App& app, RunArguments& arguments) {
  CLI::App* run =
      app.add_subcommand("run", "Run an experiment: every pipeline on every case, with tables and pictures");
  run->add_option("experiment", arguments.experiment, "experiment file (.toml)")->required();
  run->add_option("-o,--output", arguments.folder, "folder for the results")->required();
  run->add_option("--pipelines", arguments.pipelines, "words such as F,D,FB,DB; else as the file says")
      ->delimiter(',');
  run->add_option("--max-elements", arguments.max_elements, kMaxElementsHelp)
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  run->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
}

void add_mesh(CLI::App& app, MeshArguments& arguments) {
  CLI::App* mesh = app.add_subcommand("mesh", "Mesh a planar model");
  mesh->add_option("model", arguments.model, "curves and loops (.toml) or line elements (.msh)")->required();
  mesh->add_option("-o,--output", arguments.output, "mesh to write (.msh, .vtu or .obj)")->required();
  mesh->add_option("--size", arguments.size, kSizeHelp);
  mesh->add_option("--cross", arguments.cross,
                   "directions: 'boundary', 'gradient' or an angle expression (radians)");
  mesh->add_option("--pipeline", arguments.pipeline, "letters of stages: F or D, then B")
      ->capture_default_str();
  mesh->add_option("--json", arguments.json, "record to write");
  mesh->add_option("--max-elements", arguments.max_elements, kMaxElementsHelp)
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  mesh->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
}

void add_metrics(CLI::App& app, MetricsArguments& arguments) {
  CLI::App* metrics = app.add_subcommand("metrics", "Measure a mesh");
  metrics->add_option("mesh", arguments.mesh, "mesh file")->required();
  metrics->add_option("--size", arguments.size, kSizeHelp);
  metrics->add_option("--json", arguments.json, "record to write");
}

int run_program(int argc, char** argv) {
  CLI::App app("Delquad: frontal Delaunay quad meshing in the L-infinity norm");
  app.require_subcommand(1);
  RunArguments run;
  MeshArguments mesh;
  MetricsArguments metrics;
  add_run(app, run);
  add_mesh(app, mesh);
  add_metrics(app, metrics);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  if (app.got_subcommand("run")) return run_command(run);
  if (app.got_subcommand("mesh")) return mesh_command(mesh);
  return metrics_command(metrics);
}

}  // namespace

int main(int argc, char** argv) {
  delquad::exit_on_interrupt();
  try {
    return run_program(argc, argv);
  } catch (const delquad::InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return delquad::kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "internal error: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
  }
  return delquad::kInternalError;
}
