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
  /// Largest distance between the fine triangulation and the model, as a fraction of the diagonal of the
  /// model's bounding box, > 0.
  double deflection = 1.0 / 2000;
  /// Largest angle between neighboring sides of a curve, and normals of a face across an inner side,
  /// radians.
  double angle = 0.15;
  /// Unit of lengths, see length_unit.h; empty: millimeters, or the unit of a BREP file.
  std::string unit = {};
  /// Bodies share the faces, curves and points at which they touch: see glue_shape().
  bool glue = false;
  /// How far apart may be what is sewn and glued, as a fraction of the diagonal; well above rounding, below
  /// any feature.
  double weld = 1e-6;
  /// The wanted size at a place, a length: parts that hang apart and are nearer than a tenth of it are told.
  /// Null: a fiftieth of the diagonal.
  std::function<double(const Vec3&)> size = nullptr;
  /// All faces are triangulated from their outlines, as else only those for which the kernel fails: to
  /// compare the two ways.
  bool by_outline = false;
  /// Faces that cannot be triangulated are left out, and named in the model, instead of an error.
  bool keep_going = false;
};

/// Reads a STEP, IGES or BREP file, or its bytes (told apart by content), through OpenCASCADE. Lengths of
/// STEP and IGES are in the unit that is asked for, whatever the file's unit. BREP has no unit: lengths are
/// as given, and to ask for a unit is an InputError. A warning tells where faces that no solid has both touch
/// or cross (see loose_joints.h), and where they come near. With options.glue they share curves and nodes
/// there. Each face and each edge stands once, as region and curve, and its tag is its number in the file's
/// order. Gaps in the numbers stay where degenerate edges and seams were. These are no curves, and the
/// triangulation is connected across them. In STEP and IGES, a region has the names of its face, solids and
/// products and its color ("color #rrggbb"). Normals of a solid point outwards. Edges that stand in faces and
/// join others are embedded. Invalid shapes are healed and coincident free edges sewn, and a warning says so.
/// Faces whose edges lie on each other within their tolerances are taken out, with a warning, too. Warnings
/// also tell free and non-manifold curves. Projected points are accurate to 1e-9 of the diagonal where the
/// surface is regular. The kernel works in a worker process (see find_worker()), so that a damaged file
/// cannot bring the program down; its output is lost. Throws Cancelled. Throws InputError naming the file for
/// files that cannot be read or hold no face, and the places that cannot be glued. Throws it,
/// naming the faces, for faces that are unbounded or cross their own boundary. So it does for faces without
/// area, and faces that cannot be triangulated. options.keep_going leaves such faces out if others remain. An
/// unbounded one is refused in any case.
SurfaceModel read_cad(const CadModel& model, const CadOptions& options = {});
SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions& options = {});

/// Returns the program that does it (see find_worker()); empty: there is none, and nothing can be read.
std::filesystem::path cad_program();
/// Returns the library with the kernel, which is loaded when needed; empty: there is none.
std::filesystem::path cad_library();

}  // namespace delquad
