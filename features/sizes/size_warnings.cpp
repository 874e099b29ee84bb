// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/sizes/size_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/box_tree.h"
#include "base/predicates.h"
#include "base/segment.h"
#include "base/text.h"
#include "features/sizes/curvature_spots.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// By rounding to a whole and even number of edges, curves get a little fewer than wanted.
constexpr double kRoundedDown = 0.9;
/// Details that would be round only with sizes below this part of the size are too small for a warning.
constexpr double kLeastShown = 0.02;

/// Two digits of a size may be this much more than it.
constexpr double kRoundedUp = 0.95;

/// Curves and faces with few edges to a full turn.
struct CoarseTurns {
  int curves = 0, faces = 0;
  double fewest = kFewPerTurn;
  std::string worst;                                        ///< "curve 5"
  double needed = std::numeric_limits<double>::infinity();  ///< least size that gives enough

  /// `angle`: by which an edge turns; `radius`: of the curvature there; `size`: of the edge.
  void add(int& count, double angle, double radius, double size, const std::string& name) {
    const double per_turn = kTurn / angle;
    if (!(per_turn < kRoundedDown * kFewPerTurn)) return;
    // Tips and slivers: nobody wants these round.
    if (radius * kTurn / kFewPerTurn < kLeastShown * size) return;
    ++count;
    needed = std::min(needed, radius * kTurn / kFewPerTurn);
    if (!(per_turn < fewest)) return;
    fewest = per_turn;
    worst = name;
  }
  std::string text() const {
    std::string what;
    const auto name = [&](int n, const char* one) {
      if (n > 0) what += fmt::format("{}{} {}{}", what.empty() ? "" : " and ", n, one, n == 1 ? "" : "s");
    };
    name(curves, "curve");
    name(faces, "face");
    return fmt::format("{} {} fewer than {:g} edges to a full turn, the fewest {:.2g} ({})", what,
                       curves + faces == 1 ? "gets" : "get", kFewPerTurn, fewest, worst);
  }
  /// `base`: a size without curvature; `asks`: elements per full turn overall, 0: none.
  void warn(double base, double asks, double min, std::vector<Warning>& warnings) const {
    if (curves + faces == 0) return;
    std::string help = asks < kFewPerTurn ? fmt::format("--curvature {:g}", kFewPerTurn) : "";
    if (needed < least_by_curvature(base, min))
      help += fmt::format("{}--size-min {:.2g}", help.empty() ? "" : " with ", kRoundedUp * needed);
    if (!help.empty()) warnings.emplace_back(text() + ": " + help + " would help [coarse-turns]");
  }
};

/// The angle by which a curve turns all in all between its corners, and its length.
std::pair<double, double> turning(const Curve& curve, int edges) {
  constexpr int kLeastSamples = 64;
  std::vector<double> stops = curve.fixed_parameters();
  stops.push_back(1);
  const int n = std::max(kLeastSamples, 4 * edges / static_cast<int>(stops.size()));
  double angle = 0, length = 0, t = 0;
  for (const double stop : stops) {
    std::optional<Vec2> before;
    for (int k = 0; k < n; ++k) {
      const Vec2 d = curve.point(t + (stop - t) * (k + 1) / n) - curve.point(t + (stop - t) * k / n);
      length += norm(d);
      if (before) angle += std::abs(std::atan2(cross(*before, d), dot(*before, d))) * n / (n - 1);
      before = d;
    }
    t = stop;
  }
  return {angle, length};
}

/// The same for a chain of a fine triangulation.
std::pair<double, double> turning(const CurveChain& chain, const Mesh& fine) {
  const std::vector<int>& v = chain.points;
  double angle = 0, length = 0;
  for (std::size_t k = 0; k + 1 < v.size(); ++k) length += norm(fine.points[v[k + 1]] - fine.points[v[k]]);
  for (std::size_t k = 0; k + 2 < v.size(); ++k)
    angle += turn_angle(fine.points[v[k]], fine.points[v[k + 1]], fine.points[v[k + 2]]);
  // The ends turn half as much as what is between, and are not seen.
  if (v.size() > 2) angle *= static_cast<double>(v.size() - 1) / static_cast<double>(v.size() - 2);
  return {angle, length};
}

void add_curves(const SurfaceSetup& surface, CoarseTurns& turns) {
  const SurfaceDomain& domain = surface.domain;
  for (std::size_t c = 0; c < domain.chains.size(); ++c) {
    const int curve = domain.chains[c].curve;
    if (domain.cut_face[curve] >= 0 || domain.nodes.on_curve[c].size() < 2) continue;
    const auto [angle, length] = turning(domain.chains[c], surface.model.fine);
    const double edges = static_cast<double>(domain.nodes.on_curve[c].size() - 1);
    turns.add(turns.curves, angle / edges, length / angle, length / edges,
              fmt::format("curve {}", surface.model.fine.curves[curve].tag));
  }
}

