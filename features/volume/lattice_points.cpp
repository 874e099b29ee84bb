// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/hexahedra_steps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <unordered_map>

#include "base/sort_unique.h"

namespace delquad {
namespace {

/// Least distance of a new point to others, in sizes. With 0.65 the share of hexahedra falls by 3 points.
constexpr double kNear = 0.55;
/// Greatest distance of a neighbor from its place, in sizes: of the best one, and of all that may serve.
constexpr double kSlot = 0.5, kEdge = 0.75;
/// Least distance of a new point to the skin, in its least size, and the same after moves.
constexpr double kNearSkin = 0.5, kCrowdsSkin = 0.35;
/// Least distance from the skin of the middle of an edge inside between vertices of the skin, in its size.
constexpr double kThin = 0.15;
/// Distance below which one of two points goes, in sizes.
constexpr double kCrowded = 0.5;
constexpr int kRounds = 5, kMoves = 8;
/// Sweeps that make frames harmonic, each time.
constexpr int kSweeps = 20;

/// Half of the twelve neighbors in a packing of tetrahedra, along the axes of a frame; the others are
/// opposite.
constexpr double kHeight = std::numbers::sqrt2 / 2;
constexpr std::array<Vec3, 6> kTetrahedra = {{{1, 0, 0},
                                              {0, 1, 0},
                                              {0.5, 0.5, kHeight},
                                              {0.5, -0.5, kHeight},
                                              {-0.5, 0.5, kHeight},
                                              {-0.5, -0.5, kHeight}}};
/// The same for cubes.
constexpr std::array<Vec3, 3> kCubes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr int kMostNeighbours = 12;
/// Slots of a point that has no neighbors.
constexpr std::array<int, kMostNeighbours> kNone = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

/// Directions and lengths of a packing in frames.
class Neighbours {
 public:
  explicit Neighbours(Packing packing) : are_cubes_(packing == Packing::kCubes) {
    if (are_cubes_) half_ = kCubes;
  }

  int number() const { return 2 * half(); }
  /// Returns the most points that may serve along a direction.
  std::size_t most_beside() const { return are_cubes_ ? 3 : 1; }
  Vec3 step(const Frame& f, int direction) const {
    const Vec3& c = half_[direction % half()];
    const Vec3 v =
        (c.x * f.sizes[0]) * f.axes[0] + (c.y * f.sizes[1]) * f.axes[1] + (c.z * f.sizes[2]) * f.axes[2];
    return direction < half() ? v : -1.0 * v;
  }
  /// Returns the mean of the ways by two frames.
  Vec3 step(const Frame& f, const Frame& g, int direction) const {
    return 0.5 * (step(f, direction) + step(g, direction));
  }
  int nearest(const Frame& f, const Vec3& v) const {
    const Vec3 u = in_sizes(are_cubes_ ? Frame{f.axes, {1, 1, 1}} : f, v);
    int best = 0;
    for (int d = 1; d < half(); ++d)
      if (std::abs(dot(u, half_[d])) > std::abs(dot(u, half_[best]))) best = d;
    return dot(u, half_[best]) > 0 ? best : best + half();
  }
  double length(const Frame& f, const Vec3& v) const {
    const Vec3 u = in_sizes(f, v);
    return are_cubes_ ? std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z)}) : norm(u);
  }

 private:
  int half() const { return static_cast<int>(half_.size()); }
  static Vec3 in_sizes(const Frame& f, const Vec3& v) {
    return {dot(v, f.axes[0]) / f.sizes[0], dot(v, f.axes[1]) / f.sizes[1], dot(v, f.axes[2]) / f.sizes[2]};
  }

  bool are_cubes_;
  std::span<const Vec3> half_ = kTetrahedra;
};

/// Finds points near a place, in cells of several lengths, so that each search visits few cells.
class PointGrid {
 public:
  /// `usual_size` is a length that most searches have.
  explicit PointGrid(double usual_size) : lowest_(std::ilogb(usual_size) - 3) {}

  void add(int point, const Vec3& x) {
    for (int level = 0; level < kLevels; ++level) {
      const double cell = std::ldexp(1, lowest_ + level);
      cells_[level][key(place(x.x, cell), place(x.y, cell), place(x.z, cell))].push_back(point);
    }
  }
  /// Calls visit(point) for all points within a distance of x, and others.
  template <class Visit>
  void near(const Vec3& x, double distance, Visit visit) const {
    const int level = std::clamp(std::ilogb(distance) + 1 - lowest_, 0, kLevels - 1);
    const double cell = std::ldexp(1, lowest_ + level);
    const auto i1 = place(x.x + distance, cell), j1 = place(x.y + distance, cell),
               k1 = place(x.z + distance, cell);
    for (auto i = place(x.x - distance, cell); i <= i1; ++i)
      for (auto j = place(x.y - distance, cell); j <= j1; ++j)
        for (auto k = place(x.z - distance, cell); k <= k1; ++k)
          if (const auto found = cells_[level].find(key(i, j, k)); found != cells_[level].end())
            for (const int point : found->second) visit(point);
  }

 private:
  static constexpr int kLevels = 7;

