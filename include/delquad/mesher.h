#pragma once

#include <functional>
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

namespace delquad {

/// A trade of time against quality: "fast", "good" or "best".
struct Quality {
  std::string name, word;
  CrossKind cross;
};
/// From fast to best; docs/experiments.md has what each is worth. Throws InputError, naming those known.
const Quality& quality_named(const std::string& name);
const std::vector<Quality>& quality_registry();
inline constexpr const char* kDefaultQuality = "good";

/// What is to be meshed, and how. A plain value: it can be copied, and meshed again.
struct MeshProblem {
  std::string name = "model";   ///< in messages
  std::string where = "model";  ///< where it was written, for messages: a file and line
  Model model;
  SurfaceSpec surface = {};            ///< of a TriangleModel, CadModel or ExampleModel
  std::vector<LayerSpec> layers = {};  ///< of a PlanarModel or LineModel
  SizeSpec size = {};
  CrossSpec cross = {};
  std::vector<CurveDivision> divisions = {};  ///< sizes beside these curves follow their edges
  std::vector<PeriodicPair> periodic = {};
  SymmetrySpec symmetry = {};  ///< of planar models of curves, and of surfaces
  MappedSpec mapped = {};      ///< of planar models of curves, and of surfaces
  long long seed = 0;          ///< 0: as it is; else the domain is turned, and nodes are shifted along curves
  Options options = {};        ///< of the stages
  int order = 1;               ///< of the elements, 1 to 4: above 1 they are curved, see Mesh::order
  long long max_elements = 50'000'000;  ///< refuse sizes whose integral of dA/delta^2 is larger
  bool keep_going = false;     ///< leave faces out that cannot be meshed, instead of refusing the model
  bool allow_unsound = false;  ///< return meshes that are not accepted, instead of throwing UnsoundError
};

/// What is being done, for people who wait.
struct ProgressReport {
  std::string stage;  ///< "Lp-CVT smoothing"
  double part = 0;    ///< steps that are done, of all steps; 0 to 1
};

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

/// A mesh, and what is known of it.
struct MeshResult {
  Mesh mesh;
  MeshMetrics metrics;
  Soundness soundness;
  Summaries summaries;                   ///< what the stages did, added up over patches
  std::vector<Warning> warnings;         ///< on the model, the sizes and the mesh
  std::vector<FaceFailure> failures;     ///< by face; empty unless problem.keep_going
  std::optional<SurfaceReport> surface;  ///< of surfaces
  /// Seconds by step, in order of first use: those of all threads added up, so that they can be compared
  /// whatever the number of threads.
  std::vector<std::pair<std::string, double>> seconds;
  double wall_seconds = 0;    ///< of the stages of the word, on the clock
  double expected_quads = 0;  ///< integral of dA/delta^2
};

/// A mesh is not sound, or beyond the limits of its elements: see Soundness. The message has the reasons.
class UnsoundError : public std::runtime_error {
 public:
  explicit UnsoundError(const std::string& message, std::shared_ptr<const MeshResult> made = nullptr)
      : std::runtime_error(message), result(std::move(made)) {}
  std::shared_ptr<const MeshResult> result;  ///< with the mesh; null where it was not made by mesh()
};

/// Meshes a problem by a word of stages, such as "DB" or "DBCO" (see stage_registry()); of a GivenMesh also
/// by words that begin from its elements, such as "CO". The same problem and word give the same mesh, to the
/// last bit, whatever the context. May be called in several threads at once.
///
/// Throws InputError for models, sizes, options and words that cannot be used, naming file, entity or place;
/// UnsoundError; Cancelled and TimeIsUp, which say at what it was.
MeshResult mesh(const MeshProblem& problem, const std::string& word = "DBCO", const Context& context = {});

}  // namespace delquad
