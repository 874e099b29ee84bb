// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/cancel.h"
#include "base/disjoint_sets.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/chart.h"
#include "geometry/surface/compound_projector.h"
#include "geometry/surface/ignore_small.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {

namespace {

/// Values in lengths. A part is narrow if it is narrower than kNarrow over kLasts. Places of looks across are
/// kApartOnLoop apart. Ends of cuts move into corners within kIntoCorner, and into other points within
/// kIntoPoint.
constexpr double kNarrow = 1.05, kLasts = 2, kApartOnLoop = 0.25, kIntoCorner = 0.25, kIntoPoint = 0.02;
/// Number of places without a look across that a narrow part may have in a row.
constexpr int kMissing = 2;
/// Sine of the largest angle between sides that face each other.
constexpr double kFacingSine = 0.5;
constexpr int kBisections = 20;
/// Limits of places of looks in all, and of triangles on a look: a few seconds.
constexpr double kMostPlaces = 1e6;
constexpr int kMostTriangles = 1000;

/// A place on a loop of a chart: the side from its vertex number `side`, and the part along it.
struct LoopPlace {
  int loop, side;
  double t;
};

/// Looks straight across a chart from its loops.
class ChartView {
 public:
  ChartView(const Chart& chart, double reach) : chart_(chart), reach_(reach) {
    std::map<std::array<int, 2>, LoopPlace> at;
    for (std::size_t l = 0; l < chart.loops.size(); ++l) {
      const auto& loop = chart.loops[l];
      auto& arc = arcs_.emplace_back(1, 0.0);
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::array ends{loop[i], loop[(i + 1) % loop.size()]};
        at[ends] = {static_cast<int>(l), static_cast<int>(i), 0};
        arc.push_back(arc.back() + norm(point(ends[1]) - point(ends[0])));
      }
      triangle_at_.emplace_back(loop.size(), std::array{-1, -1});
    }
    place_of_.resize(chart.triangles.size());
    for (std::size_t t = 0; t < chart.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (chart.neighbours[t][k] >= 0) continue;
        const auto& v = chart.triangles[t];
        const LoopPlace& place = at.at({v[(k + 1) % 3], v[(k + 2) % 3]});
        place_of_[t][k] = place;
        triangle_at_[place.loop][place.side] = {static_cast<int>(t), k};
      }
  }

  int n_loops() const { return static_cast<int>(arcs_.size()); }
  double length(int loop) const { return arcs_[loop].back(); }
  LoopPlace place(int loop, double s) const {
    const auto& arc = arcs_[loop];
    s -= std::floor(s / arc.back()) * arc.back();
    const auto next = std::upper_bound(arc.begin() + 1, arc.end() - 1, s);
    const double length = *next - *(next - 1);
    return {loop, static_cast<int>(next - arc.begin()) - 1,
            length > 0 ? std::clamp((s - *(next - 1)) / length, 0.0, 1.0) : 0};
  }
  double arc(const LoopPlace& p) const {
    const auto& arc = arcs_[p.loop];
    return arc[p.side] + p.t * (arc[p.side + 1] - arc[p.side]);
  }
  std::array<int, 2> ends(const LoopPlace& p) const {
    const auto& loop = chart_.loops[p.loop];
    return {loop[p.side], loop[(p.side + 1) % loop.size()]};
  }
  const Vec3& point(int vertex) const { return chart_.points[vertex]; }

