// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "delquad/mesh.h"

// This header has models: planar domains of curves or lines, surfaces of triangles or CAD. Problems hold
// them.

namespace delquad {

/// A regular curve in the plane z = 0, with t in [0, 1].
class Curve {
 public:
  virtual ~Curve() = default;
  /// Several threads may call it.
  virtual Vec2 point(double t) const = 0;
  /// Returns ascending parameters, strictly between 0 and 1, with a compulsory mesh node (corners of a
  /// polyline).
  virtual std::vector<double> fixed_parameters() const { return {}; }
};

// Makers of curves. Each curve begins and ends exactly at its given points. All throw InputError, with the
// argument, for numbers that are not finite, curves without length, and arguments beyond the ranges below.

std::shared_ptr<const Curve> make_segment(Vec2 a, Vec2 b);

/// Takes at least two points, consecutive ones distinct; the last may equal the first. Every corner gets a
/// node.
std::shared_ptr<const Curve> make_polyline(std::vector<Vec2> points);

/// Makes the cubic spline through at least two points, consecutive ones distinct, parametrized by chord
/// length. It is natural at its ends, or periodic if the last point equals the first. A turn of chords by
/// more than `corner` (radians) makes a corner with a node, and ends of the spline there.
std::shared_ptr<const Curve> make_spline(std::vector<Vec2> points, double corner = std::numbers::pi / 3);

/// Makes an arc of a radius above 0 from angle0 to angle1 (radians), counterclockwise if angle1 > angle0, of
/// at most one turn. A full turn, to rounding, ends exactly at its start.
std::shared_ptr<const Curve> make_arc(Vec2 centre, double radius, double angle0, double angle1);

/// Makes a circle, counterclockwise from the point at angle 0.
std::shared_ptr<const Curve> make_circle(Vec2 centre, double radius);

/// Makes point(t) for t from t0 to t1, in either direction. Several threads may call `point`.
std::shared_ptr<const Curve> make_parametric_curve(std::function<Vec2(double)> point, double t0, double t1);

/// Makes (x(t), y(t)) for t from t0 to t1, in either direction, from formulas in t as in
/// make_expression_size().
std::shared_ptr<const Curve> make_expression_curve(const std::string& x, const std::string& y, double t0,
                                                   double t1);

struct ModelCurve {
  std::shared_ptr<const Curve> shape;
  std::string name;       ///< physical group of the boundary; may be empty
  std::string where;      ///< file and line (or entity) of the curve, for messages
  bool is_crack = false;  ///< nodes are doubled, except at ends inside: the mesh opens there
  bool is_gone = false;   ///< it only keeps its number and is in no loop
  bool is_data = false;   ///< measured points: some may get no node, see SurfaceSpec::simplify
};

/// Numbers of edges on curves, independent of size; from 1 to 100 million on each.
struct CurveDivision {
  std::string name;        ///< name or number of the curves, as in files: "curve_7"
  int edges = 0;           ///< for each curve, at least 1
  double progression = 1;  ///< length of an edge over the length of the previous one, in the direction of the
                           ///< curve; > 0
  double bump = 1;         ///< length of edges at the ends over length in the middle; > 0
  std::string where = "division";  ///< origin of the request, for messages
};

/// Curves that get images of the nodes of other curves, or faces that get images of meshes.
struct PeriodicPair {
  std::string from, to;            ///< names, or numbers: "curve_7", "region_2"; faces win if both name some
  Motion motion;                   ///< maps `from` to `to`
  std::string where = "periodic";  ///< origin of the request, for messages
};

/// Symmetry line of a planar model, or symmetry plane in space.
struct SymmetryPlane {
  Vec3 point, normal;  ///< the normal need not have unit length
};

/// Planes of symmetry. Only their positive side is meshed, and then mirrored.
struct SymmetrySpec {
  std::vector<SymmetryPlane> planes = {};  ///< one or two perpendicular planes, for surfaces up to three
  bool automatic = false;                  ///< use all planes that are found
  std::string where = "symmetry";          ///< origin of the request, for messages
};

/// A corner of a grid.
struct GridCorner {
  std::string name = {};  ///< name of a point of the model; empty: the place counts
  Vec3 at = {};           ///< within 0.001 outline diagonals of a node of the outline
};

/// Corners of the grid in a region.
struct GridCorners {
  std::string region;               ///< name or number, as in MappedSpec
  std::vector<GridCorner> corners;  ///< three or four, in any order
  std::string where = "mapped";     ///< origin of the request, for messages
};

/// Regions or faces of a surface that become grids, as fine as their sides.
struct MappedSpec {
  std::vector<std::string> names = {};  ///< names of regions, or numbers: "region_2"
  bool automatic = false;               ///< also all regions with four nearly right angles and matching sides
  std::string where = "mapped";         ///< origin of the request, for messages
  std::vector<GridCorners> corners = {};  ///< corners of regions, named above or not
  /// Surface regions by number ("region_2") that become rings of so many rows if possible. The number -1
  /// allows any grid with quads no worse than the criteria allow.
  std::vector<std::pair<std::string, int>> rings = {};

