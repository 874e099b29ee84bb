#pragma once

#include <string>
#include <variant>
#include <vector>

#include "delquad/mesh.h"

// Hexahedra, by sweeping a mesh of quads.

namespace delquad {

/// Along a straight line.
struct AlongVector {
  Vec3 shift;  ///< from the first layer of nodes to the last
};
/// Around an axis. Hexahedra have straight edges, so that a ring is a polygon's.
struct AroundAxis {
  Vec3 point, axis;      ///< the axis need not have unit length
  double degrees = 360;  ///< counterclockwise seen from where the axis points to; at most +-360, which closes
};
/// Along a polyline. The quads move with it from where they are, which need not be at its first point, and
/// turn with its tangent, but not about it. Along a segment they keep their profile, so that legs which meet
/// at a corner are mitred. Tangents halve the angles between segments; at the ends they go on as at the next
/// point where segments turn by less than 40 degrees there, else they are those of the segments.
struct AlongCurve {
  std::vector<Vec3> points;  ///< an open line
};
/// Along the normals of the quads, which look to where quads turn counterclockwise. At edges and corners
/// between planes each plane moves by the thickness.
struct AlongNormals {
  double thickness = 0;     ///< negative: against the normals
  bool both_sides = false;  ///< half of it to each side
};
using SweepPath = std::variant<AlongVector, AroundAxis, AlongCurve, AlongNormals>;

struct SweepLayers {
  /// 0: of a curve one for each segment. Else layers of curves end at equal (graded) lengths, but at each
  /// corner of 40 degrees or more the nearest one does.
  int number = 0;
  double growth = 1;  ///< each layer's height over that of the one before
  long long max_elements = 50'000'000;
};

/// Sweeps a mesh of quads of order 1. Each region becomes a volume with its names (without one "region_3", by
/// its number), and its quads faces NAME + " start" and NAME + " end", unless the sweep closes. Each curve on
/// the boundary becomes a face with its names ("curve_5"), so do named curves inside; named points become
/// curves. Quads may run either way round. `notes` learns what was left out. Throws InputError, which names
/// the place, for triangles, elements of higher order, edges of three quads, surfaces with one side, a
/// section that touches its axis, hexahedra that are not positive, and a body that meets itself.
Mesh extrude(const Mesh& mesh, const SweepPath& path, const SweepLayers& layers, ReadNotes* notes = nullptr);

/// Measures of hexahedra.
struct HexMeasures {
  /// The determinant of the unit vectors along the three edges at a corner, the least of eight: 1 for a box,
  /// not positive where the corner is inverted. The least of all hexahedra, and the mean.
  double least_jacobian = 0, mean_jacobian = 0;
  double volume = 0;
  std::vector<double> jacobian;  ///< of each hexahedron
};
HexMeasures measure(const Mesh& hexahedra);

}  // namespace delquad
