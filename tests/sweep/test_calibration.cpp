#include <gtest/gtest.h>

#include <cmath>

#include "mesher/prepare.h"
#include "sweep/calibration.h"
#include "sweep/calibration_notes.h"
#include "sweep/fairness_notes.h"
#include "sweep/peer_reference.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

/// A mesher whose number of quads is a power of its size.
auto power_law(double at_one, double power) {
  return [=](double scale) { return std::optional(std::round(at_one * std::pow(scale, power))); };
}

TEST(Calibration, IsDoneWithOneRunWhereTheNumberIsRight) {
  const Calibration done = calibrate_scale(1000, power_law(1009, -2));
  EXPECT_EQ(done.runs, 1);
  EXPECT_EQ(done.scale, 1);
  EXPECT_EQ(done.quads, 1009);
}

TEST(Calibration, FindsTheScaleOfPowerLaws) {
  for (const double power : {-2.0, -1.5, -1.0, -3.0})
    for (const double at_one : {400.0, 900.0, 1200.0, 2500.0}) {
      const Calibration done = calibrate_scale(1000, power_law(at_one, power));
      EXPECT_NEAR(done.quads, 1000, 10) << at_one << " " << power;
      EXPECT_NEAR(std::round(at_one * std::pow(done.scale, power)), done.quads, 0.5)
          << "its scale is the one";
      EXPECT_LE(done.runs, 5) << at_one << " " << power;
    }
}

/// Two power laws with a jump between: there is no scale with 1000.
TEST(Calibration, KeepsTheClosestWhereTheNumberJumps) {
  int runs = 0;
  const Calibration done = calibrate_scale(1000, [&](double scale) {
    ++runs;
    return std::optional(std::round((scale < 1.1 ? 1500 : 1150) / (scale * scale)));
  });
  EXPECT_EQ(runs, done.runs);
  EXPECT_LE(runs, kMostCalibrationRuns);
  EXPECT_LT(std::abs(std::log(done.quads / 1000)), std::log(1.25));
  for (const auto& tried : done.tried)
    EXPECT_LE(std::abs(std::log(done.quads / 1000)), std::abs(std::log(tried[1] / 1000)));
}

TEST(Calibration, EndsWhereNothingFollowsTheSize) {
  int runs = 0;
  const Calibration done = calibrate_scale(1000, [&](double) { return ++runs, std::optional(500.0); });
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(done.quads, 500);
  EXPECT_EQ(done.scale, 1);
}

TEST(Calibration, EndsWithTheRunBeforeAFailure) {
  const Calibration done = calibrate_scale(
      1000, [](double scale) { return scale == 1 ? std::optional(500.0) : std::optional<double>(); });
  EXPECT_EQ(done.runs, 2);
  EXPECT_EQ(done.quads, 500);
  EXPECT_EQ(done.scale, 1);
}

TEST(Calibration, NeverLeavesTheRangeOfScales) {
  calibrate_scale(1e9, [](double scale) {
    EXPECT_GE(scale, 0.249);
    EXPECT_LE(scale, 4.001);
    return std::optional(100 / (scale * scale));
  });
}

TEST(Calibration, CountsATriangleAsHalfAQuad) {
  Mesh mesh;
  mesh.quads.resize(3);
  mesh.triangles.resize(5);
  EXPECT_EQ(count_of_quads(mesh), 5.5);
}

PreparedProblem square() {
  MeshProblem problem;
  problem.model = polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  problem.size.field = make_constant_size(0.25);
  return prepare(problem);
}

/// A record counts when it is of the same cell; else the word is run.
TEST(ReferenceQuads, AreThoseOfAValidRecord) {
  const testing_support::TemporaryFolder folder;
  const PreparedProblem prepared = square();
  const auto quads = [&](const std::string& record) {
    testing_support::write_text(folder / "record.json", record);
    return reference_quads(prepared, "DB", {folder.path(), "abc"});
  };
  EXPECT_EQ(reference_quads(prepared, "DB", {}), 16);
  EXPECT_EQ(reference_quads(prepared, "DB", {folder.path(), "abc"}), 16) << "there is none yet";
  EXPECT_EQ(quads(R"({"key": "abc", "status": "ok", "metrics": {"n_quads": 10, "n_triangles": 4}})"), 12);
  EXPECT_EQ(quads(R"({"key": "x", "status": "ok", "metrics": {"n_quads": 10, "n_triangles": 4}})"), 16);
  EXPECT_EQ(quads(R"({"key": "abc", "status": "ok", "met)"), 16) << "cut off";
  EXPECT_EQ(quads(R"({"key": "abc", "status": "failed", "reason": "no"})"), std::nullopt);
}

CellRecord calibrated(const CalibrationRecord& calibration) {
  CellRecord record;
  record.name = "plate";
  record.pipeline = "other";
  record.calibration = calibration;
  return record;
}

TEST(CalibrationNotes, SayTheWorstOfTheCells) {
  const auto note = [](const std::vector<CellRecord>& records) { return calibration_notes(records).at(0); };
  EXPECT_EQ(note({calibrated({"DB", 1.08, 100, 100.5, 2}), calibrated({"DB", 1.1, 100, 99.5, 2})}),
            "plate other: size times 1.08 to 1.1, so that it has DB's number of quads within 1 %");
  CellRecord one = calibrated({"DB", 1, 100, 104, 8});
  one.group = "plate@seed=2";
  EXPECT_EQ(note({one}), "plate other: size times 1, and yet 4 % more quads than DB after 8 runs");
  EXPECT_EQ(note({calibrated({"DB", 1, 100, 100, 1}), one}),
            "plate other: size times 1; 1 % missed in 1 of 2 cells, at worst 4 % more quads than DB after 8 "
            "runs (seed=2)");
  EXPECT_EQ(note({calibrated({"DB", 1, 0, 0, 1})}),
            "plate other: size as given, for DB has no mesh to compare with");
}

CellRecord mesh_of(const std::string& name, const std::string& pipeline, double quads, double triangles) {
  CellRecord record;
  record.name = record.group = name;
  record.pipeline = pipeline;
  record.values = {{"n_quads", quads}, {"n_triangles", triangles}};
  return record;
}

TEST(FairnessNotes, SayWhatIsNotComparedLikeWithLike) {
  std::vector<CellRecord> records = {mesh_of("a", "DB", 100, 0),    mesh_of("b", "DB", 100, 0),
                                     mesh_of("a", "FB", 103, 0),    mesh_of("b", "FB", 117, 0),
                                     mesh_of("a", "other", 100, 4), mesh_of("b", "other", 100, 0)};
  const std::string triangles =
      "other leaves triangles in 1 case (a): it is not compared with others in measures of quads (eta, d4 "
      "and "
      "the like)";
  EXPECT_EQ(fairness_notes(records), std::vector<std::string>{triangles}) << "nothing was calibrated";
  for (std::size_t i : {4, 5}) records[i].calibration = CalibrationRecord{"DB", 1, 100, 100, 1};
  EXPECT_EQ(fairness_notes(records),
            (std::vector<std::string>{
                triangles,
                "FB has 3 % more to 17 % more quads than DB, to whose number the other meshers were "
                "brought"}));
  EXPECT_TRUE(fairness_notes({records[0], records[1]}).empty());
}

}  // namespace
}  // namespace delquad
