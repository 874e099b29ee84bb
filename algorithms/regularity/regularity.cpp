// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/regularity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "algorithms/regularity/cavity.h"
#include "algorithms/regularity/fill_trial.h"
#include "algorithms/regularity/patterns.h"
#include "base/cancel.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "geometry/mesh/quad_blocks.h"
#include "geometry/mesh/quad_corners.h"
#include "smoothing/relocation/untangling.h"

namespace delquad {

namespace {

/// Moves below this part of an edge do not activate neighbors.
constexpr double kRelaxed = 0.08;

/// State and steps of one make_regular().
class RegularityProcess {
 public:
  /// `block` and `size` must outlive this object.
  RegularityProcess(const QuadBlock& block, const ParametricSize& size, const RegularityOptions& options)
      : block_(block),
        mesh_(block.mesh, block.first_held),
        energy_(mesh_),
        relocation_(mesh_, size),
        options_(options),
        search_(mesh_, energy_),
        cavity_(search_.cavity()),
        trial_(mesh_, relocation_),
        opened_(lengthen_short_edges(mesh_, size)) {}

  void run() {
    limit_relocation(relocation_);
    if (options_.settles_first) {
      relocation_.activate_all(block_);
      summary_.relocated += relocation_.relax(kRelaxed, 10);
    }
    for (int round = 0; round < options_.rounds; ++round) {
      tolerance_ = tolerance_of(options_, round);
      quads_per_gain_ = quads_per_gain_of(options_, round);
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
    if (summary_.accepted > 0 || opened_ > 0) {
      relocation_.activate_all(block_);
      summary_.relocated += relax_at_last(relocation_);
    }
    summary_.looks = relocation_.looks();
  }

  QuadPatch result() const { return summary_.accepted > 0 || opened_ > 0 ? mesh_.to_patch() : block_.mesh; }
  const RegularitySummary& summary() const { return summary_; }

 private:
  /// A cavity whose pattern may have fewer irregular vertices.
  struct Candidate {
    double priority;  ///< lower ones are tried first
    int gain;
    std::uint64_t key;
    std::vector<int> elements;
    std::optional<Pattern> pattern;  ///< none if this visit did not search it
    friend bool operator<(const Candidate& a, const Candidate& b) {
      return a.priority != b.priority ? a.priority < b.priority : a.key < b.key;
    }
  };
  /// Known facts of a cavity.
  struct CavityFacts {
    int least = -1;  ///< irregular vertices of its best pattern; negative: no pattern
    /// Loss of its fill for each removed irregular vertex.
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
    candidates_.clear();
    search_.grow(v, options_.quads, [&] { consider(); });
    std::ranges::sort(candidates_, std::less<>());
    const long long tried = summary_.tried;
    for (Candidate& candidate : candidates_) {
      if (attempt(candidate)) return accept();
      if (summary_.tried == tried + kMostTrials) return;
    }
  }

  /// Makes a candidate of the cavity, or of the cavity with more rings of quads.
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
      CavityFacts& known = at->second;
      std::optional<Pattern> pattern;
      if (is_new) {
        pattern = best_pattern(outline(), irregular - 1);
        known.least = pattern ? irregular_vertices(*pattern) : -1;
      }
      if (const int gain = irregular - known.least; known.least >= 0 && gain > 0) {
        ++summary_.cavities;
        if (known.loss > tolerance_ || !pays(gain)) return;
        candidates_.push_back({promise_of(n, known.least, gain),
                               gain,
                               key,
                               {cavity_.elements().begin(), cavity_.elements().end()},
                               std::move(pattern)});
        return;
      }
      if (!search_.add_ring()) return;
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

  /// Fills a cavity with its best pattern. Undoes it if it costs too much.
  bool attempt(Candidate& candidate) {
    cavity_.begin(options_.quads);
    for (const int e : candidate.elements) cavity_.add(e);
    if (!cavity_.close()) return false;
    const Outline rim = outline();
    CavityFacts& known = known_[candidate.key];
    if (!candidate.pattern) candidate.pattern = best_pattern(rim, known.least);
    known.loss = std::numeric_limits<double>::infinity();
    if (!candidate.pattern) return false;
    trial_.collect_region(cavity_);
    const std::size_t n_outer = trial_.region.size();
    for (const int v : cavity_.vertices())
      if (cavity_.is_inside(v)) trial_.region.push_back(v);
    trial_.measure_before();
    trial_.region.resize(n_outer);

    const PatternMesh fill = mesh_pattern(rim, *candidate.pattern);
    const auto start = mesh_.mark();
    const int first = mesh_.vertex_slots();
    if (!mesh_.refill(cavity_.elements(), cavity_.rim(), fill.inside, fill.quads)) return false;
    relocation_.adopt_new_vertices(first);
    std::vector<int> inside(fill.inside.size());
    std::iota(inside.begin(), inside.end(), first);
    trial_.region.insert(trial_.region.begin(), inside.begin(), inside.end());
    trial_.collect_elements();
    double loss = 0;
    if (settle(trial_, tolerance_ * candidate.gain / trial_.before.n, loss, summary_.tried)) {
      ++summary_.accepted;
      summary_.grids += candidate.pattern->kind == Pattern::kGrid ? 1 : 0;
      return true;
    }
    known.loss = loss * trial_.before.n / candidate.gain;
    mesh_.rollback(start);
    return false;
  }

  void accept() {
    mesh_.commit();
    for (const int v : trial_.region) {
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
  CavitySearch search_;
  Cavity& cavity_;
  FillTrial trial_;
  int opened_;                        ///< edges that had no length
  double tolerance_ = 0;              ///< of this round
  double quads_per_gain_ = 0;         ///< limit for cavities of this round
  std::vector<int> visiting_, work_;  ///< irregular vertices of this round and of the next one
  std::vector<char> listed_;          ///< by vertex: whether it is in work_
  std::vector<Candidate> candidates_;
  std::unordered_map<std::uint64_t, CavityFacts> known_;  ///< by Cavity::key()
  RegularitySummary summary_;
};

}  // namespace

int count_irregular(const QuadPatch& mesh) {
  std::vector<int> valence(mesh.points.size(), 0);
  std::vector<double> angle(mesh.n_boundary, 0);
  const auto add = [&](const auto& corners) {
    const std::size_t n = corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      const int v = corners[k];
      ++valence[v];
      if (v >= mesh.n_boundary) continue;
      const Vec2 out = mesh.points[corners[(k + 1) % n]] - mesh.points[v];
      const Vec2 in = mesh.points[corners[(k + n - 1) % n]] - mesh.points[v];
      angle[v] += std::atan2(cross(out, in), dot(out, in));
    }
  };
  for (const auto& quad : mesh.quads) add(quad);
  for (const auto& triangle : mesh.triangles) add(triangle);
  int irregular = 0;
  for (std::size_t v = 0; v < valence.size(); ++v) {
    int ideal = 4;
    if (v < angle.size()) {
      const double turns = angle[v] / (2 * std::numbers::pi);
      ideal = ideal_quads(4 * (turns - std::ceil(turns) + 1));
    }
    irregular += valence[v] > 0 && valence[v] != ideal;
  }
  return irregular;
}

QuadPatch make_regular(const QuadPatch& mesh, const ParametricSize& size, const RegularityOptions& options,
                       RegularitySummary* summary) {
  const Stopwatch watch;
  RegularitySummary total;
  QuadPatch result = work_in_blocks(mesh, total, [&](const QuadBlock& block, RegularitySummary& part) {
    RegularityProcess process(block, size, options);
    process.run();
    part = process.summary();
    return process.result();
  });
  if (summary == nullptr) return result;
  *summary = total;
  summary->irregular_before = count_irregular(mesh);
  summary->irregular_after = count_irregular(result);
  summary->seconds = watch.seconds();
  return result;
}

namespace {

const OptionTable<RegularityOptions>& table() {
  static const auto all =
      OptionTable<RegularityOptions>("regularity", "options of C, Q and R")
          .add({.name = "tolerance",
                .help = "price of an irregular vertex, in quads times eta",
                .least = 0,
                .most = 100},
               &RegularityOptions::tolerance)
          .add({.name = "quads", .help = "most quads of a cavity", .least = 1, .most = 2000},
               &RegularityOptions::quads)
          .add({.name = "rounds", .help = "over which the tolerance grows", .least = 1, .most = 1000},
               &RegularityOptions::rounds)
          .add({.name = "weight",
                .help = "weight of irregular vertices against sizes: factor of curves.agreement and "
                        "regularity.tolerance",
                .least = 0,
                .most = 1000},
               &RegularityOptions::weight)
          .add({.name = "usual_quads",
                .help = "beyond so many quads, prices of irregular vertices grow with their number, up to "
                        "fourfold, with cavities of up to 1000 quads; 0: never",
                .least = 0},
               &RegularityOptions::usual_quads);
  return all;
}

}  // namespace

double price_factor(const RegularityOptions& options, double quads) {
  return options.usual_quads > 0 ? std::clamp(quads / options.usual_quads, 1.0, kMostPriceFactor) : 1;
}

RegularityOptions without_price(RegularityOptions options) {
  options.tolerance = 0;
  options.settles_first = true;
  return options;
}

OptionGroup regularity_group() { return table().group(); }

RegularityOptions regularity_options(const Options& options) {
  RegularityOptions read = table().read(options);
  read.tolerance *= read.weight;
  return read;
}

}  // namespace delquad
