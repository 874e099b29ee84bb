#include "algorithms/regularity/across_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "algorithms/regularity/cavity.h"
#include "algorithms/regularity/fill_trial.h"
#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/polygon_sides.h"
#include "base/cancel.h"
#include "base/stopwatch.h"

namespace delquad {

namespace {

/// Polygons of a cavity.
constexpr std::size_t kMostParts = 4;
/// Patterns with cuts that are sought in one visit of a vertex, and edges of their rims, at most.
constexpr int kMostPatterns = 8;
constexpr std::size_t kMostRim = 48;
/// Sides of polygons whose patterns are told by their numbers of edges alone.
constexpr std::size_t kSimpleSides = 5;
/// Rings of quads that polygons grow by, each of which is one.
constexpr int kRings = 3;
/// Cavities of a vertex that are filled, and of these such as are relocated.
constexpr int kMostAttempts = 6, kMostRelocated = 2;
/// An irregular vertex less may cost so many times as much as in a single patch: O moves nodes along the
/// curves afterwards, which stay where they are while it is tried.
constexpr double kDearer = 3;
/// Stretches of a vertex that are followed, and ways on from the other side of each.
constexpr std::size_t kMostStretches = 12, kMostWays = 6;
/// Quads of a polygon that hands a change on straight across, or is all of a patch.
constexpr int kMostWhole = 100;
/// Edges of a stretch over the wanted length, at least where it gets more of them, at most where fewer.
constexpr double kShortest = 0.6, kLongest = 1.5;
/// How far the middle of an edge may lie off the curve, in its lengths: a circle keeps twelve edges.
constexpr double kMostSagitta = 0.066;
/// By how much stretches change.
constexpr std::array kChanges = {2, -2, 4, -4};
/// Edges beside a stretch that make room for it, on either side, for each edge more or less.
constexpr int kSpread = 4;
/// Rings of quads around changed polygons and curves whose vertices are relocated.
constexpr int kMovedRings = 2;
/// A pattern of more strain than this for each irregular vertex less will not settle.
constexpr double kMostStrain = 1.5;

/// A stretch of a curve between two of its nodes that gets so many edges more. Those beside it make room: the
/// nodes between `from` and `to` get other places.
struct Change {
  int curve, low, high, by;
  int from = 0, to = 0;
  int side = 0;                                 ///< of a simple polygon, on which it lies
  int edges() const { return to - from + by; }  ///< between `from` and `to`, in the end
  /// The place of a node that stays, among those from `from` on.
  int index(int k) const { return k - from + (k < high ? 0 : by); }
  bool moves(int k) const { return (from < k && k <= low) || (high <= k && k < to); }
};

std::uint64_t mixed(std::uint64_t sum, std::uint64_t value) { return scattered(sum ^ scattered(value)); }
std::uint64_t mixed(std::uint64_t sum, const Change& c) {
  for (const int value : {c.curve, c.low, c.high, c.by})
    sum = mixed(sum, static_cast<std::uint64_t>(static_cast<unsigned>(value)));
  return sum;
}

/// Quads of a patch that make a closed cavity.
struct Polygon {
  std::vector<int> elements;
  std::vector<Change> runs;           ///< stretches on its rim, by 0, one of a curve
  std::optional<PolygonSides> sides;  ///< none where it is concave, or has six corners or more
  int irregular;
  std::uint64_t key;
};

/// A polygon with changed stretches.
struct Use {
  const Polygon* polygon;
  std::vector<Change> changes;
  int left;  ///< irregular vertices of its pattern
  int more() const { return left - polygon->irregular; }
  std::size_t quads() const { return polygon->elements.size(); }
  friend bool operator<(const Use& a, const Use& b) {
    return a.more() != b.more() ? a.more() < b.more() : a.quads() < b.quads();
  }
};
/// Of a patch beside a stretch, those where a change ends, and those that hand it on.
struct Uses {
  std::vector<Use> ends, ways;
};

/// The rim of a cavity once stretches have changed.
struct Rim {
  Outline outline;
  std::vector<int> vertex;    ///< of the patch; negative: a new node
  std::map<int, Vec2> moved;  ///< boundary points of the patch that get other places
  std::set<int> gone;         ///< and those that go
};

/// A patch as it is now.
class PatchWork {
 public:
  PatchWork(PatchAtCurves& of, std::uint64_t number)
      : patch(of),
        mesh(of.mesh),
        energy(mesh),
        relocation(mesh, *of.size),
        search(mesh, energy),
        before(mesh, relocation),
        version(number) {
    for (std::size_t i = 0; i < patch.edges.size(); ++i)
      if (patch.edges[i].curve >= 0) {
        const auto [at, is_new] = first_.try_emplace(patch.edges[i].curve, static_cast<int>(i), 1);
        if (!is_new) ++at->second.second;
      }
  }

