#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "delquad/mesher.h"
#include "experiments/sweep/run_experiment.h"
#include "io/cases/case.h"
#include "io/mesh_io.h"

namespace delquad {

/// Exit codes of the program, besides those in interrupt.h.
inline constexpr int kDone = 0, kInternalError = 1, kRegression = 1, kBadInput = 2, kTrianglesLeft = 3,
                     kFacesLeftOut = 4, kUnsound = 5;

struct RunArguments {
  std::filesystem::path experiment, folder;
  std::filesystem::path data = kDataFolder;
  std::optional<std::string> pipelines;      ///< words separated by commas; else those of the file
  std::vector<std::filesystem::path> peers;  ///< files of further meshers, which are run, too
  long long max_elements = 50'000'000;
  int threads = 0;  ///< of each process; 0: the cores, shared out among the processes
  SweepOptions options;
  bool dry_run = false;  ///< only list the cells
  bool allow_triangles = false;
};
int run_command(const RunArguments& arguments);

struct TablesArguments {
  std::filesystem::path folder;
};
int tables_command(const TablesArguments& arguments);

struct ReportArguments {
  std::filesystem::path folder, output;
};
int report_command(const ReportArguments& arguments);

/// `options`: those of the stages as a table, in place of the schema.
int schema_command(bool options);

/// What kinds of mesh files there are.
int formats_command();

struct RerunArguments {
  std::filesystem::path record;
  std::filesystem::path data = kDataFolder;
};
int rerun_command(const RerunArguments& arguments);

struct VerifyArguments {
  std::filesystem::path folder;
  std::filesystem::path data = kDataFolder;
  int threads = thread_count();
};
int verify_command(const VerifyArguments& arguments);

struct MergeArguments {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path output;
};
int merge_command(const MergeArguments& arguments);

/// How the faces of surfaces are made.
struct SurfaceArguments {
  std::string compound, unit;  ///< empty: as the model says
  std::optional<double> feature_angle, weld_tolerance;
  std::optional<double> ignore_below;  ///< a length
  bool glue = false;                   ///< else as the model says
  bool keep_going = false;             ///< leave out what cannot be read or meshed
};
void set_surface(const SurfaceArguments& arguments, Case& c);

struct MeshArguments : SurfaceArguments {
  bool improve = false;  ///< the model is a mesh that words begin from
  std::filesystem::path model, output, json;
  std::optional<std::string> size;                        ///< else as the model says
  std::string cross;                                      ///< empty: as the model says
  std::optional<int> order;                               ///< of the elements; else as the model says
  bool serendipity = false;                               ///< quads of order 2 have 8 nodes
  bool keep_numbers = false;                              ///< of nodes, as stages made them
  std::vector<std::string> mapped;                        ///< names of regions, or "auto"
  std::vector<std::string> size_on;                       ///< "NAME=SIZE"
  std::vector<std::string> set;                           ///< "OPTION=VALUE", see Options
  double curvature = 0, min = 0, max = 0, gradation = 0;  ///< as in SizeSpec; 0: as the model says
  std::optional<double> refine;                           ///< else as the model says
  std::optional<long long> quads;                         ///< so, too
  std::string quality = kDefaultQuality;
  std::optional<std::string> pipeline;  ///< else the word of that quality
  long long max_elements = 50'000'000;
  int threads = thread_count();
  bool allow_triangles = false;
  bool allow_unsound = false;
  std::optional<double> min_angle, max_aspect;  ///< options limits.min_angle, limits.max_aspect
  MshOptions msh{false, MshCurves::kNamed};
};
int mesh_command(const MeshArguments& arguments);

struct MetricsArguments {
  std::vector<std::string> solvers = {};  ///< that are to measure it, too
  std::filesystem::path mesh, json;
  std::optional<std::string> size;
};
int metrics_command(const MetricsArguments& arguments);

struct ExtrudeArguments {
  std::filesystem::path mesh, output, json;
  std::string along, around, curve;  ///< as they were typed; empty: another way
  bool normals = false, both_sides = false;
  std::optional<double> angle, thickness;
  int layers = 0;  ///< 0: of a curve as many as it has segments
  double growth = 1;
  long long max_elements = 50'000'000;
  int threads = thread_count();
  bool binary = false;
};
int extrude_command(const ExtrudeArguments& arguments);

struct CompareArguments {
  std::filesystem::path before, after;  ///< folders of results, or meshes
  std::vector<std::string> metrics = {"eta_mean", "eta_worst", "d4", "tau", "percent_quads"};
  double tolerance = 0.01;  ///< part of a value by which it may change
};
int compare_command(const CompareArguments& arguments);

struct InfoArguments : SurfaceArguments {
  std::filesystem::path model, json, output;
  std::optional<std::string> size;
};
int info_command(const InfoArguments& arguments);

struct ExampleArguments {
  std::string name;  ///< empty: none
  std::filesystem::path output;
  bool list = false;
};
int example_command(const ExampleArguments& arguments);

struct SuiteArguments {
  std::filesystem::path folder;  ///< to write to, or with the results
  std::filesystem::path result;  ///< folder of a submission
};
int suite_models_command(const SuiteArguments& arguments);
int suite_add_command(const SuiteArguments& arguments);
int suite_table_command(const SuiteArguments& arguments);

/// Version, commit and compiler; with `all` the libraries, too.
void print_version(bool all);

}  // namespace delquad
