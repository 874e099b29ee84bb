// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/improve_triangulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <tuple>
#include <utility>

#include "base/cancel.h"
#include "base/sort_unique.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {

namespace {

/// Largest turn of normals by flips. On a smooth true surface both diagonals are equal; otherwise the
/// triangles are the surface.
const double kTurnSmooth = std::cos(25 * std::numbers::pi / 180);
const double kTurnExact = std::cos(3 * std::numbers::pi / 180);
/// Height over longest side below which a triangle's normal is unreliable, and least such ratio after a flip.
constexpr double kThin = 0.02, kFlat = 1e-7;
/// Largest move of a new point over the side that it splits.
constexpr double kMaxMove = 0.25;

class Improver {
 public:
  Improver(SurfaceModel& model, const ImproveOptions& options)
      : model_(model), mesh_(model.fine), editor_(model), options_(options), diagonal_(diagonal(mesh_)) {
    find_curved_faces();
  }

  /// Follows a rule instead of the options' lengths.
  void refine(RefinementRule& rule) {
    rule_ = &rule;
    if (rule.has_lengths()) flip_all();
    split_all();
    editor_.finish();
  }

  void run() {
    flip_all();
    find_targets();
    split_all();
    editor_.finish();
  }

 private:
  using Edge = std::pair<int, int>;

  const Vec3& point(int v) const { return mesh_.points[v]; }
  double length(const Edge& e) const { return norm(point(e.second) - point(e.first)); }
  static Edge edge(int a, int b) { return std::minmax({a, b}); }
  Edge side(int t, int k) const {
    return edge(mesh_.triangles[t][(k + 1) % 3], mesh_.triangles[t][(k + 2) % 3]);
  }
  Vec3 double_area(int a, int b, int c) const { return cross(point(b) - point(a), point(c) - point(a)); }

