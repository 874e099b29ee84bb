// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/washers/hole_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "algorithms/fields/fields.h"
#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {
namespace {

/// Outlines turn by no more than this times a full turn in all.
constexpr double kMostTurns = 1.1;
/// How much distances from the middle of a round outline differ, in radii.
constexpr double kRound = 0.06;
/// Diameters are in a range that they miss by this part: triangulations have them so.
constexpr double kInRange = 1e-3;
/// Rows are at least so high, of what is asked for; and what is free beside them so wide, of the last edges.
constexpr double kLeastHeight = 0.6, kLeastFree = 0.5;
/// Edges around, where the size asks for less.
constexpr int kFewestEdges = 6;
constexpr double kMostEdges = 1e5;  // that are tried
/// Lengths of edges, in sizes: quads beside them have others that are a fifth shorter or longer.
constexpr double kShortest = 1.2 * QuadLimits{}.shortest, kLongest = QuadLimits{}.longest / 1.2;

/// Twice the area, along the normal.
Vec3 area_of(const std::vector<Vec3>& outline) {
  Vec3 area;
  for (std::size_t i = 0; i < outline.size(); ++i)
    area = area + cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  return area;
}

std::vector<Vec2> in_its_plane(const std::vector<Vec3>& outline) {
  const Vec3 normal = area_of(outline);
  Vec3 along = outline[1] - outline[0];
  along = along - (dot(along, normal) / dot(normal, normal)) * normal;
  const Vec3 e = (1 / norm(along)) * along, f = (1 / norm(normal)) * cross(normal, e);
  std::vector<Vec2> flat;
  for (const Vec3& x : outline) flat.push_back({dot(x - outline[0], e), dot(x - outline[0], f)});
  return flat;
}

/// Returns the diameter of a hole. For a round hole this is twice the mean distance from the middle of the
/// outline, else the least width along its sides.
double diameter_of(const std::vector<Vec2>& flat) {
  const std::size_t n = flat.size();
  Vec2 sum;
  double length = 0, radius = 0, low = std::numeric_limits<double>::infinity(), high = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double side = norm(flat[(i + 1) % n] - flat[i]);
    sum += 0.5 * side * (flat[i] + flat[(i + 1) % n]);
    length += side;
  }
  for (const Vec2& x : flat) {
    const double distance = norm(x - (1 / length) * sum);
    radius += distance / static_cast<double>(n);
    low = std::min(low, distance), high = std::max(high, distance);
  }
  if (high - low <= kRound * radius) return 2 * radius;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 d = flat[(i + 1) % n] - flat[i];
    const auto [left, right] =
        std::ranges::minmax(flat, {}, [&](const Vec2& x) { return cross(d, x - flat[i]); });
    least = std::min(least, (cross(d, right - flat[i]) - cross(d, left - flat[i])) / norm(d));
  }
  return least;
}

constexpr double kTurn = 2 * std::numbers::pi;

/// Around the last of some rows. Where no width is given each is as high as edges at its beginning are long.
double outer_length(const WasherSpec& washer, double length, int edges, int rows) {
  if (washer.width > 0) return length + kTurn * rows * washer.width / washer.rows;
  return length * std::pow(1 + kTurn / edges, rows);
}

/// An even number: edges at the hole and around the last row are as long as the size, in the mean.
int edges_for(const WasherSpec& washer, double length, double size) {
  const auto miss = [&](int n) {
    return std::log(std::sqrt(length * outer_length(washer, length, n, washer.rows)) / (n * size));
  };
  int n = std::max(kFewestEdges, 2 * static_cast<int>(length / size / 2));
  while (miss(n) > 0 && std::abs(miss(n + 2)) < miss(n)) n += 2;
  return n;
}

bool is_in_range(const WasherSpec& washer, double diameter) {
  return diameter >= (1 - kInRange) * washer.least && diameter <= (1 + kInRange) * washer.most;
}

}  // namespace

double Hole::length() const { return std::accumulate(parts.begin(), parts.end(), 0.0); }

Vec3 Hole::middle() const {
  return (1.0 / static_cast<double>(outline.size())) *
         std::accumulate(outline.begin(), outline.end(), Vec3{});
}

std::optional<double> hole_diameter(const std::vector<Vec3>& outline) {
  if (outline.size() < 6 || !(norm(area_of(outline)) > 0)) return std::nullopt;
  const std::vector<Vec2> flat = in_its_plane(outline);
  double turns = 0;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const Vec2 in = flat[(i + 1) % flat.size()] - flat[i],
               out = flat[(i + 2) % flat.size()] - flat[(i + 1) % flat.size()];
    const double turn = std::abs(std::atan2(cross(in, out), dot(in, out)));
    if (!(turn <= kMostTurn)) return std::nullopt;
    turns += turn;
  }
  if (turns > kMostTurns * 2 * std::numbers::pi) return std::nullopt;
  return diameter_of(flat);
}

