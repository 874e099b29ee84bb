#include "delquad/extend.h"

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <optional>
#include <system_error>

#include "base/context.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/console/interrupt.h"
#include "experiments/console/progress.h"
#include "io/cases/case.h"
#include "io/cases/read_problem.h"
#include "metrics/solve/solver_metrics.h"
#include "program/commands.h"
#include "program/extrude_options.h"

namespace delquad {
namespace {

constexpr const char* kSizeHelp =
    "wanted edge length: a number, an expression in x, y, z, 'boundary', or FILE[:FIELD], a field of an .msh "
    "or .vtu file";
constexpr const char* kMaxElementsHelp = "refuse sizes that ask for more quads than this";
constexpr const char* kThreadsHelp =
    "threads, whatever their number the result is the same; default: all cores";
constexpr const char* kTimeLimitHelp =
    "seconds after which the program ends with exit code 1, saying at what, and without a file";
constexpr const char* kExitCodes =
    "Exit codes: 0: done. 1: internal error, or time is up (--time-limit), or something got worse (compare,\n"
    "rerun), or cells or measures failed (run). 2: bad input. 3: triangles are left among the quads, and "
    "written.\n"
    "4: faces were left out (--keep-going). 5: the mesh is not sound. 130: interrupted (Ctrl-C). 143: "
    "terminated.";
constexpr int kMostThreads = 1024;
constexpr const char* kUnsoundHelp =
    "write meshes that are not sound (inverted or folded quads, lost parts, ...), marked in the record";
constexpr const char* kAllowHelp = "exit with 0 although triangles are left among the quads";

/// A whole number, which may be written as 1e6.
const CLI::Validator kCount(
    [](std::string& text) -> std::string {
      constexpr double kMost = 1e15;  // far from overflow
      const auto count = as_number(text);
      if (!count || *count != std::floor(*count) || *count < 1 || *count > kMost)
        return "'" + text.substr(0, 40) +
               "': expected a whole number from 1 to 1e15, such as 50000000 or 1e6";
      text = std::to_string(static_cast<long long>(*count));
      return "";
    },
    "");

/// "i/n"
const CLI::Validator kShard(
    [](std::string& text) -> std::string {
      const auto slash = text.find('/');
      const auto index = as_number(text.substr(0, slash));
      const auto count = slash == std::string::npos ? std::nullopt : as_number(text.substr(slash + 1));
      constexpr double kMost = 1e6;
      const bool good = index && count && *index == std::floor(*index) && *count == std::floor(*count) &&
                        *index >= 0 && *index < *count && *count <= kMost;
      return good ? "" : "'" + text.substr(0, 40) + "': expected i/n with 0 <= i < n, such as 0/4";
    },
    "");

constexpr double kMostPerTurn = 1e6;
const CLI::Validator kLength(
    [](std::string& text) -> std::string {
      const auto value = as_number(text);
      const bool good = value && *value > 0 && std::isfinite(*value);
      return good ? "" : "'" + text.substr(0, 40) + "': expected a finite number > 0";
    },
    "");

/// What all commands have in common.
struct CommonArguments {
  bool quiet = false, all = false, version = false;
  double time_limit = 0;             ///< seconds; 0: none
  std::vector<std::string> help_of;  ///< command to explain
};

void add_common(CLI::App& app, CommonArguments& common) {
  // These may stand behind the command, too.
  app.fallthrough();
  CLI::Option* quiet = app.add_flag("-q,--quiet", common.quiet, "print nothing but errors");
  app.add_flag("-v,--verbose", common.all, "print all warnings, not the worst of each kind")->excludes(quiet);
  app.add_flag("--version", common.version, "print version, commit and compiler; with -v libraries, too");
  app.add_subcommand("help", "Explain the program or a command")
      ->add_option("command", common.help_of, "which one")
      ->expected(0, 1);
  app.footer(kExitCodes);
}

void add_time_limit(CLI::App& command, CommonArguments& common) {
  command.add_option("--time-limit", common.time_limit, kTimeLimitHelp)->check(kLength);
  command.footer(kExitCodes);
}

/// Keeps an empty text apart from none.
CLI::Option* add_size(CLI::App& command, std::optional<std::string>& size, const char* help) {
  return command.add_option_function<std::string>(
      "--size", [&size](const std::string& text) { size = text; }, help);
}

void add_data(CLI::App& command, std::filesystem::path& data) {
  command.add_option("--data", data, "folder of the models that cases call data")->capture_default_str();
}

void add_run(CLI::App& app, RunArguments& arguments) {
  CLI::App* run =
      app.add_subcommand("run", "Run an experiment: every pipeline on every case, with tables and pictures");
  run->add_option("experiment", arguments.experiment, "experiment file (.toml)")->required();
  run->add_option("-o,--output", arguments.folder, "folder for the results")->required();
  add_data(*run, arguments.data);
  run->add_option("--pipelines", arguments.pipelines, "words such as F,D,FB,DB; else as the file says");
  run->add_option("--peer", arguments.peers, "file of other meshers, which are run beside; may be repeated")
      ->allow_extra_args(false);
  run->add_option("--max-elements", arguments.max_elements, kMaxElementsHelp)
      ->capture_default_str()
      ->transform(kCount);
  run->add_option("--threads", arguments.threads,
                  "threads of each process; default: all cores, shared out among the processes")
      ->check(CLI::Range(1, kMostThreads));
  run->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  run->add_flag("--allow-unsound", arguments.options.allow_unsound, kUnsoundHelp);
  SweepOptions& sweep = arguments.options;
  run->add_option("-j,--jobs", sweep.limits.jobs, "cells at a time, each in a process of its own")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostThreads));
  run->add_option("--timeout", sweep.limits.seconds, "seconds after which a cell has failed")->check(kLength);
  run->add_option("--memory", sweep.limits.bytes,
                  "memory a cell may take, such as 500M or 4G; more, and it has failed")
      ->transform(CLI::AsSizeValue(false));
  static const std::map<std::string, bool> pictures = {{"none", false}, {"svg", true}};
  run->add_option("--pictures", sweep.pictures, "of fields and meshes: 'svg' (the default) or 'none'")
      ->transform(CLI::CheckedTransformer(pictures).description("none or svg"));
  run->add_flag("--force", sweep.force, "run cells again that are done");
  run->add_flag("--dry-run", arguments.dry_run, "list the cells, and which of them are done");
  run->add_option_function<std::string>(
         "--shard",
         [&sweep](const std::string& text) {
           const auto slash = text.find('/');
           sweep.shard = {std::stoul(text.substr(0, slash)), std::stoul(text.substr(slash + 1))};
         },
         "i/n: the i-th of n parts (from 0), for several runs on one folder")
      ->check(kShard);
}

