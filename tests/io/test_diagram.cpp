#include "io/diagram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/svg_to_pdf.h"
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

TEST(DiagramIntervals, EndAtTheirPointsBesideTheirNames) {
  const std::string text =
      drawn_diagram({"t",
                     {"difference"},
                     {},
                     DiagramKind::kIntervals,
                     {{"a - b", {{-1, 0}, {1, 0}, {3, 0}}, {{1, 0}}}, {"a - c", {{0, 0}, {1, 0}, {2, 0}}}}});
  // From -1 to 3 with margins of 3 %: 0 is at a quarter.
  EXPECT_NE(text.find("M227.9 50v360\" stroke=\"#000\""), std::string::npos) << text;
  EXPECT_NE(text.find("M95.8 140.0H624.2\""), std::string::npos) << text;
  EXPECT_NE(text.find("M360.0 320.0m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z\" fill=\"#fff\""), std::string::npos)
      << text;
  EXPECT_NE(text.find("y=\"324\">a - c<"), std::string::npos) << text;
}

/// The objects stand where the file says, and streams are as long: readers need not mend anything.
TEST(DiagramAsPdf, IsWhole) {
  const std::string svg =
      drawn_diagram({"t (\u00e9)", {"x"}, {"1 - \u03b7"}, DiagramKind::kDots, {{"DB", {{1, 2}, {2, 3}}}}});
  const std::string pdf = svg_to_pdf(svg);
  EXPECT_EQ(pdf, svg_to_pdf(svg));
  const auto number_at = [&](std::size_t at) { return std::stoul(pdf.substr(at)); };
  const std::size_t table = number_at(pdf.rfind("startxref\n") + 10);
  ASSERT_EQ(pdf.substr(table, 5), "xref\n");
  for (std::size_t k = 1; k < number_at(table + 7); ++k)
    EXPECT_TRUE(pdf.substr(number_at(table + 9 + 20 * k)).starts_with(std::to_string(k) + " 0 obj")) << k;
  std::size_t streams = 0;
  for (std::size_t at = 0; (at = pdf.find("/Length ", at)) != pdf.npos; ++at, ++streams)
    EXPECT_EQ(pdf.substr(pdf.find("stream\n", at) + 7 + number_at(at + 8), 10), "\nendstream");
  EXPECT_EQ(streams, 2u);
  EXPECT_NE(pdf.find("(t \\(\xE9\\)) Tj"), std::string::npos);
  EXPECT_NE(pdf.find("0 -1 -1 0 20.00 242.98 Tm (1 - ?) Tj"), std::string::npos) << "upwards, in the middle";
  EXPECT_NE(pdf.find("/A.75 gs 95.80 399.80 m"), std::string::npos);
  EXPECT_NE(pdf.find(" c h f Q"), std::string::npos) << "dots are full circles";
}

}  // namespace
}  // namespace delquad
