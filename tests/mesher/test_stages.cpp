// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(Words, SomeMayLeaveTriangles) {
  for (const char* word : {"FB", "DBC", "DLBCO"}) EXPECT_TRUE(parse_pipeline(word).quads_only()) << word;
  for (const char* word : {"FG", "DT", "FGC", "F"}) EXPECT_FALSE(parse_pipeline(word).quads_only()) << word;
  expect_input_error([] { parse_pipeline("FGB"); }, {"'B'", "quads"});
}

TEST(Words, AreReadFromLeftToRight) {
  const Pipeline d = parse_pipeline("D");
  ASSERT_EQ(d.stages.size(), 1u);
  EXPECT_EQ(d.stages[0]->letter, 'D');
  EXPECT_EQ(d.result, PatchForm::kTriangles);
  const Pipeline fb = parse_pipeline("FB");
  ASSERT_EQ(fb.stages.size(), 2u);
  EXPECT_EQ(fb.stages[0]->letter, 'F');
  EXPECT_EQ(fb.stages[1]->letter, 'B');
  EXPECT_EQ(fb.result, PatchForm::kQuads);
  EXPECT_EQ(parse_pipeline("PB").result, PatchForm::kQuads);
}

TEST(Words, SmoothingComesBetween) {
  for (const char* text : {"FL", "DL", "FLB", "DLB", "FLLB"}) EXPECT_EQ(parse_pipeline(text).text, text);
  EXPECT_EQ(parse_pipeline("DL").result, PatchForm::kTriangles);
  EXPECT_EQ(parse_pipeline("DLB").result, PatchForm::kQuads);
  expect_input_error([] { parse_pipeline("L"); }, {"'L' starts from triangles", "starts from a boundary"});
  expect_input_error([] { parse_pipeline("DBL"); }, {"'L' starts from triangles", "leaves quads"});
}

TEST(Words, StagesOnQuadsFollowRecombination) {
  EXPECT_EQ(parse_pipeline("DBC").result, PatchForm::kQuads);
  EXPECT_EQ(parse_pipeline("FBCO").stages.size(), 4u);
  EXPECT_EQ(parse_pipeline("DBO").result, PatchForm::kQuads);
  expect_input_error([] { parse_pipeline("DC"); }, {"'C' starts from quads", "leaves triangles"});
}

TEST(Words, MistakesNameTheLetter) {
  expect_input_error([] { parse_pipeline(""); }, {"F (", "D (", "B ("});
  expect_input_error([] { parse_pipeline("DZ"); }, {"'DZ'", "'Z'", "F (", "D (", "B ("});
  expect_input_error([] { parse_pipeline("db"); }, {"'d'"});
  expect_input_error([] { parse_pipeline("B"); }, {"'B' starts from triangles", "starts from a boundary"});
  expect_input_error([] { parse_pipeline("FD"); }, {"'D' starts from a boundary", "leaves triangles"});
  expect_input_error([] { parse_pipeline("DBB"); }, {"'B' starts from triangles", "leaves quads"});
}

TEST(Words, LettersDiffer) {
  std::string letters;
  for (const Stage& stage : stage_registry()) {
    EXPECT_EQ(letters.find(stage.letter), std::string::npos) << stage.letter;
    letters += stage.letter;
  }
}

TEST(StageLogs, SumEachStep) {
  StageLog log;
  log.add_seconds("insertion", 1);
  log.add_time("matching", {.seconds = 2, .cpu = 1.5});
  StageLog other;
  other.add_time("insertion", {.seconds = 3, .cpu = 3});
  log.add(other);
  ASSERT_EQ(log.times.size(), 2u);
  const auto& [insertion, time] = log.times[0];
  EXPECT_EQ(insertion, "insertion");
  EXPECT_EQ(log.times[1].first, "matching");
  EXPECT_EQ((std::vector{time.seconds, time.cpu}), (std::vector<double>{4, 3}));
}

}  // namespace
}  // namespace delquad