  bool asks() const { return automatic || !names.empty() || !corners.empty() || !rings.empty(); }
};

/// A closed chain of curves. Loops may share curves and points, and may be nested; they must not cross.
struct ModelLoop {
  std::vector<int> curves;  ///< indices into PlanarModel::curves, end to start; either orientation
  std::string region;       ///< name of the region inside; a named hole is filled by a region of that name
  std::string where;
  bool is_hole = false;  ///< it must not bound a region from outside
};

/// A point that becomes a node of the mesh.
struct ModelPoint {
  Vec2 at;
  std::string name;   ///< physical group; may be empty
  std::string where;  ///< as ModelCurve::where
};

/// A planar model bounded by analytic curves.
///
/// A curve that touches another one with an end shares a node with it; overlaps of curves are merged. Curves
/// outside of all loops are embedded in the regions as chains of mesh edges. They may cross any curve and end
/// anywhere in a region. One with a name that lies on the boundary names that part of it.
struct PlanarModel {
  std::string source;  ///< file of the model, for messages
  std::vector<ModelCurve> curves;
  std::vector<ModelLoop> loops;
  std::vector<ModelPoint> points = {};  ///< in regions or on curves
  std::vector<std::string> notes = {};  ///< notes of the reader, for warnings
};

/// Makes a domain bounded by polygons, each a loop of at least three corners without repetition of the first.
/// Nested loops are holes. Every corner gets a node. Throws InputError, with the polygon, for fewer corners
/// and for equal ones in a row.
PlanarModel polygons(const std::vector<std::vector<Vec2>>& loops);

/// Surfaces that a mesh file declares, with or without elements.
struct DeclaredSurfaces {
  std::vector<std::string> group_names;  ///< names of the named groups of dimension 2
  struct Surface {
    Entity entity;
    std::vector<int> curves;  ///< tags of its boundary curves, ascending
  };
  std::vector<Surface> surfaces;
};

/// Thin quads along curves of a planar model, for flow solvers at walls. Each edge of the curves is the foot
/// of a column of stacked quads.
struct LayerSpec {
  std::vector<std::string> on;         ///< names of curves that bound regions
  double first = 0;                    ///< height of the quads at the curve, above 0
  double growth = 1.2;                 ///< height of a quad over the height of the quad below, at least 1
  int number = 0;                      ///< quads in a column, at most 10 000; 0: enough to reach `thickness`
  double thickness = 0;                ///< height of a column; 0: `number` sets it. Exactly one is given
  double fan = 60;                     ///< degrees in (0, 120]; corners that turn away by more get a fan
  std::vector<std::string> into = {};  ///< names of regions that get layers; empty: both sides
  std::string where = "layer";         ///< origin of the request, for messages
};

/// Returns the distance of each layer of a column from the curve, in ascending order. Throws InputError for
/// numbers that make no layers or more than 10 000.
std::vector<double> layer_heights(const LayerSpec& layer);

/// Rows of quads around round and slotted holes of planar models of curves and of surface faces: 1 to 1000.
struct WasherSpec {
  double least = 0, most = 0;     ///< diameters of the holes; width of slots and ovals
  int rows = 1;                   ///< number of rows, if space allows
  int edges = 0;                  ///< number of edges around, even; 0: by size, at least 6
  double width = 0;               ///< width of all rows; 0: rows are about as high as edges are long
  std::string where = "washers";  ///< origin of the request, for messages
};

/// Rows of quads across fillets of CAD models: faces of one radius with two smooth opposite sides.
struct FilletRows {
  double least = 0, most = 0;  ///< radii, in the unit of the model
  int rows = 1;
  std::string where = "fillet_rows";  ///< origin of the request, for messages
};

/// A planar domain bounded by lines; each becomes an edge of the mesh.
///
/// Regions take names from the elements just inside a loop, or from the declared surface with exactly these
/// curves. Otherwise a single region takes the name of the only named group. A loop in a region with such a
/// surface is no hole.
struct LineModel {
  Mesh mesh;  ///< its lines; all points have the same z
  DeclaredSurfaces surfaces = {};
  std::string source = "lines";  ///< for messages
};

/// A triangulated surface; its quads are split. Each region has one face or more. Lines, borders of regions
/// and sharp edges are curves.
struct TriangleModel {
  Mesh mesh;
  std::string source = "triangles";     ///< for messages
  std::vector<std::string> notes = {};  ///< notes of the reader, for warnings
};

/// A mesh to improve. Pipelines begin from its triangles (B, G, T, L) or quads (C, O). All names stay, and
/// nodes on the outline, on lines and between regions stay. In space, nodes on sharp edges and at more than
/// two elements stay, too; elements are the surface, with quads as two triangles. A pipeline from triangles
/// halves quads; a pipeline from quads keeps triangles. The default size is the size of the elements.
struct GivenMesh {
  Mesh mesh;                            ///< conforming
  std::string source = "mesh";          ///< for messages
  std::vector<std::string> notes = {};  ///< notes of the reader, for warnings
};

/// A STEP, IGES or BREP file, or its bytes.
struct CadModel {
  std::filesystem::path file;
  std::string bytes = {};  ///< used if there is no file
};

/// Sets the program delquad-cad, which reads CAD files for this process; it is not checked before the first
/// file. By default it is beside the running program or where it was installed. The environment variable
/// DELQUAD_CAD_WORKER overrides both.
void set_cad_worker(const std::filesystem::path& program);
/// Keeps prepared CAD models of this process in a folder, which is made. A file with the same content,
/// options and versions is then neither read nor triangulated again, at whatever size. The models last used
/// stay, up to 1 GiB. Empty, the default: none is kept.
void set_cad_cache(const std::filesystem::path& folder);

/// Built-in model, see example_models().
struct ExampleModel {
  std::string name;
};

/// A file of any readable format, chosen by extension: a LineModel, TriangleModel or CadModel. Meshing reads
/// it.
struct ModelFile {
  std::filesystem::path path;
  bool given = false;  ///< read it as a GivenMesh
};

using Model =
    std::variant<PlanarModel, LineModel, TriangleModel, GivenMesh, CadModel, ExampleModel, ModelFile>;

/// Name and description of a built-in model.
struct Example {
  std::string name, description;
};
/// Returns all built-in models.
const std::vector<Example>& example_models();

/// Faces of a surface that are meshed as one.
enum class Compounds { kNone, kTangent, kAll, kGroups };

/// Plane that completes a half model. Open edges lie on it within `tolerance`, from 0 to 0.1 diagonals of the
/// model.
struct MirrorPlane {
  Vec3 point, normal;  ///< the normal need not have unit length
  double tolerance = 0;
  /// Both images of a triangle share its region, so that faces continue through the plane. Otherwise the
  /// other half has its own regions of the same names, and curves run along the plane.
  bool join = true;
};

/// A polyline on a surface, which becomes edges of the mesh, or one point, which becomes a node.
struct EmbeddedLine {
  /// All points become nodes; a single one stands for a point. They lie within 0.001 model diagonals of the
  /// surface, in the unit of the mesh. An edge between two points follows the surface in the plane of both
  /// points and the mean of its normals there.
  std::vector<Vec3> points;
  std::string name;       ///< physical group; may be empty, and several lines may share it
  std::string where;      ///< as ModelCurve::where
  bool is_crack = false;  ///< as ModelCurve::is_crack
};

/// Selects faces or curves of a surface. All given rules must match.
struct PartRule {
  std::vector<int> numbers = {};  ///< as `delquad info` lists them
  std::string like = {};          ///< pattern for one of their names: * matches any text, ? one character
  std::optional<std::array<Vec3, 2>> box = {};  ///< two opposite corners of a box that contains them
  std::optional<Vec3> normal = {};              ///< direction of all normals, within 5 degrees
  std::optional<Vec3> at = {};                  ///< selects the nearest one
};

/// Gives faces or curves a name, before compounds are made. Other names are kept.
struct NamedPart {
  std::string name;     ///< physical group
  bool curves = false;  ///< select curves instead of faces
  PartRule rule = {};
  std::string where = "name";  ///< origin of the request, for messages
};

/// Options for the faces of a surface.
struct SurfaceSpec {
  Compounds compounds = Compounds::kNone;
  std::vector<std::vector<int>> groups;  ///< for kGroups: tags of faces
  /// Faces narrower than this length join a neighbor. Shorter curves join a neighbor or become a point.
  /// Planar models use leave_out_small(). 0: none.
  double ignore_below = 0;
  bool idealize = false;               ///< ignore_below defaults to min_length of the criteria
  std::vector<std::string> keep = {};  ///< names of parts that must stay
  double fill_holes = 0;               ///< close holes and tubes up to this diameter; 0: none
  /// Polylines, and chains of curves of a surface, lose corners within this many sizes of the remaining line;
  /// 0: all stay. Absent: 0.1 for measured points, 0 for others; see join_curves() for surfaces.
  std::optional<double> simplify;
  std::optional<double> feature_angle;   ///< degrees in (0, 180]; absent: 40
  std::optional<double> weld_tolerance;  ///< part of the diagonal in [0, 0.1]; absent: 1e-9
  std::optional<MirrorPlane> mirror;
  bool glue = false;  ///< bodies of a CAD model share touching faces and curves
  /// Unit of lengths in the mesh, for models with a unit: um, mm, cm, m, km, in or ft. Empty: mm for STEP and
  /// IGES, else the unit of the model.
  std::string unit;
  std::vector<EmbeddedLine> embed;
  std::vector<NamedPart> names;
  /// Only faces that one of these selects are meshed, after compounds are made; empty: all. Nodes on their
  /// outline depend on the model and its sizes alone. So meshes of other faces fit there, node by node.
  std::vector<PartRule> faces;
  /// Mesh thin bodies half-way between their opposite faces, with Mesh::thickness.
  bool midsurface = false;
  std::string where;  ///< origin of the request, for messages; empty: no request
};

}  // namespace delquad