/// Of commands that work on results that are there.
struct RecordsArguments {
  TablesArguments tables;
  RerunArguments rerun;
  VerifyArguments verify;
  MergeArguments merge;
};

void add_records(CLI::App& app, RecordsArguments& arguments) {
  CLI::App* table = app.add_subcommand("tables", "Make the tables of an experiment from its results");
  table->add_option("folder", arguments.tables.folder, "folder of 'delquad run'")->required();
  CLI::App* again = app.add_subcommand(
      "rerun", "Make a result again from its record: the same bytes, or what stands in their way");
  again->add_option("record", arguments.rerun.record, "record.json of a cell")->required();
  add_data(*again, arguments.rerun.data);
}

void add_care_of_records(CLI::App& app, RecordsArguments& arguments) {
  CLI::App* check = app.add_subcommand(
      "verify", "Check that results are as they were written; exit code 1 when something is not");
  check->add_option("folder", arguments.verify.folder, "folder of 'delquad run'")->required();
  add_data(*check, arguments.verify.data);
  check->add_option("-j,--jobs", arguments.verify.threads, "cells at a time; default: all cores")
      ->check(CLI::Range(1, kMostThreads));
  CLI::App* together = app.add_subcommand(
      "merge", "Put results of one experiment, made in several folders, together in a new one");
  together->add_option("folders", arguments.merge.folders, "folders of 'delquad run', which stay as they are")
      ->required()
      ->expected(2, -1);
  together->add_option("-o,--output", arguments.merge.output, "folder to make")->required();
}

void add_report(CLI::App& app, ReportArguments& arguments) {
  CLI::App* report = app.add_subcommand("report", "Make a page of results to look at in a browser");
  report->add_option("folder", arguments.folder, "folder of 'delquad run', or one that holds several")
      ->required();
  report->add_option("-o,--output", arguments.output, "file to write (.html)")->required();
}

void add_formats(CLI::App& app) {
  app.add_subcommand("formats",
                     "List the kinds of mesh files: what is read, what is written, up to which order");
}