HoleClearance::HoleClearance(std::vector<Wall> walls) : walls_(std::move(walls)) {
  std::vector<Box<Vec3>> boxes;
  for (const Wall& wall : walls_) boxes.push_back(Box<Vec3>::around(wall.ends));
  tree_ = BoxTree<Vec3>(boxes);
}

std::array<double, 2> HoleClearance::around(const Hole& hole, int number, double reach) const {
  std::array<double, 2> room = {reach, reach};
  const std::size_t n = hole.outline.size();
  const double step = hole.diameter / 16;  // what it misses is far less
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 side = hole.outline[(i + 1) % n] - hole.outline[i];
    const int places = 1 + static_cast<int>(norm(side) / step);
    for (int k = 0; k < places; ++k) {
      const Vec3 x = hole.outline[i] + (double(k) / places) * side;
      double limit = std::max(room[0] * room[0], room[1] * room[1]);
      tree_.nearest(x, limit, [&](int w) {
        const Wall& wall = walls_[w];
        if (wall.hole == number) return;
        double& least = room[wall.hole < 0 ? 0 : 1];
        least = std::min(least, distance_to_segment(x, wall.ends[0], wall.ends[1]));
        limit = std::max(room[0] * room[0], room[1] * room[1]);
      });
    }
  }
  return room;
}

const WasherSpec* washer_of(const std::vector<WasherSpec>& washers, const Hole& hole) {
  const auto at =
      std::ranges::find_if(washers, [&](const WasherSpec& w) { return is_in_range(w, hole.diameter); });
  return at == washers.end() ? nullptr : &*at;
}

void warn_of_idle(const std::vector<WasherSpec>& washers, const std::vector<double>& diameters,
                  std::vector<Warning>& warnings) {
  for (const WasherSpec& washer : washers) {
    if (std::ranges::any_of(diameters, [&](double d) { return is_in_range(washer, d); })) continue;
    std::string known = "there are no round or slotted holes";
    if (!diameters.empty()) {
      const auto [least, most] = std::ranges::minmax(diameters);
      known = fmt::format("holes have {:.4g} to {:.4g}", least, most);
    }
    warnings.emplace_back(fmt::format("{}: no hole has a diameter from {} to {}: {}", washer.where,
                                      washer.least, washer.most, known));
  }
}

double rim_size(const Hole& hole, const WasherSpec& washer, const SizeSpec& spec, const SizeField& field,
                std::vector<Warning>& warnings) {
  int hint = -1;
  const double size = field.at(hole.outline[0], hint);
  const double length = hole.length(),
               finer = size_by_curvature(size, kTurn / length, spec.curvature, spec.min);
  const int edges = washer.edges > 0 ? washer.edges : edges_for(washer, length, size),
            more = 2 * static_cast<int>(std::ceil(length / finer / 2 - kInRange));
  if (!(finer < size) || more <= edges) return size;
  const bool are_given = washer.edges > 0;
  warnings.push_back(
      {are_given ? "holes with fewer edges than curvature asks" : "holes with more edges by curvature",
       double(more) / edges,
       fmt::format("{}: the hole of diameter {:.4g} at {} gets {} edges, not {}: {}", washer.where,
                   hole.diameter, show_point(hole.middle()), are_given ? edges : more,
                   are_given ? more : edges,
                   are_given ? "edges that are given count more than curvature"
                             : "curvature asks for more than the size")});
  return are_given ? size : std::sqrt(length * outer_length(washer, length, more, washer.rows)) / more;
}

bool edge_fits(double length, double size) { return length >= kShortest * size && length <= kLongest * size; }

std::vector<int> share_edges(const std::vector<double>& parts, int edges) {
  const std::size_t n = parts.size(), half = n / 2;
  bool repeats = n > 1 && n % 2 == 0 && edges % 2 == 0;
  for (std::size_t i = 0; repeats && i < half; ++i)
    repeats = std::abs(parts[i] - parts[i + half]) <= kInRange * parts[i];
  if (repeats) {
    std::vector<int> shares = share_edges({parts.begin(), parts.begin() + half}, edges / 2);
    shares.insert(shares.end(), shares.begin(), shares.begin() + half);
    return shares;
  }
  std::vector<int> shares(n, 1);
  for (int left = edges - static_cast<int>(n); left > 0; --left) {
    std::size_t most = 0;
    for (std::size_t i = 1; i < n; ++i)
      if (parts[i] * shares[most] > parts[most] * shares[i] * (1 + kInRange)) most = i;
    ++shares[most];
  }
  return shares;
}