  double delta(int v) const { return relocation.delta(v); }
  double delta_at(Vec2 at) { return patch.size->at(at, hint_); }
  /// The boundary point from which the curve's k-th edge begins here.
  int edge_point(int curve, int k) const {
    const auto [first, n] = first_.at(curve);
    return patch.edges[first].forward ? first + k : first + n - 1 - k;
  }
  int node_point(int curve, int k) const {
    const auto [first, n] = first_.at(curve);
    if (patch.edges[first].forward) return k < n ? first + k : mesh.target(mesh.out(first + n - 1));
    return k > 0 ? first + n - k : mesh.target(mesh.out(first + n - 1));
  }
  int edge_element(int curve, int k) const { return QuadTopology::element(mesh.out(edge_point(curve, k))); }
  /// Of the edge that begins at a half-edge's origin; negative curve: it is none of a curve's.
  CurveEdge edge_of(int h) const {
    if (mesh.twin(h) >= 0) return {};
    return patch.edges[mesh.origin(h)];
  }

  PatchAtCurves& patch;
  QuadTopology mesh;
  ValenceEnergy energy;
  QuadRelocation relocation;
  CavitySearch search;
  FillTrial before;
  std::uint64_t version;
  /// By what they were grown from: a vertex, or a stretch.
  std::map<std::array<int, 3>, std::vector<Polygon>> polygons;
  /// By stretch and change.
  std::map<std::array<int, 4>, Uses> uses;
  std::map<std::array<int, 4>, bool> room;

 private:
  int hint_ = -1;
  std::map<int, std::pair<int, int>> first_;  ///< by curve: its first point here, and its edges
};

/// A cavity filled on a mesh of its own, with the elements around all that moves.
class LocalFill {
 public:
  /// Throws std::invalid_argument where two vertices would get a second edge in common. The patch's trial
  /// gets what there is before.
  LocalFill(PatchWork& work, const Rim& rim, const PatternMesh& fill)
      : whole_(work.mesh), cavity_(work.search.cavity()), rim_(rim) {
    find_moving();
    work.before.region = moving_;
    for (const int v : cavity_.vertices())
      if (cavity_.is_inside(v)) work.before.region.push_back(v);
    work.before.measure_before();
    Marks met;
    met.begin(whole_.element_slots());
    for_each_element_around(whole_, work.before.region, met, [&](int e) { elements_.push_back(e); });
    const int first_held = add_vertices();
    add_elements(fill);
    mesh.emplace(local_, first_held);
    relocation.emplace(*mesh, *work.patch.size);
    hold(*relocation);
    for (const int v : moving_)
      if (const auto at = number_.find(v); at != number_.end()) region.push_back(at->second);
  }

  std::optional<QuadTopology> mesh;
  std::optional<QuadRelocation> relocation;
  std::vector<int> global;  ///< vertex of the patch, by vertex here; negative: a new one
  std::vector<int> corner;  ///< by vertex of the rim
  std::vector<int> region;
  int first_fill = 0, n_fill = 0;

 private:
  void find_moving() {
    Marks met;
    met.begin(whole_.vertex_slots());
    const auto move_around = [&](int at) {
      whole_.for_each_out(at, [&](int h) {
        const int e = QuadTopology::element(h);
        for (int k = 0; k < 4; ++k)
          if (const int v = whole_.corner(e, k); v >= 0 && !cavity_.is_inside(v) && met.meet(v))
            moving_.push_back(v);
      });
    };
    for (const int h : cavity_.rim()) move_around(whole_.origin(h));
    for (const auto& [v, at] : rim_.moved) move_around(v);
    for (int ring = 1; ring < kMovedRings; ++ring)
      for (std::size_t i = 0, n = moving_.size(); i < n; ++i) move_around(moving_[i]);
  }

  int add(int v, Vec2 at) {
    global.push_back(v);
    local_.points.push_back(at);
    return static_cast<int>(global.size()) - 1;
  }

