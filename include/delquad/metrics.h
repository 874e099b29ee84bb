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

// How good a mesh is, and whether it is fit to be computed with.

namespace delquad {

enum class Better { kHigher, kLower, kNeither };

struct Metric {
  std::string key;    ///< in records and options: "eta_mean"
  std::string title;  ///< in tables: "eta mean"
  std::string unit;   ///< "", "%", "deg", "s"
  Better better;
  double worst;        ///< value of the worst possible mesh (NaN where neither is better)
  std::string source;  ///< paper section and equation, or where else it is defined
  int digits = 3;      ///< after the decimal point, in tables
};

/// Every measure: the project's own in the order of tables, then those that were added.
const std::deque<Metric>& metric_registry();
/// Null: there is none of that key.
const Metric* find_metric(const std::string& key);

/// What a measure goes by.
struct MetricInput {
  const Mesh& mesh;
  const SizeField* size;          ///< that was meshed by; null: not known
  const SizeField* given;         ///< as it was asked for; null: the same
  const Options& options;         ///< of the problem
  std::string problem = {};       ///< its name, in experiments that of the case; empty: not known
  std::string word = {};          ///< of stages; empty: of others' meshes
  const Mesh* surface = nullptr;  ///< the triangulation that stands behind a surface; null: none is known
};

/// Adds a measure from outside, before anything is meshed: a column of tables and a value of records like any
/// other. It returns NaN where it is not defined; what it throws is the reason why there is no value. Throws
/// std::invalid_argument for a key that is taken or empty, and for nothing to call.
void add_metric(Metric metric, std::function<double(const MetricInput&)> measure);

struct Histogram {
  double low = 0, high = 1;
  std::vector<long long> counts;
};

/// How irregular vertices of a mesh of quads pair, one of too few quads with one of too many: such a pair
/// ends rows of quads. metrics/regularity.h says which are a pair.
struct PairCounts {
  long long pairs = 0;
  long long unpaired = 0;                           ///< irregular vertices; one that lacks two quads twice
  std::map<std::array<int, 2>, long long> burgers;  ///< pairs by rows that end, in either direction
  std::map<int, long long> edges;                   ///< pairs by edges between the two
};

struct MeshMetrics {
  /// By key; NaN where a measure is not defined (eta of a mesh without quads; tau without a size field).
  std::map<std::string, double> values;
  std::map<std::string, std::string> failures;  ///< why a measure from outside has no value, by key
  Histogram eta;                                ///< [0, 1], 20 bins
  Histogram angle;                              ///< degrees, [0, 360], 36 bins
  std::map<int, long long> valences;            ///< interior vertices by number of incident elements
  /// Interior vertices that no triangle is at, by number of incident quads: d4 is the share at 4.
  std::map<int, long long> quad_valences;
  std::optional<PairCounts> pairs;  ///< none of meshes with triangles
};

/// Measures of a mesh in space [paper, section 6]. `size` may be null: then tau and what else is measured
/// against it are NaN. `given`: the size as it was asked for, where `size` is what was made of it; null: they
/// are the same.
/// Works on triangle meshes, quad meshes and mixtures; eta is over quads only, percent quads says what that
/// leaves out.
/// Measures from outside get `options`.
MeshMetrics evaluate_metrics(const Mesh& mesh, const SizeField* size, const SizeField* given = nullptr,
                             const Options& options = {});

/// A quad below this eta, with an angle below 10 or above 170 degrees, is bad.
inline constexpr double kBadEta = 1.0 / 9;

/// eta of one quad in space, equation (4): 1 for a square, 0 with an angle <= 0 or >= 180 degrees. `normal`
/// is the side from which the quad must run counterclockwise; a reflex or inverted corner gives 0.
double quad_eta(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& normal);
/// eta of each quad of the mesh.
std::vector<double> quad_etas(const Mesh& mesh);
/// eta of a quad of the plane.
double quad_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// What is proven of the scaled Jacobians of curved quads; 1, 1 and 0 of none.
struct ProvenJacobians {
  double least = 1, mean = 1;
  int unproven = 0;  ///< elements that are not proven to be positive
};
/// Of those of a mesh whose order is above 1.
ProvenJacobians proven_jacobians(const Mesh& mesh);

/// A place on a model or a mesh.
struct Place {
  Vec3 at;
  int face = -1;  ///< index into Mesh::regions; -1: of none
};

/// Places of one kind: how many there are, and the first few.
struct Places {
  static constexpr std::size_t kMostKept = 100;
  int count = 0;
  std::vector<Place> first;
  void add(const Place& place) {
    ++count;
    if (first.size() < kMostKept) first.push_back(place);
  }
};

/// How the elements of a mesh, or the triangles of a model, hang together.
struct Topology {
  int euler_characteristic = 0;  ///< vertices - edges + elements
  int free_edges = 0;            ///< in one element
  int branching_edges = 0;       ///< in more than two
  int disagreeing_edges = 0;     ///< in two that run along it the same way: their normals disagree
  bool watertight() const { return free_edges == 0; }
};

/// Distances up to this many sizes are explained by the size at the place: edges of length h sag by h^2 / 8R,
/// at most h / 4, on a radius of curvature R >= h / 2, and a feature that is narrower than h is missed by
/// about h. Of some 90 meshes of CAD and scans, at sizes from a tenth to a sixtieth of the diagonal, none was
/// further off than 1.01.
inline constexpr double kExplainedSizes = 1.25;

/// Distances at some samples, in diagonals of the model.
struct Distances {
  int samples = 0;
  double max = 0, mean = 0, mean_square = 0;
  double max_in_sizes = 0;  ///< of the size at the sample; 0 where no size was given
  Places unexplained;       ///< above kExplainedSizes
  void add(double distance);
  /// `size`: delta at the place, in the unit of the distance; infinite: not known.
  void add(double distance, double size, const Place& place);
};

/// Some quads of a mesh, and their vertices that lie on no curve of the model.
struct QuadShare {
  int quads = 0, vertices = 0;
  double eta = 0;  ///< mean
  double d4 = 0;   ///< percent of the vertices that have four quads
};

/// A curve as it lies between faces.
struct CurveReport {
  double length = 0;
  bool closed = false;
  std::vector<int> faces;  ///< that it bounds, ascending indices; one that lies on both sides stands twice
};

/// Where two curves of a face's boundary meet at a corner.
struct CornerReport {
  int face = -1;
  std::array<int, 2> curves{};  ///< that run into the corner and out of it, the face on their left
  Vec3 at;
  double angle = 0;  ///< inside the face, degrees
};

struct FaceReport {
  double area = 0;
  int pieces = 0;  ///< that lines divide it into
  int loops = 0;   ///< of its boundary
  int handles = 0;
  std::vector<int> curves;  ///< ascending
  /// How narrow the face is: the least distance between boundary sides that look at each other, or four times
  /// its area by its perimeter (a circle's diameter) where that is less, least of all pieces. Curves that
  /// meet at less than 60 degrees count as a corner, not as a narrow place. Infinite without boundary.
  double width = 0;
};

/// Faces that hang together along curves.
struct ShellReport {
  std::vector<int> faces;  ///< ascending
  double area = 0;
  int euler_characteristic = 0;  ///< vertices - edges + triangles
  bool closed = false;           ///< no side has less than two triangles
};

/// What a model consists of, measured on its fine triangulation. Indices are those of its curves and regions.
struct ModelReport {
  Vec3 low, high;
  double diagonal = 0, area = 0;
  double free_length = 0;  ///< of the curves that bound one face only, once
  int vertices = 0;        ///< corners
  std::vector<CurveReport> curves;
  std::vector<FaceReport> faces;
  std::vector<ShellReport> shells;    ///< by their first face
  std::vector<CornerReport> corners;  ///< by face, in the order of its loops
};

/// A model as it is read.
struct ModelInfo {
  std::string source;
  Mesh fine;  ///< a triangulation of all of it
  std::vector<Warning> warnings;
  ModelReport report;
  std::vector<std::string> left_out;  ///< why parts are missing; empty unless problem.keep_going
};

/// How far a flat chart is from a conformal one and from an isometry, weighted by area on the surface.
struct FlatQuality {
  double sigma_mean = 1, sigma_95 = 1, sigma_max = 1;  ///< ratio of singular values of triangles, >= 1
  double area_ratio = 1;                               ///< 99th over 1st percentile of the area scale
  double extreme_ratio = 1;  ///< the same of the 99.9th and .1th: small tips count, too
};

/// How far the maps of all patches of a surface are from conformal ones.
struct MapReport {
  struct Patch {
    int face;  ///< index into Mesh::regions, as below
    std::string method;
    FlatQuality quality;
  };
  std::vector<Patch> patches;
  double sigma_mean = 1;                               ///< by area over all patches
  double sigma_95 = 1, sigma_max = 1, area_ratio = 1;  ///< the worst patch's
  int worst_face = -1;                                 ///< that of the patch with the worst sigma_95
};

/// A curve along which a face of a surface was cut, so that it can be laid flat.
struct SurfaceCut {
  int curve = -1;  ///< index into Mesh::curves
  int face = -1;
  double length = 0;
  bool divides = false;  ///< made to divide a patch, else to open it
};

/// A corner of a face between two curves.
struct SharpCorner {
  int face;          ///< index into Mesh::regions
  int node;          ///< of the boundary mesh
  int curves[2];     ///< indices into Mesh::curves
  double angle;      ///< between the mesh's edges; radians
  double eta_bound;  ///< no quad in the corner has a larger eta
};

/// How a mesh fits the surface that it was made for.
struct SurfaceReport {
  Topology model, mesh;
  /// Edges that are not in as many elements as they should: two inside a face, and on a curve as many as the
  /// model has faces there.
  Places nonconforming_edges;
  /// Elements whose normal points to the other side than all of their face nearby.
  Places turned_elements;
  Distances nodes_in_faces;    ///< to the face
  Distances nodes_on_curves;   ///< to the nearest of the curve and the faces around
  Distances nodes_at_corners;  ///< the same
  Distances mesh_to_surface, surface_to_mesh;
  /// Within three rings of quads from where faces were divided or cut open, and all others.
  QuadShare near_cuts, off_cuts;
};

/// Whether a mesh is one of its model, and fit to be computed with. It is sound when
/// - every coordinate is a finite number;
/// - no element is inverted or flat: scaled Jacobians are above 1e-4, also with coordinates in single
///   precision, as far as that holds them (metrics/shape.h says why); no quad is folded (over 90 degrees
///   along a diagonal), and no element faces away from its model;
/// - it is conforming: every edge is in as many elements as the model has faces there, two inside of them,
///   and elements side by side run the same way round;
/// - it hangs together as its model does: the same Euler characteristic, watertight where the model is;
/// - none of the model is lost and nothing is added: no place of the one is further from the other than the
///   size there explains, see kExplainedSizes.
/// Triangles that are left among quads do not make a mesh unsound.
struct Soundness {
  /// One for each way in which it is not, with numbers, faces and the first places; empty: it is sound.
  std::vector<std::string> reasons;
  /// All that are known of these places, the first hundred for each reason.
  std::vector<Place> places = {};
  /// One for each limit of single elements that was asked for (options "limits") and is not kept, and the
  /// price at which given quads would be sound where that makes others poor, alike.
  std::vector<std::string> beyond = {};
  bool sound() const { return reasons.empty(); }
  /// Sound, and within these limits.
  bool accepted() const { return sound() && beyond.empty(); }
  /// All reasons in one line.
  std::string text() const;
  /// Why it is not accepted, in one line.
  std::string complaint() const;
};

}  // namespace delquad
