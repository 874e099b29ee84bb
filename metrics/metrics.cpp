// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <new>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "base/added_parts.h"
#include "base/parallel.h"
#include "delquad/error.h"
#include "metrics/regularity.h"
#include "metrics/shape.h"
#include "metrics/size_efficiency.h"

namespace delquad {
namespace {

using Values = std::map<std::string, double>;

void add_to(Histogram& histogram, double value) {
  const double bins = static_cast<double>(histogram.counts.size());
  const double bin = std::floor((value - histogram.low) / (histogram.high - histogram.low) * bins);
  // The last bin is closed; NaN counts in the first.
  ++histogram.counts[bin > 0 ? static_cast<size_t>(std::min(bin, bins - 1)) : 0];
}

/// Returns the least value that at least `percent` of the values do not exceed. Reorders the values.
double nearest_rank(std::vector<double>& values, double percent) {
  const double rank = std::ceil(percent / 100 * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <size_t N>
void add_angles(const ElementShape<N>& shape, Histogram& angles, double& low, double& high) {
  for (const double radians : shape.angle) {
    const double angle = radians * 180 / std::numbers::pi;
    add_to(angles, angle);
    if (!(angle >= low)) low = angle;
    if (!(angle <= high)) high = angle;
  }
}

void measure_shapes(const Mesh& mesh, MeshMetrics& metrics) {
  const ElementSides sides(mesh);
  std::vector<ElementShape<4>> shapes(mesh.quads.size());
  parallel_ranges(shapes.size(), [&](size_t begin, size_t end) {
    for (size_t q = begin; q < end; ++q) shapes[q] = quad_shape(mesh, static_cast<int>(q), sides);
  });
  double &low = metrics.values["angle_min"], &high = metrics.values["angle_max"];
  std::vector<double> etas;
  etas.reserve(shapes.size());
  double inverted = 0, worst_jacobian = 1, jacobian_sum = 0, eta_sum = 0;
  for (const ElementShape<4>& shape : shapes) {
    add_angles(shape, metrics.angle, low, high);
    etas.push_back(eta_of(shape.angle));
    add_to(metrics.eta, etas.back());
    eta_sum += etas.back();
    inverted += etas.back() > 0 ? 0 : 1;
    worst_jacobian = std::min(worst_jacobian, shape.scaled_jacobian);
    jacobian_sum += shape.scaled_jacobian;
  }
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const ElementShape<3> shape = triangle_shape(mesh, static_cast<int>(t), sides);
    add_angles(shape, metrics.angle, low, high);
    inverted += shape.scaled_jacobian > 0 ? 0 : 1;
  }
  metrics.values["n_inverted"] = inverted;
  if (etas.empty()) return;

  const double n = static_cast<double>(etas.size());
  metrics.values["eta_mean"] = eta_sum / n;
  metrics.values["eta_worst"] = *std::ranges::min_element(etas);
  metrics.values["eta_p1"] = nearest_rank(etas, 1);
  metrics.values["eta_p5"] = nearest_rank(etas, 5);
  metrics.values["eta_p50"] = nearest_rank(etas, 50);
  metrics.values["scaled_jacobian_min"] = worst_jacobian;
  metrics.values["scaled_jacobian_mean"] = jacobian_sum / n;
}

/// Measures proportions, which eta does not see, since it depends only on angles.
void measure_proportions(const Mesh& mesh, const std::vector<char>& in_layers, Values& values) {
  if (mesh.quads.empty()) return;
  std::vector<double> warps(mesh.quads.size()), aspects(mesh.quads.size());
  parallel_ranges(warps.size(), [&](size_t begin, size_t end) {
    for (size_t q = begin; q < end; ++q) {
      const auto corners = corners_of(mesh, mesh.quads[q]);
      warps[q] = quad_warp(corners);
      aspects[q] = quad_aspect(corners);
    }
  });
  const double n = static_cast<double>(warps.size()), degrees = 180 / std::numbers::pi;
  values["n_folded"] = static_cast<double>(std::ranges::count_if(warps, [](double w) { return w > kFold; }));
  values["warp_max"] = *std::ranges::max_element(warps) * degrees;
  values["warp_mean"] = std::accumulate(warps.begin(), warps.end(), 0.0) / n * degrees;
  values["aspect_max"] = *std::ranges::max_element(aspects);
  double n_thin = 0;
  for (size_t q = 0; q < aspects.size(); ++q)
    if (aspects[q] > kThin && (in_layers.empty() || !in_layers[q])) ++n_thin;
  values["n_thin"] = n_thin;
  values["aspect_mean"] = std::accumulate(aspects.begin(), aspects.end(), 0.0) / n;
}

void measure_lengths(const Mesh& mesh, std::span<const HalfEdge> sides, const SizeField& size,
                     const SizeField* given, Values& values) {
  const SizeFit fit = fit_to_size(mesh, sides, size);
  values["tau"] = fit.tau;
  values["edge_min"] = fit.shortest;
  values["edge_max"] = fit.longest;
  values["n_short"] = fit.n_short;
  values["tau_given"] = given == nullptr ? fit.tau : fit_to_size(mesh, sides, *given).tau;
}

/// Returns the sides of elements outside layers.
std::vector<HalfEdge> sides_outside(const Mesh& mesh, std::span<const HalfEdge> sides,
                                    const std::vector<char>& in_layers) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  std::vector<HalfEdge> outside;
  std::ranges::copy_if(sides, std::back_inserter(outside), [&](const HalfEdge& side) {
    return side.element < n_triangles || !in_layers[static_cast<size_t>(side.element - n_triangles)];
  });
  return outside;
}

void measure_topology(const Mesh& mesh, std::span<const HalfEdge> sides, MeshMetrics& metrics) {
  std::vector<int> quads_at(mesh.points.size(), 0), triangles_at(mesh.points.size(), 0);
  for (const auto& v : mesh.quads) {
    for (const int i : v) ++quads_at[i];
  }
  for (const auto& v : mesh.triangles) {
    for (const int i : v) ++triangles_at[i];
  }
  std::vector<char> on_boundary(mesh.points.size(), 0);
  double n_edges = 0;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    ++n_edges;
    if (edge.size() != 2) on_boundary[edge[0].lo] = on_boundary[edge[0].hi] = 1;
  });
  // Files without lines still have regions.
  std::vector<char> on_curve(mesh.points.size(), 0);
  for (const auto& line : mesh.lines) on_curve[line[0]] = on_curve[line[1]] = 1;
  std::vector<int> region(mesh.points.size(), -1);
  for (size_t q = 0; q < mesh.quad_region.size(); ++q)
    for (const int i : mesh.quads[q]) {
      if (region[i] < 0) region[i] = mesh.quad_region[q];
      if (region[i] != mesh.quad_region[q]) on_curve[i] = 1;
    }
  double n_vertices = 0, n_interior = 0, n_irregular_on_curves = 0;
  // Among quads only quads count; a mesh of triangles has its own degrees.
  const std::vector<int>& degrees = mesh.quads.empty() ? triangles_at : quads_at;
  int least = std::numeric_limits<int>::max(), most = 0;
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const int valence = quads_at[i] + triangles_at[i];
    if (valence == 0) continue;
    ++n_vertices;
    if (on_boundary[i]) continue;
    ++n_interior;
    ++metrics.valences[valence];
    least = std::min(least, degrees[i]);
    most = std::max(most, degrees[i]);
    if (triangles_at[i] == 0) ++metrics.quad_valences[valence];
    n_irregular_on_curves += on_curve[i] && (valence != 4 || triangles_at[i] > 0) ? 1 : 0;
  }
  Values& values = metrics.values;
  values["n_vertices"] = n_vertices;
  values["n_edges"] = n_edges;
  if (metrics.valences.empty()) return;
  values["d_min"] = least;
  values["d_max"] = most;
  if (mesh.quads.empty()) return;
  const auto regular = metrics.quad_valences.find(4);
  const double n_regular = regular == metrics.quad_valences.end() ? 0 : static_cast<double>(regular->second);
  values["d4"] = 100 * n_regular / n_interior;
  values["n_irregular"] = n_interior - n_regular;
  values["n_irregular_on_curves"] = n_irregular_on_curves;
}

