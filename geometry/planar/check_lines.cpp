// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/check_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/box.h"
#include "base/predicates.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// Spread of z, relative to the extent in x and y, that counts as rounding of a plane z = constant.
constexpr double kFlatness = 1e-9;

class LineArranger {
 public:
  LineArranger(const Mesh& mesh, const BoundaryNames& names) : mesh_(mesh), names_(names) {}

  Arrangement run() {
    check_ranges();
    collect_nodes();
    check_coordinates();
    check_lines();
    check_coincidence();
    std::vector<Vec2> points;
    points.reserve(mesh_.points.size());
    for (const Vec3& p : mesh_.points) points.push_back({p.x, p.y});
    Arrangement arrangement = arrange(points, mesh_.lines);
    if (arrangement.conflict) report_meeting((*arrangement.conflict)[0], (*arrangement.conflict)[1]);
    check_closed(arrangement);
    return arrangement;
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(names_.prefix() + fmt::format(format, std::forward<Args>(args)...));
  }

  Vec2 at(int v) const {
    const Vec3& p = mesh_.points[static_cast<std::size_t>(v)];
    return {p.x, p.y};
  }
  std::string place(int v) const { return fmt::format("({}, {})", at(v).x, at(v).y); }
  const std::array<int, 2>& line(int l) const { return mesh_.lines[static_cast<std::size_t>(l)]; }
  std::string curve(int l) const { return names_.curve(mesh_.line_curve[static_cast<std::size_t>(l)]); }
  std::string curve_at(int v) const { return curve(lines_at_[v][0]); }
  std::size_t valence(int v) const { return lines_at_[v].size(); }
  bool lexicographic(int v, int w) const {
    const Vec2 a = at(v), b = at(w);
    return std::tie(a.x, a.y, v) < std::tie(b.x, b.y, w);
  }