  /// Those of the boundary come first, new ones with them, then those that have elements elsewhere, which are
  /// held. Returns the first of these.
  int add_vertices() {
    std::map<int, int> in_elements;
    for (const int e : elements_)
      for (int k = 0; k < 4; ++k)
        if (const int v = whole_.corner(e, k); v >= 0) ++in_elements[v];
    const std::set<int> on_rim(rim_.vertex.begin(), rim_.vertex.end());
    const auto add_where = [&](const auto& is_next) {
      for (const auto& [v, n] : in_elements) {
        const bool stays = on_rim.contains(v) || !(cavity_.is_inside(v) || rim_.gone.contains(v));
        if (!stays || !is_next(v, n)) continue;
        const auto moved = rim_.moved.find(v);
        number_[v] = add(v, moved == rim_.moved.end() ? whole_.point(v) : moved->second);
      }
    };
    add_where([&](int v, int) { return whole_.on_boundary(v); });
    for (std::size_t i = 0; i < rim_.vertex.size(); ++i)
      corner.push_back(rim_.vertex[i] >= 0 ? -1 : add(-1, rim_.outline.places[i]));
    const int first_held = static_cast<int>(global.size());
    add_where([&](int v, int n) { return !whole_.on_boundary(v) && n < whole_.valence(v); });
    local_.n_boundary = static_cast<int>(global.size());
    add_where([&](int v, int n) { return !whole_.on_boundary(v) && n == whole_.valence(v); });
    for (std::size_t i = 0; i < rim_.vertex.size(); ++i)
      if (rim_.vertex[i] >= 0) corner[i] = number_.at(rim_.vertex[i]);
    return first_held;
  }

  void add_elements(const PatternMesh& fill) {
    for (const int e : elements_) {
      if (cavity_.has(e)) continue;
      std::array<int, 4> corners{};
      for (int k = 0; k < 4; ++k)
        if (const int v = whole_.corner(e, k); v >= 0) corners[k] = number_.at(v);
      if (whole_.is_quad(e))
        local_.quads.push_back(corners);
      else
        local_.triangles.push_back({corners[0], corners[1], corners[2]});
    }
    std::vector<int> vertex = corner;
    for (const Vec2 at : fill.inside) vertex.push_back(region.emplace_back(add(-1, at)));
    first_fill = static_cast<int>(local_.quads.size());
    n_fill = static_cast<int>(fill.quads.size());
    for (auto quad : fill.quads) {
      for (int& v : quad) v = vertex[v];
      local_.quads.push_back(quad);
    }
  }

  const QuadTopology& whole_;
  const Cavity& cavity_;
  const Rim& rim_;
  std::vector<int> moving_, elements_;  ///< of the patch
  std::map<int, int> number_;           ///< vertex here, by vertex of the patch
  QuadPatch local_;
};

/// Takes a fill over into its patch; boundary points keep their order.
class FillTaking {
 public:
  FillTaking(PatchWork& work, const LocalFill& fill, const Rim& rim)
      : work_(work),
        fill_(fill),
        number_(work.patch.mesh.points.size(), -1),
        of_local_(fill.global.size(), -1) {
    add_boundary(rim);
    add_inside();
    add_elements();
  }

  void finish(std::span<const Change> changes) && {
    // Edges of a curve are numbered anew, in their order or against it.
    for (const Change& change : changes) {
      const auto is_on = [&](const CurveEdge& e) { return e.curve == change.curve; };
      const auto n = static_cast<int>(std::ranges::count_if(edges_, is_on));
      int k = 0;
      for (CurveEdge& e : edges_)
        if (is_on(e)) e.index = e.forward ? k++ : n - 1 - k++;
    }
    work_.patch.mesh = std::move(made_);
    work_.patch.edges = std::move(edges_);
    work_.patch.changed = true;
  }

 private:
  int add(Vec2 at) {
    made_.points.push_back(at);
    return static_cast<int>(made_.points.size()) - 1;
  }

  void add_boundary(const Rim& rim) {
    std::map<int, std::vector<int>> after;  // new nodes by the point that they follow
    for (std::size_t i = 0, last = 0; i < rim.vertex.size(); ++i) {
      if (rim.vertex[i] >= 0)
        last = i;
      else
        after[rim.vertex[last]].push_back(fill_.corner[i]);
    }
    const QuadPatch& old = work_.patch.mesh;
    for (int v = 0; v < old.n_boundary; ++v) {
      if (rim.gone.contains(v)) continue;
      number_[v] = add(old.points[v]);
      for (const int local : after[v]) of_local_[local] = add(fill_.mesh->point(local));
      edges_.insert(edges_.end(), 1 + after[v].size(), work_.patch.edges[v]);
    }
    made_.n_boundary = static_cast<int>(made_.points.size());
  }

  void add_inside() {
    const QuadPatch& old = work_.patch.mesh;
    for (int v = old.n_boundary; v < static_cast<int>(old.points.size()); ++v)
      if (!work_.search.cavity().is_inside(v)) number_[v] = add(old.points[v]);
    for (std::size_t local = 0; local < fill_.global.size(); ++local) {
      const Vec2 at = fill_.mesh->point(static_cast<int>(local));
      if (fill_.global[local] >= 0) {
        of_local_[local] = number_[fill_.global[local]];
        made_.points[of_local_[local]] = at;
      } else if (of_local_[local] < 0) {
        of_local_[local] = add(at);
      }
    }
  }

