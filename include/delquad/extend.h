// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/matching.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "delquad/model.h"
#include "delquad/options.h"

// This header adds sizes, crosses, strategies of insertion, costs of matching and stages. Plugins use it
// before anything is read or meshed. See also add_options(), add_matching_solver() and add_metric().

namespace delquad {

/// Orthonormal frame whose axes are directions of a cross.
struct Frame {
  Vec2 e1{1, 0}, e2{0, 1};
  static Frame from_angle(double theta);  ///< radians
  /// Returns the frame at the angle of a cross, by halving angles with square roots. (0, 0) counts as angle
  /// 0.
  static Frame from_cross(Cross cross);
  Vec2 to_local(Vec2 v) const { return {dot(v, e1), dot(v, e2)}; }
  Vec2 to_global(Vec2 v) const { return v.x * e1 + v.y * e2; }
};

inline Frame Frame::from_cross(Cross cross) {
  if (cross.c == 0 && cross.s == 0) return {};
  // Returns a vector at half the angle of v, in (-pi, pi], without division or cancellation.
  const auto halve_angle = [](Vec2 v) {
    const double length = norm(v);
    if (v.x >= 0) return Vec2{v.x + length, v.y};
    return v.y >= 0 ? Vec2{v.y, length - v.x} : Vec2{-v.y, v.x - length};
  };
  const Vec2 direction = halve_angle(halve_angle({cross.c, cross.s}));
  const Vec2 e1 = (1 / norm(direction)) * direction;
  return {e1, perp(e1)};
}

/// A front edge: a side of an active triangle beside a resolved triangle or the boundary.
struct FrontEdge {
  Vec2 p, q;                          ///< the edge; the active triangle lies on its left
  Vec2 apex;                          ///< the active triangle's third vertex
  std::optional<Vec2> resolved_apex;  ///< the resolved triangle's third vertex; none on the boundary
  double delta;                       ///< delta' at the middle of the edge
  Frame frame;                        ///< the cross field's axes there
  int layer = 0;                      ///< counted from the boundary, which has layer 1; 0: not known
  const ParametricSize* size = nullptr;
  int size_hint = -1;  ///< the hint of the edge, see SizeField::at
  /// Returns delta' at another place; it is fastest near the edge.
  double delta_at(Vec2 u) const {
    int hint = size_hint;
    return size == nullptr ? delta : size->at(u, hint);
  }
};

/// A list of at most three points.
struct Candidates {
  std::array<Vec2, 3> points;
  int count = 0;
  /// Throws std::out_of_range for a fourth point.
  void add(Vec2 x) { points.at(static_cast<std::size_t>(count++)) = x; }
};

/// Strategy of insertion: it places new points and measures triangles. Several threads call it at once.
class PointPlacement {
 public:
  virtual ~PointPlacement() = default;
  /// Returns the name for messages.
  virtual std::string name() const = 0;
  /// Returns insertion.h_max if it is not set: larger triangles, by triangle_size(), get a point. Above 0.
  virtual double default_h_max() const = 0;
  /// Returns the size of a triangle over delta' at its centroid: 1 for the ideal triangle of the strategy.
  /// `cross` is the field at the centroid, not always of unit length.
  virtual double triangle_size(const std::array<Vec2, 3>& t, Cross cross, double delta) const = 0;
  /// Returns places for a new point over a front edge, best first. The mesher inserts the first one that
  /// fits.
  virtual Candidates candidates(const FrontEdge& edge) const = 0;
  /// Returns the length of v in the norm of the strategy, for the too-close test.
  virtual double length(Vec2 v, const Frame& frame) const = 0;
};

/// Makes the placement of stage F: frontal insertion in the L2 norm [rebay1993]; the ideal triangle is
/// equilateral.
std::unique_ptr<PointPlacement> make_l2_frontal();

/// Makes the placement of stage D: insertion in the L-infinity norm of the crosses [paper, section 5]; the
/// ideal triangle is half a square.
std::unique_ptr<PointPlacement> make_linf_delquad();

/// Content of a patch between two stages.
enum class PatchForm { kBoundary, kTriangles, kQuads };

struct PatchMesh {
  PatchForm form = PatchForm::kBoundary;
  TriPatch triangles;  ///< when form is kTriangles
  QuadPatch quads;     ///< when form is kQuads
  /// Places in space of the points inside, if known; else empty.
  std::vector<Vec3> inside;
};

struct StageInput {
  const PatchBoundary& boundary;
  const CrossField& cross;
  const ParametricSize& size;
  const Options& options;
  long long max_points;  ///< upper limit of the points that insertion makes
};

struct MeshingSetup;
struct SurfaceNodes;

/// All patches after the stages so far. Plugins ask input_of(), node_places() and place_inside() for the
/// rest.
struct AllPatches {
  const MeshingSetup& prepared;
  const Options& options;
  std::vector<PatchMesh>& patches;
  const std::vector<char>& left_out;  ///< by patch
  SurfaceNodes& nodes;                ///< nodes on curves; in a planar domain only their places
  bool began_from_given = false;      ///< the pipeline began from given quads
};

/// Returns the boundary and fields of a patch. Its points stand for the nodes boundary.point_node. Throws
/// std::out_of_range for an unknown patch.
StageInput input_of(const AllPatches& all, std::size_t patch);
/// Returns the places in space of all nodes on curves.
const std::vector<Vec3>& node_places(const AllPatches& all);
/// Computes missing places of the points inside, for patches of quads that are not left out. A stage that
/// moves points first clears PatchMesh::inside.
void place_inside(const AllPatches& all);

/// A stage of a pipeline: it takes a patch from one form to another.
struct Stage {
  char letter;
  std::string name;
  PatchForm from, to;
  /// Several threads call it for several patches at once. The points of the boundary stay first, in their
  /// order and places.
  std::function<void(const StageInput&, PatchMesh&, StageLog&)> run;
  /// Runs once after all patches, on all of them. It may be empty.
  std::function<void(const AllPatches&, StageLog&)> finish = {};
  bool leaves_triangles = false;  ///< its result may have triangles among quads, even if the boundary is even
  bool fills_cavities = false;    ///< it fills cavities of quads, and cuts of a face obstruct it
};

/// Returns all stages.
const std::deque<Stage>& stage_registry();
/// Adds a stage, before any pipeline is parsed. Throws std::invalid_argument if its letter is taken or no
/// capital from A to Z, or if `run` is empty.
void add_stage(Stage stage);
/// Returns a stage of frontal insertion [paper, section 5] with points by `make_placement`.
Stage insertion_stage(char letter, const std::string& name,
                      std::function<std::unique_ptr<PointPlacement>(const Options&)> make_placement);

/// Quad that two triangles of a patch would make, in the parameter plane.
struct MergedQuad {
  std::array<Vec2, 4> corners;  ///< counterclockwise; the merged side joins the second and the fourth
  Cross cross;                  ///< the field at their mean
  double delta;                 ///< delta' there
};

/// Writes the cost of each quad of a batch, from 0 (best) to 3, on the scale of 1 - eta. Matching minimizes
/// the sum. A leftover triangle costs 100, or 2.5 beside a boundary that strays from the cross. Several
/// threads call it at once.
using MergeCost = std::function<void(std::span<const MergedQuad> quads, std::span<double> cost)>;

/// Adds a value of `recombination.cost` beside "eta", which is 1 - eta, and up to 3 for angles above 180
/// degrees. Throws std::invalid_argument for a name that is taken or empty.
void add_merge_cost(const std::string& name, std::function<MergeCost(const Options&)> make);
/// Returns "eta" and the added names.
std::vector<std::string> merge_cost_names();

/// Adds a name for `size`, also in files: `fill` sets the field or the function of the spec. Throws
/// std::invalid_argument for a name that is taken, empty or does not begin with a letter.
void add_size(const std::string& name, std::function<void(const Options& options, SizeSpec& size)> fill);
/// Adds a name for `cross` likewise. `fill` also sets the kind: kMade with a maker (planes and surfaces), or
/// kField.
void add_cross(const std::string& name, std::function<void(const Options& options, CrossSpec& cross)> fill);

/// A pipeline of stages from left to right; each continues the result of the previous one.
struct Pipeline {
  std::string text;  ///< "DB"
  std::vector<const Stage*> stages;
  PatchForm result = PatchForm::kBoundary;
  /// Returns whether leftover triangles in its mesh are an error.
  bool quads_only() const;
};

/// Where pipelines begin: at the boundary, or at a given mesh.
enum class PipelineStart { kBoundary, kGivenMesh };
/// Returns the start of pipelines for a model.
PipelineStart pipeline_start(const Model& model);

/// Parses a pipeline. Throws InputError for an empty text, an unknown stage (with all known ones) and stages
/// that cannot follow each other. With `start` kGivenMesh it may begin with any stage.
Pipeline parse_pipeline(const std::string& text, PipelineStart start = PipelineStart::kBoundary);

}  // namespace delquad
