// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "experiments/sweep/experiment.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/tables.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace delquad::fuzz {

namespace {

namespace fs = std::filesystem;

/// An experiment is read, and the first of its cells.
bool try_experiment(std::string_view bytes) {
  static InputFile file("input.toml");
  const fs::path& path = file.hold(bytes);
  return result_or_input_error(path.string(), [&] {
    const Experiment experiment = Experiment::read(path, file.folder());
    describe(experiment);
    constexpr std::size_t kMost = 4;
    for (std::size_t i = 0; i < std::min(experiment.n_cases(), kMost); ++i)
      for (std::size_t variant = 0; variant < std::min(experiment.n_variants(), kMost); ++variant)
        experiment.read_variant(i, variant);
  });
}

const std::string kStudy =
    R"({"record": 3, "title": "t", "experiment": "e", "problems": {"disc": ["p"]}, "cases": ["disc"], "pipelines": ["DB", "FB"], "cells": 4, "step_times": true,)"
    R"( "compare": {"disc": {"DB": "row"}}, "axes": [["seed", ["1", "2"]]], "published": [{"name": "row", "source": "s",)"
    R"( "values": {"n_quads": 7, "eta_mean": 0.5}}], "columns": ["n_quads"], "pairs": ["seed"], "plan": "p", "geometry":)"
    R"( {"disc": {"domain": "", "digest": "d", "shape": [1, 2.5], "chord_error": 0}}, "hypotheses": [{"better": "DB", "than":)"
    R"( "FB", "along": "", "measures": ["own"]}], "may_fail": [], "plan_changed": false})";
const std::string kRecord =
    R"({"record": 3, "case": "disc", "pipeline": "DB", "variant": {"seed": "1"}, "status": "ok", "quads_only": true, "metrics":)"
    R"( {"n_quads": 12, "eta_mean": 0.9, "own": null}, "own_metrics": [{"name": "own", "title": "Own", "unit": "",)"
    R"( "better": "higher", "digits": 3}], "failed_metrics": {"own": "why"}, "meshing_seconds": 0.5, "seconds":)"
    R"( {"insertion": 0.1, "peer": 2}, "warnings": ["w"], "unsound": ["u"], "domain": {"size_adapted_to":)"
    R"( ["curvature"]}, "problem": {"size": {"base": "0.1", "source": []}}, "calibration": {"to": "DB",)"
    R"( "size_factor": 1.5, "wanted_quads": 12, "quads": 11, "runs": 3}})";
const std::string kFailed =
    R"({"record": 3, "case": "disc", "pipeline": "FB", "variant": {"seed": "2"}, "status": "failed", "kind": "input", "reason": "r"})";

/// A folder of results of which one file holds the input: its records and tables.
class Results {
 public:
  explicit Results(const std::string& name) : input_(name) {
    write("study.json", kStudy);
    write("disc@seed=1/DB/record.json", kRecord);
    write("disc@seed=2/FB/record.json", kFailed);
  }
  bool try_input(std::string_view bytes) {
    input_.hold(bytes);
    return result_or_input_error(input_.folder().string(), [&] {
      const Outcome outcome = make_tables(input_.folder());
      for (const TableFormat& format : table_formats()) format.print(outcome.table);
    });
  }

 private:
  void write(const std::string& name, const std::string& text) {
    const fs::path file = input_.folder() / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  InputFile input_;
};

bool try_record(std::string_view bytes) {
  static Results results("disc@seed=1/DB/record.json");
  return results.try_input(bytes);
}

bool try_study(std::string_view bytes) {
  static Results results("study.json");
  return results.try_input(bytes);
}

std::vector<std::string> experiment_seeds() {
  return {
      R"toml(title = "Two discs"
pipelines = ["DB", "FB", "other"]
columns = ["n_quads", "eta_mean"]
step_times = true
solver = ["poisson"]
size = 0.3
[[hypotheses]]
better = "DB"
than = "FB"
measures = ["poisson_h1"]
[matrix]
seed = [1, 2]
insertion = { h_max = [1.2, 1.5] }
[[peer]]
name = "other"
command = ["other", "{input}", "{output}"]
version = ["other", "--version"]
input = "geo"
output = "msh"
[[case]]
name = "disc"
loop = { circle = { centre = [0, 0], radius = 1 } }
[[case]]
name = "square"
loop = { rectangle = [[0, 0], [1, 1]] }
size = "0.1 + x"
)toml"};
}
std::vector<std::string> record_seeds() {
  return {
      kRecord,
      R"({"record": 3, "case": "disc", "pipeline": "DB", "variant": {"seed": "1"}, "status": "failed", "kind": "k", "reason": "r"})"};
}
std::vector<std::string> study_seeds() { return {kStudy}; }

}  // namespace

std::vector<Target> result_targets() {
  return {{"experiment", try_experiment, experiment_seeds},
          {"record", try_record, record_seeds},
          {"study", try_study, study_seeds}};
}

}  // namespace delquad::fuzz
