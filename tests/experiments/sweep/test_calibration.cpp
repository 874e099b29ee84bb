// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/calibration.h"
#include "experiments/sweep/peer.h"
#include "mesher/prepare.h"
#include "metrics/tables/notes.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr CalibrationLimits kLimits = {.tolerance = 0.01, .most_runs = 8};

/// A mesher whose number of quads is a power of its size.
auto power_law(double at_one, double power) {
  return [=](double scale) { return std::optional(std::round(at_one * std::pow(scale, power))); };
}

TEST(Calibration, IsDoneWithOneRunWhereTheNumberIsRight) {
  const Calibration done = calibrate_scale(1000, kLimits, power_law(1009, -2));
  EXPECT_EQ(done.runs, 1);
  EXPECT_EQ(done.scale, 1);
  EXPECT_EQ(done.quads, 1009);
}

TEST(Calibration, FindsTheScaleOfPowerLaws) {
  for (const double power : {-2.0, -1.5, -1.0, -3.0})
    for (const double at_one : {400.0, 900.0, 1200.0, 2500.0}) {
      const Calibration done = calibrate_scale(1000, kLimits, power_law(at_one, power));
      EXPECT_NEAR(done.quads, 1000, 10) << at_one << " " << power;
      EXPECT_NEAR(std::round(at_one * std::pow(done.scale, power)), done.quads, 0.5)
          << "its scale is the one";
      EXPECT_LE(done.runs, 5) << at_one << " " << power;
    }
}

/// Two power laws with a jump between: there is no scale with 1000.
TEST(Calibration, KeepsTheClosestWhereTheNumberJumps) {
  int runs = 0;
  const Calibration done = calibrate_scale(1000, kLimits, [&](double scale) {
    ++runs;
    return std::optional(std::round((scale < 1.1 ? 1500 : 1150) / (scale * scale)));
  });
  EXPECT_EQ(runs, done.runs);
  EXPECT_LE(runs, kLimits.most_runs);
  EXPECT_LT(std::abs(std::log(done.quads / 1000)), std::log(1.25));
  for (const auto& tried : done.tried)
    EXPECT_LE(std::abs(std::log(done.quads / 1000)), std::abs(std::log(tried[1] / 1000)));
}

TEST(Calibration, EndsWhereNothingFollowsTheSize) {
  int runs = 0;
  const Calibration done =
      calibrate_scale(1000, kLimits, [&](double) { return ++runs, std::optional(500.0); });
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(done.quads, 500);
  EXPECT_EQ(done.scale, 1);
}

TEST(Calibration, EndsWithTheRunBeforeAFailure) {
  const Calibration done = calibrate_scale(1000, kLimits, [](double scale) {
    return scale == 1 ? std::optional(500.0) : std::optional<double>();
  });
  EXPECT_EQ(done.runs, 2);
  EXPECT_EQ(done.quads, 500);
  EXPECT_EQ(done.scale, 1);
}