void measure_regularity(const Mesh& mesh, std::span<const HalfEdge> sides, MeshMetrics& metrics) {
  if (mesh.quads.empty() || !mesh.triangles.empty()) return;
  const PairedVertices paired = pair_irregular(mesh, sides);
  metrics.values["n_necessary"] = paired.necessary;
  metrics.values["n_beyond"] = paired.beyond;
  metrics.pairs = {static_cast<long long>(paired.pairs.size()), paired.unpaired, {}, {}};
  for (const IrregularPair& pair : paired.pairs) {
    ++metrics.pairs->burgers[pair.burgers];
    ++metrics.pairs->edges[pair.edges];
  }
}

std::deque<Metric>& metrics() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  using enum Better;
  static std::deque<Metric> registry = {
      {"n_elements", "N", "", kNeither, kNone, "triangles and quads"},
      {"eta_mean", "eta mean", "", kHigher, 0, "paper 6.1, equation (4), mean over quads"},
      {"eta_worst", "eta worst", "", kHigher, 0, "paper 6.1, equation (4), least over quads"},
      {"tau", "tau", "%", kHigher, 0, "paper 6.2, equations (5) and (6), each edge once"},
      {"d4", "d4", "%", kHigher, 0, "paper 6.3, interior vertices with four quads and no triangle"},
      {"d_min", "dmin", "", kHigher, 0,
       "paper 6.3, least number of quads at an interior vertex; of triangles in a mesh of triangles"},
      {"d_max", "dmax", "", kLower, kInfinite,
       "paper 6.3, greatest number of quads at an interior vertex; of triangles in a mesh of triangles"},
      {"percent_quads", "% quads", "%", kHigher, 0, "paper, table I, share of the elements"},
      {"n_vertices", "vertices", "", kNeither, kNone, "vertices of elements"},
      {"n_edges", "edges", "", kNeither, kNone, "edges of elements, each once"},
      {"n_quads", "quads", "", kNeither, kNone, "number of quads"},
      {"n_triangles", "triangles", "", kNeither, kNone, "number of triangles"},
      {"n_irregular", "irregular", "", kLower, kInfinite, "interior vertices that d4 does not count", 0},
      {"n_irregular_on_curves", "on curves", "", kLower, kInfinite,
       "irregular vertices on lines or between regions", 0},
      {"n_necessary", "necessary", "", kNeither, kNone,
       "irregular vertices, also on the boundary, that corners, holes and handles force", 0},
      {"n_beyond", "beyond", "", kLower, kInfinite,
       "irregular vertices beyond the necessary ones, also on the boundary; two for each pair", 0},
      {"n_inverted", "inverted", "", kLower, kInfinite, "quads with eta 0, triangles without positive area"},
      {"scaled_jacobian_min", "SJ min", "", kHigher, -1,
       "least sine of a quad's angles (signed), least over quads"},
      {"scaled_jacobian_mean", "SJ mean", "", kHigher, -1,
       "least sine of a quad's angles (signed), mean over quads"},
      {"angle_min", "angle min", "deg", kHigher, 0, "least inner angle of all elements"},
      {"angle_max", "angle max", "deg", kLower, 360, "largest inner angle of all elements"},
      {"eta_p1", "eta 1 %", "", kHigher, 0, "eta that 1 % of the quads do not exceed (nearest rank)"},
      {"eta_p5", "eta 5 %", "", kHigher, 0, "eta that 5 % of the quads do not exceed (nearest rank)"},
      {"eta_p50", "eta 50 %", "", kHigher, 0, "eta that half the quads do not exceed (nearest rank)"},
      {"n_folded", "folded", "", kLower, kInfinite,
       "quads whose halves turn by over 90 degrees along a diagonal"},
      {"warp_max", "warp max", "deg", kLower, 180,
       "larger angle between the normals of a quad's halves, along either diagonal [stimpson2007], greatest"},
      {"warp_mean", "warp mean", "deg", kLower, 180,
       "larger angle between the normals of a quad's halves, mean over quads"},
      {"aspect_max", "aspect max", "", kLower, kInfinite,
       "longest over shortest side of a quad [stimpson2007, edge ratio], greatest"},
      {"aspect_mean", "aspect", "", kLower, kInfinite,
       "longest over shortest side of a quad, mean over quads"},
      {"n_thin", "thin", "", kLower, kInfinite, "quads outside of layers with an aspect above 10", 0},
      {"edge_min", "edge min", "delta", kHigher, 0, "shortest edge over the size, by equation (5)"},
      {"edge_max", "edge max", "delta", kLower, kInfinite, "longest edge over the size, by equation (5)"},
      {"n_short", "short", "", kLower, kInfinite,
       "interior edges on no line that are shorter than a tenth of the size, by equation (5)", 0},
      {"tau_given", "tau given", "%", kHigher, 0,
       "tau with the size as given, before curvature and short curves reduced it"},
      {"misalignment", "off cross", "deg", kLower, 45,
       "mean angle between edges of two quads and the nearest direction of the cross field at their middles",
       1},
  };
  return registry;
}

