// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/planar/planar_model.h"
#include "io/cases/toml_reader.h"

// This header reads planar models. Readers of cases use it.

namespace delquad {

/// Reads `curve`, `loop`, `pattern` and `embed` of a table (docs/models.md explains them). Throws InputError
/// with file and line.
PlanarModel read_planar_model(const TomlTable& table);
/// Returns whether the table has any of these keys.
bool has_planar_model(const TomlTable& table);

/// Reads `embed` of a table whose model is a surface: polylines and points in space. Throws InputError with
/// file and line.
std::vector<EmbeddedLine> read_embedded_lines(const TomlTable& table);

}  // namespace delquad
