#include "pipeline/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mesh_io.h"
#include "mesh/activity.h"
#include "pipeline/boundary_report.h"
#include "pipeline/located_fields.h"
#include "pipeline/named_domain.h"
#include "pipeline/perturb.h"
#include "pipeline/prepare_surface.h"
#include "pipeline/size_aware.h"
#include "pipeline/size_warnings.h"
#include "pipeline/stopwatch.h"

namespace delquad {
namespace {

constexpr const char* kFromBoundary = "boundary";
constexpr const char* kFromGradient = "gradient";
constexpr const char* kSizeAware = "size-aware";
/// Central differences for the direction of grad delta, in diagonals of the domain: far above rounding of the
/// coordinates, far below any feature that a mesh could show.
constexpr double kGradientStep = 1e-6;
/// Up to this many boundary edges, the domain is cheap enough to be built before the number of quads is
/// known.
constexpr double kCheapEdges = 2e5;
/// The boundary edges of the coarse domain on which the number of quads is estimated beyond that.
constexpr double kCoarseEdges = 4e3;

/// Reads a formula in whose place one of `words` could stand: it may be one of them, misspelt.
template <class F>
auto formula_or_word(const std::string& text, const std::vector<std::string>& words, F&& read) {
  try {
    return read();
  } catch (const InputError& error) {
    const auto near = nearest_name(text, words);
    throw InputError(error.what() + (near ? "; did you mean '" + *near + "'?" : ""));
  }
}

/// A number or an expression as a field; `where` goes in front of messages.
std::shared_ptr<const SizeField> make_base(const std::string& text, const std::string& where) {
  if (text.empty()) throw InputError(where + ": the size is empty: expected a number or an expression");
  if (const auto number = as_number(text)) {
    if (!(*number > 0) || *number > std::numeric_limits<double>::max())
      throw InputError(where + ": size " + text + ": expected a finite number > 0");
    return make_constant_size(*number);
  }
  return located(where, [&] {
    return std::make_shared<LocatedSize>(
        formula_or_word(text, {kFromBoundary}, [&] { return make_expression_size(text); }), where);
  });
}

/// The field without its gradation limit; `boundary` makes the one that follows the boundary's edges.
template <class F>
std::shared_ptr<const SizeField> make_size(const SizeSpec& spec, F&& boundary) {
  std::shared_ptr<const SizeField> base;
  if (spec.base == kFromBoundary || (spec.base.empty() && spec.sources.empty()))
    base = boundary();
  else if (!spec.base.empty())
    base = make_base(spec.base, spec.where);
  if (!spec.sources.empty()) base = make_source_size(std::move(base), spec.sources);
  return spec.max > 0 ? make_capped_size(std::move(base), spec.max) : base;
}

/// What stands in for a base that was not given.
std::shared_ptr<const SizeField> largest_size(const Case& c, const std::string& why) {
  if (c.size.max > 0 && c.size.base.empty()) return make_constant_size(c.size.max);
  throw InputError((c.size.where.empty() ? c.where : c.size.where) + ": " + why);
}

SizeFunction as_function(std::shared_ptr<const SizeField> size, double scale = 1) {
  return
      [size = std::move(size), scale, hint = -1](const Vec3& x) mutable { return scale * size->at(x, hint); };
}

/// Boundary edges that the size asks for, by chords: a first idea, before anything is allocated.
double rough_edges(const PlanarModel& model, const SizeField& size) {
  constexpr int kChords = 200;  // a curve
  double edges = 0;
  int hint = -1;
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k < kChords; ++k) {
      const Vec2 a = curve.shape->point(double(k) / kChords), b = curve.shape->point(double(k + 1) / kChords);
      const Vec2 m = 0.5 * (a + b);
      edges += norm(b - a) / size.at({m.x, m.y, 0}, hint);
    }
  return edges;
}

void check_count(double quads, const Case& c) {
  if (quads <= static_cast<double>(c.options.max_elements)) return;
  const std::string count =
      std::isfinite(quads) ? fmt::format("about {:.3g} quads", quads) : "more quads than can be counted";
  throw InputError(fmt::format("{}: the size asks for {}, more than --max-elements {}",
                               c.size.where.empty() ? c.where : c.size.where, count, c.options.max_elements));
}

/// Refuses a hopeless size while it is still cheap: estimates the quads on a domain with coarser boundaries.
void check_count_early(const Case& c, const std::shared_ptr<const SizeField>& size) {
  const double edges = rough_edges(*c.model, *size);
  if (!(edges > kCheapEdges)) return;
  std::optional<PlanarDomain> coarse;
  try {
    coarse = make_domain(*c.model, as_function(size, edges / kCoarseEdges));
  } catch (const InputError&) {
    // The boundary makes sense only at its full resolution, where the same check is made again.
  }
  if (!coarse)
    return check_count(edges / 2,
                       c);  // each boundary edge has a quad, which has two at most, but for corners
  check_count(expected_quads(BackgroundMesh(coarse->patches), *size), c);
}

double diagonal_of(const PlanarModel& model) {
  constexpr int kPoints = 64;  // a curve
  Mesh points;
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k <= kPoints; ++k) {
      const Vec2 p = curve.shape->point(double(k) / kPoints);
      points.points.push_back({p.x, p.y, 0});
    }
  return diagonal(points);
}

