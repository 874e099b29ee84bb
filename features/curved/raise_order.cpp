// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/raise_order.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/cancel.h"
#include "base/parallel_each.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// A curved side's bend is gone at this distance from it, in its lengths.
constexpr double kReach = 1;
/// Less, as a part of the side, is no bend.
constexpr double kNoBend = 1e-12;

/// A side of quads, from its lower vertex to its higher one.
struct Side {
  int lo, hi, region;
  int line = -1;                  ///< that lies on it
  std::vector<Vec3> points = {};  ///< strictly inside
};

/// The part of a line's bend that a side gets, by its distance: 1 on the line, 0 out of reach.
struct Bend {
  double part = 0;
  std::vector<Vec3> shift = {};
};

class OrderRaiser {
 public:
  OrderRaiser(Mesh& mesh, int order, const ModelGeometry& geometry)
      : mesh_(mesh), order_(order), geometry_(geometry) {
    for (int k = 1; k < order; ++k) parts_.push_back(static_cast<double>(k) / order);
    find_sides();
  }

  void run() {
    place_sides();
    bend_thin_quads();
    number_nodes();
    parallel_each(mesh_.quads.size(), [&](std::size_t q) {
      check_cancelled();
      place_inside(mesh_, q, geometry_);
    });
  }

 private:
  void find_sides() {
    std::unordered_map<long long, int> known;  // only looked up
    const auto side_of = [&](int a, int b, int region) {
      const auto [lo, hi] = std::minmax(a, b);
      const auto [at, is_new] =
          known.try_emplace(static_cast<long long>(lo) * static_cast<long long>(mesh_.points.size()) + hi,
                            static_cast<int>(sides_.size()));
      if (is_new) sides_.push_back({lo, hi, region});
      return at->second;
    };
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
      for (int k = 0; k < 4; ++k)
        quad_sides_.push_back(side_of(mesh_.quads[q][k], mesh_.quads[q][(k + 1) % 4], mesh_.quad_region[q]));
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      line_side_.push_back(side_of(mesh_.lines[l][0], mesh_.lines[l][1], -1));
      sides_[line_side_.back()].line = static_cast<int>(l);
    }
  }

  void place_sides() {
    parallel_each(sides_.size(), [&](std::size_t s) {
      check_cancelled();
      place(sides_[s]);
    });
  }

  void place(Side& side) const {
    if (side.line >= 0) {
      side.points = geometry_.on_line(side.line, parts_);
      if (mesh_.lines[side.line][0] != side.lo) std::ranges::reverse(side.points);
      return;
    }
    for (const double t : parts_) side.points.push_back(geometry_.on_face(side.region, straight(side, t)));
  }
  Vec3 straight(const Side& side, double t) const {
    return (1 - t) * mesh_.points[side.lo] + t * mesh_.points[side.hi];
  }
  double length(const Side& side) const { return norm(mesh_.points[side.hi] - mesh_.points[side.lo]); }

  std::vector<Vec3> bend(const Side& side) const {
    std::vector<Vec3> result;
    for (std::size_t k = 0; k < parts_.size(); ++k)
      result.push_back(side.points[k] - straight(side, parts_[k]));
    return result;
  }
  bool is_bent(const Side& side) const {
    return std::ranges::any_of(bend(side), [&](const Vec3& b) { return norm(b) > kNoBend * length(side); });
  }

  /// From each bent line across the quads on both sides, while they are near.
  void bend_thin_quads() {
    std::vector<std::vector<int>> at_side(sides_.size());
    for (std::size_t i = 0; i < quad_sides_.size(); ++i)
      at_side[quad_sides_[i]].push_back(static_cast<int>(i));
    std::vector<Bend> added(sides_.size());
    for (std::size_t first = 0; first < sides_.size(); ++first) {
      if (sides_[first].line < 0 || !is_bent(sides_[first])) continue;
      for (const int i : at_side[first]) bend_across(i, at_side, added);
    }
    parallel_each(sides_.size(), [&](std::size_t s) {
      for (std::size_t k = 0; k < added[s].shift.size(); ++k)
        sides_[s].points[k] = geometry_.on_face(sides_[s].region, sides_[s].points[k] + added[s].shift[k]);
    });
  }

  void bend_across(int quad_side, const std::vector<std::vector<int>>& at_side,
                   std::vector<Bend>& added) const {
    const Side& line = sides_[quad_sides_[quad_side]];
    const std::vector<Vec3> bent = bend(line);
    // Which end of the side that is reached lies over the line's lower one.
    int quad = quad_side / 4, k = quad_side % 4;
    bool same_way = mesh_.quads[quad][k] == line.lo;
    int from = mesh_.quads[quad][k], to = mesh_.quads[quad][(k + 1) % 4];
    if (!same_way) std::swap(from, to);
    double height = 0;
    for (std::size_t step = 0; step < mesh_.quads.size(); ++step) {
      const auto& v = mesh_.quads[quad];
      const int over_first = v[(k + 3) % 4], over_second = v[(k + 2) % 4];
      const bool from_is_first = v[k] == from;
      const int next_from = from_is_first ? over_first : over_second;
      const int next_to = from_is_first ? over_second : over_first;
      height += (norm(mesh_.points[next_from] - mesh_.points[from]) +
                 norm(mesh_.points[next_to] - mesh_.points[to])) /
                2;
      from = next_from, to = next_to;
      const double part = 1 - height / (kReach * length(line));
      const int reached = quad_sides_[4 * quad + (k + 2) % 4];
      if (part <= 0 || sides_[reached].line >= 0) return;
      // At equal curvature the bend of a side grows with the square of its length.
      const double shorter = std::min(1.0, std::pow(length(sides_[reached]) / length(line), 2));
      // If several lines bend a side, the nearest counts.
      Bend& now = added[reached];
      if (part > now.part) {
        now = {part, std::vector<Vec3>(parts_.size())};
        for (std::size_t i = 0; i < parts_.size(); ++i)
          now.shift[sides_[reached].lo == from ? i : parts_.size() - 1 - i] = part * shorter * bent[i];
      }
      int next = -1;
      for (const int other : at_side[reached])
        if (other / 4 != quad) next = other;
      if (next < 0) return;
      quad = next / 4, k = next % 4;
    }
  }

  void number_nodes() {
    std::vector<int> first(sides_.size());
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      first[s] = static_cast<int>(mesh_.points.size());
      mesh_.points.insert(mesh_.points.end(), sides_[s].points.begin(), sides_[s].points.end());
    }
    const int n = order_ - 1;
    const auto append = [&](std::vector<int>& nodes, int s, int from) {
      for (int k = 0; k < n; ++k) nodes.push_back(first[s] + (sides_[s].lo == from ? k : n - 1 - k));
    };
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      append(mesh_.line_nodes, line_side_[l], mesh_.lines[l][0]);
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q) {
      for (int k = 0; k < 4; ++k) append(mesh_.quad_nodes, quad_sides_[4 * q + k], mesh_.quads[q][k]);
      for (int i = 0; i < n * n; ++i) {
        mesh_.quad_nodes.push_back(static_cast<int>(mesh_.points.size()));
        mesh_.points.emplace_back();
      }
    }
    mesh_.order = order_;
  }

  Mesh& mesh_;
  const int order_;
  const ModelGeometry& geometry_;
  std::vector<double> parts_;  ///< of a side at which its nodes are
  std::vector<Side> sides_;
  std::vector<int> quad_sides_;  ///< four of each quad
  std::vector<int> line_side_;
};

}  // namespace

void place_inside(Mesh& mesh, std::size_t quad, const ModelGeometry& geometry) {
  const int p = mesh.order, row = p + 1;
  const std::vector<int> nodes = nodes_of_quad(mesh, quad);
  const auto at = [&](int i, int j) { return mesh.points[nodes[j * row + i]]; };
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) {
      const double u = static_cast<double>(i) / p, v = static_cast<double>(j) / p;
      const Vec3 across = (1 - v) * at(i, 0) + v * at(i, p) + (1 - u) * at(0, j) + u * at(p, j);
      const Vec3 corners =
          (1 - u) * (1 - v) * at(0, 0) + u * (1 - v) * at(p, 0) + u * v * at(p, p) + (1 - u) * v * at(0, p);
      mesh.points[nodes[j * row + i]] = geometry.on_face(mesh.quad_region[quad], across - corners);
    }
}

void raise_order(Mesh& mesh, int order, const ModelGeometry& geometry) {
  OrderRaiser(mesh, order, geometry).run();
}

}  // namespace delquad
