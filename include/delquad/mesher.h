// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "delquad/error.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "delquad/model.h"
#include "delquad/options.h"

// This header is the main entry of the library: it turns a problem and a pipeline into a mesh and its report.
// Programs and the Python module use it.
//
//   mesh(problem, pipeline)  =  mesh(prepare(problem), pipeline)  =  Meshing, stage by stage, and its
//   finish()

namespace delquad {

/// Returns the version of the library: "0.1.0".
const char* version();

/// A trade of time against quality: "fast", "good", "best" or "regular", with its pipeline.
struct Quality {
  std::string name, pipeline;
  CrossKind cross;
  Options options = {};  ///< used unless the problem sets them
};
/// Throws InputError, with all known names, for an unknown name.
const Quality& quality_named(const std::string& name);
/// Returns null for an unknown name.
const Quality* find_quality(const std::string& name);
/// Returns all qualities, from "fast" to "regular".
const std::vector<Quality>& quality_registry();
inline constexpr const char* kDefaultQuality = "good";

/// A measure of elements that can have a limit.
struct Criterion {
  std::string key;     ///< "min_length"
  std::string fails;   ///< property of a failing element: "an edge shorter than"
  std::string unit;    ///< behind numbers: " degrees"; empty: none
  bool is_most;        ///< values above the limit fail; else values below it
  double least, most;  ///< range of limits
  bool of_length;      ///< limits may be given in parts of the wanted size
  std::string source;
};
/// Returns all criteria, in the order of tables.
const std::vector<Criterion>& criterion_registry();

/// A limit for every element.
struct CriterionLimit {
  std::string key;        ///< key of a Criterion
  double value = 0;       ///< in the unit of the criterion
  bool in_sizes = false;  ///< in parts of the wanted size at the element
  std::string on = {};    ///< name of regions or curves; the limit counts only for their elements
  std::string where = {};
  friend bool operator==(const CriterionLimit&, const CriterionLimit&) = default;
};

/// Material of elastic shells, in any consistent units. Poisson's ratio is from 0 to 0.5, the others above 0.
struct Material {
  double young = 0, poisson = 0, density = 0;
};

/// Limits by which an engineer judges a mesh. Stages keep limits without a name if they can.
struct Criteria {
  std::string name = {}, source = {};       ///< of a preset or a file
  std::vector<CriterionLimit> limits = {};  ///< a limit with a name replaces one without
  std::optional<Material> material = {};    ///< absent: times are lengths, at speed 1
  /// Program whose element length sets the time step: "ls-dyna", "radioss" or "abaqus".
  std::string time_step_by = "ls-dyna";
  bool strict = false;  ///< failing elements count in Soundness::beyond
  std::string where = {};
  bool empty() const { return limits.empty(); }
  /// Sets `value`, a number or "0.33 size", in place of the limit of this key and name. Throws InputError for
  /// unknown keys and impossible values.
  Criteria& set(const std::string& key, const std::string& value, const std::string& on = {},
                const std::string& set_where = "criteria");
};
/// Returns "batch", "crash" and "static" with their sources.
const std::vector<Criteria>& criteria_presets();
/// Returns a preset by name, or reads a file (docs/criteria.md). Throws InputError with file and line.
Criteria read_criteria(const std::string& preset_or_file);
/// Throws InputError for limits that contradict each other, for times without a material, and for a material
/// out of range.
void check_criteria(const Criteria& criteria);

/// Result of a mesh for a limit.
struct CriterionResult {
  CriterionLimit limit;
  double worst = 0;        ///< worst value of all elements, in parts of the size if the limit is
  Place at = {};           ///< place of the worst value
  std::string cause = {};  ///< why the worst element fails; empty: it does not
  std::string text = {};   ///< "3 elements have ..." with places, as Soundness::beyond; empty: none fails
  std::vector<int> failing = {};  ///< elements: triangles, then quads
};
/// A change of a problem that may cure failing elements.
struct Cure {
  std::string cause, key;  ///< as in CriteriaReport::causes; "surface.ignore_below" or "size"
  double value = 0;        ///< of the key; of a size, its value at the worst place
  long long count = 0;     ///< elements that it may cure
};
struct CriteriaReport {
  std::string name;
  long long elements = 0, failing = 0;
  std::vector<CriterionResult> results;     ///< by limit
  std::map<std::string, long long> causes;  ///< failing quads by cause
  std::vector<std::string> why;             ///< the same for people, with places
  std::vector<Cure> cures;                  ///< by cause, where one is known
  /// Largest stable time step of central differences for membrane waves, with bilinear elements and lumped
  /// mass; 0 if an element is inverted.
  double critical_step = 0;
  std::map<std::string, double> estimated_step;  ///< least of all elements, by the length of each program
  double step_of_squares = 0;                    ///< critical step of squares of the least wanted size
  std::vector<std::string> beyond() const;       ///< as Soundness::beyond
};
/// Judges any mesh, with its own curves as the curves of the model. `size` is the wanted size; null: the mean
/// edge. Throws InputError for a mesh whose indices or coordinates cannot be used, and for criteria that do
/// not fit it.
CriteriaReport judge(const Mesh& mesh, const Criteria& criteria, const SizeField* size = nullptr);

/// A model and all options of its mesh. It is a plain value: it can be copied and meshed again.
struct MeshProblem {
  std::string name = "model";   ///< in messages
  std::string where = "model";  ///< file and line of the model, for messages
  Model model;
  SurfaceSpec surface = {};            ///< for a TriangleModel, CadModel or ExampleModel
  std::vector<LayerSpec> layers = {};  ///< for a PlanarModel or LineModel
  SizeSpec size = {};
  MetricSpec metric = {};  ///< in place of a size; for planar models of curves, and for surfaces
  CrossSpec cross = {};
  std::vector<CurveDivision> divisions = {};  ///< sizes beside these curves follow their edges
  std::vector<PeriodicPair> periodic = {};
  SymmetrySpec symmetry = {};                ///< for planar models of curves, and for surfaces
  std::vector<WasherSpec> washers = {};      ///< for planar models of curves, and for surfaces
  std::vector<FilletRows> fillet_rows = {};  ///< for CAD models
  MappedSpec mapped = {};                    ///< for planar models of curves, and for surfaces
  long long seed = 0;      ///< 0: no change; above 0 the domain is turned, and nodes are shifted along curves
  Options options = {};    ///< of the stages
  Criteria criteria = {};  ///< criteria that judge the mesh; empty: none
  double refine = 1;       ///< divides all sizes, above 0; numbers of edges and of layers grow with it
  std::optional<long long> quads = {};  ///< wanted number, at least 1, by a factor for all sizes
  int order = 1;                        ///< from 1 to 4; above 1 elements are curved, see Mesh::order
  long long max_elements = 50'000'000;  ///< refuse sizes with a larger integral of dA/delta^2
  bool keep_going = false;     ///< leave out faces that cannot be meshed, instead of refusing the model
  bool allow_unsound = false;  ///< return meshes that are not accepted, instead of throwing UnsoundError
};

/// Current step, for people who wait.
struct ProgressReport {
  std::string stage;  ///< "Lp-CVT smoothing"
  double part = 0;    ///< finished part of all steps, 0 to 1
};

/// Reads a model file (.toml, docs/models.md), or a file of lines, triangles or CAD, and all files that it
/// names. Throws InputError with file and line.
MeshProblem read_model_file(const std::filesystem::path& file);

/// Reads and measures the model of a problem. A planar model is measured between points on its curves, at
/// most 1/2000 of its diagonal apart; lines are measured unchanged. A `size` above 0 warns if it is larger
/// than the model. Throws InputError, with file and line or entity, for models that cannot be read.
ModelInfo model_info(MeshProblem problem, double size = 0);

/// Settings of a run that never change its result. A requested stop makes mesh() throw Cancelled within a
/// fraction of a second.
struct Context {
  int threads = 0;  ///< 0: number of cores
  std::stop_token cancel = {};
  double time_limit = 0;  ///< seconds until mesh() throws TimeIsUp; 0: none
  /// Only the thread that calls mesh() calls it, at the start of each step. Its exceptions end mesh() and
  /// pass through.
  std::function<void(const ProgressReport&)> progress = {};
};

/// A face that is left out because it cannot be meshed.
struct FaceFailure {
  int face;            ///< index into Mesh::regions
  std::string reason;  ///< names the face
};

/// The size that the stages follow.
struct PreparedSize {
  std::shared_ptr<const SizeField> field;
  std::shared_ptr<const SizeField> asked;   ///< requested size, if `field` is less; else null
  std::shared_ptr<const SizeField> curved;  ///< the same with the requested curvature; null: as `asked`
  std::vector<std::string> adapted_to;      ///< reasons for smaller sizes: "short curves", ...
  double expected_quads = 0;                ///< integral of dA/delta^2
};

/// Known properties of the cross field.
struct PreparedCrosses {
  std::vector<PlacedSingularity> singularities;  ///< of a boundary-aligned or size-aware field
  /// Sum of the indices of this field, and the sum by the Euler characteristic of the domain, in quarters of
  /// a turn.
  std::optional<std::pair<int, int>> index_sum_and_expected;
  /// Expected rows of quads that end, for the boundary-aligned field and for the size-aware one in its place.
  std::optional<std::pair<double, double>> dislocations;
};

/// Report on a problem after its curves are meshed and its fields are made.
struct Preparation {
  Mesh boundary;  ///< nodes on curves, lines, curves and regions; its elements are the layers
  PreparedSize size;
  PreparedCrosses crosses;
  std::vector<SymmetryPlane> symmetry;  ///< given or found planes
  std::vector<FaceFailure> failures;    ///< by face; empty unless problem.keep_going
  std::vector<Warning> warnings;
  StepTimes times;  ///< "read", "maps", "curves", "fields", in order of first use
};

struct MeshingSetup;
struct Stage;
struct MeshResult;

/// A problem that is ready for the stages. Copies share their content.
class Prepared {
 public:
  /// Makes an empty value.
  Prepared() = default;
  /// For the library itself.
  Prepared(std::shared_ptr<const MeshProblem> problem, std::shared_ptr<const MeshingSetup> made)
      : problem_(std::move(problem)), made_(std::move(made)) {}

