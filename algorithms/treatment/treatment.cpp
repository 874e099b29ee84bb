// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/treatment/treatment.h"

#include <algorithm>

#include "algorithms/treatment/local_remeshing.h"
#include "algorithms/treatment/treatment_moves.h"
#include "base/cancel.h"
#include "base/marks.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "delquad/extend.h"
#include "delquad/matching.h"
#include "geometry/mesh/quad_blocks.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

namespace {

/// Sweeps of local relocation before a move is judged, and for the few moves that may lift a poor element.
constexpr int kTrialSweeps = 4, kRescueSweeps = 12;
/// Largest loss of valence energy by the first move of a pair, and number of tried second moves.
constexpr int kPairLoss = 2, kPairTries = 3;
/// Least energy around at which a pair of moves can gain: a single dislocation (3-5) cannot vanish.
constexpr int kPairEnergy = 3;
/// Passes over quads that are bad in the end.
constexpr int kRemeshingPasses = 5;
/// Limits of eta for new vertices as the last resort, and for remeshing in the end.
constexpr double kInsetEta = 0.15, kRemeshedEta = 0.05;
/// Least relief of penalty by such a move, and more for each unit of valence energy that it costs.
constexpr double kLeastRelief = 0.05, kReliefPerEnergy = 0.05;

/// State and steps of one treatment.
class TreatmentProcess {
 public:
  /// Both must outlive this object.
  TreatmentProcess(const QuadBlock& block, const ParametricSize& size)
      : block_(block),
        mesh_(block.mesh, block.first_held),
        energy_(mesh_),
        relocation_(mesh_, size),
        penalty_(mesh_, relocation_),
        remeshing_(mesh_, relocation_, penalty_),
        queue_(mesh_, energy_),
        most_ring_quads_(kRingQuadsPerElement * mesh_.element_slots()),
        most_looks_(most_looks(mesh_.element_slots())) {}

  void run(const TreatmentOptions& options) {
    for (int e = 0; e < mesh_.element_slots(); ++e) pending_.push_back(is_near(e));
    relocation_.activate_all(block_);
    summary_.relocated += relocation_.relax(0.1, 6);
    // The loop ends after max_rounds. In a round, single moves and pairs lower the valence energy, an integer
    // that is never negative. A rescue, at most one for each initial element, may raise it a little.
    for (int changes = 1; changes > 0 && summary_.rounds < options.max_rounds && !is_spent();
         ++summary_.rounds) {
      changes = single_moves();
      changes += paired_moves();
      summary_.relocated += relocation_.relax(0.05, 10);
      changes += rescues();
    }
    summary_.stopped = is_spent();
    relocation_.keep_convex_corners();
    relocation_.activate_all(block_);
    summary_.relocated += relocation_.relax(options.settled, 30);
    if (options.max_rounds > 0) {
      for (int pass = 0; pass < kRemeshingPasses && remeshings() > 0;) ++pass;
      summary_.relocated += relocation_.relax(options.settled, 30);
    }
    summary_.relocated += relocation_.lift_worst(0.5, 10);
    summary_.looks = relocation_.looks();
  }

  QuadPatch result() const { return mesh_.to_patch(); }
  const TreatmentSummary& summary() const { return summary_; }

 private:
  int single_moves() {
    for (int e = 0; e < mesh_.element_slots(); ++e)
      if (irregular(e) && is_near(e)) consider(e);
    return drain();
  }

  /// Returns the number of changes. The loop ends: it passes elements once, new ones included, and new ones
  /// need a fall of energy.
  int paired_moves() {
    int changes = 0;
    pending_.resize(mesh_.element_slots(), 1);
    for (int e = 0; e < mesh_.element_slots() && !is_spent(); ++e) {
      if (!pending_[e]) continue;
      pending_[e] = 0;
      if (!irregular(e)) continue;
      firsts_.clear();
      for_each_move(mesh_, e, [&](const TreatmentMove& move) {
        const int gain = energy_.gain(move);
        if (gain >= -kPairLoss && is_legal(mesh_, move)) firsts_.push_back({gain, move});
      });
      std::sort(firsts_.rbegin(), firsts_.rend());
      for (const Candidate& first : firsts_)
        if (try_pair(first)) {
          changes += 1 + drain();
          break;
        }
    }
    return changes;
  }

