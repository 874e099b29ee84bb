#include "mesher/prepare_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/activity.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "features/crosses/size_aware.h"
#include "features/grids/add_grids.h"
#include "features/periodic/periodic_sides.h"
#include "features/seed/perturb.h"
#include "features/sizes/curve_options.h"
#include "features/sizes/fine_spots.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"
#include "features/symmetry/mirrored_surface.h"
#include "features/symmetry/symmetric_size.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/improve_triangulation.h"
#include "geometry/surface/periodic_lines.h"
#include "mesher/recombination_options.h"
#include "patches/divided_chains.h"
#include "patches/surface_domain.h"

namespace delquad {
namespace {

/// Integral of dA/delta^2 over the fine triangles, by their centroids; faces that are images have that of
/// their masters. `part`: of what, if the triangles are a part of a symmetric model; null: they are all.
double expected_quads(const Mesh& fine, const SurfaceSize& size, const std::vector<FacePair>& images = {},
                      const CutSurface* part = nullptr) {
  constexpr double kThird[] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  std::vector<int> times(fine.regions.size(), 1);
  for (const FacePair& pair : images) times[pair.face] = 0, times[pair.master] = 2;
  double sum = 0;
  int hint = -1;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    const auto& triangle = fine.triangles[t];
    const auto& [a, b, c] = triangle;
    const Vec3 p = fine.points[a], q = fine.points[b], r = fine.points[c];
    const double delta = size.on_fine(triangle, kThird, (1.0 / 3) * (p + q + r), hint);
    double quads = times[fine.triangle_region[t]] * (norm(cross(q - p, r - p)) / 2 / (delta * delta));
    for (int k = 0; part != nullptr && k < part->planes.count(); ++k)
      if (!(part->half.face_planes[fine.triangle_region[t]] >> k & 1)) quads *= 2;
    sum += quads;
  }
  return sum;
}

/// Faces that cannot be meshed: the end, or left out where the problem says so.
class Failures {
 public:
  explicit Failures(const MeshProblem& problem) : where_(problem.where), keep_going_(problem.keep_going) {}

  void add(int face, const std::string& reason) {
    if (!keep_going_) throw InputError(where_ + ": " + reason);
    failures_.push_back({face, reason});
  }
  bool are_left_out() const { return keep_going_; }
  std::vector<FaceFailure> take() {
    std::ranges::stable_sort(failures_, {}, &FaceFailure::face);
    return std::move(failures_);
  }

