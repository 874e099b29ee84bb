#include "algorithms/regularity/regularity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "algorithms/cleanup/edit_in_blocks.h"
#include "algorithms/regularity/patterns.h"
#include "algorithms/treatment/treatment_moves.h"
#include "base/cancel.h"
#include "base/marks.h"
#include "base/option_table.h"
#include "geometry/mesh/quad_blocks.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/element_quality.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

namespace {

/// Scatters the bits of a number (splitmix64).
std::uint64_t scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Quads that other quads may replace. A vertex of the rim wants so many quads inside as its ideal valence is
/// more than its quads outside: one at a corner, two on a side. A closed cavity has no others, but for
/// concave vertices of the boundary, and its rim is one loop.
class Cavity {
 public:
  /// Both outlive this object.
  Cavity(const QuadTopology& mesh, const ValenceEnergy& energy) : mesh_(mesh), energy_(energy) {}

  /// Empty, and never more than `most` quads.
  void begin(int most) {
    ++pass_;
    most_ = most;
    element_pass_.resize(mesh_.element_slots(), 0);
    vertex_pass_.resize(mesh_.vertex_slots(), 0);
    quads_at_.resize(mesh_.vertex_slots(), 0);
    checked_at_.resize(mesh_.vertex_slots(), 0);
    elements_.clear(), vertices_.clear(), to_check_.clear();
  }

  /// False, here and below: it would have a triangle, a held vertex or too many quads. It can be no cavity
  /// then.
  bool add(int element) {
    if (has(element)) return true;
    if (elements_.size() >= most_ || !mesh_.is_quad(element)) return false;
    element_pass_[element] = pass_;
    elements_.push_back(element);
    for (int k = 0; k < 4; ++k) {
      const int v = mesh_.corner(element, k);
      if (mesh_.held(v)) return false;
      if (vertex_pass_[v] != pass_) {
        vertex_pass_[v] = pass_;
        quads_at_[v] = checked_at_[v] = 0;
        vertices_.push_back(v);
      }
      ++quads_at_[v];
      to_check_.push_back(v);
    }
    return true;
  }

  bool add_around(int vertex) {
    bool good = true;
    mesh_.for_each_out(vertex, [&](int h) { good = good && add(QuadTopology::element(h)); });
    return good;
  }

  /// Adds the quads at vertices of the rim that want none, or three and more, as long as there are any.
  /// False, too, where the boundary is too concave, or the rim no loop with 2 to 8 corners (concave ones
  /// taken off).
  bool close() {
    while (!to_check_.empty()) {
      const int v = to_check_.back();
      to_check_.pop_back();
      if (checked_at_[v] == quads_at_[v] || is_inside(v)) continue;
      checked_at_[v] = quads_at_[v];
      const int want = wanted(v), most = quads_at_[v] == mesh_.valence(v) ? 3 : 2;
      if (want >= 1 && want <= most && fans_at(v) == 1) continue;
      if (most == 3 || !add_around(v)) return false;
    }
    return trace();
  }

  std::span<const int> elements() const { return elements_; }
  /// All vertices, also of the rim.
  std::span<const int> vertices() const { return vertices_; }
  /// Of a closed one: the half-edges of the rim counterclockwise, and 2 - (quads wanted) of their origins.
  std::span<const int> rim() const { return rim_; }
  std::span<const int> turns() const { return turns_; }
  int corners() const { return corners_; }
  bool is_inside(int vertex) const {
    return !mesh_.on_boundary(vertex) && quads_at(vertex) == mesh_.valence(vertex);
  }
  bool has(int element) const {
    return static_cast<std::size_t>(element) < element_pass_.size() && element_pass_[element] == pass_;
  }

  /// How many of its vertices are irregular.
  int irregular() const {
    return static_cast<int>(std::ranges::count_if(vertices_, [&](int v) { return energy_.of(v) > 0; }));
  }

  /// A number that tells cavities apart, and what lies around them.
  std::uint64_t key() const {
    std::uint64_t sum = 0;
    for (const int e : elements_) sum += scattered(2 * static_cast<std::uint64_t>(e));
    for (const int v : vertices_)
      if (!is_inside(v))
        sum += scattered((static_cast<std::uint64_t>(v) << 5) + 2 * std::min(wanted(v) + 1, 7) + 1);
    return sum;
  }

