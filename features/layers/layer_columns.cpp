// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/layers/layer_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "delquad/error.h"
#include "delquad/model.h"

namespace delquad {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Ends of layers lie on walls up to this angle; beyond it they stand free.
constexpr double kWidestWall = 150 * kDegree;
/// The angle of a quad at the corner of a fan, and its least value. With it edges of the front are at most
/// kLongFront times as long as edges of the curve.
constexpr double kFanQuad = 100 * kDegree, kThinFanQuad = 45 * kDegree;
constexpr double kLongFront = 1.5;
/// The diagonal of such a quad, by its height; the diagonal of a square.
constexpr double kLongestDiagonal = std::numbers::sqrt2;
/// Columns beside a corner lean towards its bisector, or wall, up to so many times as far as that reaches.
constexpr double kLeanReach = 3;

Vec2 unit(Vec2 v) { return (1 / norm(v)) * v; }

Vec2 turned(Vec2 v, double angle) { return std::cos(angle) * v + std::sin(angle) * perp(v); }

/// Scaled so that nodes get as far from both edges as they are high.
Vec2 bisector(const ChainCorner& corner) {
  return 1 / std::sin(corner.angle / 2) * turned(corner.out, corner.angle / 2);
}

}  // namespace

LayerColumns::LayerColumns(const PlanarDomain& domain, int patch, const LayerChains& found,
                           std::span<const LayerSpec> specs, const std::vector<std::vector<double>>& heights)
    : domain_(domain), index_(patch), patch_(domain.patches[patch]), found_(found), heights_(heights) {
  for (int c = 0; c < n_chains(); ++c) {
    const int n = chain(c).n_points();
    scales.emplace_back(n, 1.0);
    corners_.emplace_back(n);
    slants_.push_back({1, 1});
    joined_.emplace_back();
    stretches_.emplace_back(n, 1.0);
    for (int k = 0; k < n; ++k) {
      set_corner(c, k, specs);
      stretches_[c][k] = stretch_at(c, k);
    }
  }
  columns_.resize(n_chains());
}

std::array<double, 2> LayerColumns::edges_at(int c, int k) const {
  const LayerChain& chain = this->chain(c);
  const int n = chain.n_points();
  const auto length = [&](int from) { return distance(c, from, (from + 1) % n); };
  const int before = k > 0 ? k - 1 : chain.is_closed ? n - 1 : 0;
  return {length(before), length(k + 1 < n || chain.is_closed ? k : n - 2)};
}

/// The mean beside both edges.
double LayerColumns::stretch_at(int c, int k) const {
  if (domain_.in_space == nullptr) return 1;
  const ChainCorner& corner = corners_[c][k];
  const auto along = [&](Vec2 edge) { return domain_.in_space->stretch(index_, foot(c, k), perp(edge)); };
  return (along(corner.in) + along(corner.out)) / 2;
}

int LayerColumns::layers_at(int c, int k) const {
  const auto [a, b] = chain(c).specs_at(k);
  return std::max(a < 0 ? 0 : n_of(a), b < 0 ? 0 : n_of(b));
}

int LayerColumns::layers_between(int c, int a, int b) const {
  const auto& columns = columns_[c];
  return columns[a].point == columns[b].point ? layers_at(c, columns[a].at) : layers_on(c, columns[a].at);
}

/// Beyond the last of fewer layers, further layers go on as they are on their side.
double LayerColumns::height(int c, int k, int layer) const {
  if (layer == 0) return 0;
  const auto [a, b] = chain(c).specs_at(k);
  const std::vector<double>&one = heights_[a < 0 ? b : a], &other = heights_[b < 0 ? a : b];
  if (a < 0 || b < 0) {
    const std::vector<int>& joined = joined_[c][k == 0 ? 0 : 1];
    double sum = one[layer - 1];
    for (const int s : joined) sum += heights_[s][layer - 1];
    return scales[c][k] * (sum / static_cast<double>(joined.size() + 1));
  }
  const int common = std::min({layer, n_of(a), n_of(b)});
  double height = (one[common - 1] + other[common - 1]) / 2;
  if (layer > common) {
    const std::vector<double>& more = one.size() > other.size() ? one : other;
    height += more[layer - 1] - more[common - 1];
  }
  return scales[c][k] * height;
}

int LayerColumns::fan_quads(double turn, int c, int k) const {
  const double edges = turn * thickness(c, k) / (kLongFront * std::ranges::max(edges_at(c, k)));
  const double wanted = std::clamp(edges / 2, turn / kFanQuad, std::max(1.0, turn / kThinFanQuad));
  return std::max(1, static_cast<int>(std::lround(wanted)));
}