 private:
  std::string where_;
  bool keep_going_;
  std::vector<FaceFailure> failures_;
};

void add_unflattened(const Flattening& flattening, const SurfaceModel& model, Failures& failures) {
  if (flattening.failed.empty()) return;
  std::string tags;
  for (const int face : flattening.failed) tags += fmt::format(" {}", model.fine.regions[face].tag);
  for (const int face : flattening.failed) failures.add(face, "these faces could not be flattened:" + tags);
}

/// All faces but those that are images of others.
Flattening flatten_all(SurfaceModel& model, const PeriodicSides& periodic) {
  if (periodic.empty()) return flatten(model);
  FlattenOptions options;
  options.left_out.assign(model.fine.regions.size(), 0);
  for (const FacePair& pair : periodic.faces) options.left_out[pair.face] = 1;
  const std::size_t n_curves = model.fine.curves.size();
  options.after_cuts = [&] { return match_corners(model, periodic, n_curves); };
  match_corners(model, periodic, n_curves);
  return flatten(model, options);
}

/// Meshes the curves; faces for which that is impossible go.
SurfaceDomain mesh_curves_of(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size,
                             const SizeField* asked, const MeshProblem& problem,
                             const std::vector<CurveDivision>& divisions, const PeriodicSides& periodic,
                             Failures& failures) {
  const auto solver = matching_solver(recombination_options(problem.options).solver, problem.options);
  while (!flattening.patches.empty()) {
    try {
      return make_surface_domain(model, failures.are_left_out() ? flattening : std::move(flattening), size,
                                 *solver, asked, divisions, periodic, problem.mapped,
                                 curve_options(problem.options).agreement);
    } catch (const FaceError& error) {
      failures.add(error.face(), error.what());
      std::erase_if(flattening.patches, [&](const FlatPatch& p) { return p.face == error.face(); });
    }
  }
  throw InputError(model.source + ": no face can be meshed");
}

/// The growth of sizes away from curves that are shorter than the size, and from spots.
constexpr double kShortCurveGradation = 0.7;

/// Elements per full turn that are asked for by name; of several the most.
std::vector<double> curvature_by_name(const std::vector<NamedSize>& named,
                                      const std::vector<Entity>& entities, const std::string& kind) {
  std::vector<double> per_turn(entities.size(), 0);
  for (const NamedSize& n : named)
    for (const int i : entities_named(entities, kind, n.name))
      per_turn[i] = std::max(per_turn[i], n.curvature);
  return per_turn;
}

/// Edges of curves that get curved elements turn by no more, in radians: polynomials hardly follow more, and
/// of a quad between two such edges the normal is never far from its mean.
constexpr double kCurvedEdgeTurn = std::numbers::pi / 2;

/// `cut`: null, or the model is the part.
WantedSize wanted_size(const MeshProblem& problem, const SurfaceModel& model,
                       std::shared_ptr<const SizeField> base, const std::vector<SizeSpot>& spots,
                       const CutSurface* cut) {
  const SizeSpec& spec = problem.size;
  WantedSize wanted;
  if (problem.order > 1 && model.projector) wanted.edge_turn = kCurvedEdgeTurn;
  wanted.base = std::move(base);
  wanted.gradation = spec.gradation;
  wanted.curve_limit = sizes_beside_short_curves(model.fine, *wanted.base);
  wanted.spots = spots;
  if (!(wanted.curve_limit.empty() && spots.empty()) && !(wanted.gradation > 0))
    wanted.gradation = kShortCurveGradation;
  const bool named = std::ranges::any_of(spec.named, [](const NamedSize& n) { return n.curvature > 0; });
  if (!(spec.curvature > 0) && !named) return wanted;
  wanted.curvature = std::make_shared<ModelCurvature>(model);
  wanted.per_turn = spec.curvature;
  if (named) {
    const Mesh& whole = cut != nullptr ? cut->whole.fine : model.fine;
    wanted.face_per_turn = curvature_by_name(spec.named, whole.regions, "region");
    wanted.curve_per_turn = curvature_by_name(spec.named, whole.curves, "curve");
  }
  if (named && cut != nullptr) {
    wanted.face_per_turn = most_of_faces(std::move(wanted.face_per_turn), *cut);
    wanted.curve_per_turn = most_of_curves(wanted.curve_per_turn, *cut);
  }
  wanted.min = spec.min;
  if (!(spec.gradation > 0)) wanted.gradation = kCurvatureGradation;
  return wanted;
}

/// The edges that curves are given, each a spot of its own length.
std::vector<FineSpot> edges_of(const SurfaceModel& model, const std::vector<CurveDivision>& divisions) {
  const std::vector<CurveChain> chains = curve_chains(model);
  const auto divided = divide_chains(model.fine, chains, divisions);
  std::vector<FineSpot> spots;
  for (std::size_t c = 0; c < chains.size(); ++c)
    for (std::size_t k = 1; k < divided[c].size(); ++k) {
      const Vec3 a = fine_point_at(model.fine, chains[c], divided[c][k - 1]);
      const Vec3 b = fine_point_at(model.fine, chains[c], divided[c][k]);
      spots.push_back({a, b, norm(b - a), 0});
    }
  return spots;
}

void check_surface_cross(const CrossSpec& cross) {
  if (cross.kind != CrossKind::kSizeAware && cross.kind != CrossKind::kBoundary)
    throw InputError(cross.where +
                     ": a surface takes its crosses from its curves: expected 'boundary' or 'size-aware'");
}

/// Maps of given elements are taken when they distort less: these may be large, and every cut holds nodes.
constexpr double kMaxSigmaOfGiven = 1.6;

void prepare_patches(const std::shared_ptr<PreparedSurface>& surface, PreparedProblem& p) {
  const std::vector<SurfacePatch>& patches = surface->domain.patches;
  p.patches.resize(patches.size());
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        const SurfacePatch& patch = patches[i];
        const DoingFace face(surface->model.fine.regions[patch.map.face].tag);
        p.patches[i] = {
            patch.boundary, patch.map.face, std::make_shared<HarmonicCrossField>(patch.background),
            std::make_shared<SurfacePatchSize>(patch, surface->model.fine, *surface->size),
            [surface, &patch](Vec2 u, int& hint) { return lift(patch, surface->model, u, hint); }};
      },
      [&](std::size_t i) { return static_cast<double>(patches[i].map.flat.triangles.size()); });
}

}  // namespace