TEST(Calibration, NeverLeavesTheRangeOfScales) {
  calibrate_scale(1e9, kLimits, [](double scale) {
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

Prepared square() {
  MeshProblem problem;
  problem.model = polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  problem.size.field = make_constant_size(0.25);
  return prepare(problem);
}

/// A record counts when it is of the same cell; else the word is run.
TEST(ReferenceQuads, AreThoseOfAValidRecord) {
  const Folder folder;
  const Prepared prepared = square();
  const auto quads = [&](const std::string& record) {
    write_text(folder / "record.json", record);
    return reference_quads(prepared, "DB", {folder.path(), "abc"});
  };
  EXPECT_EQ(reference_quads(prepared, "DB", {}), 16);
  EXPECT_EQ(reference_quads(prepared, "DB", {folder.path(), "abc"}), 16) << "there is none yet";
  EXPECT_EQ(quads(R"({"key": "abc", "status": "ok", "metrics": {"n_quads": 10, "n_triangles": 4}})"), 12);
  EXPECT_EQ(quads(R"({"key": "x", "status": "ok", "metrics": {"n_quads": 10, "n_triangles": 4}})"), 16);
  EXPECT_EQ(quads(R"({"key": "abc", "status": "ok", "met)"), 16) << "cut off";
  EXPECT_EQ(quads(R"({"key": "abc", "status": "failed", "reason": "no"})"), std::nullopt);
}

CellRecord calibrated(const CalibrationRecord& calibration, const std::string& seed = "") {
  CellRecord record;
  record.name = "plate";
  record.pipeline = "other";
  record.calibration = calibration;
  if (!seed.empty()) record.variant = {{"seed", seed}};
  return record;
}

TEST(CalibrationNotes, SayHowCloseTheNumberCame) {
  EXPECT_EQ(
      calibration_notes({calibrated({"DB", 1.08, 100, 100.5, 2}), calibrated({"DB", 1.1, 100, 99.5, 2})}),
      (Strings{"plate other: size times 1.08 to 1.1, so that it has DB's number of quads within 1 %"}));
  EXPECT_EQ(
      calibration_notes({calibrated({"DB", 1, 100, 104, 8})}),
      (Strings{
          "plate other: size times 1, and yet 1 of 1 meshes miss DB's number of quads, by +4 % at most"}));
  EXPECT_EQ(calibration_notes({calibrated({"DB", 1, 0, 0, 1})}),
            (Strings{"plate other: size as given, for DB has no mesh to compare with"}));
}

/// Tables show means over the seeds: one of them being off is not all of them being off.
TEST(CalibrationNotes, SayInHowManySeedsItWasMissed) {
  std::vector<CellRecord> cells = {
      calibrated({"DB", 1, 10000, 10000, 1}, "1"), calibrated({"DB", 1, 10000, 9497, 8}, "2"),
      calibrated({"DB", 1, 10000, 10050, 1}, "3"), calibrated({"DB", 1.1, 10000, 10200, 8}, "4")};
  EXPECT_EQ(calibration_notes(cells), (Strings{"plate other: size times 1 to 1.1, and yet 2 of 4 meshes miss "
                                               "DB's number of quads, by -5.03 % at most"}));
  cells[1].calibration->ended_by = "it crashed";
  EXPECT_TRUE(calibration_notes(cells)[0].ends_with("-5.03 % at most: it crashed"));
}

/// Records of a word on cases, with these numbers of quads.
void add_cells(const std::string& word, const std::vector<double>& quads, std::vector<CellRecord>& records) {
  for (std::size_t i = 0; i < quads.size(); ++i) {
    CellRecord record;
    record.name = record.group = "case" + std::to_string(i);
    record.pipeline = word;
    record.values = {{"n_quads", quads[i]}, {"n_triangles", 0}};
    records.push_back(record);
  }
}

/// Only peers are brought to the word's number: the study's other words have their own.
TEST(QuadCountNotes, SayHowMuchTheOtherWordsDiffer) {
  std::vector<CellRecord> records;
  add_cells("FB", {103, 117}, records);
  add_cells("DBCO", {100, 100}, records);
  EXPECT_TRUE(quad_count_notes(records).empty());
  add_cells("few", {98, 95}, records);
  add_cells("both", {98, 110}, records);
  add_cells("alike", {100.5, 99.5}, records);
  add_cells("peer", {101, 120}, records);
  for (std::size_t i = records.size() - 2; i < records.size(); ++i)
    records[i].calibration = CalibrationRecord{"DBCO", 1, 100, 101, 2};
  EXPECT_EQ(quad_count_notes(records),
            (Strings{"Calibrated, by their sizes, to DBCO's number of quads: peer. Not calibrated, beside "
                     "it: FB +3 to +17 %, few -5 to -2 %, both -2 to +10 %"}));
}

}  // namespace
}  // namespace delquad