void LayerColumns::join_end(int c, int end, std::vector<int> others, double slant) {
  joined_[c][end] = std::move(others);
  slants_[c][end] = slant;
}

void LayerColumns::set_corner(int c, int k, std::span<const LayerSpec> specs) {
  const LayerChain& chain = this->chain(c);
  ChainCorner& corner = corners_[c][k];
  const int n = chain.n_points();
  const bool is_first = k == 0 && !chain.is_closed, is_last = k == n - 1 && !chain.is_closed;
  if (!is_first) corner.in = unit(foot(c, k) - foot(c, (k + n - 1) % n));
  if (!is_last) corner.out = unit(foot(c, (k + 1) % n) - foot(c, k));
  if (is_first) corner.in = corner.out;
  if (is_last) corner.out = corner.in;
  if (is_first || is_last) return set_end(corner, c, is_first ? 0 : 1);
  const double turn = std::atan2(cross(corner.in, corner.out), dot(corner.in, corner.out));
  corner.angle = std::numbers::pi - turn;
  const auto [a, b] = chain.specs_at(k);
  if (-turn >= std::min(specs[a].fan, specs[b].fan) * kDegree) {
    corner.kind = ChainCorner::kFan;
    corner.quads = fan_quads(-turn, c, k);
  } else if (std::abs(turn) > kLayerCorner) {
    corner.kind = ChainCorner::kMitre;
  }
}

/// Where the mirror image goes on, a fan of both turns into the axis.
void LayerColumns::set_end(ChainCorner& corner, int c, int end) {
  const LayerChain& chain = this->chain(c);
  const LayerWall& wall = found_.walls[chain.wall[end]];
  const std::size_t n = wall.points.size();
  corner.angle = end == 0 ? inner_angle(patch_.points[wall.points[n - 2]], foot(c, 0), foot(c, 1))
                          : inner_angle(foot(c, chain.n_points() - 2), foot(c, chain.n_points() - 1),
                                        patch_.points[wall.points[1]]);
  if (corner.angle <= kWidestWall) {
    corner.kind = ChainCorner::kOnWall;
    slants_[c][end] = 1 / std::sin(corner.angle);
  } else if (wall.is_axis) {
    corner.kind = ChainCorner::kFanToWall;
    corner.quads = fan_quads(corner.angle - std::numbers::pi / 2, c, end == 0 ? 0 : chain.n_points() - 1);
  } else {
    corner.kind = ChainCorner::kOpenEnd;
  }
}

void LayerColumns::place() {
  for (int c = 0; c < n_chains(); ++c) {
    columns_[c].clear();
    const std::vector<double> lean = leans(c);
    for (int k = 0; k < chain(c).n_points(); ++k) add_columns(c, k, lean[k]);
  }
}

void LayerColumns::add_columns(int c, int k, double lean) {
  const ChainCorner& corner = corners_[c][k];
  const int point = chain(c).points[k];
  if (corner.kind == ChainCorner::kOnWall) {
    columns_[c].push_back(on_wall(c, k));
  } else if (corner.kind == ChainCorner::kFanToWall) {
    add_fan_to_wall(c, k);
  } else if (corner.kind == ChainCorner::kFan) {
    const double turn = corner.angle - std::numbers::pi, step = turn / (2 * corner.quads);
    const double diagonal = std::min(1 / std::cos(step), kLongestDiagonal);
    for (int i = 0; i <= 2 * corner.quads; ++i)
      columns_[c].push_back({k, point, (i % 2 == 0 ? 1 : diagonal) * turned(perp(corner.in), -i * step)});
  } else if (corner.kind == ChainCorner::kOpenEnd) {
    columns_[c].push_back({k, point, perp(corner.out)});
  } else {
    const Vec2 up = bisector(corner);
    columns_[c].push_back({k, point, up - lean * perp(unit(up))});
  }
}

/// As one half of a fan.
void LayerColumns::add_fan_to_wall(int c, int k) {
  const ChainCorner& corner = corners_[c][k];
  const bool is_first = k == 0;
  const double step = (corner.angle - std::numbers::pi / 2) / (2 * corner.quads);
  const double diagonal = std::min(1 / std::cos(step), kLongestDiagonal);
  std::vector<LayerColumn> fan;
  for (int i = 0; i < 2 * corner.quads; ++i)
    fan.push_back({k, chain(c).points[k],
                   (i % 2 == 0 ? 1 : diagonal) * turned(perp(corner.in), (is_first ? i : -i) * step)});
  fan.push_back(on_wall(c, k));
  if (is_first) std::ranges::reverse(fan);
  columns_[c].insert(columns_[c].end(), fan.begin(), fan.end());
}

