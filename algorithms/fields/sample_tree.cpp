// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/sampled_fields.h"

#include <CGAL/Bbox_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <numeric>
#include <utility>

#include "base/context.h"

namespace delquad {

namespace {

/// Kernel with rounding, which does not matter since cells are grown by kBeside.
using TreeKernel = CGAL::Simple_cartesian<double>;

/// Least number of halvings of all cells, in the plane and in space. Samples are then half an edge apart, 1 /
/// 128 and 1 / 64 of the box. Narrower features far from others are missed.
constexpr int kLeastLevelsInPlane = 6, kLeastLevelsInSpace = 5;
/// Most halvings of a cell.
constexpr int kMostLevels = 19;
/// Most halvings of a cell with samples that are not good.
constexpr int kMostLevelsAtRim = 11;
/// Limit of samples for functions that vary everywhere.
constexpr std::size_t kMostSamples = 4'000'000;
/// Margins of the box, over the extent of the model. So points near the model lie inside, and corners of
/// cells do not coincide with the periods of formulas.
constexpr double kLowMargin = 0.0173, kHighMargin = 0.0311;
/// Extent of a flat axis, over the longest extent.
constexpr double kFlat = 1e-9;
/// Part of its edges by which a cell is grown to test whether it is beside the surface.
constexpr double kBeside = 0.25;

void set_coordinate(Vec3& x, int axis, double value) { (axis == 0 ? x.x : axis == 1 ? x.y : x.z) = value; }

/// Returns the weight of corner c of a cell at a place; its digits to base 3 are its coordinates in half
/// edges.
double weight(int place, int c, int axes) {
  double w = 1;
  for (int k = 0; k < axes; ++k, place /= 3) {
    const int halves = place % 3;
    if (halves == 1)
      w /= 2;
    else if ((halves == 2) != (((c >> k) & 1) == 1))
      return 0;
  }
  return w;
}

int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

}  // namespace

class SampleTree::Builder {
 public:
  Builder(SampleTree& tree, const SampleDomain& domain, const SampleRules& rules)
      : tree_(tree),
        surface_(tree.axes_ == 3 ? domain.surface : nullptr),
        rules_(rules),
        axes_(tree.axes_),
        n_places_(power(3, axes_)) {
    for (int c = 0; c < 1 << axes_; ++c) {
      for (int place = 0; place < n_places_; ++place) weight_[place][c] = weight(place, c, axes_);
      for (int k = 0; k < axes_; ++k) corner_place_[c] += ((c >> k) & 1) * 2 * power(3, k);
    }
  }

  void run() {
    std::vector<Open> open(1);
    tree_.cells_.emplace_back();
    if (surface_ != nullptr) {
      open[0].triangles.resize(surface_->triangles.size());
      std::iota(open[0].triangles.begin(), open[0].triangles.end(), 0);
      for (const auto& [i, j, k] : surface_->triangles)
        boxes_.push_back(Box<Vec3>::around({surface_->points[i], surface_->points[j], surface_->points[k]}));
    }
    for (int c = 0; c < 1 << axes_; ++c) tree_.cells_[0].corner[c] = sample(corner_of({}, c, kUnits));
    const int least = axes_ < 3 ? kLeastLevelsInPlane : kLeastLevelsInSpace;
    for (int level = 0; !open.empty() && axes_ > 0; ++level) {
      std::vector<int> places;  // samples of each cell, n_places_ at a time
      for (const Open& cell : open)
        for (int place = 0; place < n_places_; ++place)
          places.push_back(sample(place_of(cell, place, level)));
      if (tree_.points_.size() > kMostSamples) {
        tree_.cut_short_ = true;
        tree_.points_.resize(tree_.good_.size());
        return;
      }
      if (level >= least) evaluate();
      std::vector<Open> next;
      for (std::size_t i = 0; i < open.size(); ++i) {
        check_cancelled();
        const std::span<const int> samples = std::span(places).subspan(i * n_places_, n_places_);
        if (level < least || wants_children(samples, level)) halve(open[i], samples, level, next);
      }
      open = std::move(next);
    }
    evaluate();
  }

 private:
  /// Edges of the box, in half edges of the smallest cell.
  static constexpr int kUnits = 1 << (kMostLevels + 1);
  using Place = std::array<int, 3>;

