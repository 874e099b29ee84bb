// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "io/cases/case.h"

// This header turns texts into the parts of a problem. The pipeline, the program, the bench and readers and
// writers use it.

namespace delquad {

/// Returns whether a file is a surface by its extension: CAD or triangles.
bool is_surface_file(const std::filesystem::path& path);
/// Returns these extensions, for messages.
std::string surface_files();

/// Returns the user's text for directions: "boundary", "size-aware", "gradient" or an angle; "angle" for
/// fields.
std::string text_of(const CrossSpec& cross);

/// Returns the problem with the ModelFile in memory (except CAD), and with size and directions as fields.
/// Throws InputError with file and line.
MeshProblem read_files(MeshProblem problem);

/// Throws InputError, with file and line, for errors that are known before meshing. These are a missing file
/// of the model, unless the case may be skipped, and formulas of size or cross that cannot be read.
void check_case(const Case& c);

/// Returns the size field of an existing mesh; `text` is a number, a formula, a file or "boundary", as for
/// --size. Throws InputError for another text.
std::shared_ptr<const SizeField> size_of_mesh(const Mesh& mesh, const std::string& text);

/// A size given at the points of a mesh in a file, or a formula of the `value` of a raster.
struct SizeFile {
  std::filesystem::path path;
  std::string field;  ///< empty: the only one that it has
};

/// Returns the parts of "FILE" or "FILE:FIELD", relative to `folder`, if FILE has an extension of meshes or
/// rasters; otherwise nothing.
std::optional<SizeFile> size_file_of(const std::string& text, const std::filesystem::path& folder);

/// Returns depths of water, positive downwards, as a function of points. `text` is "FILE" or "FILE: FORMULA"
/// in x, y, z and value. The raster is projected to the coordinate system of the outlines that `model` names.
/// Throws InputError if the raster cannot be read; the function throws it at places without data.
std::function<double(const Vec3&)> read_depths(const std::string& text, const Model& model);

}  // namespace delquad
