#include "algorithms/insertion/linf_adaptation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <tuple>

#include "algorithms/insertion/vertex_fields.h"
#include "mesh/predicates.h"

namespace delquad {
namespace {

constexpr double kLongest = std::numbers::sqrt2, kShortest = 1 / kLongest;

/// One corner of a triangle: side k lies opposite of it.
struct Corner {
  int t, k;
};

/// A triangulation that is edited locally. Dead triangles have v[0] < 0.
class Triangulation {
 public:
  explicit Triangulation(const TriPatch& tri)
      : points(tri.points), v(tri.triangles), n(tri.neighbours), n_boundary(tri.n_boundary) {
    corner_of.resize(points.size(), -1);
    for (int t = 0; t < size(); ++t) note_corners(t);
  }

  int size() const { return static_cast<int>(v.size()); }
  bool alive(int t) const { return v[t][0] >= 0; }
  int facing(int u, int t) const { return n[u][0] == t ? 0 : n[u][1] == t ? 1 : 2; }
  bool on_boundary(int i) const { return i < n_boundary; }

  /// The corners at an inner vertex, counterclockwise.
  void star(int i, std::vector<Corner>& corners) const {
    corners.clear();
    const int first = corner_of[i];
    int t = first;
    do {
      const int k = v[t][0] == i ? 0 : v[t][1] == i ? 1 : 2;
      corners.push_back({t, k});
      t = n[t][(k + 1) % 3];
    } while (t != first);
  }

  /// Swaps the side of t opposite of its corner k, which has a neighbour.
  void swap(int t, int k) {
    const int u = n[t][k], m = facing(u, t);
    const int a = v[t][k], b = v[t][(k + 1) % 3], c = v[t][(k + 2) % 3], d = v[u][m];
    const int ab = n[t][(k + 2) % 3], ca = n[t][(k + 1) % 3];
    const int bd = n[u][(m + 1) % 3], dc = n[u][(m + 2) % 3];
    set(t, {a, b, d}, {bd, u, ab});
    set(u, {a, d, c}, {dc, ca, t});
    relink(bd, u, t);
    relink(ca, t, u);
  }

  /// Cuts the side of t opposite of its corner k, which has a neighbour, in two.
  int split(int t, int k, Vec2 at) {
    const int u = n[t][k], m = facing(u, t), i = static_cast<int>(points.size());
    const int a = v[t][k], b = v[t][(k + 1) % 3], c = v[t][(k + 2) % 3], d = v[u][m];
    const int ca = n[t][(k + 1) % 3], ab = n[t][(k + 2) % 3];
    const int bd = n[u][(m + 1) % 3], dc = n[u][(m + 2) % 3];
    const int p = size(), q = p + 1;
    points.push_back(at);
    corner_of.push_back(-1);
    v.resize(v.size() + 2);
    n.resize(n.size() + 2);
    set(t, {a, b, i}, {u, p, ab});
    set(u, {i, b, d}, {bd, q, t});
    set(p, {a, i, c}, {q, ca, t});
    set(q, {i, d, c}, {dc, p, u});
    relink(ca, t, p);
    relink(dc, u, q);
    return i;
  }

  /// Takes inner vertex `from` out by moving it onto its neighbour `to`; `star` is that of `from`.
  void collapse(int from, int to, const std::vector<Corner>& star) {
    for (const auto& [t, k] : star) {
      const bool gone = v[t][(k + 1) % 3] == to || v[t][(k + 2) % 3] == to;
      if (!gone) {
        v[t][k] = to;
        note_corners(t);
      }
    }
    for (const auto& [t, k] : star) {
      const int j = v[t][(k + 1) % 3] == to ? (k + 1) % 3 : v[t][(k + 2) % 3] == to ? (k + 2) % 3 : -1;
      if (j < 0) continue;
      // The sides opposite of `from` and of `to` become one.
      const int left = n[t][k], right = n[t][j];
      if (left >= 0) n[left][facing(left, t)] = right;
      if (right >= 0) n[right][facing(right, t)] = left;
      v[t] = {-1, -1, -1};
      for (const int u : {left, right})
        if (u >= 0 && alive(u)) note_corners(u);
    }
    corner_of[from] = -1;
  }

