// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/disjoint_sets.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(DisjointSets, AgreeWithLabelsThatAreRewritten) {
  constexpr int kNumbers = 60;
  std::mt19937 random(7);
  DisjointSets sets(kNumbers);
  std::vector<int> label = sets.roots();
  for (int step = 0; step < 100; ++step) {
    const int i = static_cast<int>(random() % kNumbers), j = static_cast<int>(random() % kNumbers);
    const int low = std::min(label[i], label[j]), high = std::max(label[i], label[j]);
    EXPECT_EQ(sets.join(i, j), low != high);
    std::ranges::replace(label, high, low);
    EXPECT_EQ(sets.roots(), label);
  }
}

TEST(DisjointSets, GoByTheRootThatIsAskedFor) {
  DisjointSets sets(3);
  const int more = sets.add();
  EXPECT_EQ(more, 3);
  EXPECT_TRUE(sets.join_to(more, 0));
  EXPECT_TRUE(sets.join_to(0, 1));
  EXPECT_FALSE(sets.join_to(1, more));
  EXPECT_EQ(sets.roots(), (std::vector<int>{3, 3, 2, 3}));
}

}  // namespace
}  // namespace delquad
