// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/mesh_by_outline.h"

#include <fmt/format.h>

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <map>

#include "base/disjoint_sets.h"
#include "base/predicates.h"
#include "delquad/error.h"

namespace delquad::cad {

namespace {

/// An end of a passage, at which the face's boundary arrives or leaves.
struct End {
  int point;
  bool arrives;
};

class OutlineBuilder {
 public:
  OutlineBuilder(const TopoDS_Face& face, EdgeChords& chords, bool collapses)
      : face_(face), chords_(chords), surface_(BRep_Tool::Surface(face)), collapses_(collapses) {}

  FaceOutline build() {
    for (TopExp_Explorer edge(face_, TopAbs_EDGE); edge.More(); edge.Next())
      if (edge.Current().Orientation() != TopAbs_EXTERNAL) add(TopoDS::Edge(edge.Current()));
    if (outline_.passages.empty()) throw InputError("has no boundary");
    same_ = DisjointSets(outline_.uv.size());
    for (auto& [vertex, ends] : ends_) join(vertex, ends);
    join_equal_points();
    renumber();
    return std::move(outline_);
  }

 private:
  void add(const TopoDS_Edge& edge) {
    double first, last;
    const Handle(Geom2d_Curve) flat = BRep_Tool::CurveOnSurface(edge, face_, first, last);
    if (flat.IsNull()) throw InputError("an edge has no curve in its parameters");
    if (collapses_ && BRep_Tool::Degenerated(edge) && collapse(edge, *flat, first, last)) return;
    double from, to;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, from, to);
    const std::vector<double>& parameters = chords_.of(edge);
    EdgePassage& passage = outline_.passages.emplace_back(EdgePassage{edge, {}});
    for (const double t : parameters) {
      passage.points.push_back(static_cast<int>(outline_.uv.size()));
      const gp_Pnt2d uv = flat->Value(parameter_on(t, first, last, parameters));
      outline_.uv.push_back({uv.X(), uv.Y()});
      outline_.points.push_back(curve.IsNull() ? vec_of(surface_->Value(uv.X(), uv.Y()))
                                               : vec_of(curve->Value(t)));
    }
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    const bool is_reversed = edge.Orientation() == TopAbs_REVERSED;
    add_end(TopExp::FirstVertex(forward), passage.points.front(), is_boundary(edge), is_reversed);
    add_end(TopExp::LastVertex(forward), passage.points.back(), is_boundary(edge), !is_reversed);
  }

  gp_Pnt on_surface(Vec2 uv) const { return surface_->Value(uv.x, uv.y); }

  /// Stores the path of a degenerate edge through its vertex. Returns false at a pole, which is one point.
  bool collapse(const TopoDS_Edge& edge, const Geom2d_Curve& flat, double first, double last) {
    constexpr int kSamples = 16;
    std::vector<Vec2> passed;
    double length = 0;
    for (int k = 0; k <= kSamples; ++k) {
      const gp_Pnt2d uv = flat.Value(first + (last - first) * k / kSamples);
      passed.push_back({uv.X(), uv.Y()});
      length = std::max(length, on_surface(passed.back()).Distance(on_surface(passed.front())));
    }
    if (length <= Precision::Confusion()) return false;
    passed_[vertices_.Add(TopExp::FirstVertex(edge))] = std::move(passed);
    return true;
  }

  /// Returns the parameter in space, since the curve in parameters may have another range.
  static double parameter_on(double t, double first, double last, const std::vector<double>& parameters) {
    const double a = parameters.front(), b = parameters.back();
    return b > a ? first + (t - a) * ((last - first) / (b - a)) : t;
  }

  void add_end(const TopoDS_Vertex& vertex, int point, bool bounds, bool arrives) {
    if (vertex.IsNull()) throw InputError("an edge of its boundary has an open end");
    outline_.points[point] = vec_of(BRep_Tool::Pnt(vertex));
    if (bounds) ends_[vertices_.Add(vertex)].push_back({point, arrives});
  }

  /// Joins the ends at a vertex in pairs, nearest first: one that arrives and one that leaves.
  void join(int vertex, const std::vector<End>& ends) {
    std::vector<std::pair<double, std::pair<int, int>>> pairs;
    for (const End& a : ends)
      for (const End& b : ends)
        if (a.arrives && !b.arrives) {
          const Vec2 d = outline_.uv[a.point] - outline_.uv[b.point];
          pairs.push_back({dot(d, d), {a.point, b.point}});
        }
    std::ranges::sort(pairs);
    std::size_t n_joined = 0;
    for (const auto& [distance2, pair] : pairs) {
      const auto [a, b] = pair;
      if (joined_.contains(a) || joined_.contains(b)) continue;
      joined_[a] = joined_[b] = true;
      same_.join(a, b);
      if (collapses_) outline_.uv[std::min(a, b)] = nearest(vertex, {outline_.uv[a], outline_.uv[b]});
      n_joined += 2;
    }
    if (n_joined == ends.size()) return;
    const gp_Pnt p = BRep_Tool::Pnt(TopoDS::Vertex(vertices_(vertex)));
    throw InputError(fmt::format("its boundary is open at ({:g}, {:g}, {:g})", p.X(), p.Y(), p.Z()));
  }

