#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
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

// The door: a problem and a word go in, a mesh and all that is known of it come out.
//
//   mesh(problem, word)  =  mesh(prepare(problem), word)  =  Meshing, stage by stage, and its finish()

namespace delquad {

/// Of this library: "0.1.0".
const char* version();

/// A trade of time against quality: "fast", "good", "best" or "regular".
struct Quality {
  std::string name, word;
  CrossKind cross;
  Options options = {};  ///< where the problem does not set them
};
/// Throws InputError, naming those known.
const Quality& quality_named(const std::string& name);
/// Null: there is none of that name.
const Quality* find_quality(const std::string& name);
/// From fast to best; docs/experiments.md has what each is worth.
const std::vector<Quality>& quality_registry();
inline constexpr const char* kDefaultQuality = "good";

/// Something that elements are measured by, with a limit.
struct Criterion {
  std::string key;     ///< "min_length"
  std::string fails;   ///< what an element has that fails: "an edge shorter than"
  std::string unit;    ///< behind numbers: " degrees"; empty: none
  bool is_most;        ///< values above the limit fail, else those below
  double least, most;  ///< what limits may be
  bool of_length;      ///< may be told in parts of the wanted size
  std::string source;
};
/// All of them, in the order of tables.
const std::vector<Criterion>& criterion_registry();

/// What no element should be beyond.
struct CriterionLimit {
  std::string key;        ///< of a Criterion
  double value = 0;       ///< in its unit
  bool in_sizes = false;  ///< in parts of the wanted size at the element
  std::string on = {};    ///< a name: of elements of the regions, and along the curves, that have it alone
  std::string where = {};
  friend bool operator==(const CriterionLimit&, const CriterionLimit&) = default;
};

/// Of elastic shells, in any units that go together.
struct Material {
  double young = 0, poisson = 0, density = 0;
};

/// By what an engineer judges a mesh. Elements are as they are however it is judged.
struct Criteria {
  std::string name = {}, source = {};       ///< of a preset, or a file
  std::vector<CriterionLimit> limits = {};  ///< one with a name counts in place of one without
  std::optional<Material> material = {};    ///< none: times are lengths, at speed 1
  /// Whose length of an element its time step goes by: "ls-dyna", "radioss" or "abaqus".
  std::string time_step_by = "ls-dyna";
  bool strict = false;  ///< elements that fail are in Soundness::beyond
  std::string where = {};
  bool empty() const { return limits.empty(); }
  /// `value`: a number, or "0.33 size". In place of a limit of that key and name. Throws InputError for
  /// unknown keys and values that cannot be.
  Criteria& set(const std::string& key, const std::string& value, const std::string& on = {},
                const std::string& set_where = "criteria");
};
/// "batch", "crash" and "static", with what they come from.
const std::vector<Criteria>& criteria_presets();
/// A preset by its name, or a file, see docs/meshing.md. Throws InputError with file and line.
Criteria read_criteria(const std::string& preset_or_file);
/// Throws InputError for limits that contradict each other, and times without a material.
void check_criteria(const Criteria& criteria);

/// How a mesh does by a limit.
struct CriterionResult {
  CriterionLimit limit;
  double worst = 0;        ///< value of all elements, in parts of the size where the limit is
  Place at = {};           ///< of that
  std::string cause = {};  ///< why that fails; empty: it does not
  std::string text = {};   ///< "3 elements have ..." with places, as Soundness::beyond; empty: none has
  std::vector<int> failing = {};  ///< elements: triangles, then quads
};
struct CriteriaReport {
  std::string name;
  long long elements = 0, failing = 0;
  std::vector<CriterionResult> results;     ///< by limit
  std::map<std::string, long long> causes;  ///< failing quads by why they do
  std::vector<std::string> why;             ///< the same for people, with places and what helps
  /// The largest stable time step of central differences: of the mesh's membrane waves, with bilinear
  /// elements and lumped mass; 0 where an element is inverted.
  double critical_step = 0;
  std::map<std::string, double> estimated_step;  ///< least of all elements by the length of a program
  double step_of_squares = 0;                    ///< critical, of squares of the least wanted size
  std::vector<std::string> beyond() const;       ///< as Soundness::beyond
};
/// Of any mesh: its curves are those of its model. `size`: that is wanted; null: the mean edge.
CriteriaReport judge(const Mesh& mesh, const Criteria& criteria, const SizeField* size = nullptr);

/// What is to be meshed, and how. A plain value: it can be copied, and meshed again.
struct MeshProblem {
  std::string name = "model";   ///< in messages
  std::string where = "model";  ///< where it was written, for messages: a file and line
  Model model;
  SurfaceSpec surface = {};            ///< of a TriangleModel, CadModel or ExampleModel
  std::vector<LayerSpec> layers = {};  ///< of a PlanarModel or LineModel
  SizeSpec size = {};
  MetricSpec metric = {};  ///< in place of a size, of planar models of curves
  CrossSpec cross = {};
  std::vector<CurveDivision> divisions = {};  ///< sizes beside these curves follow their edges
  std::vector<PeriodicPair> periodic = {};
  SymmetrySpec symmetry = {};                ///< of planar models of curves, and of surfaces
  std::vector<WasherSpec> washers = {};      ///< of planar models of curves, and of surfaces
  std::vector<FilletRows> fillet_rows = {};  ///< of CAD models
  MappedSpec mapped = {};                    ///< of planar models of curves, and of surfaces
  long long seed = 0;      ///< 0: as it is; else the domain is turned, and nodes are shifted along curves
  Options options = {};    ///< of the stages
  Criteria criteria = {};  ///< that the mesh is judged by; none: not
  double refine = 1;       ///< all sizes are divided by it; numbers of edges and of layers grow with it
  std::optional<long long> quads = {};  ///< about so many, by sizes that are all larger or smaller
  int order = 1;                        ///< of the elements, 1 to 4: above 1 they are curved, see Mesh::order
  long long max_elements = 50'000'000;  ///< refuse sizes whose integral of dA/delta^2 is larger
  bool keep_going = false;     ///< leave faces out that cannot be meshed, instead of refusing the model
  bool allow_unsound = false;  ///< return meshes that are not accepted, instead of throwing UnsoundError
};

/// What is being done, for people who wait.
struct ProgressReport {
  std::string stage;  ///< "Lp-CVT smoothing"
  double part = 0;    ///< steps that are done, of all steps; 0 to 1
};

/// What a model file (.toml, see docs/experiments.md) asks for, or a file of lines, triangles or CAD; all
/// files that it names are read. Throws InputError with file and line.
MeshProblem read_model_file(const std::filesystem::path& file);

/// Reads and measures the model of a problem. A planar model is measured between points on its curves, at
/// most a 2000th of its diagonal apart; a mesh of lines as it is. `size`: above 0, a warning tells where that
/// is larger than the model. Throws InputError for models that cannot be read.
ModelInfo model_info(MeshProblem problem, double size = 0);

/// How a mesh is made, as opposed to what: nothing of it changes the result.
struct Context {
  int threads = 0;  ///< 0: as many as there are cores
  std::stop_token cancel =
      {};                 ///< once a stop is requested, mesh() throws Cancelled within a fraction of a second
  double time_limit = 0;  ///< seconds, after which mesh() throws TimeIsUp; 0: none
  /// Called from the thread that calls mesh() and from no other, at the beginning of each step. What it
  /// throws ends mesh() and passes through.
  std::function<void(const ProgressReport&)> progress = {};
};

/// A face that was left out because it cannot be meshed.
struct FaceFailure {
  int face;            ///< index into Mesh::regions
  std::string reason;  ///< names the face
};

/// The size that is meshed by.
struct PreparedSize {
  std::shared_ptr<const SizeField> field;
  std::shared_ptr<const SizeField> asked;  ///< as it was asked for, where `field` is less; else null
  std::vector<std::string> adapted_to;     ///< what made it less: "short curves", ...
  double expected_quads = 0;               ///< integral of dA/delta^2
};

/// What is known of the cross field.
struct PreparedCrosses {
  std::vector<PlacedSingularity> singularities;  ///< of a boundary-aligned or size-aware field
  /// Sum of the indices of such a field, and what the domain's Euler characteristic makes of
  /// it, in quarters.
  std::optional<std::pair<int, int>> index_sum_and_expected;
  /// Rows of quads that have to end, expected of the boundary-aligned field and of the size-aware one instead
  /// of it.
  std::optional<std::pair<double, double>> dislocations;
};

/// What is known of a problem once its curves are meshed and its fields are made.
struct Preparation {
  Mesh boundary;  ///< nodes on curves, lines, curves and regions; of elements the layers
  PreparedSize size;
  PreparedCrosses crosses;
  std::vector<SymmetryPlane> symmetry;  ///< planes that were given or found
  std::vector<FaceFailure> failures;    ///< by face; empty unless problem.keep_going
  std::vector<Warning> warnings;
  StepTimes times;  ///< "read", "maps", "curves", "fields", in order of first use
};

struct PreparedProblem;
struct Stage;
struct MeshResult;

/// A problem that is ready for the stages. A value: copies share what was made.
class Prepared {
 public:
  /// Of nothing yet.
  Prepared() = default;
  /// For the library itself.
  Prepared(std::shared_ptr<const MeshProblem> problem, std::shared_ptr<const PreparedProblem> made)
      : problem_(std::move(problem)), made_(std::move(made)) {}

