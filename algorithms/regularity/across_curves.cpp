#include "algorithms/regularity/across_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
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
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "smoothing/relocation/element_quality.h"

namespace delquad {

namespace {

/// Polygons of a cavity.
constexpr std::size_t kMostParts = 4;
/// Patterns with cuts that are sought around a vertex, and at a change of a stretch, and edges of their rims,
/// at most.
constexpr int kMostPatterns = 8, kMostPatternsThere = 1;
constexpr std::size_t kMostRim = 48;
/// Sides of polygons whose patterns are told by their numbers of edges alone.
constexpr std::size_t kSimpleSides = 5;
/// Rings of quads that polygons grow by around a vertex, and at a stretch; each makes one.
constexpr int kRings = 2, kRingsThere = 3;
/// Cavities of a vertex that are filled, and of these such as are relocated.
constexpr int kMostAttempts = 6, kMostRelocated = 2;
/// An irregular vertex less may cost so many times as much as in a single patch: O moves nodes along the
/// curves afterwards, which stay where they are while it is tried.
constexpr double kDearer = 3;
/// Stretches of a vertex that are followed, and ways on from the other side of each.
constexpr std::size_t kMostStretches = 8, kMostWays = 3;
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
/// A pattern of more strain than this for each irregular vertex less will not settle. Nor will one whose
/// quads lose more of the sum before they are relocated, or have a worse corner (sine).
constexpr double kMostStrain = 1.5, kMostRawLoss = 19, kWorstRawSine = -0.5;
/// Vertices that are visited at once.
constexpr std::size_t kAtOnce = 32;

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

/// A patch as it is now, for all threads.
class PatchWork {
 public:
  PatchWork(PatchAtCurves& of, std::uint64_t number)
      : patch(of), mesh(of.mesh), energy(mesh), relocation(mesh, *of.size), version(number) {
    for (std::size_t i = 0; i < patch.edges.size(); ++i)
      if (patch.edges[i].curve >= 0) {
        const auto [at, is_new] = first_.try_emplace(patch.edges[i].curve, static_cast<int>(i), 1);
        if (!is_new) ++at->second.second;
      }
  }

  double delta(int v) const { return relocation.delta(v); }
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
  /// What is known, or else what `make` makes, which is the same whoever makes it.
  template <class Map, class Make>
  const typename Map::mapped_type& known(Map& all, const typename Map::key_type& key, Make&& make) {
    {
      const std::scoped_lock held(lock_);
      if (const auto at = all.find(key); at != all.end()) return at->second;
    }
    auto made = make();
    const std::scoped_lock held(lock_);
    return all.try_emplace(key, std::move(made)).first->second;
  }

  PatchAtCurves& patch;
  QuadTopology mesh;
  ValenceEnergy energy;
  QuadRelocation relocation;
  const std::uint64_t version;
  std::map<std::array<int, 3>, std::vector<Polygon>> polygons;  ///< by stretch
  std::map<std::array<int, 4>, Uses> uses;                      ///< by stretch and change

 private:
  std::map<int, std::pair<int, int>> first_;  ///< by curve: its first point here, and its edges
  std::mutex lock_;
};

/// A cavity filled on a mesh of its own, with the elements around all that moves.
class LocalFill {
 public:
  /// Throws std::invalid_argument where two vertices would get a second edge in common.
  LocalFill(PatchWork& work, const Cavity& cavity, const Rim& rim, const PatternMesh& fill)
      : whole_(work.mesh), cavity_(cavity), rim_(rim) {
    find_moving();
    FillTrial there(work.mesh, work.relocation);
    there.region = moving_;
    for (const int v : cavity_.vertices())
      if (cavity_.is_inside(v)) there.region.push_back(v);
    there.measure_before();
    before = there.before;
    Marks met;
    met.begin(whole_.element_slots());
    for_each_element_around(whole_, there.region, met, [&](int e) { elements_.push_back(e); });
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
  FillTrial::Quality before;  ///< of what there is
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
  FillTaking(PatchWork& work, const Cavity& cavity, const LocalFill& fill, const Rim& rim)
      : number(work.patch.mesh.points.size(), -1),
        of_local(fill.global.size(), -1),
        work_(work),
        cavity_(cavity),
        fill_(fill) {
    add_boundary(rim);
    add_inside();
    add_elements();
  }

  void finish(std::span<const Change> changes) {
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

  std::vector<int> number, of_local;  ///< what becomes of vertices

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
      number[v] = add(old.points[v]);
      for (const int local : after[v]) of_local[local] = add(fill_.mesh->point(local));
      edges_.insert(edges_.end(), 1 + after[v].size(), work_.patch.edges[v]);
    }
    made_.n_boundary = static_cast<int>(made_.points.size());
  }