std::deque<AddedMetric>& measures() {
  static std::deque<AddedMetric> all;
  return all;
}

}  // namespace

MeshMetrics evaluate_metrics(const Mesh& mesh, const SizeField* size, const SizeField* given,
                             const Options& options) {
  MeshMetrics metrics = measure_builtin(mesh, size, given, sorted_half_edges(mesh));
  measure_added_metrics({mesh, size, given, options}, metrics);
  return metrics;
}

void measure_added_metrics(const MetricInput& input, MeshMetrics& metrics) {
  for (const AddedMetric& metric : added_metrics()) {
    const auto fail = [&](const std::string& why) { metrics.failures[metric.key] = why; };
    try {
      const double value = metric.measure(input);
      if (std::isinf(value))
        fail("it is infinite");
      else
        metrics.values[metric.key] = value;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      fail(*error.what() == 0 ? "it threw an exception without a message" : error.what());
    } catch (...) {
      fail("it threw something that is no std::exception");
    }
  }
}

MeshMetrics evaluate_shapes(const Mesh& mesh, std::span<const HalfEdge> sides) {
  MeshMetrics metrics;
  for (const Metric& m : metric_registry()) metrics.values[m.key] = std::numeric_limits<double>::quiet_NaN();
  metrics.eta = {0, 1, std::vector<long long>(20, 0)};
  metrics.angle = {0, 360, std::vector<long long>(36, 0)};
  measure_shapes(mesh, metrics);
  measure_topology(mesh, sides, metrics);
  return metrics;
}

