// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/activity.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Without the seconds, which differ from run to run.
std::string told() {
  std::string text = current_activities()->text();
  for (auto at = text.find(" ("); at != text.npos; at = text.find(" ("))
    text.erase(at, text.find(')', at) + 1 - at);
  return text;
}

TEST(Activity, IsTheStageOrItsFaces) {
  const RunScope run;
  const StageScope reading("reading");
  EXPECT_EQ(told(), "reading");
  {
    const StageScope merging("matching");
    const FaceScope face(12);
    EXPECT_EQ(told(), "matching of face 12");
    const StageScope treating("treatment");
    EXPECT_EQ(told(), "treatment of face 12");
    const FaceScope inner(3, "region");
    EXPECT_EQ(told(), "treatment of face 12, region 3");
    EXPECT_EQ(current_activities()->faces_text(), "face 12, region 3");
  }
  EXPECT_EQ(told(), "reading");
  EXPECT_EQ(current_activities()->faces_text(), "");
}

TEST(Activity, OfOtherThreadsIsSeen) {
  const RunScope scope;
  const StageScope stage("insertion");
  std::thread other([run = current_run()] {
    const WorkerScope works(run);
    const FaceScope face(7);
    const StageScope inner("matching");
    EXPECT_EQ(told(), "matching of face 7");
    std::thread([run] {
      const WorkerScope works_too(run);
      EXPECT_EQ(told(), "matching of face 7");
    }).join();
  });
  other.join();
  EXPECT_EQ(told(), "insertion");
}

TEST(Activity, TellsOfTheLongestAndHowManyOthers) {
  const RunScope run({.threads = 4});
  const StageScope stage("insertion");
  std::vector<std::unique_ptr<FaceScope>> faces;
  for (int f = 1; f <= 10; ++f) faces.push_back(std::make_unique<FaceScope>(f));
  EXPECT_EQ(told(), "insertion of face 1, face 2, face 3, face 4 and 6 others");
  EXPECT_EQ(current_activities()->faces().size(), 10u);
  while (!faces.empty()) faces.pop_back();
  EXPECT_EQ(told(), "insertion");
}

TEST(Activity, CountsTheTimeOfItsThread) {
  const RunScope run;
  const FaceScope face(1);
  while (current_activities()->faces().at(0).cpu_seconds < 0.05) {
  }
  EXPECT_GE(current_activities()->faces().at(0).seconds, 0.04);
}

/// In a process just forked nobody comes to the end of the parent's scopes.
TEST(Activity, IsForgottenWhenCleared) {
  const RunScope run;
  const StageScope stage("insertion");
  {
    const FaceScope face(5);
    current_activities()->clear();
    EXPECT_EQ(told(), "starting");
    const FaceScope other(6);
    EXPECT_EQ(current_activities()->faces_text(), "face 6");
  }
  EXPECT_EQ(current_activities()->faces_text(), "");
}

TEST(Activity, OfAnotherProcessHasNoProcessorTime) {
  const RunScope run;
  const FaceScope here(1);
  const RemoteFaceScope there(2, "triangulation");
  const auto faces = current_activities()->faces();
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_EQ(faces[1].stage, "triangulation");
  EXPECT_EQ(faces[1].tag, 2);
  EXPECT_EQ(faces[1].cpu_seconds, 0);
}

TEST(Activity, BelongsToItsRun) {
  const StageScope nobody("outside");
  EXPECT_EQ(current_activities(), nullptr);
  Activities own(4);
  const RunScope outer({.activities = &own});
  const StageScope reading("reading");
  std::thread([] {
    const RunScope other;
    const FaceScope face(7);
    EXPECT_EQ(current_activities()->faces_text(), "face 7");
  }).join();
  EXPECT_EQ(told(), "reading");
  const RunScope inner({.threads = 2});  // tells the activities of the scope around
  const FaceScope face(3);
  EXPECT_EQ(own.faces_text(), "face 3");
}

TEST(Activity, IsTakenAtOnce) {
  std::vector<std::pair<int, bool>> calls;
  Activities own(4);
  own.on_face = [&](int tag, bool begins) { calls.emplace_back(tag, begins); };
  const RunScope run({.activities = &own});
  {
    const FaceScope first(1);
    const FaceScope second(2);
  }
  EXPECT_EQ(calls, (std::vector<std::pair<int, bool>>{{1, true}, {2, true}, {2, false}, {1, false}}));
}

TEST(Activity, TextIsCutToItsRoom) {
  const RunScope run;
  const StageScope stage("reading");
  char text[5] = "????";
  EXPECT_EQ(current_activities()->describe(text, sizeof text), 4u);
  EXPECT_STREQ(text, "read");
}

}  // namespace
}  // namespace delquad