  const Preparation* operator->() const;
  const Preparation& operator*() const { return *operator->(); }
  const MeshProblem& problem() const { return *problem_; }  ///< with the content of all files
  bool is_surface() const;

  std::size_t n_patches() const;
  const PatchBoundary& patch(std::size_t i) const;  ///< in its parameter plane; throws std::out_of_range
  /// Returns the triangulation of a surface. It does not exist for planar domains, like the next two.
  const Mesh& fine() const;
  const std::vector<SurfaceCut>& cuts() const;
  std::vector<SharpCorner> sharp_corners()
      const;  ///< corners of any model that allow no quad an eta of kBadEta
  MapReport maps() const;
  /// Returns the triangles that carry the fields of a planar domain; null on surfaces.
  const TriPatch* background() const;
  /// Returns the expected number of rows of quads that must end along the fields of all patches to keep the
  /// sizes. It takes about as long as stage D unless the fields are size-aware. Own method, see
  /// docs/algorithms.md.
  double row_ends() const;

  /// Measures a mesh of this problem, made by this pipeline, which only added measures may use.
  MeshMetrics metrics(const Mesh& made, const std::string& pipeline = {}) const;
  /// Measures a mesh of the same model by other programs: measures, bad quads, criteria and soundness of
  /// elements.
  MeshResult measure(Mesh of_others) const;

