#pragma once

#include <random>
#include <span>
#include <vector>

#include "algorithms/cleanup/cleanup.h"
#include "algorithms/treatment/move_queue.h"
#include "algorithms/treatment/treatment_moves.h"
#include "base/marks.h"
#include "geometry/mesh/quad_blocks.h"
#include "smoothing/relocation/element_quality.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// The state and the steps of one clean-up; clean_up() is its public face.
class CleanupProcess {
 public:
  /// Block and size outlive this object.
  CleanupProcess(const QuadBlock& block, const ParametricSize& size, const CleanupOptions& options);

  void run();
  QuadPatch result() const { return mesh_.to_patch(); }
  const CleanupSummary& summary() const { return summary_; }

 private:
  void greedy();
  template <class F>
  void for_each_edit_near(int v, F&& f);
  void consider(std::span<const int> vertices);
  void drain();
  void anneal(double tolerance);
  bool pick_neutral(int v, TreatmentMove& move);
  /// Applies the move and relocates around; takes all back if the quality falls by more than `loss`.
  bool attempt(const TreatmentMove& move, double loss);
  void accept();
  void count(const TreatmentMove& move);
  ElementQuality quality(std::span<const int> vertices);
  bool is_spent() const { return relocation_.looks() + quality_looks_ > most_looks_; }
  void list_irregular(int v);
  bool has_failed(int v, const TreatmentMove& move) const;

  const QuadBlock& block_;
  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  CleanupOptions options_;
  long long quality_looks_ = 0;  ///< elements whose quality was looked at
  long long most_looks_;         ///< until then edits are tried
  std::mt19937_64 random_;
  MoveQueue queue_;                   ///< edits that lower the sum
  std::vector<int> visiting_, work_;  ///< irregular vertices of this round and of the next
  std::vector<char> listed_;          ///< by vertex: in work_
  /// What failed at a vertex since an edit changed what lies around: the last one by vertex (-1: none), and
  /// before it.
  std::vector<int> last_failed_;
  struct Failed {
    TreatmentMove move;
    int before;
  };
  std::vector<Failed> failed_;
  std::vector<int> touched_;  ///< vertices of the edit on trial
  std::vector<TreatmentMove> choices_;
  Marks elements_met_, vertices_met_;
  CleanupSummary summary_;
};

}  // namespace delquad
