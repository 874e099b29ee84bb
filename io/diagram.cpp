#include "io/diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "io/mesh_io.h"
#include "io/xml.h"

namespace delquad {
namespace {

// Of the axes and around them, in pixels.
constexpr double kPlotWidth = 560, kPlotHeight = 360, kPlotLeft = 80, kPlotTop = 50, kLegend = 260,
                 kBelow = 60, kLegendLine = 18;
/// Colours that people with any colour vision tell apart (Okabe and Ito), without the yellow.
constexpr std::array<const char*, 7> kLineColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                     "#56b4e9", "#e69f00", "#000000"};
/// Shapes of dots, 8 pixels wide, from their middle; and dashes of lines. Seven colours times four.
constexpr std::array<const char*, 4> kShapes = {"m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", "m-3.5 -3.5h7v7h-7z",
                                                "m0 -4.5l4.5 8h-9z", "m0 -5l5 5l-5 5l-5 -5z"};
constexpr std::array<const char*, 4> kDashes = {"", "6 3", "2 3", "8 3 2 3"};

/// An axis of the drawing: from values to 0 at its low end and 1 at its high end.
class AxisScale {
 public:
  AxisScale(const DiagramAxis& axis, std::vector<double> values) : logarithmic_(axis.logarithmic) {
    std::erase_if(values, [&](double v) { return !shows(v); });
    if (values.empty()) values = {1};
    const auto [low, high] = std::ranges::minmax(values);
    low_ = inner(low);
    high_ = inner(high);
    const double margin = high_ > low_ ? 0.03 * (high_ - low_) : std::max(0.1, 0.1 * std::abs(low_));
    low_ -= margin;
    high_ += margin;
  }
  bool shows(double v) const { return std::isfinite(v) && (!logarithmic_ || v > 0); }
  double at(double v) const { return (inner(v) - low_) / (high_ - low_); }
  /// Round values along it.
  std::vector<double> ticks() const {
    constexpr int kMost = 8;
    std::vector<double> result;
    if (logarithmic_ && high_ - low_ > 1) {
      const std::vector<double> leads =
          high_ - low_ > 3 ? std::vector<double>{1} : std::vector<double>{1, 2, 5};
      for (int power = static_cast<int>(std::floor(low_)); power <= high_; ++power)
        for (const double lead : leads) add(lead * std::pow(10, power), result);
      return result;
    }
    const double low = outer(low_), high = outer(high_), rough = (high - low) / kMost;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double lead : {5.0, 2.0, 1.0})
      if (lead * power >= rough) step = lead * power;
    for (double k = std::ceil(low / step); k * step <= high; ++k) add(k * step, result);
    return result;
  }

 private:
  double inner(double v) const { return logarithmic_ ? std::log10(v) : v; }
  double outer(double v) const { return logarithmic_ ? std::pow(10, v) : v; }
  void add(double v, std::vector<double>& ticks) const {
    if (shows(v) && at(v) >= 0 && at(v) <= 1) ticks.push_back(v + 0.0);  // no -0
  }

  bool logarithmic_;
  double low_ = 0, high_ = 1;
};

double x_pixel(const AxisScale& x, double v) { return kPlotLeft + kPlotWidth * x.at(v); }
double y_pixel(const AxisScale& y, double v) { return kPlotTop + kPlotHeight * (1 - y.at(v)); }

std::string axes(const Diagram& diagram, const AxisScale& x, const AxisScale& y) {
  std::string out;
  const auto to = std::back_inserter(out);
  const int digits = diagram.kind == DiagramKind::kLines ? 6 : 4;
  for (const double v : x.ticks())
    fmt::format_to(to,
                   "<path d=\"M{0:.1f} {1}v{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
                   "text-anchor=\"middle\">{4:.{5}g}</text>\n",
                   x_pixel(x, v), kPlotTop, kPlotHeight, kPlotTop + kPlotHeight + kLegendLine, v, digits);
  for (const double v : diagram.kind == DiagramKind::kIntervals ? std::vector<double>() : y.ticks())
    fmt::format_to(to,
                   "<path d=\"M{0} {1:.1f}h{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
                   "text-anchor=\"end\">{5:.{6}g}</text>\n",
                   kPlotLeft, y_pixel(y, v), kPlotWidth, kPlotLeft - 8, y_pixel(y, v) + 4, v, digits);
  fmt::format_to(to, "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#000\"/>\n",
                 kPlotLeft, kPlotTop, kPlotWidth, kPlotHeight);
  fmt::format_to(to, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", kPlotLeft + kPlotWidth / 2,
                 kPlotTop + kPlotHeight + 42, xml_escaped(diagram.x.label));
  fmt::format_to(to, "<text transform=\"translate(20 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                 kPlotTop + kPlotHeight / 2, xml_escaped(diagram.y.label));
  return out;
}

/// The series `k`: its points, or a line at `kLegend` beside its name where `in_legend`.
std::string paint(std::size_t k, DiagramKind kind, const std::string& path) {
  const char* colour = kLineColours[k % kLineColours.size()];
  const std::size_t style = k / kLineColours.size() % kDashes.size();
  if (kind == DiagramKind::kDots)
    return fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\".75\"/>\n", path, colour);
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>\n", path,
      colour, kDashes[style]);
}

/// Dots take turns at shapes, too, so that they are told apart without colour.
std::string dot(std::size_t k, double x, double y) {
  return fmt::format("M{:.1f} {:.1f}{}", x, y, kShapes[k % kShapes.size()]);
}