void add_schema(CLI::App& app, bool& options) {
  CLI::App* schema =
      app.add_subcommand("schema", "Print the JSON Schema of experiment files, for editors and checkers");
  schema->add_flag("--options", options, "print the options of the stages as a table (Markdown) instead");
}

/// How the faces of surfaces are made.
void add_feature_angle(CLI::App& command, SurfaceArguments& arguments) {
  command.add_option(
      "--feature-angle", arguments.feature_angle,
      "degrees by which triangles must turn for a curve between them, and curves for a corner");
}

void add_surface(CLI::App& mesh, SurfaceArguments& arguments) {
  mesh.add_option("--compound", arguments.compound,
                  "faces of a surface to mesh as one: 'all' that hang together, or 'tangent' ones");
  add_feature_angle(mesh, arguments);
  mesh.add_option("--weld", arguments.weld_tolerance,
                  "join ends of open edges of a triangulation up to this part of its diagonal");
  mesh.add_option("--ignore-below", arguments.ignore_below,
                  "length: close smaller holes, join narrower faces to neighbours, shorter curves to points");
  mesh.add_flag("--glue", arguments.glue,
                "bodies of a CAD model that touch share faces, curves and nodes there");
  mesh.add_option("--unit", arguments.unit,
                  "of the lengths, of CAD (else mm) and 3MF: um, mm, cm, m, km, in or ft");
  mesh.add_flag("--keep-going", arguments.keep_going,
                "leave out what cannot be read or meshed, name it, do the rest and exit with 4");
}

void add_set(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option(
          "--set", arguments.set,
          "OPTION=VALUE, such as regularity.tolerance=5 ('delquad schema --options' lists all); may be "
          "repeated")
      ->allow_extra_args(false);
}

void add_sizes(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option("--size-max", arguments.max, "largest size")->check(kLength);
  mesh.add_option("--gradation", arguments.gradation,
                  "the most by which sizes grow per unit length; 0.3 with --curvature")
      ->check(kLength);
  mesh.add_option("--cross", arguments.cross,
                  "directions: 'boundary', 'size-aware', 'gradient' or an angle expression (radians)");
}

/// What comes out, and how.
void add_mesh_output(CLI::App& mesh, MeshArguments& arguments, CommonArguments& common) {
  mesh.add_option(
          "-o,--output", arguments.output,
          "mesh to write (.msh, .vtu, .inp, ...: 'delquad formats' lists all), or a picture of it (.svg)")
      ->required();
  mesh.add_option("--order", arguments.order,
                  "of the elements: 2 to 4 are curved along the model (.msh, .vtu; 2 also .inp)")
      ->check(CLI::Range(1, kMostOrder));
  mesh.add_flag("--serendipity", arguments.serendipity,
                "with --order 2: quads of 8 nodes, without a middle one, in .msh and .vtu, too");
  mesh.add_option("--json", arguments.json, "record to write");
  mesh.add_option("--max-elements", arguments.max_elements, kMaxElementsHelp)
      ->capture_default_str()
      ->transform(kCount);
  mesh.add_option("--threads", arguments.threads, kThreadsHelp)->check(CLI::Range(1, kMostThreads));
  mesh.add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  mesh.add_flag("--binary", arguments.msh.binary, "write .msh as bytes");
  static const std::map<std::string, MshCurves> curves = {
      {"all", MshCurves::kAll}, {"named", MshCurves::kNamed}, {"boundary", MshCurves::kBoundary}};
  mesh.add_option("--curves", arguments.msh.curves,
                  "line elements in .msh: 'boundary' of the mesh only, also those inside it that are 'named' "
                  "(the default), or 'all'; deal.II takes none inside")
      ->transform(CLI::CheckedTransformer(curves).description("all, boundary or named"));
  mesh.add_flag("--keep-numbers", arguments.keep_numbers,
                "do not number the nodes anew for a small bandwidth");
  mesh.add_flag("--allow-unsound", arguments.allow_unsound, kUnsoundHelp);
  mesh.add_option("--min-angle", arguments.min_angle,
                  "degrees: an element with a smaller angle is an error (exit code 5)");
  mesh.add_option(
      "--max-aspect", arguments.max_aspect,
      "an element whose longest side is longer than this times its shortest is an error, but in layers");
  add_time_limit(mesh, common);
}