  /// Returns the place straight across within the reach, if it faces this side.
  std::optional<LoopPlace> look(const LoopPlace& from) const {
    auto [t, k] = triangle_at_[from.loop][from.side];
    const auto [p, q] = ends(from);
    Vec3 x = point(p) + from.t * (point(q) - point(p));
    double left = reach_;
    // Direction by its components along the side and across it.
    double along = 0, across = 1;
    for (int step = 0; step < kMostTriangles; ++step) {
      const auto& v = chart_.triangles[t];
      const Vec3 &a = point(v[(k + 1) % 3]), &b = point(v[(k + 2) % 3]), &c = point(v[k]);
      const Vec3 side = b - a, normal = cross(side, c - a);
      if (!(norm(normal) > 0)) return std::nullopt;
      const Vec3 e = (1 / norm(side)) * side, up = cross((1 / norm(normal)) * normal, e);
      const Vec3 d = along * e + across * up;
      const bool to_left = dot(cross(d, c - x), normal) < 0;  // the apex is on the right
      const Vec3 &from_end = to_left ? c : b, &to_end = to_left ? a : c;
      const Vec3 out = to_end - from_end;
      const double over = dot(cross(d, out), normal);
      if (over == 0) return std::nullopt;
      const double way = dot(cross(from_end - x, out), normal) / over;
      const double part = dot(cross(from_end - x, d), normal) / over, u = std::clamp(part, 0.0, 1.0);
      left -= way;
      if (!(way >= 0) || left < 0) return std::nullopt;
      const int j = to_left ? (k + 2) % 3 : (k + 1) % 3;  // the corner opposite to that side
      const Vec3 f = (1 / norm(out)) * out;
      along = -dot(d, f);
      across = std::sqrt(std::max(0.0, 1 - along * along));
      x = from_end + u * out;
      const int beyond = chart_.neighbours[t][j];
      if (beyond < 0) {
        if (std::abs(along) > kFacingSine) return std::nullopt;
        LoopPlace seen = place_of_[t][j];
        seen.t = u;
        return seen;
      }
      const auto& back = chart_.neighbours[beyond];
      const int from_triangle = t;
      t = beyond;
      k = static_cast<int>(std::ranges::find(back, from_triangle) - back.begin());
    }
    return std::nullopt;
  }

 private:
  const Chart& chart_;
  double reach_;
  std::vector<std::vector<double>> arcs_;
  std::vector<std::vector<std::array<int, 2>>> triangle_at_;  ///< by loop and side: triangle, opposite corner
  std::vector<std::array<LoopPlace, 3>> place_of_;
};

/// The ends of a cut on a chart's loops.
using LoopCut = std::array<LoopPlace, 2>;

/// Finds the cuts of a chart.
class ChartCuts {
 public:
  /// `apart` is the distance of the places of looks.
  ChartCuts(const Chart& chart, const std::vector<char>& is_corner, double length, double apart)
      : view_(chart, kNarrow * length), length_(length), apart_(apart), corners_(chart.loops.size()) {
    for (int l = 0; l < view_.n_loops(); ++l) {
      const auto& loop = chart.loops[l];
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (is_corner[chart.fine_node[loop[i]]]) corners_[l].push_back({l, static_cast<int>(i), 0});
    }
  }

  std::vector<LoopCut> find() {
    for (int l = 0; l < view_.n_loops(); ++l) {
      const double n = std::ceil(view_.length(l) / apart_);
      n_.push_back(std::max(3, static_cast<int>(n)));
      auto& seen = seen_.emplace_back();
      for (int i = 0; i < n_[l]; ++i) seen.push_back(view_.look(view_.place(l, arc(l, i))));
      find_runs(l);
    }
    std::ranges::stable_sort(runs_, std::greater<>(), [](const Run& run) { return run.last - run.first; });
    for (const auto& s : seen_) done_.emplace_back(s.size(), 0);
    std::vector<LoopCut> cuts;
    for (const Run& run : runs_) add_cuts(run, cuts);
    return cuts;
  }

 private:
  /// A range of places, which may pass the loop's last.
  struct Run {
    int loop, first, last;
  };

  double arc(int loop, double i) const { return (i + 0.5) * view_.length(loop) / n_[loop]; }
  int index(int loop, int i) const { return (i % n_[loop] + n_[loop]) % n_[loop]; }
  bool sees(int loop, int i) const { return seen_[loop][index(loop, i)].has_value(); }

  void find_runs(int loop) {
    const int n = n_[loop];
    const auto ends_before = [&](int i) {  // nothing is seen over enough places
      for (int k = 1; k <= kMissing + 1; ++k)
        if (sees(loop, i - k)) return false;
      return true;
    };
    for (int first = 0; first < n; ++first) {
      if (!sees(loop, first) || !ends_before(first)) continue;
      int last = first;
      for (int i = first + 1; i < first + n && i <= last + kMissing + 1; ++i)
        if (sees(loop, i)) last = i;
      if ((last - first + 1) * view_.length(loop) / n >= kLasts * length_)
        runs_.push_back({loop, first, last});
    }
  }