  static std::int64_t place(double x, double cell) { return static_cast<std::int64_t>(std::floor(x / cell)); }
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(i) & kMask) << 42 | (static_cast<std::uint64_t>(j) & kMask) << 21 |
           (static_cast<std::uint64_t>(k) & kMask);
  }

  int lowest_;
  std::array<std::unordered_map<std::uint64_t, std::vector<int>>, kLevels> cells_;
};

double least(const Frame& f) { return std::min({f.sizes[0], f.sizes[1], f.sizes[2]}); }
/// Returns a radius around all places within a distance, which is in sizes.
double reach_of(const Frame& f, double distance) {
  return distance * norm(Vec3{f.sizes[0], f.sizes[1], f.sizes[2]});
}

class PointFront {
 public:
  PointFront(const Skin& skin, Packing packing)
      : neighbours_(packing),
        skin_(skin),
        at_skin_(skin.body()),
        n_skin_(static_cast<int>(skin.body().points.size())),
        grid_(at_skin_.usual_size) {
    for (int v = 0; v < n_skin_; ++v) add(skin.body().points[v], at_skin_.values[v], at_skin_.frames[v].axes);
    find_slots();
    diffuse();
  }

  Lattice fill() {
    for (int round = 0;; ++round) {
      advance();
      find_slots();
      if (round == kRounds) break;
      diffuse();
      for (int move = 0; move < kMoves; ++move) relax();
      diffuse();
      thin();
      find_slots();
    }
    Lattice lattice{points_, {}, {}};
    lattice.best.resize(points_.size()), lattice.beside.resize(points_.size());
    const auto join = [](auto& lists, int p, int q) { lists[p].push_back(q), lists[q].push_back(p); };
    for (int p = 0; p < size(); ++p)
      for (int d = 0; d < neighbours_.number(); ++d) {
        if (slots_[p][d] >= 0) join(lattice.best, p, slots_[p][d]);
        for (const int q : candidates(p, d)) join(lattice.beside, p, q);
      }
    for_each_side(skin_.body(), [&](int v, int w) { lattice.best[v].push_back(w); });
    for (std::size_t p = 0; p < points_.size(); ++p) {
      sort_unique(lattice.best[p]);
      lattice.beside[p].insert(lattice.beside[p].end(), lattice.best[p].begin(), lattice.best[p].end());
      sort_unique(lattice.beside[p]);
    }
    return lattice;
  }

 private:
  int size() const { return static_cast<int>(points_.size()); }

  void add(const Vec3& x, const FrameValues& values, const Axes& guess) {
    grid_.add(size(), x);
    points_.push_back(x);
    values_.push_back(values);
    frames_.push_back(at_skin_.frame_of(values, guess));
    slots_.push_back(kNone);
  }

  /// Returns the mean of the values at points near x, with weights of inverse squares of distances.
  FrameValues values_near(const Vec3& x, const Frame& f) const {
    FrameValues sum = FrameValues::Zero();
    double total = 0;
    const double reach = reach_of(f, 1);
    grid_.near(x, reach, [&](int q) {
      const Vec3 e = points_[q] - x;
      const double d2 = dot(e, e);
      if (d2 > reach * reach) return;
      const double weight = 1 / std::max(d2, 1e-6 * reach * reach);
      sum += weight * values_[q], total += weight;
    });
    return sum / total;
  }

  /// Makes frames and sizes inside harmonic.
  void diffuse() {
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (int p = 0; p < size(); ++p) {
        FrameValues sum = FrameValues::Zero();
        int n = 0;
        for (const int q : slots_[p])
          if (q >= 0) sum += values_[q], ++n;
        if (n == 0) continue;
        sum /= n;
        if (p >= n_skin_)
          values_[p] = sum;
        else
          values_[p].col(6) = sum.col(6), at_skin_.keep_known_sizes(values_[p], p);
      }
    for (int p = 0; p < size(); ++p) {
      frames_[p] = at_skin_.frame_of(values_[p], frames_[p].axes);
      set_axes(values_[p], frames_[p].axes);
    }
  }

  /// Returns the point nearest to x in the norm of `frame`, without `own`, and its distance.
  std::pair<int, double> nearest(const Vec3& x, const Frame& frame, double limit, int own) const {
    std::pair<int, double> best = {-1, limit};
    grid_.near(x, reach_of(frame, limit), [&](int q) {
      if (q == own) return;
      const double d = neighbours_.length(frame, points_[q] - x);
      if (d < best.second || (d == best.second && best.first > q)) best = {q, d};
    });
    return best;
  }

  /// Links p to q along a direction of p, and q to p if its direction is free.
  void link(int p, int direction, int q) {
    slots_[p][direction] = q;
    const int back = neighbours_.nearest(frames_[q], points_[p] - points_[q]);
    if (slots_[q][back] < 0) slots_[q][back] = p;
  }