  /// Tries `repair` on each quad below this eta that was not given up. Returns the number of changes. The
  /// loop ends: it visits each initial element once.
  template <class Repair>
  int repair_below(double eta, std::vector<char>& given_up, Repair repair) {
    int changes = 0;
    const double least = sine_of_eta(eta);
    for (int e = 0, n = mesh_.element_slots(); e < n; ++e) {
      check_cancelled();
      given_up.resize(mesh_.element_slots(), 0);
      if (!mesh_.is_quad(e) || given_up[e] || least_sine(mesh_, e) >= least) continue;
      given_up[e] = !repair(e);
      if (!given_up[e]) changes += 1 + drain();
    }
    return changes;
  }

  int rescues() {
    return repair_below(kPoorEta, beyond_rescue_, [&](int e) { return rescue(e); });
  }

  /// Remeshes the neighborhoods of bad quads as the last resort.
  int remeshings() {
    return repair_below(kRemeshedEta, hopeless_, [&](int e) {
      if (!remeshing_.improve(e, kLeastRelief)) return false;
      touched_.assign(remeshing_.touched().begin(), remeshing_.touched().end());
      if (remeshing_.ring_quads() > 0) {
        ++summary_.boundary_repairs;
        summary_.ring_quads += remeshing_.ring_quads();
      } else if (remeshing_.move().at >= 0) {
        count(remeshing_.move());
      }
      accept();
      return true;
    });
  }

  void consider(int element) {
    const auto push = [&](const TreatmentMove& move) {
      const int gain = energy_.gain(move);
      if (gain > 0) queue_.push({gain, move});
    };
    for_each_move(mesh_, element, push);
    for_each_opening(mesh_, element, push);
  }

  /// Tries queued moves. The loop ends: each kept move lowers the valence energy and queues only moves around
  /// it.
  int drain() {
    int changes = 0;
    while (const auto move = queue_.pop())
      if (!is_spent()) changes += try_single(*move);
    return changes;
  }

  bool try_single(const TreatmentMove& move) {
    touched_.clear();
    touch(touched_by(mesh_, move));
    const double before = penalty();
    const auto start = mesh_.mark();
    perform(move);
    if (!settles(before)) {
      mesh_.rollback(start);
      return false;
    }
    count(move);
    accept();
    return true;
  }

  bool try_pair(const Candidate& first) {
    const TouchedVertices touched = touched_by(mesh_, first.move);
    touched_.clear();
    touch(touched);
    const double before = penalty();
    const auto start = mesh_.mark();
    perform(first.move);
    if (find_seconds(touched, first.gain)) {
      int tries = 0;
      for (const Candidate& second : seconds_) {
        if (!is_legal(mesh_, second.move)) continue;
        if (++tries > kPairTries) break;
        touched_.clear();
        touch(touched);
        touch(touched_by(mesh_, second.move));
        const auto middle = mesh_.mark();
        perform(second.move);
        if (settles(before)) {
          count(first.move);
          count(second.move);
          accept();
          return true;
        }
        mesh_.rollback(middle);
      }
    }
    mesh_.rollback(start);
    return false;
  }

  bool find_seconds(const TouchedVertices& touched, int gain) {
    elements_met_.begin(mesh_.element_slots());
    vertices_met_.begin(mesh_.vertex_slots());
    region_.clear();
    int energy = 0;
    for_each_element_around(mesh_, touched, elements_met_, [&](int e) {
      region_.push_back(e);
      for (int k = 0; k < 4; ++k)
        if (const int w = mesh_.corner(e, k); w >= 0 && vertices_met_.meet(w)) energy += energy_.of(w);
    });
    if (energy < kPairEnergy - gain) return false;
    seconds_.clear();
    for (const int e : region_)
      for_each_move(mesh_, e, [&](const TreatmentMove& move) {
        const int total = gain + energy_.gain(move);
        if (total > 0) seconds_.push_back({total, move});
      });
    std::sort(seconds_.rbegin(), seconds_.rend());
    const auto same = [](const Candidate& a, const Candidate& b) { return a.move == b.move; };
    seconds_.erase(std::unique(seconds_.begin(), seconds_.end(), same), seconds_.end());
    return !seconds_.empty();
  }

