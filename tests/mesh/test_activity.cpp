#include "mesh/activity.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <thread>

namespace delquad {
namespace {

/// Without the seconds, which differ from run to run.
std::string told() {
  std::string text = doing();
  for (auto at = text.find(" ("); at != text.npos; at = text.find(" ("))
    text.erase(at, text.find(')', at) + 1 - at);
  return text;
}

TEST(Activity, IsTheStageOrItsFaces) {
  const DoingStage reading("reading");
  EXPECT_EQ(told(), "reading");
  {
    const DoingStage merging("matching");
    const DoingFace face(12);
    EXPECT_EQ(told(), "matching of face 12");
    const DoingStage treating("treatment");
    EXPECT_EQ(told(), "treatment of face 12");
    const DoingFace inner(3, "region");
    EXPECT_EQ(told(), "treatment of face 12, region 3");
    EXPECT_EQ(faces_doing(), "face 12, region 3");
  }
  EXPECT_EQ(told(), "reading");
  EXPECT_EQ(faces_doing(), "");
}

TEST(Activity, OfOtherThreadsIsSeen) {
  const DoingStage stage("insertion");
  std::thread other([] {
    const DoingFace face(7);
    const DoingStage inner("matching");
    EXPECT_EQ(told(), "matching of face 7");
    std::thread([] { EXPECT_EQ(told(), "matching of face 7"); }).join();
  });
  other.join();
  EXPECT_EQ(told(), "insertion");
}

TEST(Activity, TellsOfTheLongestAndHowManyOthers) {
  const DoingStage stage("insertion");
  std::vector<std::unique_ptr<DoingFace>> faces;
  for (int f = 1; f <= 10; ++f) faces.push_back(std::make_unique<DoingFace>(f));
  EXPECT_EQ(told(), "insertion of face 1, face 2, face 3, face 4 and 6 others");
  EXPECT_EQ(faces_at_work().size(), 10u);
  while (!faces.empty()) faces.pop_back();
  EXPECT_EQ(told(), "insertion");
}

TEST(Activity, CountsTheTimeOfItsThread) {
  const DoingFace face(1);
  while (faces_at_work().at(0).cpu_seconds < 0.05) {
  }
  EXPECT_GE(faces_at_work().at(0).seconds, 0.04);
}

/// A child may die at any place.
TEST(Activity, OfAChildIsSeenUntilItIsForgotten) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const DoingFace face(5);
    const bool told_so = write(ends[1], "x", 1) == 1;
    pause();
    _exit(told_so ? 0 : 1);
  }
  char c;
  ASSERT_EQ(read(ends[0], &c, 1), 1);
  EXPECT_EQ(faces_doing(), "face 5");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(faces_doing(), "face 5");
  forget_activities(child);
  EXPECT_EQ(faces_doing(), "");
  close(ends[0]);
  close(ends[1]);
}

TEST(Activity, TextIsCutToItsRoom) {
  const DoingStage stage("reading");
  char text[5] = "????";
  EXPECT_EQ(describe_doing(text, sizeof text), 4u);
  EXPECT_STREQ(text, "read");
}

}  // namespace
}  // namespace delquad
