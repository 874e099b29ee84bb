// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "delquad/model.h"
#include "io/cases/case.h"
#include "io/cases/toml_reader.h"

// This header reads model files and cases. The program, experiments and the Python module use it.

namespace delquad {

/// Reads the keys of a case that the table has: model, data, mesh, curve, loop, pattern, surface, size,
/// cross, insertion, smoothing, recombination, compare. Other keys of the case stay. Paths are relative to
/// the folder of the table's file. Throws InputError with file and line.
void read_case_keys(const TomlTable& table, Case& target);

/// Returns the case of a model file: keys of a case at the top level, or a mesh of lines (.msh). `defaults`
/// has the values of absent keys. Throws InputError for other extensions, for experiment files, and with file
/// and line for wrong keys.
Case read_model_case(const std::filesystem::path& file, const Case& defaults = {});

/// Reads "all" or "tangent". Throws InputError, beginning with `where`, for anything else.
Compounds parse_compounds(const std::string& text, const std::string& where);

}  // namespace delquad
