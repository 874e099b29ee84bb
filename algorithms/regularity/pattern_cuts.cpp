// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <tuple>

#include "algorithms/regularity/patterns.h"

namespace delquad {

namespace {

/// Range of the length of edges on a cut, over the wanted length.
constexpr double kShortestEdge = 0.75, kLongestEdge = 1.4;
/// Limit of followed cuts of an outline, least strain first, and the divisor of this number for its parts.
constexpr int kMostCuts = 8, kFewerOfParts = 4;
/// Corners of an outline minus concave vertices.
constexpr int kFewestCorners = 2, kMostCorners = 8;

/// Returns the number of irregular vertices that corners require.
int bound_of(int corners) { return std::abs(4 - corners); }

/// Sums up the sides of a polygon from a piece of an outline and a cut.
class PartSides {
 public:
  /// `turn` is the turn at the start of the piece.
  explicit PartSides(int turn) : corners_(turn), at_corner_(turn == 1), convex_(turn >= 0) {}
  /// Advances to the next place with a turn, or to the end of the piece.
  void go(int edges, int turn) {
    edges_[last_] += edges;
    corners_ += turn;
    convex_ = convex_ && turn >= 0;
    if (turn == 1 && last_ + 1 < edges_.size()) ++last_;
  }
  int corners() const { return corners_; }
  /// Returns a lower bound for the irregular vertices of its patterns; negative if it has none.
  int least(int cut) const {
    if (corners_ < kFewestCorners || corners_ > kMostCorners) return -1;
    if (!convex_ || corners_ > 5) return bound_of(corners_);
    std::array<int, 7> edges = edges_;
    edges[last_] += cut + (at_corner_ ? 0 : edges[0]);
    return least_irregular_of(std::span(edges).subspan(at_corner_ ? 0 : 1, corners_));
  }

 private:
  std::array<int, 7> edges_{};
  std::size_t last_ = 0;
  int corners_;
  bool at_corner_, convex_;
};

struct Cut {
  int from, along, back, to, edges;  ///< as in Pattern
  int irregular;                     ///< lower bound for its parts
  double strain;
  friend bool operator<(const Cut& a, const Cut& b) {
    return std::tie(a.irregular, a.strain, a.from, a.to, a.along, a.back, a.edges) <
           std::tie(b.irregular, b.strain, b.from, b.to, b.along, b.back, b.edges);
  }
};

/// Search for cuts of an outline with one loop.
class CutSearch {
 public:
  /// Leaves out cuts with more than `most` irregular vertices.
  CutSearch(const Outline& outline, int most)
      : outline_(outline), n_(static_cast<int>(outline.turn.size())), most_(most), to_turn_(n_, n_) {
    for (int i = 2 * n_ - 1; i >= 0; --i)
      to_turn_[i % n_] = outline.turn[(i + 1) % n_] != 0 ? 1 : std::min(to_turn_[(i + 1) % n_] + 1, n_);
  }

  /// Returns up to n cuts, by fewest irregular vertices, then least strain.
  std::vector<Cut> first(int n) && {
    if (const auto sides = sides_of(outline_.turn)) {
      between_sides(*sides);
    } else {
      const auto concave = std::ranges::find_if(outline_.turn, [](int t) { return t < 0; });
      const int from = static_cast<int>(concave - outline_.turn.begin());
      for (int k = 2; k <= n_ - 2 && from < n_; ++k) try_ends(from, (from + k) % n_);
    }
    const auto end = cuts_.begin() + std::min<std::ptrdiff_t>(n, std::ssize(cuts_));
    std::partial_sort(cuts_.begin(), end, cuts_.end());
    cuts_.erase(end, cuts_.end());
    return std::move(cuts_);
  }

 private:
  /// Tries cuts that leave a pentagon.
  void between_sides(const PolygonSides& sides) {
    const auto& s = sides.edges;
    const int n = static_cast<int>(s.size());
    if (n < 6) return;
    std::vector<int> start{sides.start};
    for (int i = 1; i < 2 * n; ++i) start.push_back(start.back() + s[(i - 1) % n]);
    for (int i = 0; i < (n == 6 ? 3 : n); ++i)
      for (int a = 1; a < s[i]; ++a)
        for (int b = 1; b < s[(i + 3) % n]; ++b) try_ends((start[i] + a) % n_, (start[i + 3] + b) % n_);
  }

