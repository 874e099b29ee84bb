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

/// Returns whether the file holds a surface by its extension: CAD or triangles.
bool is_surface_file(const std::filesystem::path& path);
/// Returns these extensions, for messages.
std::string surface_files();

/// Returns how people write the directions: "boundary", "size-aware", "gradient", an angle; "angle" of
/// fields.
std::string text_of(const CrossSpec& cross);

/// Returns the problem with the ModelFile in memory (but for CAD) and the texts of size and directions as
/// fields. Throws InputError with file and line.
MeshProblem read_files(MeshProblem problem);

/// Throws InputError with file and line where the model's file is missing, but for data that cases are
/// skipped without. So it does if formulas of size or crosses cannot be read. These are the errors that are
/// known before anything is meshed.
void check_case(const Case& c);

/// Returns the size field of a mesh that is there already: `text` is a number, an expression, a file or
/// "boundary", as --size gives it.
std::shared_ptr<const SizeField> size_of_mesh(const Mesh& mesh, const std::string& text);

/// A size that a file gives at the points of its mesh, or a formula of the `value` of a raster.
struct SizeFile {
  std::filesystem::path path;
  std::string field;  ///< empty: the only one that it has
};

/// Returns the parts of "FILE" or "FILE:FIELD", where FILE ends as meshes or rasters do, and counts from
/// `folder`; nothing for other texts.
std::optional<SizeFile> size_file_of(const std::string& text, const std::filesystem::path& folder);

/// Depths of water at points, positive downwards, of "FILE" or "FILE: FORMULA" in x, y, z and value. The
/// raster is projected to the coordinate system of the outlines that `model` names. Throws InputError if the
/// raster cannot be read; the function throws it where the raster has no data.
std::function<double(const Vec3&)> read_depths(const std::string& text, const Model& model);

}  // namespace delquad
