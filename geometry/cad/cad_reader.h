// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "delquad/model.h"
#include "geometry/surface/surface_model.h"

// This header reads CAD files and data. The bench, features and geometry use it.

namespace delquad {

struct CadOptions {
  /// Largest distance between the fine triangulation and the model, over the diagonal of the model's bounding
  /// box, > 0.
  double deflection = 1.0 / 2000;
  /// Largest angle, radians > 0, between neighboring sides of a curve, and normals of a face across an inner
  /// side.
  double angle = 0.15;
  /// Unit of lengths, see length_unit.h; empty: millimeters, or the unit of a BREP file.
  std::string unit = {};
  /// Whether bodies share the faces, curves and points at which they touch: see glue_shape().
  bool glue = false;
  /// Largest distance of sewn and glued parts, over the diagonal: above rounding, below any feature.
  double weld = 1e-6;
  /// Wanted size at a place, a length. Separate parts that are nearer than a tenth of it get a warning. Null:
  /// a fiftieth of the diagonal.
  std::function<double(const Vec3&)> size = nullptr;
  /// Whether all faces are triangulated from their outlines, and not only those for which the kernel fails;
  /// for comparisons.
  bool by_outline = false;
  /// Whether faces that cannot be triangulated are left out, and named in the model, instead of an error.
  bool keep_going = false;
};

/// Returns the model of a STEP, IGES or BREP file, or of its bytes (told apart by content), by OpenCASCADE.
/// Lengths of STEP and IGES are in the requested unit, whatever the file's unit. BREP has no unit; lengths
/// stay, and a requested unit is an InputError. Each face is a region and each edge a curve, once; its tag is
/// its number in the file. Degenerate edges and seams are no curves, which leaves gaps in the numbers; the
/// triangulation is connected across them. In STEP and IGES, a region has the names of its face, solids and
/// products and its color ("color #rrggbb"). Normals of a solid point outwards. Edges inside of faces that
/// join others are embedded. Warnings tell healed shapes, sewn free edges, and removed faces whose edges
/// coincide within their tolerances. They also tell free and non-manifold curves, and places where separate
/// parts touch, cross or come near (see loose_joints.h). Projected points are accurate to 1e-9 of the
/// diagonal where the surface is regular. The kernel works in a worker process (see find_worker()), so that a
/// damaged file cannot crash the program; its output is lost. Throws Cancelled. Throws InputError, with the
/// file, if it cannot be read, has no face, or cannot be glued. Throws it, with the faces, for faces that are
/// unbounded, cross their own boundary, have no area, or cannot be triangulated. With options.keep_going,
/// such faces are left out if others remain, except unbounded ones.
SurfaceModel read_cad(const CadModel& model, const CadOptions& options = {});
SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions& options = {});

/// Returns the worker program (see find_worker()); empty: there is none, and CAD cannot be read.
std::filesystem::path cad_program();
/// Returns the file of the library with the kernel, which is loaded if needed; empty: there is none.
std::filesystem::path cad_library();

}  // namespace delquad
