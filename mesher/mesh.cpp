#include <utility>

#include "base/context.h"
#include "delquad/mesher.h"
#include "mesher/prepare.h"
#include "mesher/refine_unsound.h"
#include "mesher/runner.h"
#include "mesher/stages.h"

namespace delquad {
namespace {

/// Tells of steps as they begin.
class Steps {
 public:
  Steps(const Context& context, std::size_t steps) : context_(context), steps_(static_cast<double>(steps)) {}
  void begin(const std::string& stage) {
    check_cancelled();
    if (context_.progress) context_.progress({stage, static_cast<double>(begun_) / steps_});
    ++begun_;
  }

 private:
  const Context& context_;
  double steps_;
  int begun_ = 0;
};

MeshResult result_of(const PreparedProblem& prepared, RunResult run) {
  MeshResult result;
  result.mesh = std::move(run.mesh);
  result.metrics = std::move(run.metrics);
  result.soundness = std::move(run.soundness);
  result.summaries = std::move(run.log.summaries);
  result.warnings = prepared.warnings;
  result.warnings.insert(result.warnings.end(), run.warnings.begin(), run.warnings.end());
  if (!result.soundness.accepted()) result.warnings.emplace_back(result.soundness.complaint());
  result.failures = std::move(run.failures);
  result.surface = std::move(run.surface);
  for (const StepTimes* times : {&prepared.times, &std::as_const(run.log.times)})
    for (const auto& [step, time] : *times) result.seconds.emplace_back(step, time.work);
  result.wall_seconds = run.seconds;
  result.expected_quads = prepared.size.expected_quads;
  return result;
}

}  // namespace

MeshResult mesh(const MeshProblem& problem, const std::string& word, const Context& context) {
  const Word stages = parse_word(word, word_start(problem.model));
  const RunScope running(
      {.threads = context.threads, .cancel = context.cancel, .seconds = context.time_limit});
  Steps steps(context, stages.stages.size() + 2);
  steps.begin("boundary and fields");
  PreparedProblem prepared = prepare(problem);
  RunResult run = run_word(prepared, stages, [&](const std::string& stage) { steps.begin(stage); });
  refine_unsound([&](const Refinement& r) { return prepare(problem, r); }, stages, prepared, run);
  MeshResult result = result_of(prepared, std::move(run));
  if (!result.soundness.accepted() && !problem.allow_unsound) {
    const std::string why = result.soundness.complaint();
    throw UnsoundError(problem.name + " " + word + ": " + why,
                       std::make_shared<const MeshResult>(std::move(result)));
  }
  return result;
}

}  // namespace delquad