  void add_inside() {
    const QuadPatch& old = work_.patch.mesh;
    for (int v = old.n_boundary; v < static_cast<int>(old.points.size()); ++v)
      if (!cavity_.is_inside(v)) number[v] = add(old.points[v]);
    for (std::size_t local = 0; local < fill_.global.size(); ++local) {
      const Vec2 at = fill_.mesh->point(static_cast<int>(local));
      if (fill_.global[local] >= 0) {
        of_local[local] = number[fill_.global[local]];
        made_.points[of_local[local]] = at;
      } else if (of_local[local] < 0) {
        of_local[local] = add(at);
      }
    }
  }

  void add_elements() {
    const QuadPatch& old = work_.patch.mesh;
    for (std::size_t q = 0; q < old.quads.size(); ++q) {
      if (cavity_.has(static_cast<int>(q))) continue;
      auto& quad = made_.quads.emplace_back(old.quads[q]);
      for (int& v : quad) v = number[v];
    }
    for (int e = fill_.first_fill; e < fill_.first_fill + fill_.n_fill; ++e) {
      auto& quad = made_.quads.emplace_back();
      for (int k = 0; k < 4; ++k) quad[k] = of_local[fill_.mesh->corner(e, k)];
    }
    made_.triangles = old.triangles;
    for (auto& triangle : made_.triangles)
      for (int& v : triangle) v = number[v];
  }

  PatchWork& work_;
  const Cavity& cavity_;
  const LocalFill& fill_;
  QuadPatch made_;
  std::vector<CurveEdge> edges_;
};

/// A polygon of a cavity that was filled.
struct Filled {
  int patch;
  std::vector<int> elements;
  std::vector<Change> changes;
  Rim rim;
  std::unique_ptr<LocalFill> fill;
};

/// What a visit of a vertex has found. It holds as long as the patches that were looked at stay.
struct Visited {
  std::vector<int> looked_at;
  std::vector<std::uint64_t> lost;  ///< candidates that were tried
  long long tried = 0;
  int gain = 0;               ///< irregular vertices less
  std::vector<Filled> parts;  ///< none: nothing was found
};

/// What visits share.
struct Shared {
  const CurveNetwork& network;
  const RegularityOptions& options;
  std::vector<std::unique_ptr<PatchWork>> works;  ///< of patches that take part
  std::unordered_set<std::uint64_t> lost;         ///< candidates that were tried

  bool may_cross(const CurveEdge& e) const { return e.curve >= 0 && network.sides[e.curve][0] >= 0; }