 private:
  int quads_at(int v) const {
    return static_cast<std::size_t>(v) < vertex_pass_.size() && vertex_pass_[v] == pass_ ? quads_at_[v] : 0;
  }
  int wanted(int v) const { return energy_.ideal(v) - (mesh_.valence(v) - quads_at(v)); }

  /// Runs of its quads around a vertex.
  int fans_at(int v) const {
    if (quads_at(v) == 1 || (!mesh_.on_boundary(v) && quads_at(v) == mesh_.valence(v) - 1)) return 1;
    int fans = 0, first = -1, last = -1;
    mesh_.for_each_out(v, [&](int h) {
      const int in = has(QuadTopology::element(h)) ? 1 : 0;
      if (first < 0) first = in;
      if (in == 1 && last != 1) ++fans;
      last = in;
    });
    return fans - (!mesh_.on_boundary(v) && first == 1 && last == 1 && fans > 1 ? 1 : 0);
  }

  bool trace() {
    rim_.clear(), turns_.clear(), corners_ = 0;
    const auto is_outer = [&](int h) {
      return mesh_.twin(h) < 0 || !has(QuadTopology::element(mesh_.twin(h)));
    };
    std::size_t n_outer = 0;
    int first = -1;
    for (const int e : elements_)
      for (int h = 4 * e; h < 4 * e + 4; ++h) {
        if (!is_outer(h)) continue;
        ++n_outer;
        if (first < 0 || h < first) first = h;
      }
    int h = first;
    do {
      if (rim_.size() == n_outer) return false;
      rim_.push_back(h);
      turns_.push_back(2 - wanted(mesh_.origin(h)));
      corners_ += turns_.back();
      h = mesh_.next(h);
      while (!is_outer(h)) h = mesh_.next(mesh_.twin(h));
    } while (h != first);
    return rim_.size() == n_outer && corners_ >= 2 && corners_ <= 8;
  }

  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  std::size_t most_ = 0;
  unsigned pass_ = 0;
  std::vector<unsigned> element_pass_, vertex_pass_;  ///< the last pass in which each was met
  std::vector<int> quads_at_;                         ///< by vertex of this pass
  std::vector<int> checked_at_;                       ///< and how many there were when it was checked last
  std::vector<int> elements_, vertices_, to_check_, rim_, turns_;
  int corners_ = 0;  ///< sum of the turns
};

/// How many irregular vertices near one make cavities with it, and among how many vertices they are looked
/// for, for each quad that a cavity may have. With 5, a quarter more cavities on the plate of 16 holes bring
/// nothing.
constexpr std::size_t kNear = 4, kMostMet = 3;
/// Cavities of a vertex that are tried in a round. A third brings nothing, either.
constexpr int kMostTrials = 2;
/// Rings of quads that a cavity grows by until it has a pattern.
constexpr int kMostRings = 2;
/// Cavities with few quads are tried first, an irregular vertex that stays counts as so many.
constexpr double kQuadsPerIrregular = 10;
/// Quads that a cavity may have for each irregular vertex less in the first round, and how many times more in
/// each further one; the last one has no limit. Of the fills of larger ones one in thirty would be kept.
constexpr double kQuadsPerGain = 15, kMoreQuads = 3;
/// Sweeps within which a fill must settle.
constexpr int kFillSweeps = 12;
/// A fill is given up where a sweep mends less than this part of what it loses too much, or of what its worst
/// corner lacks.
constexpr double kHopelessPart = 0.2;
/// And where at any time the sum loses so much more than it may, times the square root of the quads around.
/// Without that, relocation costs half as much again and mends as many on the plate of 16 holes; with 1.2 it
/// costs a fifth less and mends 2 % fewer.
constexpr double kHopelessLoss = 1.6;
/// As in CleanupProcess: the part of an edge below which a move calls for no more, in the end, too.
constexpr double kRelaxed = 0.08, kRelaxedAtLast = 0.02;

/// The state and the steps of one make_regular().
class RegularityProcess {
 public:
  /// Block and size outlive this object.
  RegularityProcess(const QuadBlock& block, const ParametricSize& size, const RegularityOptions& options)
      : block_(block),
        mesh_(block.mesh, block.first_held),
        energy_(mesh_),
        relocation_(mesh_, size),
        options_(options),
        cavity_(mesh_, energy_) {}

