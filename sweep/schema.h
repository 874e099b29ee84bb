#pragma once

#include <string>

#include "io/toml_keys.h"

namespace delquad {

/// The keys of an experiment file, and those of its tables that models lack.
const TomlKeys& experiment_keys();
const TomlKeys& experiment_case_keys();
const TomlKeys& peer_keys();
const TomlKeys& ratio_keys();
const TomlKeys& linf_study_keys();

/// The JSON Schema (draft 2020-12) of experiment files, made from the keys that they are read against. Ends
/// with a newline.
std::string experiment_schema();

}  // namespace delquad
