// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/untangle_curved.h"

#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "base/cancel.h"
#include "base/parallel.h"
#include "base/parallel_each.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// Derivatives of an order's shape functions at the places where elements' distortion is measured.
struct SampleTable {
  std::vector<std::vector<double>> du, dv;  ///< by sample and node
};

/// An element, and the parallelogram that it should be like.
struct DistortionTarget {
  std::vector<int> nodes;           ///< as nodes_of_quad() orders them
  Vec3 e1, e2;                      ///< of its plane
  std::array<double, 4> inverse{};  ///< of the parallelogram's sides in that plane, by rows
};

/// The target shape of an element.
enum class TargetShape {
  kStraight,     ///< the parallelogram in the middle of its straight form
  kRightAngled,  ///< a rectangle with sides as long as the sides of its straight form are in the mean
};

/// Weights of the terms of a distortion.
struct DistortionWeights {
  double shape;  ///< w below: weight of shapes against scaled Jacobians, 0 to 1
  int power;     ///< k below: how much more the worst count
};

/// A node that moves: along two axes, or one, the other being zero.
struct FreeNode {
  int node;
  int region = -1, curve = -1;  ///< that it slides on: one of these
  std::array<Vec3, 2> axes = {};
};

/// Limits below which det T counts as hardly positive. The second is a part of the least determinant if all
/// are positive, so that they stay positive.
constexpr double kSoftness = 0.05, kSoftPart = 0.2;
/// Places at which an element's distortion is measured, along each side.
constexpr int kSamples = 7;

SampleTable make_sample_table(int order) {
  const auto values = [&](double t) {
    std::vector<std::array<double, 2>> result;  // value and derivative of each node's polynomial
    for (int i = 0; i <= order; ++i) {
      double value = 1, slope = 0;
      for (int k = 0; k <= order; ++k) {
        if (k == i) continue;
        const double over = static_cast<double>(i - k) / order,
                     factor = (t - static_cast<double>(k) / order) / over;
        slope = slope * factor + value / over;
        value *= factor;
      }
      result.push_back({value, slope});
    }
    return result;
  };
  SampleTable table;
  for (int b = 0; b < kSamples; ++b)
    for (int a = 0; a < kSamples; ++a) {
      const auto fu = values(static_cast<double>(a) / (kSamples - 1)),
                 fv = values(static_cast<double>(b) / (kSamples - 1));
      std::vector<double> du, dv;
      for (int j = 0; j <= order; ++j)
        for (int i = 0; i <= order; ++i) {
          du.push_back(fu[i][1] * fv[j][0]);
          dv.push_back(fu[i][0] * fv[j][1]);
        }
      table.du.push_back(std::move(du));
      table.dv.push_back(std::move(dv));
    }
  return table;
}

/// False where the straight quad is flat.
bool make_target(const Mesh& mesh, std::size_t quad, TargetShape target_shape, DistortionTarget& target) {
  target.nodes = nodes_of_quad(mesh, quad);
  const auto& v = mesh.quads[quad];
  const auto at = [&](int k) { return mesh.points[v[k]]; };
  const Vec3 a = 0.5 * (at(1) - at(0) + at(2) - at(3)), b = 0.5 * (at(3) - at(0) + at(2) - at(1));
  const Vec3 n = cross(a, b);
  if (!(norm(n) > 1e-9 * norm(a) * norm(b))) return false;
  target.e1 = (1 / norm(a)) * a;
  target.e2 = cross((1 / norm(n)) * n, target.e1);
  double x = norm(a), y = dot(b, target.e1), z = dot(b, target.e2);
  if (target_shape == TargetShape::kRightAngled) {
    const auto side = [&](int k) { return norm(at((k + 1) % 4) - at(k)); };
    x = (side(0) + side(2)) / 2, y = 0, z = (side(1) + side(3)) / 2;
  }
  target.inverse = {1 / x, -y / (x * z), 0, 1 / z};
  return true;
}