  void run() {
    relocation_.keep_convex_corners();
    relocation_.hold_lengths();
    relocation_.keep_sines_above(sine_of_eta(kCleanupFloorEta));
    for (int round = 0; round < options_.rounds; ++round) {
      tolerance_ =
          options_.rounds > 1 ? options_.tolerance * round / (options_.rounds - 1) : options_.tolerance;
      quads_per_gain_ =
          round + 1 < options_.rounds ? kQuadsPerGain * std::pow(kMoreQuads, round) : options_.quads;
      work_.clear();
      listed_.assign(mesh_.vertex_slots(), 0);
      for (int v = 0; v < mesh_.vertex_slots(); ++v)
        if (block_.is_near(v)) list(v);
      while (!work_.empty()) {
        visiting_.swap(work_);
        work_.clear();
        for (const int v : visiting_) listed_[v] = 0;
        for (const int v : visiting_)
          if (mesh_.vertex_alive(v) && energy_.of(v) > 0) visit(v);
      }
    }
    if (summary_.accepted > 0) {
      relocation_.activate_all(block_);
      summary_.relocated += relocation_.relax(kRelaxedAtLast, 30);
      summary_.relocated += relocation_.lift_worst(kCleanupFloorEta, 10);
    }
    summary_.looks = relocation_.looks();
  }

  QuadPatch result() const { return mesh_.to_patch(); }
  const RegularitySummary& summary() const { return summary_; }

 private:
  /// A cavity that may be filled with fewer irregular vertices.
  struct Candidate {
    double promise;  ///< the less, the sooner it is tried
    int gain;
    std::uint64_t key;
    std::vector<int> elements;
    std::optional<Pattern> pattern;  ///< none where it was not sought in this visit
    friend bool operator<(const Candidate& a, const Candidate& b) {
      return a.promise != b.promise ? a.promise < b.promise : a.key < b.key;
    }
  };
  /// Of elements_.
  struct Quality {
    double mean = 0;  ///< of their values
    double least_sine = 1;
    int failing = 0, thin = 0;
    double crowding = 0;
    int n = 0;
  };
  /// What is known of a cavity.
  struct Known {
    int least = -1;  ///< irregular vertices of its patterns; negative: it has none
    /// That a fill brought, for each irregular vertex less.
    double loss = -std::numeric_limits<double>::infinity();
  };

  void list(int v) {
    listed_.resize(mesh_.vertex_slots(), 0);
    if (listed_[v] || !mesh_.vertex_alive(v) || energy_.of(v) == 0) return;
    listed_[v] = 1;
    work_.push_back(v);
  }

  void visit(int v) {
    check_cancelled();
    find_near(v);
    candidates_.clear();
    cavity_.begin(options_.quads);
    if (cavity_.add_around(v)) consider();
    for (std::size_t j = 0; j < near_.size(); ++j) {
      cavity_.begin(options_.quads);
      if (cavity_.add_around(v) && add_path(near_[j])) consider();
      if (j == 0) continue;
      cavity_.begin(options_.quads);
      bool good = cavity_.add_around(v);
      for (std::size_t i = 0; i <= j && good; ++i) good = add_path(near_[i]);
      if (good) consider();
    }
    std::ranges::sort(candidates_, std::less<>());
    const long long tried = summary_.tried;
    for (Candidate& candidate : candidates_) {
      if (attempt(candidate)) return accept();
      if (summary_.tried == tried + kMostTrials) return;
    }
  }

  /// Irregular vertices around v, as far as quads go from vertex to vertex.
  void find_near(int v) {
    near_.clear();
    vertices_met_.begin(mesh_.vertex_slots());
    from_.resize(mesh_.vertex_slots());
    vertices_met_.meet(v);
    std::vector<int> queue{v};
    from_[v] = v;
    const std::size_t most = kMostMet * static_cast<std::size_t>(options_.quads);
    for (std::size_t i = 0; i < queue.size() && queue.size() < most; ++i) {
      const int at = queue[i];
      const auto reach = [&](int w) {
        if (mesh_.held(w) || !vertices_met_.meet(w)) return;
        from_[w] = at;
        queue.push_back(w);
        if (energy_.of(w) > 0) near_.push_back(w);
      };
      mesh_.for_each_out(at, [&](int h) {
        reach(mesh_.target(h));
        reach(mesh_.target(mesh_.next(h)));
        reach(mesh_.origin(mesh_.prev(h)));
      });
      if (near_.size() >= kNear) break;
    }
    if (near_.size() > kNear) near_.resize(kNear);
  }