  void check_ranges() const {
    if (mesh_.lines.empty()) fail("there are no lines: nothing bounds a domain [empty-domain]");
    if (mesh_.line_curve.size() != mesh_.lines.size())
      fail("{} lines have {} curves: expected one for each", mesh_.lines.size(), mesh_.line_curve.size());
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      if (static_cast<std::size_t>(mesh_.line_curve[l]) >= mesh_.curves.size())
        fail("line {} lies on curve {}, which does not exist", l + 1, mesh_.line_curve[l]);
      for (int v : mesh_.lines[l])
        if (static_cast<std::size_t>(v) >= mesh_.points.size())
          fail("line {} has node {}, which does not exist", l + 1, v);
    }
  }

  // Lines of each node, and the nodes that have any.
  void collect_nodes() {
    lines_at_.resize(mesh_.points.size());
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      for (int v : mesh_.lines[l]) lines_at_[v].push_back(static_cast<int>(l));
    for (std::size_t v = 0; v < mesh_.points.size(); ++v)
      if (valence(static_cast<int>(v)) > 0) used_.push_back(static_cast<int>(v));
  }

  void check_coordinates() const {
    const Vec3& first = mesh_.points[static_cast<std::size_t>(used_[0])];
    Box<Vec3> box{first, first};
    for (int v : used_) {
      const Vec3& p = mesh_.points[static_cast<std::size_t>(v)];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail("a node of {} is at ({}, {}, {}): expected finite coordinates", curve_at(v), p.x, p.y, p.z);
      box.add(p);
    }
    const Vec3 size = box.size();
    if (size.z > kFlatness * std::max(size.x, size.y))
      fail("the lines are not in a plane z = constant: z goes from {} to {} [not-planar]", box.low.z,
           box.high.z);
  }

  void check_lines() const {
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      const auto [a, b] = mesh_.lines[l];
      if (a == b || at(a) == at(b))
        fail("a line of {} has no length: both ends are at {}", curve(static_cast<int>(l)), place(a));
    }
    if (used_.size() < 3) fail("the boundary has only {} nodes: expected at least three", used_.size());
  }

  void check_coincidence() {
    std::ranges::sort(used_, [&](int v, int w) { return lexicographic(v, w); });
    for (std::size_t i = 1; i < used_.size(); ++i) {
      const int v = used_[i - 1], w = used_[i];
      if (at(v) != at(w)) continue;
      if (cross_there(v, w))
        fail("lines of {} and {} cross at {} [crossing-curves]", curve_at(v), curve_at(w), place(v));
      fail("two nodes coincide at {}, on {} and on {}: expected one node, which both lines share", place(v),
           curve_at(v), curve_at(w));
    }
    std::vector<int> order(mesh_.lines.size());
    std::iota(order.begin(), order.end(), 0);
    const auto ends = [&](int l) { return std::pair<int, int>(std::minmax(line(l)[0], line(l)[1])); };
    std::ranges::sort(order, {}, [&](int l) { return std::pair(ends(l), l); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      const int l = order[i - 1], m = order[i];
      const auto [v, w] = ends(l);
      if (ends(m) != ends(l)) continue;
      if (valence(v) == 2 && valence(w) == 2)
        fail("the loop through {} and {} of {} has only two nodes: expected at least three", place(v),
             place(w), curve(l));
      fail("the line from {} to {} is there twice, on {} and on {}: expected it once", place(v), place(w),
           curve(l), curve(m));
    }
  }

  /// Returns whether the lines of two nodes at one place, each with two lines, cross there.
  bool cross_there(int v, int w) const {
    if (valence(v) != 2 || valence(w) != 2) return false;
    const auto end = [&](int node, std::size_t k) {
      const auto [a, b] = line(lines_at_[node][k]);
      return at(a == node ? b : a);
    };
    const Vec2 x = at(v), a = end(v, 0), b = end(v, 1);
    const auto side = [&](Vec2 p) {  // 1: counter-clockwise from a to b; 0: on one of the two
      const int from_a = orient2d(x, a, p), to_b = orient2d(x, p, b);
      if (from_a == 0 && dot(a - x, p - x) > 0) return 0;
      if (to_b == 0 && dot(b - x, p - x) > 0) return 0;
      const bool is_within = orient2d(x, a, b) > 0 ? from_a > 0 && to_b > 0 : from_a > 0 || to_b > 0;
      return is_within ? 1 : -1;
    };
    return side(end(w, 0)) * side(end(w, 1)) < 0;
  }

  void check_closed(const Arrangement& arrangement) const {
    const auto is_open = [&](int l) {
      return arrangement.has_one_face(l) && arrangement.face_of[2 * l] < 0 &&
             mesh_.line_curve[static_cast<std::size_t>(l)] != names_.dangling;
    };
    std::vector<int> ends;
    for (int v : used_)
      if (valence(v) == 1 && is_open(lines_at_[v][0])) ends.push_back(v);
    if (ends.size() == 1)
      fail("{} ends at {}, outside of every region [embedded-outside]", curve_at(ends[0]), place(ends[0]));
    if (ends.size() > 1)
      fail("the boundary is open: it has {} loose ends, at {} of {} and at {} of {} [open-outline]",
           ends.size(), place(ends[0]), curve_at(ends[0]), place(ends[1]), curve_at(ends[1]));
    for (int l = 0; l < static_cast<int>(mesh_.lines.size()); ++l)
      if (is_open(l))
        fail("{} bounds no region and lies in none from {} to {}: remove it, or close it to a loop", curve(l),
             place(line(l)[0]), place(line(l)[1]));
  }

  [[noreturn]] void report_meeting(int l, int m) const {
    const auto [a, b] = line(l);
    const auto [c, d] = line(m);
    const std::string hint = names_.crossing_hint.empty() ? "" : "; " + names_.crossing_hint;
    const int oc = orient2d(at(a), at(b), at(c)), od = orient2d(at(a), at(b), at(d));
    const int oa = orient2d(at(c), at(d), at(a)), ob = orient2d(at(c), at(d), at(b));
    if (oc == 0 && od == 0) {
      std::array ends{a, b, c, d};
      std::ranges::sort(ends, [&](int v, int w) { return lexicographic(v, w); });
      fail("lines of {} and {} overlap between {} and {}{}", curve(l), curve(m), place(ends[1]),
           place(ends[2]), hint);
    }
    if (oc * od != 0 && oa * ob != 0) {
      const Vec2 u = at(b) - at(a), w = at(d) - at(c);
      const Vec2 x = at(a) + (cross(at(c) - at(a), w) / cross(u, w)) * u;
      fail("lines of {} and {} cross at ({:.10g}, {:.10g}){} [crossing-curves]", curve(l), curve(m), x.x, x.y,
           hint);
    }
    const bool on_first = oc == 0 || od == 0;
    const int node = oc == 0 ? c : od == 0 ? d : oa == 0 ? a : b;
    fail("the node at {} of {} touches a line of {}{}", place(node), curve(on_first ? m : l),
         curve(on_first ? l : m), hint);
  }

  const Mesh& mesh_;
  const BoundaryNames& names_;
  std::vector<std::vector<int>> lines_at_;  ///< nodes
  std::vector<int> used_;  ///< nodes with lines; sorted by coordinates once these are known to be finite
};

}  // namespace

BoundaryNames names_of_curves(const Mesh& lines, const std::string& source) {
  // Captures by value, since the mesh may move while the names are in use.
  const auto label = [curves = lines.curves](int c) {
    const Entity& curve = curves[static_cast<std::size_t>(c)];
    return curve.names.empty() ? fmt::format("curve {}", curve.tag)
                               : fmt::format("curve '{}'", fmt::join(curve.names, "', '"));
  };
  return {source, label, ""};
}

Arrangement arrange_lines(const Mesh& lines, const BoundaryNames& names) {
  return LineArranger(lines, names).run();
}

}  // namespace delquad