void add_mesh(CLI::App& app, MeshArguments& arguments, CommonArguments& common) {
  CLI::App* mesh = app.add_subcommand("mesh", "Mesh a planar domain or a surface");
  mesh->add_option(
          "model", arguments.model,
          "a model file (.toml), lines or triangles (.msh), triangles (.stl, .obj, .off, .ply, .3mf) or CAD "
          "(.step, .stp, .iges, .igs, .brep)")
      ->required();
  add_size(*mesh, arguments.size, kSizeHelp);
  mesh->add_option("--size-on", arguments.size_on,
                   "NAME=SIZE: at most this size on and in what has the name; may be repeated")
      ->allow_extra_args(false);
  mesh->add_option(
          "--mapped", arguments.mapped,
          "name of a region or face that becomes a grid, or 'auto' for all where that pays; may be repeated")
      ->allow_extra_args(false);
  mesh->add_option("--refine", arguments.refine, "divide all sizes by this, for studies of convergence")
      ->check(kLength);
  mesh->add_option("--quads", arguments.quads,
                   "about how many, by sizes that are all larger or smaller; no --size is needed then")
      ->transform(kCount);
  mesh->add_option("--curvature", arguments.curvature,
                   "of surfaces: elements per full turn of a curved face or curve")
      ->check(CLI::Range(kLeastPerTurn, kMostPerTurn));
  mesh->add_option("--size-min", arguments.min, "least size by curvature; default: 1/20 of --size")
      ->check(kLength);
  add_sizes(*mesh, arguments);
  add_surface(*mesh, arguments);
  std::string qualities;
  for (const Quality& q : quality_registry())
    qualities += (qualities.empty() ? "" : ", ") + q.name + " (" + q.word + ", cross " +
                 text_of(CrossSpec{.kind = q.cross}) + ")";
  CLI::Option* quality =
      mesh->add_option("--quality", arguments.quality, "time against quality: " + qualities)
          ->capture_default_str();
  mesh->add_option("--pipeline", arguments.pipeline,
                   "instead: letters of stages: F, D or P, then perhaps L, then B, then perhaps C, Q and O")
      ->excludes(quality);
  add_set(*mesh, arguments);
  add_mesh_output(*mesh, arguments, common);
}

void add_improve(CLI::App& app, MeshArguments& arguments, CommonArguments& common) {
  arguments.improve = true;
  CLI::App* improve =
      app.add_subcommand("improve", "Make a mesh better that is there already, on its own boundary");
  improve
      ->add_option("mesh", arguments.model,
                   "triangles, quads or both (.msh, .vtu, .inp, .mesh, .obj, .off, .stl, .ply, .3mf)")
      ->required();
  add_size(*improve, arguments.size, kSizeHelp)->default_str("what the mesh has");
  add_sizes(*improve, arguments);
  improve->add_option(
      "--pipeline", arguments.pipeline,
      "letters of stages: L, then B, G or T, of triangles; C, Q and O of quads; default: CO, or "
      "BCO of triangles alone");
  add_set(*improve, arguments);
  add_feature_angle(*improve, arguments);
  add_mesh_output(*improve, arguments, common);
}

void add_metrics(CLI::App& app, MetricsArguments& arguments, CommonArguments& common) {
  CLI::App* metrics = app.add_subcommand("metrics", "Measure a mesh");
  metrics->add_option("mesh", arguments.mesh, "mesh file")->required();
  add_size(*metrics, arguments.size, kSizeHelp);
  metrics->add_option("--solve", arguments.solvers, "errors of finite elements, too: poisson, elasticity")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(solver_names()));
  metrics->add_option("--json", arguments.json, "record to write");
  add_time_limit(*metrics, common);
}

void add_extrude(CLI::App& app, ExtrudeArguments& arguments, CommonArguments& common) {
  CLI::App* extrude = add_extrude(app, arguments);
  extrude->add_option("--max-elements", arguments.max_elements, "refuse to make more hexahedra than this")
      ->capture_default_str()
      ->transform(kCount);
  extrude->add_option("--threads", arguments.threads, kThreadsHelp)->check(CLI::Range(1, kMostThreads));
  add_time_limit(*extrude, common);
}

