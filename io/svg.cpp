// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "io/mesh_io.h"
#include "io/xml.h"

namespace delquad::svg {

namespace {

constexpr double kLargestWidth = 1000, kLargestHeight = 800, kLeastHeight = 300;  // of the drawing, pixels
constexpr double kMargin = 20, kTitleHeight = 28, kLegendWidth = 110;
constexpr double kBarWidth = 16, kBarHeight = 180, kLineHeight = 20;

}  // namespace

void Path::step(char command, PixelPoint s) {
  // A command letter holds for what follows it, and a minus sign separates numbers.
  const bool same = command == last_ || (command == 'l' && last_ == 'm');
  const int dx = s.x - at_.x, dy = s.y - at_.y;
  if (!same) data_ += command;
  if (same && dx >= 0) data_ += ' ';
  fmt::format_to(std::back_inserter(data_), "{}{}{}", dx, dy < 0 ? "" : " ", dy);
  last_ = command;
  at_ = s;
}

void Path::move_to(PixelPoint s) {
  last_ = 0;
  step('m', s);
  start_ = s;
}

void Path::line_to(PixelPoint s) { step('l', s); }

void Path::close() {
  data_ += 'z';
  last_ = 0;
  at_ = start_;
}

void Path::polygon(const std::vector<PixelPoint>& corners) {
  move_to(corners[0]);
  for (size_t k = 1; k < corners.size(); ++k) line_to(corners[k]);
  close();
}

std::string colour(double t) {
  static constexpr std::array<std::array<double, 3>, 11> kMap = {{{68, 1, 84},
                                                                  {72, 36, 117},
                                                                  {65, 68, 135},
                                                                  {53, 95, 141},
                                                                  {42, 120, 142},
                                                                  {33, 145, 140},
                                                                  {34, 168, 132},
                                                                  {68, 191, 112},
                                                                  {122, 209, 81},
                                                                  {189, 223, 38},
                                                                  {253, 231, 37}}};
  const double at = std::clamp(t, 0.0, 1.0) * (kMap.size() - 1);
  const size_t k = std::min(static_cast<size_t>(at), kMap.size() - 2);
  const double f = at - static_cast<double>(k);
  std::array<int, 3> rgb{};
  for (int c = 0; c < 3; ++c)
    rgb[c] = static_cast<int>(std::lround((1 - f) * kMap[k][c] + f * kMap[k + 1][c]));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

std::string_view mark_colour(int index) { return index == 1 ? "#1f3fff" : index == -1 ? "#e0102a" : "#000"; }

Picture::Picture(const std::vector<Vec3>& points, const std::string& title) : title_(title) {
  double x1 = points.empty() ? 0 : points[0].x, y0 = points.empty() ? 0 : points[0].y;
  x0_ = x1;
  y1_ = y0;
  for (const Vec3& p : points) {
    x0_ = std::min(x0_, p.x);
    x1 = std::max(x1, p.x);
    y0 = std::min(y0, p.y);
    y1_ = std::max(y1_, p.y);
  }
  const double w = x1 - x0_, h = y1_ - y0;
  scale_ = std::min(kLargestWidth / w, kLargestHeight / h);
  if (!(std::isfinite(scale_) && scale_ > 0)) scale_ = 1;
  width_ = std::min(w * scale_, kLargestWidth);
  height_ = std::min(h * scale_, kLargestHeight);
  page_height_ = std::max(height_, kLeastHeight);
  legend_y_ = 0;
}

PixelPoint Picture::spot(double x, double y) const {
  const auto hundredths = [](double pixels) {
    constexpr double kFarOut = 1e6;
    return static_cast<int>(std::lround(100 * std::clamp(pixels, -kFarOut, kFarOut)));
  };
  return {hundredths((x - x0_) * scale_), hundredths((y1_ - y) * scale_)};
}

void Picture::add(const Path& path, std::string_view fill, std::string_view stroke, double stroke_width) {
  if (path.data().empty()) return;
  fmt::format_to(std::back_inserter(body_),
                 "<path fill=\"{}\" stroke=\"{}\" stroke-width=\"{:.3g}\" d=\"{}\"/>\n", fill, stroke,
                 100 * stroke_width, path.data());
}

void Picture::add_marks(const std::vector<Mark>& marks) {
  std::map<std::pair<int, int>, Path> paths;  // by radius in half pixels and by index
  for (const Mark& mark : marks) {
    const int half_pixels = std::max(1, static_cast<int>(std::lround(2 * mark.radius)));
    const PixelPoint s = spot(mark.at);
    // A stroke of almost no length with round caps is a dot.
    paths[{half_pixels, mark.index}].segment(s, {s.x + 1, s.y});
  }
  constexpr double kHalo = 0.8;  // pixels of white around a dot
  for (const auto& [key, path] : paths) {
    if (key.first > 2) add(path, "none", "#fff", key.first + 2 * kHalo);
    add(path, "none", mark_colour(key.second), key.first);
  }
}

void Picture::add_marks(const std::vector<Mark>& marks, const std::vector<std::array<Vec2, 2>>& pairs) {
  has_pairs_ = !pairs.empty();
  double width = 0;  // the marks' mean radius
  for (const Mark& mark : marks) width += mark.radius / static_cast<double>(marks.size());
  Path path;
  for (const auto& [few, many] : pairs) path.segment(spot(few), spot(many));
  add(path, "none", "#fff", 1.6 * width);
  add(path, "none", kPairColour, 0.8 * width);
  add_marks(marks);
}

void Picture::add_colour_bar(std::string_view title,
                             const std::vector<std::pair<double, std::string>>& labels) {
  auto out = std::back_inserter(legend_);
  fmt::format_to(out,
                 "<text y=\"12\">{}</text>\n<linearGradient id=\"bar\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">",
                 title);
  constexpr int kStops = 10;
  for (int k = 0; k <= kStops; ++k) {
    fmt::format_to(out, "<stop offset=\"{}\" stop-color=\"{}\"/>", double(k) / kStops,
                   colour(double(k) / kStops));
  }
  fmt::format_to(out,
                 "</linearGradient>\n<rect y=\"{0}\" width=\"{1}\" height=\"{2}\" fill=\"url(#bar)\"/>\n",
                 kLineHeight, kBarWidth, kBarHeight);
  for (const auto& [t, label] : labels) {
    const double y = kLineHeight + (1 - t) * kBarHeight;
    fmt::format_to(out, "<path d=\"M{} {:.1f}h4\" stroke=\"#000\"/><text x=\"{}\" y=\"{:.1f}\">{}</text>\n",
                   kBarWidth, y, kBarWidth + 8, y + 4, label);
  }
  legend_y_ = 2 * kLineHeight + kBarHeight;
}

void Picture::add_mark_legend(const std::vector<std::pair<int, std::string>>& labels) {
  for (const auto& [index, label] : labels) {
    fmt::format_to(std::back_inserter(legend_),
                   "<circle cx=\"8\" cy=\"{}\" r=\"4\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                   legend_y_ + 8, mark_colour(index), kBarWidth + 8, legend_y_ + 12, label);
    legend_y_ += kLineHeight;
  }
  if (!has_pairs_) return;
  fmt::format_to(
      std::back_inserter(legend_),
      "<path d=\"M0 {}h16\" stroke=\"{}\" stroke-width=\"2\"/><text x=\"{}\" y=\"{}\">pair</text>\n",
      legend_y_ + 8, kPairColour, kBarWidth + 8, legend_y_ + 12);
  legend_y_ += kLineHeight;
}

void Picture::write(const std::filesystem::path& path) const {
  constexpr double kCharacter = 8.5;  // pixels of the title's font, more or less
  const double title_width = kCharacter * static_cast<double>(title_.size());
  const double page_width =
      std::max(width_ + (legend_.empty() ? 0 : kMargin + kLegendWidth), title_width) + 2 * kMargin;
  const double page_height = page_height_ + kTitleHeight + 2 * kMargin;
  write_file_atomically(path, [&](std::ostream& out) {
    out << fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
        "{0:.0f} {1:.0f}\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        "<g font-family=\"sans-serif\" font-size=\"12\">\n"
        "<text x=\"{2}\" y=\"{3}\" font-size=\"15\">{4}</text>\n",
        page_width, page_height, kMargin, kMargin + 8, xml_escaped(title_));
    out << fmt::format("<g transform=\"translate({:.2f} {:.2f})\">\n{}</g>\n</g>\n", width_ + 2 * kMargin,
                       kMargin + kTitleHeight, legend_);
    out << fmt::format(
        "<g transform=\"translate({:.2f} {:.2f}) scale(.01)\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\">\n",
        kMargin, kMargin + kTitleHeight + (page_height_ - height_) / 2);
    out << body_ << "</g>\n</svg>\n";
  });
}

}  // namespace delquad::svg
