// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/cleanup/cleanup.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "algorithms/cleanup/edit_in_blocks.h"
#include "algorithms/treatment/treatment_moves.h"
#include "base/cancel.h"
#include "base/marks.h"
#include "base/option_table.h"
#include "geometry/mesh/quad_blocks.h"
#include "geometry/mesh/quad_corners.h"
#include "smoothing/relocation/element_quality.h"
#include "smoothing/relocation/quad_relocation.h"
#include "smoothing/relocation/untangling.h"

namespace delquad {

namespace {

/// Sweeps of local relocation before an edit is judged.
constexpr int kTrialSweeps = 4;
/// Sweeps after an accepted edit. Moves below these parts of an edge do not activate neighbors; the last part
/// is for the end.
constexpr int kSettlingSweeps = 3;
constexpr double kSettled = 0.08, kSettledAtLast = 0.02;
/// Largest loss of mean quality around an edit that lowers the valence sum.
constexpr double kGreedyLoss = 0.02;
/// An edit is given up if a sweep leaves its loss this much above the limit.
constexpr double kHopeless = 0.05;

/// State and steps of one clean-up.
class CleanupProcess {
 public:
  /// `block` and `size` must outlive this object.
  CleanupProcess(const QuadBlock& block, const ParametricSize& size, const CleanupOptions& options)
      : block_(block),
        mesh_(block.mesh, block.first_held),
        energy_(mesh_),
        relocation_(mesh_, size),
        options_(options),
        most_looks_(most_looks(mesh_.element_slots())),
        random_(static_cast<std::uint64_t>(options.seed)),
        queue_(mesh_, energy_) {
    lengthen_short_edges(mesh_, size);
  }

  void run() {
    relocation_.keep_convex_corners();
    relocation_.hold_lengths();
    relocation_.keep_sines_above(sine_of_eta(kCleanupFloorEta));
    relocation_.activate_all(block_);
    summary_.relocated += relocation_.relax(kSettled, 10);
    greedy();
    for (int v = 0; v < mesh_.vertex_slots(); ++v)
      if (block_.is_near(v)) list_irregular(v);
    for (int left = options_.rounds - 1; left >= 0 && !work_.empty() && !is_spent(); --left)
      anneal(options_.tolerance * left / options_.rounds);
    summary_.stopped = is_spent();
    relocation_.activate_all(block_);
    summary_.relocated += relocation_.relax(kSettledAtLast, 30);
    summary_.relocated += relocation_.lift_worst(kCleanupFloorEta, 10);
    summary_.looks = relocation_.looks();
  }

  QuadPatch result() const { return mesh_.to_patch(); }
  const CleanupSummary& summary() const { return summary_; }

 private:
  void greedy() {
    std::vector<int> irregular;
    for (int v = 0; v < mesh_.vertex_slots(); ++v)
      if (mesh_.vertex_alive(v) && energy_.of(v) > 0 && block_.is_near(v)) irregular.push_back(v);
    consider(irregular);
    drain();
  }

  /// Calls f for edits of the elements around v, and for splits of v and its neighbors.
  template <class F>
  void for_each_edit_near(int v, F&& f) {
    mesh_.for_each_out(v, [&](int h) {
      for_each_move(mesh_, QuadTopology::element(h), f);
      for_each_opening(mesh_, QuadTopology::element(h), f);
    });
    for_each_split(mesh_, v, f);
    mesh_.for_each_out(v, [&](int h) { for_each_split(mesh_, mesh_.target(h), f); });
  }

  /// Queues edits that lower the sum near these vertices, each once; dead vertices are skipped.
  void consider(std::span<const int> vertices) {
    const auto add = [&](const TreatmentMove& move) {
      const int gain = energy_.gain(move);
      if (gain > 0 && is_legal(mesh_, move)) queue_.push({gain, move});
    };
    elements_met_.begin(mesh_.element_slots());
    vertices_met_.begin(mesh_.vertex_slots());
    for (const int v : vertices) {
      if (!mesh_.vertex_alive(v)) continue;
      if (vertices_met_.meet(v)) for_each_split(mesh_, v, add);
      mesh_.for_each_out(v, [&](int h) {
        const int e = QuadTopology::element(h), w = mesh_.target(h);
        if (elements_met_.meet(e)) for_each_move(mesh_, e, add);
        if (vertices_met_.meet(w)) for_each_split(mesh_, w, add);
      });
    }
  }

  void drain() {
    while (const auto move = queue_.pop())
      if (!is_spent() && attempt(*move, kGreedyLoss)) accept();
  }

  void anneal(double tolerance) {
    visiting_.swap(work_);
    work_.clear();
    for (const int v : visiting_) listed_[v] = 0;
    for (const int v : visiting_) {
      check_cancelled();
      if (is_spent()) return;
      if (!mesh_.vertex_alive(v) || energy_.of(v) == 0) continue;
      TreatmentMove move{};
      if (!pick_neutral(v, move)) continue;
      ++summary_.tried;
      if (attempt(move, tolerance)) {
        ++summary_.annealed;
        accept();
        drain();
      } else {
        failed_.push_back({move, last_failed_[v]});
        last_failed_[v] = static_cast<int>(failed_.size()) - 1;
      }
      list_irregular(v);
    }
  }