MeshMetrics measure_builtin(const Mesh& mesh, const SizeField* size, const SizeField* given,
                            std::span<const HalfEdge> sides, const std::vector<char>& in_layers) {
  MeshMetrics metrics = evaluate_shapes(mesh, sides);
  const double n_quads = static_cast<double>(mesh.quads.size());
  const double n_elements = n_quads + static_cast<double>(mesh.triangles.size());
  metrics.values["n_quads"] = n_quads;
  metrics.values["n_triangles"] = n_elements - n_quads;
  metrics.values["n_elements"] = n_elements;
  if (n_elements > 0) metrics.values["percent_quads"] = 100 * n_quads / n_elements;

  measure_proportions(mesh, in_layers, metrics.values);
  measure_regularity(mesh, sides, metrics);
  if (size != nullptr) {
    const bool has_layers = std::ranges::find(in_layers, 1) != in_layers.end();
    const auto outside = has_layers ? sides_outside(mesh, sides, in_layers) : std::vector<HalfEdge>();
    measure_lengths(mesh, has_layers ? outside : sides, *size, given, metrics.values);
  }
  return metrics;
}

double quad_eta(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& normal) {
  return eta_of(element_shape(std::array{a, b, c, d}, normal).angle);
}

double quad_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const auto lift = [](Vec2 p) { return Vec3{p.x, p.y, 0}; };
  return quad_eta(lift(a), lift(b), lift(c), lift(d), {0, 0, 1});
}

std::vector<double> quad_etas(const Mesh& mesh) {
  const ElementSides sides(mesh);
  std::vector<double> etas(mesh.quads.size());
  parallel_ranges(etas.size(), [&](size_t begin, size_t end) {
    for (size_t q = begin; q < end; ++q) etas[q] = eta_of(quad_shape(mesh, static_cast<int>(q), sides).angle);
  });
  return etas;
}

const std::deque<Metric>& metric_registry() { return metrics(); }

const Metric* find_metric(const std::string& key) {
  const auto at = std::ranges::find(metrics(), key, &Metric::key);
  return at == metrics().end() ? nullptr : &*at;
}

const std::deque<AddedMetric>& added_metrics() { return measures(); }

void add_metric(Metric metric, std::function<double(const MetricInput&)> measure) {
  check_part_name("metric", metric.key);
  if (!measure) throw std::invalid_argument("metric '" + metric.key + "': there is nothing to call");
  if (find_metric(metric.key) != nullptr)
    throw std::invalid_argument("there is a metric '" + metric.key + "' already");
  measures().push_back({metric.key, std::move(measure)});
  metrics().push_back(std::move(metric));
}

}  // namespace delquad
