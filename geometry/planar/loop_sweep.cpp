#include "geometry/planar/loop_sweep.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "base/cancel.h"
#include "base/predicates.h"

namespace delquad {

namespace {

bool before(Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

/// A line as the sweep sees it: from left to right (bottom to top when vertical).
struct Segment {
  int left, right;
  int loop, line;
  bool reversed;  ///< the loop runs from right to left
};

/// The sweep line goes from left to right, bottom to top. Between the two ends of a line all decisions are
/// signs of areas of triangles of given points, hence exact.
class Sweep {
 public:
  Sweep(const std::vector<Vec2>& points, const std::vector<std::vector<int>>& loops)
      : points_(points), at_node_(points.size(), {-1, -1}), status_(Below{*this}) {
    nesting_.parent.assign(loops.size(), -1);
    entered_.assign(loops.size(), false);
    for (std::size_t l = 0; l < loops.size(); ++l) add_loop(loops[l], static_cast<int>(l));
    position_.assign(segments_.size(), status_.end());
  }

  LoopNesting run() {
    std::vector<int> events;
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (at_node_[v].first >= 0) events.push_back(static_cast<int>(v));
    std::ranges::sort(events, [&](int a, int b) { return before(point(a), point(b)); });
    for (int v : events) {
      check_cancelled();
      visit(v);
      if (nesting_.conflict) break;
    }
    return std::move(nesting_);
  }

 private:
  struct Below {
    using is_transparent = void;
    const Sweep& sweep;
    bool operator()(int a, int b) const { return sweep.below(a, b); }
    bool operator()(int s, Vec2 p) const { return sweep.side(s, p) > 0; }
  };
  using Status = std::set<int, Below>;

  Vec2 point(int v) const { return points_[static_cast<std::size_t>(v)]; }
  const Segment& segment(int s) const { return segments_[static_cast<std::size_t>(s)]; }
  /// +1: p above the segment's line, -1: below.
  int side(int s, Vec2 p) const { return orient2d(point(segment(s).left), point(segment(s).right), p); }

  // Order of two segments that both cross the sweep line: told by the one that begins later.
  bool below(int a, int b) const {
    const Segment &sa = segment(a), &sb = segment(b);
    if (sa.left == sb.left) return side(a, point(sb.right)) > 0;
    if (before(point(sa.left), point(sb.left))) return side(a, point(sb.left)) > 0;
    return side(b, point(sa.left)) < 0;
  }

  void add_loop(const std::vector<int>& nodes, int loop) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const int a = nodes[k], b = nodes[(k + 1) % nodes.size()];
      const bool reversed = before(point(b), point(a));
      const int s = static_cast<int>(segments_.size());
      segments_.push_back({reversed ? b : a, reversed ? a : b, loop, static_cast<int>(k), reversed});
      at_node_[static_cast<std::size_t>(a)].second = s;
      at_node_[static_cast<std::size_t>(b)].first = s;
    }
  }

  void visit(int v) {
    const auto [in, out] = at_node_[static_cast<std::size_t>(v)];
    std::vector<int> beginning;
    for (int s : {in, out}) {
      if (segment(s).right == v)
        status_.erase(position_[static_cast<std::size_t>(s)]);
      else
        beginning.push_back(s);
    }
    const Status::iterator above = status_.lower_bound(point(v));
    const int next = above == status_.end() ? -1 : *above;
    const int previous = above == status_.begin() ? -1 : *std::prev(above);
    if (next >= 0 && side(next, point(v)) == 0) return report(next, in);
    if (beginning.size() == 2) {
      const int turn = side(beginning[0], point(segment(beginning[1]).right));
      if (turn == 0) return report(beginning[0], beginning[1]);
      if (turn < 0) std::swap(beginning[0], beginning[1]);
    }
    if (beginning.empty()) return check(previous, next);
    check(previous, beginning.front());
    check(beginning.back(), next);
    if (nesting_.conflict) return;
    enter(segment(in).loop, previous);
    for (int s : beginning) position_[static_cast<std::size_t>(s)] = status_.insert(above, s);
  }

  // The first node of a loop: what lies just above the segment below it is what is around the loop.
  void enter(int loop, int segment_below) {
    const auto l = static_cast<std::size_t>(loop);
    if (entered_[l]) return;
    entered_[l] = true;
    if (segment_below < 0) return;
    const Segment& s = segment(segment_below);
    nesting_.parent[l] = s.reversed ? nesting_.parent[static_cast<std::size_t>(s.loop)] : s.loop;
  }

  // Neighbours with a common end cannot meet elsewhere: a node on a line is found when the sweep reaches it.
  void check(int a, int b) {
    if (a < 0 || b < 0 || nesting_.conflict) return;
    const Segment &sa = segment(a), &sb = segment(b);
    if (sa.left == sb.left || sa.right == sb.right) return;
    const int al = side(a, point(sb.left)), ar = side(a, point(sb.right));
    const int bl = side(b, point(sa.left)), br = side(b, point(sa.right));
    if (al * ar <= 0 && bl * br <= 0 && (al != 0 || ar != 0)) report(a, b);
  }

  void report(int a, int b) {
    if (std::pair(segment(b).loop, segment(b).line) < std::pair(segment(a).loop, segment(a).line))
      std::swap(a, b);
    nesting_.conflict = LineConflict{{segment(a).loop, segment(b).loop}, {segment(a).line, segment(b).line}};
  }

  const std::vector<Vec2>& points_;
  std::vector<Segment> segments_;
  std::vector<std::pair<int, int>> at_node_;  ///< the line into and the line out of each node
  Status status_;
  std::vector<Status::iterator> position_;
  std::vector<bool> entered_;
  LoopNesting nesting_;
};

}  // namespace

LoopNesting nest_loops(const std::vector<Vec2>& points, const std::vector<std::vector<int>>& loops) {
  return Sweep(points, loops).run();
}

}  // namespace delquad