PreparedProblem prepare_given_surface(const MeshProblem& problem, GivenSurface given, const Mesh& mesh,
                                      std::shared_ptr<const SizeField> size,
                                      const std::function<void(double quads)>& check_count) {
  check_surface_cross(problem.cross);
  PreparedProblem p = with_settings_of(problem);
  WantedSize wanted;
  wanted.base = std::move(size);
  wanted.gradation = problem.size.gradation;

  const Stopwatch maps;
  const DoingStage flattening_faces("maps");
  SurfaceModel& model = given.model;
  FlattenOptions options;
  options.max_sigma = kMaxSigmaOfGiven;
  options.element = given.element;
  options.avoided = given.avoided;
  Flattening flattening = located(problem.where, [&] { return flatten(model, options); });
  Failures failures(problem);
  add_unflattened(flattening, model, failures);
  if (flattening.patches.empty()) throw InputError(model.source + ": no face can be meshed");
  p.times.emplace_back("maps", maps.time());

  const Stopwatch curves;
  const DoingStage meshing_curves("boundary");
  auto surface = std::make_shared<PreparedSurface>();
  surface->cuts = flattening.cuts;
  surface->size = std::make_shared<SurfaceSize>(model, wanted);
  p.size.field = surface->size;
  p.size.expected_quads = expected_quads(model.fine, *surface->size);
  check_count(p.size.expected_quads);
  surface->domain = make_kept_domain(model, std::move(flattening), *surface->size);
  given.given_curve.resize(model.fine.curves.size(), -1);
  surface->given = {mesh.curves, mesh.regions, given.given_curve, given.given_region};
  p.failures = failures.take();
  p.warnings = model.warnings;
  p.warnings.insert(p.warnings.end(), surface->domain.warnings.begin(), surface->domain.warnings.end());
  p.boundary = surface->domain.boundary;
  p.boundary.unit = model.fine.unit;
  std::vector<QuadPatch> elements;
  std::vector<std::vector<Vec3>> inside(surface->domain.patches.size());
  for (std::size_t i = 0; i < inside.size(); ++i)
    elements.push_back(elements_within(given, surface->domain.patches[i], inside[i]));
  surface->model = std::move(model);
  p.surface = surface;
  p.times.emplace_back("curves", curves.time());

  const Stopwatch fields;
  const DoingStage making_fields("fields");
  prepare_patches(surface, p);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    p.patches[i].given = std::move(elements[i]);
    p.patches[i].given_inside = std::move(inside[i]);
  }
  if (problem.cross.kind == CrossKind::kSizeAware) make_crosses_size_aware(p);
  p.times.emplace_back("fields", fields.time());
  return p;
}