  void advance() {
    for (int p = 0; p < size(); ++p)
      for (int d = 0; d < neighbours_.number(); ++d) {
        if (slots_[p][d] >= 0) continue;
        const Frame& own = frames_[p];
        Vec3 x = points_[p] + neighbours_.step(own, d);
        const FrameValues values = values_near(x, own);
        const Frame there = at_skin_.frame_of(values, own.axes);
        x = points_[p] + neighbours_.step(own, there, d);
        const auto [q, distance] = nearest(x, there, kNear, p);
        if (q >= 0) {
          link(p, d, q);
          continue;
        }
        const double gap = kNearSkin * least(there);
        if (skin_.distance(x, gap) < gap || !skin_.contains(x)) continue;
        add(x, values, there.axes);
        link(p, d, size() - 1);
      }
  }

  /// Sets the slots anew by places; on the skin along sides of quads first.
  void find_slots() {
    for (auto& slots : slots_) slots = kNone;
    for_each_side(skin_.body(), [&](int v, int w) {
      const Vec3 e = points_[w] - points_[v];
      int& slot = slots_[v][neighbours_.nearest(frames_[v], e)];
      if (slot < 0 || dot(points_[slot] - points_[v], e) < 0) slot = w;
    });
    for (int p = 0; p < size(); ++p)
      for (int d = 0; d < neighbours_.number(); ++d) {
        if (slots_[p][d] >= 0) continue;
        const Frame& f = frames_[p];
        slots_[p][d] = nearest(points_[p] + neighbours_.step(f, d), f, kSlot, p).first;
      }
  }

  /// Returns the points nearest to the place of a neighbor, nearest first.
  std::vector<int> candidates(int p, int direction) const {
    const Frame& f = frames_[p];
    const Vec3 x = points_[p] + neighbours_.step(f, direction);
    std::vector<std::pair<double, int>> near;
    grid_.near(x, reach_of(f, kEdge), [&](int q) {
      const double distance = neighbours_.length(f, points_[q] - x);
      if (q == p || distance >= kEdge) return;
      if (p < n_skin_ && q < n_skin_) {
        const double gap = kThin * least(f);
        if (skin_.distance(0.5 * (points_[p] + points_[q]), gap) <= gap) return;
      }
      near.emplace_back(distance, q);
    });
    std::ranges::sort(near);
    std::vector<int> found;
    for (std::size_t i = 0; i < near.size() && i < neighbours_.most_beside(); ++i)
      found.push_back(near[i].second);
    return found;
  }

  void relax() {
    std::vector<Vec3> sum(points_.size(), Vec3{0, 0, 0});
    std::vector<double> count(points_.size(), 0);
    for (int p = 0; p < size(); ++p)
      for (int d = 0; d < neighbours_.number(); ++d) {
        const int q = slots_[p][d];
        if (q < 0) continue;
        const Frame &f = frames_[p], &g = frames_[q];
        const int e = neighbours_.nearest(g, points_[p] - points_[q]);
        const Vec3 step = 0.5 * (neighbours_.step(f, d) - neighbours_.step(g, e));
        sum[p] = sum[p] + points_[q] - step;
        sum[q] = sum[q] + points_[p] + step;
        count[p] += 1, count[q] += 1;
      }
    for (int p = n_skin_; p < size(); ++p) {
      if (count[p] > 0) points_[p] = 0.2 * points_[p] + (0.8 / count[p]) * sum[p];
    }
  }

  int links(int p) const {
    return static_cast<int>(std::ranges::count_if(slots_[p], [](int q) { return q >= 0; }));
  }

  void rebuild_grid() {
    grid_ = PointGrid(at_skin_.usual_size);
    for (int p = 0; p < size(); ++p) grid_.add(p, points_[p]);
  }

  /// Removes points near the skin or near others that have more neighbors.
  void thin() {
    rebuild_grid();
    std::vector<char> goes(points_.size(), 0);
    for (int p = n_skin_; p < size(); ++p) {
      const double gap = kCrowdsSkin * least(frames_[p]);
      goes[p] = skin_.distance(points_[p], gap) < gap || !skin_.contains(points_[p]);
    }
    for (int p = n_skin_; p < size(); ++p) {
      if (goes[p]) continue;
      const Frame& f = frames_[p];
      grid_.near(points_[p], reach_of(f, kCrowded), [&](int q) {
        if (q == p || goes[q] || neighbours_.length(f, points_[q] - points_[p]) > kCrowded) return;
        if (q < n_skin_ || std::pair(links(p), q) <= std::pair(links(q), p)) goes[p] = 1;
      });
    }
    int kept = 0;
    for (int p = 0; p < size(); ++p) {
      if (goes[p]) continue;
      points_[kept] = points_[p], frames_[kept] = frames_[p], values_[kept++] = values_[p];
    }
    points_.resize(kept), frames_.resize(kept), values_.resize(kept), slots_.resize(kept);
    rebuild_grid();
  }

  const Neighbours neighbours_;
  const Skin& skin_;
  const SkinFrames at_skin_;
  const int n_skin_;
  std::vector<Vec3> points_;
  std::vector<Frame> frames_;
  std::vector<FrameValues> values_;
  std::vector<std::array<int, kMostNeighbours>> slots_;
  PointGrid grid_;
};

}  // namespace

Lattice fill_with_points(const Skin& skin, Packing packing) { return PointFront(skin, packing).fill(); }

}  // namespace delquad
