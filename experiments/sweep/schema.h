#pragma once

#include <string>

#include "io/cases/toml_keys.h"

namespace delquad {

/// The keys of an experiment file, and those of its tables that models lack.
TomlKeys experiment_keys();
TomlKeys experiment_case_keys();
const TomlKeys& peer_keys();
const TomlKeys& peer_file_keys();
const TomlKeys& metric_keys();
const TomlKeys& ratio_keys();
const TomlKeys& correlate_keys();
const TomlKeys& linf_study_keys();

/// Limits of what a metric by command may ask for: digits, and seconds (a week).
inline constexpr int kMostDigits = 12, kMostSeconds = 604'800, kMostRepetitions = 1000;

/// The JSON Schema (draft 2020-12) of experiment files, made from the keys that they are read against. Ends
/// with a newline.
std::string experiment_schema();

}  // namespace delquad
