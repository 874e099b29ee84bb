#pragma once

#include <vector>

#include "algorithms/treatment/local_remeshing.h"
#include "algorithms/treatment/treatment.h"
#include "algorithms/treatment/treatment_moves.h"
#include "base/marks.h"
#include "geometry/mesh/quad_blocks.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// The state and the steps of one treatment; treat_paper() is its public face.
class TreatmentProcess {
 public:
  /// Both outlive this object.
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

  void run(const TreatmentOptions& options);
  QuadPatch result() const { return mesh_.to_patch(); }
  const TreatmentSummary& summary() const { return summary_; }

 private:
  int single_moves();
  int paired_moves();
  /// Tries to mend each quad below this eta that was not given up; returns how much changed.
  template <class Mend>
  int mend_below(double eta, std::vector<char>& given_up, Mend mend);
  int rescues();
  int remeshings();

  void consider(int element);
  int drain();
  bool try_single(const TreatmentMove& move);
  bool try_pair(const Candidate& first);
  bool find_seconds(const TouchedVertices& touched, int gain);
  bool rescue(int element);
  bool rescue_by_inset(int element);
  double relief_of(const TreatmentMove& move);

  void perform(const TreatmentMove& move) { apply(mesh_, relocation_, move, touched_); }
  void touch(const TouchedVertices& vertices);
  void relax_touched();
  double penalty() { return penalty_.around(touched_); }
  bool settles(double penalty_before);
  void accept();
  void count(const TreatmentMove& move);
  bool is_spent() const { return relocation_.looks() + penalty_.looks() > most_looks_; }
  bool irregular(int element) const;
  bool is_near(int element) const;

  const QuadBlock& block_;
  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  ShapePenalty penalty_;
  LocalRemeshing remeshing_;
  MoveQueue queue_;                  ///< single moves
  std::vector<char> pending_;        ///< by element: changed since pairs of moves were tried there
  std::vector<char> hopeless_;       ///< by element: unchanged since remeshing failed there
  std::vector<char> beyond_rescue_;  ///< by element: unchanged since no move took off enough there
  std::vector<int> touched_;         ///< vertices of the move on trial
  std::vector<Candidate> firsts_, seconds_;
  std::vector<int> region_;
  Marks elements_met_, vertices_met_;
  bool revocable_ = false;             ///< accepted moves may still be taken back
  std::vector<int> touched_on_trial_;  ///< by those moves
  /// Rings of new quads may not outgrow the patch, however poor its quads stay.
  static constexpr int kRingQuadsPerElement = 4;
  int most_ring_quads_;
  long long most_looks_;  ///< until then moves are tried
  TreatmentSummary summary_;
};

}  // namespace delquad
