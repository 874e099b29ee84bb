// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// This header has points, meshes in space, and meshes of one patch in its parameter plane. All modules use
// it.

namespace delquad {

/// A point or vector of a plane, physical or parametric.
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
/// Returns the z component of a x b: positive if b lies counterclockwise of a.
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
  std::vector<std::string> names;  ///< physical groups that contain it; may be empty
};

/// Prefix of the names that CAD faces get from their colors.
inline constexpr std::string_view kColourName = "colour #";

/// A mesh point that stands for a point of the model.
struct NamedPoint {
  int point;  ///< index into Mesh::points
  Entity entity;
};

/// A turn about an axis, then a shift.
struct Motion {
  Vec3 shift = {};
  double angle = 0;  ///< radians, counterclockwise seen from the tip of the axis
  Vec3 centre = {};
  Vec3 axis = {0, 0, 1};  ///< need not have unit length
  Vec3 operator()(const Vec3& x) const;
  /// Returns a matrix of four rows for points (x, y, z, 1).
  std::array<double, 16> matrix() const;
  /// Returns the motion that undoes this one.
  Motion inverse() const;
};

/// Nodes of a curve that are images of the nodes of another curve.
struct PeriodicNodes {
  int curve, master;                      ///< indices into Mesh::curves
  Motion motion;                          ///< maps the master to `curve`
  std::vector<std::array<int, 2>> nodes;  ///< pairs: a node, and the node whose image it is
};

/// A face that is the image of another one: its elements are images of the master's, in the same order.
struct PeriodicFaces {
  int face, master;  ///< indices into Mesh::regions
  Motion motion;     ///< maps the master to `face`
  bool is_reversed;  ///< its elements have the opposite orientation, as on opposite faces of a body
  std::vector<std::array<int, 2>>
      nodes;  ///< pairs: a node, and the node whose image it is; nodes on curves first
};

/// The highest polynomial degree of elements.
inline constexpr int kMostOrder = 4;

/// The node in the middle of an edge of cells, where it is not the middle of a straight edge.
struct MiddleNode {
  std::array<int, 2> edge;  ///< indices into Mesh::points, ascending
  Vec3 at;
};

/// A mesh in space: line elements on curves, triangles and quads in regions. Planar meshes have z = 0, and
/// indices count from 0. A mesh of hexahedra (extrude()) has no triangles. Its quads are the boundary,
/// counterclockwise seen from outside, and named faces inside.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::array<int, 2>> lines;
  std::vector<int> line_curve;  ///< index into `curves` of each line
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> triangle_region;  ///< index into `regions` of each triangle
  std::vector<std::array<int, 4>> quads;
  std::vector<int> quad_region;
  /// Polynomial degree of the elements, 1 to 4; above 1 they are curved and have no triangles. `lines` and
  /// `quads` are the corners, and these are the further nodes, element by element. A line has order - 1, from
  /// its first end to its second. A quad has order - 1 for each side, in its orientation. Then (order - 1)^2
  /// inside follow, in rows along the first side. All lie at equal parameter distances.
  int order = 1;
  std::vector<int> line_nodes = {}, quad_nodes = {};
  std::vector<Entity> curves;
  std::vector<Entity> regions;
  std::vector<NamedPoint> named_points;
  std::vector<PeriodicNodes> periodic;
  std::vector<PeriodicFaces> periodic_faces;
  std::string unit;  ///< unit of lengths, such as "mm"; empty: not known
  /// Corners: four around one side, counterclockwise seen from the opposite side, then the four opposite
  /// ones.
  std::vector<std::array<int, 8>> hexahedra = {};
  std::vector<int> hex_volume = {};  ///< index into `volumes` of each hexahedron
  /// Corners of a triangle, counterclockwise seen from the opposite side, then the three opposite ones.
  std::vector<std::array<int, 6>> prisms = {};
  std::vector<int> prism_volume = {};
  /// Corners of the base, counterclockwise seen from the apex, then the apex.
  std::vector<std::array<int, 5>> pyramids = {};
  std::vector<int> pyramid_volume = {};
  /// Corners of a triangle, counterclockwise seen from the apex, then the apex.
  std::vector<std::array<int, 4>> tetrahedra = {};
  std::vector<int> tet_volume = {};
  /// For cells that are written with nodes in the middle of edges (C3D10); by edge, each once.
  std::vector<MiddleNode> middle_nodes = {};
  std::vector<Entity> volumes = {};
  /// Thickness of a shell, by triangle, then by quad; empty: none is known.
  std::vector<double> thickness = {};
};

