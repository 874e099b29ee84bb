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
  /// Largest angle between neighbouring sides of a curve, and normals of a face across an inner side,
  /// radians.
  double angle = 0.15;
  /// Processor time that the kernel may take to triangulate a face, in one of its trials. Faces that take
  /// longer, or for which it fails, are triangulated from their outlines. No face of 24 models took more than
  /// 2.2 s, so that the machine does not decide.
  double face_seconds = 6;
  /// The same for checking and healing all of the shape, which then is taken as it is. No model took more
  /// than 1.5 s.
  double healing_seconds = 20;
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

/// Reads a STEP, IGES or BREP file, or its bytes (told apart by content), through OpenCASCADE. Lengths are in
/// the unit that is asked for in STEP and IGES, whatever the file's unit, and as given in BREP, which has
/// none, so that to ask for one is an InputError. Where faces that no solid has both touch or cross (see
/// loose_joints.h) is told in a warning, and where they come near; with options.glue they share curves and
/// nodes there. Each face and each edge stands once, as region and curve; their tags are their numbers in the
/// file's order, so that gaps stay where degenerate edges and seams were: these are no curves, the
/// triangulation is connected across them. A region's names are those of its face, solids and products in
/// STEP and IGES and its colour ("colour #rrggbb"). Normals of a solid point outwards. Edges that stand in
/// faces and join others are embedded. Invalid shapes are healed and coincident free edges sewn, and a
/// warning says so; so are faces taken out whose edges lie on each other within their tolerances. Warnings
/// also tell free and non-manifold curves. Projected points are accurate to 1e-9 of the diagonal where the
/// surface is regular. The kernel works in a worker process (see find_worker()), so that a damaged file
/// cannot bring the program down; what it prints is lost. Throws Cancelled, and InputError naming the file
/// for files that cannot be read or hold no face, and naming the faces that are unbounded, have no area,
/// cross their own boundary or cannot be triangulated, unless options.keep_going leaves them out and others
/// remain (an unbounded one is refused in any case), or the places that cannot be glued.
SurfaceModel read_cad(const CadModel& model, const CadOptions& options = {});
SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions& options = {});

/// The program that does it (see find_worker()); empty: there is none, and nothing can be read.
std::filesystem::path cad_program();
/// The library with the kernel, which is loaded when needed; empty: there is none.
std::filesystem::path cad_library();

}  // namespace delquad