  /// Adds the quads around `from` and those on the way to the visited vertex.
  bool add_path(int from) {
    if (!cavity_.add_around(from)) return false;
    bool good = true;
    for (int v = from; from_[v] != v && good; v = from_[v])
      mesh_.for_each_out(v, [&](int h) {
        const int e = QuadTopology::element(h);
        bool on_way = false;
        for (int k = 0; k < 4; ++k) on_way |= mesh_.corner(e, k) == from_[v];
        if (on_way) good = good && cavity_.add(e);
      });
    return good;
  }

  /// Makes a candidate of the cavity, or of it with rings of quads more, if it is one.
  void consider() {
    for (int ring = 0; ring <= kMostRings; ++ring) {
      if (!cavity_.close()) return;
      const int irregular = cavity_.irregular();
      const double n = static_cast<double>(cavity_.elements().size());
      const auto pays = [&](int gain) { return gain > 0 && n <= gain * quads_per_gain_; };
      if (!pays(irregular - std::abs(4 - cavity_.corners()))) return;
      const std::uint64_t key = cavity_.key();
      if (std::ranges::find(candidates_, key, &Candidate::key) != candidates_.end()) return;
      const auto [at, is_new] = known_.try_emplace(key);
      Known& known = at->second;
      std::optional<Pattern> pattern;
      if (is_new) {
        pattern = best_pattern(outline(), irregular - 1);
        known.least = pattern ? irregular_vertices(*pattern) : -1;
      }
      if (const int gain = irregular - known.least; known.least >= 0 && gain > 0) {
        ++summary_.cavities;
        if (known.loss > tolerance_ || !pays(gain)) return;
        candidates_.push_back({(n + kQuadsPerIrregular * known.least) / gain,
                               gain,
                               key,
                               {cavity_.elements().begin(), cavity_.elements().end()},
                               std::move(pattern)});
        return;
      }
      for (const int h : cavity_.rim())
        if (!cavity_.add_around(mesh_.origin(h))) return;
    }
  }

  Outline outline() const {
    Outline outline;
    for (const int h : cavity_.rim()) {
      outline.places.push_back(mesh_.point(mesh_.origin(h)));
      outline.delta.push_back(relocation_.delta(mesh_.origin(h)));
    }
    outline.turn.assign(cavity_.turns().begin(), cavity_.turns().end());
    return outline;
  }

  /// Fills a cavity with its best pattern; takes all back where that costs too much.
  bool attempt(Candidate& candidate) {
    cavity_.begin(options_.quads);
    for (const int e : candidate.elements) cavity_.add(e);
    if (!cavity_.close()) return false;
    const Outline rim = outline();
    Known& known = known_[candidate.key];
    if (!candidate.pattern) candidate.pattern = best_pattern(rim, known.least);
    known.loss = std::numeric_limits<double>::infinity();
    if (!candidate.pattern) return false;
    collect_region();
    const std::size_t n_outer = region_.size();
    for (const int v : cavity_.vertices())
      if (cavity_.is_inside(v)) region_.push_back(v);
    collect_elements();
    const Quality before = quality();
    region_.resize(n_outer);

    const PatternMesh fill = mesh_pattern(rim, *candidate.pattern);
    const auto start = mesh_.mark();
    const int first = mesh_.vertex_slots();
    if (!mesh_.refill(cavity_.elements(), cavity_.rim(), fill.inside, fill.quads)) return false;
    relocation_.adopt_new_vertices(first);
    region_.insert(region_.begin(), fill.inside.size(), 0);
    std::iota(region_.begin(), region_.begin() + static_cast<std::ptrdiff_t>(fill.inside.size()), first);
    collect_elements();
    double loss = 0;
    if (settles(before, tolerance_ * candidate.gain / before.n, loss)) {
      ++summary_.accepted;
      summary_.grids += candidate.pattern->kind == Pattern::kGrid ? 1 : 0;
      return true;
    }
    known.loss = loss * before.n / candidate.gain;
    mesh_.rollback(start);
    return false;
  }