  bool rescue(int element) {
    if (is_spent()) return false;
    double best = kLeastRelief;
    TreatmentMove choice{TreatmentMove::kInset, -1};
    for_each_move(mesh_, element, [&](const TreatmentMove& move) {
      if (!is_legal(mesh_, move)) return;
      const int loss = std::max(-energy_.gain(move), 0);
      const double relief = relief_of(move) - kReliefPerEnergy * loss;
      if (relief > best) best = relief, choice = move;
    });
    if (choice.at < 0) return least_sine(mesh_, element) < sine_of_eta(kInsetEta) && rescue_by_inset(element);
    touched_.clear();
    touch(touched_by(mesh_, choice));
    const double before = penalty();
    const auto start = mesh_.mark();
    perform(choice);
    relax_touched();
    // The relief was against relaxed neighbors, which may be poorer than the actual ones.
    if (before - penalty() < kLeastRelief) {
      mesh_.rollback(start);
      return false;
    }
    count(choice);
    accept();
    return true;
  }

  /// Adds new vertices in a bad element, and lets single moves repair the valences. Keeps it if all of it
  /// helps.
  bool rescue_by_inset(int element) {
    const TreatmentMove inset{TreatmentMove::kInset, 4 * element};
    if (!is_legal(mesh_, inset) || summary_.ring_quads >= most_ring_quads_) return false;
    const TreatmentSummary summary = summary_;
    const auto start = mesh_.mark();
    touched_.clear();
    touch(touched_by(mesh_, inset));
    const double before = penalty();
    perform(inset);
    relax_touched();
    count(inset);
    revocable_ = true;
    touched_on_trial_.clear();
    accept();
    const std::vector<int> around = touched_;
    drain();
    revocable_ = false;
    touched_ = around;
    relax_touched();
    if (before - penalty() < kLeastRelief) {
      mesh_.rollback(start);
      summary_ = summary;
      return false;
    }
    touched_ = touched_on_trial_;
    accept();
    return true;
  }

  /// Returns the relief of penalty by the move after it has settled.
  double relief_of(const TreatmentMove& move) {
    touched_.clear();
    touch(touched_by(mesh_, move));
    const auto start = mesh_.mark();
    relax_touched();
    const double before = penalty();
    perform(move);
    relax_touched();
    const double after = penalty();
    mesh_.rollback(start);
    return before - after;
  }

  void perform(const TreatmentMove& move) { apply(mesh_, relocation_, move, touched_); }

  void touch(const TouchedVertices& vertices) {
    for (const int v : vertices)
      if (std::find(touched_.begin(), touched_.end(), v) == touched_.end()) touched_.push_back(v);
  }

  void relax_touched() {
    for (int sweep = 0; sweep < kRescueSweeps; ++sweep)
      for (const int v : touched_) relocation_.step(v);
  }

  double penalty() { return penalty_.around(touched_); }

  bool settles(double penalty_before) {
    for (int sweep = 0; sweep < kTrialSweeps; ++sweep) {
      for (const int v : touched_) relocation_.step(v);
      if (penalty() <= penalty_before) return true;
    }
    return false;
  }

  void accept() {
    if (revocable_) {
      touched_on_trial_.insert(touched_on_trial_.end(), touched_.begin(), touched_.end());
      for (const int v : touched_)
        if (mesh_.vertex_alive(v)) mesh_.for_each_out(v, [&](int h) { consider(QuadTopology::element(h)); });
      return;
    }
    mesh_.commit();
    pending_.resize(mesh_.element_slots(), 1);
    hopeless_.resize(mesh_.element_slots(), 0);
    beyond_rescue_.resize(mesh_.element_slots(), 0);
    for (const int v : touched_) {
      if (!mesh_.vertex_alive(v)) continue;
      mesh_.for_each_out(v, [&](int h) {
        const int e = QuadTopology::element(h);
        consider(e);
        pending_[e] = 1;
        hopeless_[e] = beyond_rescue_[e] = 0;
        for (int k = 0; k < 4; ++k)
          if (const int w = mesh_.corner(e, k); w >= 0) relocation_.activate(w);
      });
    }
  }

