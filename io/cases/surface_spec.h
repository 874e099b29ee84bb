#pragma once

#include <optional>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/surface/surface_model.h"
#include "io/cases/toml_reader.h"

namespace delquad {

/// The keys of a [surface] table: compound, merge_curves, ignore_below, feature_angle, weld_tolerance,
/// mirror, glue, unit. Throws InputError with file and line.
SurfaceSpec read_surface_spec(const TomlTable& table);

/// "all" or "tangent". Throws InputError, beginning with `where`, for anything else.
Compounds parse_compounds(const std::string& text, const std::string& where);

}  // namespace delquad
