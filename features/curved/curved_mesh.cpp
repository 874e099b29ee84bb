// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/curved_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <span>

#include "base/parallel_each.h"
#include "base/text.h"
#include "delquad/mesh.h"
#include "features/curved/curved_geometry.h"
#include "features/curved/jacobian_bounds.h"
#include "features/curved/raise_order.h"
#include "features/curved/untangle_curved.h"
#include "features/layers/add_layers.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {
namespace {

/// Corners of the model of less (radians) are cusps: nodes of polynomials do not follow curves so well.
inline constexpr double kCuspAngle = 0.01;

/// How far nodes in the middle of a line slide, in its lengths, from what is tried first.
constexpr std::array kShifts{0.025, 0.05, 0.1, 0.15};

class CuspOpener {
 public:
  CuspOpener(Mesh& mesh, const ModelGeometry& geometry, std::vector<JacobianBounds>& bounds)
      : mesh_(mesh), geometry_(geometry), bounds_(bounds), periodic_(mesh.points.size(), 0) {
    for (const PeriodicNodes& pair : mesh.periodic)
      for (const auto& both : pair.nodes)
        for (const int v : both) periodic_[v] = 1;
  }

  /// `quads`: that have nodes of the lines of the corner.
  void open(const CurveCorner& corner, const std::set<int>& quads) {
    const State before = state_of(quads);
    State best = before;
    for (const double shift : kShifts) {
      for (const double sign : {1.0, -1.0}) {
        restore(before);
        slide(corner.out, mesh_.quads[corner.quad][corner.corner], sign * shift);
        slide(corner.in, mesh_.quads[corner.quad][corner.corner], -sign * shift);
        for (const int q : quads) {
          place_inside(mesh_, static_cast<std::size_t>(q), geometry_);
          std::vector<Vec3> places;
          for (const int v : nodes_of_quad(mesh_, static_cast<std::size_t>(q)))
            places.push_back(mesh_.points[v]);
          bounds_[q] = element_bounds(places, mesh_.order);
        }
        State now = state_of(quads);
        if (is_better(corner.quad, now, best, before)) best = std::move(now);
      }
      if (best.bounds.at(corner.quad).positive()) break;
    }
    restore(best);
  }

 private:
  struct State {
    std::map<int, Vec3> points;
    std::map<int, JacobianBounds> bounds;
  };
  State state_of(const std::set<int>& quads) const {
    State state;
    for (const int q : quads) {
      state.bounds[q] = bounds_[q];
      for (const int v : nodes_of_quad(mesh_, static_cast<std::size_t>(q))) state.points[v] = mesh_.points[v];
    }
    return state;
  }
  void restore(const State& state) {
    for (const auto& [v, x] : state.points) mesh_.points[v] = x;
    for (const auto& [q, b] : state.bounds) bounds_[q] = b;
  }

  static bool is_better(int quad, const State& now, const State& best, const State& before) {
    for (const auto& [q, b] : now.bounds)
      if (q != quad && b.proven < std::min(before.bounds.at(q).proven, kPoorJacobian)) return false;
    return now.bounds.at(quad).proven > best.bounds.at(quad).proven;
  }

  void slide(int line, int from, double shift) {
    const std::vector<int> nodes = nodes_of_line(mesh_, static_cast<std::size_t>(line));
    const int p = mesh_.order;
    const double away = nodes.front() == from ? shift : -shift;
    std::vector<double> parts;
    for (int k = 1; k < p; ++k) {
      const double t = static_cast<double>(k) / p;
      parts.push_back(t + 4 * away * t * (1 - t));
    }
    const std::vector<Vec3> places = geometry_.on_line(line, parts);
    for (int k = 1; k < p; ++k)
      if (!periodic_[nodes[k]]) mesh_.points[nodes[k]] = places[k - 1];
  }