std::string joined(const DiagramSeries& series, const AxisScale& x, const AxisScale& y) {
  std::string line, dots;
  for (const Vec2& p : series.points)
    if (x.shows(p.x) && y.shows(p.y))
      line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x_pixel(x, p.x), y_pixel(y, p.y));
  for (const Vec2& p : series.marked)
    if (x.shows(p.x) && y.shows(p.y))
      dots += fmt::format("M{:.1f} {:.1f}h.1", x_pixel(x, p.x), y_pixel(y, p.y));
  if (line.empty()) return "";
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"#2a788e\"/>\n<path d=\"{}\" fill=\"none\" stroke=\"#440154\" "
      "stroke-width=\"4\" stroke-linecap=\"round\"/>\n",
      line, dots);
}

/// The height of the series' name, and of its interval.
double line_of_legend(const Diagram& diagram, std::size_t k) {
  const auto line = static_cast<double>(k), lines = static_cast<double>(diagram.series.size());
  return diagram.kind == DiagramKind::kIntervals ? kPlotTop + kPlotHeight * (line + 0.5) / lines
                                                 : kPlotTop + 8 + kLegendLine * line;
}

std::string interval(const Diagram& diagram, std::size_t k, const AxisScale& x) {
  const auto& [name, points, marked] = diagram.series[k];
  const double y = line_of_legend(diagram, k);
  return fmt::format(
      "<path d=\"M{0:.1f} {1}v{2}\" stroke=\"#000\"/>\n<path d=\"M{3:.1f} {4:.1f}H{5:.1f}\" "
      "stroke=\"#0072b2\" "
      "stroke-width=\"2\"/>\n<path d=\"M{6:.1f} {4:.1f}{7}\" fill=\"{8}\" stroke=\"#0072b2\"/>\n",
      x_pixel(x, 0), kPlotTop, kPlotHeight, x_pixel(x, points[0].x), y, x_pixel(x, points[2].x),
      x_pixel(x, points[1].x), kShapes[0], marked.empty() ? "#fff" : "#0072b2");
}

std::string drawn(const Diagram& diagram, std::size_t k, const AxisScale& x, const AxisScale& y) {
  if (diagram.kind == DiagramKind::kIntervals) return interval(diagram, k, x);
  if (diagram.kind == DiagramKind::kLines) return joined(diagram.series[k], x, y);
  std::string path;
  for (const Vec2& p : diagram.series[k].points) {
    if (!x.shows(p.x) || !y.shows(p.y)) continue;
    const double px = x_pixel(x, p.x), py = y_pixel(y, p.y);
    if (diagram.kind == DiagramKind::kDots)
      path += dot(k, px, py);
    else
      path += path.empty() ? fmt::format("M{:.1f} {:.1f}", px, py) : fmt::format("H{:.1f}V{:.1f}", px, py);
  }
  if (diagram.kind == DiagramKind::kSteps && !path.empty())
    path += fmt::format("H{}", kPlotLeft + kPlotWidth);
  return path.empty() ? "" : paint(k, diagram.kind, path);
}

std::string legend(const Diagram& diagram) {
  std::string out;
  for (std::size_t k = 0; k < diagram.series.size(); ++k) {
    const double x = kPlotLeft + kPlotWidth + 20, y = line_of_legend(diagram, k);
    if (diagram.kind != DiagramKind::kIntervals)
      out += paint(k, diagram.kind,
                   diagram.kind == DiagramKind::kDots ? dot(k, x + 10, y) : fmt::format("M{} {}h20", x, y));
    out += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x + 28, y + 4,
                       xml_escaped(diagram.series[k].name));
  }
  return out;
}

}  // namespace

std::string drawn_diagram(const Diagram& diagram) {
  std::vector<double> all_x, all_y;
  if (diagram.kind == DiagramKind::kIntervals) all_x = {0};
  for (const DiagramSeries& series : diagram.series)
    for (const Vec2& p : series.points) {
      all_x.push_back(p.x);
      all_y.push_back(p.y);
    }
  const AxisScale x(diagram.x, std::move(all_x)), y(diagram.y, std::move(all_y));
  const std::size_t in_legend = diagram.kind == DiagramKind::kLines ? 0 : diagram.series.size();
  const double below = std::max(kPlotTop + kPlotHeight + kBelow,
                                kPlotTop + kLegendLine * (1 + static_cast<double>(in_legend)));
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<g font-family=\"sans-serif\" font-size=\"12\">\n"
      "<text x=\"{2}\" y=\"28\" font-size=\"15\">{3}</text>\n",
      kPlotLeft + kPlotWidth + kLegend, below + kLegendLine * static_cast<double>(diagram.notes.size()),
      kPlotLeft, xml_escaped(diagram.title));
  out += axes(diagram, x, y);
  for (std::size_t k = 0; k < diagram.series.size(); ++k) out += drawn(diagram, k, x, y);
  if (diagram.kind != DiagramKind::kLines) out += legend(diagram);
  for (std::size_t k = 0; k < diagram.notes.size(); ++k)
    out += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", kPlotLeft,
                       below + kLegendLine * static_cast<double>(k), xml_escaped(diagram.notes[k]));
  return out + "</g>\n</svg>\n";
}

void draw_diagram(const std::filesystem::path& path, const Diagram& diagram) {
  write_text_file(path, drawn_diagram(diagram));
}

}  // namespace delquad
