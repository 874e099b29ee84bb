#include "pipeline/prepare_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cad/cad_reader.h"
#include "cad/example_models.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/improve_triangulation.h"
#include "io/mesh_io.h"
#include "io/polygons.h"
#include "mesh/activity.h"
#include "mesh/parallel.h"
#include "pipeline/located.h"
#include "pipeline/perturb.h"
#include "pipeline/size_aware.h"
#include "pipeline/size_warnings.h"
#include "pipeline/stopwatch.h"
#include "surfaces/surface_domain.h"

namespace delquad {
namespace {

const std::set<std::string> kCadFiles = {".step", ".stp", ".brep"};
const std::set<std::string> kTriangleFiles = {".stl", ".obj", ".off"};

/// Integral of dA/delta^2 over the fine triangles, by their centroids.
double expected_quads(const Mesh& fine, const SurfaceSize& size) {
  constexpr double kThird[] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  double sum = 0;
  int hint = -1;
  for (const auto& triangle : fine.triangles) {
    const auto& [a, b, c] = triangle;
    const Vec3 p = fine.points[a], q = fine.points[b], r = fine.points[c];
    const double delta = size.on_fine(triangle, kThird, (1.0 / 3) * (p + q + r), hint);
    sum += norm(cross(q - p, r - p)) / 2 / (delta * delta);
  }
  return sum;
}

/// Faces that cannot be meshed: the end, or left out where the case says so.
class Failures {
 public:
  explicit Failures(const Case& c) : where_(c.where), keep_going_(c.options.keep_going) {}

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

/// Meshes the curves; faces for which that is impossible go.
SurfaceDomain mesh_curves_of(const SurfaceModel& model, Flattening flattening, const SizeField& size,
                             const SizeField* asked, Failures& failures) {
  const auto solver = make_lemon_solver();
  while (!flattening.patches.empty()) {
    try {
      return make_surface_domain(model, failures.are_left_out() ? flattening : std::move(flattening), size,
                                 *solver, asked);
    } catch (const FaceError& error) {
      failures.add(error.face(), error.what());
      std::erase_if(flattening.patches, [&](const FlatPatch& p) { return p.face == error.face(); });
    }
  }
  throw InputError(model.source + ": no face can be meshed");
}

/// The growth of sizes away from curves that are shorter than the size.
constexpr double kShortCurveGradation = 0.7;

WantedSize wanted_size(const SizeSpec& spec, const SurfaceModel& model,
                       std::shared_ptr<const SizeField> base) {
  WantedSize wanted;
  wanted.base = std::move(base);
  wanted.gradation = spec.gradation;
  wanted.curve_limit = sizes_beside_short_curves(model.fine, *wanted.base);
  if (!wanted.curve_limit.empty() && !(wanted.gradation > 0)) wanted.gradation = kShortCurveGradation;
  if (!(spec.curvature > 0)) return wanted;
  wanted.curvature = std::make_shared<ModelCurvature>(model);
  wanted.per_turn = spec.curvature;
  wanted.min = spec.min;
  if (!(spec.gradation > 0)) wanted.gradation = kCurvatureGradation;
  return wanted;
}

}  // namespace

bool is_surface_file(const std::filesystem::path& path) {
  return kCadFiles.count(kind_of_file(path)) + kTriangleFiles.count(kind_of_file(path)) > 0;
}

bool holds_surface(const Mesh& mesh) {
  const auto in_space = [&](const auto& elements) {
    return std::ranges::any_of(elements, [&](const auto& element) {
      return std::ranges::any_of(element,
                                 [&](int v) { return mesh.points[v].z != mesh.points[elements[0][0]].z; });
    });
  };
  return in_space(mesh.triangles) || in_space(mesh.quads);
}

SurfaceModel make_triangle_model(const Case& c, Mesh mesh, const std::string& source, ReadNotes notes) {
  split_quads(mesh, source, notes);
  SurfaceModel model = make_model(c.surface, std::move(mesh), source);
  model.warnings.insert(model.warnings.begin(), notes.begin(), notes.end());
  return model;
}

SurfaceModel read_surface(const Case& c) {
  const std::filesystem::path& path = c.surface_file;
  return located(c.where, [&] {
    if (c.example.empty() && !kCadFiles.count(kind_of_file(path))) {
      ReadNotes notes;
      Mesh mesh = read_mesh(path, &notes);
      return make_triangle_model(c, std::move(mesh), path.string(), std::move(notes));
    }
    check_for_cad(c.surface);
    CadOptions options;
    options.keep_going = c.options.keep_going;
    SurfaceModel model = c.example.empty() ? read_cad(path, options) : read_example(c.example, options);
    if (!model.left_out.empty() && !c.surface.where.empty())
      throw InputError(model.left_out[0].reason + "; compounds need all faces");
    return make_compounds(c.surface, std::move(model));
  });
}

std::vector<const FlatPatch*> maps_of(const PreparedSurface& surface) {
  std::vector<const FlatPatch*> maps;
  for (const SurfacePatch& patch : surface.domain.patches) maps.push_back(&patch.map);
  return maps;
}

PreparedCase prepare_surface(const Case& c, SurfaceModel model, std::shared_ptr<const SizeField> size,
                             const std::function<void(double quads)>& check_count) {
  const bool size_aware = c.cross.text == "size-aware";
  if (!size_aware && c.cross.text != "boundary")
    throw InputError(c.cross.where +
                     ": a surface takes its crosses from its curves: expected 'boundary' or 'size-aware'");
  PreparedCase p;
  check_count(expected_quads(model.fine, SurfaceSize(size)));
  const Stopwatch sizes;
  const DoingStage measuring("sizes");
  const WantedSize wanted = wanted_size(c.size, model, std::move(size));
  const double size_seconds = sizes.work_seconds();

  const Stopwatch maps;
  const DoingStage flattening_faces("maps");
  improve_triangulation(model);
  refine_for_size(model, wanted);
  Flattening flattening = located(c.where, [&] { return flatten(model); });
  Failures failures(c);
  for (const LeftOutFace& face : model.left_out) failures.add(face.face, face.reason);
  add_unflattened(flattening, model, failures);
  p.seconds.emplace_back("maps", maps.work_seconds());

  const Stopwatch curves;
  const DoingStage meshing_curves("boundary");
  auto surface = std::make_shared<PreparedSurface>();
  surface->cuts = flattening.cuts;
  surface->size = std::make_shared<SurfaceSize>(model, wanted);
  p.size = surface->size;
  if (!wanted.curve_limit.empty()) p.size_adapted_to.push_back("short curves");
  if (wanted.curvature) p.size_adapted_to.push_back("curvature");
  if (!p.size_adapted_to.empty()) p.given_size = wanted.base;
  p.expected_quads = expected_quads(model.fine, *surface->size);
  check_count(p.expected_quads);
  const auto on_curves = c.seed == 0 ? p.size : jittered(p.size, c.seed, diagonal(model.fine));
  surface->domain = mesh_curves_of(model, std::move(flattening), *on_curves,
                                   wanted.curvature ? nullptr : wanted.base.get(), failures);
  surface->model = std::move(model);
  p.failures = failures.take();
  p.surface = surface;
  p.warnings = surface->model.warnings;
  p.warnings.insert(p.warnings.end(), surface->domain.warnings.begin(), surface->domain.warnings.end());
  warn_of_large_size(*wanted.base, surface->model.fine, p.warnings);
  warn_of_coarse_turns(wanted, *surface, p.warnings);
  p.boundary = surface->domain.boundary;
  p.sharp_corners = surface->domain.sharp_corners;
  p.seconds.emplace_back("curves", curves.work_seconds());

  const std::vector<SurfacePatch>& patches = surface->domain.patches;
  const Stopwatch fields;
  const DoingStage making_fields("fields");
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
  if (size_aware) make_crosses_size_aware(p);
  p.seconds.emplace_back("fields", size_seconds + fields.work_seconds());
  return p;
}

}  // namespace delquad
