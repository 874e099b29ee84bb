// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "io/cases/toml_reader.h"

// This header has keys that several tables of an experiment have. Experiments and their schema use it.

namespace delquad {

/// Returns the keys of an experiment file, and keys of its cases that models lack.
TomlKeys experiment_keys();
TomlKeys experiment_case_keys();
/// Returns the keys of a [[variant]].
TomlKeys variant_keys();

/// Returns the JSON Schema (draft 2020-12) of experiment files, made from their keys, with a newline at the
/// end.
std::string experiment_schema();

/// Throws InputError, with file and line, for a placeholder in `command` that is not in `known`, and if all
/// of one of the groups of `needed` are missing. Other braces are allowed in arguments that are text of a
/// program.
void check_placeholders(const TomlTable& table, const std::vector<std::string>& command,
                        const std::vector<std::string>& known,
                        const std::vector<std::vector<std::string>>& needed);

/// Returns whether a word of the command contains `placeholder`, such as "{mesh}".
bool has_placeholder(const std::vector<std::string>& command, const std::string& placeholder);

/// Throws InputError, with file and line, for a name that cannot be a folder, the name of a file of results,
/// and a name in `others`. Some file systems do not distinguish capitals.
void check_folder_name(const TomlTable& table, const std::string& name,
                       const std::vector<std::string>& others);

}  // namespace delquad