  const MeshingSetup& inside() const { return *made_; }  ///< for the library itself

 private:
  std::shared_ptr<const MeshProblem> problem_;
  std::shared_ptr<const MeshingSetup> made_;
};

/// The wanted edges at the points of a mesh.
struct WantedAt {
  std::vector<double> size;  ///< edge length; for a metric the root of the product of both lengths
  /// Vectors along the cross, or the axes of the metric, of the wanted length. 0 without a field.
  std::vector<std::array<Vec3, 2>> edges;
};
/// Returns the wanted edges at the points of a mesh of the problem.
WantedAt wanted_at(const Prepared& prepared, const Mesh& mesh);

/// A metric given by its values.
struct NodalMetric {
  Mesh mesh;
  std::vector<Tensor2> at;  ///< metric at each point
};

/// Returns the metric that meshes of a planar domain follow, at points of triangles with lines along all
/// curves. Empty without a metric.
std::optional<NodalMetric> followed_metric(const Prepared& prepared);

/// A mesh and its report.
struct MeshResult {
  Mesh mesh;
  MeshMetrics metrics;
  Soundness soundness;
  /// Log of all steps with their times, preparation included, added up over patches.
  StageLog log;
  std::vector<Warning> warnings;  ///< warnings of the preparation, then warnings on the mesh
  /// Quads with an eta below kBadEta: in corners of the model that forbid more, and elsewhere.
  int bad_in_corners = 0, bad_elsewhere = 0;
  std::vector<FaceFailure> failures;       ///< by face; empty unless problem.keep_going
  std::optional<CriteriaReport> criteria;  ///< if the problem has criteria
  std::optional<SurfaceReport> surface;    ///< for surfaces
  double seconds = 0;                      ///< time of the stages of the pipeline
  long long lifting_cost = 0;              ///< in units of the library's budget
  long long peak_memory = 0;               ///< bytes; largest memory of the process so far
  Prepared prepared;                       ///< with smaller sizes where the mesh would not have been sound