LayerColumn LayerColumns::on_wall(int c, int k) const {
  const int end = k == 0 ? 0 : 1;
  return {k, chain(c).points[k], {}, chain(c).wall[end], end, slants_[c][end]};
}

Vec2 LayerColumns::point(int c, const LayerColumn& column, double height) const {
  if (column.wall < 0) return foot(c, column.at) + height * stretch(c, column.at) * column.direction;
  const WallTrack& track = found_.walls[column.wall].track;
  const double along = column.slant * height;
  return track.point(track.place(column.end == 0 ? track.length() - along : along));
}

/// How far columns of smooth points lean along their chain, by their height.
std::vector<double> LayerColumns::leans(int c) const {
  std::vector<double> leans(chain(c).n_points(), 0.0);
  for (int k = 0; k < chain(c).n_points(); ++k) {
    if (corners_[c][k].kind == ChainCorner::kSmooth) continue;
    lean_beside(c, k, true, leans);
    lean_beside(c, k, false, leans);
  }
  return leans;
}

/// Returns the lean of a corner's column, as its neighbors on one side see it.
double LayerColumns::lean_of(int c, int k, bool forward) const {
  const ChainCorner& corner = corners_[c][k];
  if (corner.kind == ChainCorner::kMitre) return (forward ? 1 : -1) / std::tan(corner.angle / 2);
  if (corner.kind != ChainCorner::kOnWall) return 0;
  const double h = thickness(c, k);
  return dot(point(c, on_wall(c, k), h) - foot(c, k), corner.in) / (h * stretch(c, k));
}

void LayerColumns::lean_beside(int c, int k, bool forward, std::vector<double>& leans) const {
  const int n = chain(c).n_points();
  const auto next = [&](int i) {
    const int j = forward ? i + 1 : i - 1;
    return chain(c).is_closed ? (j + n) % n : j;
  };
  const double lean = lean_of(c, k, forward);
  if (lean == 0) return;
  std::vector<std::pair<int, double>> beside;  // smooth points, and how far they are
  double length = 0;
  for (int i = k, j = next(k);; i = j, j = next(j)) {
    if (j < 0 || j >= n) return;  // there is no chain on that side
    length += distance(c, i, j);
    if (corners_[c][j].kind != ChainCorner::kSmooth || j == k) break;
    beside.emplace_back(j, length);
  }
  const double reach = std::min(kLeanReach * std::abs(lean) * thickness(c, k), length / 2);
  for (const auto& [j, far] : beside) leans[j] += lean * std::max(0.0, 1 - far / reach);
}

namespace {

constexpr int kMostLayers = 10000;

}  // namespace

std::vector<double> layer_heights(const LayerSpec& spec) {
  if ((spec.number == 0) == (spec.thickness == 0))
    throw InputError(fmt::format("{}: {} of 'number' and 'thickness': expected one", spec.where,
                                 spec.number == 0 ? "none" : "both"));
  if (spec.number < 0 || spec.number > kMostLayers)
    throw InputError(fmt::format("{}: {} layers: expected at most {}", spec.where, spec.number, kMostLayers));
  if (spec.number == 0 && spec.thickness < spec.first)
    throw InputError(
        fmt::format("{}: thickness {} is less than the first height, {}: expected a larger thickness",
                    spec.where, spec.thickness, spec.first));
  // This leaves room for the rounding of the sums.
  const double enough = spec.thickness * (1 - 1e-9);
  std::vector<double> heights;
  double height = spec.first, sum = 0;
  while (spec.number > 0 ? static_cast<int>(heights.size()) < spec.number : sum < enough) {
    if (heights.size() == static_cast<std::size_t>(kMostLayers))
      throw InputError(
          fmt::format("{}: the thickness needs more than {} layers: expected a larger first height or growth",
                      spec.where, kMostLayers));
    heights.push_back(sum += height);
    height *= spec.growth;
  }
  if (!(sum > 0) || !std::isfinite(sum))
    throw InputError(spec.where +
                     ": the layers have no finite thickness: expected a smaller growth or fewer layers");
  return heights;
}

}  // namespace delquad
