// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>

#include "base/activity.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "delquad/error.h"
#include "features/given/given_domain.h"
#include "features/grids/mapped_grid.h"
#include "features/layers/add_layers.h"
#include "mesher/finish_steps.h"
#include "mesher/runner.h"

namespace delquad {
namespace {

template <std::size_t N>
bool are_below(const std::vector<std::array<int, N>>& elements, std::size_t n, int least = 0) {
  return std::ranges::all_of(elements, [&](const auto& element) {
    return std::ranges::all_of(element, [&](int i) { return i >= least && i < static_cast<int>(n); });
  });
}

/// Throws Error if a stage from outside left a mesh that would crash the next stages. If `may_slide`, nodes
/// on curves may have moved.
void check_stage_result(const Stage& stage, const PatchBoundary& boundary, const PatchMesh& mesh,
                        bool may_slide) {
  const auto refuse = [&](const char* what) {
    throw Error(fmt::format("stage {} ({}) left {}", stage.letter, stage.name, what));
  };
  if (mesh.form != stage.to) refuse("a mesh of another form than it says");
  if (mesh.form == PatchForm::kBoundary) return;
  const bool of_triangles = mesh.form == PatchForm::kTriangles;
  const std::vector<Vec2>& points = points_of(mesh);
  if ((of_triangles ? mesh.triangles.n_boundary : mesh.quads.n_boundary) !=
          static_cast<int>(boundary.points.size()) ||
      points.size() < boundary.points.size() ||
      !(may_slide || std::equal(boundary.points.begin(), boundary.points.end(), points.begin())))
    refuse("a mesh whose first points are not the boundary's");
  if (!mesh.inside.empty() && mesh.inside.size() != points.size() - boundary.points.size())
    refuse("places in space that are not one for each point inside");
  const TriPatch& tri = mesh.triangles;
  if (of_triangles
          ? !are_below(tri.triangles, points.size())
          : !are_below(mesh.quads.quads, points.size()) || !are_below(mesh.quads.triangles, points.size()))
    refuse("an element with a corner that is no point");
  if (of_triangles &&
      (tri.neighbours.size() != tri.triangles.size() || !are_below(tri.neighbours, tri.triangles.size(), -1)))
    refuse("triangles without neighbors");
}

/// Returns the mesh of a patch from which a pipeline begins with this stage.
PatchMesh initial_mesh(const Stage& stage, const MeshingSetup& prepared, const PatchSetup& patch) {
  if (patch.given.points.empty())
    throw InputError(
        fmt::format("{}: '{}' cannot begin a pipeline here: expected a stage that inserts points, or "
                    "'delquad improve' for a given mesh",
                    prepared.settings.where, stage.letter));
  const auto has_quads = [](const PatchSetup& other) { return !other.given.quads.empty(); };
  PatchMesh start;
  // Triangles of a mesh in space stay, since regions may be small, and cuts may separate triangles from
  // quads.
  if (prepared.surface && stage.from == PatchForm::kQuads &&
      std::ranges::any_of(prepared.patches, has_quads)) {
    start.form = PatchForm::kQuads;
    start.quads = patch.given;
  } else {
    start = located(prepared.settings.where, [&] { return start_from(patch.given, stage.from); });
  }
  start.inside = patch.given_inside;
  return start;
}

/// Stores the meshes from which a pipeline begins with this stage, if they are quads or halves of quads.
void note_given_quads(const Stage& stage, const MeshingSetup& prepared, std::vector<PatchMesh>& given) {
  const bool halves = std::ranges::all_of(
      prepared.patches, [](const PatchSetup& patch) { return patch.given.triangles.empty(); });
  for (const PatchSetup& patch : prepared.patches)
    if (stage.from == PatchForm::kQuads)
      given.push_back(initial_mesh(stage, prepared, patch));
    else if (prepared.given_worst && halves)
      given.push_back({PatchForm::kQuads, {}, patch.given, patch.given_inside});
}

/// Runs one stage on a patch. Returns why its face must be left out, with its name; empty: it need not.
std::string run_on_patch(const Stage& stage, const MeshingSetup& prepared, std::size_t i, PatchMesh& mesh,
                         StageLog& log) {
  const PatchSetup& patch = prepared.patches[i];
  const StageInput input{patch.boundary, *patch.cross, *patch.size, prepared.settings.options,
                         kPointsPerElement * prepared.settings.max_elements};
  const auto run = [&] {
    if (mesh.form != stage.from) {
      mesh = initial_mesh(stage, prepared, patch);
      mesh.inside.clear();
    }
    stage.run(input, mesh, log);
    check_stage_result(stage, patch.boundary, mesh, false);
  };
  if (!prepared.surface) try {
      run();
      return "";
    } catch (const TooManyPoints& error) {
      throw InputError(prepared.settings.where + ": " + error.what());
    }
  const std::string title =
      fmt::format("face {}: {}: ", prepared.boundary.regions[patch.region].tag, stage.name);
  try {
    run();
    return "";
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const InputError& error) {
    if (!prepared.settings.keep_going)
      throw InputError(prepared.settings.where + ": " + title + error.what());
    return title + error.what();
  } catch (const std::exception& error) {
    if (!prepared.settings.keep_going) throw Error(prepared.settings.where + ": " + title + error.what());
    return title + error.what();
  }
}

/// Returns the area over the square of the mean boundary edge, the cost of a patch.
double rough_quads(const PatchBoundary& boundary) {
  double double_area = 0, length = 0;
  for (const auto& [i, j] : boundary.edges) {
    const Vec2 a = boundary.points[i], b = boundary.points[j];
    double_area += cross(a, b);
    length += norm(b - a);
  }
  const double edge = length / static_cast<double>(boundary.edges.size());
  return double_area / 2 / (edge * edge);
}

void count_grids(const MeshingSetup& prepared, StageLog& log) {
  long long faces = 0, asked = 0, quads = 0;
  for (const PatchSetup& patch : prepared.patches) {
    if (!patch.grid) continue;
    ++faces;
    asked += patch.grid_stays;
    quads += static_cast<long long>(patch.grid->quads.size());
  }
  if (faces > 0) log.summaries.add("grids", {{"faces", faces}, {"asked", asked}, {"quads", quads}});
}

/// Adds the log of each patch, and warns of steps that were stopped.
void add_logs(const MeshingSetup& prepared, const std::vector<StageLog>& logs, PipelineState& state) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (logs[i].summaries.has("treatment") && logs[i].summaries.number("treatment", "stopped") > 0)
      state.warnings.push_back(
          stopped_early(prepared, "treatment", prepared.boundary.regions[prepared.patches[i].region].tag));
    state.log.add(logs[i]);
  }
}

