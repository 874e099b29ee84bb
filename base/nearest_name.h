// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

// This header finds the name that was meant by a slip. Readers of options and files use it.

namespace delquad {

/// Returns the name in `known` nearest to `given`: names of other programs first ("face_3" for "region_3"),
/// then by restricted Damerau-Levenshtein distance. The distance is at most half of the name, or 1.
std::optional<std::string> nearest_name(const std::string& given, const std::vector<std::string>& known);

/// Returns an addition to a message: "; did you mean 'size'?"; empty: no name is near.
std::string suggestion(const std::string& given, const std::vector<std::string>& known);

/// Returns suggestion(), or, if no name is near, the first twelve names alphabetically: "; there are 'inlet',
/// 'wall'".
std::string suggestion_or_all(const std::string& given, std::vector<std::string> known);

}  // namespace delquad
