#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace delquad {

/// A value at one step of an iteration.
struct PlotPoint {
  double x, y;
  bool marked = false;  ///< drawn as a dot, too
};
/// Points joined in their order.
using PlotCurve = std::vector<PlotPoint>;

/// Curves over common axes, from the least to the largest value of both, with labels. SVG, written whole or
/// not at all. Points that are not finite are left out.
void draw_curves(const std::filesystem::path& path, const std::vector<PlotCurve>& curves,
                 const std::string& title, const std::string& x_label, const std::string& y_label);

}  // namespace delquad