  bool pick_neutral(int v, TreatmentMove& move) {
    last_failed_.resize(mesh_.vertex_slots(), -1);
    choices_.clear();
    for_each_edit_near(v, [&](const TreatmentMove& edit) {
      if (energy_.gain(edit) == 0 && !has_failed(v, edit) && is_legal(mesh_, edit)) choices_.push_back(edit);
    });
    if (choices_.empty()) return false;
    move = choices_[random_() % choices_.size()];
    return true;
  }

  /// Applies the move and relocates around it. Undoes both if the quality falls by more than `loss`.
  bool attempt(const TreatmentMove& move, double loss) {
    const TouchedVertices touched = touched_by(mesh_, move);
    touched_.assign(touched.begin(), touched.end());
    const ElementQuality before = quality(touched_);
    const double least = std::min(before.least_sine, sine_of_eta(kCleanupFloorEta));
    const auto start = mesh_.mark();
    apply(mesh_, relocation_, move, touched_);
    for (int sweep = 0; sweep < kTrialSweeps; ++sweep) {
      for (const int v : touched_) relocation_.step(v);
      const ElementQuality after = quality(touched_);
      if (after.least_sine >= least && after.crowding <= before.crowding && after.failing <= before.failing &&
          after.value >= before.value - loss) {
        count(move);
        return true;
      }
      if (after.value < before.value - loss - kHopeless) break;
    }
    mesh_.rollback(start);
    return false;
  }

  void accept() {
    mesh_.commit();
    last_failed_.resize(mesh_.vertex_slots(), -1);
    consider(touched_);
    for (const int v : touched_) {
      if (!mesh_.vertex_alive(v)) continue;
      mesh_.for_each_out(v, [&](int h) {
        const int e = QuadTopology::element(h);
        for (int k = 0; k < 4; ++k) {
          const int w = mesh_.corner(e, k);
          if (w < 0) continue;
          relocation_.activate(w);
          last_failed_[w] = -1;
          list_irregular(w);
        }
      });
    }
    summary_.relocated += relocation_.relax(kSettled, kSettlingSweeps);
  }

  void count(const TreatmentMove& move) {
    using S = CleanupSummary;
    // Indexed by TreatmentMove::Kind; insets do not occur.
    static constexpr int S::*kCounters[] = {&S::rotations, &S::rotations, &S::diamonds, &S::doublets,
                                            &S::rotations, &S::splits,    &S::openings, &S::openings};
    ++(summary_.*kCounters[move.kind]);
  }

  /// Returns the mean value and least sine of the elements around these vertices.
  ElementQuality quality(std::span<const int> vertices) {
    ElementQuality total;
    int n = 0;
    elements_met_.begin(mesh_.element_slots());
    for_each_element_around(mesh_, vertices, elements_met_, [&](int e) {
      total.add(element_quality(mesh_, relocation_, e));
      ++n;
    });
    quality_looks_ += n;
    total.value /= std::max(n, 1);
    return total;
  }

  bool is_spent() const { return relocation_.looks() + quality_looks_ > most_looks_; }

  void list_irregular(int v) {
    listed_.resize(mesh_.vertex_slots(), 0);
    if (listed_[v] || !mesh_.vertex_alive(v) || energy_.of(v) == 0) return;
    listed_[v] = 1;
    work_.push_back(v);
  }

  bool has_failed(int v, const TreatmentMove& move) const {
    for (int i = last_failed_[v]; i >= 0; i = failed_[i].before)
      if (failed_[i].move == move) return true;
    return false;
  }

  const QuadBlock& block_;
  QuadTopology mesh_;
  ValenceEnergy energy_;
  QuadRelocation relocation_;
  CleanupOptions options_;
  long long quality_looks_ = 0;  ///< number of elements whose quality was measured
  long long most_looks_;         ///< limit of looks, after which no edit is tried
  std::mt19937_64 random_;
  MoveQueue queue_;                   ///< edits that lower the sum
  std::vector<int> visiting_, work_;  ///< irregular vertices of this round and of the next one
  std::vector<char> listed_;          ///< by vertex: whether it is in work_
  /// Index in failed_ of the last edit that failed at a vertex since its surroundings changed; -1: none.
  /// `before` links to the previous one.
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

QuadPatch clean_up(const QuadPatch& mesh, const ParametricSize& size, const CleanupOptions& options,
                   CleanupSummary* summary) {
  return edit_in_blocks<CleanupProcess>(mesh, size, options, summary);
}

namespace {

const OptionTable<CleanupOptions>& table() {
  static const auto all =
      OptionTable<CleanupOptions>("cleanup", "options of C")
          .add({.name = "rounds",
                .help = "rounds of annealing; 0: greedy edits only",
                .least = 0,
                .most = 1e6},
               &CleanupOptions::rounds)
          .add({.name = "tolerance",
                .help = "quality that an edit may cost in the first round",
                .above = 0,
                .most = 1},
               &CleanupOptions::tolerance)
          .add({.name = "seed", .help = "seed of the annealing", .least = 0}, &CleanupOptions::seed);
  return all;
}

}  // namespace

OptionGroup cleanup_group() { return table().group(); }
CleanupOptions cleanup_options(const Options& options) { return table().read(options); }

}  // namespace delquad
