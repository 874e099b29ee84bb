#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/counters.h"
#include "delquad/extend.h"
#include "delquad/model.h"
#include "patches/all_patches.h"

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

/// max_elements bounds what is inserted, too: a quad mesh has about as many points as quads.
inline constexpr long long kPointsPerElement = 4;

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
