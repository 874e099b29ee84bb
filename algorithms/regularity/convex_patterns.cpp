// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "algorithms/regularity/patterns.h"

namespace delquad {

namespace {

/// Extra cost of a center on the rim, which comes last.
constexpr double kRimStrain = 1000;

/// An irregular vertex with lines to fixed places. Each edge of a line is a spring of the same strength.
struct Hub {
  struct Line {
    Vec2 to;
    double delta;
    int edges;
  };
  void add(Vec2 to, double delta, int edges) {
    lines[n++] = {to, delta, edges};
    pull += (1.0 / edges) * to;
    weight += 1.0 / edges;
  }
  Vec2 rest() const { return (1 / weight) * pull; }
  double strain(Vec2 at) const {
    double sum = 0;
    for (const Line& l : std::span(lines).first(n)) sum += strain_of(at, l.to, l.edges, l.delta);
    return sum;
  }
  std::array<Line, 5> lines;
  std::size_t n = 0;
  Vec2 pull;          ///< sum of the ends, each divided by its edges
  double weight = 0;  ///< sum of 1 / edges
};

/// Search for patterns without cuts in an outline without concave vertices.
class ConvexSearch {
 public:
  ConvexSearch(const Outline& outline, const PolygonSides& sides) : outline_(outline), sides_(sides) {}

  std::optional<Pattern> best() const {
    const auto& s = sides_.edges;
    if (s.size() == 3 || s.size() == 5) {
      const auto feet = star_feet(s);
      return feet ? std::optional(star(*feet)) : std::nullopt;
    }
    if (s.size() == 4 && s[0] == s[2] && s[1] == s[3]) return grid();
    std::optional<Pattern> least;
    any_corner(s, [&](int at, int along, int back, std::span<const int> rest, const auto& feet) {
      const auto found = pair(at, along, back, {rest, feet});
      if (found && (!least || found->strain < least->strain))
        least = Pattern{.kind = Pattern::kCorner,
                        .at = at,
                        .along = along,
                        .back = back,
                        .places = {found->three, found->five},
                        .strain = found->strain};
      return false;
    });
    return least;
  }

 private:
  std::size_t place(int i) const {
    const int n = static_cast<int>(outline_.places.size());
    return static_cast<std::size_t>(((sides_.start + i) % n + n) % n);
  }
  int start(int side) const { return std::accumulate(sides_.edges.begin(), sides_.edges.begin() + side, 0); }
  void add_line(Hub& hub, int i, int edges) const {
    hub.add(outline_.places[place(i)], outline_.delta[place(i)], edges);
  }
  /// A star: sides of its polygon, and feet of its arms.
  struct Star {
    std::span<const int> sides;
    const std::array<int, 5>& feet;
  };
  /// Adds the arms of a star to its sides from `first` on, which begin at `at` on the outline. Returns the
  /// side with its center; negative: none.
  int add_arms(Hub& hub, const Star& star, std::size_t first, int at) const {
    const auto& [sides, x] = star;
    const std::size_t n = sides.size();
    std::size_t on = 0;
    while (on < n && x[(on + 1) % n] > 0) ++on;
    for (std::size_t i = first; i < n; ++i) {
      // Arms beside a center on the rim lie on the rim.
      if (on == n || (i + n - on + 1) % n > 2) add_line(hub, at + x[i], x[(i + 1) % n]);
      at += sides[i];
    }
    return on < n ? static_cast<int>(on) : -1;
  }

  Pattern grid() const {
    Pattern pattern{Pattern::kGrid};
    for (int i = 0; i < 2; ++i) {
      const int half = sides_.edges[i] / 2, across = sides_.edges[1 - i];
      const std::size_t from = place(start(i) + half), to = place(start(i + 2) + sides_.edges[i] - half);
      pattern.strain += strain_of(outline_.places[from], outline_.places[to], across, outline_.delta[from]);
    }
    return pattern;
  }

  Pattern star(const std::array<int, 5>& feet) const {
    Pattern pattern{Pattern::kStar};
    Hub hub;
    const int on = add_arms(hub, {sides_.edges, feet}, 0, 0);
    pattern.places = {on < 0 ? hub.rest() : outline_.places[place(start(on) + feet[on])]};
    pattern.strain = hub.strain(pattern.places[0]);
    return pattern;
  }

  struct Pair {
    double strain;
    Vec2 three, five;
  };

  std::optional<Pair> pair(int at, int along, int back, const Star& left) const {
    const auto& [rest, x] = left;
    double strain = 0;
    const int corner = start(at), between = x[1] + std::abs(x[0] - along);
    const std::size_t ahead = place(corner + along), behind = place(corner - back);
    Hub three, star;
    add_line(three, corner + along, back);
    add_line(three, corner - back, along);
    const int on = add_arms(star, left, 1, corner + along);
    Vec2 t = three.rest(), c = t;
    if (on < 0) {
      // Both vertices pull at each other.
      const double w = 1.0 / between, a = three.weight + w, b = star.weight + w, det = a * b - w * w;
      t = (1 / det) * (b * three.pull + w * star.pull);
      c = (1 / det) * (w * three.pull + a * star.pull);
      strain = strain_of(t, c, between, outline_.delta[ahead]);
    } else if (on > 0) {
      const int foot = std::accumulate(rest.begin() + 1, rest.begin() + on, corner + along + x[on]);
      c = outline_.places[place(foot)];
    } else if (x[0] != along) {
      const double far = x[0] < along ? double(x[0]) / along : double(rest[0] - x[0]) / back;
      c = (1 - far) * outline_.places[x[0] < along ? behind : ahead] + far * t;
    } else {
      return std::nullopt;  // both irregular vertices would coincide
    }
    return Pair{strain + three.strain(t) + star.strain(c) + (on < 0 ? 0 : kRimStrain), t, c};
  }

  const Outline& outline_;
  const PolygonSides& sides_;
};

}  // namespace

double strain_of(Vec2 a, Vec2 b, int edges, double delta) {
  assert(edges > 0 && delta > 0);
  const double misfit = std::log(std::max(norm(a - b), 1e-3 * delta) / (edges * delta));
  return edges * misfit * misfit;
}

std::optional<Pattern> best_convex(const Outline& outline, const PolygonSides& sides) {
  assert(std::ranges::all_of(outline.turn, [](int turn) { return turn >= 0; }));
  return ConvexSearch(outline, sides).best();
}

}  // namespace delquad
