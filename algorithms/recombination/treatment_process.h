#pragma once

#include <queue>
#include <vector>

#include "algorithms/recombination/local_remeshing.h"
#include "algorithms/recombination/poorness.h"
#include "algorithms/recombination/treatment.h"
#include "algorithms/recombination/treatment_moves.h"
#include "smoothing/quad_relocation.h"

namespace delquad {

/// The state and the steps of one treatment; treat_paper() is its public face.
class TreatmentProcess {
 public:
  TreatmentProcess(const QuadPatch& mesh, const ParametricSize& size)
      : mesh_(mesh),
        energy_(mesh_),
        relocation_(mesh_, size),
        poorness_(mesh_),
        remeshing_(mesh_, relocation_, poorness_),
        pending_(mesh_.element_slots(), 1),
        most_ring_quads_(kRingQuadsPerElement * mesh_.element_slots()) {}

  void run(const TreatmentOptions& options);
  QuadPatch result() const { return mesh_.to_patch(); }
  const TreatmentSummary& summary() const { return summary_; }

 private:
  struct Candidate {
    int gain;
    TreatmentMove move;
    bool operator<(const Candidate& other) const {
      return gain != other.gain ? gain < other.gain : other.move < move;
    }
  };

  int single_moves();
  int paired_moves();
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

  void perform(const TreatmentMove& move);
  void touch(const TouchedVertices& vertices);
  void relax_touched();
  double poorness() { return poorness_.around(touched_); }
  bool settles(double poorness_before);
  void accept();
  void count(const TreatmentMove& move);
  bool irregular(int element) const;

  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  Poorness poorness_;
  LocalRemeshing remeshing_;
  std::priority_queue<Candidate> queue_;  ///< single moves by gain
  std::vector<char> pending_;             ///< by element: changed since pairs of moves were tried there
  std::vector<char> hopeless_;            ///< by element: unchanged since remeshing failed there
  std::vector<char> beyond_rescue_;       ///< by element: unchanged since no move took off enough there
  std::vector<int> touched_;              ///< vertices of the move on trial
  std::vector<Candidate> firsts_, seconds_;
  std::vector<int> region_;
  std::vector<unsigned> seen_element_, seen_vertex_;  ///< against seen_
  unsigned seen_ = 0;
  bool revocable_ = false;             ///< accepted moves may still be taken back
  std::vector<int> touched_on_trial_;  ///< by those moves
  /// Rings of new quads may not outgrow the patch, however poor its quads stay.
  static constexpr int kRingQuadsPerElement = 4;
  int most_ring_quads_;
  TreatmentSummary summary_;
};

}  // namespace delquad
