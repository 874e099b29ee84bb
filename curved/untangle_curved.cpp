#include "curved/untangle_curved.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "base/cancel.h"
#include "base/parallel.h"
#include "mesh/element_nodes.h"

namespace delquad {

namespace {

/// Rings of quads around poor ones that move with them.
constexpr int kRingsAround = 2;
/// How often nodes are projected to their face after a descent.
constexpr int kDescents = 4;
constexpr int kDescentSteps = 60;
/// det T below this counts as hardly positive.
constexpr double kSoftness = 0.05;
/// Exponent of the distortion: the worst count most.
constexpr int kDistortionPower = 3;
/// Places at which an element's distortion is measured, along each side.
constexpr int kSamples = 7;

/// Shape functions' derivatives at the samples, for one order.
struct SampleTable {
  std::vector<std::vector<double>> du, dv;  ///< by sample and node
};

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

/// An element of a neighbourhood: its nodes, and the parallelogram that it should be like.
struct Target {
  std::vector<int> nodes;
  Vec3 e1, e2;                      ///< of its plane
  std::array<double, 4> inverse{};  ///< of the parallelogram's sides in that plane, by rows
};

/// None where the straight quad is flat.
bool make_target(const Mesh& mesh, std::size_t quad, Target& target) {
  target.nodes = nodes_of_quad(mesh, quad);
  const auto& v = mesh.quads[quad];
  const auto at = [&](int k) { return mesh.points[v[k]]; };
  const Vec3 a = 0.5 * (at(1) - at(0) + at(2) - at(3)), b = 0.5 * (at(3) - at(0) + at(2) - at(1));
  const Vec3 n = cross(a, b);
  if (!(norm(n) > 1e-9 * norm(a) * norm(b))) return false;
  target.e1 = (1 / norm(a)) * a;
  target.e2 = cross((1 / norm(n)) * n, target.e1);
  const double x = norm(a), y = dot(b, target.e1), z = dot(b, target.e2);
  target.inverse = {1 / x, -y / (x * z), 0, 1 / z};
  return true;
}

struct FreeNode {
  int node, region;
  std::array<Vec3, 2> axes;
};

class DistortionEnergy final : public ceres::FirstOrderFunction {
 public:
  DistortionEnergy(const std::vector<Vec3>& points, const std::vector<Target>& targets,
                   const std::vector<FreeNode>& free, const SampleTable& table)
      : points_(points), targets_(targets), free_(free), table_(table) {
    for (std::size_t i = 0; i < free.size(); ++i) index_[free[i].node] = static_cast<int>(i);
  }
  int NumParameters() const override { return 2 * static_cast<int>(free_.size()); }

  Vec3 place(int node, const double* x) const {
    const auto found = index_.find(node);
    if (found == index_.end()) return points_[node];
    const FreeNode& f = free_[found->second];
    return points_[node] + x[2 * found->second] * f.axes[0] + x[2 * found->second + 1] * f.axes[1];
  }

  bool Evaluate(const double* x, double* cost, double* gradient) const override {
    if (is_cancelled()) return false;
    *cost = 0;
    if (gradient != nullptr) std::fill_n(gradient, NumParameters(), 0.0);
    for (const Target& target : targets_) add(target, x, *cost, gradient);
    return std::isfinite(*cost);
  }