void add_compare(CLI::App& app, CompareArguments& arguments) {
  CLI::App* compare =
      app.add_subcommand("compare", "Compare the results of two runs; exit code 1 when something got worse");
  compare->add_option("before", arguments.before, "folder of results, or a mesh")->required();
  compare->add_option("after", arguments.after, "folder of results, or mesh, to judge")->required();
  compare->add_option("--metrics", arguments.metrics, "keys of records, or 'seconds'")
      ->delimiter(',')
      ->capture_default_str();
  compare->add_option("--tolerance", arguments.tolerance, "part of a value by which it may change")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

/// Of commands that work on meshes that are there.
struct MeshesArguments {
  MetricsArguments metrics;
  ExtrudeArguments extrude;
  CompareArguments compare;
};

void add_meshes(CLI::App& app, MeshesArguments& arguments, CommonArguments& common) {
  add_metrics(app, arguments.metrics, common);
  add_extrude(app, arguments.extrude, common);
  add_compare(app, arguments.compare);
}

void add_info(CLI::App& app, InfoArguments& arguments, CommonArguments& common) {
  CLI::App* info = app.add_subcommand("info", "Tell what a model consists of and what is hard to mesh in it");
  info->add_option("model", arguments.model,
                   "CAD (.step, .stp, .iges, .igs, .brep), triangles (.stl, .obj, .off, .ply, .3mf, .msh) or "
                   "a planar model (.toml, .msh)")
      ->required();
  add_size(*info, arguments.size, "wanted edge length, a number: name what is smaller");
  add_surface(*info, arguments);
  info->add_option("--json", arguments.json, "record to write, with every face, curve and sharp corner");
  info->add_option(
      "-o,--output", arguments.output,
      "the model as it is understood, to look at (.vtu, .msh): triangles by face, lines by curve, as "
      "they are found in a triangulation");
  add_time_limit(*info, common);
}

void add_example(CLI::App& app, ExampleArguments& arguments, CommonArguments& common) {
  CLI::App* example = app.add_subcommand("example", "Write a CAD model that the program makes itself");
  CLI::Option* list = example->add_flag("--list", arguments.list, "names of the examples");
  example->add_option("name", arguments.name, "which one")->excludes(list);
  example->add_option("-o,--output", arguments.output, "CAD file to write (.step, .stp or .brep)")
      ->excludes(list);
  add_time_limit(*example, common);
}

void add_suite(CLI::App& app, SuiteArguments& arguments) {
  CLI::App* suite = app.add_subcommand("suite", "Compare programs on models that this one makes");
  suite->require_subcommand(1);
  CLI::App* models =
      suite->add_subcommand("models", "Write the suite's models and sizes, and the experiment");
  models->add_option("-o,--output", arguments.folder, "folder to write to")->required();
  CLI::App* add = suite->add_subcommand("add", "Measure the meshes of another program");
  add->add_option("result", arguments.result, "folder of its meshes, with result.toml")->required();
  add->add_option("-o,--output", arguments.folder, "folder of results")->required();
  CLI::App* table = suite->add_subcommand("table", "Rank the programs of a folder of results");
  table->add_option("folder", arguments.folder, "folder of results")->required();
}

int run_suite(const CLI::App& app, const SuiteArguments& arguments) {
  const CLI::App& suite = *app.get_subcommand("suite");
  if (suite.got_subcommand("models")) return suite_models_command(arguments);
  return suite.got_subcommand("add") ? suite_add_command(arguments) : suite_table_command(arguments);
}

int run_command_line(int argc, char** argv);

/// As the program and its commands explain themselves.
int print_help(const CLI::App& app, char* program, std::vector<std::string> command) {
  std::string known;
  bool found = command.empty();
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    found = found || sub->get_name() == command[0];
    known += (known.empty() ? "" : ", ") + sub->get_name();
  }
  if (!found) throw InputError("help: there is no command '" + command[0] + "'; known: " + known);
  command.emplace_back("--help");
  std::vector<char*> words = {program};
  for (std::string& word : command) words.push_back(word.data());
  return run_command_line(static_cast<int>(words.size()), words.data());
}

/// The standard output goes nowhere, except from commands that do nothing but print.
void be_quiet(const CLI::App& app, bool only_prints) {
  set_verbosity(Verbosity::kQuiet);
  if (only_prints || app.got_subcommand("schema")) return;
  if (std::freopen("/dev/null", "w", stdout) == nullptr)
    throw InputError("-q: /dev/null cannot be opened: " + std::generic_category().message(errno));
}

/// The exit code, where it is one of these commands, which tell what there is.
std::optional<int> run_on_nothing(const CLI::App& app, bool only_options) {
  if (app.got_subcommand("schema")) return schema_command(only_options);
  if (app.got_subcommand("formats")) return formats_command();
  return std::nullopt;
}

