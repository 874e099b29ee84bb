#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

struct DiagramAxis {
  std::string label;
  bool logarithmic = false;  ///< then values that are not positive are left out
};

/// What one of several things that are compared has.
struct DiagramSeries {
  std::string name;
  std::vector<Vec2> points;
  std::vector<Vec2> marked = {};  ///< of lines and intervals: those of the points that are dots, too
};

enum class DiagramKind {
  kDots,      ///< each point by itself
  kSteps,     ///< the height of a point holds until the next one
  kLines,     ///< each is joined to the next one; all series look alike, and there is no legend
  kIntervals  ///< from the first to the last point of each series, beside its name; a circle at the second
};

/// Several series over common axes, told apart by colour and shape, with a legend, and lines of text below.
/// Points that are not finite are left out.
struct Diagram {
  std::string title;
  DiagramAxis x, y;
  DiagramKind kind = DiagramKind::kDots;
  std::vector<DiagramSeries> series;
  std::vector<std::string> notes = {};
};
/// As SVG.
std::string drawn_diagram(const Diagram& diagram);
/// The same in a file, written whole or not at all.
void draw_diagram(const std::filesystem::path& path, const Diagram& diagram);

}  // namespace delquad