  void add_elements() {
    const QuadPatch& old = work_.patch.mesh;
    for (std::size_t q = 0; q < old.quads.size(); ++q) {
      if (work_.search.cavity().has(static_cast<int>(q))) continue;
      auto& quad = made_.quads.emplace_back(old.quads[q]);
      for (int& v : quad) v = number_[v];
    }
    for (int e = fill_.first_fill; e < fill_.first_fill + fill_.n_fill; ++e) {
      auto& quad = made_.quads.emplace_back();
      for (int k = 0; k < 4; ++k) quad[k] = of_local_[fill_.mesh->corner(e, k)];
    }
    made_.triangles = old.triangles;
    for (auto& triangle : made_.triangles)
      for (int& v : triangle) v = number_[v];
  }

  PatchWork& work_;
  const LocalFill& fill_;
  QuadPatch made_;
  std::vector<CurveEdge> edges_;
  std::vector<int> number_, of_local_;  ///< what becomes of vertices
};

class AcrossCurves {
 public:
  AcrossCurves(CurveNetwork& network, const RegularityOptions& options)
      : network_(network),
        options_(options),
        tolerance_(kDearer * options.tolerance),
        works_(network.patches.size()),
        to_visit_(works_.size(), 1) {}

  AcrossCurvesSummary run() {
    for (bool again = true; again;) {
      again = false;
      for (std::size_t p = 0; p < works_.size(); ++p)
        if (std::exchange(to_visit_[p], 0) != 0 && is_in(static_cast<int>(p)))
          again = visit_patch(static_cast<int>(p)) || again;
    }
    for (std::size_t p = 0; p < works_.size(); ++p)
      if (network_.patches[p].changed) relax(network_.patches[p]);
    return summary_;
  }

 private:
  struct Part {
    int patch;
    const Use* use;  ///< its last change is shared with the next part, its first one with the last part
  };
  struct Candidate {
    double promise;
    int gain;
    std::uint64_t key;
    std::vector<Part> parts;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      return a.promise != b.promise ? a.promise < b.promise : a.key < b.key;
    }
  };

  bool is_in(int patch) const {
    const PatchAtCurves& p = network_.patches[patch];
    return p.size != nullptr &&
           std::ranges::any_of(p.edges, [&](const CurveEdge& e) { return may_cross(e); });
  }
  bool may_cross(const CurveEdge& e) const { return e.curve >= 0 && network_.sides[e.curve][0] >= 0; }

  PatchWork& work(int patch) {
    if (!works_[patch]) works_[patch] = std::make_unique<PatchWork>(network_.patches[patch], ++versions_);
    return *works_[patch];
  }

  bool visit_patch(int patch) {
    bool accepted = false;
    for (int v = 0; v < work(patch).mesh.vertex_slots(); ++v)
      if (work(patch).mesh.vertex_alive(v) && work(patch).energy.of(v) > 0)
        accepted = visit(patch, v) || accepted;
    return accepted;
  }

  bool visit(int patch, int v) {
    check_cancelled();
    candidates_.clear();
    patterns_left_ = kMostPatterns;
    PatchWork& w = work(patch);
    std::vector<Use> starts;
    for (const Polygon& polygon : polygons_around(w, v))
      for (const Change& run : polygon.runs)
        for (const int by : kChanges) add_use(w, patch, polygon, {changed(run, by)}, -1, starts);
    const auto promise = [](const Use& o) { return promise_of(double(o.quads()), o.left, -o.more()); };
    std::ranges::stable_sort(starts, {}, promise);
    if (starts.size() > kMostStretches) starts.resize(kMostStretches);
    for (const Use& start : starts) go_on({patch, &start}, -start.more(), static_cast<double>(start.quads()));
    std::ranges::sort(candidates_, std::less<>());
    const long long tried = summary_.tried;
    attempts_ = 0;
    for (const Candidate& candidate : candidates_) {
      if (attempt(candidate)) return true;
      if (summary_.tried >= tried + kMostRelocated || attempts_ >= kMostAttempts) return false;
    }
    return false;
  }

  const std::vector<Polygon>& polygons_around(PatchWork& w, int v) {
    const auto [at, is_new] = w.polygons.try_emplace({-1, v, 0});
    std::vector<Polygon>& found = at->second;
    if (!is_new) return found;
    const std::span<const int> source(&v, 1);
    // The nearest curves may be farther away than irregular vertices.
    std::vector<int> at_curves{-1};
    std::set<int> curves;
    w.search.find_near(source, options_.quads, [&](int u) {
      if (!w.mesh.on_boundary(u) || at_curves.size() > 2) return;
      if (const CurveEdge& e = w.patch.edges[u]; may_cross(e) && curves.insert(e.curve).second)
        at_curves.push_back(u);
    });
    for (const int u : at_curves)
      w.search.grow(
          source, options_.quads,
          [&] { return w.search.cavity().add_around(v) && (u < 0 || w.search.add_path(u)); },
          [&] { collect(w, found); });
    return found;
  }

