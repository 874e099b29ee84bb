#include "geometry/surface/report_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

namespace {

std::string list_curves(const Mesh& mesh, const std::vector<char>& listed) {
  constexpr int kMostNamed = 10;
  std::string text;
  int n = 0;
  for (std::size_t c = 0; c < listed.size(); ++c) {
    if (!listed[c]) continue;
    if (++n <= kMostNamed) text += fmt::format("{}{}", n > 1 ? ", " : "", mesh.curves[c].tag);
  }
  if (n > kMostNamed) text += ", ...";
  const auto first = std::ranges::find(listed, 1) - listed.begin();
  const auto line = std::ranges::find(mesh.line_curve, static_cast<int>(first)) - mesh.line_curve.begin();
  return fmt::format("{} ({}), the first through {}", n, text, show_point(mesh.points[mesh.lines[line][0]]));
}

}  // namespace

void report_edges(SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  std::vector<std::pair<std::array<int, 2>, int>> curve_of;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto& [a, b] = mesh.lines[l];
    curve_of.push_back({{std::min(a, b), std::max(a, b)}, mesh.line_curve[l]});
  }
  std::ranges::sort(curve_of);
  std::vector<char> free(mesh.curves.size(), 0), crowded(mesh.curves.size(), 0);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2) return;
    const std::array<int, 2> ends{edge[0].lo, edge[0].hi};
    const auto at = std::ranges::lower_bound(curve_of, std::pair(ends, 0));
    if (at == curve_of.end() || at->first != ends) return;
    (edge.size() == 1 ? free : crowded)[at->second] = 1;
  });
  if (std::ranges::count(free, 1) > 0)
    model.warnings.push_back("the surface is open: free curves: " + list_curves(mesh, free));
  if (std::ranges::count(crowded, 1) > 0)
    model.warnings.push_back("more than two faces meet on curves: " + list_curves(mesh, crowded));
}

}  // namespace delquad
