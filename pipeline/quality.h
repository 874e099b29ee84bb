#pragma once

#include <span>
#include <string>

#include "pipeline/case.h"

namespace delquad {

/// A trade of time against quality: which word, and which cross field where the model does not say.
struct Quality {
  std::string name, word, cross;
};

/// From fast to best; docs/experiments.md has what each is worth.
std::span<const Quality> quality_registry();

/// Throws InputError, naming those known.
const Quality& quality_named(const std::string& name);

inline constexpr const char* kDefaultQuality = "good";

}  // namespace delquad
