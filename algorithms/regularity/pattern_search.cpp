#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/polygon_sides.h"

namespace delquad {

namespace {

/// Of a cut: its edges are at least and at most so many times as long as wanted.
constexpr double kShortestEdge = 0.6, kLongestEdge = 1.7;

double strain_of(Vec2 a, Vec2 b, int edges, double delta) {
  const double misfit = std::log(std::max(norm(a - b), 1e-3 * delta) / (edges * delta));
  return edges * misfit * misfit;
}

/// An irregular vertex and the lines from it to places that stay: springs, in which each edge is as strong as
/// the others.
struct Hub {
  struct Line {
    Vec2 to;
    double delta;
    int edges;
  };
  void add(Vec2 to, double delta, int edges) {
    lines.push_back({to, delta, edges});
    pull += (1.0 / edges) * to;
    weight += 1.0 / edges;
  }
  Vec2 rest() const { return (1 / weight) * pull; }
  double strain(Vec2 at) const {
    double sum = 0;
    for (const Line& l : lines) sum += strain_of(at, l.to, l.edges, l.delta);
    return sum;
  }
  std::vector<Line> lines;
  Vec2 pull;          ///< sum of the ends, each over its edges
  double weight = 0;  ///< sum of 1 / edges
};

/// Patterns of an outline without concave vertices, but no cuts.
class ConvexSearch {
 public:
  ConvexSearch(const Outline& outline, PolygonSides sides) : outline_(outline), sides_(std::move(sides)) {}

  std::optional<Pattern> best() const;

 private:
  std::size_t place(int i) const {
    const int n = static_cast<int>(outline_.places.size());
    return static_cast<std::size_t>(((sides_.start + i) % n + n) % n);
  }
  int start(int side) const { return std::accumulate(sides_.edges.begin(), sides_.edges.begin() + side, 0); }
  void add_line(Hub& hub, int i, int edges) const {
    hub.add(outline_.places[place(i)], outline_.delta[place(i)], edges);
  }
  /// The arms of a star to its sides from `first` on, which follow each other on the outline from `at`.
  void add_arms(Hub& hub, std::span<const int> sides, std::size_t first, int at) const;
  Pattern grid() const;
  Pattern star() const;
  Pattern corner(int at, int along, int back) const;

