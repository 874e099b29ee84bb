#pragma once

#include <string>
#include <vector>

#include "mesher/repair_options.h"
#include "mesher/runner.h"

namespace delquad {

/// When a finish step runs, and on what.
enum class FinishAt {
  kEveryStage,  ///< after each letter, on all patches
  kPatches,     ///< after the last one, on all patches
  kMesh,        ///< on the mesh that these make
  kMeasured,    ///< on the mesh and its measures
  kProblem,     ///< on the problem, which is meshed anew: see refine_unsound()
};

/// A mesh on its way from the letters to its result.
struct Finishing {
  const PreparedProblem& prepared;
  MeshingState& state;
  std::vector<char> left_out;  ///< by region
  RunResult result = {};       ///< the mesh from FinishAt::kMesh on, its measures from FinishAt::kMeasured on
  std::string label = {};      ///< names case and pipeline in warnings
};

/// What is done to a mesh beside the letters of its word.
struct FinishStep {
  const char* name;             ///< in records
  const char* time;             ///< in records of times
  bool RepairOptions::*option;  ///< false switches it off, and it alone; null: elements of order 1 do
  const char* touches;
  FinishAt at;
  bool (*applies)(const Finishing& to);
  bool (*run)(Finishing& on);  ///< returns whether anything changed; null: see FinishAt::kProblem
};

/// All of them, in the order in which they run.
const std::vector<FinishStep>& finish_steps();

/// Runs the steps of one place. The log gets the time of each, and the worth of the mesh before and after
/// where a step changed it.
void run_finish_steps(FinishAt at, Finishing& on);

/// What finish steps are about.
struct MeshWorth {
  double eta_mean, eta_worst;
  double irregular;  ///< vertices
  double failing;    ///< places where the mesh is not sound, the first hundred for each reason
};
MeshWorth worth_of(const RunResult& measured);
/// The seconds of a step, and what it was worth where it changed the mesh. The sums over all steps are those
/// of "finish".
void note_seconds(const char* step, double seconds, Summaries& summaries);
void note_worth(const char* step, const MeshWorth& before, const MeshWorth& after, Summaries& summaries);

}  // namespace delquad
