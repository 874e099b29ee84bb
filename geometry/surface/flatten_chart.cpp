// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/flatten_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/segment.h"
#include "geometry/surface/element_cuts.h"

namespace delquad {

namespace {

/// Distortion of a map that is taken at once.
constexpr double kGoodSigma = 1.05, kGoodAreaRatio = 4;
/// Distortion above which an annulus, or a chart with more holes, is cut by a seam.
constexpr double kMaxUncutAnnulus = 2, kMaxUncutHoles = 4;
/// Length of a division over the length of a cut below which a chart is divided.
constexpr double kShortDivision = 0.5;
/// Least area ratio for a cut to a tip.
constexpr double kMinTipRatio = 2;
/// Numbers of cuts through charts with a map after which angles, and then areas, of a one-to-one map no
/// longer count. Cuts seldom improve angles. Areas still count up to kMostAreas, beyond which vertices of the
/// mesh would miss parts of the face.
constexpr int kAnyAngles = 2, kAnyAreas = 12;
constexpr double kMostAreas = 300;
/// Loops above which charts are divided before any map, since one seam for each would take too long.
constexpr std::size_t kManyLoops = 8;

/// Returns the least distance of the vertices of a loop from another loop.
double distance_between(const Chart& chart, const std::vector<int>& from, const std::vector<int>& to) {
  double least = std::numeric_limits<double>::infinity();
  for (const int v : from)
    for (std::size_t k = 0; k < to.size(); ++k)
      least = std::min(least, distance_to_segment(chart.points[v], chart.points[to[k]],
                                                  chart.points[to[(k + 1) % to.size()]]));
  return least;
}

/// Returns a lower bound of the ratio of area scales in all conformal maps of a chart with two loops. Each
/// loop turns by 2 pi in the plane, so the logarithm of the scale has a flux from loop to loop. Curvature
/// inside may take some of it. The logarithm varies by at least the flux times gap^2 / area, since these are
/// below the extremal distance of the loops.
double least_area_ratio(const Chart& chart) {
  const std::vector<double> defects = angle_defects(chart);
  double flux = std::numeric_limits<double>::infinity();
  for (const auto& loop : chart.loops) {
    double turn = 0;
    for (const int v : loop) turn += defects[v];
    flux = std::min(flux, std::abs(2 * std::numbers::pi - turn));
  }
  for (std::size_t v = static_cast<std::size_t>(chart.n_boundary); v < defects.size(); ++v)
    flux -= std::abs(defects[v]);
  const std::vector<double> areas = triangle_areas(chart);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  const double gap = std::min(distance_between(chart, chart.loops[0], chart.loops[1]),
                              distance_between(chart, chart.loops[1], chart.loops[0]));
  return std::exp(2 * std::max(0.0, flux) * gap * gap / area);
}

ChartElements elements_of(const Chart& chart, const FlattenOptions& options) {
  ChartElements elements;
  for (const int t : chart.fine_triangle) elements.element.push_back(options.element[t]);
  for (const int v : chart.fine_node)
    elements.avoided.push_back(options.avoided.empty() ? 0 : options.avoided[v]);
  return elements;
}

class ChartWork {
 public:
  ChartWork(const Chart& chart, const std::vector<CutEnd>& ends, const std::vector<char>& on_cut,
            const FlattenOptions& options, double tolerance, int tries, bool stuck)
      : chart_(chart),
        ends_(ends),
        on_cut_(on_cut),
        options_(options),
        tolerance_(tolerance),
        tries_(tries),
        stuck_(stuck) {
    if (!options.element.empty()) elements_ = elements_of(chart, options);
  }

  ChartOutcome run() const {
    ChartOutcome outcome = plan();
    const bool wanted =
        outcome.cut.has_value() || !outcome.map || outcome.map->quality.extreme_ratio > kMostAreas;
    if (wanted && outcome.parts.empty() && (!outcome.cut || stuck_))
      return {std::move(outcome.map), std::nullopt, true, split_chart(chart_, options_)};
    return outcome;
  }

 private:
  ChartOutcome plan() const {
    if (chart_.loops.empty() || genus(chart_) > 0) return divide(std::nullopt);
    // A plane is a map for another isotropic metric, too.
    if (auto flat = planar_map(chart_, tolerance_))
      if (auto map = checked_map(chart_, std::move(*flat), "plane");
          map && (chart_.sides.empty() || map->quality.sigma_95 <= kGoodSigma))
        return {std::move(map), {}, false};
    return chart_.loops.size() > 1 ? flatten_with_holes() : flatten_disk();
  }

  bool acceptable(const FlatQuality& q, double max_area_ratio) const {
    return q.extreme_ratio <= kMostAreas && (q.area_ratio <= max_area_ratio || tries_ >= kAnyAreas) &&
           (q.sigma_95 <= options_.max_sigma || tries_ >= kAnyAngles);
  }