PlanarDomain mesh_model(const Case& c, const std::shared_ptr<const SizeField>& size) {
  CurveMeshOptions options;
  options.max_edges = static_cast<double>(c.options.max_elements);
  const auto on_curves = c.seed == 0 ? size : jittered(size, c.seed, diagonal_of(*c.model));
  return make_domain(*c.model, as_function(on_curves), options);
}

PlanarDomain prepare_model(const Case& c, PreparedCase& p) {
  const SizeSpec& spec = c.size;
  p.size = make_size(spec, [&] {
    return largest_size(
        c, "curves have no edge lengths of their own: expected a size (a number or an expression)");
  });
  check_count_early(c, p.size);
  PlanarDomain domain = mesh_model(c, p.size);
  p.background = std::make_shared<BackgroundMesh>(domain.patches);
  if (spec.gradation > 0) {
    p.size = limit_gradation(p.size, p.background, spec.gradation);
    check_count_early(c, p.size);
    domain = mesh_model(c, p.size);
    p.background = std::make_shared<BackgroundMesh>(domain.patches);
  }
  return domain;
}

PlanarDomain read_lines(const Case& c, const Mesh& mesh, const MshSurfaces& surfaces, PreparedCase& p) {
  if (mesh.lines.empty())
    throw InputError(c.mesh_file.string() +
                     ": holds no line elements: expected the boundary of a planar domain");
  if (!mesh.triangles.empty() || !mesh.quads.empty())
    p.warnings.push_back(
        fmt::format("{}: {} triangles and {} quads are left out: only lines count as boundary",
                    c.mesh_file.string(), mesh.triangles.size(), mesh.quads.size()));
  return make_named_domain(mesh, surfaces, c.mesh_file.string());
}

PlanarDomain prepare_mesh(const Case& c, const Mesh& mesh, const MshSurfaces& surfaces, PreparedCase& p) {
  const SizeSpec& spec = c.size;
  PlanarDomain domain = read_lines(c, mesh, surfaces, p);
  p.background = std::make_shared<BackgroundMesh>(domain.patches);
  p.size = make_size(spec, [&] { return make_boundary_size(p.background, domain.boundary); });
  if (spec.gradation > 0) p.size = limit_gradation(p.size, p.background, spec.gradation);
  for (const std::string& line : odd_boundaries(domain))
    p.warnings.push_back({"regions with an odd number of boundary edges", 0, line});
  return domain;
}

/// Says so when the indices of a cross field do not add up to the Euler characteristic.
void check_index_sum(const Case& c, PreparedCase& p) {
  const auto [sum, expected] = *p.index_sum_and_expected;
  if (sum == expected) return;
  p.warnings.push_back(
      fmt::format("{}: the indices of the cross field add up to {}/4, but the domain's Euler "
                  "characteristic is {}/4",
                  c.name, sum, expected));
}

/// The field of the whole domain.
std::shared_ptr<const CrossField> make_cross(const Case& c, PreparedCase& p) {
  const std::string& text = c.cross.text;
  if (text == kFromGradient) return make_gradient_cross(p.size, kGradientStep * diagonal(p.boundary));
  if (text != kFromBoundary && text != kSizeAware)
    return located(c.cross.where, [&] {
      std::shared_ptr<const CrossField> cross =
          std::make_shared<LocatedCross>(formula_or_word(text, {kFromBoundary, kFromGradient, kSizeAware},
                                                         [&] { return make_expression_cross(text); }),
                                         c.cross.where);
      return c.seed == 0 ? cross : rotated(std::move(cross), Rotation::by_seed(c.seed));
    });
  auto field = std::make_shared<HarmonicCrossField>(p.background);
  p.singularities = field->singularities();
  p.index_sum_and_expected = {field->index_sum(), 4 * field->euler_characteristic()};
  return field;
}