/// The angle between the normals of a face and their mean, at most.
double spread_of_normals(const Mesh& fine, const std::vector<int>& triangles) {
  const auto normal = [&](int t) {
    const auto& [a, b, c] = fine.triangles[t];
    return cross(fine.points[b] - fine.points[a], fine.points[c] - fine.points[a]);
  };
  Vec3 mean;
  for (const int t : triangles) mean = mean + normal(t);
  double most = 0;
  for (const int t : triangles) {
    const Vec3 n = normal(t);
    most = std::max(most, std::atan2(norm(cross(n, mean)), dot(n, mean)));
  }
  return most;
}

void add_faces(const SurfaceSetup& surface, CoarseTurns& turns) {
  constexpr std::size_t kSamples = 16;  // a face: for a line of text
  const Mesh& fine = surface.model.fine;
  std::vector<std::vector<int>> triangles_of(fine.regions.size());
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    triangles_of[fine.triangle_region[t]].push_back(static_cast<int>(t));
  for (std::size_t f = 0; f < triangles_of.size(); ++f) {
    const std::vector<int>& triangles = triangles_of[f];
    // A face that turns by less than an element may is well served by one.
    const double all = triangles.empty() ? 0 : 2 * spread_of_normals(fine, triangles);
    if (all < kTurn / kFewPerTurn) continue;
    double angle = 0, radius = 0, size_there = 0;
    for (std::size_t k = 0; k < triangles.size();
         k += std::max<std::size_t>(1, triangles.size() / kSamples)) {
      const auto& v = fine.triangles[triangles[k]];
      const Vec3 x = (1.0 / 3) * (fine.points[v[0]] + fine.points[v[1]] + fine.points[v[2]]);
      const double curvature = surface.model.projector->face_curvature(static_cast<int>(f), x);
      int hint = -1;
      const double size = surface.size->at(x, hint);
      if (!(curvature * size > angle)) continue;
      angle = curvature * size;
      radius = 1 / curvature;
      size_there = size;
    }
    if (angle > 0)
      turns.add(turns.faces, std::min(angle, all), radius, size_there,
                fmt::format("face {}", fine.regions[f].tag));
  }
}

}  // namespace

void warn_of_ineffective_sizes(const std::vector<NamedSize>& named, const NamedParts& parts,
                               const SizeField& size, std::vector<Warning>& warnings) {
  for (const NamedSize& wanted : named) {
    if (!(wanted.size > 0)) continue;
    double largest = 0;
    int hint = -1;
    for (const LocalSize& spot : parts.spots({wanted}))
      for (const Vec3& x : {spot.a, spot.b, spot.c.value_or(spot.a), 0.5 * (spot.a + spot.b)})
        largest = std::max(largest, size.at(x, hint));
    if (largest > wanted.size || largest == 0) continue;
    warnings.emplace_back(fmt::format(
        "{}: the size {:.4g} of '{}' has no effect: it is {:.4g} there, or less, and the smaller one counts. "
        "Ask for the larger size overall, and for smaller sizes elsewhere by name [idle-size]",
        wanted.where, wanted.size, wanted.name, largest));
  }
}

void warn_of_large_size(const SizeField& size, const Mesh& model, std::vector<Warning>& warnings) {
  const double extent = diagonal(model);
  double least = std::numeric_limits<double>::infinity();
  int hint = -1;
  for (const Vec3& x : model.points) {
    least = std::min(least, size.at(x, hint));
    if (!(least > extent)) return;
  }
  warnings.emplace_back(fmt::format(
      "the size, {:.4g}, is larger than the model, whose diagonal is {:.4g} [large-size]", least, extent));
}

void warn_of_coarse_turns(const PlanarModel& model, const PlanarDomain& domain, const SizeSpec& spec,
                          const SizeField& asked, std::vector<Warning>& warnings) {
  CoarseTurns turns;
  std::vector<int> edges(model.curves.size(), 0);
  for (const int curve : domain.boundary.line_curve)
    for (const int c : domain.model_curves[curve]) ++edges[c];
  const std::vector<double> per_turn = requested_turns(model, domain, spec);
  double needed = turns.needed, least_asked = kFewPerTurn, base = 0;
  for (std::size_t c = 0; c < edges.size(); ++c) {
    if (edges[c] == 0) continue;
    const auto [angle, length] = turning(*model.curves[c].shape, edges[c]);
    const std::string& name = model.curves[c].name;
    const int before = turns.curves;
    turns.add(turns.curves, angle / edges[c], length / angle, length / edges[c],
              name.empty() ? fmt::format("curve {}", c + 1) : "'" + name + "'");
    if (turns.curves > before) least_asked = std::min(least_asked, per_turn[c]);
    if (std::exchange(needed, turns.needed) == turns.needed) continue;
    const Vec2 there = model.curves[c].shape->point(0.5);
    int hint = -1;
    base = asked.at({there.x, there.y, 0}, hint);
  }
  turns.warn(base, least_asked, spec.min, warnings);
}