  void count(const TreatmentMove& move) {
    using S = TreatmentSummary;
    // Indexed by TreatmentMove::Kind; splits do not occur.
    static constexpr int S::*kCounters[] = {
        &S::swaps, &S::swaps,    &S::diamonds, &S::doublets, &S::boundary_repairs,
        &S::swaps, &S::openings, &S::openings};
    ++(summary_.*kCounters[move.kind]);
    if (move.kind == TreatmentMove::kInset) summary_.ring_quads += 4;
  }

  bool is_spent() const { return relocation_.looks() + penalty_.looks() > most_looks_; }

  bool irregular(int element) const {
    for (int k = 0; k < 4; ++k)
      if (const int v = mesh_.corner(element, k); v >= 0 && energy_.of(v) > 0) return true;
    return false;
  }

  bool is_near(int element) const {
    for (int k = 0; k < 4; ++k)
      if (const int v = mesh_.corner(element, k); v >= 0 && block_.is_near(v)) return true;
    return false;
  }

  const QuadBlock& block_;
  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  ShapePenalty penalty_;
  LocalRemeshing remeshing_;
  MoveQueue queue_;                  ///< single moves
  std::vector<char> pending_;        ///< by element: changed since its last pairs of moves
  std::vector<char> hopeless_;       ///< by element: unchanged since remeshing failed
  std::vector<char> beyond_rescue_;  ///< by element: unchanged since no move had enough relief
  std::vector<int> touched_;         ///< vertices of the current move
  std::vector<Candidate> firsts_, seconds_;
  std::vector<int> region_;
  Marks elements_met_, vertices_met_;
  bool revocable_ = false;             ///< accepted moves can still be undone
  std::vector<int> touched_on_trial_;  ///< vertices of these moves
  /// Limit of ring quads for each element, so that rings cannot outgrow the patch.
  static constexpr int kRingQuadsPerElement = 4;
  int most_ring_quads_;
  long long most_looks_;  ///< limit of looks, after which no move is tried
  TreatmentSummary summary_;
};

}  // namespace

QuadPatch treat_paper(QuadPatch mesh, const ParametricSize& size, const TreatmentOptions& options,
                      TreatmentSummary* summary) {
  const Stopwatch watch;
  TreatmentSummary total;
  mesh = work_in_blocks(std::move(mesh), total, [&](const QuadBlock& block, TreatmentSummary& part) {
    TreatmentProcess treatment(block, size);
    treatment.run(options);
    part = treatment.summary();
    return treatment.result();
  });
  total.seconds = watch.seconds();
  if (summary != nullptr) *summary = total;
  return mesh;
}

namespace {

const OptionTable<RecombinationOptions>& recombination_table() {
  static const auto all =
      OptionTable<RecombinationOptions>("recombination", "options of B and G")
          .add({.name = "solver",
                .help = "solver that matches triangles, and makes numbers of edges even",
                .names = matching_solver_names},
               &RecombinationOptions::solver)
          .add({.name = "cost", .help = "cost of merging two triangles in B", .names = merge_cost_names},
               &RecombinationOptions::cost)
          .choice({.name = "treatment", .help = "after the matching"}, &RecombinationOptions::treatment,
                  std::vector<std::pair<std::string, Treatment>>{{"none", Treatment::kNone},
                                                                 {"paper", Treatment::kPaper}})
          .add({.name = "settled",
                .help = "part of an edge below which a move of the treatment calls for no more",
                .above = 0,
                .most = 1},
               &RecombinationOptions::settled);
  return all;
}

}  // namespace

OptionGroup recombination_group() { return recombination_table().group(); }
RecombinationOptions recombination_options(const Options& options) {
  return recombination_table().read(options);
}

}  // namespace delquad