 private:
  void add(const Target& t, const double* x, double& cost, double* gradient) const {
    const std::size_t n = t.nodes.size();
    std::vector<Vec2> flat(n), slope(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 p = place(t.nodes[i], x);
      flat[i] = {dot(p, t.e1), dot(p, t.e2)};
    }
    const auto& [m00, m01, m10, m11] = t.inverse;
    for (std::size_t s = 0; s < table_.du.size(); ++s) {
      Vec2 xu, xv;
      for (std::size_t i = 0; i < n; ++i) {
        xu += table_.du[s][i] * flat[i];
        xv += table_.dv[s][i] * flat[i];
      }
      // Columns of T: A times the inverse of the target.
      const Vec2 p = m00 * xu + m10 * xv, q = m01 * xu + m11 * xv;
      const double det = cross(p, q), root = std::sqrt(det * det + kSoftness * kSoftness);
      const double soft = (det + root) / 2, square = dot(p, p) + dot(q, q);
      const double distortion = square / (2 * soft);
      const double power = std::pow(distortion, kDistortionPower - 1);
      cost += power * distortion;
      if (gradient == nullptr) continue;
      const double outer = kDistortionPower * power;
      const double by_det = -distortion / soft * (1 + det / root) / 2;
      const Vec2 by_p = outer * ((1 / soft) * p + by_det * Vec2{q.y, -q.x});
      const Vec2 by_q = outer * ((1 / soft) * q + by_det * Vec2{-p.y, p.x});
      const Vec2 by_u = m00 * by_p + m01 * by_q, by_v = m10 * by_p + m11 * by_q;
      for (std::size_t i = 0; i < n; ++i) slope[i] += table_.du[s][i] * by_u + table_.dv[s][i] * by_v;
    }
    if (gradient == nullptr) return;
    for (std::size_t i = 0; i < n; ++i) {
      const auto found = index_.find(t.nodes[i]);
      if (found == index_.end()) continue;
      const Vec3 in_space = slope[i].x * t.e1 + slope[i].y * t.e2;
      for (const int k : {0, 1})
        gradient[2 * found->second + k] += dot(in_space, free_[found->second].axes[k]);
    }
  }

  const std::vector<Vec3>& points_;
  const std::vector<Target>& targets_;
  const std::vector<FreeNode>& free_;
  const SampleTable& table_;
  std::map<int, int> index_;
};

/// Poor quads that have common quads around them, with these.
struct Neighbourhood {
  std::vector<int> quads;
};

class CurvedUntangler {
 public:
  CurvedUntangler(Mesh& mesh, const ModelGeometry& geometry, std::vector<JacobianBounds>& bounds)
      : mesh_(mesh), geometry_(geometry), bounds_(bounds), table_(make_sample_table(mesh.order)) {}

  UntanglingSummary run() {
    UntanglingSummary summary;
    find_fixed();
    const std::vector<char> poor = find_poor();
    summary.poor = static_cast<int>(std::ranges::count(poor, 1));
    if (summary.poor == 0) return summary;
    const std::vector<JacobianBounds> before = bounds_;
    const std::vector<Neighbourhood> all = neighbourhoods(poor);
    parallel_for(all.size(), [&](std::size_t i) { mend(all[i]); });
    for (std::size_t q = 0; q < poor.size(); ++q)
      summary.improved += poor[q] && bounds_[q].proven > before[q].proven;
    return summary;
  }

 private:
  void find_fixed() {
    fixed_.assign(mesh_.points.size(), 0);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      for (const int v : nodes_of_line(mesh_, l)) fixed_[v] = 1;
    for (const NamedPoint& named : mesh_.named_points) fixed_[named.point] = 1;
    quads_at_.resize(mesh_.points.size());
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
      for (const int v : nodes_of_quad(mesh_, q)) quads_at_[v].push_back(static_cast<int>(q));
  }

  std::vector<char> find_poor() const {
    std::vector<char> poor(mesh_.quads.size(), 0);
    parallel_ranges(poor.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) {
        if (bounds_[q].proven >= kPoorJacobian) continue;
        std::vector<Vec3> straight;
        for (const int corner : {0, 1, 3, 2}) straight.push_back(mesh_.points[mesh_.quads[q][corner]]);
        constexpr double kAsGood = 0.7;
        poor[q] = bounds_[q].proven <= 0 || bounds_[q].proven < kAsGood * jacobian_bounds(straight, 1).found;
      }
    });
    return poor;
  }

