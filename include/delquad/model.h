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

// What can be meshed: planar domains by curves or by lines, surfaces by triangles or by CAD.

namespace delquad {

/// A regular curve of the plane z = 0, t in [0, 1].
class Curve {
 public:
  virtual ~Curve() = default;
  virtual Vec2 point(double t) const = 0;
  /// Parameters strictly between 0 and 1, ascending, at which a mesh node is compulsory (a polyline's
  /// corners).
  virtual std::vector<double> fixed_parameters() const { return {}; }
};

// The curves a model can be made of. Each begins and ends exactly at the points it is given. All throw
// InputError for coordinates that are not finite and for curves without length; the message says which
// argument.

std::shared_ptr<const Curve> make_segment(Vec2 a, Vec2 b);

/// At least two points, none equal to the one before; the last may equal the first. Every corner gets a node.
std::shared_ptr<const Curve> make_polyline(std::vector<Vec2> points);

/// The cubic spline through two points or more, none equal to the one before, twice differentiable by the
/// length of chords; natural at its ends, periodic if the last point equals the first. Where chords turn by
/// more than `corner` (radians) it has a corner, with a node, and ends there as at its ends.
std::shared_ptr<const Curve> make_spline(std::vector<Vec2> points, double corner = std::numbers::pi / 3);

/// From angle0 to angle1 (radians), counterclockwise when angle1 > angle0; at most one turn. A full turn, to
/// rounding, ends at the very point where it began.
std::shared_ptr<const Curve> make_arc(Vec2 centre, double radius, double angle0, double angle1);

/// Counterclockwise from the point at angle 0.
std::shared_ptr<const Curve> make_circle(Vec2 centre, double radius);

/// point(t) for t from t0 to t1, either direction. Safe to call from several threads.
std::shared_ptr<const Curve> make_parametric_curve(std::function<Vec2(double)> point, double t0, double t1);

/// (x(t), y(t)) for t from t0 to t1, either direction: formulas in t, as those of make_expression_size().
std::shared_ptr<const Curve> make_expression_curve(const std::string& x, const std::string& y, double t0,
                                                   double t1);

struct ModelCurve {
  std::shared_ptr<const Curve> shape;
  std::string name;       ///< physical group of the boundary; may be empty
  std::string where;      ///< file and line (or entity) it was read from, for messages
  bool is_crack = false;  ///< its nodes are doubled, except where it ends inside: the mesh comes apart there
  bool is_gone = false;   ///< it only keeps its number, and no loop has it
  bool is_data = false;   ///< its points were measured: they need not all be nodes, see SurfaceSpec::simplify
};

/// How curves are divided into edges, whatever the size asks for.
struct CurveDivision {
  std::string name;        ///< of the curves; those without go by their number, as in files: "curve_7"
  int edges = 0;           ///< of each of them, at least 1
  double progression = 1;  ///< length of each edge, of that before it, along the curve as it was given; > 0
  double bump = 1;         ///< length of the edges at the ends, of those in the middle; > 0
  std::string where = "division";  ///< who asked for it, for messages
};

/// Curves that get the images of the nodes of others, or faces of a surface that get their meshes.
struct PeriodicPair {
  std::string from, to;  ///< names, or numbers: "curve_7", "region_2"; both of faces: those are meant
  Motion motion;         ///< that takes those of `from` to those of `to`
  std::string where = "periodic";  ///< who asked for it, for messages
};

/// A line of the plane, or a plane of space, at which a model is symmetric.
struct SymmetryPlane {
  Vec3 point, normal;  ///< the normal need not have unit length
};

/// What is meshed on the positive side of planes only, and mirrored to the others.
struct SymmetrySpec {
  std::vector<SymmetryPlane> planes = {};  ///< one, or two that are perpendicular; of surfaces up to three
  bool automatic = false;                  ///< those that are found
  std::string where = "symmetry";          ///< who asked for it, for messages
};

/// A corner of a grid.
struct GridCorner {
  std::string name = {};  ///< of a point of the model; empty: the place counts
  Vec3 at = {};           ///< within a thousandth of the outline's diagonal of a node that the outline has
};

/// Where the sides of a region's grid begin.
struct GridCorners {
  std::string region;               ///< name or number, as in MappedSpec
  std::vector<GridCorner> corners;  ///< three or four, in any order
  std::string where = "mapped";     ///< who asked for it, for messages
};

/// Regions, or faces of a surface, that become grids, as fine as their sides.
struct MappedSpec {
  std::vector<std::string> names = {};  ///< of the regions, or numbers: "region_2"
  bool automatic = false;        ///< and all where that pays: four nearly right angles, sides that match
  std::string where = "mapped";  ///< who asked for it, for messages
  std::vector<GridCorners> corners = {};  ///< of regions whose corners are told, named above or not
  /// Numbers of regions of surfaces ("region_2") that become rings of so many rows where they can; -1: any
  /// grids, where their quads are no worse than a sheet allows.
  std::vector<std::pair<std::string, int>> rings = {};

