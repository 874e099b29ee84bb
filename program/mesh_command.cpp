// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "base/activity.h"
#include "base/context.h"
#include "base/estimate.h"
#include "base/located.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/console/interrupt.h"
#include "experiments/console/progress.h"
#include "experiments/sweep/record.h"
#include "experiments/sweep/recorded_cell.h"
#include "experiments/sweep/wanted_fields.h"
#include "io/cases/case_file.h"
#include "io/cases/read_problem.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/mesh_options.h"
#include "program/options.h"
#include "program/print.h"
#include "program/view.h"

namespace delquad {
namespace {

void print_left_out(const std::vector<FaceFailure>& failures) {
  for (const FaceFailure& failure : failures) fmt::print(stderr, "error: left out: {}\n", failure.reason);
}

/// Meshes; of what is left out is told, too, when that fails.
MeshResult mesh_or_report(const MeshArguments& arguments, const Prepared& prepared, const Pipeline& pipeline,
                          const Context& context, Progress& progress) {
  std::vector<FaceFailure> left_out = prepared->failures;
  try {
    MeshResult result = mesh(prepared, pipeline.text, context);
    left_out = result.failures;
    std::vector<Warning> warnings = result.warnings_on_mesh();
    // The last one is the error then.
    if (!result.soundness.accepted() && !arguments.allow_unsound) warnings.pop_back();
    progress.warn(warnings);
    if (result.criteria && !result.soundness.accepted() && !arguments.allow_unsound) {
      progress.finish();
      print_criteria(*result.criteria, result.mesh);
    }
    if (!arguments.allow_unsound) require_sound(arguments.model.string(), result);
    return result;
  } catch (...) {
    progress.finish();
    print_left_out(left_out);
    throw;
  }
}

/// Tells the cost of a large mesh. Returns whether it is large.
bool warn_of_cost(const MeshProblem& problem, double quads, const Pipeline& pipeline, Progress& progress) {
  constexpr double kManyQuads = 2e6;
  if (!(quads > kManyQuads)) return false;
  // The bracket and the plate of docs/measurements.md, with half a million quads, need these.
  const std::map<char, double> microseconds = {{'C', 55}, {'R', 70}, {'L', 200}};
  constexpr double kOther = 11, kBytes = 700, kMoreBytes = 600, kMinute = 60e6, kGigabyte = 1e9;
  double time = 0, bytes = kBytes;
  for (const Stage* stage : pipeline.stages) {
    const auto slow = microseconds.find(stage->letter);
    time += slow == microseconds.end() ? kOther : slow->second;
    if (slow != microseconds.end()) bytes = kBytes + kMoreBytes;
  }
  progress.warn(
      {fmt::format("{}: about {:.2g} million quads are expected: some {:.1f} GB of memory and {} of "
                   "processor time; --max-elements refuses more quads than it says",
                   problem.name, quads / 1e6, quads * bytes / kGigabyte,
                   counted(std::lround(std::ceil(quads * time / kMinute)), "minute"))});
  return true;
}

/// Gives the nodes of a kept file's sets, which stay, the names that other formats have for them.
void name_points_as_given(const Mesh& given, Mesh& mesh) {
  std::map<std::array<double, 3>, int> index;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    index[{mesh.points[i].x, mesh.points[i].y, mesh.points[i].z}] = static_cast<int>(i);
  mesh.named_points.clear();
  for (const auto& [point, entity] : given.named_points)
    if (const Vec3& p = given.points[point]; index.contains({p.x, p.y, p.z}))
      mesh.named_points.push_back({index[{p.x, p.y, p.z}], entity});
}

/// Returns whether the given file is kept. Else tells which names change, what of this file gets lost, and
/// what the other one misses.
bool keeps_given(const MeshArguments& arguments, const std::optional<Mesh>& given, MeshResult& result,
                 Progress& progress) {
  if (given && keeps_file(arguments.model, arguments.output)) return true;
  if (given && keeps_file(arguments.model, arguments.model)) name_points_as_given(*given, result.mesh);
  const std::string output = arguments.output.string();
  std::vector<Warning> lost;
  if (const auto renamed = renamed_in_file(arguments.output, result.mesh); !renamed.empty())
    lost.push_back(fmt::format("{} cannot hold all names as they are: {}", output, fmt::join(renamed, "; ")));
  if (given && given->order > result.mesh.order)
    lost.push_back(fmt::format("{} loses the nodes on the sides of elements", output));
  if (const auto names = unsupported_in_file(arguments.output, result.mesh); !names.empty())
    lost.push_back(fmt::format("{} loses {}", output, fmt::join(names, "; ")));
  for (const std::string& what : missing_in_file(arguments.output, result.mesh, !arguments.depth.empty()))
    lost.push_back(what);
  result.warnings.insert(result.warnings.end(), lost.begin(), lost.end());
  progress.warn(lost);
  return false;
}

/// Quads beyond the criteria.
std::vector<std::size_t> failing_quads(const MeshResult& result) {
  std::set<std::size_t> failing;
  const std::size_t first = result.mesh.triangles.size();
  if (result.criteria)
    for (const CriterionResult& limit : result.criteria->results)
      for (const int element : limit.failing)
        if (const auto e = static_cast<std::size_t>(element); e >= first) failing.insert(e - first);
  return {failing.begin(), failing.end()};
}

/// Returns the exit code.
int print_missing(const MeshResult& result, const Pipeline& pipeline, bool quads_wanted) {
  print_left_out(result.failures);
  if (!result.failures.empty()) return kFacesLeftOut;
  if (!quads_wanted || result.mesh.triangles.empty()) return kDone;
  const std::size_t n = result.mesh.triangles.size();
  fmt::print(stderr,
             "error: {} {} left among the quads of the written mesh (--allow-triangles accepts them{}) "
             "[odd-boundary]\n",
             n, n == 1 ? "triangle is" : "triangles are",
             pipeline.stages.front()->from != PatchForm::kQuads
                 ? ""
                 : "; a pipeline that begins with B, such as BCO, merges triangles");
  return kTrianglesLeft;
}

/// The text of the pipeline that is asked for; `given`: of what is to be improved.
std::string pipeline_text(const MeshArguments& arguments, const std::optional<Mesh>& given) {
  if (arguments.pipeline) return *arguments.pipeline;
  if (given) return given->quads.empty() ? "BCO" : "CO";
  return quality_named(arguments.quality).pipeline;
}

/// Reads the cell of a record, and takes over its pipeline and how experiments write meshes.
std::optional<RecordedCell> read_record(MeshArguments& arguments) {
  if (arguments.improve || kind_of_file(arguments.model) != ".json") return std::nullopt;
  RecordedCell cell = recorded_cell(read_record_file(arguments.model), arguments.model);
  if (!cell.experiment.peers.empty() || cell.c.adapt)
    refuse("{}: is the record of {}: 'delquad rerun' makes it again", arguments.model.string(),
           cell.c.adapt ? "a loop of meshes" : "another mesher");
  if (const auto* file = std::get_if<ModelFile>(&cell.c.model); file && kind_of_file(file->path) == ".inp")
    refuse("{}: is the record of an improved deck: 'delquad improve {} -o FILE' keeps the deck",
           arguments.model.string(), file->path.string());
  if (!arguments.pipeline) arguments.pipeline = cell.experiment.parsed[0].text;
  arguments.keep_numbers |= cell.is_of_experiment;
  if (cell.is_of_experiment && arguments.msh.curves == MeshArguments().msh.curves)
    arguments.msh.curves = MshOptions().curves;
  return cell;
}

Case read_case(const MeshArguments& arguments) {
  if (arguments.improve) {
    Case c;
    c.name = arguments.model.stem().string();
    c.where = arguments.model;
    c.model = ModelFile{arguments.model, true};
    return c;
  }
  Case c = read_model_case(arguments.model);
  if (arguments.pipeline) return c;
  const Quality& quality = quality_named(arguments.quality);
  if (c.cross.text.empty()) c.cross.kind = quality.cross;
  c.options.set_absent(quality.options);
  return c;
}

void print_before(const std::string& file, const Mesh& mesh, const Prepared& prepared) {
  fmt::print("{}: {}\n", file, show_counts(mesh));
  print_measures(prepared.metrics(mesh));
  if (const Criteria& criteria = prepared.problem().criteria; !criteria.empty())
    print_criteria(judge(mesh, criteria, prepared->size.field.get()), mesh);
}

/// Warns of a size that asks for another number of elements, which stages on given elements keep.
void warn_of_number(const Mesh& given, const Prepared& prepared, const Pipeline& pipeline,
                    Progress& progress) {
  constexpr double kMuch = 1.5;
  const double asked = prepared->size.expected_quads;
  const auto number =
      static_cast<double>(given.quads.size()) + static_cast<double>(given.triangles.size()) / 2;
  if (pipeline.stages.front()->from == PatchForm::kBoundary ||
      (asked < kMuch * number && number < kMuch * asked))
    return;
  progress.warn({Warning(fmt::format(
      "--size: about {:.2g} quads are wanted, and {} keeps the number of {:.0f}: '--pipeline DBCO' makes new "
      "ones between the edges of the boundary, which stay",
      asked, pipeline.text, number))});
}

/// The least and the largest wanted size at nodes.
std::pair<double, double> size_on(const Mesh& mesh, const SizeField& size) {
  std::vector<double> at;
  int hint = -1;
  for (const Vec3& x : mesh.points) at.push_back(size.at(x, hint));
  const auto [least, most] = std::ranges::minmax(at);
  return {least, most};
}

/// `seconds`: on the clock, of the whole command.
void print_after(const MeshArguments& arguments, const MeshResult& result, double seconds) {
  const Preparation& prepared = *result.prepared;
  fmt::print("{}: {}{} in {:.2f} s\n", arguments.output.string(), show_counts(result.mesh),
             arguments.msh.triangles ? ", with each quad written as two triangles," : "", seconds);
  const bool all = verbosity() == Verbosity::kAll;
  print_measures(result.metrics);
  const Summaries& log = result.log.summaries;
  if (log.has("layers"))
    fmt::print("  layers: {} quads on {} edges, which tau and edges leave out\n",
               log.number("layers", "quads"), log.number("layers", "columns"));
  if (all && log.has("across_cuts") && log.number("across_cuts", "faces") > 0)
    fmt::print("  across cuts: {} irregular vertices before{}\n",
               log.number("across_cuts", "irregular_before"),
               log.number("across_cuts", "taken") > 0
                   ? ""
                   : ", and after: with other cuts there were no fewer, or eta or tau were worse");
  if (log.has("grids") && (all || log.number("grids", "asked") > 0))
    fmt::print("  grids: {} faces, {} of them by name, with {} quads\n", log.number("grids", "faces"),
               log.number("grids", "asked"), log.number("grids", "quads"));
  if (const auto quads = result.prepared.problem().quads) {
    const auto [least, most] = size_on(result.mesh, *prepared.size.field);
    fmt::print("  size: {:.6g}{} for {} quads\n", least, most > least ? fmt::format(" to {:.6g}", most) : "",
               *quads);
  }
  if (!prepared.size.adapted_to.empty())
    fmt::print("  size: made smaller for {}: tau and edges are measured against that, tau given is not\n",
               fmt::join(prepared.size.adapted_to, " and "));
  for (const auto& [at, n] : prepared.symmetry)
    fmt::print("  symmetry: plane through {}, normal {}\n", show_point(at), show_point(n));
  const bool is_outline = std::holds_alternative<PlanarModel>(result.prepared.problem().model);
  if (!all && result.surface && !is_outline) print_surface_summary(*result.surface);
  print_names(result.mesh);
  if (const auto& of = result.mesh.thickness; !of.empty())
    fmt::print("  thickness: {:.4g} to {:.4g}\n", std::ranges::min(of), std::ranges::max(of));
  if (!result.mesh.unit.empty()) fmt::print("  lengths: in {}\n", result.mesh.unit);
  if (all) print_seconds(result.log.times);
  if (all && result.surface) print_surface_report(result.prepared, *result.surface);
  if (result.criteria) print_criteria(*result.criteria, result.mesh);
  if (!all && !result.warnings.empty())
    fmt::print("  {} above; -v has all of them, and all measures\n",
               counted(static_cast<long long>(lines_of(result.warnings).size()), "warning"));
}

/// Moves elements that fail to regions of their own, which have the tag and names of theirs, "failing" and,
/// by criterion, "failing_min_length".
void name_failing(const CriteriaReport& report, Mesh& mesh) {
  if (!mesh.periodic_faces.empty())
    throw InputError("--failing-sets does not go with periodic faces, whose elements stay together");
  for (const Entity& region : mesh.regions)
    for (const std::string& name : region.names)
      if (name.starts_with("failing"))
        refuse("--failing-sets: region '{}' has the name of such a set: expected another", name);
  std::vector<std::set<std::string>> sets(mesh.triangles.size() + mesh.quads.size());
  for (const CriterionResult& result : report.results)
    for (const int element : result.failing) sets[element].insert("failing_" + result.limit.key);
  std::map<std::pair<int, std::set<std::string>>, int> made;
  for (std::size_t e = 0; e < sets.size(); ++e) {
    if (sets[e].empty()) continue;
    const std::size_t n = mesh.triangles.size();
    int& region = e < n ? mesh.triangle_region[e] : mesh.quad_region[e - n];
    const auto [at, is_new] = made.try_emplace({region, sets[e]}, static_cast<int>(mesh.regions.size()));
    if (is_new) {
      Entity part = mesh.regions[region];
      part.names.emplace_back("failing");
      part.names.insert(part.names.end(), sets[e].begin(), sets[e].end());
      mesh.regions.push_back(std::move(part));
    }
    region = at->second;
  }
}

/// Meshes again with each option that may cure failing elements, and prints how many fail then. The written
/// mesh stays.
void try_cures(const MeshArguments& arguments, const Case& c, const Pipeline& pipeline,
               const CriteriaReport& report) {
  if (!arguments.try_cures || report.failing == 0) return;
  struct Trial {
    std::string option;
    Case c;
    std::string pipeline;
  };
  std::vector<Trial> trials;
  for (const Cure& cure : cures_by_key(report))
    if (cure.key == "surface.ignore_below") {
      Trial& trial = trials.emplace_back(fmt::format("--ignore-below {:.3g}", cure.value), c, pipeline.text);
      trial.c.surface.ignore_below = cure.value;
    }
  MeshArguments best = arguments;
  best.quality = "best";
  if (const std::string text = quality_named(best.quality).pipeline;
      !arguments.pipeline && !arguments.improve && pipeline.text != text) {
    Trial& trial = trials.emplace_back("--quality best", read_case(best), text);
    trial.c.allow_unsound = true;
    set_problem(best, trial.c);
  }
  for (const Trial& trial : trials) try {
      const MeshResult other = mesh(prepare(trial.c), trial.pipeline);
      if (!other.soundness.accepted()) throw InputError(other.soundness.complaint());
      fmt::print("    tried {}: {} of {} elements fail, {} before\n", trial.option, other.criteria->failing,
                 other.criteria->elements, report.failing);
    } catch (const InputError& error) {
      fmt::print("    tried {}: not possible: {}\n", trial.option, error.what());
    }
}

void check_fields_file(const std::filesystem::path& file) {
  if (kind_of_file(file) != ".vtu") refuse("--fields: {}: expected a .vtu file", file.string());
  check_output(file);
}

/// Adds the shell sections of a given deck to one of another program, and tells what gets lost.
void carry_given(const MeshArguments& arguments, const Mesh& mesh, MeshResult& result, Progress& progress) {
  std::vector<Warning> lost;
  for (const std::string& what : carry_sections(arguments.model, arguments.output, mesh))
    lost.push_back(fmt::format("{} loses {}", arguments.output.string(), what));
  result.warnings.insert(result.warnings.end(), lost.begin(), lost.end());
  progress.warn(lost);
}

/// `depth`: of water, at points; null: none is written. `is_kept`: the file of the given mesh is.
void write_result(const MeshArguments& arguments, const Case& c, const Pipeline& pipeline,
                  const std::function<double(const Vec3&)>& depth, bool is_kept, Progress& progress,
                  MeshResult& result) {
  const StageScope writing_files("writing");
  const Uninterrupted whole;
  if (!arguments.keep_numbers) reduce_bandwidth(result.mesh);
  std::optional<Mesh> other;
  if (arguments.failing_sets) name_failing(*result.criteria, other.emplace(result.mesh));
  if (depth) {
    for (Vec3& x : other.emplace(result.mesh).points) x.z = -depth(x);
    if (std::ranges::none_of(other->points, [](const Vec3& x) { return x.z < 0; }))
      progress.warn(
          {Warning("--depth: no depth is above 0, and depths count downwards: expected \"FILE: "
                   "-value\" for a raster of heights")});
  }
  const Stopwatch writing;
  const Mesh& last = other ? *other : result.mesh;
  const auto write = arguments.serendipity ? write_serendipity : write_mesh;
  is_kept ? rewrite_mesh(arguments.model, arguments.output, last, c.surface.weld_tolerance.value_or(0))
          : write(arguments.output, last, options_for_source(arguments.model, arguments.msh));
  if (arguments.improve && !is_kept) carry_given(arguments, last, result, progress);
  result.log.add_time("write", writing.time());
  if (!arguments.fields.empty()) write_wanted(arguments.fields, result.mesh, result.prepared);
  if (!arguments.json.empty()) write_text_file(arguments.json, run_record(c, pipeline, result));
}

int mesh_command(MeshArguments arguments) {
  const Stopwatch command;
  const RunScope run({.threads = arguments.threads});
  check_mesh_format(arguments.output, arguments.msh);
  std::optional<Mesh> given;
  if (arguments.improve) given = read_mesh(arguments.model);
  const std::optional<RecordedCell> recorded = read_record(arguments);
  const std::string text = pipeline_text(arguments, given);
  parse_pipeline(text, PipelineStart::kGivenMesh);  // before anything is read
  Case c = recorded ? recorded->c : read_case(arguments);
  const Pipeline pipeline = parse_pipeline(text, pipeline_start(c.model));
  c.allow_unsound = true;  // see below
  set_problem(arguments, c);
  check_mesh_format(arguments.output, arguments.msh, c.order, pipeline.result == PatchForm::kQuads);
  if (arguments.improve) check_triangles(arguments.model, arguments.output, arguments.msh);
  if (arguments.serendipity) check_serendipity(arguments.output, arguments.msh, c.order);
  const auto size_file = size_file_of(c.size.text, c.size.folder);
  check_distinct(
      {{"the model", arguments.model},
       {"the model's mesh", model_path(c) == arguments.model ? "" : model_path(c)},
       {"the file of sizes", size_file && size_file->path != arguments.model ? size_file->path : ""},
       {"-o", arguments.output},
       {"--json", arguments.json},
       {"--fields", arguments.fields},
       {"--view", arguments.view ? page_of(arguments.output) : ""}});
  check_output(arguments.output);
  std::function<double(const Vec3&)> depth;
  if (!arguments.depth.empty()) {
    check_depths(arguments.output);
    depth = read_depths(arguments.depth, c.model);
  }
  if (!arguments.json.empty()) check_output(arguments.json);
  if (!arguments.fields.empty()) check_fields_file(arguments.fields);

  Progress progress(2 + static_cast<int>(pipeline.stages.size()));
  const auto told = [&](const std::string& head) {
    return Context{.progress = [&progress, head](const ProgressReport& report) {
      progress.step(head + ": " + report.stage);
    }};
  };
  on_estimate() = [&, is_reported = false](double quads) mutable {
    is_reported =
        is_reported || warn_of_cost(c, c.quads ? static_cast<double>(*c.quads) : quads, pipeline, progress);
  };
  const Prepared prepared = prepare(c, told(c.name));
  on_estimate() = nullptr;
  progress.warn(prepared->warnings);
  if (given && !c.size.text.empty()) warn_of_number(*given, prepared, pipeline, progress);
  MeshResult result =
      mesh_or_report(arguments, prepared, pipeline, told(c.name + " " + pipeline.text), progress);
  const bool is_kept = keeps_given(arguments, given, result, progress);
  write_result(arguments, c, pipeline, depth, is_kept, progress, result);
  progress.finish();
  if (given) print_before(arguments.model.string(), *given, result.prepared);
  print_after(arguments, result, command.seconds());
  if (result.criteria) try_cures(arguments, c, pipeline, *result.criteria);
  if (arguments.view)
    view(page_of(arguments.output), result.mesh, arguments.output.filename().string(),
         {.warnings = lines_of(result.warnings), .failing = failing_quads(result)});
  return print_missing(result, pipeline, pipeline.quads_only() && !arguments.allow_triangles);
}

}  // namespace

void add_mesh(CLI::App& app, Commands& commands) {
  const auto mesh = std::make_shared<MeshArguments>(), improve = std::make_shared<MeshArguments>();
  commands.push_back({.app = add_mesh_options(app, *mesh),
                      .run = [mesh] { return mesh_command(*mesh); },
                      .has_time_limit = true});
  commands.push_back({.app = add_improve_options(app, *improve),
                      .run = [improve] { return mesh_command(*improve); },
                      .has_time_limit = true});
}

}  // namespace delquad
