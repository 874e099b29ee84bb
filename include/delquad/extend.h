#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delquad/fields.h"
#include "delquad/matching.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "delquad/model.h"
#include "delquad/options.h"

// What can be added from outside: fields, strategies of insertion, costs of matching and stages of any kind
// here; see add_options() for their keys, add_matching_solver() and add_metric() for the rest. All of it has
// to be added before anything is read or meshed.

namespace delquad {

/// An orthonormal frame; its axes are directions of a cross.
struct Frame {
  Vec2 e1{1, 0}, e2{0, 1};
  static Frame from_angle(double theta);
  /// The frame at the angle of a cross, found by halving angles with square roots; (0, 0) counts as angle 0.
  static Frame from_cross(Cross cross);
  Vec2 to_local(Vec2 v) const { return {dot(v, e1), dot(v, e2)}; }
  Vec2 to_global(Vec2 v) const { return v.x * e1 + v.y * e2; }
};

inline Frame Frame::from_cross(Cross cross) {
  if (cross.c == 0 && cross.s == 0) return {};
  // Some vector at half the angle of v, which is in (-pi, pi]; no division, no cancellation.
  const auto halve_angle = [](Vec2 v) {
    const double length = norm(v);
    if (v.x >= 0) return Vec2{v.x + length, v.y};
    return v.y >= 0 ? Vec2{v.y, length - v.x} : Vec2{-v.y, v.x - length};
  };
  const Vec2 direction = halve_angle(halve_angle({cross.c, cross.s}));
  const Vec2 e1 = (1 / norm(direction)) * direction;
  return {e1, perp(e1)};
}

/// A front edge: the side of an active triangle that borders a resolved triangle or the boundary.
struct FrontEdge {
  Vec2 p, q;                          ///< the edge; the active triangle lies on its left
  Vec2 apex;                          ///< the active triangle's third vertex
  std::optional<Vec2> resolved_apex;  ///< the resolved triangle's third vertex; none on the boundary
  double delta;                       ///< delta' at the middle of the edge
  Frame frame;                        ///< the cross field's axes there
  int layer = 0;                      ///< counted from the boundary, whose own is 1; 0: not known
  const ParametricSize* size = nullptr;
  int size_hint = -1;  ///< of the edge, see SizeField::at
  /// delta' at another place, best near the edge.
  double delta_at(Vec2 u) const {
    int hint = size_hint;
    return size == nullptr ? delta : size->at(u, hint);
  }
};

/// A list of at most three points.
struct Candidates {
  std::array<Vec2, 3> points;
  int count = 0;
  /// Throws std::out_of_range for a fourth one.
  void add(Vec2 x) { points.at(static_cast<std::size_t>(count++)) = x; }
};

/// Where the next point goes, in which norm triangles are measured: the strategy that the comparison
/// exchanges. Called in several threads at once.
class PointPlacement {
 public:
  virtual ~PointPlacement() = default;
  virtual std::string name() const = 0;
  virtual double default_h_max() const = 0;
  /// Size of a triangle over delta' at its centroid: 1 for the strategy's ideal triangle. `cross` is the
  /// field there, not necessarily of unit length.
  virtual double triangle_size(const std::array<Vec2, 3>& t, Cross cross, double delta) const = 0;
  /// Where a new point may go over a front edge, best first; the mesher inserts the first that it can.
  virtual Candidates candidates(const FrontEdge& edge) const = 0;
  /// Length of v in the strategy's norm, for the too-close test.
  virtual double length(Vec2 v, const Frame& frame) const = 0;
};

/// F: Rebay's frontal insertion in the L2 norm; ideal triangle equilateral.
std::unique_ptr<PointPlacement> make_l2_frontal();

/// D: Delquad insertion in the L-infinity norm of the cross field; ideal triangle half a square.
std::unique_ptr<PointPlacement> make_linf_delquad();

/// What a patch holds between two stages.
enum class PatchForm { kBoundary, kTriangles, kQuads };

struct PatchMesh {
  PatchForm form = PatchForm::kBoundary;
  TriPatch triangles;  ///< when form is kTriangles
  QuadPatch quads;     ///< when form is kQuads
  /// Places in space of the points inside, once they are known; else empty.
  std::vector<Vec3> inside;
};

struct StageInput {
  const PatchBoundary& boundary;
  const CrossField& cross;
  const ParametricSize& size;
  const Options& options;
  long long max_points;  ///< the most that insertion may make
};

struct PreparedProblem;
struct SurfaceNodes;

/// What a word has made of all patches so far. From outside: input_of(), node_places() and place_inside() say
/// the rest.
struct AllPatches {
  const PreparedProblem& prepared;
  const Options& options;
  std::vector<PatchMesh>& patches;
  const std::vector<char>& left_out;  ///< by patch
  SurfaceNodes& nodes;                ///< on curves; of a planar domain only their places
  bool began_from_given = false;      ///< quads
};

/// Boundary and fields of a patch; its points stand for the nodes boundary.point_node.
StageInput input_of(const AllPatches& all, std::size_t patch);
/// The places in space of all nodes on curves.
const std::vector<Vec3>& node_places(const AllPatches& all);
/// Patches of quads that are not left out get the places of their points inside, where they have none yet:
/// whoever moves points clears PatchMesh::inside first.
void place_inside(const AllPatches& all);

/// One letter of a pipeline word: takes a patch from one form to another.
struct Stage {
  char letter;
  std::string name;
  PatchForm from, to;
  /// Called for several patches at once, in several threads. The boundary's points stay the first ones, in
  /// their order and places.
  std::function<void(const StageInput&, PatchMesh&, StageLog&)> run;
  /// What it then does to all patches together. May be empty.
  std::function<void(const AllPatches&, StageLog&)> finish = {};
  bool leaves_triangles = false;  ///< among its quads, however even the boundary is
  bool fills_cavities = false;    ///< of quads: cuts of a face are in its way
};

/// Every stage.
const std::deque<Stage>& stage_registry();
/// Adds one from outside, before any word is parsed. Throws std::invalid_argument when its letter is taken or
/// no capital from A to Z, or nothing is to be run.
void add_stage(Stage stage);
/// Frontal insertion of points where `make_placement` says.
Stage insertion_stage(char letter, const std::string& name,
                      std::function<std::unique_ptr<PointPlacement>(const Options&)> make_placement);

/// A quad that two triangles of a patch would make, in the parameter plane.
struct MergedQuad {
  std::array<Vec2, 4> corners;  ///< counterclockwise; the side that goes is between the second and the fourth
  Cross cross;                  ///< the field's at their mean
  double delta;                 ///< delta' there
};

/// What each quad of a batch costs, 0 (best) to 3, on the scale of 1 - eta: the sum is made least. A triangle
/// too many costs 100; 2.5 beside a boundary that strays from the cross. Called in several threads at once.
using MergeCost = std::function<void(std::span<const MergedQuad> quads, std::span<double> cost)>;

/// Adds one from outside: what `recombination.cost` may be beside "eta", which is 1 - eta, and up to 3 where
/// an angle is above 180 degrees. Throws std::invalid_argument for a name that is taken or empty.
void add_merge_cost(const std::string& name, std::function<MergeCost(const Options&)> make);
std::vector<std::string> merge_cost_names();

/// Adds a name that `size` may be, in files, too: `fill` sets the field or the function of the spec. Throws
/// std::invalid_argument for a name that is taken, empty or begins with no letter.
void add_size(const std::string& name, std::function<void(const Options& options, SizeSpec& size)> fill);
/// The same of `cross`, for which `fill` sets the kind, too: kMade with a maker, on planes and surfaces, or
/// kField.
void add_cross(const std::string& name, std::function<void(const Options& options, CrossSpec& cross)> fill);

/// A pipeline: stages read from left to right, each starting from what the one before leaves.
struct Word {
  std::string text;  ///< "DB"
  std::vector<const Stage*> stages;
  PatchForm result = PatchForm::kBoundary;
  /// Triangles that are left in its mesh are an error.
  bool quads_only() const;
};

/// Where a word may begin.
enum class WordStart { kBoundary, kGivenMesh };
/// Where words of a model may begin.
WordStart word_start(const Model& model);

/// Throws InputError for an empty word, an unknown letter (naming it and those known) and for letters that do
/// not follow each other. `start`: with a given mesh a word may begin with any letter.
Word parse_word(const std::string& text, WordStart start = WordStart::kBoundary);

}  // namespace delquad