  /// Places on the curve of the nodes from `from` to `to`, once they have changed.
  std::vector<double> new_places(const Change& change) const {
    const auto& nodes = network.nodes[change.curve];
    const int n = change.edges();
    std::vector<double> places;
    for (int i = 0; i <= n; ++i) {
      const double at = change.from + double(i) * (change.to - change.from) / n;
      const int k = std::min(static_cast<int>(at), change.to - 1);
      places.push_back(nodes[k] + (at - k) * (nodes[k + 1] - nodes[k]));
    }
    return places;
  }
};

/// Grows cavities of patches, one thread at a time.
class Searches {
 public:
  CavitySearch& of(PatchWork& w, int patch) {
    if (of_.size() <= static_cast<std::size_t>(patch)) of_.resize(patch + 1);
    auto& [version, search] = of_[patch];
    if (!search || version != w.version) {
      version = w.version;
      search = std::make_unique<CavitySearch>(w.mesh, w.energy);
    }
    return *search;
  }
  /// Makes the polygon the patch's cavity; none: it is no more.
  const Cavity* take(PatchWork& w, int patch, const std::vector<int>& elements) {
    Cavity& cavity = of(w, patch).cavity();
    cavity.begin(static_cast<int>(elements.size()));
    for (const int e : elements) cavity.add(e);
    return cavity.close() ? &cavity : nullptr;
  }

 private:
  std::vector<std::pair<std::uint64_t, std::unique_ptr<CavitySearch>>> of_;  ///< by patch
};

/// A visit of an irregular vertex: seeks cavities around it, and fills them.
class Visit {
 public:
  Visit(const Shared& shared, Searches& searches)
      : shared_(shared), network_(shared.network), options_(shared.options), searches_(searches) {}