  /// Without common free nodes.
  std::vector<Neighbourhood> neighbourhoods(const std::vector<char>& poor) const {
    std::vector<char> near = poor;
    for (int ring = 0; ring < kRingsAround; ++ring) {
      const std::vector<char> inner = near;
      for (std::size_t q = 0; q < inner.size(); ++q)
        if (inner[q])
          for (const int v : mesh_.quads[q])
            for (const int other : quads_at_[v]) near[other] = 1;
    }
    std::vector<Neighbourhood> all;
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
      all.push_back({std::move(quads)});
    }
    return all;
  }

  double least_proven(const std::vector<int>& quads) const {
    double least = 1;
    for (const int q : quads) least = std::min(least, bounds_[q].proven);
    return least;
  }

  void mend(const Neighbourhood& around) {
    std::vector<Target> targets;
    std::map<int, int> uses;
    for (const int q : around.quads) {
      Target target;
      if (!make_target(mesh_, static_cast<std::size_t>(q), target)) continue;
      for (const int v : target.nodes) ++uses[v];
      targets.push_back(std::move(target));
    }
    std::vector<FreeNode> free;
    for (const auto& [v, n] : uses)
      if (!fixed_[v] && n == static_cast<int>(quads_at_[v].size()))
        free.push_back({v, mesh_.quad_region[quads_at_[v].front()], {}});
    if (free.empty()) return;
    std::vector<Vec3> before;
    for (const FreeNode& f : free) before.push_back(mesh_.points[f.node]);
    const std::vector<JacobianBounds> bounds_before = bounds_of(around.quads);
    const double least_before = least_proven(around.quads);
    for (int round = 0; round < kDescents; ++round) {
      check_cancelled();
      if (!descend(targets, free)) break;
    }
    for (const int q : around.quads) bounds_[q] = bounds_of_quad(q);
    if (least_proven(around.quads) > least_before) return;
    for (std::size_t i = 0; i < free.size(); ++i) mesh_.points[free[i].node] = before[i];
    for (std::size_t i = 0; i < around.quads.size(); ++i) bounds_[around.quads[i]] = bounds_before[i];
  }

  std::vector<JacobianBounds> bounds_of(const std::vector<int>& quads) const {
    std::vector<JacobianBounds> result;
    for (const int q : quads) result.push_back(bounds_[q]);
    return result;
  }
  JacobianBounds bounds_of_quad(int q) const {
    std::vector<Vec3> places;
    for (const int v : nodes_of_quad(mesh_, static_cast<std::size_t>(q))) places.push_back(mesh_.points[v]);
    return element_bounds(places, mesh_.order);
  }

  /// False where nothing moved.
  bool descend(const std::vector<Target>& targets, std::vector<FreeNode>& free) {
    set_axes(targets, free);
    std::vector<double> x(2 * free.size(), 0.0);
    auto* energy = new DistortionEnergy(mesh_.points, targets, free, table_);
    const ceres::GradientProblem problem(energy);  // which owns it
    ceres::GradientProblemSolver::Options options;
    options.max_num_iterations = kDescentSteps;
    options.logging_type = ceres::SILENT;
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(options, problem, x.data(), &summary);
    check_cancelled();
    bool moved = false;
    std::vector<Vec3> places;
    for (const FreeNode& f : free) places.push_back(energy->place(f.node, x.data()));
    for (std::size_t i = 0; i < free.size(); ++i) {
      const Vec3 place = geometry_.on_face(free[i].region, places[i]);
      moved = moved || norm(place - mesh_.points[free[i].node]) > 1e-6 * norm(free[i].axes[0]);
      mesh_.points[free[i].node] = place;
    }
    return moved;
  }

  /// Square to the mean normal of the elements around; a step of 1 is their mean side.
  void set_axes(const std::vector<Target>& targets, std::vector<FreeNode>& free) const {
    std::map<int, std::pair<Vec3, double>> at;
    for (const Target& t : targets)
      for (const int v : t.nodes) {
        auto& [normal, length] = at[v];
        normal = normal + cross(t.e1, t.e2);
        length = std::max(length, 1 / t.inverse[0]);
      }
    for (FreeNode& f : free) {
      const auto& [sum, length] = at.at(f.node);
      const Vec3 n = norm(sum) > 0 ? (1 / norm(sum)) * sum : Vec3{0, 0, 1};
      const Vec3 other = std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      const Vec3 e = cross(n, other);
      f.axes[0] = (length / norm(e)) * e;
      f.axes[1] = cross(n, f.axes[0]);
    }
  }

  Mesh& mesh_;
  const ModelGeometry& geometry_;
  std::vector<JacobianBounds>& bounds_;
  const SampleTable table_;
  std::vector<char> fixed_;
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

UntanglingSummary untangle_curved(Mesh& mesh, const ModelGeometry& geometry,
                                  std::vector<JacobianBounds>& bounds) {
  return CurvedUntangler(mesh, geometry, bounds).run();
}

}  // namespace delquad