  Mesh& mesh_;
  const ModelGeometry& geometry_;
  std::vector<JacobianBounds>& bounds_;
  std::vector<char> periodic_;
};

/// Where two curves leave a point in the same direction, quads between them have no angle there. No quad that
/// follows the curves is proven to be positive. So nodes of both lines slide along their curves, one away
/// from the corner and the other towards it. They go by the least way that lets the polynomials leave it at
/// an angle. `corners`: of the straight mesh, of which `mesh` is the curved form; `bounds`: of all quads,
/// kept up to date. No other quad falls below kPoorJacobian by that, or becomes worse where it was.
void open_cusps(Mesh& mesh, const ModelGeometry& geometry, std::span<const CurveCorner> corners,
                std::vector<JacobianBounds>& bounds) {
  std::vector<CurveCorner> cusps;
  std::map<int, std::set<int>> quads_at;  // the first node between the ends of their lines
  const auto node_of = [&](int line) { return nodes_of_line(mesh, static_cast<std::size_t>(line))[1]; };
  for (const CurveCorner& corner : corners) {
    if (corner.angle >= kCuspAngle || bounds[corner.quad].positive()) continue;
    cusps.push_back(corner);
    for (const int line : {corner.out, corner.in}) quads_at[node_of(line)];
  }
  if (cusps.empty()) return;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : nodes_of_quad(mesh, q))
      if (const auto found = quads_at.find(v); found != quads_at.end())
        found->second.insert(static_cast<int>(q));
  CuspOpener opener(mesh, geometry, bounds);
  for (const CurveCorner& cusp : cusps) {
    std::set<int> quads = quads_at.at(node_of(cusp.out));
    quads.merge(std::set<int>(quads_at.at(node_of(cusp.in))));
    opener.open(cusp, quads);
  }
}

/// The inner quad begins so far inside, as a part of the way between opposite sides.
constexpr double kRingWidth = 0.3;

void put_ring_in(Mesh& mesh, std::size_t quad, const ModelGeometry& geometry) {
  const std::array<int, 4> outer = mesh.quads[quad];
  const int region = mesh.quad_region[quad];
  const int first = static_cast<int>(mesh.points.size());
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](int i) { return mesh.points[outer[(k + i) % 4]]; };
    constexpr double t = kRingWidth;
    mesh.points.push_back(
        geometry.on_face(region, (1 - t) * (1 - t) * at(0) + t * (1 - t) * (at(1) + at(3)) + t * t * at(2)));
  }
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    mesh.quads.push_back({outer[k], outer[next], first + next, first + k});
    mesh.quad_region.push_back(region);
    mesh.quads[quad][k] = first + k;
  }
}

/// Puts a ring of quads into each quad that has a corner on a smooth curve, or a corner that is hardly less
/// than flat. A curved quad would have no area there. Every corner then has two quads. Returns how many got
/// one. The elements must have order 1.
int split_flat_corners(Mesh& straight, const ModelGeometry& geometry) {
  std::set<int> flat;
  for (const CurveCorner& corner : curve_corners(straight, geometry))
    if (corner.angle > std::numbers::pi / 2 && std::sin(corner.angle) < kPoorJacobian)
      flat.insert(corner.quad);
  for (const int quad : flat) put_ring_in(straight, static_cast<std::size_t>(quad), geometry);
  return static_cast<int>(flat.size());
}

/// Nodes of periodic lines are images, too.
void pair_curved_lines(Mesh& mesh) {
  for (PeriodicNodes& pair : mesh.periodic) {
    std::map<int, int> master_of;
    for (const auto& [image, master] : pair.nodes) master_of.emplace(image, master);
    std::map<std::array<int, 2>, std::size_t> masters;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      if (mesh.line_curve[l] == pair.master) masters.emplace(mesh.lines[l], l);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      const auto a = master_of.find(mesh.lines[l][0]), b = master_of.find(mesh.lines[l][1]);
      if (mesh.line_curve[l] != pair.curve || a == master_of.end() || b == master_of.end()) continue;
      auto found = masters.find({a->second, b->second});
      const bool forward = found != masters.end();
      if (!forward) found = masters.find({b->second, a->second});
      if (found == masters.end()) continue;
      const std::vector<int> own = nodes_of_line(mesh, l), of = nodes_of_line(mesh, found->second);
      for (std::size_t k = 1; k + 1 < own.size(); ++k) {
        const int master = of[forward ? k : own.size() - 1 - k];
        mesh.points[own[k]] = pair.motion(mesh.points[master]);
        pair.nodes.push_back({own[k], master});
      }
    }
  }
}