  void try_ends(int from, int to) {
    if (outline_.turn[to] > 0) return;
    const double delta = 0.5 * (outline_.delta[from] + outline_.delta[to]);
    const Vec2 a = outline_.places[from], b = outline_.places[to];
    const double length = norm(a - b) / delta;
    const int most = static_cast<int>(std::min(1.0 * n_, length / kShortestEdge));
    int least = std::max(1, static_cast<int>(std::ceil(length / kLongestEdge)));
    if ((least + to - from + n_) % 2 != 0) ++least;
    const int all_from = 2 - outline_.turn[from], all_to = 2 - outline_.turn[to];
    for (int at_from = 1; at_from < all_from; ++at_from)
      for (int at_to = 1; at_to < all_to; ++at_to) {
        const PartSides one = part(from, to, 2 - at_from, 2 - at_to),
                        other = part(to, from, 2 - all_to + at_to, 2 - all_from + at_from);
        if (bound_of(one.corners()) + bound_of(other.corners()) > most_) continue;
        for (int cut = least; cut <= most; cut += 2) {
          const int irregular_one = one.least(cut);
          if (irregular_one < 0 || irregular_one > most_) continue;
          const int irregular_other = other.least(cut), irregular = irregular_one + irregular_other;
          if (irregular_other >= 0 && irregular <= most_)
            cuts_.push_back({from, at_from, at_to, to, cut, irregular, strain_of(a, b, cut, delta)});
        }
      }
  }

  PartSides part(int from, int to, int turn_from, int turn_to) const {
    PartSides sides(turn_from);
    int left = (to - from + n_) % n_;
    for (int at = from; to_turn_[at] < left;) {
      const int step = to_turn_[at];
      at = (at + step) % n_, left -= step;
      sides.go(step, outline_.turn[at]);
    }
    sides.go(left, turn_to);
    return sides;
  }

  const Outline& outline_;
  int n_, most_;
  std::vector<int> to_turn_;  ///< edges from each place to the next place with a turn
  std::vector<Cut> cuts_;
};

/// Makes outlines of pieces of another outline.
struct OutlineMaker {
  const Outline& whole;
  Outline made = {};

  void reserve(std::size_t n) { made.places.reserve(n), made.delta.reserve(n), made.turn.reserve(n); }
  void add(int i, int turn) {
    made.places.push_back(whole.places[i]), made.delta.push_back(whole.delta[i]), made.turn.push_back(turn);
  }
  /// Adds the places between two places of a loop.
  void add_between(int from, int to, int begin, int end) {
    for (int i = from + 1 < end ? from + 1 : begin; i != to; i = i + 1 < end ? i + 1 : begin)
      add(i, whole.turn[i]);
  }
  void add_row(int from, int to, int edges) {
    for (int i = 1; i < edges; ++i) {
      const double t = double(i) / edges;
      made.places.push_back((1 - t) * whole.places[from] + t * whole.places[to]);
      made.delta.push_back((1 - t) * whole.delta[from] + t * whole.delta[to]);
      made.turn.push_back(0);
    }
  }
};

Outline part_of(const Outline& whole, int from, int to, int turn_from, int turn_to, int cut) {
  OutlineMaker maker{whole};
  maker.reserve(whole.turn.size() + cut);
  maker.add(from, turn_from);
  maker.add_between(from, to, 0, static_cast<int>(whole.turn.size()));
  maker.add(to, turn_to);
  maker.add_row(to, from, cut);
  return std::move(maker.made);
}

/// Returns the best pattern with at most `most` irregular vertices. It follows `n_cuts` cuts.
std::optional<Pattern> search(const Outline& outline, int most, int n_cuts) {
  if (const auto sides = sides_of(outline.turn); sides && sides->edges.size() < 6) {
    const int least = least_irregular_of(sides->edges);
    return least >= 0 && least <= most ? best_convex(outline, *sides) : std::nullopt;
  }
  if (n_cuts == 0) return std::nullopt;
  std::optional<Pattern> best;
  for (const Cut& c : CutSearch(outline, most).first(n_cuts)) {
    if (c.irregular > most) break;
    Pattern pattern{Pattern::kCut, c.from, c.along, c.back, c.to, c.edges};
    pattern.strain = c.strain;
    const Outline halves[2] = {
        part_of(outline, c.from, c.to, 2 - c.along, 2 - c.back, c.edges),
        part_of(outline, c.to, c.from, outline.turn[c.to] + c.back, outline.turn[c.from] + c.along, c.edges)};
    for (const Outline& half : halves) {
      auto part =
          search(half, most - irregular_vertices(pattern), (n_cuts + kFewerOfParts / 2) / kFewerOfParts);
      if (!part) break;
      pattern.strain += part->strain;
      pattern.parts.push_back(*std::move(part));
    }
    if (pattern.parts.size() < 2) continue;
    const int irregular = irregular_vertices(pattern);
    if (!best || irregular < most || pattern.strain < best->strain) best = std::move(pattern);
    most = irregular;
  }
  return best;
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
      int sum = 0;
      for (const Pattern& part : pattern.parts) sum += irregular_vertices(part);
      return sum;
  }
}

std::optional<Pattern> best_pattern(const Outline& outline, int most) {
  assert(outline.delta.size() == outline.places.size() && outline.turn.size() == outline.places.size());
  return search(outline, most, kMostCuts);
}

}  // namespace delquad
