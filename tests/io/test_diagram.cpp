#include "io/diagram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using testing_support::read_text;
using testing_support::TemporaryFolder;

std::string drawn(const std::vector<DiagramSeries>& lines) {
  const TemporaryFolder folder;
  draw_diagram(folder / "c.svg", {"a < b", {"steps"}, {"cost"}, DiagramKind::kLines, lines});
  return read_text(folder / "c.svg");
}

TEST(DiagramLines, SpanTheAxes) {
  const std::string text = drawn({{"", {{1, 10}, {2, 4}, {3, 2}}, {{1, 10}, {3, 2}}}});
  EXPECT_NE(text.find("a &lt; b"), std::string::npos);
  EXPECT_NE(text.find(">steps<"), std::string::npos);
  EXPECT_NE(text.find(">cost<"), std::string::npos);
  // From the upper left corner of the axes to the lower right one, but for margins of 3 %; dots at the ends.
  EXPECT_NE(text.find("d=\"M95.8 60.2L360.0 314.9L624.2 399.8\""), std::string::npos) << text;
  EXPECT_NE(text.find("d=\"M95.8 60.2h.1M624.2 399.8h.1\""), std::string::npos) << text;
  EXPECT_NE(text.find(">2.5<"), std::string::npos);  // a tick of x
}

TEST(DiagramLines, LeaveOutWhatIsNotFinite) {
  const std::string text =
      drawn({{"", {{1, 1}, {2, NAN}, {3, INFINITY}, {4, 0}}}, {"", {}}, {"", {{1, NAN}}, {{1, NAN}}}});
  EXPECT_NE(text.find("d=\"M95.8 60.2L624.2 399.8\""), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST(DiagramLines, OfOneValueOrNoneAreDrawn) {
  using Lines = std::vector<DiagramSeries>;
  for (const Lines& lines : {Lines{}, Lines{{"", {{1, 5}}}}, Lines{{"", {{1, 0}, {2, 0}}}}}) {
    const std::string text = drawn(lines);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_NE(text.find("</svg>"), std::string::npos);
  }
}

}  // namespace
}  // namespace delquad
