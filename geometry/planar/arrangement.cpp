// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/arrangement.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <span>

#include "base/cancel.h"
#include "base/disjoint_sets.h"
#include "base/predicates.h"

namespace delquad {

namespace {

using Lines = std::vector<std::array<int, 2>>;

bool before(Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

/// Sides that leave each point, counterclockwise: to the right from bottom to top, then to the left from top
/// to bottom.
class Fans {
 public:
  Fans(const std::vector<Vec2>& points, const Lines& lines)
      : points_(points), lines_(lines), first_(points.size() + 1, 0), sides_(2 * lines.size()) {
    for (const auto& line : lines)
      for (const int v : line) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (int s = 0; s < static_cast<int>(sides_.size()); ++s) sides_[next[start(s)]++] = s;
    place_.resize(sides_.size());
    for (int v = 0; v < static_cast<int>(points.size()); ++v) sort(v);
  }

  int start(int side) const { return start_of(lines_, side); }
  int end(int side) const { return start(side ^ 1); }
  bool goes_right(int side) const { return before(points_[start(side)], points_[end(side)]); }
  std::span<const int> at(int v) const {
    return {sides_.data() + first_[v], static_cast<std::size_t>(first_[v + 1] - first_[v])};
  }
  /// Returns the number of sides to the right; they come first.
  int n_right(int v) const {
    const auto fan = at(v);
    return static_cast<int>(std::ranges::partition_point(fan, [&](int s) { return goes_right(s); }) -
                            fan.begin());
  }
  /// Returns two sides that leave a point in the same direction, if any.
  const std::optional<std::array<int, 2>>& overlap() const { return overlap_; }
  /// Returns the next side with the same face on its left: the sharpest turn to the left.
  int next(int side) const {
    const int v = end(side);
    const int at = place_[side ^ 1];
    return sides_[at == first_[v] ? first_[v + 1] - 1 : at - 1];
  }

 private:
  int turn(int a, int b) const { return orient2d(points_[start(a)], points_[end(a)], points_[end(b)]); }

  void sort(int v) {
    const auto begin = sides_.begin() + first_[v], last = sides_.begin() + first_[v + 1];
    std::sort(begin, last, [&](int a, int b) {
      const bool ra = goes_right(a), rb = goes_right(b);
      if (ra != rb) return ra;
      return turn(a, b) > 0;
    });
    for (auto i = begin; i != last; ++i) {
      place_[*i] = static_cast<int>(i - sides_.begin());
      if (i == begin || overlap_) continue;
      if (goes_right(*i) == goes_right(*(i - 1)) && turn(*(i - 1), *i) == 0)
        overlap_ = {{*(i - 1) / 2, *i / 2}};
    }
  }

  const std::vector<Vec2>& points_;
  const Lines& lines_;
  std::vector<int> first_, sides_;
  std::vector<int> place_;  ///< place of each side in sides_
  std::optional<std::array<int, 2>> overlap_;
};

/// Sweep of a line from left to right, bottom to top. All decisions are signs of areas of triangles of given
/// points, and thus exact.
class Sweep {
 public:
  Sweep(const std::vector<Vec2>& points, const Fans& fans, std::size_t n_lines)
      : points_(points), fans_(fans), below_(points.size(), -1), status_(Below{*this}), position_(n_lines) {}

  /// Returns two lines that meet, if any do.
  std::optional<std::array<int, 2>> run() {
    std::vector<int> events;
    for (int v = 0; v < static_cast<int>(points_.size()); ++v)
      if (!fans_.at(v).empty()) events.push_back(v);
    std::ranges::sort(events, [&](int a, int b) { return before(points_[a], points_[b]); });
    for (const int v : events) {
      check_cancelled();
      visit(v);
      if (conflict_) break;
    }
    return conflict_;
  }

  /// Returns the side that runs to the right just below a point without lines from the left; -1: none.
  int below(int v) const { return below_[v]; }

 private:
  /// Order of sides to the right, by height.
  struct Below {
    using is_transparent = void;
    const Sweep& sweep;
    bool operator()(int a, int b) const { return sweep.is_below(a, b); }
    bool operator()(int s, Vec2 p) const { return sweep.side(s, p) > 0; }
  };
  using Status = std::set<int, Below>;

  Vec2 left(int s) const { return points_[fans_.start(s)]; }
  Vec2 right(int s) const { return points_[fans_.end(s)]; }
  /// Returns +1 if p is above the line of a side, -1 below, 0 on it.
  int side(int s, Vec2 p) const { return orient2d(left(s), right(s), p); }

  // Orders two lines that cross the sweep line, by the one that begins later.
  bool is_below(int a, int b) const {
    if (fans_.start(a) == fans_.start(b)) return side(a, right(b)) > 0;
    if (before(left(a), left(b))) return side(a, left(b)) > 0;
    return side(b, left(a)) < 0;
  }

  void visit(int v) {
    const auto fan = fans_.at(v);
    const int n_right = fans_.n_right(v);
    for (const int s : fan.subspan(n_right)) status_.erase(position_[s / 2]);
    const Status::iterator above = status_.lower_bound(points_[v]);
    const int next = above == status_.end() ? -1 : *above;
    const int previous = above == status_.begin() ? -1 : *std::prev(above);
    if (next >= 0 && side(next, points_[v]) == 0) return report(next, fan[0]);
    below_[v] = previous;
    if (n_right == 0) return check(previous, next);
    check(previous, fan[0]);
    check(fan[n_right - 1], next);
    if (conflict_) return;
    for (const int s : fan.first(n_right)) position_[s / 2] = status_.insert(above, s);
  }

  // Checks two neighbors. Lines with a common end cannot meet elsewhere, and a point on a line is found when
  // the sweep reaches it.
  void check(int a, int b) {
    if (a < 0 || b < 0 || conflict_) return;
    if (fans_.start(a) == fans_.start(b) || fans_.end(a) == fans_.end(b)) return;
    const int al = side(a, left(b)), ar = side(a, right(b));
    const int bl = side(b, left(a)), br = side(b, right(a));
    if (al * ar <= 0 && bl * br <= 0 && (al != 0 || ar != 0)) report(a, b);
  }

  void report(int a, int b) { conflict_ = {{std::min(a / 2, b / 2), std::max(a / 2, b / 2)}}; }

  const std::vector<Vec2>& points_;
  const Fans& fans_;
  std::vector<int> below_;
  Status status_;
  std::vector<Status::iterator> position_;  ///< of each line
  std::optional<std::array<int, 2>> conflict_;
};

class Arranger {
 public:
  Arranger(const std::vector<Vec2>& points, const Lines& lines)
      : points_(points), lines_(lines), fans_(points, lines), sweep_(points, fans_, lines.size()) {}

  Arrangement run() {
    Arrangement result;
    result.conflict = fans_.overlap() ? fans_.overlap() : sweep_.run();
    if (result.conflict) return result;
    walk_cycles();
    std::vector<int> face(cycles_.size(), -1);
    for (std::size_t c = 0; c < cycles_.size(); ++c) {
      if (cycles_[c].is_contour) continue;
      face[c] = static_cast<int>(result.faces.size());
      result.faces.push_back({{cycles_[c].sides}});
    }
    // A contour below another one's first point begins farther to the left: its cycle comes before.
    for (std::size_t c = 0; c < cycles_.size(); ++c) {
      if (!cycles_[c].is_contour) continue;
      const int below = sweep_.below(fans_.start(cycles_[c].sides[0]));
      if (below >= 0) face[c] = face[cycle_of_[below]];
      (face[c] < 0 ? result.outside : result.faces[face[c]].cycles).push_back(cycles_[c].sides);
    }
    for (const int cycle : cycle_of_) result.face_of.push_back(face[cycle]);
    set_around(result);
    return result;
  }

 private:
  struct Cycle {
    std::vector<int> sides;
    bool is_contour;  ///< goes around lines from outside
  };

  /// Lists the cycles in the order of their first points: at a point the contour first, then inner faces from
  /// bottom to top.
  void walk_cycles() {
    std::vector<int> order(points_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](int a, int b) { return before(points_[a], points_[b]); });
    cycle_of_.assign(2 * lines_.size(), -1);
    for (const int v : order) {
      const auto fan = fans_.at(v);
      // No side of an unknown cycle lies farther to the left. If no line does, the cycle is a contour.
      if (!fan.empty() && cycle_of_[fan.back()] < 0) add_cycle(fan.back(), fans_.goes_right(fan.back()));
      for (const int side : fan)
        if (cycle_of_[side] < 0) add_cycle(side, false);
    }
  }

  void add_cycle(int first, bool is_contour) {
    Cycle& cycle = cycles_.emplace_back(Cycle{{}, is_contour});
    int side = first;
    do {
      cycle.sides.push_back(side);
      cycle_of_[side] = static_cast<int>(cycles_.size()) - 1;
      side = fans_.next(side);
    } while (side != first);
  }

  /// Sets the face around each component, which is on the left of its contour.
  void set_around(Arrangement& result) const {
    DisjointSets components(points_.size());
    for (const auto& [a, b] : lines_) components.join(a, b);
    std::vector<int> around(points_.size(), -1);
    for (const Cycle& cycle : cycles_)
      if (cycle.is_contour)
        around[components.root(fans_.start(cycle.sides[0]))] = result.face_of[cycle.sides[0]];
    for (Arrangement::Face& face : result.faces) {
      face.component = components.root(fans_.start(face.cycles[0][0]));
      face.around = around[face.component];
    }
  }

  const std::vector<Vec2>& points_;
  const Lines& lines_;
  Fans fans_;
  Sweep sweep_;
  std::vector<Cycle> cycles_;
  std::vector<int> cycle_of_;  ///< of each side
};

}  // namespace

Arrangement arrange(const std::vector<Vec2>& points, const std::vector<std::array<int, 2>>& lines) {
  return Arranger(points, lines).run();
}

}  // namespace delquad