  bool asks() const { return automatic || !names.empty() || !corners.empty() || !rings.empty(); }
};

/// A closed chain of curves. Loops may share curves and points, and lie in each other; none may cross
/// another.
struct ModelLoop {
  std::vector<int> curves;  ///< indices into PlanarModel::curves, end to start, closed; either orientation
  std::string region;  ///< name of the region inside; on a hole: the hole is filled by a region of that name
  std::string where;
  bool is_hole = false;  ///< it must bound no region from outside
};

/// A point that becomes a node of the mesh.
struct ModelPoint {
  Vec2 at;
  std::string name;   ///< physical group; may be empty
  std::string where;  ///< as that of a curve
};

/// A planar model bounded by analytic curves.
///
/// Curves that touch another with an end share a node with it, and those that lie on each other are one
/// there. Those that no loop has stand in the regions: they may cross any others and end anywhere in a
/// region, and become chains of edges of the mesh.
struct PlanarModel {
  std::string source;  ///< file it was read from, for messages
  std::vector<ModelCurve> curves;
  std::vector<ModelLoop> loops;
  std::vector<ModelPoint> points = {};  ///< in regions or on curves
  std::vector<std::string> notes = {};  ///< of its reader, for warnings
};

/// A domain bounded by polygons, each a loop of at least three corners without the first repeated. Loops
/// inside others are holes. Every corner gets a node.
PlanarModel polygons(const std::vector<std::vector<Vec2>>& loops);

/// What a mesh file says of surfaces, whether it has elements on them or not.
struct DeclaredSurfaces {
  std::vector<std::string> group_names;  ///< of the named groups of dimension 2
  struct Surface {
    Entity entity;
    std::vector<int> curves;  ///< tags of the curves that bound it, ascending
  };
  std::vector<Surface> surfaces;
};

/// Thin quads along curves of a planar model, as flow solvers want them at walls. Each edge of the curves is
/// the foot of a column of quads that stand on each other.
struct LayerSpec {
  std::vector<std::string> on;         ///< names of curves that bound regions
  double first = 0;                    ///< height of the quads at the curve
  double growth = 1.2;                 ///< height of a quad over that of the one below it, at least 1
  int number = 0;                      ///< quads in a column; 0: as many as reach `thickness`
  double thickness = 0;                ///< height of a column; 0: `number` says it. One of both is given
  double fan = 60;                     ///< degrees in (0, 120]: corners that turn away by more get a fan
  std::vector<std::string> into = {};  ///< names of the regions that get them; empty: on both sides
  std::string where = "layer";         ///< who asked for it, for messages
};

/// How far the layers of a column reach from their curve: the first, the second, ..., the whole. Throws
/// InputError for numbers that make no layers.
std::vector<double> layer_heights(const LayerSpec& layer);

/// Rows of quads around round and slotted holes of planar models of curves, and in faces of surfaces.
struct WasherSpec {
  double least = 0, most = 0;     ///< diameters of the holes; of slots and ovals their width
  int rows = 1;                   ///< where there is room
  int edges = 0;                  ///< around, even; 0: as the size asks for, 6 at least
  double width = 0;               ///< of all rows; 0: they are about as high as edges are long
  std::string where = "washers";  ///< who asked for it, for messages
};

/// Rows of quads across fillets of CAD models: faces of one radius that go on smoothly on two opposite sides.
struct FilletRows {
  double least = 0, most = 0;  ///< radii
  int rows = 1;
  std::string where = "fillet_rows";  ///< who asked for it, for messages
};

/// A planar domain bounded by lines, which are kept: each becomes an edge of the mesh.
///
/// Regions get their names where that is plain: from the elements of the mesh just inside of a loop; else
/// from the declared surface with just these curves; else, for a single region, from the only group that has
/// a name. A loop in a region that holds such a surface is no hole.
struct LineModel {
  Mesh mesh;  ///< its lines count; points with the same z
  DeclaredSurfaces surfaces = {};
  std::string source = "lines";  ///< for messages
};

/// A triangulated surface. Quads are split. Each region is at least one face; lines, regions' borders and
/// sharp edges are curves.
struct TriangleModel {
  Mesh mesh;
  std::string source = "triangles";     ///< for messages
  std::vector<std::string> notes = {};  ///< of its reader, for warnings
};

/// A mesh to improve: words may begin from its triangles (B, G, T, L) or quads (C, O). Its nodes on the
/// outline, on lines and between regions stay, in space also those on sharp edges and where more than two
/// elements meet, and so do all names. In space its elements, quads as two triangles, are the surface. Quads
/// are halved where a word begins from triangles; triangles among quads stay where it begins from quads.
/// Where nothing is said, the size is that of the elements.
struct GivenMesh {
  Mesh mesh;                            ///< conforming
  std::string source = "mesh";          ///< for messages
  std::vector<std::string> notes = {};  ///< of its reader, for warnings
};

/// A STEP, IGES or BREP file, or one's bytes.
struct CadModel {
  std::filesystem::path file;
  std::string bytes = {};  ///< counts where there is no file
};

/// The program delquad-cad, which reads CAD files for all of this process; else it is looked for beside the
/// running program and where it was installed. The environment variable DELQUAD_CAD_WORKER, where it is set,
/// counts more.
void set_cad_worker(const std::filesystem::path& program);

/// A model that the library makes itself, see example_models().
struct ExampleModel {
  std::string name;
};

/// A mesh or CAD in a file of any format that the program reads, by its extension: a LineModel, TriangleModel
/// or CadModel, which is read when it is meshed.
struct ModelFile {
  std::filesystem::path path;
  bool given = false;  ///< a GivenMesh
};

using Model =
    std::variant<PlanarModel, LineModel, TriangleModel, GivenMesh, CadModel, ExampleModel, ModelFile>;

/// The examples' names and what they are.
struct Example {
  std::string name, description;
};
const std::vector<Example>& example_models();

/// Which faces of a surface are meshed as one.
enum class Compounds { kNone, kTangent, kAll, kGroups };

/// A surface that is one half of a model.
struct MirrorPlane {
  Vec3 point, normal;  ///< the normal need not have unit length
  double tolerance =
      0;  ///< how far open edges may lie from the plane; a part of the model's diagonal, from 0
  /// Both images of a triangle are in its region, so that faces run on through the plane; else the other half
  /// has regions of its own, of the same names, and curves run along the plane.
  bool join = true;
};

/// A polyline on a surface, which becomes edges of the mesh, or a single point, which becomes a node.
struct EmbeddedLine {
  /// At most a thousandth of the model's diagonal away from the surface, in the unit of the mesh; one: a
  /// point. All become nodes. Edges between two of them follow the surface in the plane through both and the
  /// mean of its normals there.
  std::vector<Vec3> points;
  std::string name;   ///< physical group; may be empty, and that of several
  std::string where;  ///< as that of a curve
};

/// Faces or curves of a surface that get a name, before compounds are made. All that is given must fit; what
/// has names keeps them, and has this one, too.
struct NamedPart {
  std::string name;               ///< physical group
  bool curves = false;            ///< else faces
  std::vector<int> numbers = {};  ///< as `delquad info` lists them
  std::string like = {};          ///< of the names that they have one: * stands for any text, ? for a letter
  std::optional<std::array<Vec3, 2>> box = {};  ///< two opposite corners: it holds them whole
  std::optional<Vec3> normal = {};              ///< faces look this way everywhere, within 5 degrees
  std::optional<Vec3> at = {};                  ///< the one that is nearest to it
  std::string where = "name";                   ///< who asked for it, for messages
};

/// How the faces of a surface are made from what its model holds.
struct SurfaceSpec {
  Compounds compounds = Compounds::kNone;
  std::vector<std::vector<int>> groups;  ///< of kGroups: tags of faces
  /// Faces narrower than this length become part of a neighbour, curves shorter than it one with a neighbour
  /// or a point; of planar models see leave_out_small(); 0: none.
  double ignore_below = 0;
  bool idealize = false;  ///< ignore_below is min_length of the criteria, where nothing else is said
  std::vector<std::string> keep = {};  ///< what has these names is not left out
  double fill_holes = 0;               ///< holes and tubes not wider than this diameter are closed; 0: none
  /// Planar polylines lose the points that lie within so many sizes of what stays; 0: all points stay.
  /// Absent: 0.1 of those of data, 0 of others.
  std::optional<double> simplify;
  std::optional<double> feature_angle;   ///< degrees in (0, 180]; absent: 40
  std::optional<double> weld_tolerance;  ///< part of the diagonal in [0, 0.1]; absent: 1e-9
  std::optional<MirrorPlane> mirror;
  bool glue = false;  ///< bodies of a CAD model share the faces and curves at which they touch
  /// Of the lengths that the mesh gets, for models that say theirs: um, mm, cm, m, km, in or ft; empty: mm
  /// for STEP and IGES, else as the model has them.
  std::string unit;
  std::vector<EmbeddedLine> embed;
  std::vector<NamedPart> names;
  std::string where;  ///< who asked for it, for messages; empty: nothing was asked for
};

}  // namespace delquad
