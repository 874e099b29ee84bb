// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/visit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/cancel.h"
#include "smoothing/relocation/element_quality.h"

namespace delquad::across {

namespace {

/// Limit of polygons of a cavity.
constexpr std::size_t kMostParts = 4;
/// Limit of patterns with cuts that are searched around a vertex, and at a change of a stretch. Limit of
/// edges of their rims.
constexpr int kMostPatterns = 8, kMostPatternsThere = 1;
constexpr std::size_t kMostRim = 48;
/// Limit of sides of polygons whose patterns follow from numbers of edges alone.
constexpr std::size_t kSimpleSides = 5;
/// Rings of quads that polygons add around a vertex, and at a stretch; each ring makes a polygon.
constexpr int kRings = 2, kRingsThere = 3;
/// Limit of filled cavities of a vertex, and relocated ones among them.
constexpr int kMostAttempts = 6, kMostRelocated = 2;
/// Factor of the tolerance over a single patch: O moves nodes along curves later, but they are fixed in the
/// trial.
constexpr double kPriceFactor = 3;
/// Limit of stretches of a vertex that are followed, and ways on from the other side of each.
constexpr std::size_t kMostStretches = 8, kMostWays = 3;
/// Limit of quads of a polygon that passes a change straight across or is a whole patch.
constexpr int kMostWhole = 100;
/// Limits of edges on a stretch over the wanted length: the least if it gains edges, the most if it loses
/// some.
constexpr double kShortest = 0.6, kLongest = 1.5;
/// Largest distance of the middle of an edge from the curve, in its lengths: a circle keeps twelve edges.
constexpr double kMostSagitta = 0.066;
/// Changes of stretches.
constexpr std::array kChanges = {2, -2, 4, -4};
/// Edges beside a stretch, on either side, that make space for each added or removed edge.
constexpr int kSpread = 4;
/// Limits for each removed irregular vertex: a pattern with more strain or raw loss will not settle. Least
/// sine of a corner before relocation.
constexpr double kMostStrain = 1.5, kMostRawLoss = 19, kWorstRawSine = -0.5;

/// A visit of an irregular vertex.
class Visit {
 public:
  Visit(const Shared& shared, SearchPool& searches)
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
    const auto priority = [](const Use& o) { return promise_of(double(o.quads()), o.left, -o.more()); };
    std::ranges::stable_sort(starts, {}, priority);
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
    const Use* use;  ///< its last change is shared with the next part, its first one with the previous part
  };
  struct Candidate {
    double priority;
    int gain;
    std::uint64_t key;
    std::vector<Part> parts;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      return a.priority != b.priority ? a.priority < b.priority : a.key < b.key;
    }
  };

  PatchWork& look_at(int patch) {
    if (std::ranges::find(visited_.looked_at, patch) == visited_.looked_at.end())
      visited_.looked_at.push_back(patch);
    return *shared_.works[patch];
  }
  bool may_cross(const CurveEdge& e) const { return shared_.may_cross(e); }

  /// Returns polygons around a vertex, and with the path to the nearest curve, which may be farther than
  /// irregular vertices.
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
    // Tries straight across to the next curve.
    cavity.begin(kMostWhole);
    bool good = start();
    for (int k = change.low; k < change.high && good; ++k)
      for (int h = w.mesh.out(w.edge_point(change.curve, k)); h >= 0 && good;
           h = w.mesh.twin(w.mesh.next(w.mesh.next(h))))
        if (good = w.mesh.is_quad(QuadTopology::element(h)); good)
          good = cavity.add(QuadTopology::element(h));
    if (good) collect(w, search, kRingsThere, -1, found);
    // Tries all of a small patch, over which the change spreads.
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

  /// Collects the cavity, and the cavity with rings of quads, if a pattern may have at least `fewer`
  /// irregular vertices less.
  void collect(PatchWork& w, CavitySearch& search, int rings, int fewer, std::vector<Polygon>& found) const {
    Cavity& cavity = search.cavity();
    for (int ring = 0; ring <= rings; ++ring) {
      if (!cavity.close()) return;
      const std::uint64_t key = hash_combine(cavity.key(), w.version);
      if (std::ranges::find(found, key, &Polygon::key) != found.end()) return;
      if (const int irregular = cavity.irregular(); irregular - std::abs(4 - cavity.corners()) >= fewer) {
        Polygon polygon{{cavity.elements().begin(), cavity.elements().end()}, {}, {}, irregular, key};
        find_runs(w, cavity, polygon);
        if (!polygon.runs.empty()) found.push_back(std::move(polygon));
      }
      if (!search.add_ring()) return;
    }
  }

  /// Returns the irregular vertices of the polygon's best pattern after stretches have changed; negative: no
  /// pattern, or more than `most`.
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
      for (const Change& change : part.use->changes) of_part = hash_combine(of_part, change);
      key += of_part;
    }
    if (std::ranges::find(candidates_, key, &Candidate::key) != candidates_.end()) return;
    if (shared_.lost.contains(key)) return;
    candidates_.push_back({promise_of(quads, left, gain), gain, key, parts_});
  }

  /// Adds a use if the polygon has a pattern with at most `most_more` more irregular vertices.
  void add_use(PatchWork& w, int patch, const Polygon& polygon, std::vector<Change> changes, int most_more,
               int& patterns_left, std::vector<Use>& to) {
    const int left = least(w, patch, polygon, changes, polygon.irregular + most_more, patterns_left);
    if (left >= 0) to.push_back({&polygon, std::move(changes), left});
  }

  /// Returns the ways in which the patch can take this change.
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
    // Keeps the smallest of similar uses, and the largest, over which a change spreads.
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

  /// Continues at the other side of the last changed stretch. `gain` is the number of removed irregular
  /// vertices so far.
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

  /// Finds the sides of the closed cavity, and stretches of curves on its rim whose inner vertices all want
  /// two quads.
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
    // A curve with several stretches stays.
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

  /// Returns whether edges on the changed stretch have about the wanted length and lie near the curve.
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

  /// Returns new places of boundary points that make space.
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

  /// Returns whether quads of a fill are too poor before relocation to become good. Adds their loss of the
  /// sum to `loss`.
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
      after.add(quality_of(at, wanted, w.relocation.limits()));
    }
    const double more = double(fill.quads.size()) - double(cavity.elements().size());
    loss += before.value - after.value + more;
    return after.least_sine < kWorstRawSine;
  }

  /// Fills all polygons of a cavity with their best patterns. Fails if it costs too much.
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
    const double tolerance = kPriceFactor * options_.tolerance;
    if (!settle(trials, tolerance * candidate.gain / n, candidate.gain, loss, visited_.tried)) return false;
    visited_.gain = candidate.gain;
    visited_.parts = std::move(parts);
    return true;
  }

  const Shared& shared_;
  const CurveNetwork& network_;
  const RegularityOptions& options_;
  SearchPool& searches_;
  int attempts_ = 0;
  std::vector<Part> parts_;  ///< polygons of the current cavity
  std::vector<Candidate> candidates_;
  std::map<std::array<int, 5>, bool> room_;  ///< by patch, stretch and change
  Visited visited_;
};

}  // namespace

Visited visit(const Shared& shared, SearchPool& searches, int patch, int vertex) {
  return Visit(shared, searches).run(patch, vertex);
}

}  // namespace delquad::across
