#include "metrics/metrics.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace delquad {

namespace {

std::deque<Metric>& metrics() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  using enum Better;
  static std::deque<Metric> registry = {
      {"n_elements", "N", "", kNeither, kNone, "triangles and quads"},
      {"eta_mean", "eta mean", "", kHigher, 0, "paper 6.1, equation (4), mean over quads"},
      {"eta_worst", "eta worst", "", kHigher, 0, "paper 6.1, equation (4), least over quads"},
      {"tau", "tau", "%", kHigher, 0, "paper 6.2, equations (5) and (6), each edge once"},
      {"d4", "d4", "%", kHigher, 0, "paper 6.3, interior vertices with four quads and nothing else"},
      {"d_min", "dmin", "", kHigher, 0,
       "paper 6.3, least number of quads at an interior vertex (of a mesh of triangles: of these)"},
      {"d_max", "dmax", "", kLower, kInfinite,
       "paper 6.3, greatest number of quads at an interior vertex (of a mesh of triangles: of these)"},
      {"percent_quads", "% quads", "%", kHigher, 0, "paper, table I, share of the elements"},
      {"n_vertices", "vertices", "", kNeither, kNone, "vertices of elements"},
      {"n_edges", "edges", "", kNeither, kNone, "edges of elements, each once"},
      {"n_quads", "quads", "", kNeither, kNone, "count"},
      {"n_triangles", "triangles", "", kNeither, kNone, "count"},
      {"n_irregular", "irregular", "", kLower, kInfinite, "interior vertices that d4 leaves out", 0},
      {"n_necessary", "necessary", "", kNeither, kNone,
       "irregular vertices, those on the boundary with them, that corners, holes and handles force", 0},
      {"n_beyond", "beyond", "", kLower, kInfinite,
       "irregular vertices beyond these, those on the boundary with them; two for each pair", 0},
      {"n_inverted", "inverted", "", kLower, kInfinite, "quads with eta 0, triangles without positive area"},
      {"scaled_jacobian_min", "SJ min", "", kHigher, -1,
       "least sine of a quad's angles (signed), least over quads"},
      {"scaled_jacobian_mean", "SJ mean", "", kHigher, -1,
       "least sine of a quad's angles (signed), mean over quads"},
      {"angle_min", "angle min", "deg", kHigher, 0, "inner angles of all elements"},
      {"angle_max", "angle max", "deg", kLower, 360, "inner angles of all elements"},
      {"eta_p1", "eta 1 %", "", kHigher, 0, "eta that 1 % of the quads do not exceed (nearest rank)"},
      {"eta_p5", "eta 5 %", "", kHigher, 0, "eta that 5 % of the quads do not exceed (nearest rank)"},
      {"eta_p50", "eta 50 %", "", kHigher, 0, "eta that half the quads do not exceed (nearest rank)"},
      {"n_folded", "folded", "", kLower, kInfinite,
       "quads whose halves turn by over 90 degrees along a diagonal"},
      {"warp_max", "warp max", "deg", kLower, 180,
       "larger angle between the normals of a quad's halves, along either diagonal [stimpson2007], greatest"},
      {"warp_mean", "warp mean", "deg", kLower, 180, "the same, mean over quads"},
      {"aspect_max", "aspect max", "", kLower, kInfinite,
       "longest over shortest side of a quad [stimpson2007, edge ratio], greatest"},
      {"aspect_mean", "aspect", "", kLower, kInfinite, "the same, mean over quads"},
      {"n_thin", "thin", "", kLower, kInfinite, "quads of an aspect above 10, layers left out", 0},
      {"edge_min", "edge min", "delta", kHigher, 0, "shortest edge over the size, by equation (5)"},
      {"edge_max", "edge max", "delta", kLower, kInfinite, "longest edge over the size, by equation (5)"},
      {"n_short", "short", "", kLower, kInfinite,
       "edges inside, on no line, below a tenth of the size, by equation (5)", 0},
      {"tau_given", "tau given", "%", kHigher, 0,
       "tau against the size as given, before curvature and short curves made it smaller"},
  };
  return registry;
}

std::deque<OwnMetric>& measures() {
  static std::deque<OwnMetric> all;
  return all;
}

}  // namespace

const std::deque<Metric>& metric_registry() { return metrics(); }

const Metric* find_metric(const std::string& key) {
  const auto at = std::ranges::find(metrics(), key, &Metric::key);
  return at == metrics().end() ? nullptr : &*at;
}

const std::deque<OwnMetric>& own_metrics() { return measures(); }

void add_metric(Metric metric, std::function<double(const MetricInput&)> measure) {
  if (metric.key.empty()) throw std::invalid_argument("a metric needs a key");
  if (!measure) throw std::invalid_argument("metric '" + metric.key + "': there is nothing to call");
  if (find_metric(metric.key) != nullptr)
    throw std::invalid_argument("there is a metric '" + metric.key + "' already");
  measures().push_back({metric.key, std::move(measure)});
  metrics().push_back(std::move(metric));
}

}  // namespace delquad