  Visited run(int patch, int v) && {
    check_cancelled();
    PatchWork& w = look_at(patch);
    const std::vector<Polygon> polygons = grow_around(w, patch, v);
    std::vector<Use> starts;
    int patterns_left = kMostPatterns;
    for (const Polygon& polygon : polygons)
      for (const Change& run : polygon.runs)
        for (const int by : kChanges)
          add_use(w, patch, polygon, {changed(run, by)}, -1, patterns_left, starts);
    const auto promise = [](const Use& o) { return promise_of(double(o.quads()), o.left, -o.more()); };
    std::ranges::stable_sort(starts, {}, promise);
    if (starts.size() > kMostStretches) starts.resize(kMostStretches);
    for (const Use& start : starts) go_on({patch, &start}, -start.more(), static_cast<double>(start.quads()));
    std::ranges::sort(candidates_, std::less<>());
    for (const Candidate& candidate : candidates_)
      if (attempt(candidate) || visited_.tried >= kMostRelocated || attempts_ >= kMostAttempts) break;
    return std::move(visited_);
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

  PatchWork& look_at(int patch) {
    if (std::ranges::find(visited_.looked_at, patch) == visited_.looked_at.end())
      visited_.looked_at.push_back(patch);
    return *shared_.works[patch];
  }
  bool may_cross(const CurveEdge& e) const { return shared_.may_cross(e); }

  /// Polygons with a vertex, and with the way to the nearest curve, which may be farther away than irregular
  /// vertices.
  std::vector<Polygon> grow_around(PatchWork& w, int patch, int v) {
    CavitySearch& search = searches_.of(w, patch);
    std::vector<Polygon> found;
    int at_curve = -1;
    search.find_near(std::span(&v, 1), options_.quads, [&](int u) {
      if (at_curve < 0 && w.mesh.on_boundary(u) && may_cross(w.patch.edges[u])) at_curve = u;
    });
    for (const bool to_curve : {false, true})
      if (!to_curve || at_curve >= 0)
        search.grow(
            options_.quads,
            [&] { return search.cavity().add_around(v) && (!to_curve || search.add_path(at_curve)); },
            [&] { collect(w, search, kRings, 1, found); });
    return found;
  }

  std::vector<Polygon> grow_at(PatchWork& w, int patch, const Change& change) {
    CavitySearch& search = searches_.of(w, patch);
    Cavity& cavity = search.cavity();
    std::vector<Polygon> found;
    std::vector<int> nodes;
    for (int k = change.low; k <= change.high; ++k) nodes.push_back(w.node_point(change.curve, k));
    const auto start = [&] {
      for (int k = change.low; k < change.high; ++k)
        if (!cavity.add(w.edge_element(change.curve, k))) return false;
      return std::all_of(nodes.begin() + 1, nodes.end() - 1, [&](int v) { return cavity.add_around(v); });
    };
    search.grow(nodes, options_.quads, start, [&] { collect(w, search, kRingsThere, -1, found); });
    // Straight across to the next curve.
    cavity.begin(kMostWhole);
    bool good = start();
    for (int k = change.low; k < change.high && good; ++k)
      for (int h = w.mesh.out(w.edge_point(change.curve, k)); h >= 0 && good;
           h = w.mesh.twin(w.mesh.next(w.mesh.next(h))))
        if (good = w.mesh.is_quad(QuadTopology::element(h)); good)
          good = cavity.add(QuadTopology::element(h));
    if (good) collect(w, search, kRingsThere, -1, found);
    // All of a small patch: what it hands on spreads over it.
    cavity.begin(kMostWhole);
    good = w.mesh.element_slots() <= kMostWhole;
    for (int e = 0; e < w.mesh.element_slots() && good; ++e) good = cavity.add(e);
    if (good) collect(w, search, kRingsThere, -1, found);
    std::erase_if(found, [&](const Polygon& polygon) {
      return std::ranges::none_of(polygon.runs, [&](const Change& run) {
        return run.curve == change.curve && run.low <= change.low && run.high >= change.high;
      });
    });
    return found;
  }

  /// The cavity, and what it becomes by rings of quads, where a pattern may have so many irregular vertices
  /// less.
  void collect(PatchWork& w, CavitySearch& search, int rings, int fewer, std::vector<Polygon>& found) const {
    Cavity& cavity = search.cavity();
    for (int ring = 0; ring <= rings; ++ring) {
      if (!cavity.close()) return;
      const std::uint64_t key = mixed(cavity.key(), w.version);
      if (std::ranges::find(found, key, &Polygon::key) != found.end()) return;
      if (const int irregular = cavity.irregular(); irregular - std::abs(4 - cavity.corners()) >= fewer) {
        Polygon polygon{{cavity.elements().begin(), cavity.elements().end()}, {}, {}, irregular, key};
        find_runs(w, cavity, polygon);
        if (!polygon.runs.empty()) found.push_back(std::move(polygon));
      }
      if (!search.add_ring()) return;
    }
  }

  /// Irregular vertices of the polygon's best pattern, once stretches have changed; negative: it has none, or
  /// one with more than `most`.
  int least(PatchWork& w, int patch, const Polygon& polygon, std::span<const Change> changes, int most,
            int& patterns_left) {
    const Change& last = changes.back();
    if (last.high - last.low + last.by < 1) return -1;
    if (polygon.sides) {
      std::array<int, kSimpleSides> sides{};
      std::ranges::copy(polygon.sides->edges, sides.begin());
      for (const Change& change : changes)
        sides[std::ranges::find(polygon.runs, change.curve, &Change::curve)->side] += change.by;
      const int left = least_irregular_of(std::span(sides).first(polygon.sides->edges.size()));
      return left <= most && has_room(w, patch, last) ? left : -1;
    }
    if (patterns_left <= 0 || !has_room(w, patch, last)) return -1;
    const Cavity* cavity = searches_.take(w, patch, polygon.elements);
    if (cavity == nullptr) return -1;
    const Rim rim = rim_of(w, patch, *cavity, changes);
    if (rim.vertex.size() > kMostRim) return -1;
    --patterns_left;
    const auto pattern = best_pattern(rim.outline, most);
    return pattern ? irregular_vertices(*pattern) : -1;
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
    if (shared_.lost.contains(key)) return;
    candidates_.push_back({promise_of(quads, left, gain), gain, key, parts_});
  }

  /// Where the polygon has a pattern with at most so many irregular vertices more.
  void add_use(PatchWork& w, int patch, const Polygon& polygon, std::vector<Change> changes, int most_more,
               int& patterns_left, std::vector<Use>& to) {
    const int left = least(w, patch, polygon, changes, polygon.irregular + most_more, patterns_left);
    if (left >= 0) to.push_back({&polygon, std::move(changes), left});
  }

  /// How the patch can take this change.
  Uses find_uses(PatchWork& w, int patch, const Change& change) {
    Uses found;
    if (!has_room(w, patch, change)) return found;
    int patterns_left = kMostPatternsThere;
    for (const Polygon& polygon : w.known(w.polygons, {change.curve, change.low, change.high},
                                          [&] { return grow_at(w, patch, change); })) {
      add_use(w, patch, polygon, {change}, 1, patterns_left, found.ends);
      for (const Change& run : polygon.runs)
        for (const int by : {change.by, -change.by})
          if (run.curve != change.curve)
            add_use(w, patch, polygon, {change, changed(run, by)}, 1, patterns_left, found.ways);
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
    PatchWork& w = look_at(patch);
    const Uses& uses = w.known(w.uses, {change.curve, change.low, change.high, change.by},
                               [&] { return find_uses(w, patch, change); });
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
  void find_runs(const PatchWork& w, const Cavity& cavity, Polygon& polygon) const {
    const auto rim = cavity.rim(), turns = cavity.turns();
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

  /// Whether edges on the changed stretch are about as long as wanted, and near the curve.
  bool has_room(const PatchWork& w, int patch, const Change& change) {
    const auto [at, is_new] = room_.try_emplace({patch, change.curve, change.low, change.high, change.by});
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
    const std::vector<double> places = shared_.new_places(change);
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
      const std::vector<double> places = shared_.new_places(c);
      for (int k = c.from + 1; k < c.to; ++k)
        if (c.moves(k)) moved[w.node_point(c.curve, k)] = network_.at(patch, c.curve, places[c.index(k)]);
    }
    return moved;
  }

  Rim rim_of(const PatchWork& w, int patch, const Cavity& cavity, std::span<const Change> changes) const {
    Rim rim{.outline = {}, .vertex = {}, .moved = moved_points(w, patch, changes), .gone = {}};
    for (const Change& c : changes)
      for (int k = c.low + 1; k < c.high; ++k) rim.gone.insert(w.node_point(c.curve, k));
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
      const std::vector<double> places = shared_.new_places(*change);
      const double low = w.delta(w.node_point(change->curve, change->low)),
                   high = w.delta(w.node_point(change->curve, change->high));
      const int first = change->index(change->low), n = change->index(change->high) - first;
      for (int j = 1; j < n; ++j) {
        const int at = e.forward ? j : n - j;
        add(-1, network_.at(patch, change->curve, places[first + at]), low + (high - low) * at / n, 0);
      }
    }
    return rim;
  }

  /// Whether quads of a fill are so poor before they are relocated that they will not get good. `loss` gets
  /// what they lose of the sum.
  static bool is_hopeless(const PatchWork& w, const Cavity& cavity, const Outline& rim,
                          const PatternMesh& fill, double& loss) {
    std::vector<Vec2> points = rim.places;
    std::vector<double> delta = rim.delta;
    int hint = -1;
    for (const Vec2 p : fill.inside) points.push_back(p), delta.push_back(w.patch.size->at(p, hint));
    ElementQuality before, after;
    for (const int e : cavity.elements()) before.add(element_quality(w.mesh, w.relocation, e));
    for (const auto& q : fill.quads) {
      std::array<Vec2, 4> at;
      std::array<double, 4> wanted{};
      for (int k = 0; k < 4; ++k) at[k] = points[q[k]], wanted[k] = delta[q[k]];
      after.add(quality_of(at, wanted));
    }
    const double more = double(fill.quads.size()) - double(cavity.elements().size());
    loss += before.value - after.value + more;
    return after.least_sine < kWorstRawSine;
  }

  /// Fills all polygons of a cavity with their best patterns; nothing is found where that costs too much.
  bool attempt(const Candidate& candidate) {
    visited_.lost.push_back(candidate.key);
    std::vector<Filled> parts;
    std::vector<Pattern> patterns;
    double strain = 0;
    for (const Part& part : candidate.parts) {
      PatchWork& w = *shared_.works[part.patch];
      const auto& [polygon, changes, left] = *part.use;
      const Cavity* cavity = searches_.take(w, part.patch, polygon->elements);
      if (cavity == nullptr) return false;
      const Rim& rim =
          parts.emplace_back(part.patch, polygon->elements, changes, rim_of(w, part.patch, *cavity, changes))
              .rim;
      auto pattern = best_pattern(rim.outline, left);
      if (!pattern) return false;
      strain += pattern->strain;
      patterns.push_back(*std::move(pattern));
    }
    if (strain > kMostStrain * candidate.gain) return false;
    ++attempts_;
    std::vector<PatternMesh> meshes;
    double loss = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const PatchWork& w = *shared_.works[parts[i].patch];
      const Outline& rim = parts[i].rim.outline;
      meshes.push_back(mesh_pattern(rim, patterns[i]));
      const Cavity& cavity = searches_.of(*shared_.works[parts[i].patch], parts[i].patch).cavity();
      if (is_hopeless(w, cavity, rim, meshes[i], loss)) return false;
    }
    if (loss > kMostRawLoss * candidate.gain) return false;
    std::vector<FillTrial> trials;
    double n = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      PatchWork& w = *shared_.works[parts[i].patch];
      const Cavity& cavity = searches_.of(w, parts[i].patch).cavity();
      try {
        parts[i].fill = std::make_unique<LocalFill>(w, cavity, parts[i].rim, meshes[i]);
      } catch (const std::invalid_argument&) {
        return false;
      }
      LocalFill& fill = *parts[i].fill;
      FillTrial& trial = trials.emplace_back(*fill.mesh, *fill.relocation);
      trial.region = fill.region;
      trial.collect_elements();
      trial.before = fill.before;
      n += fill.before.n;
    }
    const double tolerance = kDearer * options_.tolerance;
    if (!settle(trials, tolerance * candidate.gain / n, candidate.gain, loss, visited_.tried)) return false;
    visited_.gain = candidate.gain;
    visited_.parts = std::move(parts);
    return true;
  }

