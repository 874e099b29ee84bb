#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "algorithms/regularity/cavity.h"
#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/regularity.h"
#include "base/marks.h"
#include "geometry/mesh/quad_blocks.h"
#include "smoothing/relocation/element_quality.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// The state and the steps of one make_regular().
class RegularityProcess {
 public:
  /// Block and size outlive this object.
  RegularityProcess(const QuadBlock& block, const ParametricSize& size, const RegularityOptions& options);

  void run();
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
    double longest = 0;  ///< side, over delta'
    double crowding = 0;
    int n = 0;
  };
  /// What is known of a cavity.
  struct Known {
    int least = -1;  ///< irregular vertices of its patterns; negative: it has none
    /// That a fill brought, for each irregular vertex less.
    double loss = -std::numeric_limits<double>::infinity();
  };

  void list(int v);
  void visit(int v);
  void find_near(int v);
  bool add_path(int from);
  void consider();
  Outline outline() const;
  bool attempt(Candidate& candidate);
  void collect_region();
  bool settles(const Quality& before, double allowed, double& loss);
  void collect_elements();
  Quality quality() const;
  void accept();

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

}  // namespace delquad
