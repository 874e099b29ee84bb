#include "algorithms/recombination/treatment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <queue>

#include "algorithms/recombination/treatment_moves.h"
#include "smoothing/quad_relocation.h"

namespace delquad {

namespace {

/// Below this eta an element is poor: moves for the valences may not add to the poorness around, and any move
/// that takes from it is welcome.
constexpr double kPoorEta = 0.3;
/// Below this eta even new vertices are, once nothing else helps.
constexpr double kBadEta = 0.15;
/// How much poorness such a move must take off, and more for each unit of valence energy that it costs.
constexpr double kLeastRelief = 0.05, kReliefPerEnergy = 0.05;
/// Sweeps of local relocation within which a move must settle; and for the few that may lift a poor element.
constexpr int kTrialSweeps = 4, kRescueSweeps = 12;
/// A pair's first move may cost this much valence energy; of its second moves so many are tried.
constexpr int kPairLoss = 2, kPairTries = 3;
/// No pair of moves gains where the energy around is less: a dislocation alone (3-5) cannot vanish.
constexpr int kPairEnergy = 3;

double sine_of_eta(double eta) { return std::sin(eta * std::numbers::pi / 2); }

struct Candidate {
  int gain;
  TreatmentMove move;
  bool operator<(const Candidate& other) const {
    return gain != other.gain ? gain < other.gain : other.move < move;
  }
};

class Treatment {
 public:
  Treatment(const QuadPatch& mesh, const ParametricSize& size)
      : mesh_(mesh), energy_(mesh_), relocation_(mesh_, size), pending_(mesh_.element_slots(), 1) {}

  void run(const TreatmentOptions& options);
  QuadPatch result() const { return mesh_.to_patch(); }
  const TreatmentSummary& summary() const { return summary_; }

 private:
  int single_moves();
  int paired_moves();
  int rescues();

  void consider(int element);
  int drain();
  bool try_single(const TreatmentMove& move);
  bool try_pair(const Candidate& first);
  bool find_seconds(const TouchedVertices& touched, int gain);
  bool rescue(int element);
  bool rescue_by_inset(int element);
  double relief_of(const TreatmentMove& move);