  TriPatch to_patch() const {
    TriPatch tri;
    tri.n_boundary = n_boundary;
    std::vector<int> point_at(points.size(), -1), triangle_at(v.size(), -1);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      if (!on_boundary(i) && corner_of[i] < 0) continue;
      point_at[i] = static_cast<int>(tri.points.size());
      tri.points.push_back(points[i]);
    }
    for (int t = 0, next = 0; t < size(); ++t)
      if (alive(t)) triangle_at[t] = next++;
    for (int t = 0; t < size(); ++t) {
      if (!alive(t)) continue;
      tri.triangles.push_back({point_at[v[t][0]], point_at[v[t][1]], point_at[v[t][2]]});
      auto& around = tri.neighbours.emplace_back();
      for (int k = 0; k < 3; ++k) around[k] = n[t][k] < 0 ? -1 : triangle_at[n[t][k]];
    }
    return tri;
  }

  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> v, n;
  std::vector<int> corner_of;  ///< a triangle of each vertex
  int n_boundary;

 private:
  void note_corners(int t) {
    for (const int i : v[t]) corner_of[i] = t;
  }
  void set(int t, std::array<int, 3> corners, std::array<int, 3> around) {
    v[t] = corners;
    n[t] = around;
    note_corners(t);
  }
  void relink(int t, int from, int to) {
    if (t >= 0) n[t][facing(t, from)] = to;
  }
};

class Adaptation {
 public:
  Adaptation(const TriPatch& tri, const CrossField& cross, const ParametricSize& size,
             const AdaptationOptions& options)
      : mesh_(tri), cross_(cross), size_(size), options_(options) {
    for (std::size_t i = 0; i < tri.points.size(); ++i) sample(static_cast<int>(i), VertexFields{});
  }

  TriPatch run(AdaptationSummary& s) {
    for (std::size_t edits = mesh_.v.size(); edits > mesh_.v.size() / kFew && s.sweeps < options_.max_sweeps;
         ++s.sweeps) {
      const long long splits = split_long(), collapses = collapse_short();
      const long long swaps = swap_edges();
      s.moves += move_vertices();
      s.splits += splits;
      s.collapses += collapses;
      s.swaps += swaps;
      edits = static_cast<std::size_t>(splits + collapses + swaps);
    }
    s.swaps += swap_edges();
    return mesh_.to_patch();
  }

 private:
  /// An edge with its length, a < b.
  struct Edge {
    double length;
    int a, b;
  };

  /// `near` by value: it may lie in the list that grows here.
  void sample(int i, VertexFields near) {
    if (static_cast<std::size_t>(i) >= fields_.size()) fields_.resize(i + 1);
    fields_[i] = sample_fields(cross_, size_, mesh_.points[i], near);
  }

  /// Axes and length by which vectors are measured.
  struct Frame {
    Vec2 e;
    double delta;
    Vec2 of(Vec2 d) const { return (1 / delta) * Vec2{dot(e, d), ::delquad::cross(e, d)}; }
    Vec2 to_plane(Vec2 f) const { return delta * (f.x * e + f.y * perp(e)); }
  };
  /// The means at some vertices.
  template <std::size_t N>
  Frame frame_of(const std::array<int, N>& vertices) const {
    Cross sum = {0, 0};
    double delta = 0;
    for (const int i : vertices) {
      sum = sum + fields_[i].cross;
      delta += fields_[i].delta / N;
    }
    const double theta = sum.angle();
    return {{std::cos(theta), std::sin(theta)}, delta};
  }
  static double largest(Vec2 d) { return std::max(std::abs(d.x), std::abs(d.y)); }
  double length(int a, int b) const {
    return largest(frame_of(std::array{a, b}).of(mesh_.points[b] - mesh_.points[a]));
  }

  /// 0 when it is flat or upside down.
  double measure(const Frame& frame, int a, int b, int c) const {
    const Vec2 p = mesh_.points[a], q = mesh_.points[b], r = mesh_.points[c];
    if (orient2d(p, q, r) <= 0) return 0;
    const double longest =
        std::max({largest(frame.of(q - p)), largest(frame.of(r - q)), largest(frame.of(p - r))});
    return ::delquad::cross(q - p, r - p) / (frame.delta * frame.delta * longest * longest);
  }