/// The exit code, where it is one of these commands.
std::optional<int> run_on_records(const CLI::App& app, const RecordsArguments& arguments) {
  if (app.got_subcommand("tables")) return tables_command(arguments.tables);
  if (app.got_subcommand("rerun")) return rerun_command(arguments.rerun);
  if (app.got_subcommand("verify")) return verify_command(arguments.verify);
  if (app.got_subcommand("merge")) return merge_command(arguments.merge);
  return std::nullopt;
}

int run_command_line(int argc, char** argv) {
  CLI::App app("Delquad: frontal Delaunay quad meshing in the L-infinity norm");
  app.require_subcommand(0, 1);
  CommonArguments common;
  RunArguments run;
  MeshArguments mesh, improve;
  MeshesArguments meshes;
  InfoArguments info;
  ExampleArguments example;
  RecordsArguments records;
  ReportArguments report;
  SuiteArguments suite;
  add_common(app, common);
  add_run(app, run);
  add_records(app, records);
  add_care_of_records(app, records);
  add_report(app, report);
  bool only_options = false;
  add_schema(app, only_options);
  add_formats(app);
  add_mesh(app, mesh, common);
  add_improve(app, improve, common);
  add_meshes(app, meshes, common);
  add_info(app, info, common);
  add_example(app, example, common);
  add_suite(app, suite);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help
    fmt::print(stderr, "error: {} ('delquad help' and 'delquad help COMMAND' tell what is)\n", error.what());
    return kBadInput;
  }
  if (common.version) {
    print_version(common.all);
    return kDone;
  }
  if (app.got_subcommand("help")) return print_help(app, argv[0], common.help_of);
  if (app.get_subcommands().empty()) {
    fmt::print(stderr, "error: expected a command; 'delquad help' lists them\n");
    return kBadInput;
  }
  if (common.all) set_verbosity(Verbosity::kAll);
  if (common.quiet) be_quiet(app, example.list || run.dry_run);
  const RunScope told({.activities = &program_activities()});
  std::optional<TimeLimit> limit;
  if (common.time_limit > 0) limit.emplace(common.time_limit);
  if (app.got_subcommand("run")) return run_command(run);
  if (app.got_subcommand("suite")) return run_suite(app, suite);
  if (app.got_subcommand("report")) return report_command(report);
  if (const auto code = run_on_nothing(app, only_options)) return *code;
  if (const auto code = run_on_records(app, records)) return *code;
  if (app.got_subcommand("mesh")) return mesh_command(mesh);
  if (app.got_subcommand("improve")) return mesh_command(improve);
  if (app.got_subcommand("extrude")) return extrude_command(meshes.extrude);
  if (app.got_subcommand("compare")) return compare_command(meshes.compare);
  if (app.got_subcommand("info")) return info_command(info);
  if (app.got_subcommand("example")) return example_command(example);
  return metrics_command(meshes.metrics);
}

/// The exit code, unless what was printed did not reach its reader.
int after_printing(int code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  fmt::print(stderr, "error: the standard output cannot be written{}\n",
             errno != 0 ? ": " + std::generic_category().message(errno) : "");
  return code == kDone ? kBadInput : code;
}

/// Large arrays come and go in every step: giving them back to the system each time costs 3 to 5 % of a run.
void keep_freed_memory() {
  constexpr int kMebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMebibyte);  // the most that is allowed
  mallopt(M_TRIM_THRESHOLD, 1024 * kMebibyte);
  mallopt(M_TOP_PAD, 16 * kMebibyte);
}

}  // namespace

int run_program(int argc, char** argv) {
  exit_on_interrupt();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond `ulimit -f` is an error like a full disk
  keep_freed_memory();
  try {
    return after_printing(run_command_line(argc, argv));
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {  // disks and folders that take no more
    fmt::print(stderr, "error: {}: {}\n", (error.path2().empty() ? error.path1() : error.path2()).string(),
               error.code().message());
    return kBadInput;
  } catch (const UnsoundError& error) {
    fmt::print(stderr, "error: {}: nothing was written (--allow-unsound writes it)\n", error.what());
    return kUnsound;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "internal error: out of memory\n");
  } catch (const std::exception& error) {
    if (std::ferror(stdout)) return after_printing(kDone);
    fmt::print(stderr, "internal error: {}\n", error.what());
  }
  return kInternalError;
}

}  // namespace delquad