  void perform(const TreatmentMove& move);
  void touch(const TouchedVertices& vertices);
  void relax_touched();
  double poorness();
  bool settles(double poorness_before);
  void accept();
  void count(const TreatmentMove& move);
  bool irregular(int element) const;

  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  std::priority_queue<Candidate> queue_;  ///< single moves by gain
  std::vector<char> pending_;             ///< by element: changed since pairs of moves were tried there
  std::vector<int> touched_;              ///< vertices of the move on trial
  std::vector<Candidate> firsts_, seconds_;
  std::vector<int> region_;
  std::vector<unsigned> seen_element_, seen_vertex_;  ///< against seen_
  unsigned seen_ = 0;
  bool revocable_ = false;  ///< accepted moves may still be taken back
  TreatmentSummary summary_;
};

void Treatment::run(const TreatmentOptions& options) {
  relocation_.activate_all();
  summary_.relocated += relocation_.relax(0.1, 6);
  for (int changes = 1; changes > 0 && summary_.rounds < options.max_rounds; ++summary_.rounds) {
    changes = single_moves();
    changes += paired_moves();
    summary_.relocated += relocation_.relax(0.05, 10);
    changes += rescues();
  }
  relocation_.activate_all();
  summary_.relocated += relocation_.relax(0.01, 30);
  summary_.relocated += relocation_.lift_worst(0.5, 10);
}

// --- single moves, the largest gain first

bool Treatment::irregular(int element) const {
  for (int k = 0; k < 4; ++k)
    if (const int v = mesh_.corner(element, k); v >= 0 && energy_.of(v) > 0) return true;
  return false;
}

void Treatment::consider(int element) {
  for_each_move(mesh_, element, [&](const TreatmentMove& move) {
    const int gain = energy_.gain(move);
    if (gain > 0) queue_.push({gain, move});
  });
}

int Treatment::single_moves() {
  for (int e = 0; e < mesh_.element_slots(); ++e)
    if (irregular(e)) consider(e);
  return drain();
}

int Treatment::drain() {
  int changes = 0;
  Candidate last{0, {}};
  while (!queue_.empty()) {
    const Candidate candidate = queue_.top();
    queue_.pop();
    // A side is seen from both its elements.
    if (candidate.gain == last.gain && candidate.move == last.move) continue;
    last = candidate;
    if (!is_legal(mesh_, candidate.move)) continue;
    const int gain = energy_.gain(candidate.move);
    if (gain <= 0) continue;
    if (gain != candidate.gain)
      queue_.push({gain, candidate.move});
    else if (try_single(candidate.move))
      ++changes;
  }
  return changes;
}

bool Treatment::try_single(const TreatmentMove& move) {
  touched_.clear();
  touch(touched_by(mesh_, move));
  const double before = poorness();
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

int Treatment::paired_moves() {
  int changes = 0;
  pending_.resize(mesh_.element_slots(), 1);
  for (int e = 0; e < mesh_.element_slots(); ++e) {
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

bool Treatment::try_pair(const Candidate& first) {
  const TouchedVertices touched = touched_by(mesh_, first.move);
  touched_.clear();
  touch(touched);
  const double before = poorness();
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

bool Treatment::find_seconds(const TouchedVertices& touched, int gain) {
  ++seen_;
  seen_element_.resize(mesh_.element_slots(), 0);
  seen_vertex_.resize(mesh_.vertex_slots(), 0);
  region_.clear();
  int energy = 0;
  for (const int v : touched)
    mesh_.for_each_out(v, [&](int h) {
      const int e = QuadTopology::element(h);
      if (seen_element_[e] == seen_) return;
      seen_element_[e] = seen_;
      region_.push_back(e);
      for (int k = 0; k < 4; ++k) {
        const int w = mesh_.corner(e, k);
        if (w < 0 || seen_vertex_[w] == seen_) continue;
        seen_vertex_[w] = seen_;
        energy += energy_.of(w);
      }
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

// --- poor elements

int Treatment::rescues() {
  int changes = 0;
  const double poor = sine_of_eta(kPoorEta);
  for (int e = 0; e < mesh_.element_slots(); ++e)
    if (mesh_.is_quad(e) && least_sine(mesh_, e) < poor && rescue(e)) changes += 1 + drain();
  return changes;
}

bool Treatment::rescue(int element) {
  double best = kLeastRelief;
  TreatmentMove choice{TreatmentMove::kInset, -1};
  for_each_move(mesh_, element, [&](const TreatmentMove& move) {
    if (!is_legal(mesh_, move)) return;
    const int loss = std::max(-energy_.gain(move), 0);
    const double relief = relief_of(move) - kReliefPerEnergy * loss;
    if (relief > best) best = relief, choice = move;
  });
  if (choice.at < 0) return least_sine(mesh_, element) < sine_of_eta(kBadEta) && rescue_by_inset(element);
  touched_.clear();
  touch(touched_by(mesh_, choice));
  perform(choice);
  relax_touched();
  count(choice);
  accept();
  return true;
}

/// How much poorness the move takes off once it has settled.
double Treatment::relief_of(const TreatmentMove& move) {
  touched_.clear();
  touch(touched_by(mesh_, move));
  const auto start = mesh_.mark();
  relax_touched();
  const double before = poorness();
  perform(move);
  relax_touched();
  const double after = poorness();
  mesh_.rollback(start);
  return before - after;
}

/// New vertices in a bad element, after which single moves put the valences right: kept if all of it helps.
bool Treatment::rescue_by_inset(int element) {
  const TreatmentMove inset{TreatmentMove::kInset, 4 * element};
  const TreatmentSummary summary = summary_;
  const auto start = mesh_.mark();
  touched_.clear();
  touch(touched_by(mesh_, inset));
  const double before = poorness();
  perform(inset);
  relax_touched();
  count(inset);
  revocable_ = true;
  accept();
  const std::vector<int> around = touched_;
  drain();
  revocable_ = false;
  touched_ = around;
  relax_touched();
  if (before - poorness() < kLeastRelief) {
    mesh_.rollback(start);
    summary_ = summary;
    return false;
  }
  accept();
  return true;
}

// --- trials

/// Applies the move; vertices that it creates are touched, too.
void Treatment::perform(const TreatmentMove& move) {
  const int first = mesh_.vertex_slots();
  apply(mesh_, move);
  if (first == mesh_.vertex_slots()) return;
  relocation_.adopt_new_vertices(first);
  for (int v = first; v < mesh_.vertex_slots(); ++v) touched_.push_back(v);
}

void Treatment::touch(const TouchedVertices& vertices) {
  for (const int v : vertices)
    if (std::find(touched_.begin(), touched_.end(), v) == touched_.end()) touched_.push_back(v);
}

void Treatment::relax_touched() {
  for (int sweep = 0; sweep < kRescueSweeps; ++sweep)
    for (const int v : touched_) relocation_.step(v);
}

/// Of the corners of the elements around the touched vertices, the sum of (what the sine lacks, as a part of
/// what is wanted)^3: one flat corner outweighs a handful that are merely poor, and an element without area
/// counts as four.
double Treatment::poorness() {
  const double poor = sine_of_eta(kPoorEta);
  ++seen_;
  seen_element_.resize(mesh_.element_slots(), 0);
  double sum = 0;
  for (const int v : touched_) {
    if (!mesh_.vertex_alive(v)) continue;
    mesh_.for_each_out(v, [&](int h) {
      const int e = QuadTopology::element(h);
      if (seen_element_[e] == seen_) return;
      seen_element_[e] = seen_;
      for (const double sine : corner_sines(mesh_, e)) {
        const double lack = std::max(0.0, 1 - sine / poor);
        sum += lack * lack * lack;
      }
    });
  }
  return sum;
}

bool Treatment::settles(double poorness_before) {
  for (int sweep = 0; sweep < kTrialSweeps; ++sweep) {
    for (const int v : touched_) relocation_.step(v);
    if (poorness() <= poorness_before) return true;
  }
  return false;
}

void Treatment::accept() {
  if (!revocable_) mesh_.commit();
  pending_.resize(mesh_.element_slots(), 1);
  for (const int v : touched_) {
    if (!mesh_.vertex_alive(v)) continue;
    mesh_.for_each_out(v, [&](int h) {
      const int e = QuadTopology::element(h);
      consider(e);
      pending_[e] = 1;
      for (int k = 0; k < 4; ++k)
        if (const int w = mesh_.corner(e, k); w >= 0) relocation_.activate(w);
    });
  }
}

void Treatment::count(const TreatmentMove& move) {
  switch (move.kind) {
    case TreatmentMove::kCollapse:
      ++summary_.diamonds;
      break;
    case TreatmentMove::kDoublet:
      ++summary_.doublets;
      break;
    case TreatmentMove::kInset:
      ++summary_.boundary_repairs;
      break;
    default:
      ++summary_.swaps;
  }
}

}  // namespace

QuadPatch treat_paper(QuadPatch mesh, const ParametricSize& size, const TreatmentOptions& options,
                      TreatmentSummary* summary) {
  const auto start = std::chrono::steady_clock::now();
  Treatment treatment(mesh, size);
  treatment.run(options);
  QuadPatch result = treatment.result();
  if (summary != nullptr) {
    *summary = treatment.summary();
    summary->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return result;
}

}  // namespace delquad