/// Turns domain and size by the case's seed.
void turn(const Case& c, PlanarDomain& domain, PreparedCase& p) {
  const Rotation rotation = Rotation::by_seed(c.seed);
  rotate(rotation, domain);
  p.background = std::make_shared<BackgroundMesh>(domain.patches);
  p.size = rotated(std::move(p.size), rotation);
}

PreparedCase prepare_surface_case(const Case& c, SurfaceModel model, const Stopwatch& reading) {
  const double read_seconds = reading.seconds();
  const auto size = make_size(c.size, [&] {
    return largest_size(c, c.size.base.empty()
                               ? "a surface needs a size (a number or an expression)"
                               : "'boundary' extends the lengths of a planar boundary that is "
                                 "kept; a surface's curves are meshed anew: expected a size (a "
                                 "number or an expression)");
  });
  PreparedCase p = prepare_surface(c, std::move(model), size, [&](double quads) { check_count(quads, c); });
  p.seconds.insert(p.seconds.begin(), {"read", read_seconds});
  return p;
}

}  // namespace

PreparedCase prepare_case(const Case& c) {
  const Stopwatch reading;
  const DoingStage stage("reading");
  if (!c.surface_file.empty() || !c.example.empty()) return prepare_surface_case(c, read_surface(c), reading);
  Mesh mesh;
  MshSurfaces surfaces;
  PreparedCase p;
  if (!c.model) {
    mesh = located(c.where, [&] { return read_msh(c.mesh_file, &surfaces); });
    if (holds_surface(mesh))
      return prepare_surface_case(c, make_triangle_model(c, std::move(mesh), c.mesh_file.string()), reading);
    p.seconds.emplace_back("read", reading.seconds());
  }
  if (!c.surface.where.empty())
    throw InputError(
        c.surface.where +
        ": the model is planar: compounds, feature angles, welding and mirrors are for surfaces");
  if (c.size.curvature > 0)
    throw InputError((c.size.where.empty() ? c.where : c.size.where) +
                     ": sizes by curvature are for surfaces, and this is a planar domain");
  const Stopwatch watch;
  const DoingStage meshing_curves("boundary");
  PlanarDomain domain = c.model ? prepare_model(c, p) : prepare_mesh(c, mesh, surfaces, p);
  p.expected_quads = expected_quads(*p.background, *p.size);
  check_count(p.expected_quads, c);
  check_holes(c.holes, domain);
  warn_of_large_size(*p.size, domain.boundary, p.warnings);
  if (c.model) warn_of_coarse_turns(*c.model, domain.boundary, p.warnings);
  if (c.seed != 0) turn(c, domain, p);
  p.boundary = std::move(domain.boundary);
  p.curve_places = std::move(domain.places);
  p.seconds.emplace_back("curves", watch.seconds());

  const Stopwatch fields;
  const DoingStage making_fields("fields");
  const auto cross = make_cross(c, p);
  const double z = p.boundary.points[0].z;
  const auto size = std::make_shared<PlanarSize>(p.size, z);
  for (std::size_t i = 0; i < domain.patches.size(); ++i)
    p.patches.push_back(
        {std::move(domain.patches[i]), domain.patch_region[i], cross, size, [z](Vec2 u, int&) {
           return Vec3{u.x, u.y, z};
         }});
  if (c.cross.text == kSizeAware) make_crosses_size_aware(p);
  if (p.index_sum_and_expected) check_index_sum(c, p);
  p.seconds.emplace_back("fields", fields.work_seconds());
  return p;
}

std::shared_ptr<const SizeField> size_of_mesh(const Mesh& mesh, const std::string& text) {
  if (text != kFromBoundary) return make_base(text, "--size");
  const PlanarDomain domain = make_domain(outline(mesh), {"boundary of the mesh", {}});
  return make_boundary_size(std::make_shared<BackgroundMesh>(domain.patches), domain.boundary);
}

}  // namespace delquad