  void add_cuts(const Run& run, std::vector<LoopCut>& cuts) {
    int n_done = 0;
    for (int i = run.first; i <= run.last; ++i) n_done += done_[run.loop][index(run.loop, i)];
    if (2 * n_done > run.last - run.first) return;
    for (int i = run.first; i <= run.last; ++i) {
      const auto& seen = seen_[run.loop][index(run.loop, i)];
      if (!seen) continue;
      const int at = static_cast<int>(view_.arc(*seen) / view_.length(seen->loop) * n_[seen->loop]);
      for (int k = -kMissing; k <= kMissing; ++k) done_[seen->loop][index(seen->loop, at + k)] = 1;
    }
    for (const auto& [in, out] : {std::array{run.first, run.first - 1}, {run.last, run.last + 1}}) {
      double seeing = arc(run.loop, in), blind = arc(run.loop, out);
      std::optional<LoopPlace> seen = seen_[run.loop][index(run.loop, in)];
      for (int step = 0; step < kBisections; ++step) {
        const double middle = 0.5 * (seeing + blind);
        const auto there = view_.look(view_.place(run.loop, middle));
        (there ? seeing : blind) = middle;
        if (there) seen = there;
      }
      const LoopCut cut{into_corner(view_.place(run.loop, seeing)), into_corner(*seen)};
      // A part that runs into a tip is cut at one place only.
      if (std::ranges::none_of(cuts, [&](const LoopCut& other) {
            return distance(cut[0], other[1]) < length_ && distance(cut[1], other[0]) < length_;
          }))
        cuts.push_back(cut);
    }
  }

  LoopPlace into_corner(const LoopPlace& p) const {
    LoopPlace best = p;
    double least = kIntoCorner * length_;
    for (const LoopPlace& corner : corners_[p.loop])
      if (const double d = distance(p, corner); d < least) best = corner, least = d;
    return best;
  }

  /// Returns the distance along the loop; infinity for places on other loops.
  double distance(const LoopPlace& p, const LoopPlace& q) const {
    if (p.loop != q.loop) return std::numeric_limits<double>::infinity();
    const double d = std::abs(view_.arc(p) - view_.arc(q));
    return std::min(d, view_.length(p.loop) - d);
  }

  ChartView view_;
  double length_, apart_;
  std::vector<std::vector<LoopPlace>> corners_;
  std::vector<int> n_;                                       ///< places, by loop
  std::vector<std::vector<std::optional<LoopPlace>>> seen_;  ///< place seen from each place
  std::vector<std::vector<char>> done_;
  std::vector<Run> runs_;
};

/// A place on the lines of a fine triangulation: a node (b < 0) or inside of the edge from a < b.
struct LinePlace {
  int a, b = -1;
  double t = 0;
};

class FaceCutter {
 public:
  FaceCutter(SurfaceModel& model, double length) : model_(model), mesh_(model.fine), length_(length) {}

  /// Makes the cuts. Returns the faces of the new curves.
  std::vector<int> cut() {
    find();
    SurfaceEditor editor(model_);
    for (auto& [edge, parts] : splits_) split(editor, edge, parts);
    std::vector<int> faces;
    for (const auto& [face, ends] : cuts_) {
      check_cancelled();
      const int p = node_of(ends[0]), q = node_of(ends[1]);
      if (p == q || editor.line_on(p, q) >= 0) continue;
      const std::vector<int> chain = connect(editor, face, p, q);
      if (chain.size() < 2) continue;
      editor.add_curve(chain);
      faces.push_back(face);
    }
    editor.finish();
    return faces;
  }

 private:
  struct Cut {
    int face;
    std::array<LinePlace, 2> ends;
  };

  void find() {
    std::vector<char> is_corner(mesh_.points.size(), 0), has_embedded(mesh_.regions.size(), 0);
    for (const int p : model_.corners) is_corner[p] = 1;
    for (const EmbeddedCurve& e : model_.embedded) has_embedded[e.face] = 1;
    double outline = 0;
    for (const auto& [a, b] : mesh_.lines) outline += 2 * norm(mesh_.points[b] - mesh_.points[a]);
    const double apart = std::max(kApartOnLoop * length_, outline / kMostPlaces);
    for (const Chart& chart : extract_charts(mesh_, std::vector<char>(mesh_.triangles.size(), 1))) {
      check_cancelled();
      if (has_embedded[chart.face]) continue;
      for (const LoopCut& cut : ChartCuts(chart, is_corner, length_, apart).find()) {
        Cut found{chart.face, {}};
        for (int i = 0; i < 2; ++i) found.ends[i] = line_place(chart, cut[i]);
        cuts_.push_back(found);
      }
    }
  }