  /// Of the patch on the other side of a stretch, those that have all of it.
  const std::vector<Polygon>& polygons_at(PatchWork& w, const Change& change) {
    const auto [at, is_new] = w.polygons.try_emplace({change.curve, change.low, change.high});
    std::vector<Polygon>& found = at->second;
    if (!is_new) return found;
    Cavity& cavity = w.search.cavity();
    std::vector<int> nodes;
    for (int k = change.low; k <= change.high; ++k) nodes.push_back(w.node_point(change.curve, k));
    const auto start = [&] {
      for (int k = change.low; k < change.high; ++k)
        if (!cavity.add(w.edge_element(change.curve, k))) return false;
      return std::all_of(nodes.begin() + 1, nodes.end() - 1, [&](int v) { return cavity.add_around(v); });
    };
    w.search.grow(nodes, options_.quads, start, [&] { collect(w, found); });
    // Straight across to the next curve.
    cavity.begin(kMostWhole);
    bool good = start();
    for (int k = change.low; k < change.high && good; ++k)
      for (int h = w.mesh.out(w.edge_point(change.curve, k)); h >= 0 && good;
           h = w.mesh.twin(w.mesh.next(w.mesh.next(h))))
        if (good = w.mesh.is_quad(QuadTopology::element(h)); good)
          good = cavity.add(QuadTopology::element(h));
    if (good) collect(w, found);
    // All of a small patch: what it hands on spreads over it.
    cavity.begin(kMostWhole);
    good = w.mesh.element_slots() <= kMostWhole;
    for (int e = 0; e < w.mesh.element_slots() && good; ++e) good = cavity.add(e);
    if (good) collect(w, found);
    std::erase_if(found, [&](const Polygon& polygon) {
      return std::ranges::none_of(polygon.runs, [&](const Change& run) {
        return run.curve == change.curve && run.low <= change.low && run.high >= change.high;
      });
    });
    return found;
  }

  /// The cavity, and what it becomes by rings of quads.
  void collect(PatchWork& w, std::vector<Polygon>& found) {
    const Cavity& cavity = w.search.cavity();
    for (int ring = 0; ring <= kRings; ++ring) {
      if (!w.search.cavity().close()) return;
      const std::uint64_t key = mixed(cavity.key(), w.version);
      if (std::ranges::find(found, key, &Polygon::key) != found.end()) return;
      Polygon polygon{{cavity.elements().begin(), cavity.elements().end()}, {}, {}, cavity.irregular(), key};
      find_runs(w, polygon);
      if (!polygon.runs.empty()) found.push_back(std::move(polygon));
      if (!w.search.add_ring()) return;
    }
  }

  /// Makes the polygon the patch's cavity.
  bool take(PatchWork& w, const std::vector<int>& elements) {
    Cavity& cavity = w.search.cavity();
    cavity.begin(static_cast<int>(elements.size()));
    for (const int e : elements) cavity.add(e);
    return cavity.close();
  }

  /// Irregular vertices of the polygon's best pattern, once stretches have changed; negative: it has none, or
  /// one with more than one irregular vertex more.
  int least(PatchWork& w, int patch, const Polygon& polygon, const std::vector<Change>& changes) {
    const int most = polygon.irregular + 1;
    if (changes.back().high - changes.back().low + changes.back().by < 1) return -1;
    if (polygon.sides) {
      std::array<int, kSimpleSides> sides{};
      std::ranges::copy(polygon.sides->edges, sides.begin());
      for (const Change& change : changes)
        sides[std::ranges::find(polygon.runs, change.curve, &Change::curve)->side] += change.by;
      const int left = least_irregular_of(std::span(sides).first(polygon.sides->edges.size()));
      return left <= most && has_room(w, patch, changes.back()) ? left : -1;
    }
    std::uint64_t key = polygon.key;
    for (const Change& change : changes) key = mixed(key, change);
    if (const auto known = least_.find(key); known != least_.end()) return known->second;
    if (patterns_left_ <= 0) return -1;
    int& known = least_[key] = -1;
    if (!has_room(w, patch, changes.back()) || !take(w, polygon.elements)) return known;
    const Rim rim = rim_of(w, patch, changes);
    if (rim.vertex.size() > kMostRim) return known;
    --patterns_left_;
    const auto pattern = best_pattern(rim.outline, most);
    return known = pattern ? irregular_vertices(*pattern) : -1;
  }

