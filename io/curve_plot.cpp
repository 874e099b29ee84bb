#include "io/curve_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ostream>

#include "io/mesh_io.h"
#include "io/xml.h"

namespace delquad {
namespace {

// Of the axes and around them, in pixels.
constexpr double kWidth = 640, kHeight = 360, kLeft = 90, kTop = 50, kRight = 30, kBottom = 60;

struct Range {
  double low = INFINITY, high = -INFINITY;

  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  /// 0 at low, 1 at high.
  double at(double v) const { return (v - low) / (high - low); }
  void widen_if_empty() {
    if (!(low <= high)) low = high = 0;
    const double least = 1e-12 * std::max(1.0, std::abs(low));
    if (high - low < least) {
      low -= 0.5 * std::max(1.0, std::abs(low));
      high += 0.5 * std::max(1.0, std::abs(high));
    }
  }
};

/// A round step (1, 2 or 5 times a power of ten) that cuts the range in at most `most` parts.
double tick_step(const Range& range, int most) {
  const double rough = (range.high - range.low) / most;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

std::vector<double> ticks(const Range& range, int most) {
  const double step = tick_step(range, most);
  std::vector<double> result;
  for (double k = std::ceil(range.low / step); k * step <= range.high; ++k) result.push_back(k * step);
  return result;
}

double pixel_x(const Range& x, double v) { return kLeft + kWidth * x.at(v); }
double pixel_y(const Range& y, double v) { return kTop + kHeight * (1 - y.at(v)); }

std::string axes(const Range& x, const Range& y, const std::string& x_label, const std::string& y_label) {
  std::string out;
  const auto to = std::back_inserter(out);
  for (const double v : ticks(x, 10)) {
    const double at = pixel_x(x, v);
    fmt::format_to(to,
                   "<path d=\"M{0:.1f} {1}v{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
                   "text-anchor=\"middle\">{4:g}</text>\n",
                   at, kTop, kHeight, kTop + kHeight + 18, v);
  }
  for (const double v : ticks(y, 8)) {
    const double at = pixel_y(y, v);
    fmt::format_to(to,
                   "<path d=\"M{0} {1:.1f}h{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
                   "text-anchor=\"end\">{5:.6g}</text>\n",
                   kLeft, at, kWidth, kLeft - 8, at + 4, v);
  }
  fmt::format_to(to, "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#000\"/>\n",
                 kLeft, kTop, kWidth, kHeight);
  fmt::format_to(to, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", kLeft + kWidth / 2,
                 kTop + kHeight + 42, xml_escaped(x_label));
  fmt::format_to(to, "<text transform=\"translate(20 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                 kTop + kHeight / 2, xml_escaped(y_label));
  return out;
}

std::string drawn(const PlotCurve& curve, const Range& x, const Range& y) {
  std::string line, dots;
  for (const PlotPoint& p : curve) {
    const double px = pixel_x(x, p.x), py = pixel_y(y, p.y);
    fmt::format_to(std::back_inserter(line), "{}{:.1f} {:.1f}", line.empty() ? "M" : "L", px, py);
    if (p.marked) fmt::format_to(std::back_inserter(dots), "M{:.1f} {:.1f}h.1", px, py);
  }
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"#2a788e\"/>\n<path d=\"{}\" fill=\"none\" stroke=\"#440154\" "
      "stroke-width=\"4\" stroke-linecap=\"round\"/>\n",
      line, dots);
}

}  // namespace

void draw_curves(const std::filesystem::path& path, const std::vector<PlotCurve>& curves,
                 const std::string& title, const std::string& x_label, const std::string& y_label) {
  std::vector<PlotCurve> finite = curves;
  Range x, y;
  for (PlotCurve& curve : finite) {
    std::erase_if(curve, [](const PlotPoint& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); });
    for (const PlotPoint& p : curve) {
      x.add(p.x);
      y.add(p.y);
    }
  }
  x.widen_if_empty();
  y.widen_if_empty();
  write_file_atomically(path, [&](std::ostream& out) {
    out << fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        "<g font-family=\"sans-serif\" font-size=\"12\">\n"
        "<text x=\"{2}\" y=\"28\" font-size=\"15\">{3}</text>\n",
        kLeft + kWidth + kRight, kTop + kHeight + kBottom, kLeft, xml_escaped(title));
    out << axes(x, y, x_label, y_label);
    for (const PlotCurve& curve : finite)
      if (!curve.empty()) out << drawn(curve, x, y);
    out << "</g>\n</svg>\n";
  });
}

}  // namespace delquad
