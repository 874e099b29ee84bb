#include "algorithms/treatment/treatment.h"

#include <algorithm>

#include "algorithms/treatment/treatment_process.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "delquad/matching.h"

namespace delquad {

namespace {

/// Sweeps of local relocation within which a move must settle; and for the few that may lift a poor element.
constexpr int kTrialSweeps = 4, kRescueSweeps = 12;
/// In the end vertices rest once they would move by less than this part of an edge.
constexpr double kSettled = 0.02;
/// A pair's first move may cost this much valence energy; of its second moves so many are tried.
constexpr int kPairLoss = 2, kPairTries = 3;
/// No pair of moves gains where the energy around is less: a dislocation alone (3-5) cannot vanish.
constexpr int kPairEnergy = 3;
/// Passes over the quads that are bad in the end.
constexpr int kRemeshingPasses = 5;

}  // namespace

void TreatmentProcess::run(const TreatmentOptions& options) {
  for (int e = 0; e < mesh_.element_slots(); ++e) pending_.push_back(is_near(e));
  relocation_.activate_all(block_);
  summary_.relocated += relocation_.relax(0.1, 6);
  // Ends after max_rounds. In a round, single moves and pairs lower the valence energy, an integer that is
  // never negative; a rescue, at most one for each element that the round began with, may raise it by a few.
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
  summary_.relocated += relocation_.relax(kSettled, 30);
  if (options.max_rounds > 0) {
    for (int pass = 0; pass < kRemeshingPasses && remeshings() > 0;) ++pass;
    summary_.relocated += relocation_.relax(kSettled, 30);
  }
  summary_.relocated += relocation_.lift_worst(0.5, 10);
  summary_.looks = relocation_.looks();
}

// --- single moves, the largest gain first

bool TreatmentProcess::irregular(int element) const {
  for (int k = 0; k < 4; ++k)
    if (const int v = mesh_.corner(element, k); v >= 0 && energy_.of(v) > 0) return true;
  return false;
}

void TreatmentProcess::consider(int element) {
  const auto push = [&](const TreatmentMove& move) {
    const int gain = energy_.gain(move);
    if (gain > 0) queue_.push({gain, move});
  };
  for_each_move(mesh_, element, push);
  for_each_opening(mesh_, element, push);
}

bool TreatmentProcess::is_near(int element) const {
  for (int k = 0; k < 4; ++k)
    if (const int v = mesh_.corner(element, k); v >= 0 && block_.is_near(v)) return true;
  return false;
}

int TreatmentProcess::single_moves() {
  for (int e = 0; e < mesh_.element_slots(); ++e)
    if (irregular(e) && is_near(e)) consider(e);
  return drain();
}

/// Ends: each move that is kept lowers the valence energy and calls for no more others than lie around it.
int TreatmentProcess::drain() {
  int changes = 0;
  while (const auto move = queue_.pop())
    if (!is_spent()) changes += try_single(*move);
  return changes;
}

bool TreatmentProcess::try_single(const TreatmentMove& move) {
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

// --- pairs of moves: the first may cost energy, both together gain

/// Ends: elements are passed once, new ones included, and there are new ones only where energy fell.
int TreatmentProcess::paired_moves() {
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

bool TreatmentProcess::try_pair(const Candidate& first) {
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

bool TreatmentProcess::find_seconds(const TouchedVertices& touched, int gain) {
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

// --- trials

void TreatmentProcess::touch(const TouchedVertices& vertices) {
  for (const int v : vertices)
    if (std::find(touched_.begin(), touched_.end(), v) == touched_.end()) touched_.push_back(v);
}

void TreatmentProcess::relax_touched() {
  for (int sweep = 0; sweep < kRescueSweeps; ++sweep)
    for (const int v : touched_) relocation_.step(v);
}

bool TreatmentProcess::settles(double penalty_before) {
  for (int sweep = 0; sweep < kTrialSweeps; ++sweep) {
    for (const int v : touched_) relocation_.step(v);
    if (penalty() <= penalty_before) return true;
  }
  return false;
}

void TreatmentProcess::accept() {
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

void TreatmentProcess::count(const TreatmentMove& move) {
  using S = TreatmentSummary;
  // By TreatmentMove::Kind; there are no splits.
  static constexpr int S::*kCounters[] = {
      &S::swaps, &S::swaps,    &S::diamonds, &S::doublets, &S::boundary_repairs,
      &S::swaps, &S::openings, &S::openings};
  ++(summary_.*kCounters[move.kind]);
  if (move.kind == TreatmentMove::kInset) summary_.ring_quads += 4;
}

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
  total.seconds = watch.work_seconds();
  if (summary != nullptr) *summary = total;
  return mesh;
}

namespace {

const OptionTable<RecombinationOptions>& recombination_table() {
  static const auto all =
      OptionTable<RecombinationOptions>("recombination", "options of B and G")
          .add({.name = "solver",
                .help = "what matches triangles, and makes counts on curves even",
                .names = matching_solver_names},
               &RecombinationOptions::solver)
          .choice({.name = "treatment", .help = "after the matching"}, &RecombinationOptions::treatment,
                  std::vector<std::pair<std::string, Treatment>>{{"none", Treatment::kNone},
                                                                 {"paper", Treatment::kPaper}});
  return all;
}

}  // namespace

OptionGroup recombination_group() { return recombination_table().group(); }
RecombinationOptions recombination_options(const Options& options) {
  return recombination_table().read(options);
}

}  // namespace delquad