  /// A cell that may be halved.
  struct Open {
    int cell = 0;
    Place low{};
    std::vector<int> triangles;  ///< triangles of the surface that it is beside
  };

  static int edge(int level) { return kUnits >> level; }

  Place corner_of(Place low, int c, int length) const {
    for (int k = 0; k < axes_; ++k) low[k] += ((c >> k) & 1) * length;
    return low;
  }

  Place place_of(const Open& cell, int place, int level) const {
    Place at = cell.low;
    for (int k = 0; k < axes_; ++k, place /= 3) at[k] += place % 3 * edge(level) / 2;
    return at;
  }

  Vec3 point(const Place& place) const {
    Vec3 x = tree_.low_;
    for (int k = 0; k < axes_; ++k)
      set_coordinate(
          x, tree_.axis_[k],
          coordinate(x, tree_.axis_[k]) + tree_.extent_[k] * (static_cast<double>(place[k]) / kUnits));
    return x;
  }

  /// Returns the sample at a place, and adds one if there is none.
  int sample(const Place& place) {
    std::uint64_t key = 0;
    for (int k = 0; k < axes_; ++k) key = key << 21 | static_cast<std::uint64_t>(place[k]);
    const auto [found, is_new] = index_.try_emplace(key, static_cast<int>(tree_.points_.size()));
    if (is_new) tree_.points_.push_back(point(place));
    return found->second;
  }

  /// Evaluates the function at new samples.
  void evaluate() {
    const std::size_t first = tree_.good_.size(), n = tree_.points_.size(), width = tree_.width_;
    if (first == n) return;
    tree_.values_.resize(n * width, std::numeric_limits<double>::quiet_NaN());
    rules_.function(std::span(tree_.points_).subspan(first), std::span(tree_.values_).subspan(first * width));
    for (std::size_t i = first; i < n; ++i) tree_.good_.push_back(rules_.is_good(value(static_cast<int>(i))));
  }

  const double* value(int sample) const {
    return &tree_.values_[static_cast<std::size_t>(sample) * tree_.width_];
  }

  double longest_edge(int level) const {
    return *std::max_element(tree_.extent_.begin(), tree_.extent_.begin() + axes_) / (1 << level);
  }

  bool wants_children(std::span<const int> samples, int level) const {
    if (level >= kMostLevels) return false;
    const auto n_good = std::ranges::count_if(samples, [&](int s) { return tree_.good_[s] != 0; });
    if (n_good == 0) return false;
    if (n_good < std::ssize(samples) && level >= kMostLevelsAtRim) return false;
    double short_edge = std::numeric_limits<double>::infinity();
    for (const int s : samples)
      if (tree_.good_[s]) short_edge = std::min(short_edge, rules_.short_edge(tree_.points_[s], value(s)));
    if (longest_edge(level) <= short_edge) return false;
    return n_good < std::ssize(samples) || is_missed(samples);
  }

  /// Returns whether interpolation between the corners misses a sample by more than its tolerance.
  bool is_missed(std::span<const int> samples) const {
    for (int place = 0; place < n_places_; ++place) {
      const double* wanted = value(samples[place]);
      const double tolerance = rules_.tolerance(wanted);
      for (int j = 0; j < tree_.width_; ++j) {
        double sum = 0;
        for (int c = 0; c < 1 << axes_; ++c) sum += weight_[place][c] * value(samples[corner_place_[c]])[j];
        if (std::abs(sum - wanted[j]) > tolerance) return true;
      }
    }
    return false;
  }

  void halve(const Open& parent, std::span<const int> samples, int level, std::vector<Open>& next) {
    const int first = static_cast<int>(tree_.cells_.size());
    tree_.cells_[parent.cell].children = first;
    for (int child = 0; child < 1 << axes_; ++child) {
      Cell cell;
      for (int c = 0; c < 1 << axes_; ++c) {
        int place = 0;
        for (int k = 0; k < axes_; ++k) place += (((child >> k) & 1) + ((c >> k) & 1)) * power(3, k);
        cell.corner[c] = samples[place];
      }
      tree_.cells_.push_back(cell);
      Open open{first + child, corner_of(parent.low, child, edge(level + 1)), {}};
      if (surface_ == nullptr || is_beside(parent, open, level + 1)) next.push_back(std::move(open));
    }
  }