  const Outline& outline_;
  PolygonSides sides_;
};

void ConvexSearch::add_arms(Hub& hub, std::span<const int> sides, std::size_t first, int at) const {
  const std::array<int, 5> x = star_feet(sides).value();
  for (std::size_t i = first; i < sides.size(); ++i) {
    add_line(hub, at + x[i], x[(i + 1) % sides.size()]);
    at += sides[i];
  }
}

Pattern ConvexSearch::grid() const {
  Pattern pattern{Pattern::kGrid};
  for (int i = 0; i < 2; ++i) {
    const int half = sides_.edges[i] / 2, across = sides_.edges[1 - i];
    const std::size_t from = place(start(i) + half), to = place(start(i + 2) + sides_.edges[i] - half);
    pattern.strain += strain_of(outline_.places[from], outline_.places[to], across, outline_.delta[from]);
  }
  return pattern;
}

Pattern ConvexSearch::star() const {
  Pattern pattern{Pattern::kStar};
  Hub hub;
  add_arms(hub, sides_.edges, 0, 0);
  pattern.places = {hub.rest()};
  pattern.strain = hub.strain(hub.rest());
  return pattern;
}

Pattern ConvexSearch::corner(int at, int along, int back) const {
  Pattern pattern{Pattern::kCorner, at, along, back};
  const std::size_t n = sides_.edges.size() + 1;
  const auto all = sides_without_corner(sides_.edges, at, along, back);
  const auto rest = std::span(all).first(n);
  const auto x = star_feet(rest).value();
  const int corner = start(at), between = x[1] + std::abs(x[0] - along);
  Hub three, star;
  add_line(three, corner + along, back);
  add_line(three, corner - back, along);
  add_arms(star, rest, 1, corner + along);
  // Both pull at each other.
  const double w = 1.0 / between, a = three.weight + w, b = star.weight + w, det = a * b - w * w;
  const Vec2 t = (1 / det) * (b * three.pull + w * star.pull);
  const Vec2 c = (1 / det) * (w * three.pull + a * star.pull);
  pattern.places = {t, c};
  pattern.strain =
      three.strain(t) + star.strain(c) + strain_of(t, c, between, outline_.delta[place(corner + along)]);
  return pattern;
}

std::optional<Pattern> ConvexSearch::best() const {
  const auto& s = sides_.edges;
  if (s.size() == 3 || s.size() == 5) return star_feet(s) ? std::optional(star()) : std::nullopt;
  if (s.size() == 4 && s[0] == s[2] && s[1] == s[3]) return grid();
  std::optional<Pattern> least;
  if (s.size() == 2 || s.size() == 4)
    any_corner(s, [&](int at, int along, int back) {
      Pattern pattern = corner(at, along, back);
      if (!least || pattern.strain < least->strain) least = std::move(pattern);
      return false;
    });
  return least;
}

/// As ConvexSearch's; -1: there is none.
int least_of_convex(std::span<const int> s) {
  if (s.size() == 3 || s.size() == 5) return star_feet(s) ? 1 : -1;
  if (s.size() == 4 && s[0] == s[2] && s[1] == s[3]) return 0;
  const bool found = (s.size() == 2 || s.size() == 4) && any_corner(s, [](int, int, int) { return true; });
  return found ? 2 : -1;
}

/// The sides of a part of an outline, from one place to another and back along a cut; empty where it is not
/// convex, or has more than 5 sides.
class PartSides {
 public:
  PartSides(std::span<const int> turn, int from, int to, int turn_from, int turn_to, int cut) {
    const int n = static_cast<int>(turn.size());
    for (int i = from; i != to; i = (i + 1) % n) {
      if (i != from && !pass(turn[i])) return;
      ++edges_[last_];
    }
    if (!pass(turn_to)) return;
    edges_[last_] += cut;
    if (turn_from == 0) edges_[last_] += edges_[0];
    first_ = turn_from == 0 ? 1 : 0;
    n_ = last_ + 1 - first_;
  }
  std::span<const int> get() const {
    return n_ < 2 || n_ > 5 ? std::span<const int>() : std::span(edges_).subspan(first_, n_);
  }

 private:
  bool pass(int turn) {
    if (turn == 1) ++last_;
    return turn >= 0 && last_ < edges_.size();
  }
  std::array<int, 7> edges_{};
  std::size_t last_ = 0, first_ = 0, n_ = 0;
};

/// Cuts of an outline into two convex parts.
class CutSearch {
 public:
  explicit CutSearch(const Outline& outline) : outline_(outline), n_(static_cast<int>(outline.turn.size())) {}

  /// Calls f(cut, irregular vertices of the parts) for all, until f returns true.
  template <class F>
  void for_each(F&& f) const {
    const auto concave = std::ranges::find_if(outline_.turn, [](int t) { return t < 0; });
    if (concave == outline_.turn.end()) return for_each_of_hexagon(f);
    if (*concave < -1) return;
    const int from = static_cast<int>(concave - outline_.turn.begin());
    for (int k = 2; k <= n_ - 2; ++k)
      if (try_ends(from, (from + k) % n_, f)) return;
  }
  Pattern with_parts(Pattern cut) const;

