// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "delquad/options.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"

// This header has the steps that finish a mesh after its stages. The pipeline uses it.

namespace delquad {

/// Most quads of a cavity where irregular vertices lie far apart, so that it reaches from one to another.
inline constexpr long long kFarQuads = 1000;

/// Options of the repairs beside the stages of a pipeline: see finish_steps().
struct RepairOptions {
  bool separate_duplicates = true;
  bool lift_bad_quads = true;
  bool failing_quads = true;
  bool flat_corners = true;
  bool across_cuts = true;
  bool refine_unsound = true;
  bool ignore_small = true;
  bool keep_given = true;  ///< a given mesh may not become worse, as a whole and by quad
  bool at_any_price = false;
};

/// Returns the keys of `repair`, and their values in options.
OptionGroup repair_group();
RepairOptions repair_options(const Options& options);

/// Time at which a finish step runs, and its object.
enum class FinishAt {
  kEveryStage,  ///< after each stage, on all patches
  kPatches,     ///< after the last one, on all patches
  kMesh,        ///< on the mesh that the patches make
  kMeasured,    ///< on the mesh and its measures
  kProblem,     ///< on the problem, which is meshed again: see refine_unsound()
};

/// A mesh between the stages of its pipeline and its result.
struct FinishContext {
  const MeshingSetup& prepared;
  PipelineState& state;
  std::vector<char> left_out;  ///< whether a region is left out
  MeshResult result = {};      ///< the mesh from FinishAt::kMesh on, its measures from FinishAt::kMeasured on
  std::string label = {};      ///< names case and pipeline in warnings
};

/// A step of a mesh beside the stages of its pipeline.
struct FinishStep {
  const char* name;             ///< in records
  const char* time;             ///< in records of times
  bool RepairOptions::*option;  ///< false switches off this step alone; null: higher orders switch it on
  FinishAt at;
  bool (*applies)(const FinishContext& to);
  void (*run)(FinishContext& on);  ///< null: see FinishAt::kProblem
};

/// Returns all steps, in the order in which they run.
const std::vector<FinishStep>& finish_steps();

/// Runs the steps of this time. The log gets the seconds of each.
void run_finish_steps(FinishAt at, FinishContext& on);

/// Notes the seconds of a step, and adds them to "finish".
void note_seconds(const char* step, double seconds, Summaries& summaries);

/// Returns whether cuts hinder stages that begin from quads. This holds for stages that fill cavities, as no
/// cavity crosses a cut. In a given mesh, nodes on cuts can only move along these, so cuts hinder every
/// stage.
bool cuts_obstruct(const MeshingSetup& prepared, const std::vector<const Stage*>& of_quads);

/// Runs the stages that begin from quads once more with other cuts, in faces that have cuts. The new mesh is
/// taken if it is better (is_better(), is_more_regular()), and has no lines on cuts.
void run_across_cuts(FinishContext& on);

/// Calls prepare_problem() with the same problem. It throws InputError for hints that leave nothing to mesh.
using PrepareWithHints = std::function<MeshingSetup(const RetryHints&)>;

/// Returns the work on a mesh as the number of quads that usually take as long. It counts quads, lifting,
/// looks of stages, steps of curves and triangles of maps, so it does not depend on the machine.
long long work_on(const MeshingSetup& prepared, const MeshResult& result);

/// Halves the size around places where the mesh is not sound, and meshes again (own method). It goes on as
/// long as such places become fewer, within a budget of work_on(). If that does not help, sharp edges there
/// become features. `prepared` and `result` become the best mesh, with a warning and the time of all tries.
/// If it is not sound, a warning says why the tries ended. Then details narrower than a tenth of the size are
/// left out. The last tries change the size, the stages or the feature angle of a triangulation. Each is
/// taken, with a warning, if its mesh is sound. If problem.keep_going is set, faces with such places are left
/// out at last, as long as others remain.
void refine_unsound(const PrepareWithHints& prepare_with_hints, const Pipeline& pipeline,
                    MeshingSetup& prepared, MeshResult& result);

/// Returns whether a mesh is worse than the given mesh that it was made of. It is worse if it is not sound
/// where the given one was, or degradation_of() finds harm. It is not worse if only it is sound. Otherwise it
/// is worse if none of eta mean, eta worst and d4 is better and one of them is worse.
bool is_worse(const MeshResult& after, const MeshResult& before);

/// Returns whether a mesh is not worse, and fewer quads fail, see failing_part(). If as many fail, the sum of
/// eta mean, eta worst and the share of regular vertices must be larger.
bool is_better(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before);

/// Returns whether a mesh has fewer irregular vertices, no more failing quads, and a tau of at least 91 % or
/// as before.
bool is_more_regular(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before);

/// Returns whether the worst eta is at least `eta`, or as large as before.
bool keeps_worst_eta(double eta, const MeshResult& after, const MeshResult& before);

/// Replaces the mesh of a result and its measures.
void take_mesh(MeshResult&& from, MeshResult& result);

}  // namespace delquad