PreparedProblem prepare_surface(const MeshProblem& problem, SurfaceModel model,
                                std::shared_ptr<const SizeField> size,
                                const std::function<void(double quads)>& check_count,
                                const Refinement& refinement) {
  const std::vector<SizeSpot>& spots = refinement.spots;
  const bool size_aware = problem.cross.kind == CrossKind::kSizeAware;
  check_surface_cross(problem.cross);
  PreparedProblem p = with_settings_of(problem);
  check_count(expected_quads(model.fine, SurfaceSize(size)));
  std::optional<CutSurface> cut = cut_at_planes(problem, model, size);
  std::vector<CurveDivision> divisions = problem.divisions;
  if (cut) {
    divisions = divisions_of_part(divisions, *cut);
    model = std::move(cut->half.model);
  }
  const CutSurface* part = cut ? &*cut : nullptr;
  const Stopwatch sizes;
  const DoingStage measuring("sizes");
  const std::shared_ptr<const SizeField> given = size;
  if (!divisions.empty()) size = as_near(size, edges_of(model, divisions));
  const WantedSize wanted = wanted_size(problem, model, std::move(size), spots, part);
  const TimeSpent size_time = sizes.time();

  const Stopwatch maps;
  const DoingStage flattening_faces("maps");
  improve_triangulation(model);
  refine_for_size(model, wanted);
  std::vector<Warning> warnings;
  const PeriodicSides periodic = find_periodic_sides(model, problem.periodic, warnings);
  Flattening flattening = located(problem.where, [&] { return flatten_all(model, periodic); });
  Failures failures(problem);
  for (const LeftOutFace& face : model.left_out) failures.add(face.face, face.reason);
  add_unflattened(flattening, model, failures);
  p.times.emplace_back("maps", maps.time());

  const Stopwatch curves;
  const DoingStage meshing_curves("boundary");
  auto surface = std::make_shared<PreparedSurface>();
  surface->cuts = flattening.cuts;
  surface->size = std::make_shared<SurfaceSize>(model, wanted);
  p.size.field = surface->size;
  if (!wanted.curve_limit.empty()) p.size.adapted_to.push_back("short curves");
  if (wanted.curvature) p.size.adapted_to.push_back("curvature");
  if (!spots.empty()) p.size.adapted_to.push_back("sound quads");
  if (!problem.divisions.empty()) p.size.adapted_to.push_back("given edges");
  if (!p.size.adapted_to.empty()) p.size.asked = given;
  p.size.expected_quads = expected_quads(model.fine, *surface->size, periodic.faces, part);
  check_count(p.size.expected_quads);
  auto on_curves = surface->size;
  if (problem.seed != 0) {
    WantedSize other = wanted;
    other.base = jittered(wanted.base, problem.seed, diagonal(model.fine));
    on_curves = std::make_shared<SurfaceSize>(model, other);
  }
  surface->domain =
      mesh_curves_of(model, std::move(flattening), *on_curves, wanted.curvature ? nullptr : wanted.base.get(),
                     problem, divisions, periodic, failures);
  surface->model = std::move(model);
  surface->cad = refinement.cad;
  p.failures = failures.take();
  p.surface = surface;
  p.warnings = surface->model.warnings;
  p.warnings.insert(p.warnings.end(), warnings.begin(), warnings.end());
  p.warnings.insert(p.warnings.end(), surface->domain.warnings.begin(), surface->domain.warnings.end());
  warn_of_large_size(*wanted.base, surface->model.fine, p.warnings);
  warn_of_coarse_turns(wanted, *surface, p.warnings);
  p.boundary = surface->domain.boundary;
  p.boundary.unit = surface->model.fine.unit;
  p.times.emplace_back("curves", curves.time());

  const Stopwatch fields;
  const DoingStage making_fields("fields");
  prepare_patches(surface, p);
  add_grids(problem.mapped, surface->domain.mapped, p);
  for (std::size_t i = 0; i < p.patches.size(); ++i)
    if (p.patches[i].grid && p.patches[i].grid_stays)
      for (const auto& loop : surface->domain.patches[i].outline)
        for (const CurveSide& side : loop) surface->domain.chain_stays[side.chain] = 1;
  if (size_aware) make_crosses_size_aware(p);
  if (cut) {
    p.symmetry = cut->planes.all();
    p.size.field = folded_size(p.size.field, cut->planes);
    if (p.size.asked) p.size.asked = folded_size(p.size.asked, cut->planes);
    surface->mirrored = mirrored_surface(std::move(*cut), *surface);
  }
  p.times.emplace_back("fields", size_time + fields.time());
  return p;
}

}  // namespace delquad
