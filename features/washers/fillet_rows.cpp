// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "features/washers/surface_washers.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/chart.h"

namespace delquad {
namespace {

/// Parts of a fillet's curvature: how much less it may be somewhere, and how much a neighbor may have along
/// its sides.
constexpr double kVaries = 0.05, kMostBeside = 0.5;
/// Places at which a face is looked at.
constexpr std::size_t kPlaces = 16;
/// Cosine of the angle between triangles on a smooth side, 30 degrees: the first chord of a fillet turns by
/// less.
constexpr double kSmooth = 0.866;

class FilletFinder {
 public:
  explicit FilletFinder(const SurfaceModel& model)
      : model_(model), mesh_(model.fine), sides_(sorted_half_edges(mesh_)) {}

  /// 1 / radius of the face of a chart; 0: it differs from place to place, or is not known.
  double curvature(const Chart& chart) const {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t i = 0; i < chart.fine_triangle.size(); i += 1 + chart.fine_triangle.size() / kPlaces) {
      const double k = curvature_at(chart.fine_triangle[i]);
      if (!std::isfinite(k)) continue;
      least = std::min(least, k), most = std::max(most, k);
    }
    return least >= (1 - kVaries) * most ? most : 0;
  }

  /// The curves across a fillet of that curvature; of a ring none. Nothing where the chart is no fillet.
  std::optional<std::set<int>> across(const OutlinedChart& chart, double curvature) const {
    std::set<int> curves;
    int n_changes = 0, n_across = 0;
    for (std::size_t l = 0; l < chart.loops.size(); ++l) {
      int before = side_of(chart, l, chart.loops[l].size() - 1, curvature);
      for (std::size_t i = 0; i < chart.loops[l].size(); ++i) {
        const int curve = side_of(chart, l, i, curvature);
        n_changes += curve != before;
        n_across += curve != before && curve >= 0;
        if (curve >= 0) curves.insert(curve);
        before = curve;
      }
    }
    const bool is_strip = chart.loops.size() == 1 && n_changes == 4 && n_across == 2;
    const bool is_ring = chart.loops.size() == 2 && curves.empty();
    return is_strip || is_ring ? std::optional(curves) : std::nullopt;
  }

 private:
  double curvature_at(int triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Vec3 middle = (1.0 / 3) * (mesh_.points[a] + mesh_.points[b] + mesh_.points[c]);
    const int face = mesh_.triangle_region[triangle];
    return model_.projector->face_curvature(face, model_.projector->to_face(face, middle));
  }
  /// -1 where a flatter face goes on smoothly beside that side of a loop; else the curve.
  int side_of(const OutlinedChart& chart, std::size_t l, std::size_t i, double curvature) const {
    const std::vector<int>& loop = chart.loops[l];
    const int a = chart.fine_node[loop[i]], b = chart.fine_node[loop[(i + 1) % loop.size()]];
    const int curve = chart.curve_of[l][i];
    const auto edge = sides_of_edge(std::span(sides_), a, b);
    if (edge.size() != 2) return curve;
    const Vec3 m = area_vector(mesh_, edge[0].element), n = area_vector(mesh_, edge[1].element);
    if ((edge[0].forward == edge[1].forward ? -1 : 1) * dot(m, n) < kSmooth * norm(m) * norm(n)) return curve;
    const int other = edge[mesh_.triangle_region[edge[0].element] == chart.face ? 1 : 0].element;
    return curvature_at(other) <= kMostBeside * curvature ? -1 : curve;
  }

  const SurfaceModel& model_;
  const Mesh& mesh_;
  std::vector<HalfEdge> sides_;
};

}  // namespace

void SurfaceWashers::divide_fillets() {
  const std::vector<FilletRows>& fillets = problem_.fillet_rows;
  if (fillets.empty() || !model_.projector) return;
  find_divided();
  const FilletFinder finder(model_);
  for (const OutlinedChart& chart : outlined_charts(model_.fine)) {
    const double curvature = finder.curvature(chart);
    const auto spec = std::ranges::find_if(fillets, [&](const FilletRows& f) {
      return curvature * f.most >= 1 - kVaries / 2 && curvature * f.least <= 1 + kVaries / 2;
    });
    if (!(curvature > 0) || spec == fillets.end()) continue;
    const auto curves = finder.across(chart, curvature);
    if (!curves) continue;
    if (curves->empty())
      mapped_.rings.emplace_back(fmt::format("region_{}", model_.fine.regions[chart.face].tag), spec->rows);
    for (const int c : *curves) divide(c, spec->rows, spec->where);
  }
}

}  // namespace delquad
