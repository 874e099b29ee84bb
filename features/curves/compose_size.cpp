#include "features/curves/compose_size.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "delquad/error.h"
#include "fields/fields.h"

namespace delquad {

std::shared_ptr<const SizeField> base_size(const SizeSpec& spec, const SampleDomain& domain,
                                           std::vector<Warning>& warnings,
                                           const std::function<std::shared_ptr<const SizeField>()>& own) {
  std::shared_ptr<const SizeField> base = spec.field;
  if (spec.function) base = sample_size(spec.function, domain, spec.where + ": the size function", warnings);
  if (spec.from_boundary || (!base && spec.sources.empty())) base = own();
  if (!spec.sources.empty()) base = make_source_size(std::move(base), spec.sources);
  return spec.max > 0 ? make_capped_size(std::move(base), spec.max) : base;
}

std::shared_ptr<const SizeField> largest_size(const SizeSpec& size, const std::string& why) {
  if (size.max > 0 && !size.from_boundary) return make_constant_size(size.max);
  throw InputError(size.where + ": " + why);
}

PointSize as_function(std::shared_ptr<const SizeField> size, double scale) {
  return
      [size = std::move(size), scale, hint = -1](const Vec3& x) mutable { return scale * size->at(x, hint); };
}

void check_count(double quads, const MeshProblem& problem) {
  if (quads <= static_cast<double>(problem.max_elements)) return;
  const std::string count =
      std::isfinite(quads) ? fmt::format("about {:.3g} quads", quads) : "more quads than can be counted";
  throw InputError(fmt::format("{}: the size asks for {}, more than the {} that are allowed (max-elements)",
                               problem.size.where, count, problem.max_elements));
}

bool is_symmetric(const MeshProblem& problem) {
  return problem.symmetry.automatic || !problem.symmetry.planes.empty();
}

double expected_quads(const Mesh& fine, const SurfaceSize& size, const std::vector<FacePair>& images,
                      const CutSurface* part) {
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

}  // namespace delquad
