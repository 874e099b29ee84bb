#include "features/curved/open_cusps.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "features/curved/raise_order.h"
#include "features/curved/untangle_curved.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

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

}  // namespace

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

}  // namespace delquad