  /// The vertices of the rim and of the quads around it; those within are others before and after.
  void collect_region() {
    region_.clear();
    vertices_met_.begin(mesh_.vertex_slots());
    for (const int h : cavity_.rim())
      mesh_.for_each_out(mesh_.origin(h), [&](int g) {
        const int e = QuadTopology::element(g);
        for (int k = 0; k < 4; ++k)
          if (const int v = mesh_.corner(e, k); v >= 0 && !cavity_.is_inside(v) && vertices_met_.meet(v))
            region_.push_back(v);
      });
  }

  /// Relocates the region; whether the loss of the mean gets as small as allowed.
  bool settles(const Quality& before, double allowed, double& loss) {
    const double least = std::min(before.least_sine, sine_of_eta(kCleanupFloorEta));
    const double hopeless = allowed + kHopelessLoss / std::sqrt(before.n);
    double last_loss = 0, last_sine = 0;
    const auto is_slow = [](double mended, double lack) { return lack > 0 && mended < kHopelessPart * lack; };
    for (int sweep = 0; sweep <= kFillSweeps; ++sweep) {
      if (sweep == 1) ++summary_.tried;
      if (sweep > 0)
        for (const int v : region_) relocation_.step(v);
      const Quality after = quality();
      loss = before.mean - after.mean;
      if (after.least_sine >= least && after.failing <= before.failing && after.thin <= before.thin &&
          after.crowding <= before.crowding && loss <= allowed)
        return true;
      if (loss > hopeless) return false;
      if (sweep > 2 && is_slow(last_loss - loss, loss - allowed)) return false;
      if (sweep > 2 && is_slow(after.least_sine - last_sine, least - after.least_sine)) break;
      last_loss = loss, last_sine = after.least_sine;
    }
    // A corner gets no better where more may be lost.
    if (loss <= allowed) loss = std::numeric_limits<double>::infinity();
    return false;
  }

  void collect_elements() {
    elements_.clear();
    elements_met_.begin(mesh_.element_slots());
    for_each_element_around(mesh_, region_, elements_met_, [&](int e) { elements_.push_back(e); });
  }

  Quality quality() const {
    ElementQuality total;
    for (const int e : elements_) total.add(element_quality(mesh_, relocation_, e));
    const int n = static_cast<int>(elements_.size());
    return {total.value / std::max(n, 1), total.least_sine, total.failing, total.thin, total.crowding, n};
  }

  void accept() {
    mesh_.commit();
    for (const int v : region_) {
      relocation_.activate(v);
      list(v);
    }
    relocation_.relax(kRelaxed, 1);
  }

  const QuadBlock& block_;
  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  RegularityOptions options_;
  Cavity cavity_;
  double tolerance_ = 0;              ///< of this round
  double quads_per_gain_ = 0;         ///< of this round's cavities, at most
  std::vector<int> visiting_, work_;  ///< irregular vertices of this round and of the next
  std::vector<char> listed_;          ///< by vertex: in work_
  std::vector<int> near_;             ///< irregular vertices near the visited one, the nearest first
  std::vector<int> from_;             ///< by vertex met: where the search came from
  std::vector<Candidate> candidates_;
  std::unordered_map<std::uint64_t, Known> known_;  ///< by Cavity::key()
  std::vector<int> region_;                         ///< vertices that move
  std::vector<int> elements_;                       ///< around these
  Marks elements_met_, vertices_met_;
  RegularitySummary summary_;
};

}  // namespace

QuadPatch make_regular(const QuadPatch& mesh, const ParametricSize& size, const RegularityOptions& options,
                       RegularitySummary* summary) {
  return edit_in_blocks<RegularityProcess>(mesh, size, options, summary);
}

namespace {

const OptionTable<RegularityOptions>& table() {
  static const auto all =
      OptionTable<RegularityOptions>("regularity", "options of Q")
          .add({.name = "tolerance",
                .help = "what an irregular vertex less may cost: quads times eta",
                .least = 0,
                .most = 100},
               &RegularityOptions::tolerance)
          .add({.name = "quads", .help = "of a cavity, at most", .least = 1, .most = 2000},
               &RegularityOptions::quads)
          .add({.name = "rounds", .help = "over which the tolerance grows", .least = 1, .most = 1000},
               &RegularityOptions::rounds);
  return all;
}

}  // namespace

OptionGroup regularity_group() { return table().group(); }
RegularityOptions regularity_options(const Options& options) { return table().read(options); }

}  // namespace delquad
