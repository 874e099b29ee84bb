#include "io/curve_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using testing_support::read_text;
using testing_support::TemporaryFolder;

std::string drawn(const std::vector<PlotCurve>& curves) {
  const TemporaryFolder folder;
  draw_curves(folder / "c.svg", curves, "a < b", "steps", "cost");
  return read_text(folder / "c.svg");
}

TEST(CurvePlots, SpanTheAxes) {
  const std::string text = drawn({{{1, 10, true}, {2, 4}, {3, 2, true}}});
  EXPECT_NE(text.find("a &lt; b"), std::string::npos);
  EXPECT_NE(text.find(">steps<"), std::string::npos);
  EXPECT_NE(text.find(">cost<"), std::string::npos);
  // From the upper left corner of the axes to the lower right one; dots at the ends only.
  EXPECT_NE(text.find("d=\"M90.0 50.0L410.0 320.0L730.0 410.0\""), std::string::npos) << text;
  EXPECT_NE(text.find("d=\"M90.0 50.0h.1M730.0 410.0h.1\""), std::string::npos) << text;
  EXPECT_NE(text.find(">2.4<"), std::string::npos);  // a tick of x
}

TEST(CurvePlots, LeaveOutWhatIsNotFinite) {
  const std::string text = drawn({{{1, 1}, {2, NAN}, {3, INFINITY}, {4, 0}}, {}, {{1, NAN}}});
  EXPECT_NE(text.find("d=\"M90.0 50.0L730.0 410.0\""), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST(CurvePlots, OfOneValueOrNoneAreDrawn) {
  for (const std::vector<PlotCurve>& curves : {std::vector<PlotCurve>{}, {{{1, 5}}}, {{{1, 0}, {2, 0}}}}) {
    const std::string text = drawn(curves);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_NE(text.find("</svg>"), std::string::npos);
  }
}

}  // namespace
}  // namespace delquad