  /// Returns the parameters with the place nearest to a vertex, of `uv` and of degenerate edges there.
  Vec2 nearest(int vertex, std::vector<Vec2> uv) const {
    if (const auto passed = passed_.find(vertex); passed != passed_.end() && ends_.at(vertex).size() == 2)
      uv.insert(uv.end(), passed->second.begin(), passed->second.end());
    const gp_Pnt at = BRep_Tool::Pnt(TopoDS::Vertex(vertices_(vertex)));
    return *std::ranges::min_element(uv, {}, [&](Vec2 x) { return on_surface(x).SquareDistance(at); });
  }

  /// Joins points with the same parameters: where wires touch, and on both sides of a slit.
  void join_equal_points() {
    std::map<std::pair<double, double>, int> at;
    for (int i = 0; i < std::ssize(outline_.uv); ++i) {
      const Vec2 own = outline_.uv[same_.root(i)];
      same_.join(at.try_emplace({own.x, own.y}, i).first->second, i);
    }
  }

  void renumber() {
    std::vector<int> number(same_.size(), -1);
    int n = 0;
    for (int i = 0; i < std::ssize(outline_.uv); ++i) {
      if (same_.root(i) != i) continue;
      number[i] = n;
      outline_.uv[n] = outline_.uv[i];
      outline_.points[n++] = outline_.points[i];
    }
    outline_.uv.resize(static_cast<std::size_t>(n));
    outline_.points.resize(static_cast<std::size_t>(n));
    for (EdgePassage& passage : outline_.passages)
      for (int& point : passage.points) point = number[same_.root(point)];
  }

  TopoDS_Face face_;
  EdgeChords& chords_;
  Handle(Geom_Surface) surface_;
  bool collapses_;
  FaceOutline outline_;
  TopTools_IndexedMapOfShape vertices_;
  std::map<int, std::vector<End>> ends_;     ///< by vertex
  std::map<int, std::vector<Vec2>> passed_;  ///< parameters that collapsed edges pass, by vertex
  std::map<int, bool> joined_;               ///< points
  DisjointSets same_;                        ///< joined points
};

struct Chord {
  int a, b;
  Vec2 p, q;
  OutlineChord of;
};

bool boxes_meet(const Chord& c, const Chord& d) {
  const auto meet = [](double a, double b, double p, double q) {
    return std::min(a, b) <= std::max(p, q) && std::min(p, q) <= std::max(a, b);
  };
  return meet(c.p.x, c.q.x, d.p.x, d.q.x) && meet(c.p.y, c.q.y, d.p.y, d.q.y);
}

/// Returns whether two chords meet except at common ends.
bool cross(const Chord& c, const Chord& d) {
  if (!boxes_meet(c, d)) return false;
  const bool same_ends = std::minmax(c.a, c.b) == std::minmax(d.a, d.b);
  if (same_ends) return false;  // both sides of a slit
  const int c1 = orient2d(c.p, c.q, d.p), c2 = orient2d(c.p, c.q, d.q), d1 = orient2d(d.p, d.q, c.p),
            d2 = orient2d(d.p, d.q, c.q);
  if (c.a == d.a || c.a == d.b || c.b == d.a || c.b == d.b) {
    // With one common end, they overlap if they have the same direction there.
    if (c1 != 0 || c2 != 0) return false;
    const Vec2 common = c.a == d.a || c.a == d.b ? c.p : c.q;
    const Vec2 u = common == c.p ? c.q - c.p : c.p - c.q, v = common == d.p ? d.q - d.p : d.p - d.q;
    return dot(u, v) > 0;
  }
  if (c1 * c2 > 0 || d1 * d2 > 0) return false;
  return true;  // also on one line: their boxes meet
}

}  // namespace

FaceOutline outline_of(const TopoDS_Face& face, EdgeChords& chords, bool collapses) {
  return OutlineBuilder(face, chords, collapses).build();
}

PatchBoundary boundary_of(const FaceOutline& outline, Vec2 scale) {
  PatchBoundary boundary;
  for (const Vec2 uv : outline.uv) boundary.points.push_back({uv.x * scale.x, uv.y * scale.y});
  for (const EdgePassage& passage : outline.passages) {
    for (std::size_t k = 0; k + 1 < passage.points.size(); ++k) {
      const int a = passage.points[k], b = passage.points[k + 1];
      if (a == b) continue;
      if (passage.edge.Orientation() != TopAbs_REVERSED) boundary.edges.push_back({a, b});
      if (passage.edge.Orientation() != TopAbs_FORWARD) boundary.edges.push_back({b, a});
    }
  }
  return boundary;
}

std::vector<OutlineChord> crossing_chords(const FaceOutline& outline, Vec2 scale) {
  std::vector<Chord> all;
  const auto scaled = [&](int i) { return Vec2{outline.uv[i].x * scale.x, outline.uv[i].y * scale.y}; };
  for (int s = 0; s < std::ssize(outline.passages); ++s) {
    const std::vector<int>& points = outline.passages[s].points;
    for (int k = 0; k + 1 < std::ssize(points); ++k)
      if (points[k] != points[k + 1])
        all.push_back({points[k], points[k + 1], scaled(points[k]), scaled(points[k + 1]), {s, k}});
  }
  const auto left = [](const Chord& c) { return std::min(c.p.x, c.q.x); };
  std::ranges::sort(all, {}, left);
  std::vector<char> crosses(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double right = std::max(all[i].p.x, all[i].q.x);
    for (std::size_t j = i + 1; j < all.size() && left(all[j]) <= right; ++j)
      if (cross(all[i], all[j])) crosses[i] = crosses[j] = 1;
  }
  std::vector<OutlineChord> found;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (crosses[i] != 0) found.push_back(all[i].of);
  return found;
}

}  // namespace delquad::cad