/// The distortion of elements as a function of their free nodes, with two parameters for each node. It is the
/// sum over places of (w |T|^2 / (2 det T) + (1 - w) |p| |q| / det T)^k. T is the element's map divided by
/// the map of its target [Knupp 2001], and p and q are its columns. If det T is not positive, it is
/// regularized [Escobar et al. 2003]. If targets are rectangles, the second term is one over the scaled
/// Jacobian.
class DistortionEnergy final : public ceres::FirstOrderFunction {
 public:
  /// All but the weights outlive it.
  DistortionEnergy(const std::vector<Vec3>& points, const std::vector<DistortionTarget>& targets,
                   const std::vector<FreeNode>& free, const SampleTable& table, DistortionWeights weights)
      : points_(points), targets_(targets), free_(free), table_(table), weights_(weights) {
    std::map<int, int> index;
    for (std::size_t i = 0; i < free.size(); ++i) index[free[i].node] = static_cast<int>(i);
    for (const DistortionTarget& target : targets_) {
      std::vector<int>& of = free_of_.emplace_back();
      for (const int node : target.nodes) {
        const auto found = index.find(node);
        of.push_back(found == index.end() ? -1 : found->second);
      }
    }
    const std::vector<double> start(2 * free.size(), 0);
    double least = 1;
    for (std::size_t t = 0; t < targets_.size(); ++t) {
      const Flat nodes = nodes_in_plane(t, start.data());
      for (std::size_t s = 0; s < table_.du.size(); ++s) {
        const auto [p, q] = columns(targets_[t], nodes, s);
        least = std::min(least, cross(p, q));
      }
    }
    softness_ = least > 0 ? std::min(kSoftPart * least, kSoftness) : kSoftness;
  }

  int NumParameters() const override { return 2 * static_cast<int>(free_.size()); }

  bool Evaluate(const double* x, double* cost, double* gradient) const override {
    if (is_cancelled()) return false;
    *cost = 0;
    if (gradient != nullptr) std::fill_n(gradient, NumParameters(), 0.0);
    for (std::size_t t = 0; t < targets_.size(); ++t) add(t, x, *cost, gradient);
    return std::isfinite(*cost);
  }

 private:
  static constexpr std::size_t kMostNodes = (kMostOrder + 1) * (kMostOrder + 1);
  /// An element's nodes in its plane, or what goes with them.
  struct Flat {
    std::array<double, kMostNodes> x, y;
  };

  Flat nodes_in_plane(std::size_t target, const double* x) const {
    const DistortionTarget& t = targets_[target];
    Flat flat{};
    for (std::size_t i = 0; i < t.nodes.size(); ++i) {
      Vec3 p = points_[t.nodes[i]];
      if (const int f = free_of_[target][i]; f >= 0)
        p = p + x[2 * f] * free_[f].axes[0] + x[2 * f + 1] * free_[f].axes[1];
      flat.x[i] = dot(p, t.e1), flat.y[i] = dot(p, t.e2);
    }
    return flat;
  }

  /// Columns of T: the columns of the element's map times the inverse of the target's map.
  std::array<Vec2, 2> columns(const DistortionTarget& t, const Flat& flat, std::size_t sample) const {
    Vec2 xu, xv;
    const double *du = table_.du[sample].data(), *dv = table_.dv[sample].data();
    for (std::size_t i = 0; i < t.nodes.size(); ++i) {
      xu.x += du[i] * flat.x[i], xu.y += du[i] * flat.y[i];
      xv.x += dv[i] * flat.x[i], xv.y += dv[i] * flat.y[i];
    }
    const auto& [m00, m01, m10, m11] = t.inverse;
    return {m00 * xu + m10 * xv, m01 * xu + m11 * xv};
  }

  void add(std::size_t target, const double* x, double& cost, double* gradient) const {
    const DistortionTarget& t = targets_[target];
    const std::size_t n = t.nodes.size();
    const Flat flat = nodes_in_plane(target, x);
    Flat slope{};
    const auto& [m00, m01, m10, m11] = t.inverse;
    const double shape = weights_.shape;
    for (std::size_t s = 0; s < table_.du.size(); ++s) {
      const auto [p, q] = columns(t, flat, s);
      const double pp = dot(p, p), qq = dot(q, q), lengths = std::sqrt(pp * qq);
      const double det = cross(p, q), root = std::sqrt(det * det + softness_ * softness_);
      const double soft = (det + root) / 2;
      const double distortion = (shape * (pp + qq) / 2 + (1 - shape) * lengths) / soft;
      const double power = std::pow(distortion, weights_.power - 1);
      cost += power * distortion;
      if (gradient == nullptr) continue;
      const double outer = weights_.power * power;
      const double by_det = -distortion / soft * (1 + det / root) / 2;
      const double of_p = pp > 0 ? (1 - shape) * lengths / pp : 0,
                   of_q = qq > 0 ? (1 - shape) * lengths / qq : 0;
      const Vec2 by_p = outer * ((shape + of_p) / soft * p + by_det * Vec2{q.y, -q.x});
      const Vec2 by_q = outer * ((shape + of_q) / soft * q + by_det * Vec2{-p.y, p.x});
      const Vec2 by_u = m00 * by_p + m01 * by_q, by_v = m10 * by_p + m11 * by_q;
      const double *du = table_.du[s].data(), *dv = table_.dv[s].data();
      for (std::size_t i = 0; i < n; ++i) {
        slope.x[i] += du[i] * by_u.x + dv[i] * by_v.x;
        slope.y[i] += du[i] * by_u.y + dv[i] * by_v.y;
      }
    }
    if (gradient == nullptr) return;
    for (std::size_t i = 0; i < n; ++i) {
      const int f = free_of_[target][i];
      if (f < 0) continue;
      const Vec3 in_space = slope.x[i] * t.e1 + slope.y[i] * t.e2;
      for (const int k : {0, 1}) gradient[2 * f + k] += dot(in_space, free_[f].axes[k]);
    }
  }