/// From places halfway between nodes, where elements are furthest off.
double distance_to_model(const Mesh& mesh, const ModelGeometry& geometry) {
  std::vector<double> of_quads(mesh.quads.size(), 0);
  parallel_each(of_quads.size(), [&](std::size_t q) {
    std::vector<Vec3> places;
    for (const int v : nodes_of_quad(mesh, q)) places.push_back(mesh.points[v]);
    const Bernstein<Vec3> map = bernstein_of(places, mesh.order);
    for (int j = 0; j < mesh.order; ++j)
      for (int i = 0; i < mesh.order; ++i) {
        const Vec3 x = value_at(map, (i + 0.5) / mesh.order, (j + 0.5) / mesh.order);
        of_quads[q] = std::max(of_quads[q], norm(x - geometry.on_face(mesh.quad_region[q], x)));
      }
  });
  std::vector<double> of_lines(mesh.lines.size(), 0);
  parallel_each(of_lines.size(), [&](std::size_t l) {
    std::vector<Vec3> places;
    for (const int v : nodes_of_line(mesh, l)) places.push_back(mesh.points[v]);
    for (int i = 0; i < mesh.order; ++i) {
      const Vec3 x = value_on_line(places, (i + 0.5) / mesh.order);
      if (const auto on_curve = geometry.on_curve(mesh.line_curve[l], x))
        of_lines[l] = std::max(of_lines[l], norm(x - *on_curve));
    }
  });
  double most = 0;
  for (const auto* distances : {&of_quads, &of_lines})
    for (const double d : *distances) most = std::max(most, d);
  return most / diagonal(mesh);
}

/// Returns the scaled Jacobian that corners of the model allow for each quad.
std::vector<double> allowed_by(const std::vector<CurveCorner>& corners, std::size_t n_quads) {
  std::vector<double> allowed(n_quads, 1);
  for (const CurveCorner& corner : corners)
    if (corner.angle < kCuspAngle)
      allowed[corner.quad] = 0;
    else if (corner.angle < std::numbers::pi / 2)
      allowed[corner.quad] = std::min(allowed[corner.quad], std::sin(corner.angle));
  return allowed;
}

bool has_metric(const MeshingSetup& p) { return p.metric_plane || (p.surface && p.surface->metric); }

/// A metric wants sharp corners: no more than the straight quads have.
void allow_as_straight(const Mesh& straight, std::vector<double>& allowed) {
  const std::vector<JacobianBounds> bounds = jacobian_bounds(straight);
  for (std::size_t q = 0; q < allowed.size(); ++q)
    allowed[q] = std::min(allowed[q], std::max(0.0, bounds[q].proven));
}

/// Vertices that no untangling moves: of layers, and of grids that were asked for.
std::vector<int> held_vertices(const MeshingSetup& prepared, const Mesh& mesh) {
  std::vector<char> is_grid(prepared.boundary.regions.size(), 0);
  for (const PatchSetup& patch : prepared.patches)
    if (patch.grid && patch.grid_stays) is_grid[patch.region] = 1;
  const std::vector<char> in_layers = quads_in_layers(prepared, mesh);
  std::set<int> held;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    if (in_layers[q] || is_grid[mesh.quad_region[q]]) held.insert(mesh.quads[q].begin(), mesh.quads[q].end());
  return {held.begin(), held.end()};
}

/// Whether a narrow corner of the model explains that an element has no more than `proven`.
bool is_in_corner(double proven, double allowed) {
  const double explained = kPartOfAllowed * allowed;
  return explained < kLowJacobian && (allowed == 0 || proven >= explained);
}

std::string show_element(const Mesh& mesh, std::size_t q) {
  Vec3 centre;
  for (const int v : mesh.quads[q]) centre = centre + 0.25 * mesh.points[v];
  return fmt::format("{} in region {}", show_point(centre), mesh.regions[mesh.quad_region[q]].tag);
}

/// Counts elements with little, and tells of those that are positive.
void count_low(const std::vector<JacobianBounds>& bounds, const std::vector<double>& allowed,
               const Mesh& mesh, const MeshingSetup& prepared, CurvingSummary& summary,
               std::vector<Warning>& warnings) {
  std::vector<std::pair<double, std::size_t>> low[2];  // elsewhere, in corners
  for (std::size_t q = 0; q < bounds.size(); ++q) {
    const double proven = bounds[q].proven;
    const bool in_corner = is_in_corner(proven, allowed[q]);
    if (!in_corner) summary.least_elsewhere = std::min(summary.least_elsewhere, proven);
    if (proven >= kLowJacobian) continue;
    ++summary.below;
    summary.in_corners += in_corner;
    summary.unproven_elsewhere += !in_corner && proven <= 0;
    if (proven > 0) low[in_corner].emplace_back(proven, q);
  }
  for (const bool in_corner : {false, true}) {
    auto& these = low[in_corner];
    if (these.empty() || (in_corner && has_metric(prepared))) continue;
    std::ranges::sort(these);
    constexpr std::size_t kShown = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(kShown, these.size()); ++i)
      text += fmt::format("{}{:.2g} at {}", i > 0 ? ", " : "", these[i].first,
                          show_element(mesh, these[i].second));
    warnings.push_back(fmt::format(
        "{}: {} curved element(s) with a scaled Jacobian below {} {}: {}{}", prepared.settings.name,
        these.size(), kLowJacobian,
        in_corner ? "lie in corners of the model that allow no more" : "that no corner of the model explains",
        text, these.size() > kShown ? ", ..." : ""));
  }
}

