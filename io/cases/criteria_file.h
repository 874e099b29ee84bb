#pragma once

#include "delquad/mesher.h"
#include "io/cases/toml_reader.h"

namespace delquad {

/// The key `criteria` of a table: a preset, a file from the folder of the table's file, or a table. Throws
/// InputError with file and line.
Criteria read_criteria_key(const TomlTable& table);

}  // namespace delquad
