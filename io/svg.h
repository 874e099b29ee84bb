// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// This header writes SVG drawings. Readers and writers and the report use it.

namespace delquad::svg {

/// Point of the drawing, in hundredths of a pixel, y down.
struct PixelPoint {
  int x, y;
};

/// Data of an SVG path with many shapes, in relative coordinates, which take few bytes.
class Path {
 public:
  void move_to(PixelPoint s);
  void line_to(PixelPoint s);
  void close();
  void segment(PixelPoint a, PixelPoint b) {
    move_to(a);
    line_to(b);
  }
  void polygon(const std::vector<PixelPoint>& corners);
  const std::string& data() const { return data_; }

 private:
  void step(char command, PixelPoint s);
  std::string data_;
  PixelPoint at_{0, 0}, start_{0, 0};
  char last_ = 0;
};

/// Returns #rrggbb for t in [0, 1]: dark violet, green, yellow, perceptually even (viridis).
std::string colour(double t);

/// Returns the color of an irregular vertex or singularity by index: +1 (valence one too small), -1 (one too
/// large), others.
std::string_view mark_colour(int index);

/// Color of lines that join pairs of irregular vertices.
inline constexpr const char* kPairColour = "#e26a00";

/// A dot in the drawing.
struct Mark {
  Vec2 at;
  int index;      ///< see mark_colour
  double radius;  ///< pixels
};

/// A picture of part of the plane: title, drawing to scale, legend at the right.
class Picture {
 public:
  /// Shows the bounding box of the points, at the largest scale that fits the page.
  Picture(const std::vector<Vec3>& points, const std::string& title);

  PixelPoint spot(double x, double y) const;
  PixelPoint spot(Vec2 p) const { return spot(p.x, p.y); }
  PixelPoint spot(const Vec3& p) const { return spot(p.x, p.y); }
  /// Returns the pixels per unit of length.
  double scale() const { return scale_; }

  /// Adds a path. The width is in pixels; "none" draws no fill or no stroke.
  void add(const Path& path, std::string_view fill, std::string_view stroke, double stroke_width);
  void add_marks(const std::vector<Mark>& marks);
  /// Adds marks, and lines that join pairs of them.
  void add_marks(const std::vector<Mark>& marks, const std::vector<std::array<Vec2, 2>>& pairs);

  /// Adds a color bar with labels at positions in [0, 1].
  void add_colour_bar(std::string_view title, const std::vector<std::pair<double, std::string>>& labels);
  /// Adds labels of marks by index below the bar, and of lines between pairs if there are any.
  void add_mark_legend(const std::vector<std::pair<int, std::string>>& labels);

  /// Writes the file completely or not at all. Throws InputError with the path.
  void write(const std::filesystem::path& path) const;

 private:
  double width_, height_;   ///< of the drawing, pixels
  double x0_, y1_, scale_;  ///< the model's left and upper bounds; pixels a unit
  double page_height_;      ///< below the title
  double legend_y_;         ///< first free line of the legend
  bool has_pairs_ = false;
  std::string title_, body_, legend_;
};

}  // namespace delquad::svg