std::optional<HoleRows> rows_around(const Hole& hole, int number, const WasherSpec& washer, double size,
                                    const HoleClearance& room, std::vector<Warning>& warnings) {
  const double length = hole.length();
  const bool is_given = !hole.given.empty() && std::ranges::count(hole.given, 0) == 0;
  const int wanted = is_given           ? std::accumulate(hole.given.begin(), hole.given.end(), 0)
                     : washer.edges > 0 ? washer.edges
                                        : edges_for(washer, length, size);
  const auto outer = [&](int n, int rows) { return outer_length(washer, length, n, rows); };
  const auto height = [&](int n, int rows) { return (outer(n, rows) - length) / kTurn / rows; };
  const auto fits = [&](int n) {
    return n >= static_cast<int>(hole.parts.size()) && (!hole.is_rim || edge_fits(length / n, size)) &&
           length + kTurn * kLeastHeight * height(n, 1) <= n * kLongest * size &&
           outer(n, washer.rows) >= n * kShortest * size;
  };
  int edges = fits(wanted) ? wanted : 0;
  const int most =
      is_given || edges > 0
          ? 0
          : static_cast<int>(std::min(kMostEdges, outer(kFewestEdges, washer.rows) / (kShortest * size)));
  for (int n = kFewestEdges; n <= most; n += 2)
    if (fits(n) &&
        (edges == 0 || std::abs(std::log(n / double(wanted))) < std::abs(std::log(edges / double(wanted)))))
      edges = n;
  const double asked = height(edges > 0 ? edges : wanted, washer.rows);
  const auto [plain, shared] = room.around(hole, number, (2 * washer.rows + 2) * asked);
  int rows = edges > 0 ? washer.rows : 0;
  const auto possible = [&, plain = plain, shared = shared] {
    const double free = kLeastFree * length / edges, growth = kLeastFree * kTurn / edges;
    return std::min({height(edges, rows), plain / (rows + 1), (plain - free) / rows / (1 + growth),
                     shared / (2 * rows + 1), (shared - free) / rows / (2 + growth),
                     (edges * kLongest * size - length) / kTurn / rows});
  };
  while (rows > 0 && possible() < kLeastHeight * height(edges, rows)) --rows;
  const double high = rows > 0 ? possible() : 0;
  if (rows == washer.rows && high == asked && edges == wanted)
    return HoleRows{rows, high, is_given ? hole.given : share_edges(hole.parts, edges)};
  const double near = std::min(plain, shared);
  const std::string why =
      near < (washer.rows + 1) * asked && edges > 0
          ? fmt::format("something is {:.3g} away", near)
          : fmt::format("{} edges would be {:.2g} to {:.2g} sizes long", wanted, length / wanted / size,
                        outer(wanted, washer.rows) / wanted / size);
  const std::string label = fmt::format("{}: the hole of diameter {:.4g} at {} gets", washer.where,
                                        hole.diameter, show_point(hole.middle()));
  if (rows == 0) {
    warnings.push_back(
        {"holes without rows", 1,
         fmt::format("{} no rows: {}, and a row is {:.3g} high [no-rows]", label, why, asked)});
    return std::nullopt;
  }
  const std::string others = edges == wanted ? "" : fmt::format(" and {} edges", edges);
  warnings.push_back(
      {"holes with less room for rows than asked for", asked * washer.rows / (rows * high),
       fmt::format("{} {} of {:.3g}{}, not {} of {:.3g}: {} [no-rows]", label, counted(rows, "row"), high,
                   others, washer.rows, height(wanted, washer.rows), why)});
  return HoleRows{rows, high, is_given ? hole.given : share_edges(hole.parts, edges)};
}

LayerSpec layers_of(const HoleRows& rows, const std::vector<int>& curves, const std::string& where) {
  // Heights of layers are the heights of their quads, between nodes that turn.
  const double turned = std::cos(std::numbers::pi / std::accumulate(rows.edges.begin(), rows.edges.end(), 0));
  LayerSpec layer{.on = {}, .first = turned * rows.height, .growth = 1, .number = rows.rows, .where = where};
  for (const int curve : curves) layer.on.push_back(fmt::format("curve_{}", curve));
  return layer;
}

}  // namespace delquad