  const std::vector<Vec3>& points_;
  const std::vector<DistortionTarget>& targets_;
  const std::vector<FreeNode>& free_;
  const SampleTable& table_;
  const DistortionWeights weights_;
  double softness_ = 0;
  std::vector<std::vector<int>> free_of_;  ///< of each target's nodes: index into `free`; -1: it stays
};

/// How often nodes are projected to their face after a descent.
constexpr int kDescents = 5;
constexpr int kDescentSteps = 60;
/// A descent ends where the energy falls by no more, as a part of it, in a step.
constexpr double kLeastDecrease = 1e-3;
/// Parts of the energy's step that are tried; the first that improves the quads counts. Energies know planes
/// only.
constexpr std::array kPartsOfStep{1.0, 0.5, 0.25, 0.1};
/// A node on a curve moves at most by this part of the way to its neighbors there.
constexpr double kMostOfWay = 0.5;

/// One trial; trials follow each other while elements stay poor.
struct Trial {
  int rings;            ///< of quads around poor ones that move with them
  bool moves_vertices;  ///< else only the nodes between them
  TargetShape target_shape;
  DistortionWeights weights;
};
constexpr std::array kTrials{Trial{2, false, TargetShape::kStraight, {1, 3}},
                             Trial{2, true, TargetShape::kRightAngled, {0.2, 3}},
                             Trial{3, true, TargetShape::kRightAngled, {0.05, 4}},
                             Trial{6, true, TargetShape::kRightAngled, {0.1, 4}},
                             Trial{3, true, TargetShape::kRightAngled, {0.05, 8}},
                             Trial{2, true, TargetShape::kRightAngled, {0.2, 4}}};

class CurvedUntangler {
 public:
  CurvedUntangler(Mesh& mesh, const ModelGeometry& geometry, const UntanglingLimits& limits,
                  std::vector<JacobianBounds>& bounds)
      : mesh_(mesh),
        geometry_(geometry),
        limits_(limits),
        bounds_(bounds),
        table_(make_sample_table(mesh.order)) {}

  UntanglingSummary run() {
    UntanglingSummary summary;
    find_tracks();
    is_rough_.assign(mesh_.quads.size(), 0);
    const std::vector<JacobianBounds> before = bounds_;
    std::vector<char> worked_on(mesh_.quads.size(), 0);
    for (const Trial& trial : kTrials) {
      const std::vector<char> poor = find_poor(trial);
      if (std::ranges::count(poor, 1) == 0) continue;
      for (std::size_t q = 0; q < poor.size(); ++q) worked_on[q] |= poor[q];
      const std::vector<std::vector<int>> all = neighbourhoods(poor, trial.rings);
      std::vector<char> moved(all.size(), 0);
      parallel_for(all.size(), [&](std::size_t i) { moved[i] = repair(all[i], trial); });
      summary.moved_vertices =
          summary.moved_vertices || (trial.moves_vertices && std::ranges::count(moved, 1) > 0);
    }
    // Quads that are better than poor have rough bounds so far.
    parallel_each(bounds_.size(), [&](std::size_t q) {
      if (is_rough_[q]) bounds_[q] = bounds_of_quad(static_cast<int>(q), 1);
    });
    for (std::size_t q = 0; q < worked_on.size(); ++q) {
      summary.poor += worked_on[q];
      summary.improved += worked_on[q] && bounds_[q].proven > before[q].proven;
    }
    return summary;
  }

