// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "delquad/error.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/options.h"

// This header has measures, soundness and reports of meshes. Tables, records and judges of meshes use it.

namespace delquad {

enum class Better { kHigher, kLower, kNeither };

struct Metric {
  std::string key;    ///< in records and options: "eta_mean"
  std::string title;  ///< in tables: "eta mean"
  std::string unit;   ///< "", "%", "deg", "s"
  Better better;
  double worst;        ///< value of the worst possible mesh; NaN if neither is better
  std::string source;  ///< paper section and equation, or another definition
  int digits = 3;      ///< after the decimal point, in tables
};

/// Returns all measures: built-in ones in the order of tables, then added ones.
const std::deque<Metric>& metric_registry();
/// Returns null for an unknown key.
const Metric* find_metric(const std::string& key);

/// Input of a measure.
struct MetricInput {
  const Mesh& mesh;
  const SizeField* size;          ///< size that the mesh follows; null: not known
  const SizeField* given;         ///< requested size; null: the same
  const Options& options;         ///< of the problem
  std::string problem = {};       ///< its name, or the name of the case in experiments; empty: not known
  std::string pipeline = {};      ///< pipeline; empty for meshes by other programs
  const Mesh* surface = nullptr;  ///< triangulation of a surface; null: not known
};

/// Adds a measure before anything is meshed: a column of tables and a value of records. It returns NaN if it
/// is not defined; its exception becomes the reason for a missing value. Throws std::invalid_argument for a
/// key that is taken or empty, and for an empty function.
void add_metric(Metric metric, std::function<double(const MetricInput&)> measure);

struct Histogram {
  double low = 0, high = 1;
  std::vector<long long> counts;
};

/// Pairs of irregular vertices in a mesh of quads: one with too few quads, one with too many. Such a pair
/// ends rows of quads. metrics/regularity.h defines pairs.
struct PairCounts {
  long long pairs = 0;
  long long unpaired = 0;  ///< irregular vertices; a vertex that lacks two quads counts twice
  std::map<std::array<int, 2>, long long> burgers;  ///< pairs by ending rows, in either direction
  std::map<int, long long> edges;                   ///< pairs by number of edges between them
};

struct MeshMetrics {
  /// Values by key; NaN if not defined (eta without quads, tau without a size).
  std::map<std::string, double> values;
  std::map<std::string, std::string> failures;  ///< reasons for missing values of added measures, by key
  Histogram eta;                                ///< [0, 1], 20 bins
  Histogram angle;                              ///< degrees, [0, 360], 36 bins
  std::map<int, long long> valences;            ///< interior vertices by number of incident elements
  /// Interior vertices without triangles, by number of incident quads; d4 is the share at 4.
  std::map<int, long long> quad_valences;
  std::optional<PairCounts> pairs;  ///< empty if the mesh has triangles
};

/// Measures a mesh in space of triangles, quads or both [paper, section 6]. Without `size` (null), tau and
/// similar measures are NaN. `given` is the requested size if `size` was derived from it; null: they are the
/// same. eta is over quads only, and percent quads tells their share. Added measures get `options`.
MeshMetrics evaluate_metrics(const Mesh& mesh, const SizeField* size, const SizeField* given = nullptr,
                             const Options& options = {});

/// A quad with a lower eta has an angle below 10 or above 170 degrees, and is bad.
inline constexpr double kBadEta = 1.0 / 9;

/// Returns eta of a quad in space [paper, equation (4)]: 1 for a square, 0 with an angle <= 0 or >= 180
/// degrees. The quad must run counterclockwise as seen from `normal`; a reflex or inverted corner gives 0.
double quad_eta(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& normal);
/// Returns eta of each quad.
std::vector<double> quad_etas(const Mesh& mesh);
/// Returns eta of a quad of the plane.
double quad_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// Proven bounds of the scaled Jacobians of curved quads; 1, 1 and 0 without curved quads.
struct ProvenJacobians {
  double least = 1, mean = 1;
  int unproven = 0;  ///< elements without a proof that they are positive
};
/// Proves bounds for a mesh with an order above 1 [johnen2013, extended to scaled Jacobians].
ProvenJacobians proven_jacobians(const Mesh& mesh);

/// A place on a model or a mesh.
struct Place {
  Vec3 at;
  int face = -1;  ///< index into Mesh::regions; -1: none
};

/// Places of one kind: their number and the first ones.
struct Places {
  static constexpr std::size_t kMostKept = 100;
  int count = 0;
  std::vector<Place> first;
  void add(const Place& place) {
    ++count;
    if (first.size() < kMostKept) first.push_back(place);
  }
};

/// Topology of the elements of a mesh, or of the triangles of a model.
struct Topology {
  int euler_characteristic = 0;  ///< vertices - edges + elements
  int free_edges = 0;            ///< edges of one element
  int branching_edges = 0;       ///< edges of more than two elements
  int disagreeing_edges = 0;     ///< edges of two elements in the same direction: their normals disagree
  bool watertight() const { return free_edges == 0; }
};

/// Size explains distances up to this many sizes. An edge of length h sags by h^2 / 8R <= h / 4 for a radius
/// of curvature R >= h / 2. A feature narrower than h is missed by about h. Some 90 meshes of CAD and scans,
/// with sizes of 1/10 to 1/60 of the diagonal, had at most 1.01.
inline constexpr double kExplainedSizes = 1.25;

/// Distances at samples, in diagonals of the model.
struct Distances {
  int samples = 0;
  double max = 0, mean = 0, mean_square = 0;
  double max_in_sizes = 0;  ///< in the size at the sample; 0 without a size
  Places unexplained;       ///< above kExplainedSizes
  void add(double distance);
  /// `size` is delta at the place, in the unit of the distance; infinite: not known.
  void add(double distance, double size, const Place& place);
};

/// A subset of quads, and its vertices that lie on no curve of the model.
struct QuadShare {
  int quads = 0, vertices = 0;
  double eta = 0;  ///< mean
  double d4 = 0;   ///< percentage of the vertices that have four quads
};

/// Report on a curve between faces.
struct CurveReport {
  double length = 0;
  bool closed = false;
  std::vector<int> faces;  ///< adjacent faces in ascending order; a face on both sides appears twice
};

/// A corner between two curves on the boundary of a face.
struct CornerReport {
  int face = -1;
  std::array<int, 2> curves{};  ///< the curves into and out of the corner, with the face on their left
  Vec3 at;
  double angle = 0;  ///< inside the face, degrees
};

struct FaceReport {
  double area = 0;
  int pieces = 0;  ///< number of pieces between lines
  int loops = 0;   ///< number of loops of the boundary
  int handles = 0;
  std::vector<int> curves;  ///< ascending
  /// Width of the narrowest piece. It is the least distance between boundary sides that face each other, or
  /// four areas by perimeter (diameter of a circle) if less. Curves that meet at less than 60 degrees count
  /// as a corner, not as a narrow place. Infinite without boundary.
  double width = 0;
};

/// Faces that are connected along curves.
struct ShellReport {
  std::vector<int> faces;  ///< ascending
  double area = 0;
  int euler_characteristic = 0;  ///< vertices - edges + triangles
  bool closed = false;           ///< every side has two triangles or more
};

/// Report on a model, measured on its fine triangulation. Indices refer to its curves and regions.
struct ModelReport {
  Vec3 low, high;
  double diagonal = 0, area = 0;
  double free_length = 0;  ///< total length of curves with only one face
  int vertices = 0;        ///< number of corners
  std::vector<CurveReport> curves;
  std::vector<FaceReport> faces;
  std::vector<ShellReport> shells;    ///< in the order of their first face
  std::vector<CornerReport> corners;  ///< by face, in the order of its loops
};

/// A model after reading.
struct ModelInfo {
  std::string source;
  Mesh fine;  ///< triangulation of the whole model
  std::vector<Warning> warnings;
  ModelReport report;
  std::vector<std::string> left_out;  ///< reasons for missing parts; empty unless problem.keep_going
};

/// Distance of a flat chart from conformal and isometric charts, weighted by area on the surface.
struct FlatQuality {
  double sigma_mean = 1, sigma_95 = 1, sigma_max = 1;  ///< ratio of singular values of triangles, >= 1
  double area_ratio = 1;                               ///< 99th over first percentile of the area scale
  double extreme_ratio = 1;  ///< ratio of the 99.9th to the 0.1th percentile, which includes small tips
};

/// Distance of the maps of all patches from conformal ones.
struct MapReport {
  struct Patch {
    int face;  ///< index into Mesh::regions, as below
    std::string method;
    FlatQuality quality;
  };
  std::vector<Patch> patches;
  double sigma_mean = 1;                               ///< mean over the area of all patches
  double sigma_95 = 1, sigma_max = 1, area_ratio = 1;  ///< of the worst patch
  int worst_face = -1;                                 ///< face of the patch with the worst sigma_95
};

/// A curve along which a face was cut to lay it flat.
struct SurfaceCut {
  int curve = -1;  ///< index into Mesh::curves
  int face = -1;
  double length = 0;
  bool divides = false;  ///< divides a patch; else opens it
};

/// A corner of a face between two curves.
struct SharpCorner {
  int face;          ///< index into Mesh::regions
  int node;          ///< node of the boundary mesh
  int curves[2];     ///< indices into Mesh::curves
  double angle;      ///< angle between the mesh edges, radians
  double eta_bound;  ///< upper limit of eta for quads in the corner
};

/// Comparison of a mesh with its surface.
struct SurfaceReport {
  Topology model, mesh;
  /// Edges whose number of elements is wrong: not two inside a face, or not the number of model faces at a
  /// curve.
  Places nonconforming_edges;
  /// Elements whose normal is opposite to all of their face nearby.
  Places turned_elements;
  Distances nodes_in_faces;    ///< to the face
  Distances nodes_on_curves;   ///< to the nearest of the curve and its faces
  Distances nodes_at_corners;  ///< as on curves
  Distances mesh_to_surface, surface_to_mesh;
  /// Quads within three rings of places where faces were divided or cut open, and all other quads.
  QuadShare near_cuts, off_cuts;
};

/// Whether a mesh represents its model and is fit for computation. A sound mesh has these properties:
/// - every coordinate is a finite number;
/// - no element is inverted, flat or turned away from its model. Scaled Jacobians are above 1e-4, also in
///   single precision if it can hold them (metrics/shape.h). No quad is folded by over 90 degrees along a
///   diagonal;
/// - it is conforming: every edge has as many elements as the model has faces there, two inside faces.
///   Adjacent elements have the same orientation;
/// - it is connected like its model: the Euler characteristic is equal, and it is watertight if the model is;
/// - mesh and model cover each other: size explains all distances, see kExplainedSizes.
/// Leftover triangles do not make a mesh unsound.
struct Soundness {
  /// One for each defect, with numbers, faces and the first places; empty: sound.
  std::vector<std::string> reasons;
  /// Known places of the defects, up to a hundred for each reason.
  std::vector<Place> places = {};
  /// One for each violated limit of elements (options "limits"). It also has the price of soundness for given
  /// quads, if that makes other quads poor.
  std::vector<std::string> beyond = {};
  bool sound() const { return reasons.empty(); }
  /// Returns whether the mesh is sound and within these limits.
  bool accepted() const { return sound() && beyond.empty(); }
  /// Returns all reasons in one line.
  std::string text() const;
  /// Returns all reasons and violated limits in one line.
  std::string complaint() const;
};

}  // namespace delquad
