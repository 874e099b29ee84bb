#pragma once

#include "geometry/planar_model.h"
#include "io/toml_reader.h"

namespace delquad {

/// A loop that the model calls a hole, by a point on it.
struct DeclaredHole {
  Vec2 point;
  std::string where;
};

struct ModelFile {
  PlanarModel model;
  std::vector<DeclaredHole> holes;
};

/// Reads `curve`, `loop` and `pattern` of a table (docs/experiments.md has the schema). Throws InputError
/// with file and line.
ModelFile read_planar_model(const TomlTable& table);
/// Whether the table has any of these keys.
bool has_planar_model(const TomlTable& table);

}  // namespace delquad