  const Shared& shared_;
  const CurveNetwork& network_;
  const RegularityOptions& options_;
  Searches& searches_;
  int attempts_ = 0;
  std::vector<Part> parts_;  ///< polygons of the cavity that is sought
  std::vector<Candidate> candidates_;
  std::map<std::array<int, 5>, bool> room_;  ///< by patch, stretch and change
  Visited visited_;
};

class AcrossCurves {
 public:
  AcrossCurves(CurveNetwork& network, const RegularityOptions& options)
      : network_(network), shared_{network, options, {}, {}} {}

  AcrossCurvesSummary run() {
    begin();
    while (!pending_.empty()) {
      const std::size_t n = std::min(kAtOnce, pending_.size());
      std::vector<Visited> found(n);
      parallel_for(n, [&](std::size_t i) {
        const auto searches = take_searches();
        found[i] = Visit(shared_, *searches).run(pending_[i].patch, pending_[i].vertex);
        give_back(searches);
      });
      take(found);
    }
    parallel_for(network_.patches.size(), [&](std::size_t p) {
      if (network_.patches[p].changed) relax(network_.patches[p]);
    });
    summary_.patches = static_cast<int>(std::ranges::count_if(network_.patches, &PatchAtCurves::changed));
    return summary_;
  }

 private:
  /// An irregular vertex that is to be visited; negative: it is gone.
  struct Place {
    int patch, vertex;
    friend bool operator==(const Place&, const Place&) = default;
  };

