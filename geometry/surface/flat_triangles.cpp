// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/triangle_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <queue>
#include <utility>

#include "base/cancel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {

namespace {

using Corners = std::array<int, 3>;

constexpr double kCollinear = 1e-7;  // height, or a side, over the longest side: rounding of single precision

bool repeats_vertex(const Corners& v) { return v[0] == v[1] || v[1] == v[2] || v[2] == v[0]; }

double side_length(const std::vector<Vec3>& points, const Corners& v, int k) {
  return norm(points[v[(k + 1) % 3]] - points[v[k]]);
}

int longest_side(const std::vector<Vec3>& points, const Corners& v) {
  int longest = 0;
  for (int k = 1; k < 3; ++k)
    if (side_length(points, v, k) > side_length(points, v, longest)) longest = k;
  return longest;
}

class FlatRemover {
 public:
  FlatRemover(Mesh& mesh, const std::string& source) : mesh_(mesh), source_(source) {}

  FlatTriangles run() {
    gone_.assign(mesh_.triangles.size(), 0);
    FlatTriangles flat;
    for (int t = 0; t < static_cast<int>(gone_.size()); ++t) {
      gone_[t] = repeats_vertex(mesh_.triangles[t]);
      if (!gone_[t] && has_area(mesh_.points, mesh_.triangles[t])) continue;
      if (flat.count++ == 0) flat.first = mesh_.points[mesh_.triangles[t][0]];
      if (!gone_[t]) consider(t);
    }
    if (flat.count == 0) return flat;
    if (!queue_.empty()) take_out(static_cast<std::size_t>(flat.count));
    finish();
    return flat;
  }

 private:
  void consider(int t) {
    const Corners& v = mesh_.triangles[t];
    if (!has_area(mesh_.points, v))
      queue_.push({side_length(mesh_.points, v, longest_side(mesh_.points, v)), -t});
  }

  /// Removes flat triangles, the longest first, since triangles that are cut with one are shorter.
  void take_out(std::size_t n_flat) {
    triangles_at_.resize(mesh_.points.size());
    for (int t = 0; t < static_cast<int>(gone_.size()); ++t)
      if (!gone_[t])
        for (const int v : mesh_.triangles[t]) triangles_at_[v].push_back(t);
    constexpr std::size_t kLeast = 1000, kEach = 100;  // a chain takes as many steps as it has triangles
    for (std::size_t left = kLeast + kEach * n_flat; !queue_.empty(); --left) {
      check_cancelled();
      const int t = -queue_.top().second;
      queue_.pop();
      const Corners v = mesh_.triangles[t];
      if (gone_[t] || has_area(mesh_.points, v)) continue;
      if (left == 0)
        throw InputError(
            fmt::format("{}: triangles without area lie on each other at {}: expected a surface "
                        "in which they can be taken out",
                        source_, show_point(mesh_.points[v[0]])));
      const int k = longest_side(mesh_.points, v);
      const double least = kCollinear * side_length(mesh_.points, v, k);
      const int a = v[k], b = v[(k + 1) % 3], middle = v[(k + 2) % 3];
      if (!(side_length(mesh_.points, v, (k + 1) % 3) > least))
        join(std::min(b, middle), std::max(b, middle));
      else if (!(side_length(mesh_.points, v, (k + 2) % 3) > least))
        join(std::min(a, middle), std::max(a, middle));
      else
        cut(t, a, b, middle);
    }
  }

  void remove(int t) {
    gone_[t] = 1;
    for (const int v : mesh_.triangles[t]) std::erase(triangles_at_[v], t);
  }

  /// Handles a triangle with new corners. If two triangles have the same corners, both are removed. If both
  /// have no area, one is removed, because the neighbors have still to be cut.
  void settle(int t) {
    const Corners v = mesh_.triangles[t];
    if (repeats_vertex(v)) return remove(t);
    for (const int u : triangles_at_[v[0]])
      if (u != t && std::ranges::is_permutation(mesh_.triangles[u], v)) {
        if (has_area(mesh_.points, v)) remove(u);
        return remove(t);
      }
    consider(t);
  }

  void replace_corner(int t, int from, int to) {
    std::ranges::replace(mesh_.triangles[t], from, to);
    std::erase(triangles_at_[from], t);
    if (std::ranges::find(triangles_at_[to], t) == triangles_at_[to].end()) triangles_at_[to].push_back(t);
  }

  /// Merges vertex `gone` into vertex `kept`.
  void join(int kept, int gone) {
    const std::vector<int> triangles = triangles_at_[gone];
    for (const int t : triangles) replace_corner(t, gone, kept);
    for (const int t : triangles)
      if (!gone_[t]) settle(t);
    for (auto& line : mesh_.lines) std::ranges::replace(line, gone, kept);
  }

  /// Cuts the other triangles on side a, b of the flat triangle at its third vertex. The first half takes its
  /// place.
  void cut(int flat, int a, int b, int middle) {
    remove(flat);
    std::vector<int> changed;
    for (const int u : std::vector<int>(triangles_at_[a])) {
      const Corners v = mesh_.triangles[u];
      if (std::ranges::find(v, b) == v.end()) continue;
      const int half = gone_[flat] ? flat : static_cast<int>(gone_.size());
      if (half == flat) {
        mesh_.triangle_region[flat] = mesh_.triangle_region[u];
      } else {
        mesh_.triangles.emplace_back();
        mesh_.triangle_region.push_back(int{mesh_.triangle_region[u]});
        gone_.push_back(0);
      }
      gone_[half] = 0;
      const int end = v[(std::ranges::find(v, a) - v.begin() + 1) % 3] == b ? b : a;  // end of the side in u
      mesh_.triangles[half] = v;
      for (const int w : v) triangles_at_[w].push_back(half);
      replace_corner(half, end, middle);
      replace_corner(u, a + b - end, middle);
      changed.insert(changed.end(), {half, u});
    }
    for (const int t : changed)
      if (!gone_[t]) settle(t);
    cut_lines(a, b, middle);
  }

  void cut_lines(int a, int b, int middle) {
    for (std::size_t i = mesh_.lines.size(); i-- > 0;) {
      const auto [c, d] = mesh_.lines[i];
      if (std::minmax(a, b) != std::minmax(c, d)) continue;
      mesh_.lines[i] = {c, middle};
      mesh_.lines.push_back({middle, d});
      mesh_.line_curve.push_back(int{mesh_.line_curve[i]});
    }
  }

  void finish() {
    keep_triangles(mesh_, [&](std::size_t t) { return !gone_[t]; });
    keep_lines(mesh_, [&](std::size_t i) { return mesh_.lines[i][0] != mesh_.lines[i][1]; });
  }

  Mesh& mesh_;
  const std::string& source_;
  std::vector<char> gone_;                             ///< triangles
  std::vector<std::vector<int>> triangles_at_;         ///< vertices
  std::priority_queue<std::pair<double, int>> queue_;  ///< flat triangles: longest side, minus the index
};

}  // namespace

bool has_area(const std::vector<Vec3>& points, const std::array<int, 3>& v) {
  const int k = longest_side(points, v);
  const Vec3 base = points[v[(k + 1) % 3]] - points[v[k]], side = points[v[(k + 2) % 3]] - points[v[k]];
  const double length = norm(base);
  return norm(cross((1 / length) * base, side)) > kCollinear * length;
}

FlatTriangles take_out_flat_triangles(Mesh& mesh, const std::string& source) {
  return FlatRemover(mesh, source).run();
}

}  // namespace delquad