void warn_of_coarse_turns(const WantedSize& wanted, const SurfaceSetup& surface,
                          std::vector<Warning>& warnings) {
  if (!surface.model.projector) return;  // turns of triangles may be noise
  CoarseTurns turns;
  add_curves(surface, turns);
  add_faces(surface, turns);
  int hint = -1;
  turns.warn(wanted.base->at(surface.model.fine.points[0], hint), wanted.curvature ? wanted.per_turn : 0,
             wanted.min, warnings);
}

namespace {

/// Gaps are told of below this part of an edge.
constexpr double kNarrow = 0.01;

/// An edge with a patch on its left only.
struct OuterEdge {
  Vec2 a, b;
  std::array<int, 2> nodes;
  int curve;
};

std::vector<OuterEdge> outer_edges(const PlanarDomain& domain) {
  std::map<std::pair<int, int>, int> sides;
  const auto key = [](const PatchBoundary& patch, const std::array<int, 2>& edge) {
    return std::minmax(patch.point_node[edge[0]], patch.point_node[edge[1]]);
  };
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& edge : patch.edges) ++sides[key(patch, edge)];
  std::vector<OuterEdge> edges;
  for (const PatchBoundary& patch : domain.patches)
    for (std::size_t e = 0; e < patch.edges.size(); ++e) {
      const auto [i, j] = patch.edges[e];
      if (patch.edge_curve[e] < 0 || sides[key(patch, {i, j})] != 1) continue;
      edges.push_back({patch.points[i],
                       patch.points[j],
                       {patch.point_node[i], patch.point_node[j]},
                       patch.edge_curve[e]});
    }
  return edges;
}

}  // namespace

void warn_of_gaps(const PlanarDomain& domain, std::vector<Warning>& warnings) {
  const std::vector<OuterEdge> edges = outer_edges(domain);
  std::vector<Box<Vec2>> boxes;
  for (const OuterEdge& edge : edges) boxes.push_back({lower(edge.a, edge.b), upper(edge.a, edge.b)});
  const BoxTree<Vec2> tree(boxes);
  std::set<int> on_crack(domain.on_crack.begin(), domain.on_crack.end());
  std::set<int> near;  // nodes at gaps
  double least = 0, shown = 0;
  std::pair<int, int> curves;
  Vec2 place;
  for (const OuterEdge& from : edges) {
    const int node = from.nodes[0];
    if (on_crack.contains(node)) continue;
    const double reach = kNarrow * norm(from.b - from.a);
    tree.search(
        reach * reach, [&](const auto& branch) { return branch.box.distance2(from.a); },
        [&](int i) {
          const OuterEdge& edge = edges[i];
          if (edge.nodes[0] == node || edge.nodes[1] == node || edge.nodes[0] == from.nodes[1] ||
              orient2d(edge.a, edge.b, from.a) >= 0)
            return;
          const double gap = norm(nearest_on_segment(from.a, edge.a, edge.b) - from.a);
          if (!(gap > 0) || gap > std::min(reach, kNarrow * norm(edge.b - edge.a))) return;
          near.insert(node);
          // If gaps are equal, the gap between curves side by side says most.
          const double aside = std::abs(cross(from.b - from.a, edge.b - edge.a));
          const double blame = gap * (1 + aside / (norm(from.b - from.a) * norm(edge.b - edge.a)));
          if (least > 0 && blame >= least) return;
          least = blame;
          shown = gap;
          curves = {from.curve, edge.curve};
          place = from.a;
        });
  }
  if (near.empty()) return;
  const auto title = [&](int c) { return curve_title(domain.boundary.curves[c]); };
  warnings.emplace_back(
      fmt::format("{} and {} leave a gap of {:.2g} between them at {}, far narrower than the edges there{}. "
                  "If the regions should join, let their curves lie on each other [gap-between-regions]",
                  title(curves.first), title(curves.second), shown, show_point(place),
                  near.size() > 1 ? fmt::format(", and so at {} nodes", near.size()) : ""));
}

}  // namespace delquad
