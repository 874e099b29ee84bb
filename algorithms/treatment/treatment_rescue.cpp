#include "algorithms/treatment/treatment_process.h"

#include <algorithm>

#include "base/cancel.h"

namespace delquad {

namespace {

/// Below this eta even new vertices are welcome, once nothing else helps; and in the end remeshing.
constexpr double kInsetEta = 0.15, kRemeshedEta = 0.05;
/// How much penalty such a move must take off, and more for each unit of valence energy that it costs.
constexpr double kLeastRelief = 0.05, kReliefPerEnergy = 0.05;

}  // namespace

/// Ends: each element that was there at the start is looked at once.
template <class Mend>
int TreatmentProcess::mend_below(double eta, std::vector<char>& given_up, Mend mend) {
  int changes = 0;
  const double least = sine_of_eta(eta);
  for (int e = 0, n = mesh_.element_slots(); e < n; ++e) {
    check_cancelled();
    given_up.resize(mesh_.element_slots(), 0);
    if (!mesh_.is_quad(e) || given_up[e] || least_sine(mesh_, e) >= least) continue;
    given_up[e] = !mend(e);
    if (!given_up[e]) changes += 1 + drain();
  }
  return changes;
}

int TreatmentProcess::rescues() {
  return mend_below(kPoorEta, beyond_rescue_, [&](int e) { return rescue(e); });
}

bool TreatmentProcess::rescue(int element) {
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
  // The relief was against relaxed neighbours, which may be poorer than those that are there.
  if (before - penalty() < kLeastRelief) {
    mesh_.rollback(start);
    return false;
  }
  count(choice);
  accept();
  return true;
}

/// How much penalty the move takes off once it has settled.
double TreatmentProcess::relief_of(const TreatmentMove& move) {
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

/// New vertices in a bad element, after which single moves put the valences right: kept if all of it helps.
bool TreatmentProcess::rescue_by_inset(int element) {
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

/// The last resort: the neighbourhoods of bad quads.
int TreatmentProcess::remeshings() {
  return mend_below(kRemeshedEta, hopeless_, [&](int e) {
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

}  // namespace delquad