 private:
  static constexpr int kStays = -1, kInFace = -2;

  /// Where nodes may go.
  void find_tracks() {
    curve_of_.assign(mesh_.points.size(), kInFace);
    along_.resize(mesh_.points.size());
    is_vertex_.assign(mesh_.points.size(), 0);
    quads_at_.resize(mesh_.points.size());
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q) {
      for (const int v : mesh_.quads[q]) is_vertex_[v] = 1;
      for (const int v : nodes_of_quad(mesh_, q)) quads_at_[v].push_back(static_cast<int>(q));
    }
    find_tracks_on_lines();
    for (const int v : limits_.stay) curve_of_[v] = kStays;
    for (const NamedPoint& named : mesh_.named_points) curve_of_[named.point] = kStays;
    for (const PeriodicNodes& pair : mesh_.periodic)
      for (const auto& both : pair.nodes)
        for (const int v : both) curve_of_[v] = kStays;
  }

  void find_tracks_on_lines() {
    std::vector<char> has_shape(mesh_.curves.size(), 0);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      has_shape[mesh_.line_curve[l]] =
          geometry_.on_curve(mesh_.line_curve[l], mesh_.points[mesh_.lines[l][0]]).has_value();
    std::vector<int> lines_at(mesh_.points.size(), 0);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      const int curve = mesh_.line_curve[l];
      const std::vector<int> nodes = nodes_of_line(mesh_, l);
      for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
        curve_of_[nodes[k]] = has_shape[curve] ? curve : kStays;
        along_[nodes[k]] = {nodes[k - 1], nodes[k + 1]};
      }
      for (const auto& [v, next] :
           {std::pair(nodes.front(), nodes[1]), std::pair(nodes.back(), nodes[nodes.size() - 2])}) {
        const int n = lines_at[v]++;
        if (n < 2) along_[v][n] = next;
        const bool is_same = n == 0 || curve_of_[v] == curve;
        curve_of_[v] = is_same && n < 2 && has_shape[curve] && geometry_.slides(v) ? curve : kStays;
      }
    }
    for (std::size_t v = 0; v < lines_at.size(); ++v)
      if (lines_at[v] == 1) curve_of_[v] = kStays;
  }

  std::vector<char> find_poor(const Trial& trial) const {
    std::vector<char> poor(mesh_.quads.size(), 0);
    parallel_each(poor.size(), [&](std::size_t q) { poor[q] = is_poor(q, trial); });
    return poor;
  }
  bool is_poor(std::size_t q, const Trial& trial) const {
    const double proven = bounds_[q].proven;
    if (proven <= 0) return true;
    if (proven >= std::min(kPoorJacobian, kPartOfAllowed * limits_.allowed[q])) return false;
    if (trial.moves_vertices) return true;
    std::vector<Vec3> straight;
    for (const int corner : {0, 1, 3, 2}) straight.push_back(mesh_.points[mesh_.quads[q][corner]]);
    constexpr double kAsGood = 0.7;
    return proven < kAsGood * jacobian_bounds(straight, 1).found;
  }

  /// Poor quads that have common quads around them, with these: no two have a free node in common.
  std::vector<std::vector<int>> neighbourhoods(const std::vector<char>& poor, int rings) const {
    std::vector<char> near = poor;
    for (int ring = 0; ring < rings; ++ring) {
      const std::vector<char> inner = near;
      for (std::size_t q = 0; q < inner.size(); ++q)
        if (inner[q])
          for (const int v : mesh_.quads[q])
            for (const int other : quads_at_[v]) near[other] = 1;
    }
    std::vector<std::vector<int>> all;
    std::vector<char> done(near.size(), 0);
    for (std::size_t first = 0; first < near.size(); ++first) {
      if (!near[first] || done[first]) continue;
      std::vector<int> quads{static_cast<int>(first)};
      done[first] = 1;
      for (std::size_t i = 0; i < quads.size(); ++i)
        for (const int v : mesh_.quads[quads[i]])
          for (const int other : quads_at_[v])
            if (near[other] && !std::exchange(done[other], 1)) quads.push_back(other);
      std::ranges::sort(quads);
      all.push_back(std::move(quads));
    }
    return all;
  }

  /// Returns a score of proven bounds of some quads: a sum of logarithms. Bounds above kPoorJacobian count as
  /// kPoorJacobian, and nothing makes up for a bound that is not positive.
  static double score(const std::vector<JacobianBounds>& bounds) {
    constexpr double kNext = 1e-9, kNotPositive = -1e6;
    double sum = 0;
    for (const JacobianBounds& b : bounds)
      sum += b.positive() ? std::log(std::clamp(b.proven, kNext, kPoorJacobian)) : kNotPositive;
    return sum;
  }

  /// Whether one that was positive is no more.
  static bool turns_bad(const std::vector<JacobianBounds>& before, const std::vector<JacobianBounds>& after) {
    for (std::size_t i = 0; i < before.size(); ++i)
      if (before[i].positive() && !after[i].positive()) return true;
    return false;
  }

  std::vector<FreeNode> free_nodes(const std::vector<DistortionTarget>& targets, const Trial& trial) const {
    std::map<int, int> uses;
    for (const DistortionTarget& target : targets)
      for (const int v : target.nodes) ++uses[v];
    std::vector<FreeNode> free;
    for (const auto& [v, n] : uses) {
      if (curve_of_[v] == kStays || n < static_cast<int>(quads_at_[v].size())) continue;
      if (is_vertex_[v] && !trial.moves_vertices) continue;
      FreeNode node{v};
      (curve_of_[v] == kInFace ? node.region : node.curve) =
          curve_of_[v] == kInFace ? mesh_.quad_region[quads_at_[v].front()] : curve_of_[v];
      free.push_back(node);
    }
    return free;
  }

  /// False where nothing was better.
  bool repair(const std::vector<int>& quads, const Trial& trial) {
    std::vector<DistortionTarget> targets;
    for (const int q : quads) {
      // In a cusp, where nothing helps, one would outweigh all others: its nodes stay.
      if (limits_.allowed[q] == 0 && bounds_[q].positive()) continue;
      if (DistortionTarget target;
          make_target(mesh_, static_cast<std::size_t>(q), trial.target_shape, target))
        targets.push_back(std::move(target));
    }
    std::vector<FreeNode> free = free_nodes(targets, trial);
    if (free.empty()) return false;
    const auto places = [&] {
      std::vector<Vec3> at;
      for (const FreeNode& f : free) at.push_back(mesh_.points[f.node]);
      return at;
    };
    std::vector<Vec3> best = places();
    std::vector<JacobianBounds> best_bounds = bounds_of(quads);
    const bool was_positive = std::ranges::all_of(best_bounds, &JacobianBounds::positive);
    bool is_better = false;
    for (int round = 0; round < kDescents; ++round) {
      const std::vector<Vec3> from = places();
      const std::vector<Vec3> step = descend(targets, trial, free);
      bool found = false;
      for (const double part : kPartsOfStep) {
        check_cancelled();
        move(free, from, step, part);
        std::vector<JacobianBounds> now;
        for (const int q : quads) now.push_back(bounds_of_quad(q, kPoorJacobian));
        constexpr double kBetter = 1e-3;
        if (score(now) < score(best_bounds) + kBetter || turns_bad(best_bounds, now)) continue;
        found = is_better = true;
        best = places();
        best_bounds = std::move(now);
        break;
      }
      if (!found && was_positive) break;
      if (!found) move(free, from, step, 1);
    }
    for (std::size_t i = 0; i < free.size(); ++i) mesh_.points[free[i].node] = best[i];
    for (std::size_t i = 0; i < quads.size(); ++i) {
      bounds_[quads[i]] = best_bounds[i];
      if (is_better) is_rough_[quads[i]] = 1;
    }
    return is_better;
  }

  std::vector<JacobianBounds> bounds_of(const std::vector<int>& quads) const {
    std::vector<JacobianBounds> result;
    for (const int q : quads) result.push_back(bounds_[q]);
    return result;
  }
  JacobianBounds bounds_of_quad(int q, double enough) const {
    std::vector<Vec3> places;
    for (const int v : nodes_of_quad(mesh_, static_cast<std::size_t>(q))) places.push_back(mesh_.points[v]);
    return element_bounds(places, mesh_.order, enough);
  }

  /// Where the energy wants the free nodes, from where they are.
  std::vector<Vec3> descend(const std::vector<DistortionTarget>& targets, const Trial& trial,
                            std::vector<FreeNode>& free) const {
    set_axes(targets, free);
    std::vector<double> x(2 * free.size(), 0.0);
    auto* energy = new DistortionEnergy(mesh_.points, targets, free, table_, trial.weights);
    const ceres::GradientProblem problem(energy);  // which owns it
    ceres::GradientProblemSolver::Options options;
    options.max_num_iterations = kDescentSteps;
    options.function_tolerance = kLeastDecrease;
    options.logging_type = ceres::SILENT;
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(options, problem, x.data(), &summary);
    check_cancelled();
    std::vector<Vec3> step;
    for (std::size_t i = 0; i < free.size(); ++i)
      step.push_back(x[2 * i] * free[i].axes[0] + x[2 * i + 1] * free[i].axes[1]);
    return step;
  }

  /// Goes a part of the step, on faces and curves.
  void move(const std::vector<FreeNode>& free, const std::vector<Vec3>& from, const std::vector<Vec3>& step,
            double part) {
    std::vector<double> most(free.size(), 0);  // of nodes on curves
    for (std::size_t i = 0; i < free.size(); ++i) {
      mesh_.points[free[i].node] = from[i];
      if (free[i].curve < 0) continue;
      const auto way = [&](int k) { return norm(mesh_.points[along_[free[i].node][k]] - from[i]); };
      most[i] = kMostOfWay * std::min(way(0), way(1));
    }
    for (std::size_t i = 0; i < free.size(); ++i) {
      Vec3 x = from[i] + part * step[i];
      if (free[i].curve < 0) {
        mesh_.points[free[i].node] = geometry_.on_face(free[i].region, x);
        continue;
      }
      if (const double length = norm(x - from[i]); length > most[i])
        x = from[i] + (most[i] / length) * (x - from[i]);
      const Vec3 place = geometry_.on_curve(free[i].curve, x).value_or(from[i]);
      if (norm(place - from[i]) <= 2 * most[i])
        mesh_.points[free[i].node] = place;  // not on another part of it
    }
  }

  /// Square to the mean normal of the elements around, or along the curve; a step of 1 is their mean side.
  void set_axes(const std::vector<DistortionTarget>& targets, std::vector<FreeNode>& free) const {
    std::map<int, std::pair<Vec3, double>> at;
    for (const DistortionTarget& t : targets)
      for (const int v : t.nodes) {
        auto& [normal, length] = at[v];
        normal = normal + cross(t.e1, t.e2);
        length = std::max(length, 1 / t.inverse[0]);
      }
    for (FreeNode& f : free) {
      const auto& [sum, length] = at.at(f.node);
      if (f.curve >= 0) {
        const Vec3 tangent = mesh_.points[along_[f.node][1]] - mesh_.points[along_[f.node][0]];
        f.axes = {(norm(tangent) > 0 ? length / norm(tangent) : 0) * tangent, Vec3{}};
        continue;
      }
      const Vec3 n = norm(sum) > 0 ? (1 / norm(sum)) * sum : Vec3{0, 0, 1};
      const Vec3 other = std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      const Vec3 e = cross(n, other);
      f.axes[0] = (length / norm(e)) * e;
      f.axes[1] = cross(n, f.axes[0]);
    }
  }

  Mesh& mesh_;
  const ModelGeometry& geometry_;
  const UntanglingLimits& limits_;
  std::vector<JacobianBounds>& bounds_;
  const SampleTable table_;
  std::vector<int> curve_of_;              ///< of each node; kStays, kInFace
  std::vector<std::array<int, 2>> along_;  ///< of each node on a curve those beside it there
  std::vector<char> is_vertex_;
  std::vector<char> is_rough_;  ///< of each quad: its bounds were found no closer than its neighborhood needs
  std::vector<std::vector<int>> quads_at_;  ///< of each node
};

}  // namespace

std::vector<JacobianBounds> jacobian_bounds(const Mesh& mesh) {
  std::vector<JacobianBounds> bounds(mesh.quads.size());
  parallel_ranges(bounds.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3> places;
    for (std::size_t q = begin; q < end; ++q) {
      check_cancelled();
      places.clear();
      for (const int v : nodes_of_quad(mesh, q)) places.push_back(mesh.points[v]);
      bounds[q] = element_bounds(places, mesh.order);
    }
  });
  return bounds;
}

ProvenJacobians proven_jacobians(const Mesh& mesh) { return proven_jacobians(jacobian_bounds(mesh)); }

UntanglingSummary untangle_curved(Mesh& mesh, const ModelGeometry& geometry, const UntanglingLimits& limits,
                                  std::vector<JacobianBounds>& bounds) {
  return CurvedUntangler(mesh, geometry, limits, bounds).run();
}

}  // namespace delquad
