#pragma once

#include <optional>
#include <string>
#include <vector>

namespace delquad {

/// The name among `known` nearest to `given` (Damerau-Levenshtein distance), when it is near enough to be a
/// slip.
std::optional<std::string> nearest_name(const std::string& given, const std::vector<std::string>& known);

/// What messages add to tell it: "; did you mean 'size'?"; empty where there is none.
std::string suggestion(const std::string& given, const std::vector<std::string>& known);

/// The same of names in a model; where none is near, those that there are: "; there are 'inlet', 'wall'", of
/// many the first ones in the order of the alphabet.
std::string suggestion_or_all(const std::string& given, std::vector<std::string> known);

}  // namespace delquad