  void find_curved_faces() {
    std::vector<Vec3> sum(mesh_.regions.size());
    std::vector<int> any(mesh_.regions.size(), -1);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto [a, b, c] = mesh_.triangles[t];
      sum[mesh_.triangle_region[t]] = sum[mesh_.triangle_region[t]] + double_area(a, b, c);
      any[mesh_.triangle_region[t]] = a;
    }
    curved_.assign(mesh_.regions.size(), 0);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const int face = mesh_.triangle_region[t];
      const double scale = norm(sum[face]);
      for (int v : mesh_.triangles[t])
        if (scale == 0 || std::abs(dot(point(v) - point(any[face]), sum[face])) > 1e-9 * diagonal_ * scale)
          curved_[face] = 1;
    }
  }

  /// Returns the unit normal; zero for a triangle whose height over its longest side is below `thinnest`.
  Vec3 normal(int a, int b, int c, double thinnest) const {
    const Vec3 n = double_area(a, b, c);
    const double longest = std::max({length({a, b}), length({b, c}), length({c, a})});
    return norm(n) > thinnest * longest * longest ? (1 / norm(n)) * n : Vec3{};
  }

  double length_in(int face, const Edge& e) const {
    return rule_ == nullptr ? length(e) : rule_->length(face, e.first, e.second, length(e));
  }

  double cotangent(int at, int b, int c) const {
    const Vec3 u = point(b) - point(at), v = point(c) - point(at);
    return dot(u, v) / std::max(norm(cross(u, v)), std::numeric_limits<double>::min());
  }

  /// Returns the normal of a face at one of its points, of any length.
  Vec3 normal_at(int v, int face) const {
    Vec3 sum;
    for (const int t : editor_.triangles_at(v)) {
      const auto& [a, b, c] = mesh_.triangles[t];
      if (mesh_.triangle_region[t] == face) sum = sum + double_area(a, b, c);
    }
    return sum;
  }

  /// Returns whether c-d is better than the edge a-b of the triangles (a, b, c) and (b, a, d) of a face. One
  /// of them may be too thin for a normal, as facets of long cylinders are. Then normals at their points must
  /// not turn further away from the triangles.
  bool should_flip(int a, int b, int c, int d, int face) const {
    constexpr double kTie = 1e-6;  // cocircular points stay as they are
    const double sum = rule_ != nullptr && rule_->has_lengths() ? rule_->cotangents(face, {a, b, c, d})
                                                                : cotangent(c, a, b) + cotangent(d, a, b);
    if (sum > -kTie) return false;
    const Vec3 old_normals[] = {normal(a, b, c, kThin), normal(b, a, d, kThin)};
    const Vec3 new_normals[] = {normal(a, d, c, kFlat), normal(b, c, d, kFlat)};
    const double limit = model_.projector ? kTurnSmooth : kTurnExact;
    for (const Vec3& n : new_normals) {
      if (dot(n, n) == 0) return false;
      for (const Vec3& o : old_normals)
        if (dot(o, o) > 0 && dot(n, o) < limit) return false;
    }
    const bool known = dot(old_normals[0], old_normals[0]) > 0 && dot(old_normals[1], old_normals[1]) > 0;
    return known || std::ranges::all_of(std::array{a, b, c, d}, [&](int v) {
             const Vec3 at = normal_at(v, face);
             const auto least = [&](const Vec3& m, const Vec3& n) {
               return std::min(dot(m, at), dot(n, at));
             };
             return least(new_normals[0], new_normals[1]) >=
                    std::min(kTurnSmooth * norm(at), least(normal(a, b, c, 0), normal(b, a, d, 0)));
           });
  }

  /// Removes all copies of the least edge from the queue, a heap, and returns it.
  Edge next_in_queue() {
    const Edge e = queue_.front();
    while (!queue_.empty() && queue_.front() == e) {
      std::ranges::pop_heap(queue_, std::greater<>{});
      queue_.pop_back();
    }
    return e;
  }

  void flip_all() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) queue_.push_back(side(static_cast<int>(t), k));
    flip();
  }

  /// Flips the edges in the queue, and edges around each flipped edge, until none is better.
  void flip() {
    sort_unique(queue_);
    std::size_t budget = 20 * queue_.size();  // flips in space have no energy that falls
    while (!queue_.empty() && budget > 0) {
      check_cancelled();
      const Edge e = next_in_queue();
      editor_.find_triangles_on(e.first, e.second, on_edge_);
      if (on_edge_.size() != 2) continue;
      const auto [a, b, c] = seen_from(on_edge_[0], e);
      const int d = seen_from(on_edge_[1], e)[2];
      if (!should_flip(a, b, c, d, mesh_.triangle_region[on_edge_[0]]) || !editor_.flip_edge(a, b)) continue;
      --budget;
      for (int t : on_edge_) flipped_.push_back(t);
      for (const Edge& next : {edge(a, c), edge(a, d), edge(b, c), edge(b, d)}) {
        queue_.push_back(next);
        std::ranges::push_heap(queue_, std::greater<>{});
      }
    }
    queue_.clear();
  }

  /// Returns the triangle as (a, b, c), with the edge a-b.
  std::array<int, 3> seen_from(int t, const Edge& e) const {
    const auto& v = mesh_.triangles[t];
    for (int k = 0; k < 3; ++k)
      if (v[k] != e.first && v[k] != e.second) return {v[(k + 1) % 3], v[(k + 2) % 3], v[k]};
    return v;
  }

  /// Side to split: longest first, ties by nodes.
  using Candidate = std::tuple<double, int, int>;

  bool is_too_large(int t, double longest) const {
    if (rule_ == nullptr) return curved_[mesh_.triangle_region[t]] && longest > target_[t];
    const auto& v = mesh_.triangles[t];
    std::array<int, 3> curve;
    for (int k = 0; k < 3; ++k) curve[k] = curve_on(v[(k + 1) % 3], v[(k + 2) % 3]);
    return rule_->is_too_large(mesh_.triangle_region[t], v, curve);
  }

  int curve_on(int a, int b) const {
    const int line = editor_.line_on(a, b);
    return line >= 0 ? mesh_.line_curve[line] : -1;
  }

  void consider(int t) {
    const int face = mesh_.triangle_region[t];
    std::array<double, 3> lengths;
    for (int k = 0; k < 3; ++k) lengths[k] = length_in(face, side(t, k));
    if (!is_too_large(t, std::ranges::max(lengths))) return;
    int longest = -1;
    for (int k = 0; k < 3; ++k)
      if ((longest < 0 || lengths[k] > lengths[longest]) &&
          (rule_ == nullptr || rule_->may_split(face, side(t, k).first, side(t, k).second)))
        longest = k;
    const auto [a, b] = side(t, longest);
    candidates_.push({lengths[longest], a, b});
  }

  // Sets the largest length of sides for each triangle. Halves keep it, since needles around a pole are
  // needles at any size.
  void find_targets() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      double shortest = options_.max_length * diagonal_;
      for (int k = 0; k < 3; ++k)
        shortest = std::min(shortest, options_.max_aspect * length(side(static_cast<int>(t), k)));
      target_.push_back(std::max(shortest, options_.min_length * diagonal_));
    }
  }

  // Splits sides, and flips edges around each new point at once, since halves of needles are needles. It
  // ends, as each split halves an edge and short edges are not split.
  void split_all() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) consider(static_cast<int>(t));
    while (!candidates_.empty()) {
      check_cancelled();
      const auto [l, a, b] = candidates_.top();
      candidates_.pop();
      const std::vector<int> on_edge = editor_.triangles_on(a, b);
      if (on_edge.empty()) continue;  // split or flipped already
      if (rule_ != nullptr && rule_->has_lengths() &&
          std::ranges::none_of(on_edge, [&](int t) { return is_too_large(t, l); }))
        continue;
      if (rule_ == nullptr)
        for (int t : on_edge) target_.push_back(target_[t]);
      const int face = mesh_.triangle_region[on_edge[0]];
      const int curve = curve_on(a, b);
      const int node = editor_.split_edge(a, b, midpoint(a, b, on_edge[0]));
      if (rule_ != nullptr) rule_->node_added(node, a, b, face, curve);
      flipped_.clear();
      for (int t : editor_.triangles_at(node))
        for (int k = 0; k < 3; ++k) queue_.push_back(side(t, k));
      flip();
      for (int t : flipped_) consider(t);
      for (int t : editor_.triangles_at(node)) consider(t);
    }
  }

  Vec3 midpoint(int a, int b, int triangle) const {
    const Vec3 middle = 0.5 * (point(a) + point(b));
    if (!model_.projector) return middle;
    const int line = editor_.line_on(a, b);
    const Vec3 x = line >= 0 ? model_.projector->to_curve(mesh_.line_curve[line], middle)
                             : model_.projector->to_face(mesh_.triangle_region[triangle], middle);
    return norm(x - middle) <= kMaxMove * length({a, b}) ? x : middle;
  }

  SurfaceModel& model_;
  Mesh& mesh_;
  SurfaceEditor editor_;
  const ImproveOptions& options_;
  double diagonal_;
  RefinementRule* rule_ = nullptr;
  std::vector<char> curved_;    ///< whether each face is curved
  std::vector<double> target_;  ///< largest length of sides of each triangle
  std::vector<Edge> queue_;     ///< edges that may have to be flipped
  std::vector<int> on_edge_;    ///< triangles, in flip()
  std::vector<int> flipped_;    ///< triangles, since the last split
  std::priority_queue<Candidate> candidates_;
};

}  // namespace

void improve_triangulation(SurfaceModel& model, const ImproveOptions& options) {
  Improver(model, options).run();
}

void refine_triangulation(SurfaceModel& model, RefinementRule& rule) {
  const ImproveOptions none;
  Improver(model, none).refine(rule);
}

}  // namespace delquad
