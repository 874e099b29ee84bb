#include "features/curved/untangle_curved.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/cancel.h"
#include "base/parallel.h"
#include "features/curved/distortion_energy.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// How often nodes are projected to their face after a descent.
constexpr int kDescents = 5;
constexpr int kDescentSteps = 60;
/// A descent ends where the energy falls by no more, as a part of it, in a step.
constexpr double kHardlyLess = 1e-3;
/// Of what the energy wants, so much is done, the first that is better: energies know planes only.
constexpr std::array kPartsOfStep{1.0, 0.5, 0.25, 0.1};
/// A node on a curve moves at most by this part of the way to its neighbours there.
constexpr double kMostOfWay = 0.5;

/// What is tried, one after the other, where elements stay poor.
struct Trial {
  int rings;            ///< of quads around poor ones that move with them
  bool moves_vertices;  ///< else only the nodes between them
  Likeness likeness;
  DistortionWeights weights;
};
constexpr std::array kTrials{
    Trial{2, false, Likeness::kStraight, {1, 3}},      Trial{2, true, Likeness::kRightAngled, {0.2, 3}},
    Trial{3, true, Likeness::kRightAngled, {0.05, 4}}, Trial{6, true, Likeness::kRightAngled, {0.1, 4}},
    Trial{3, true, Likeness::kRightAngled, {0.05, 8}}, Trial{2, true, Likeness::kRightAngled, {0.2, 4}}};
/// Those that follow the first are about elements with less.
constexpr double kPoorStill = 1.2 * kLowJacobian;

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
      parallel_for(all.size(), [&](std::size_t i) { moved[i] = mend(all[i], trial); });
      summary.moved_vertices =
          summary.moved_vertices || (trial.moves_vertices && std::ranges::count(moved, 1) > 0);
    }
    // What is better than poor was not looked at closely.
    parallel_ranges(bounds_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q)
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
    parallel_ranges(poor.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) poor[q] = is_poor(q, trial);
    });
    return poor;
  }
  bool is_poor(std::size_t q, const Trial& trial) const {
    const double proven = bounds_[q].proven;
    if (proven <= 0) return true;
    if (proven >= std::min(kPoorJacobian, kPartOfAllowed * limits_.allowed[q])) return false;
    if (trial.moves_vertices) return proven < kPoorStill;
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

  /// What is proven of some quads, all in all: a sum of logarithms, in which more than enough is no more than
  /// enough, and nothing makes up for one that is not positive.
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
  bool mend(const std::vector<int>& quads, const Trial& trial) {
    std::vector<DistortionTarget> targets;
    for (const int q : quads) {
      // In a cusp, where nothing helps, one would outweigh all others: its nodes stay.
      if (limits_.allowed[q] == 0 && bounds_[q].positive()) continue;
      if (DistortionTarget target; make_target(mesh_, static_cast<std::size_t>(q), trial.likeness, target))
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
    options.function_tolerance = kHardlyLess;
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
  std::vector<char>
      is_rough_;  ///< of each quad: its bounds were found no closer than its neighbourhood needs
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