  const Preparation* operator->() const;
  const Preparation& operator*() const { return *operator->(); }
  const MeshProblem& problem() const { return *problem_; }  ///< with all files read
  bool is_surface() const;

  std::size_t n_patches() const;
  const PatchBoundary& patch(std::size_t i) const;  ///< in its parameter plane
  /// The triangulation that stands behind a surface. Not of planar domains, as the next two.
  const Mesh& fine() const;
  const std::vector<SurfaceCut>& cuts() const;
  std::vector<SharpCorner> sharp_corners()
      const;  ///< those that forbid a quad an eta of kBadEta; of all models
  MapReport maps() const;
  /// The triangles that carry the fields of a planar domain; null on surfaces.
  const TriPatch* background() const;
  /// Rows of quads that have to end along the fields of all patches so that sizes are as wanted, in the mean.
  /// Takes about as long as D unless the fields are size-aware.
  double row_ends() const;

  /// Measures of a mesh that was made of it, by `word`: only measures from outside may look at that.
  MeshMetrics metrics(const Mesh& made, const std::string& word = {}) const;
  /// A mesh of the same model by others: its measures, bad quads, and whether its elements are sound.
  MeshResult measure(Mesh of_others) const;

  const PreparedProblem& inside() const { return *made_; }  ///< for the library itself

