#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/insertion/linf_adaptation.h"
#include "algorithms/recombination/recombine.h"
#include "pipeline/options.h"
#include "surfaces/curve_nodes.h"

namespace delquad {

/// What a patch holds between two stages.
enum class PatchForm { kBoundary, kTriangles, kQuads };

struct PatchMesh {
  PatchForm form = PatchForm::kBoundary;
  TriPatch triangles;  ///< when form is kTriangles
  QuadPatch quads;     ///< when form is kQuads
  /// Places in space of the points inside, once they are known; else empty.
  std::vector<Vec3> inside;
};

struct StageInput {
  const PatchBoundary& boundary;
  const CrossField& cross;
  const ParametricSize& size;
  const MeshingOptions& options;
};

/// Edits of whole patches that were taken back, because they left two quads around a tube.
struct DiscardSummary {
  int treatments = 0;  ///< patches whose matching was relocated only
  int cleanups = 0;    ///< patches that stayed as they were
};

/// What part_twins() did, over all stages.
struct PartingSummary {
  int chords = 0;        ///< parted
  int left = 0;          ///< chords that the quads beside did not allow to part
  int rings = 0;         ///< of quads, put inside of faces of one quad
  int corners = 0;       ///< nodes with two quads in all, of which one face got a second one
  int corners_left = 0;  ///< those where that would have left bad quads
  double seconds = 0;
};

/// What became of quads that were bad in space, at the end.
struct LiftingSummary {
  int moved = 0;  ///< vertices
  int rings = 0;  ///< of quads, put inside those that stayed inverted or folded
  double seconds = 0;
};

/// What the stages did: on one patch, or summed over patches. stage_counters.h lists the summaries.
struct StageLog {
  /// By step, in order of first use: the times of all threads added up, so that they can be compared whatever
  /// the number of threads.
  std::vector<std::pair<std::string, double>> seconds;
  std::optional<FrontalSummary> insertion;
  std::optional<AdaptationSummary> adaptation;
  double h_max = 0;                         ///< that insertion used: the option's or the strategy's own
  std::vector<SmoothingSummary> smoothing;  ///< of each patch; after each other where a word smooths twice
  std::optional<RecombineSummary> recombination;
  std::optional<TreatmentSummary> treatment;
  std::optional<CleanupSummary> cleanup;
  std::optional<OptimisationSummary> optimisation;
  std::optional<DiscardSummary> discarded;  ///< there after treatment or clean-up
  std::optional<PartingSummary> part_twins;
  std::optional<LiftingSummary> lift_bad_quads;
  void add_seconds(const std::string& step, double s);
  /// Adds what was done on another patch.
  void add(const StageLog& other);
};

struct PreparedCase;

/// The places in space of the points inside a patch (by its index); `nodes` are those of the boundaries.
std::vector<Vec3> places_inside(const PreparedCase& prepared, std::size_t patch, const PatchMesh& mesh,
                                const std::vector<Vec3>& nodes);

/// What a word has made of all patches so far.
struct AllPatches {
  const PreparedCase& prepared;
  const MeshingOptions& options;
  std::vector<PatchMesh>& patches;
  const std::vector<char>& left_out;  ///< by patch
  SurfaceNodes& nodes;                ///< on curves; of a planar domain only their places
};

/// One letter of a pipeline word: takes a patch from one form to another.
struct Stage {
  char letter;
  std::string name;
  PatchForm from, to;
  std::function<void(const StageInput&, PatchMesh&, StageLog&)> run;
  /// What it then does to all patches together. May be empty.
  std::function<void(const AllPatches&, StageLog&)> finish = {};
  bool leaves_triangles = false;  ///< among its quads, however even the boundary is
};

/// Every stage. A new idea is a new entry here, or an add_stage().
const std::deque<Stage>& stage_registry();
/// Adds one from outside, before any word is parsed. Throws std::invalid_argument when its letter is taken.
void add_stage(Stage stage);
/// Frontal insertion of points where `make_placement` says.
Stage insertion_stage(char letter, const std::string& name,
                      std::function<std::unique_ptr<PointPlacement>(const MeshingOptions&)> make_placement);

/// A pipeline: stages read from left to right, each starting from what the one before leaves.
struct Word {
  std::string text;  ///< "DB"
  std::vector<const Stage*> stages;
  PatchForm result = PatchForm::kBoundary;
  /// Triangles that are left in its mesh are an error.
  bool quads_only() const;
};

/// Throws InputError for an empty word, an unknown letter (naming it and those known) and for letters that do
/// not follow each other.
Word parse_word(const std::string& text);

}  // namespace delquad
