// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_experiment.h"
#include "io/cases/case_file.h"
#include "smoothing/cvt/smooth_points.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

class SmoothingStage : public testing::Test {
 protected:
  Case read(const std::string& smoothing) {
    return read_model_case(write_text(
        folder_ / "c.toml",
        "loop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.15\nsmoothing = " + smoothing + "\n"));
  }
  void run(const std::string& smoothing, const std::string& words) {
    const auto file = write_text(folder_ / "e.toml",
                                 "pipelines = " + words + "\nsmoothing = " + smoothing +
                                     "\n[[case]]\nname = 'disk'\n"
                                     "loop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.15\n");
    const Outcome outcome = run_experiment(Experiment::read(file), folder_ / "out");
    EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0);
    EXPECT_EQ(outcome.leftover_triangles, 0);
  }
  Json record(const std::string& word) {
    return Json::parse(std::ifstream(folder_ / "out" / "disk" / word / "record.json"));
  }
  Folder folder_;
};

TEST_F(SmoothingStage, OptionsAreRead) {
  EXPECT_EQ(smoothing_options(read("{}").options).p, 6);
  const SmoothingOptions o = smoothing_options(
      read("{ p = 8, outer_iterations = 2, inner_iterations = 7, function_tolerance = 1e-3 }").options);
  EXPECT_EQ(o.p, 8);
  EXPECT_EQ(o.outer_iterations, 2);
  EXPECT_EQ(o.inner.iterations, 7);
  EXPECT_EQ(o.inner.function_tolerance, 1e-3);
}

TEST_F(SmoothingStage, MistakesAreNamed) {
  expect_input_error([&] { read("{ p = 5 }"); }, {"c.toml:3", "'smoothing.p' is 5", "2, 4, 6"});
  expect_input_error([&] { read("{ p = 18 }"); }, {"c.toml:3", "14 or 16"});
  expect_input_error([&] { read("{ method = 'lloyd' }"); },
                     {"c.toml:3", "'smoothing.method' was removed", "exact gradient"});
  expect_input_error([&] { read("{ inner_iterations = -1 }"); },
                     {"c.toml:3", "'smoothing.inner_iterations' is -1"});
  expect_input_error([&] { read("{ function_tolerance = -1 }"); }, {"'smoothing.function_tolerance' is -1"});
  expect_input_error([&] { read("{ q = 4 }"); }, {"'smoothing.q'"});
}

TEST_F(SmoothingStage, RecordsItsConvergence) {
  run("{ outer_iterations = 2 }", "[\"F\", \"FL\", \"FLB\", \"DLB\"]");
  const Json f = record("F"), fl = record("FL");
  EXPECT_EQ(f["metrics"]["n_vertices"], fl["metrics"]["n_vertices"]);
  EXPECT_FALSE(f.contains("smoothing"));
  const Json s = fl["smoothing"];
  EXPECT_LT(s["final_energy"], s["first_energy"]);
  EXPECT_GT(s["iterations"], 3);
  EXPECT_EQ(s["energy_by_evaluation"].size(), 1u);
  EXPECT_EQ(s["energy_by_evaluation"][0].size(), s["evaluations"]);
  EXPECT_EQ(s["energy_by_evaluation"][0][0], s["first_energy"]);
  EXPECT_EQ(s["first_of_frames"][0].size(), s["outer_iterations"]);
  EXPECT_GE(s["accepted_evaluations"][0].size(), s["iterations"]);
  EXPECT_LE(s["accepted_evaluations"][0].size(), s["evaluations"]);
  EXPECT_EQ(s["termination"].size(), 1u);
  EXPECT_EQ(fl["problem"]["options"]["smoothing"]["outer_iterations"], 2);
  EXPECT_TRUE(fl["seconds"].contains("smoothing"));
}

}  // namespace
}  // namespace delquad