  std::vector<Warning> warnings_on_mesh() const {
    return {warnings.begin() + static_cast<std::ptrdiff_t>(prepared->warnings.size()), warnings.end()};
  }
};

/// A mesh is unsound, or beyond the limits of elements (see Soundness). The message has the reasons.
class UnsoundError : public Error {
 public:
  explicit UnsoundError(const std::string& message, std::shared_ptr<const MeshResult> made = nullptr)
      : Error(message), result(std::move(made)) {}
  std::shared_ptr<const MeshResult> result;  ///< with the mesh; null if mesh() did not make it
};

/// Makes the boundary and fields of a problem, from which all pipelines start. Throws InputError, with file,
/// entity or place, for models, sizes and options that it cannot use. Throws Cancelled and TimeIsUp, with the
/// step.
Prepared prepare(MeshProblem problem, const Context& context = {});

/// A run of a pipeline. Copies of the process may continue from here, so that pipelines share their first
/// stages.
class Meshing {
 public:
  explicit Meshing(Prepared prepared);
  Meshing(Meshing&&) noexcept;
  Meshing& operator=(Meshing&&) noexcept;
  ~Meshing();

  /// Takes every patch through one more stage, which must continue the form of the last one. Throws
  /// InputError if the mesher had to stop.
  void run(const Stage& stage);
  /// Returns the mesh after the stages so far.
  Mesh mesh() const;
  /// Joins the patches; repairs, measures and judges the mesh. An unsound mesh is meshed again with smaller
  /// sizes there; it never throws for one. Call it once, last.
  MeshResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Meshes by a pipeline such as "DB" or "DBCO" (see stage_registry()). Pipelines of a GivenMesh may begin
/// from its elements, such as "CO". Throws as prepare() and parse_pipeline(), and UnsoundError, with the
/// mesh, unless the problem allows it.
MeshResult mesh(const Prepared& prepared, const std::string& pipeline, const Context& context = {});

/// Prepares and meshes by a pipeline, or by the name of a quality. A quality has a pipeline, and
/// directions unless the problem sets them; it improves a GivenMesh by CO or, without quads, BCO. Problem and
/// `pipeline` fix every bit of the mesh, for any context. Throws as above. Several threads may call it at
/// once.
MeshResult mesh(MeshProblem problem, const std::string& pipeline = kDefaultQuality,
                const Context& context = {});

/// Throws UnsoundError if the mesh is not accepted. The message begins with `label`.
void require_sound(const std::string& label, const MeshResult& result);

}  // namespace delquad