  void begin() {
    const std::size_t n = network_.patches.size();
    shared_.works.resize(n);
    parallel_for(n, [&](std::size_t p) {
      PatchAtCurves& patch = network_.patches[p];
      const auto crosses = [&](const CurveEdge& e) { return shared_.may_cross(e); };
      if (patch.size != nullptr && std::ranges::any_of(patch.edges, crosses))
        shared_.works[p] = std::make_unique<PatchWork>(patch, p);
    });
    versions_ = n;
    // One of each patch after the other, as those of a patch look at the same quads.
    std::vector<std::pair<int, Place>> places;
    for (std::size_t p = 0; p < n; ++p)
      if (const auto& w = shared_.works[p])
        for (int v = 0, rank = 0; v < w->mesh.vertex_slots(); ++v)
          if (w->energy.of(v) > 0) places.push_back({rank++, {static_cast<int>(p), v}});
    std::ranges::stable_sort(places, {}, &std::pair<int, Place>::first);
    for (const auto& [rank, place] : places) pending_.push_back(place);
  }

  std::shared_ptr<Searches> take_searches() {
    const std::scoped_lock held(lock_);
    if (idle_.empty()) return std::make_shared<Searches>();
    auto one = std::move(idle_.back());
    idle_.pop_back();
    return one;
  }
  void give_back(std::shared_ptr<Searches> one) {
    const std::scoped_lock held(lock_);
    idle_.push_back(std::move(one));
  }