  /// Keeps the parent's triangles that the cell is beside. Returns false if there are none.
  bool is_beside(const Open& parent, Open& cell, int level) const {
    const Vec3 a = point(cell.low), b = point(corner_of(cell.low, (1 << axes_) - 1, edge(level)));
    const Vec3 grow = kBeside * (b - a);
    const Vec3 low = a - grow, high = b + grow;
    const CGAL::Bbox_3 box(low.x, low.y, low.z, high.x, high.y, high.z);
    const auto corner = [&](int v) {
      const Vec3& p = surface_->points[v];
      return TreeKernel::Point_3(p.x, p.y, p.z);
    };
    for (const int t : parent.triangles) {
      if (!boxes_[t].overlaps({low, high})) continue;
      const auto& [i, j, k] = surface_->triangles[t];
      if (CGAL::do_intersect(TreeKernel::Triangle_3(corner(i), corner(j), corner(k)), box))
        cell.triangles.push_back(t);
    }
    return !cell.triangles.empty();
  }

  SampleTree& tree_;
  const Mesh* surface_;
  const SampleRules& rules_;
  int axes_, n_places_;
  /// Weights of a cell's corners at its 3^axes_ places, and the places of the corners.
  std::array<std::array<double, kMostCorners>, 27> weight_{};
  std::array<int, kMostCorners> corner_place_{};
  std::vector<Box<Vec3>> boxes_;  ///< boxes of the surface's triangles
  std::pmr::monotonic_buffer_resource memory_;
  std::pmr::unordered_map<std::uint64_t, int> index_{&memory_};  ///< samples by their place
};

SampleTree::SampleTree(const SampleDomain& domain, const SampleRules& rules)
    : box_(domain.box), width_(rules.width) {
  const Vec3 size = domain.box.high - domain.box.low;
  const double longest = std::max({size.x, size.y, size.z});
  low_ = domain.box.low;
  for (int k = 0; k < 3; ++k) {
    const double extent = coordinate(size, k);
    if (!(extent > kFlat * longest)) continue;
    set_coordinate(low_, k, coordinate(low_, k) - kLowMargin * extent);
    axis_[axes_] = k;
    extent_[axes_++] = (1 + kLowMargin + kHighMargin) * extent;
  }
  Builder(*this, domain, rules).run();
}

SampleTree::Sample SampleTree::bad_corner(const Cell& cell) const {
  int found = -1;
  for (int c = 0; c < 1 << axes_; ++c) {
    const int s = cell.corner[c];
    if (good_[s]) continue;
    if (found < 0) found = s;
    if (box_.overlaps({points_[s], points_[s]})) return {points_[s], values_[std::size_t(s) * width_]};
  }
  return {points_[found], values_[std::size_t(found) * width_]};
}

std::optional<SampleTree::Sample> SampleTree::interpolate(const Vec3& x, std::span<double> value) const {
  double part[3] = {0, 0, 0};
  for (int k = 0; k < axes_; ++k)
    part[k] = std::clamp((coordinate(x, axis_[k]) - coordinate(low_, axis_[k])) / extent_[k], 0.0, 1.0);
  const Cell* cell = &cells_[0];
  while (cell->children >= 0) {
    int child = 0;
    for (int k = 0; k < axes_; ++k) {
      const bool upper = part[k] >= 0.5;
      part[k] = 2 * part[k] - upper;
      child |= upper << k;
    }
    cell = &cells_[cell->children + child];
  }
  std::ranges::fill(value, 0);
  double total = 0;
  for (int c = 0; c < 1 << axes_; ++c) {
    if (!good_[cell->corner[c]]) continue;
    double w = 1;
    for (int k = 0; k < axes_; ++k) w *= ((c >> k) & 1) ? part[k] : 1 - part[k];
    total += w;
    for (int j = 0; j < width_; ++j)
      value[j] += w * values_[static_cast<std::size_t>(cell->corner[c]) * width_ + j];
  }
  if (!(total > 0)) return bad_corner(*cell);
  for (double& v : value) v /= total;
  return std::nullopt;
}

}  // namespace delquad
