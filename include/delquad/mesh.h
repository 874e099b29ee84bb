#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// Points, meshes in space, and meshes of one patch in its parameter plane.

namespace delquad {

/// A point or vector of a plane (physical or parameter plane).
struct Vec2 {
  double x = 0, y = 0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline Vec2& operator+=(Vec2& a, Vec2 b) { return a = a + b; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// z component of a x b: positive when b lies counterclockwise of a.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }
inline Vec2 perp(Vec2 a) { return {-a.y, a.x}; }

/// A point or vector of physical space.
struct Vec3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

/// A named part of a model: a point, a curve or a region.
struct Entity {
  int tag = 0;                     ///< number in files, > 0
  std::vector<std::string> names;  ///< physical groups that hold it; may be empty
};

/// How the names begin that CAD faces have from their colours.
inline constexpr std::string_view kColourName = "colour #";

/// A point of a mesh that stands for a point of the model.
struct NamedPoint {
  int point;  ///< index into Mesh::points
  Entity entity;
};

/// A turn about an axis, then a shift.
struct Motion {
  Vec3 shift = {};
  double angle = 0;  ///< radians, counterclockwise seen from where the axis points to
  Vec3 centre = {};
  Vec3 axis = {0, 0, 1};  ///< need not have unit length
  Vec3 operator()(const Vec3& x) const;
  /// As a matrix of four rows for points (x, y, z, 1).
  std::array<double, 16> matrix() const;
  /// That takes everything back.
  Motion inverse() const;
};

/// Nodes of a curve that are images of those of another.
struct PeriodicNodes {
  int curve, master;                      ///< indices into Mesh::curves
  Motion motion;                          ///< that takes the master there
  std::vector<std::array<int, 2>> nodes;  ///< each beside that of which it is the image
};

/// A face that is the image of another: its elements are those of the master, in the same order.
struct PeriodicFaces {
  int face, master;  ///< indices into Mesh::regions
  Motion motion;     ///< that takes the master there
  bool is_reversed;  ///< its elements run the other way round, as on opposite faces of a body
  std::vector<std::array<int, 2>>
      nodes;  ///< each beside that of which it is the image; those on curves first
};

/// The highest polynomial degree of elements.
inline constexpr int kMostOrder = 4;

/// A mesh in space: line elements on curves, triangles and quads in regions. Planar meshes have z = 0.
/// Indices count from 0. With hexahedra, see extrude(), it has no triangles, and its quads are the boundary,
/// counterclockwise seen from outside, and faces inside that have a name.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::array<int, 2>> lines;
  std::vector<int> line_curve;  ///< index into `curves` of each line
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> triangle_region;  ///< index into `regions` of each triangle
  std::vector<std::array<int, 4>> quads;
  std::vector<int> quad_region;
  /// Polynomial degree of the elements, 1 to 4. Above 1 they are curved: `lines` and `quads` are their
  /// corners, and these are their further nodes, one element after the other. Of a line order - 1, from its
  /// first end to its second; of a quad order - 1 for each side, as the quad runs round, then (order - 1)^2
  /// inside, in rows along the first side. They lie at equal distances of the element's parameters. Such
  /// meshes have no triangles.
  int order = 1;
  std::vector<int> line_nodes = {}, quad_nodes = {};
  std::vector<Entity> curves;
  std::vector<Entity> regions;
  std::vector<NamedPoint> named_points;
  std::vector<PeriodicNodes> periodic;
  std::vector<PeriodicFaces> periodic_faces;
  std::string unit;  ///< of lengths, such as "mm"; empty: not known
  /// Corners: four around one side, counterclockwise seen from the side opposite, then the four opposite of
  /// these.
  std::vector<std::array<int, 8>> hexahedra = {};
  std::vector<int> hex_volume = {};  ///< index into `volumes` of each hexahedron
  std::vector<Entity> volumes = {};
};

/// Length of the diagonal of the bounding box; 0 without points.
double diagonal(const Mesh& mesh);

/// What is wrong with the mesh, one line each; empty when it is sound: indices in range, no repeated vertex
/// in an element, each edge in at most two elements which run along it in opposite directions, no element
/// used twice, every line an edge of some element (when there are elements), no vertex that nothing uses.
std::vector<std::string> check_invariants(const Mesh& mesh);

/// The greatest difference of the numbers of two nodes of one element; 0 without elements.
int bandwidth(const Mesh& mesh);
/// Numbers the nodes anew by the reversed order of Cuthill and McKee [1969], so that matrices have their
/// entries near the diagonal. All else keeps its order. Nothing changes where the bandwidth would not become
/// less.
void reduce_bandwidth(Mesh& mesh);

/// What a reader did to the file's content that its user should know, one sentence each.
using ReadNotes = std::vector<std::string>;

/// Reads a file by its extension: .msh, .vtu, .obj, .inp, .mesh, .mfem, .bdf, .off, .stl, .ply or .3mf. The
/// file may be packed (.gz). Throws InputError with file and line or byte. For any other extension the
/// message names the known ones.
Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes = nullptr);

/// Which line elements an MSH file has. deal.II refuses all that lie inside the mesh.
enum class MshCurves {
  kAll,
  kNamed,     ///< those on the boundary of the mesh, and those inside it that have a name
  kBoundary,  ///< those on the boundary of the mesh
};

struct MshOptions {
  bool binary = false;
  MshCurves curves = MshCurves::kAll;
  /// The kind of hexahedra in .inp. C3D8, C3D8I, C3D8R; with nodes in the middles of the straight edges
  /// C3D20, C3D20R; for heat DC3D8, DC3D20. Empty: C3D8.
  std::string element = {};
};

/// Writes by extension: .msh, .vtu (with eta per quad), .obj, .inp, .mesh, .svg (a picture); whole or not at
/// all. Hexahedra go to .msh (4.1), .vtu, .inp, .e, .cgns, .med, .su2, .bdf or .unv. Throws InputError that
/// names the path, and for a format that has no such option.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});

/// The closed boundary of one patch, discretised, in the patch's parameter plane.
struct PatchBoundary {
  std::vector<Vec2> points;
  /// Indices into `points`; the patch lies on the left of each edge, and every point has one edge in, one
  /// out.
  std::vector<std::array<int, 2>> edges;
  /// Curve of each edge (index into Mesh::curves); -1: an edge that is no line.
  std::vector<int> edge_curve;
  /// Node of the boundary mesh that each point stands for. Two points may share a node (a seam).
  std::vector<int> point_node;
  /// Points inside from which insertion starts, besides the boundary; mostly none.
  std::vector<Vec2> seeds;
};

/// A triangulation of one patch in its parameter plane.
struct TriPatch {
  /// The boundary's points first, in their order, then the inserted ones.
  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise
  std::vector<std::array<int, 3>>
      neighbours;      ///< neighbours[t][k] lies across the side opposite to vertex k; -1: boundary
  int n_boundary = 0;  ///< how many of the points are the boundary's
};

/// A quadrilateral mesh of one patch in its parameter plane.
struct QuadPatch {
  std::vector<Vec2> points;                   ///< the boundary's points first, in their order
  std::vector<std::array<int, 4>> quads;      ///< counterclockwise
  std::vector<std::array<int, 3>> triangles;  ///< leftovers; empty when the boundary is even
  int n_boundary = 0;
};

}  // namespace delquad