  /// Returns the place in the fine triangulation, moved into a near node.
  LinePlace line_place(const Chart& chart, const LoopPlace& p) {
    const auto& loop = chart.loops[p.loop];
    const int a = chart.fine_node[loop[p.side]], b = chart.fine_node[loop[(p.side + 1) % loop.size()]];
    const double snap = kIntoPoint * length_ / norm(mesh_.points[b] - mesh_.points[a]);
    if (p.t <= snap) return {a};
    if (p.t >= 1 - snap) return {b};
    const LinePlace place = a < b ? LinePlace{a, b, p.t} : LinePlace{b, a, 1 - p.t};
    std::vector<std::pair<double, int>>& parts = splits_[{place.a, place.b}];
    for (const auto& [t, node] : parts)
      if (std::abs(t - place.t) <= snap) return {place.a, place.b, t};
    parts.emplace_back(place.t, -1);
    return place;
  }

  void split(SurfaceEditor& editor, const std::array<int, 2>& edge,
             std::vector<std::pair<double, int>>& parts) const {
    std::ranges::sort(parts, std::greater<>());
    const Vec3 a = mesh_.points[edge[0]], b = mesh_.points[edge[1]];
    int last = edge[1];
    for (auto& [t, node] : parts) {
      Vec3 x = a + t * (b - a);
      if (model_.projector) {
        const Vec3 y = model_.projector->to_curve(mesh_.line_curve[editor.line_on(edge[0], last)], x);
        if (norm(y - x) < kIntoPoint * length_) x = y;
      }
      last = node = editor.split_edge(edge[0], last, x);
    }
  }

  int node_of(const LinePlace& p) const {
    if (p.b < 0) return p.a;
    for (const auto& [t, node] : splits_.at({p.a, p.b}))
      if (t == p.t) return node;
    return -1;
  }

  /// Returns a chain of edges inside of a face from p straight to q, or to a line on the way; empty: none.
  std::vector<int> connect(SurfaceEditor& editor, int face, int p, int q) const {
    constexpr int kMostSteps = 1000;
    std::vector<int> chain{p};
    Vec3 normal;
    for (const int t : editor.triangles_at(p))
      if (mesh_.triangle_region[t] == face) normal = normal + area_vector(mesh_, t);
    const Vec3 to = mesh_.points[q] - mesh_.points[p], beside = cross(normal, to);
    const auto height = [&](int v) { return dot(mesh_.points[v] - mesh_.points[p], beside); };
    for (int step = 0; step < kMostSteps; ++step) {
      const int v = chain.back();
      if (v == q || (v != p && editor.is_on_line(v))) return chain;
      int next = -1;
      std::array<int, 2> crossed{};
      double u = 0;
      for (const int t : editor.triangles_at(v)) {
        if (mesh_.triangle_region[t] != face) continue;
        std::array<int, 2> other{};
        int n = 0;
        for (const int w : mesh_.triangles[t])
          if (w != v) other[n++] = w;
        if (other[0] == q || other[1] == q) {
          next = q;
          break;
        }
        const double from = height(other[0]), upto = height(other[1]);
        if (from * upto > 0 || from == upto) continue;
        const double part = from / (from - upto);
        const Vec3 x = mesh_.points[other[0]] + part * (mesh_.points[other[1]] - mesh_.points[other[0]]);
        if (dot(x - mesh_.points[v], to) > 0) crossed = other, u = part, next = v;
      }
      if (next < 0) return {};
      if (next == v) {
        const Vec3 &a = mesh_.points[crossed[0]], &b = mesh_.points[crossed[1]];
        const double snap = std::min(0.1, kIntoPoint * length_ / norm(b - a));
        const int near = u <= snap ? 0 : u >= 1 - snap ? 1 : -1;
        if (near >= 0 && editor.line_on(v, crossed[near]) < 0) {
          next = crossed[near];
        } else {
          next = editor.split_edge(crossed[0], crossed[1], a + u * (b - a));
        }
      }
      if (std::ranges::find(chain, next) != chain.end()) return {};
      chain.push_back(next);
    }
    return {};
  }

  SurfaceModel& model_;
  const Mesh& mesh_;
  double length_;
  std::vector<Cut> cuts_;
  std::map<std::array<int, 2>, std::vector<std::pair<double, int>>> splits_;  ///< part and node
};