 private:
  /// Between opposite sides.
  template <class F>
  void for_each_of_hexagon(F& f) const {
    const auto sides = sides_of(outline_.turn);
    if (!sides || sides->edges.size() != 6) return;
    const auto& s = sides->edges;
    for (int i = 0, at = sides->start; i < 3; at += s[i], ++i)
      for (int a = 1, across = at + s[i] + s[i + 1] + s[i + 2]; a < s[i]; ++a)
        for (int b = 1; b < s[i + 3]; ++b)
          if (try_ends((at + a) % n_, (across + b) % n_, f)) return;
  }
  template <class F>
  bool try_ends(int from, int to, F& f) const {
    if (outline_.turn[to] > 0) return false;
    const double delta = 0.5 * (outline_.delta[from] + outline_.delta[to]);
    const double length = norm(outline_.places[from] - outline_.places[to]) / delta;
    const int most = static_cast<int>(std::min(1.0 * n_, length / kShortestEdge));
    int cut = std::max(1, static_cast<int>(std::ceil(length / kLongestEdge)));
    if ((cut + to - from + n_) % 2 != 0) ++cut;
    for (; cut <= most; cut += 2)
      for (int at_from = 1; at_from < 2 - outline_.turn[from]; ++at_from)
        for (int at_to = 1; at_to < 2 - outline_.turn[to]; ++at_to)
          if (try_cut({Pattern::kCut, from, at_from, at_to, to, cut}, f)) return true;
    return false;
  }
  template <class F>
  bool try_cut(const Pattern& c, F& f) const {
    const PartSides first(outline_.turn, c.at, c.to, 2 - c.along, 2 - c.back, c.cut);
    const int one = least_of_convex(first.get());
    if (one < 0) return false;
    const PartSides second(outline_.turn, c.to, c.at, outline_.turn[c.to] + c.back,
                           outline_.turn[c.at] + c.along, c.cut);
    const int other = least_of_convex(second.get());
    return other >= 0 && f(c, one + other);
  }
  Outline part(int from, int to, int turn_from, int turn_to, int cut) const;

  const Outline& outline_;
  int n_;
};

Outline CutSearch::part(int from, int to, int turn_from, int turn_to, int cut) const {
  Outline half;
  const auto add = [&](Vec2 place, double delta, int turn) {
    half.places.push_back(place), half.delta.push_back(delta), half.turn.push_back(turn);
  };
  add(outline_.places[from], outline_.delta[from], turn_from);
  for (int i = (from + 1) % n_; i != to; i = (i + 1) % n_)
    add(outline_.places[i], outline_.delta[i], outline_.turn[i]);
  add(outline_.places[to], outline_.delta[to], turn_to);
  for (int i = 1; i < cut; ++i) {
    const double t = double(i) / cut;
    add((1 - t) * outline_.places[to] + t * outline_.places[from],
        (1 - t) * outline_.delta[to] + t * outline_.delta[from], 0);
  }
  return half;
}

/// The cut with patterns of both parts.
Pattern CutSearch::with_parts(Pattern c) const {
  const Outline halves[2] = {
      part(c.at, c.to, 2 - c.along, 2 - c.back, c.cut),
      part(c.to, c.at, outline_.turn[c.to] + c.back, outline_.turn[c.at] + c.along, c.cut)};
  c.strain = strain_of(outline_.places[c.at], outline_.places[c.to], c.cut,
                       0.5 * (outline_.delta[c.at] + outline_.delta[c.to]));
  for (const Outline& half : halves) {
    c.parts.push_back(ConvexSearch(half, sides_of(half.turn).value()).best().value());
    c.strain += c.parts.back().strain;
  }
  return c;
}

}  // namespace

int irregular_vertices(const Pattern& pattern) {
  switch (pattern.kind) {
    case Pattern::kGrid:
      return 0;
    case Pattern::kStar:
      return 1;
    case Pattern::kCorner:
      return 2;
    default:
      return irregular_vertices(pattern.parts[0]) + irregular_vertices(pattern.parts[1]);
  }
}

std::optional<int> least_irregular(const Outline& outline) {
  if (const auto sides = sides_of(outline.turn)) {
    const int least = least_of_convex(sides->edges);
    if (least >= 0) return least;
  }
  // Corners alone ask for as many.
  const int bound = std::abs(4 - std::reduce(outline.turn.begin(), outline.turn.end()));
  std::optional<int> least;
  CutSearch(outline).for_each([&](const Pattern&, int irregular) {
    if (!least || irregular < *least) least = irregular;
    return *least <= bound;
  });
  return least;
}

std::optional<Pattern> best_pattern(const Outline& outline, int least) {
  if (auto sides = sides_of(outline.turn))
    if (auto best = ConvexSearch(outline, *std::move(sides)).best()) return best;
  const CutSearch search(outline);
  std::optional<Pattern> best;
  search.for_each([&](const Pattern& cut, int irregular) {
    if (irregular > least) return false;
    Pattern pattern = search.with_parts(cut);
    if (!best || pattern.strain < best->strain) best = std::move(pattern);
    return false;
  });
  return best;
}

}  // namespace delquad