  void add_candidate(int gain, double quads) {
    if (quads > gain * options_.quads) return;
    std::uint64_t key = 0;
    int left = 0;
    for (const Part& part : parts_) {
      left += part.use->left;
      std::uint64_t of_part = part.use->polygon->key;
      for (const Change& change : part.use->changes) of_part = mixed(of_part, change);
      key += of_part;
    }
    if (std::ranges::find(candidates_, key, &Candidate::key) != candidates_.end()) return;
    if (lost_.contains(key)) return;
    candidates_.push_back({promise_of(quads, left, gain), gain, key, parts_});
  }

  /// Where the polygon has a pattern with at most so many irregular vertices more.
  void add_use(PatchWork& w, int patch, const Polygon& polygon, std::vector<Change> changes, int most_more,
               std::vector<Use>& to) {
    const int left = least(w, patch, polygon, changes);
    if (left >= 0 && left - polygon.irregular <= most_more)
      to.push_back({&polygon, std::move(changes), left});
  }

  /// How the patch can take this change.
  const Uses& uses_at(PatchWork& w, int patch, const Change& change) {
    const auto [at, is_new] = w.uses.try_emplace({change.curve, change.low, change.high, change.by});
    Uses& found = at->second;
    if (!is_new) return found;
    for (const Polygon& polygon : polygons_at(w, change)) {
      add_use(w, patch, polygon, {change}, 1, found.ends);
      for (const Change& run : polygon.runs)
        for (const int by : {change.by, -change.by})
          if (run.curve != change.curve)
            add_use(w, patch, polygon, {change, changed(run, by)}, 1, found.ways);
    }
    // Of those alike the smallest, and the largest, over which a change spreads.
    const auto prune = [](std::vector<Use>& all, const auto& kind_of) {
      std::ranges::stable_sort(all, {}, [&](const Use& use) { return std::pair(kind_of(use), use.quads()); });
      std::vector<Use> kept;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const bool first = i == 0 || kind_of(all[i - 1]) != kind_of(all[i]);
        const bool last = i + 1 == all.size() || kind_of(all[i + 1]) != kind_of(all[i]);
        if (first || last) kept.push_back(all[i]);
      }
      std::ranges::stable_sort(kept, std::less<>());
      all = std::move(kept);
    };
    prune(found.ends, [](const Use& use) { return std::array{use.more(), 0, 0}; });
    prune(found.ways, [](const Use& use) {
      return std::array{use.more(), use.changes[1].curve, use.changes[1].by};
    });
    if (found.ways.size() > kMostWays) found.ways.resize(kMostWays);
    return found;
  }

  /// To the other side of the stretch that this polygon changed last. `gain`: irregular vertices less so far.
  void go_on(Part part, int gain, double quads) {
    const Change change = part.use->changes.back();
    const auto& [a, b] = network_.sides[change.curve];
    const int patch = part.patch == a ? b : a;
    if (std::ranges::find(parts_, patch, &Part::patch) != parts_.end()) return;
    parts_.push_back(part);
    const Uses& uses = uses_at(work(patch), patch, change);
    for (const Use& end : uses.ends)
      if (const int all = gain - end.more(); all > 0) {
        parts_.push_back({patch, &end});
        add_candidate(all, quads + static_cast<double>(end.quads()));
        parts_.pop_back();
      }
    if (parts_.size() + 1 < kMostParts)
      for (const Use& way : uses.ways)
        if (const int all = gain - way.more(); all > 0)
          go_on({patch, &way}, all, quads + static_cast<double>(way.quads()));
    parts_.pop_back();
  }

  /// The sides of the closed cavity, and stretches of curves on its rim without vertices in between that want
  /// other than two quads.
  void find_runs(const PatchWork& w, Polygon& polygon) const {
    const auto rim = w.search.cavity().rim();
    const auto turns = w.search.cavity().turns();
    const auto n = static_cast<int>(rim.size());
    polygon.sides = sides_of(turns);
    if (polygon.sides && polygon.sides->edges.size() > kSimpleSides) polygon.sides.reset();
    const auto joins = [&](int i) {
      const CurveEdge a = w.edge_of(rim[(i + n - 1) % n]), b = w.edge_of(rim[i]);
      return may_cross(a) && a.curve == b.curve && turns[i] == 0 && b.index == a.index + (a.forward ? 1 : -1);
    };
    int start = polygon.sides ? polygon.sides->start : 0;
    for (int i = 0; i < n && joins(start); ++i) start = (start + 1) % n;
    if (joins(start)) return;
    for (int j = 0, side = -1; j < n; ++j) {
      const int i = (start + j) % n;
      side += turns[i] == 1 ? 1 : 0;
      const CurveEdge e = w.edge_of(rim[i]);
      if (!may_cross(e)) continue;
      if (j > 0 && joins(i)) {
        Change& run = polygon.runs.back();
        run.low = std::min(run.low, e.index), run.high = std::max(run.high, e.index + 1);
      } else {
        polygon.runs.push_back(
            {.curve = e.curve, .low = e.index, .high = e.index + 1, .by = 0, .side = side});
      }
    }
    // A curve that is there twice stays.
    std::erase_if(polygon.runs, [all = polygon.runs](const Change& run) {
      return std::ranges::count(all, run.curve, &Change::curve) > 1;
    });
  }

