// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/counters.h"
#include "delquad/error.h"
#include "delquad/extend.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/patches/places_inside.h"
#include "metrics/judgement/soundness.h"
#include "metrics/metrics.h"
#include "metrics/surface/surface_report.h"

// This header runs the stages of a pipeline. The pipeline uses it.

namespace delquad {

/// State of a pipeline between two stages: the mesh of each patch.
struct PipelineState {
  std::vector<PatchMesh> patches;
  std::vector<PatchMesh> given;             ///< quads that the pipeline began from, or halved
  std::vector<const Stage*> stages = {};    ///< stages that ran
  std::vector<const Stage*> of_quads = {};  ///< stages that ran and began from quads
  std::vector<std::string> reasons;         ///< reason of each patch to leave its face out; empty: none
  std::vector<Warning> warnings;
  SurfaceNodes nodes;  ///< nodes on curves
  StageLog log;
  double seconds = 0;  ///< wall-clock time so far
  /// The problem with the nodes that a stage put on curves; null: as it was prepared.
  std::shared_ptr<const MeshingSetup> other = {};

  /// Returns the problem from which later stages start.
  const MeshingSetup& now(const MeshingSetup& prepared) const { return other ? *other : prepared; }
};
/// Returns the state before the first stage. `prepared` must outlive it.
PipelineState begin_meshing(const MeshingSetup& prepared);
/// Lays all patches of a surface out anew, with other numbers of edges on curves, where that is better.
/// Nodes on curves change, and state.other with them.
void run_joint_layouts(const MeshingSetup& prepared, PipelineState& state);
/// Returns whether the patch is on both sides of one of its curves, and two of its quads have the same four
/// nodes. These are two quads around a tube.
bool has_duplicate_quads(const QuadPatch& mesh, const std::vector<int>& point_node);
/// Runs one stage on all patches. Throws InputError if a patch fails and problem.keep_going is not set, and
/// Error if a stage from outside leaves no valid mesh.
void run_stage(const Stage& stage, const MeshingSetup& prepared, PipelineState& state);
/// Adds the times of steps to the log.
void add_times(const StepTimes& times, StageLog& log);
struct FinishContext;
/// Runs the finish steps on patches, and returns the patches as one mesh.
Mesh finish_patches(FinishContext& on);
/// Measures the mesh, reports the model of a surface, and checks soundness, in parallel. `left_out` tells for
/// each region whether it is missing.
void measure(const MeshingSetup& prepared, const std::vector<char>& left_out, MeshResult& result);
/// Returns measures by the size, or metric, of the problem. `sides` has the sorted_half_edges(), here and
/// below.
MeshMetrics metrics_of(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides);
/// Adds the angles between edges and cross field.
void add_misalignment(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides,
                      MeshMetrics& metrics);
/// Adds the measures that programs registered; `pipeline` is the text of the pipeline.
void measure_added_metrics(const MeshingSetup& prepared, const Mesh& mesh, const std::string& pipeline,
                           MeshMetrics& metrics);
/// Measures a curved mesh after its vertices moved, and adds the unsound places of its straight form.
void measure_straight_form(const MeshingSetup& prepared, const std::vector<char>& left_out,
                           MeshResult& result);
/// Gives the mesh the curves and regions of the given mesh, and removes all other lines.
void put_back_entities(const GivenEntities& given, Mesh& mesh);
/// Returns the warning about a step that stopped at its limit of work, with the tag of a face.
Warning stopped_early(const MeshingSetup& prepared, const std::string& step, int face);
/// Returns for each patch whether no step may edit its mesh.
std::vector<char> unedited_patches(const MeshingSetup& prepared, const PipelineState& state);
/// Joins the patches, measures the mesh and checks its soundness, with all finish steps but refine_unsound().
/// `label` names the case and pipeline in warnings.
MeshResult finish_meshing(const MeshingSetup& prepared, const std::string& label, PipelineState state);

/// Meshes every patch stage by stage, and returns finish_meshing(). Throws as run_stage().
MeshResult run_pipeline(const MeshingSetup& prepared, const Pipeline& pipeline);

/// Returns the patches as one mesh. Boundary nodes, at `nodes`, come first; the points inside each patch
/// follow. Faces that are `left_out` (by region) are missing, with their own nodes. `log` receives the time
/// of bringing the points back to space, as "projection".
Mesh assemble(const MeshingSetup& prepared, const std::vector<Vec3>& nodes,
              const std::vector<PatchMesh>& patches, const std::vector<char>& left_out,
              StageLog* log = nullptr);

/// Error if more points would be inserted than max_elements allow. The message has no place of the request.
class TooManyPoints : public InputError {
 public:
  using InputError::InputError;
};

/// Limit of inserted points over max_elements; a quad mesh has about as many points as quads.
inline constexpr long long kPointsPerElement = 4;

}  // namespace delquad
