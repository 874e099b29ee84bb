#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/surface/mirror.h"
#include "geometry/surface/surface_model.h"
#include "io/toml_reader.h"

namespace delquad {

/// Which faces of a surface are meshed as one.
enum class Compounds { kNone, kTangent, kAll, kGroups };

/// How the faces of a surface are made from what its file holds, as it was written.
struct SurfaceSpec {
  Compounds compounds = Compounds::kNone;
  std::vector<std::vector<int>> groups;  ///< of kGroups: tags of faces
  double merge_curves = 0;               ///< curves shorter than this length become one with a neighbour
  std::optional<double> feature_angle;   ///< degrees; absent: that of TriangulatedOptions and CompoundOptions
  std::optional<double> weld_tolerance;  ///< part of the diagonal; absent: that of TriangulatedOptions
  std::optional<MirrorPlane> mirror;
  std::string where;  ///< for messages; empty: nothing was asked for
};

/// The keys of a [surface] table: compound, merge_curves, feature_angle, weld_tolerance, mirror. Throws
/// InputError with file and line.
SurfaceSpec read_surface_spec(const TomlTable& table);

/// "all" or "tangent". Throws InputError, beginning with `where`, for anything else.
Compounds parse_compounds(const std::string& text, const std::string& where);
/// The value, when it is above 0 and at most 180. Throws InputError, beginning with `where`, otherwise.
double checked_feature_angle(double degrees, const std::string& where);
/// The value, when it is from 0 to 0.1. Throws InputError, beginning with `where`, otherwise.
double checked_weld_tolerance(double part, const std::string& where);

/// The model of a triangulated surface, mirrored, welded and with the compounds that the specification asks
/// for.
SurfaceModel make_model(const SurfaceSpec& spec, Mesh triangles, const std::string& source);
/// Compounds made and short curves merged. Throws InputError for faces that do not exist or do not hang
/// together.
SurfaceModel make_compounds(const SurfaceSpec& spec, SurfaceModel model);
/// Throws InputError for what has no effect on a CAD model: welding, a mirror, an angle without compounds.
void check_for_cad(const SurfaceSpec& spec);

}  // namespace delquad