  Change changed(Change run, int by) const {
    run.by = by;
    const int spread = kSpread * std::abs(by);
    run.from = std::max(0, run.low - spread);
    run.to = std::min(static_cast<int>(network_.nodes[run.curve].size()) - 1, run.high + spread);
    return run;
  }

  /// Places on the curve of the nodes from `from` to `to`, once they have changed.
  std::vector<double> new_places(const Change& change) const {
    const auto& nodes = network_.nodes[change.curve];
    const int n = change.edges();
    std::vector<double> places;
    for (int i = 0; i <= n; ++i) {
      const double at = change.from + double(i) * (change.to - change.from) / n;
      const int k = std::min(static_cast<int>(at), change.to - 1);
      places.push_back(nodes[k] + (at - k) * (nodes[k + 1] - nodes[k]));
    }
    return places;
  }

  /// Whether edges on the changed stretch are about as long as wanted, and near the curve.
  bool has_room(PatchWork& w, int patch, const Change& change) const {
    const auto [at, is_new] = w.room.try_emplace({change.curve, change.low, change.high, change.by}, false);
    if (is_new) at->second = would_have_room(w, patch, change);
    return at->second;
  }
  bool would_have_room(const PatchWork& w, int patch, const Change& change) const {
    const int n = change.edges();
    double wanted = 0;
    for (int k = change.from; k < change.to; ++k) {
      const int a = w.node_point(change.curve, k), b = w.node_point(change.curve, k + 1);
      wanted += norm(w.mesh.point(b) - w.mesh.point(a)) / (0.5 * (w.delta(a) + w.delta(b)));
    }
    if (change.by > 0) return wanted >= kShortest * n;
    if (wanted > kLongest * n) return false;
    const std::vector<double> places = new_places(change);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const auto at = [&](double s) { return network_.at(patch, change.curve, s); };
      const Vec2 a = at(places[i]), b = at(places[i + 1]);
      if (norm(at(0.5 * (places[i] + places[i + 1])) - 0.5 * (a + b)) > kMostSagitta * norm(b - a))
        return false;
    }
    return true;
  }

  /// Where boundary points go that make room.
  std::map<int, Vec2> moved_points(const PatchWork& w, int patch, std::span<const Change> changes) const {
    std::map<int, Vec2> moved;
    for (const Change& c : changes) {
      const std::vector<double> places = new_places(c);
      for (int k = c.from + 1; k < c.to; ++k)
        if (c.moves(k)) moved[w.node_point(c.curve, k)] = network_.at(patch, c.curve, places[c.index(k)]);
    }
    return moved;
  }

  Rim rim_of(PatchWork& w, int patch, std::span<const Change> changes) {
    Rim rim{.outline = {}, .vertex = {}, .moved = moved_points(w, patch, changes), .gone = {}};
    for (const Change& c : changes)
      for (int k = c.low + 1; k < c.high; ++k) rim.gone.insert(w.node_point(c.curve, k));
    const Cavity& cavity = w.search.cavity();
    const auto add = [&](int v, Vec2 at, double delta, int turn) {
      rim.vertex.push_back(v);
      rim.outline.places.push_back(at), rim.outline.delta.push_back(delta), rim.outline.turn.push_back(turn);
    };
    for (std::size_t i = 0; i < cavity.rim().size(); ++i) {
      const int h = cavity.rim()[i], v = w.mesh.origin(h);
      const CurveEdge e = w.edge_of(h);
      const auto change = std::ranges::find_if(changes, [&](const Change& c) {
        return c.curve == e.curve && c.low <= e.index && e.index < c.high;
      });
      const int k = e.forward ? e.index : e.index + 1;
      if (change != changes.end() && change->low < k && k < change->high) continue;
      const auto moved = rim.moved.find(v);
      add(v, moved != rim.moved.end() ? moved->second : w.mesh.point(v), w.delta(v), cavity.turns()[i]);
      if (change == changes.end()) continue;
      const std::vector<double> all = new_places(*change);
      std::vector<double> places(all.begin() + change->index(change->low) + 1,
                                 all.begin() + change->index(change->high));
      if (!e.forward) std::ranges::reverse(places);
      for (const double place : places) {
        const Vec2 at = network_.at(patch, change->curve, place);
        add(-1, at, w.delta_at(at), 0);
      }
    }
    return rim;
  }

  /// Fills all polygons of a cavity with their best patterns; nothing changes where that costs too much.
  bool attempt(const Candidate& candidate) {
    lost_.insert(candidate.key);
    std::vector<Rim> rims;
    std::vector<Pattern> patterns;
    double strain = 0;
    for (const Part& part : candidate.parts) {
      PatchWork& w = work(part.patch);
      if (!take(w, part.use->polygon->elements)) return false;
      const Rim& rim = rims.emplace_back(rim_of(w, part.patch, part.use->changes));
      auto pattern = best_pattern(rim.outline, part.use->left);
      if (!pattern) return false;
      strain += pattern->strain;
      patterns.push_back(*std::move(pattern));
    }
    if (strain > kMostStrain * candidate.gain) return false;
    ++attempts_;
    std::vector<LocalFill> fills;
    std::vector<FillTrial> trials;
    fills.reserve(candidate.parts.size());
    for (std::size_t i = 0; i < candidate.parts.size(); ++i) {
      PatchWork& w = work(candidate.parts[i].patch);
      try {
        fills.emplace_back(w, rims[i], mesh_pattern(rims[i].outline, patterns[i]));
      } catch (const std::invalid_argument&) {
        return false;
      }
      FillTrial& trial = trials.emplace_back(*fills[i].mesh, *fills[i].relocation);
      trial.region = fills[i].region;
      trial.collect_elements();
      trial.before = w.before.before;
    }
    double n = 0, loss = 0;
    for (const FillTrial& trial : trials) n += trial.before.n;
    if (!settle(trials, tolerance_ * candidate.gain / n, candidate.gain, loss, summary_.tried)) return false;
    accept(candidate, fills, rims);
    return true;
  }

  void accept(const Candidate& candidate, const std::vector<LocalFill>& fills, const std::vector<Rim>& rims) {
    ++summary_.accepted;
    summary_.gained += candidate.gain;
    summary_.longest = std::max(summary_.longest, static_cast<int>(candidate.parts.size()));
    std::vector<std::pair<Change, std::vector<double>>> changed;
    for (std::size_t i = 0; i < candidate.parts.size(); ++i) {
      const Part& part = candidate.parts[i];
      FillTaking(work(part.patch), fills[i], rims[i]).finish(part.use->changes);
      if (i + 1 < candidate.parts.size()) {
        const Change& change = part.use->changes.back();
        changed.emplace_back(change, new_places(change));
      }
    }
    for (const auto& [change, places] : changed) {
      auto& nodes = network_.nodes[change.curve];
      nodes.erase(nodes.begin() + change.from + 1, nodes.begin() + change.to);
      nodes.insert(nodes.begin() + change.from + 1, places.begin() + 1, places.end() - 1);
    }
    for (const Part& part : candidate.parts) {
      works_[part.patch].reset();
      to_visit_[part.patch] = 1;
    }
  }

  void relax(PatchAtCurves& patch) {
    ++summary_.patches;
    QuadTopology mesh(patch.mesh);
    QuadRelocation relocation(mesh, *patch.size);
    hold(relocation);
    relocation.activate_all();
    relax_at_last(relocation);
    patch.mesh = mesh.to_patch();
  }

  CurveNetwork& network_;
  const RegularityOptions& options_;
  double tolerance_;
  std::vector<std::unique_ptr<PatchWork>> works_;
  std::uint64_t versions_ = 0;
  std::vector<char> to_visit_;  ///< patches where something has changed
  int patterns_left_ = 0;       ///< of this visit
  int attempts_ = 0;            ///< of this visit
  std::vector<Part> parts_;     ///< polygons of the cavity that is sought
  std::vector<Candidate> candidates_;
  std::unordered_map<std::uint64_t, int> least_;  ///< irregular vertices of patterns; negative: none
  std::unordered_set<std::uint64_t> lost_;        ///< candidates that were tried
  AcrossCurvesSummary summary_;
};

}  // namespace

AcrossCurvesSummary make_regular_across_curves(CurveNetwork& network, const RegularityOptions& options) {
  const Stopwatch watch;
  AcrossCurvesSummary summary = AcrossCurves(network, options).run();
  summary.seconds = watch.work_seconds();
  return summary;
}

}  // namespace delquad