void report_unproven(const Mesh& mesh, const std::vector<JacobianBounds>& bounds, Soundness& soundness) {
  Places places;
  std::string text;
  for (std::size_t q = 0; q < bounds.size(); ++q) {
    if (bounds[q].positive()) continue;
    constexpr int kShown = 3;
    if (places.count < kShown)
      text += fmt::format("{} {}", places.count > 0 ? "," : "", show_element(mesh, q));
    Vec3 centre;
    for (const int v : mesh.quads[q]) centre = centre + 0.25 * mesh.points[v];
    places.add({centre, mesh.quad_region[q]});
  }
  if (places.count == 0) return;
  soundness.reasons.push_back(fmt::format("{} curved element{} not proven to be positive, at{}", places.count,
                                          places.count == 1 ? " is" : "s are", text));
  soundness.places.insert(soundness.places.end(), places.first.begin(), places.first.end());
}

}  // namespace

int split_flat_corners(const MeshingSetup& prepared, const SurfaceNodes& nodes, Mesh& mesh) {
  if (prepared.settings.order == 1 || !mesh.triangles.empty() || !has_finite_points(mesh)) return 0;
  const Mesh given = mesh;
  return split_flat_corners(mesh, *true_geometry(prepared, nodes, given));
}

bool curve_mesh(const MeshingSetup& prepared, const SurfaceNodes& nodes, Mesh& mesh, Soundness& soundness,
                std::vector<Warning>& warnings, CurvingSummary& summary) {
  if (!mesh.triangles.empty())
    throw InputError(fmt::format("{}: elements of order {} need a mesh of quads alone: {} triangles are left",
                                 prepared.settings.where, prepared.settings.order, mesh.triangles.size()));
  summary.order = prepared.settings.order;
  const Mesh straight = mesh;
  const auto geometry = true_geometry(prepared, nodes, straight);
  summary.distance_straight = distance_to_model(straight, *geometry);
  raise_order(mesh, prepared.settings.order, *geometry);
  pair_curved_lines(mesh);
  std::vector<JacobianBounds> bounds = jacobian_bounds(mesh);
  const std::vector<CurveCorner> corners = curve_corners(straight, *geometry);
  open_cusps(mesh, *geometry, corners, bounds);
  UntanglingLimits limits{allowed_by(corners, mesh.quads.size()), held_vertices(prepared, straight)};
  if (has_metric(prepared)) allow_as_straight(straight, limits.allowed);
  const UntanglingSummary untangled = untangle_curved(mesh, *geometry, limits, bounds);
  summary.poor = untangled.poor;
  summary.improved = untangled.improved;
  const ProvenJacobians proven = proven_jacobians(bounds);
  summary.unproven = proven.unproven;
  summary.least_jacobian = proven.least;
  summary.mean_jacobian = proven.mean;
  count_low(bounds, limits.allowed, mesh, prepared, summary, warnings);
  summary.distance = distance_to_model(mesh, *geometry);
  report_unproven(mesh, bounds, soundness);
  return untangled.moved_vertices;
}

Mesh straight_form(const Mesh& curved) {
  Mesh mesh = curved;
  int n = 0;
  for (const auto& quad : mesh.quads) n = std::max(n, *std::ranges::max_element(quad) + 1);
  mesh.points.resize(static_cast<std::size_t>(n));
  mesh.order = 1;
  mesh.line_nodes.clear();
  mesh.quad_nodes.clear();
  for (PeriodicNodes& pair : mesh.periodic)
    std::erase_if(pair.nodes, [&](const auto& both) { return both[0] >= n; });
  return mesh;
}

}  // namespace delquad