  /// Takes over what the first ones that are pending have found. Where one before has changed a patch that
  /// another one has looked at, that is visited once more.
  void take(std::vector<Visited>& found) {
    std::vector<char> changed(network_.patches.size(), 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (std::ranges::any_of(found[i].looked_at, [&](int p) { return changed[p] != 0; })) continue;
      pending_[i].vertex = -1;
      shared_.lost.insert(found[i].lost.begin(), found[i].lost.end());
      summary_.tried += found[i].tried;
      if (found[i].parts.empty()) continue;
      accept(found[i]);
      for (const Filled& part : found[i].parts) changed[part.patch] = 1;
    }
    std::erase_if(pending_, [](const Place& place) { return place.vertex < 0; });
  }

  void accept(const Visited& found) {
    ++summary_.accepted;
    summary_.gained += found.gain;
    summary_.longest = std::max(summary_.longest, static_cast<int>(found.parts.size()));
    std::vector<std::pair<Change, std::vector<double>>> changed;
    std::vector<Place> near;
    for (std::size_t i = 0; i < found.parts.size(); ++i) {
      const Filled& part = found.parts[i];
      PatchWork& w = *shared_.works[part.patch];
      FillTaking taking(w, *searches_.take(w, part.patch, part.elements), *part.fill, part.rim);
      taking.finish(part.changes);
      for (Place& place : pending_)
        if (place.patch == part.patch && place.vertex >= 0) place.vertex = taking.number[place.vertex];
      for (const int v : taking.of_local) near.push_back({part.patch, v});
      if (i + 1 < found.parts.size())
        changed.emplace_back(part.changes.back(), shared_.new_places(part.changes.back()));
    }
    for (const auto& [change, places] : changed) {
      auto& nodes = network_.nodes[change.curve];
      nodes.erase(nodes.begin() + change.from + 1, nodes.begin() + change.to);
      nodes.insert(nodes.begin() + change.from + 1, places.begin() + 1, places.end() - 1);
    }
    for (const Filled& part : found.parts)
      shared_.works[part.patch] = std::make_unique<PatchWork>(network_.patches[part.patch], versions_++);
    for (const Place& place : near)
      if (shared_.works[place.patch]->energy.of(place.vertex) > 0 &&
          std::ranges::find(pending_, place) == pending_.end())
        pending_.push_back(place);
  }

  static void relax(PatchAtCurves& patch) {
    QuadTopology mesh(patch.mesh);
    QuadRelocation relocation(mesh, *patch.size);
    hold(relocation);
    relocation.activate_all();
    relax_at_last(relocation);
    patch.mesh = mesh.to_patch();
  }

  CurveNetwork& network_;
  Shared shared_;
  std::uint64_t versions_ = 0;
  std::vector<Place> pending_;
  std::mutex lock_;
  std::vector<std::shared_ptr<Searches>> idle_;  ///< with lock_
  Searches searches_;
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
