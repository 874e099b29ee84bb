// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/warning.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(Warnings, OfAKindAreOneLineWithTheirNumberAndTheWorst) {
  const std::vector<Warning> warnings = {
      {"short curves", 2, "curve 1 is short"}, "alone", {"flat faces", 1, "face 9 is flat"},
      {"short curves", 7, "curve 5 is short"}, "alone", {"short curves", 7, "curve 6 is short"}};
  EXPECT_EQ(summaries(warnings), (std::vector<std::string>{"3 short curves; the worst: curve 5 is short",
                                                           "alone", "face 9 is flat", "alone"}));
  EXPECT_EQ(texts(warnings).size(), warnings.size());
  EXPECT_TRUE(summaries({}).empty());
}

}  // namespace
}  // namespace delquad
