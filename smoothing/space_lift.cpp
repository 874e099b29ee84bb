#include "smoothing/space_lift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "smoothing/quad_topology.h"

namespace delquad {

namespace {

/// The search begins with this part of the longest edge, and ends after so many steps.
constexpr double kReach = 0.25;
constexpr int kSteps = 14;
/// A move that gains less is not made.
constexpr double kLeastGain = 1e-3;
/// Quality of a quad that is turned over in the parameter plane.
constexpr double kTurnedOver = -3;

class SpaceLift {
 public:
  SpaceLift(const QuadPatch& patch, const std::vector<Vec3>& boundary, const PatchLift& lift)
      : mesh_(patch), lift_(lift), place_(boundary), hint_(patch.points.size(), -1) {
    for (size_t v = boundary.size(); v < patch.points.size(); ++v) {
      if (v > 0) hint_[v] = hint_[v - 1];
      place_.push_back(lift_(patch.points[v], hint_[v]));
    }
  }

  void run(double eta, int max_sweeps) {
    bool moved = true;
    for (int sweep = 0; sweep < max_sweeps && moved; ++sweep) {
      moved = false;
      for (int e = 0; e < mesh_.element_slots(); ++e) {
        if (!mesh_.is_quad(e) || quality(e) >= eta) continue;
        for (int k = 0; k < 4; ++k) moved = improve(mesh_.corner(e, k)) || moved;
      }
      mesh_.commit();
    }
  }

  Vec2 point(int v) const { return mesh_.point(v); }
  Vec3 place(int v) const { return place_[v]; }

 private:
  /// 1 - |angle - 90 degrees| / 90 degrees, the least over the corners: eta where that is positive. Without
  /// the corner `skipped` (none: -1).
  double quality(int e, int skipped = -1) const {
    std::array<Vec3, 4> x;
    std::array<Vec2, 4> u;
    for (int k = 0; k < 4; ++k) x[k] = place_[mesh_.corner(e, k)], u[k] = mesh_.point(mesh_.corner(e, k));
    if (!(cross(u[2] - u[0], u[3] - u[1]) > 0)) return kTurnedOver;
    const Vec3 normal = cross(x[2] - x[0], x[3] - x[1]);
    double least = 1;
    for (int k = 0; k < 4; ++k) {
      if (k == skipped) continue;
      const Vec3 out = x[(k + 1) % 4] - x[k], in = x[(k + 3) % 4] - x[k], c = cross(out, in);
      double angle = std::atan2(norm(c), dot(out, in));
      if (dot(c, normal) < 0) angle = 2 * std::numbers::pi - angle;
      least = std::min(least, 1 - std::abs(angle - std::numbers::pi / 2) * (2 / std::numbers::pi));
    }
    return least;
  }

  /// Of the corners that the place of v changes: in each quad all but the one opposite.
  double quality_around(int v) const {
    double least = 1;
    mesh_.for_each_out(v, [&](int h) {
      const int e = QuadTopology::element(h);
      if (mesh_.is_quad(e)) least = std::min(least, quality(e, (h + 2) & 3));
    });
    return least;
  }

  void put(int v, Vec2 u) {
    mesh_.move(v, u);
    place_[v] = lift_(u, hint_[v]);
  }

  /// Axes of the search, a step long: along the longest edge, and across it as far as the edges reach.
  std::array<Vec2, 2> axes(int v) const {
    Vec2 along;
    mesh_.for_each_out(v, [&](int h) {
      const Vec2 edge = mesh_.point(mesh_.target(h)) - mesh_.point(v);
      if (norm(edge) > norm(along)) along = edge;
    });
    double width = 0;
    mesh_.for_each_out(v, [&](int h) {
      const Vec2 edge = mesh_.point(mesh_.target(h)) - mesh_.point(v);
      width = std::max(width, std::abs(cross(along, edge)) / dot(along, along));
    });
    return {kReach * along, kReach * width * perp(along)};
  }

  /// The best of the places halfway between two neighbours, then a compass search: eight directions, a step
  /// that shrinks.
  bool improve(int v) {
    if (mesh_.on_boundary(v)) return false;
    const Vec2 start = mesh_.point(v);
    const double before = quality_around(v);
    double best = before;
    Vec2 at = start;
    const auto try_at = [&](Vec2 u) {
      put(v, u);
      const double trial = quality_around(v);
      if (trial > best) best = trial, at = u;
    };
    std::vector<Vec2> neighbours;
    mesh_.for_each_out(v, [&](int h) { neighbours.push_back(mesh_.point(mesh_.target(h))); });
    for (size_t i = 0; i < neighbours.size(); ++i)
      for (size_t j = 0; j < i; ++j) try_at(0.5 * (neighbours[i] + neighbours[j]));
    put(v, at);
    auto [along, across] = axes(v);
    constexpr double kDiagonal = std::numbers::sqrt2 / 2;
    constexpr Vec2 kCompass[8] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                                  {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};
    for (int step = 0; step < kSteps; ++step) {
      const Vec2 centre = at;
      const double last = best;
      for (const Vec2 direction : kCompass) try_at(centre + direction.x * along + direction.y * across);
      if (best == last) along = 0.5 * along, across = 0.5 * across;
    }
    const bool gained = best > before + kLeastGain;
    put(v, gained ? at : start);
    return gained;
  }

  QuadTopology mesh_;
  const PatchLift& lift_;
  std::vector<Vec3> place_;  ///< in space, of each vertex
  std::vector<int> hint_;
};

}  // namespace

std::vector<Vec3> lift_worst_in_space(QuadPatch& patch, const std::vector<Vec3>& boundary,
                                      const PatchLift& lift, double eta, int max_sweeps) {
  SpaceLift process(patch, boundary, lift);
  process.run(eta, max_sweeps);
  std::vector<Vec3> inside;
  for (int v = patch.n_boundary; v < static_cast<int>(patch.points.size()); ++v) {
    patch.points[v] = process.point(v);
    inside.push_back(process.place(v));
  }
  return inside;
}

}  // namespace delquad
