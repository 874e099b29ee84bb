#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "io/cases/case.h"
#include "io/mesh_io.h"

namespace delquad {

/// How the faces of surfaces are made.
struct SurfaceArguments {
  std::string compound, unit;  ///< empty: as the model says
  std::optional<double> feature_angle, weld_tolerance;
  std::optional<double> ignore_below, fill_holes;  ///< lengths
  std::optional<double> simplify;                  ///< sizes
  bool idealize = false;
  std::vector<std::string> keep;  ///< names
  bool glue = false;              ///< else as the model says
  bool keep_going = false;        ///< leave out what cannot be read or meshed
};
void add_surface(CLI::App& command, SurfaceArguments& arguments);
void set_surface(const SurfaceArguments& arguments, Case& c);

struct MeshArguments : SurfaceArguments {
  bool improve = false;  ///< the model is a mesh that words begin from
  std::filesystem::path model, output, json;
  std::optional<std::string> size;                        ///< else as the model says
  std::string metric;                                     ///< empty: as the model says
  std::string cross;                                      ///< empty: as the model says
  std::optional<int> order;                               ///< of the elements; else as the model says
  bool serendipity = false;                               ///< quads of order 2 have 8 nodes
  bool keep_numbers = false;                              ///< of nodes, as stages made them
  std::vector<std::string> mapped;                        ///< names of regions, or "auto"
  std::vector<std::string> washers, fillet_rows;          ///< "LEAST-MOST:ROWS..."
  std::vector<std::string> size_on;                       ///< "NAME=SIZE"
  std::vector<std::string> set;                           ///< "OPTION=VALUE", see Options
  double curvature = 0, min = 0, max = 0, gradation = 0;  ///< as in SizeSpec; 0: as the model says
  std::optional<double> refine;                           ///< else as the model says
  std::optional<long long> quads;                         ///< so, too
  std::string quality = kDefaultQuality;
  std::optional<std::string> pipeline;  ///< else the word of that quality
  long long max_elements = 50'000'000;
  int threads = thread_count();
  bool view = false;  ///< show the mesh, too
  bool allow_triangles = false;
  bool allow_unsound = false;
  std::optional<double> min_angle, max_aspect;  ///< options limits.min_angle, limits.max_aspect
  std::string criteria;                         ///< a preset or file; empty: as the model says
  bool strict = false, failing_sets = false;
  MshOptions msh{false, MshCurves::kNamed};
};
/// `--binary` and `--curves`.
void add_msh(CLI::App& command, MshOptions& msh);
CLI::App* add_mesh_options(CLI::App& app, MeshArguments& arguments);
CLI::App* add_improve_options(CLI::App& app, MeshArguments& arguments);
/// Size, directions, grids and options as the command line says, in place of what the model says.
void set_problem(const MeshArguments& arguments, Case& c);

}  // namespace delquad
