// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "delquad/mesh.h"
#include "delquad/model.h"

// This header sweeps quads to hexahedra, fills closed quads with cells, and measures cells. Programs that
// mesh solids use it.

namespace delquad {

/// Sweep along a straight line.
struct AlongVector {
  Vec3 shift;  ///< from the first layer of nodes to the last
};
/// Sweep around an axis. Hexahedra have straight edges, so a ring is a polygon. Angles count counterclockwise
/// seen from the tip of the axis, and each layer turns by less than 180 degrees.
struct AroundAxis {
  Vec3 point, axis;      ///< the axis need not have unit length
  double degrees = 360;  ///< in [-360, 360], not 0; a full turn closes
};
/// Sweep along a polyline. The quads start at their own place, not at the first point, and turn with the
/// tangent, but not about it. They keep their profile along a segment, so legs are mitered at a corner.
/// Tangents halve the angles between segments. End tangents continue the next turn if it is below 40 degrees;
/// otherwise they follow the segments.
struct AlongCurve {
  std::vector<Vec3> points;  ///< open line of two points or more, no two in a row the same
};
/// Sweep along the normals, which look to the side from which quads run counterclockwise. At edges and
/// corners between planes each plane moves by the thickness.
struct AlongNormals {
  double thickness = 0;  ///< negative: against the normals
  /// Half of it to each side. Then three or more quads may share an edge, with an even number of layers:
  /// hexahedra fill the joints of plates.
  bool both_sides = false;
};
using SweepPath = std::variant<AlongVector, AroundAxis, AlongCurve, AlongNormals>;

struct SweepLayers {
  /// Number of layers; 0: one for each segment of a curve. Along curves, layers end at equal (graded)
  /// lengths. At each corner of 40 degrees or more the nearest layer ends.
  int number = 0;
  double growth = 1;  ///< height of each layer over the height of the previous one, above 0
  long long max_elements = 50'000'000;
  /// Lengths along a vector, or thicknesses along normals, by names of regions; other regions have the length
  /// of the path. A layer ends at each height. Growth is kept between heights, in parts.
  std::map<std::string, double> heights = {};
};

/// Sweeps a mesh of quads of order 1 and returns hexahedra. Each region becomes a volume of its names, or
/// "region_3" by its number. Unless the sweep closes, its quads become faces NAME + " start" and NAME + "
/// end". Curves on the boundary and named curves inside become faces of their names ("curve_5"); named points
/// become curves. Quads may run either way round. `notes` tells the omissions. Throws InputError, with the
/// place, for triangles, higher order, edges of three quads (see AlongNormals), one-sided surfaces, and
/// sections that touch the axis. It also refuses hexahedra that are not positive, a body that meets itself,
/// paths out of range, and more than max_elements.
Mesh extrude(const Mesh& mesh, const SweepPath& path, const SweepLayers& layers, ReadNotes* notes = nullptr);

/// Measures of cells of one shape, or of all.
struct ShapeMeasures {
  std::string name;  ///< "hexahedra", "prisms", "pyramids", "tetrahedra", or "cells" for all
  std::size_t count = 0;
  double volume = 0;
  /// Least and mean scaled Jacobian. The value of a cell is the least one of its corners, a determinant of
  /// unit vectors along three edges. A cell with edges of one length has 1; an inverted corner has 0 or less.
  double least_jacobian = 0, mean_jacobian = 0;
  int unproven = 0;  ///< cells whose Jacobian is not proven positive everywhere
};
struct CellMeasures : ShapeMeasures {
  std::vector<ShapeMeasures> shapes;  ///< of each shape that there is
  std::vector<double> jacobian;       ///< value of each hexahedron, prism, pyramid and tetrahedron
};
/// Returns the measures of the cells of a mesh.
CellMeasures measure(const Mesh& mesh);

/// Kinds of cells in a volume.
enum class VolumeCells {
  kHexDominant,      ///< hexahedra as far as they go, pyramids and tetrahedra around them
  kPyramidsAndTets,  ///< a pyramid on each quad, tetrahedra between
  kTets,             ///< each quad is split into two triangles
};

struct VolumeOptions {
  VolumeCells cells = VolumeCells::kHexDominant;
  long long max_elements = 50'000'000;
  /// Stages that make hexahedra and the cells around them, by letter. `F` or `D` place points, of equilateral
  /// tetrahedra or of cubes along a field of frames. `B` recombines them to hexahedra, `C` fills gaps
  /// between these again, `O` optimizes pyramids and tetrahedra. `C` and `O` may be absent.
  std::string strategy = "DBCO";
  /// Layers of hexahedra on the faces `on`, or on all; `fan` and `into` do not count. They end on rows of
  /// quads of other faces if these look like them, elsewhere by prisms of heights that fall to zero. Heights
  /// shrink where there is no room, and `notes` tell where.
  std::optional<LayerSpec> layers = {};
};

/// Returns the kind of a name: "hex-dominant", "pyramids-and-tets" or "tets". Throws InputError for another.
VolumeCells volume_cells(const std::string& name);
/// Throws InputError unless a text is as VolumeOptions::strategy.
void check_strategy(const std::string& strategy);

/// Returns layers on faces of a skin, along the curves where the layers of its volume end. With these in a
/// problem, mesh() makes rows of quads for fill_skin() to end layers on. No `on` in the result: none is
/// needed. Throws InputError for unknown names.
LayerSpec layers_beside(const LayerSpec& layers, const Mesh& skin);

/// Fills closed quads of order 1 with cells. Quads may enclose cavities and several bodies, also with quads
/// between them. Points keep their numbers and places. Quads look outwards afterwards; with tetrahedra alone
/// each becomes two triangles. Each body is a volume, with the names that all its faces share; a cavity is
/// told to `notes`. The same input gives the same bytes. Throws InputError, with the place, for triangles,
/// quads that are open or cross each other, and bodies that cannot be filled.
///
/// For tetrahedra alone the quads may have order 2. Then points are renumbered, and Mesh::middle_nodes gets
/// the middle nodes of the skin. Where tetrahedra would fold, these move towards straight edges, and `notes`
/// tell where.
Mesh fill_skin(const Mesh& skin, const VolumeOptions& options = {}, ReadNotes* notes = nullptr);

}  // namespace delquad