  /// Inner edges whose length is `wanted`, by vertices.
  template <class Wanted>
  std::vector<Edge> inner_edges(Wanted wanted) const {
    std::vector<Edge> edges;
    for (int t = 0; t < mesh_.size(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (int k = 0; k < 3; ++k) {
        if (mesh_.n[t][k] < t) continue;
        const int a = mesh_.v[t][(k + 1) % 3], b = mesh_.v[t][(k + 2) % 3];
        if (const double l = length(a, b); wanted(l)) edges.push_back({l, std::min(a, b), std::max(a, b)});
      }
    }
    return edges;
  }

  /// The corner opposite of the edge in a triangle that has it and a neighbour there; t < 0: none any more.
  Corner find_edge(int a, int b) {
    if (mesh_.corner_of[a] < 0 || mesh_.corner_of[b] < 0) return {-1, 0};
    const int inner = mesh_.on_boundary(a) ? b : a, other = inner == a ? b : a;
    if (mesh_.on_boundary(inner)) return find_chord(a, b);
    mesh_.star(inner, star_);
    for (const auto& [t, k] : star_)
      if (mesh_.v[t][(k + 1) % 3] == other) return {t, (k + 2) % 3};
    return {-1, 0};
  }

  /// Between two boundary vertices: turns around a from its known triangle, both ways.
  Corner find_chord(int a, int b) const {
    for (const int way : {1, 2}) {
      int t = mesh_.corner_of[a];
      const int first = t;
      do {
        const int k = mesh_.v[t][0] == a ? 0 : mesh_.v[t][1] == a ? 1 : 2;
        for (const int j : {1, 2})
          if (mesh_.v[t][(k + j) % 3] == b) {
            const int opposite = (k + 3 - j) % 3;
            return mesh_.n[t][opposite] < 0 ? Corner{-1, 0} : Corner{t, opposite};
          }
        t = mesh_.n[t][(k + way) % 3];
      } while (t >= 0 && t != first);
    }
    return {-1, 0};
  }

  long long split_long() {
    std::vector<Edge> edges = inner_edges([](double l) { return l > kLongest; });
    std::ranges::sort(edges, [](const Edge& x, const Edge& y) {
      return std::tuple(-x.length, x.a, x.b) < std::tuple(-y.length, y.a, y.b);
    });
    long long splits = 0;
    for (const Edge& e : edges) {
      if (static_cast<long long>(mesh_.points.size()) >= options_.max_points) break;
      const Corner at = find_edge(e.a, e.b);
      if (at.t < 0) continue;
      const Vec2 middle = 0.5 * (mesh_.points[e.a] + mesh_.points[e.b]);
      const int u = mesh_.n[at.t][at.k];
      const Vec2 apex[] = {mesh_.points[mesh_.v[at.t][at.k]],
                           mesh_.points[mesh_.v[u][mesh_.facing(u, at.t)]]};
      const Vec2 b = mesh_.points[mesh_.v[at.t][(at.k + 1) % 3]],
                 c = mesh_.points[mesh_.v[at.t][(at.k + 2) % 3]];
      const bool upright = orient2d(apex[0], b, middle) > 0 && orient2d(apex[0], middle, c) > 0 &&
                           orient2d(apex[1], c, middle) > 0 && orient2d(apex[1], middle, b) > 0;
      if (!upright) continue;
      sample(mesh_.split(at.t, at.k, middle), fields_[e.a]);
      ++splits;
    }
    return splits;
  }

  long long collapse_short() {
    std::vector<Edge> edges = inner_edges([](double l) { return l < kShortest; });
    std::ranges::sort(edges, [](const Edge& x, const Edge& y) {
      return std::tuple(x.length, x.a, x.b) < std::tuple(y.length, y.a, y.b);
    });
    long long collapses = 0;
    for (const Edge& e : edges) {
      if (find_edge(e.a, e.b).t < 0 || length(e.a, e.b) >= kShortest) continue;
      // The younger vertex goes, if it can.
      collapses += collapse(e.b, e.a) || collapse(e.a, e.b);
    }
    return collapses;
  }

  bool collapse(int from, int to) {
    if (mesh_.on_boundary(from)) return false;
    mesh_.star(from, star_);
    if (star_.size() < 4) return false;  // three triangles would become one that overlaps what is outside
    int common = 0;
    for (const auto& [t, k] : star_) {
      const int a = mesh_.v[t][(k + 1) % 3], b = mesh_.v[t][(k + 2) % 3];
      if (a != to && length(a, to) > kLongest) return false;
      common += adjacent(a, to);
      if (a == to || b == to) continue;
      if (orient2d(mesh_.points[to], mesh_.points[a], mesh_.points[b]) <= 0) return false;
    }
    if (common != 2) return false;  // else an edge would be there twice
    mesh_.collapse(from, to, star_);
    return true;
  }

  /// Whether an edge joins two vertices; boundary edges count.
  bool adjacent(int a, int b) const {
    if (a == b) return false;
    for (const int way : {1, 2}) {
      int t = mesh_.corner_of[a];
      const int first = t;
      do {
        const int k = mesh_.v[t][0] == a ? 0 : mesh_.v[t][1] == a ? 1 : 2;
        if (mesh_.v[t][(k + 1) % 3] == b || mesh_.v[t][(k + 2) % 3] == b) return true;
        t = mesh_.n[t][(k + way) % 3];
      } while (t >= 0 && t != first);
    }
    return false;
  }

  long long swap_edges() {
    constexpr int kPasses = 10;
    constexpr double kBetter = 1e-6;  // far above rounding, so that no edge goes to and fro
    long long swaps = 0;
    for (int pass = 0, changed = 1; pass < kPasses && changed > 0; ++pass) {
      changed = 0;
      for (int t = 0; t < mesh_.size(); ++t)
        for (int k = 0; k < 3 && mesh_.alive(t); ++k) {
          const int u = mesh_.n[t][k];
          if (u < t) continue;
          const int a = mesh_.v[t][k], b = mesh_.v[t][(k + 1) % 3], c = mesh_.v[t][(k + 2) % 3];
          const int d = mesh_.v[u][mesh_.facing(u, t)];
          const Frame frame = frame_of(std::array{a, b, c, d});
          const double now = std::min(measure(frame, a, b, c), measure(frame, d, c, b));
          if (std::min(measure(frame, a, b, d), measure(frame, a, d, c)) <= now + kBetter) continue;
          mesh_.swap(t, k);
          ++changed;
        }
      swaps += changed;
    }
    return swaps;
  }

  long long move_vertices() {
    constexpr int kPasses = 3;
    long long moves = 0;
    for (int pass = 0; pass < kPasses; ++pass)
      for (int i = mesh_.n_boundary; i < static_cast<int>(mesh_.points.size()); ++i)
        if (mesh_.corner_of[i] >= 0) moves += move(i);
    return moves;
  }

  /// Sum over the edges of i, when it lies at `at`, of the squares of what separates them from the nearest
  /// ideal edge, over delta'; `step` receives the mean of the ways to these, if asked for.
  double misfit(int i, Vec2 at, Vec2* step) const {
    double sum = 0;
    Vec2 ways;
    for (const auto& [t, k] : star_) {
      const int j = mesh_.v[t][(k + 1) % 3];
      const Frame frame = frame_of(std::array{i, j});
      const Vec2 f = frame.of(at - mesh_.points[j]), way = nearest_ideal(f) - f;
      sum += dot(way, way);
      ways += frame.to_plane(way);
    }
    if (step != nullptr) *step = (1.0 / static_cast<double>(star_.size())) * ways;
    return sum;
  }

  /// Of the legs and hypotenuses of unit half squares along the axes.
  static Vec2 nearest_ideal(Vec2 f) {
    const auto whole = [](double x) { return std::clamp(std::round(x), -1.0, 1.0); };
    const Vec2 ideal = {whole(f.x), whole(f.y)};
    if (ideal != Vec2{}) return ideal;
    return std::abs(f.x) > std::abs(f.y) ? Vec2{std::copysign(1, f.x), 0} : Vec2{0, std::copysign(1, f.y)};
  }

  bool move(int i) {
    mesh_.star(i, star_);
    const Vec2 from = mesh_.points[i];
    Vec2 step;
    const double before = misfit(i, from, &step);
    const auto upright = [&](Vec2 at) {
      return std::ranges::all_of(star_, [&](const Corner& c) {
        return orient2d(at, mesh_.points[mesh_.v[c.t][(c.k + 1) % 3]],
                        mesh_.points[mesh_.v[c.t][(c.k + 2) % 3]]) > 0;
      });
    };
    for (double part = 1; part > 0.1; part /= 2) {
      const Vec2 at = from + part * step;
      if (!upright(at) || !(misfit(i, at, nullptr) < before)) continue;
      mesh_.points[i] = at;
      sample(i, fields_[i]);
      return true;
    }
    return false;
  }

  static constexpr std::size_t kFew = 1000;  // edits to so many triangles are not worth another sweep
  Triangulation mesh_;
  const CrossField& cross_;
  const ParametricSize& size_;
  AdaptationOptions options_;
  std::vector<VertexFields> fields_;
  std::vector<Corner> star_;
};

}  // namespace

TriPatch adapt_linf(const TriPatch& tri, const CrossField& cross, const ParametricSize& size,
                    const AdaptationOptions& options, AdaptationSummary* summary) {
  const auto start = std::chrono::steady_clock::now();
  AdaptationSummary s;
  TriPatch adapted = Adaptation(tri, cross, size, options).run(s);
  s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (summary != nullptr) *summary = s;
  return adapted;
}

}  // namespace delquad