 private:
  std::shared_ptr<const MeshProblem> problem_;
  std::shared_ptr<const PreparedProblem> made_;
};

/// The edges that a problem asks for at the points of a mesh of it.
struct WantedAt {
  std::vector<double> size;  ///< the edge length; of a metric the root of both lengths' product
  /// Along the cross, or the axes of the metric: as long as edges are wanted there. 0 where no field is.
  std::vector<std::array<Vec3, 2>> edges;
};
WantedAt wanted_at(const Prepared& prepared, const Mesh& mesh);

/// A metric by its values.
struct NodalMetric {
  Mesh mesh;
  std::vector<Tensor2> at;  ///< its points
};

/// The metric of a planar domain as its meshes follow it, at the points of triangles with lines along all
/// curves; nothing where there is none.
std::optional<NodalMetric> followed_metric(const Prepared& prepared);

/// A mesh, and what is known of it.
struct MeshResult {
  Mesh mesh;
  MeshMetrics metrics;
  Soundness soundness;
  /// The log of all steps with their times, preparation included, added up over patches.
  StageLog log;
  std::vector<Warning> warnings;  ///< those of the preparation, then those on the mesh
  /// Quads with an eta below kBadEta: in corners of the model that forbid more, and others.
  int bad_in_corners = 0, bad_elsewhere = 0;
  std::vector<FaceFailure> failures;       ///< by face; empty unless problem.keep_going
  std::optional<CriteriaReport> criteria;  ///< where the problem has some
  std::optional<SurfaceReport> surface;    ///< of surfaces
  double seconds = 0;                      ///< of the stages of the word, on the clock
  long long lifting_cost = 0;              ///< of the library's own budget
  long long peak_memory = 0;               ///< bytes, the most that the process has held so far
  Prepared prepared;  ///< what it was made of: with smaller sizes where it would not have been sound

  std::vector<Warning> warnings_on_mesh() const {
    return {warnings.begin() + static_cast<std::ptrdiff_t>(prepared->warnings.size()), warnings.end()};
  }
};

/// A mesh is not sound, or beyond the limits of its elements: see Soundness. The message has the reasons.
class UnsoundError : public Error {
 public:
  explicit UnsoundError(const std::string& message, std::shared_ptr<const MeshResult> made = nullptr)
      : Error(message), result(std::move(made)) {}
  std::shared_ptr<const MeshResult> result;  ///< with the mesh; null where it was not made by mesh()
};

/// Boundary and fields of a problem: what every word starts from. Throws InputError for models, sizes and
/// options that cannot be used, naming file, entity or place; Cancelled and TimeIsUp, which say at what it
/// was.
Prepared prepare(MeshProblem problem, const Context& context = {});

/// A word on its way. What several words begin with is made once where copies of the process go on from
/// there.
class Meshing {
 public:
  explicit Meshing(Prepared prepared);
  Meshing(Meshing&&) noexcept;
  Meshing& operator=(Meshing&&) noexcept;
  ~Meshing();

  /// Takes every patch through one more stage. Throws InputError when the mesher had to stop.
  void run(const Stage& stage);
  /// The mesh as the stages have left it.
  Mesh mesh() const;
  /// Puts the patches together, mends, measures and judges the mesh. Where it is not sound, meshes anew with
  /// smaller sizes there. Does not throw for a mesh that is not sound. To be called once, last.
  MeshResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Meshes by a word of stages, such as "DB" or "DBCO" (see stage_registry()); of a GivenMesh also by words
/// that begin from its elements, such as "CO". Throws as prepare(), for words that cannot be used, and
/// UnsoundError unless the problem allows that.
MeshResult mesh(const Prepared& prepared, const std::string& word, const Context& context = {});

/// Both in one. `word`: of stages, or the name of a quality, which stands for a word and for the directions
/// where the problem does not say them; a GivenMesh it improves, by CO or, without quads, BCO. The same
/// problem and word give the same mesh, to the last bit, whatever the context. May be called in several
/// threads at once.
MeshResult mesh(MeshProblem problem, const std::string& word = kDefaultQuality, const Context& context = {});

/// Throws UnsoundError when the mesh is not accepted; `label` begins the message.
void require_sound(const std::string& label, const MeshResult& result);

}  // namespace delquad