  ChartOutcome flatten_with_holes() const {
    if (chart_.loops.size() > kManyLoops)
      if (ChartOutcome division = divide(std::nullopt); division.cut || !division.parts.empty())
        return division;
    const double limit = elements_                  ? options_.max_area_ratio
                         : chart_.loops.size() == 2 ? kMaxUncutAnnulus
                                                    : kMaxUncutHoles;
    // A cylinder's wall is cut open without a map. Quantiles of scales may be nearer than the bound says.
    if (chart_.loops.size() == 2 && !elements_ && chart_.sides.empty() && !stuck_ && tries_ < kAnyAreas &&
        least_area_ratio(chart_) > limit * limit)
      if (auto seam = plan_seam(chart_, ends_)) return {std::nullopt, std::move(seam), false};
    std::optional<ConformalMap> map = checked_map(chart_, spectral_map(chart_), "spectral");
    if (map && acceptable(map->quality, std::min(limit, options_.max_area_ratio)))
      return {std::move(map), {}, false};
    auto seam = elements_ ? path_from(chart_.loops[1], chart_.loops[0]) : plan_seam(chart_, ends_);
    if (chart_.loops.size() == 2 && seam) return {std::move(map), std::move(seam), false};
    ChartOutcome division = divide(std::move(map));
    if (seam && !(division.cut && division.cut->length < kShortDivision * seam->length))
      return {std::move(division.map), std::move(seam), false};
    return division;
  }

  ChartOutcome flatten_disk() const {
    std::optional<ConformalMap> map = checked_map(chart_, boundary_first_map(chart_), "boundary-first");
    const bool good = map && map->quality.sigma_95 <= kGoodSigma && map->quality.area_ratio <= kGoodAreaRatio;
    if (!good) {
      std::optional<ConformalMap> other = checked_map(chart_, spectral_map(chart_), "spectral");
      if (other && (!map || better(other->quality, map->quality))) map = std::move(other);
    }
    if (!map || map->quality.area_ratio > kMinTipRatio) {
      for (int tip : sharp_tips(chart_))
        if (auto cut = elements_ ? path_to_boundary(tip) : plan_tip_cut(chart_, tip, ends_))
          return {std::move(map), std::move(cut), false};
    }
    if (!elements_ && !stuck_)
      if (auto through = plan_cut_through_tip(chart_, ends_, on_cut_))
        return {std::move(map), std::move(through), true};
    if (map && acceptable(map->quality, options_.max_area_ratio)) return {std::move(map), {}, false};
    return divide(std::move(map));
  }

  bool better(const FlatQuality& a, const FlatQuality& b) const {
    const bool fits_a = a.area_ratio <= options_.max_area_ratio,
               fits_b = b.area_ratio <= options_.max_area_ratio;
    // Angles count most: a size field can follow the scale.
    auto cost = [](const FlatQuality& q) { return std::log(q.sigma_mean) + 0.02 * std::log(q.area_ratio); };
    return fits_a != fits_b ? fits_a : cost(a) < cost(b);
  }

  ChartOutcome divide(std::optional<ConformalMap> map) const {
    if (elements_) return {std::move(map), std::nullopt, true, split_chart(chart_, options_)};
    return {std::move(map), plan_division(chart_), true};
  }
  std::optional<CutPath> path_from(const std::vector<int>& from, const std::vector<int>& to) const {
    std::vector<char> begins(chart_.points.size(), 0), ends(chart_.points.size(), 0);
    for (const int v : from) begins[v] = 1;
    for (const int v : to) ends[v] = 1;
    return path_beside_elements(chart_, *elements_, begins, ends);
  }
  std::optional<CutPath> path_to_boundary(int tip) const {
    std::vector<int> boundary(static_cast<std::size_t>(chart_.n_boundary));
    std::iota(boundary.begin(), boundary.end(), 0);
    return path_from({tip}, boundary);
  }

  const Chart& chart_;
  const std::vector<CutEnd>& ends_;
  const std::vector<char>& on_cut_;  ///< whether fine nodes are on cuts
  const FlattenOptions& options_;
  double tolerance_;
  int tries_;                              ///< earlier cuts because of distortion
  bool stuck_;                             ///< whether its last cut failed
  std::optional<ChartElements> elements_;  ///< none: cuts run anywhere
};

}  // namespace

std::optional<ConformalMap> checked_map(const Chart& chart, std::vector<Vec2> flat, const char* method) {
  double flat_area = 0;
  for (const auto& [a, b, c] : chart.triangles) flat_area += cross(flat[b] - flat[a], flat[c] - flat[a]) / 2;
  const std::vector<double> areas = triangle_areas(chart);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  if (!(flat_area > 0) || !(area > 0)) return std::nullopt;
  const double scale = std::sqrt(area / flat_area);
  if (!std::isfinite(scale)) return std::nullopt;
  for (Vec2& p : flat) p = scale * p;
  if (!is_one_to_one(chart, flat)) return std::nullopt;
  const FlatQuality quality = measure_flat(chart, flat);
  return ConformalMap{std::move(flat), quality, method};
}

std::vector<char> split_chart(const Chart& chart, const FlattenOptions& options) {
  return options.element.empty() ? plan_split(chart) : plan_division(chart, elements_of(chart, options));
}

ChartOutcome flatten_chart(const Chart& chart, const std::vector<CutEnd>& ends,
                           const std::vector<char>& on_cut, const FlattenOptions& options, double tolerance,
                           int tries, bool stuck) {
  return ChartWork(chart, ends, on_cut, options, tolerance, tries, stuck).run();
}

}  // namespace delquad
