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

/// Quads of a cavity, if irregular vertices lie far apart: the cavity reaches from one to another.
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
  bool keep_given = true;  ///< see forbid_degradation() in stages.cpp, too
  bool at_any_price = false;
};

OptionGroup repair_group();
RepairOptions repair_options(const Options& options);

/// When a finish step runs, and on what.
enum class FinishAt {
  kEveryStage,  ///< after each stage, on all patches
  kPatches,     ///< after the last one, on all patches
  kMesh,        ///< on the mesh that these make
  kMeasured,    ///< on the mesh and its measures
  kProblem,     ///< on the problem, which is meshed anew: see refine_unsound()
};

/// A mesh on its way from the letters to its result.
struct FinishContext {
  const MeshingSetup& prepared;
  PipelineState& state;
  std::vector<char> left_out;  ///< by region
  MeshResult result = {};      ///< the mesh from FinishAt::kMesh on, its measures from FinishAt::kMeasured on
  std::string label = {};      ///< names case and pipeline in warnings
};

/// A step of a mesh beside the stages of its pipeline.
struct FinishStep {
  const char* name;             ///< in records
  const char* time;             ///< in records of times
  bool RepairOptions::*option;  ///< false switches it off, and it alone; null: elements of order 1 do
  FinishAt at;
  bool (*applies)(const FinishContext& to);
  void (*run)(FinishContext& on);  ///< null: see FinishAt::kProblem
};

/// Returns all steps, in the order in which they run.
const std::vector<FinishStep>& finish_steps();

/// Runs the steps of one place. The log gets the time of each.
void run_finish_steps(FinishAt at, FinishContext& on);

/// Notes the seconds of a step, and adds them to "finish".
void note_seconds(const char* step, double seconds, Summaries& summaries);

/// Returns whether cuts hinder such stages, which begin from quads. This holds for stages that fill cavities,
/// as no cavity crosses a cut. In a given mesh, nodes on cuts can only move along these, so cuts hinder every
/// stage.
bool cuts_obstruct(const MeshingSetup& prepared, const std::vector<const Stage*>& of_quads);

/// Runs the stages that begin from quads once more with other cuts, in faces that have cuts. The mesh that
/// they made is replaced where that is better; it has no lines on cuts then.
void run_across_cuts(FinishContext& on);

/// prepare_problem() of the same problem.
using PrepareWithHints = std::function<MeshingSetup(const RetryHints&)>;

/// Returns the work on a mesh as a number of quads that take as long. It counts quads, lifting, looks of
/// stages, steps of curves and triangles of maps, so that it is the same on every machine.
long long work_on(const MeshingSetup& prepared, const MeshResult& result);

/// Halves the size around places where the mesh of a surface is not sound, and meshes anew. It goes on as
/// long as there get fewer such places, within a budget of work_on(). If that does not help, sharp edges
/// there become features. `prepared` and `result` become the best mesh, with a warning and the time of all
/// tries. If it is not sound, a warning says why there are no more tries. Then what is narrower than a tenth
/// of the size is left out. Last, another size, fewer stages or, of triangulations, another feature angle are
/// tried. Each is taken if the mesh is sound, with a warning. If the problem says keep_going, faces with such
/// places are left out if others remain.
void refine_unsound(const PrepareWithHints& prepare_with_hints, const Word& word, MeshingSetup& prepared,
                    MeshResult& result);

/// Returns whether a mesh that was made of a given one is worse. It is worse if it is not sound where the
/// given one was, or has harm. It is worse, too, if none of eta mean, eta worst and d4 is better and one of
/// them is worse. It is not worse if it is sound where the given one was not.
bool is_worse(const MeshResult& after, const MeshResult& before);

/// Returns whether it is not worse, and fewer quads fail, see failing_part(). If as many fail, the sum of eta
/// mean, eta worst and the share of regular vertices must be larger.
bool is_better(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before);

/// Returns whether there are fewer irregular vertices, no more quads fail, and edges are as near to their
/// size.
bool is_more_regular(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before);

/// Returns whether the worst eta is above this or what it was.
bool keeps_worst_eta(double eta, const MeshResult& after, const MeshResult& before);

/// Takes another mesh and what is measured of it.
void take_mesh(MeshResult&& from, MeshResult& result);

}  // namespace delquad
