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

/// A pipeline on its way: what the stages so far have made of each patch.
struct PipelineState {
  std::vector<PatchMesh> patches;
  std::vector<PatchMesh> given;             ///< the quads that the word began from, or halved
  std::vector<const Stage*> stages = {};    ///< all that ran
  std::vector<const Stage*> of_quads = {};  ///< those that began from quads
  std::vector<std::string> reasons;         ///< of each patch, to leave its face out; empty: none
  std::vector<Warning> warnings;
  SurfaceNodes nodes;  ///< those on curves
  StageLog log;
  double seconds = 0;  ///< on the clock, so far
  /// The problem with other nodes on curves, once a stage made these; null: as it was prepared.
  std::shared_ptr<const MeshingSetup> other = {};

  /// Returns the problem from which later stages start.
  const MeshingSetup& now(const MeshingSetup& prepared) const { return other ? *other : prepared; }
};
PipelineState begin_meshing(const MeshingSetup& prepared);
/// Lays all patches of a surface out anew, with other numbers of edges on curves, where that is better.
/// Nodes on curves change, and state.other with them.
void run_joint_layouts(const MeshingSetup& prepared, PipelineState& state);
/// Returns whether the patch is on both sides of one of its curves, and two of its quads have the same four
/// nodes. These are two quads around a tube.
bool has_duplicate_quads(const QuadPatch& mesh, const std::vector<int>& point_node);
/// Takes every patch through one stage. Throws InputError when the mesher had to stop.
void run_stage(const Stage& stage, const MeshingSetup& prepared, PipelineState& state);
void add_times(const StepTimes& times, StageLog& log);
struct FinishContext;
/// Runs the finish steps on patches, and returns these as one mesh.
Mesh finish_patches(FinishContext& on);
/// Metrics of the mesh and, at the same time, the report of a surface and what is sound. `left_out`: by
/// region.
void measure(const MeshingSetup& prepared, const std::vector<char>& left_out, MeshResult& result);
/// Returns measures by the size, or by the metric, that is meshed by.
MeshMetrics metrics_of(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides);
/// Adds how well the edges follow the cross field.
void add_misalignment(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides,
                      MeshMetrics& metrics);
/// Adds the measures from outside.
void measure_added_metrics(const MeshingSetup& prepared, const Mesh& mesh, const std::string& word,
                           MeshMetrics& metrics);
/// Does the same for a curved mesh, after its vertices moved: adds what is not sound of its straight form.
void measure_straight_form(const MeshingSetup& prepared, const std::vector<char>& left_out,
                           MeshResult& result);
/// Gives the mesh the curves and regions that were given, and no other lines.
void put_back_entities(const GivenEntities& given, Mesh& mesh);
/// Returns the warning about a step that would have taken too long, with the tag of a face.
Warning stopped_early(const MeshingSetup& prepared, const std::string& step, int face);
/// Returns, by patch, whether it is one whose mesh no step edits.
std::vector<char> unedited_patches(const MeshingSetup& prepared, const PipelineState& state);
/// Puts the patches together, measures the mesh and says whether it is sound, with all finish steps but
/// refine_unsound(). `label` names the case and pipeline in warnings.
MeshResult finish_meshing(const MeshingSetup& prepared, const std::string& label, PipelineState state);

/// Meshes every patch stage by stage, puts the patches together, measures the mesh and says whether it is
/// sound. Throws InputError when the mesher had to stop.
MeshResult run_pipeline(const MeshingSetup& prepared, const Word& word);

/// Joins the patches into one mesh. Boundary nodes, at `nodes`, occur once; the points inside each patch
/// follow. Faces that are `left_out` (by region) are missing, with their own nodes. `log` receives the time
/// of bringing the points back to space, as "projection".
Mesh assemble(const MeshingSetup& prepared, const std::vector<Vec3>& nodes,
              const std::vector<PatchMesh>& patches, const std::vector<char>& left_out,
              StageLog* log = nullptr);

/// More points were to be inserted than max_elements allow. The message has no place of the request.
class TooManyPoints : public InputError {
 public:
  using InputError::InputError;
};

/// max_elements bounds what is inserted, too: a quad mesh has about as many points as quads.
inline constexpr long long kPointsPerElement = 4;

}  // namespace delquad
