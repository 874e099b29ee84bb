#include <fmt/format.h>

#include <cstdio>

#include "apps/commands.h"
#include "pipeline/experiment_runner.h"
#include "pipeline/located.h"

namespace delquad {

namespace {

/// Empty words are kept, for parse_words() to refuse.
std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words(1);
  for (const char c : list) {
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

}  // namespace

int run_command(const RunArguments& arguments) {
  set_thread_count(arguments.threads);
  Experiment experiment = read_experiment(arguments.experiment, arguments.data);
  if (arguments.pipelines)
    experiment.words = located("--pipelines", [&] { return parse_words(split(*arguments.pipelines)); });
  for (Case& c : experiment.cases) c.options.max_elements = arguments.max_elements;

  ExperimentOutcome outcome;
  {
    Progress progress(experiment_steps(experiment));
    outcome = run_experiment(experiment, arguments.folder, progress);
  }
  fmt::print("{}\nresults: {}\n", to_markdown(outcome.table), arguments.folder.string());
  if (outcome.internal_errors > 0) return kInternalError;
  if (outcome.bad_inputs > 0) return kBadInput;
  if (outcome.leftover_triangles == 0 || arguments.allow_triangles) return kDone;
  fmt::print(stderr, "error: {} triangles are left among the quads (--allow-triangles accepts them)\n",
             outcome.leftover_triangles);
  return kTrianglesLeft;
}

}  // namespace delquad