/// Returns the diagonal of the bounding box; 0 without points.
double diagonal(const Mesh& mesh);

/// Returns the defects of the topology of a mesh, one line each; empty: it has none. Indices are in range,
/// elements have distinct vertices, and no element is repeated. An edge has at most two elements, in opposite
/// directions. Every vertex is used. Every line is an edge of an element, if there are any.
std::vector<std::string> check_invariants(const Mesh& mesh);

/// Returns the largest difference of node numbers in an element; 0 without elements.
int bandwidth(const Mesh& mesh);
/// Renumbers the nodes by the reversed order of Cuthill and McKee [1969], so that matrices have entries near
/// the diagonal. Everything else keeps its order. Nothing changes unless the bandwidth falls.
void reduce_bandwidth(Mesh& mesh);

/// Notes for users on changes by a reader, one sentence each.
using ReadNotes = std::vector<std::string>;

/// Reads a file whose extension names its format, such as `.msh` or `.vtu`; `delquad formats` lists all.
/// `notes` may be null. Throws InputError with file and line or byte. The message for another extension names
/// the known ones.
Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes = nullptr);

/// Line elements of an MSH file. deal.II refuses all lines inside the mesh.
enum class MshCurves {
  kAll,
  kNamed,     ///< lines on the boundary of the mesh, and named lines inside
  kBoundary,  ///< lines on the boundary of the mesh
};

struct MshOptions {
  bool binary = false;
  MshCurves curves = MshCurves::kAll;
  /// Kind of hexahedra in .inp: C3D8, C3D8I or C3D8R; with nodes in the middle of edges C3D20 or C3D20R; for
  /// heat DC3D8 or DC3D20. Empty: C3D8. S4 makes shells of quads in a plane.
  std::string element = {};
  /// Whether quads of order 1 are written as two triangles each. STL and ADCIRC have no quads.
  bool triangles = false;
  /// Whether .msh has format 2.2, as .msh2 always has; otherwise 4.1.
  bool is_msh22 = false;
};

/// Writes a mesh by extension: .msh, .vtu (with eta per quad), .obj, .inp, .mesh or .svg (a picture).
/// Hexahedra go to .msh (4.1), .vtu, .inp, .e, .cgns, .med, .su2, .bdf or .unv. The file is written
/// completely or not at all. Throws InputError, with the path, if it cannot be written, and for a format
/// without the given option or kind of elements.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});

/// The closed boundary of one patch, discretized, in its parameter plane.
struct PatchBoundary {
  std::vector<Vec2> points;
  /// Indices into `points`. The patch lies on the left of each edge, and every point has one edge in and one
  /// out.
  std::vector<std::array<int, 2>> edges;
  /// Curve of each edge, an index into Mesh::curves; -1: the edge is no line.
  std::vector<int> edge_curve;
  /// Node of the boundary mesh for each point. Two points may share a node (a seam).
  std::vector<int> point_node;
  /// Points inside at which insertion starts, besides the boundary; usually none.
  std::vector<Vec2> seeds;
};

/// A triangulation of one patch in its parameter plane.
struct TriPatch {
  /// The points of the boundary in their order, then the inserted ones.
  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise
  std::vector<std::array<int, 3>>
      neighbours;      ///< `neighbours[t][k]` lies across the side opposite to vertex k; -1: boundary
  int n_boundary = 0;  ///< number of points on the boundary
};

/// A quadrilateral mesh of one patch in its parameter plane.
struct QuadPatch {
  std::vector<Vec2> points;                   ///< points of the boundary first, in their order
  std::vector<std::array<int, 4>> quads;      ///< counterclockwise
  std::vector<std::array<int, 3>> triangles;  ///< leftovers; empty if the boundary is even
  int n_boundary = 0;
};

}  // namespace delquad
