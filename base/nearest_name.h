// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

// This header finds the name that was meant by a slip. Readers of options and files use it.

namespace delquad {

/// Returns the name in `known` nearest to `given` (Damerau-Levenshtein distance), if it may be a slip.
std::optional<std::string> nearest_name(const std::string& given, const std::vector<std::string>& known);

/// Returns an addition to a message: "; did you mean 'size'?"; empty: no name is near.
std::string suggestion(const std::string& given, const std::vector<std::string>& known);

/// Returns the same for names in a model. If none is near, it lists them, or the first ones alphabetically:
/// "; there are 'inlet', 'wall'".
std::string suggestion_or_all(const std::string& given, std::vector<std::string> known);

}  // namespace delquad
