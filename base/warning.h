#pragma once

#include <string>
#include <vector>

#include "delquad/error.h"

namespace delquad {

/// A line for each kind, in the order of the first of each: its only text, or how many there are and the text
/// of the worst.
std::vector<std::string> summaries(const std::vector<Warning>& warnings);

/// The text of each.
std::vector<std::string> texts(const std::vector<Warning>& warnings);

}  // namespace delquad