/// Makes a face of each part between cuts (curves from `first_cut` on); the largest part that is not narrow
/// keeps the old face. Narrow parts come last. Faces that are narrow everywhere, or not marked in `is_cut`,
/// stay. Returns the former face of each.
std::vector<int> number_parts(Mesh& mesh, int first_cut, const std::vector<char>& is_cut,
                              const NarrowOptions& options) {
  const std::vector<Chart> charts = extract_charts(mesh, std::vector<char>(mesh.triangles.size(), 1));
  const int n = static_cast<int>(charts.size());
  std::vector<int> chart_of(mesh.triangles.size());
  std::vector<double> area(charts.size(), 0), outline(area), part_area(area);
  for (int c = 0; c < n; ++c) {
    for (const int t : charts[c].fine_triangle) chart_of[t] = c;
    for (const double a : triangle_areas(charts[c])) area[c] += a;
  }
  std::vector<char> is_narrow(charts.size(), 0);
  std::vector<std::array<int, 2>> beside_cuts;  // charts
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    const auto edge = sides_of_edge(sides, a, b);
    for (const HalfEdge& side : edge) {
      outline[chart_of[side.element]] += norm(mesh.points[b] - mesh.points[a]);
      if (edge.size() == 2 && may_join(mesh, mesh.line_curve[l], mesh.triangle_region[side.element],
                                       mesh.triangle_region[edge[&side == &edge[0]].element], options))
        is_narrow[chart_of[side.element]] = 1;
    }
    if (mesh.line_curve[l] >= first_cut)
      beside_cuts.push_back({chart_of[edge[0].element], chart_of[edge[1].element]});
  }
  for (int c = 0; c < n; ++c)
    if (!(2 * area[c] < options.length * outline[c]) ||
        std::ranges::any_of(charts[c].fine_triangle, [&](int t) { return is_kept(mesh, t, options); }))
      is_narrow[c] = 0;
  DisjointSets parts(charts.size());
  for (const auto& [c, d] : beside_cuts)
    if (!is_narrow[c] && !is_narrow[d]) parts.join(c, d);
  for (int c = 0; c < n; ++c) part_area[parts.root(c)] += area[c];
  std::vector<int> origin(mesh.regions.size()), largest(mesh.regions.size(), -1);
  std::iota(origin.begin(), origin.end(), 0);
  for (int c = 0; c < n; ++c) {
    int& most = largest[charts[c].face];
    if (parts.root(c) == c && !is_narrow[c] && (most < 0 || part_area[c] > part_area[most])) most = c;
  }
  int tag = 0;
  for (const Entity& face : mesh.regions) tag = std::max(tag, face.tag);
  std::vector<int> face_of(charts.size(), -1);  // by root
  for (const char narrow : {0, 1})
    for (int c = 0; c < n; ++c) {
      const int former = charts[c].face, root = parts.root(c);
      if (is_narrow[c] != narrow || largest[former] < 0 || root == largest[former] || !is_cut[former])
        continue;
      if (face_of[root] < 0) {
        face_of[root] = static_cast<int>(mesh.regions.size());
        mesh.regions.push_back(Entity{++tag, mesh.regions[former].names});
        origin.push_back(former);
      }
      for (const int t : charts[c].fine_triangle) mesh.triangle_region[t] = face_of[root];
    }
  return origin;
}

}  // namespace

std::vector<int> cut_narrow_parts(SurfaceModel& whole, const NarrowOptions& options) {
  SurfaceModel model = whole;
  Mesh& mesh = model.fine;
  const std::size_t n_faces = mesh.regions.size();
  const int n_curves = static_cast<int>(mesh.curves.size());
  const std::vector<int> faces_of_cuts = FaceCutter(model, options.length).cut();
  std::vector<char> is_cut(n_faces, 0);
  for (const int face : faces_of_cuts) is_cut[face] = 1;
  std::vector<int> origin(n_faces);
  std::iota(origin.begin(), origin.end(), 0);
  if (!faces_of_cuts.empty()) origin = number_parts(mesh, n_curves, is_cut, options);
  if (origin.size() == n_faces) return origin;
  EntityGroups faces;
  for (const int face : origin) faces.push_back({face});
  regroup(model, mesh, faces, singleton_groups(n_curves));
  if (model.projector)
    model.projector = with_curves_on_faces(std::move(model.projector), n_curves, faces_of_cuts);
  // Cuts that separate nothing are removed.
  const Mesh former = mesh;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  keep_lines(mesh, [&](std::size_t l) {
    const auto edge = sides_of_edge(sides, former.lines[l][0], former.lines[l][1]);
    return former.line_curve[l] < n_curves ||
           mesh.triangle_region[edge[0].element] != mesh.triangle_region[edge[1].element];
  });
  tidy_model(model, former);
  whole = std::move(model);
  return origin;
}

}  // namespace delquad
