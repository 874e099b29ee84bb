#pragma once

#include <optional>
#include <string>

#include "experiments/sweep/peer.h"

namespace delquad {

/// The number of quads that a word makes of a case, see count_of_quads(): by the record of its cell, or,
/// where that is not there or of something else, by running it in a process of its own, which gives the same
/// number. Nothing where the word has no mesh of the case. Throws JobFailed where that process crashes.
std::optional<double> reference_quads(const Prepared& prepared, const std::string& word,
                                      const ReferenceCell& cell);

/// The planar problem with every size multiplied by `scale`, its boundary made anew at those. Throws
/// InputError as prepare() does.
Prepared prepare_scaled(const Prepared& prepared, double scale);

}  // namespace delquad
