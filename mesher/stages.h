#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/counters.h"
#include "delquad/extend.h"
#include "delquad/model.h"
#include "features/layers/add_layers.h"
#include "patches/curve_nodes.h"

namespace delquad {

/// Edits of whole patches that were taken back, because they left two quads around a tube.
struct DiscardSummary {
  int treatments = 0;  ///< patches whose matching was relocated only
  int cleanups = 0;    ///< patches that stayed as they were
};

template <>
struct Counters<DiscardSummary> {
  using S = DiscardSummary;
  static constexpr const char* step = "discarded";
  static constexpr auto all =
      std::tuple{counter("treatments", &S::treatments), counter("cleanups", &S::cleanups)};
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

template <>
struct Counters<PartingSummary> {
  using S = PartingSummary;
  static constexpr const char* step = "part_twins";
  static constexpr auto all =
      std::tuple(counter("chords", &S::chords), counter("left", &S::left), counter("rings", &S::rings),
                 counter("corners", &S::corners), counter("corners_left", &S::corners_left),
                 counter("seconds", &S::seconds));
};

/// What became of quads that were bad in space, at the end.
struct LiftingSummary {
  int moved = 0;       ///< vertices
  int rings = 0;       ///< of quads, put inside those that stayed inverted or folded
  int mended = 0;      ///< changes of the quads around those
  long long cost = 0;  ///< places of vertices that were tried, those on CAD ten times
  int stopped = 0;     ///< the tag of the face with the worst quad, where it may not cost more; 0: it ended
  double seconds = 0;
};

template <>
struct Counters<LiftingSummary> {
  using S = LiftingSummary;
  static constexpr const char* step = "lift_bad_quads";
  static constexpr auto all = std::tuple{counter("moved", &S::moved),     counter("rings", &S::rings),
                                         counter("mended", &S::mended),   counter("cost", &S::cost),
                                         counter("stopped", &S::stopped), counter("seconds", &S::seconds)};
};

/// What refine_unsound() did.
struct RefinementSummary {
  int rounds = 0;  ///< how often the problem was meshed anew
  int spots = 0;   ///< places around which the size is smaller
};

template <>
struct Counters<RefinementSummary> {
  using S = RefinementSummary;
  static constexpr const char* step = "refine_unsound";
  static constexpr auto all = std::tuple{counter("rounds", &S::rounds), counter("spots", &S::spots)};
};

template <>
struct Counters<LayerCount> {
  using S = LayerCount;
  static constexpr const char* step = "layers";
  static constexpr auto all = std::tuple{counter("columns", &S::columns), counter("quads", &S::quads),
                                         counter("fans", &S::fans), counter("least_scale", &S::least_scale)};
};

struct PreparedProblem;

/// The places in space of the points inside a patch (by its index); `nodes` are those of the boundaries.
std::vector<Vec3> places_inside(const PreparedProblem& prepared, std::size_t patch, const PatchMesh& mesh,
                                const std::vector<Vec3>& nodes);

/// What a word has made of all patches so far.
struct AllPatches {
  const PreparedProblem& prepared;
  const Options& options;
  std::vector<PatchMesh>& patches;
  const std::vector<char>& left_out;  ///< by patch
  SurfaceNodes& nodes;                ///< on curves; of a planar domain only their places
  bool began_from_quads = false;      ///< that were given
};

/// Adds what a step counted to the log.
template <class Summary>
void add_summary(StageLog& log, const Summary& summary) {
  log.summaries.add(Counters<Summary>::step, fields_of(summary));
}

/// A pipeline: stages read from left to right, each starting from what the one before leaves.
struct Word {
  std::string text;  ///< "DB"
  std::vector<const Stage*> stages;
  PatchForm result = PatchForm::kBoundary;
  /// Triangles that are left in its mesh are an error.
  bool quads_only() const;
};

/// Where a word may begin.
enum class WordStart { kBoundary, kGivenMesh };

/// Throws InputError for an empty word, an unknown letter (naming it and those known) and for letters that do
/// not follow each other. `start`: with a given mesh a word may begin with any letter.
Word parse_word(const std::string& text, WordStart start = WordStart::kBoundary);
/// Where words of a model may begin.
WordStart word_start(const Model& model);

}  // namespace delquad