/// Returns for each region whether it is left out.
std::vector<char> regions_left_out(const MeshingSetup& prepared, const std::vector<std::string>& reasons) {
  std::vector<char> left_out(prepared.boundary.regions.size(), 0);
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (!reasons[i].empty()) left_out[prepared.patches[i].region] = 1;
  return left_out;
}

}  // namespace

Warning stopped_early(const MeshingSetup& prepared, const std::string& step, int face) {
  return {"steps that were stopped before their end", 0,
          fmt::format("{}: {} of face {} was stopped, as it would take too long. Quads there may be poor; a "
                      "smaller size helps, or a model without slivers and spikes there",
                      prepared.settings.name, step, face)};
}

std::vector<char> unedited_patches(const MeshingSetup& prepared, const PipelineState& state) {
  std::vector<char> left_out;
  for (std::size_t i = 0; i < state.patches.size(); ++i) {
    const PatchSetup& patch = prepared.patches[i];
    left_out.push_back(!state.reasons[i].empty() || patch.grid || patch.given_stays);
  }
  return left_out;
}

PipelineState begin_meshing(const MeshingSetup& prepared) {
  PipelineState state;
  state.patches.resize(prepared.patches.size());
  state.reasons.resize(prepared.patches.size());
  if (prepared.surface) state.nodes = prepared.surface->domain.nodes;
  state.nodes.points = prepared.boundary.points;
  if (prepared.layers) add_summary(state.log, prepared.layers->count);
  count_grids(prepared, state.log);
  return state;
}

namespace {

void run_on_patches(const Stage& stage, const MeshingSetup& prepared, PipelineState& state) {
  state.stages.push_back(&stage);
  if (stage.from == PatchForm::kQuads) state.of_quads.push_back(&stage);
  std::vector<PatchMesh>& patches = state.patches;
  if (patches[0].form == PatchForm::kBoundary && stage.from != PatchForm::kBoundary)
    note_given_quads(stage, prepared, state.given);
  std::vector<StageLog> logs(patches.size());
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        std::string& reason = state.reasons[i];
        const FaceScope face = patch_scope(prepared, i);
        patches[i].inside.clear();
        if (prepared.patches[i].given_stays) {
          if (patches[i].form != stage.to) patches[i] = initial_mesh(stage, prepared, prepared.patches[i]);
          return;
        }
        // The quads of automatic grids may be edited.
        if (const auto& grid = prepared.patches[i].grid;
            grid && (prepared.patches[i].grid_stays || stage.from != PatchForm::kQuads)) {
          if (patches[i].form != stage.to) patches[i] = grid_as(stage.to, *grid);
          return;
        }
        if (reason.empty()) reason = run_on_patch(stage, prepared, i, patches[i], logs[i]);
      },
      [&](std::size_t i) {
        return patches[i].form == PatchForm::kBoundary ? rough_quads(prepared.patches[i].boundary)
                                                       : static_cast<double>(points_of(patches[i]).size());
      });
  add_logs(prepared, logs, state);
}

/// Runs a stage on all patches together.
void run_on_all(const Stage& stage, const MeshingSetup& prepared, PipelineState& state) {
  std::vector<PatchMesh>& patches = state.patches;
  FinishContext finishing{prepared, state, regions_left_out(prepared, state.reasons)};
  run_finish_steps(FinishAt::kEveryStage, finishing);
  state.log.add(finishing.result.log);
  if (stage.finish) {
    std::vector<char> held = unedited_patches(prepared, state);
    // Stages that move points of quads also move points of grids that need not stay.
    for (std::size_t i = 0; stage.from == PatchForm::kQuads && i < held.size(); ++i)
      if (const PatchSetup& patch = prepared.patches[i]; patch.grid && !patch.grid_stays) held[i] = 0;
    stage.finish({prepared, prepared.settings.options, patches, held, state.nodes, !state.given.empty()},
                 state.log);
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) check_stage_result(stage, prepared.patches[i].boundary, patches[i], true);
  }
}

}  // namespace

void run_stage(const Stage& stage, const MeshingSetup& prepared, PipelineState& state) {
  const Stopwatch watch;
  const StageScope running(stage.name.c_str());
  run_on_patches(stage, state.now(prepared), state);
  if (stage.letter == 'R' && prepared.surface) run_joint_layouts(state.now(prepared), state);
  run_on_all(stage, state.now(prepared), state);
  state.seconds += watch.seconds();
}

}  // namespace delquad
