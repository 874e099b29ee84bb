#include <algorithm>
#include <set>
#include <utility>

#include "features/divisions/divisions.h"
#include "features/sizes/fine_spots.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

FineSpot spot_of_edge(const Vec3& a, const Vec3& b) { return {a, b, norm(b - a), 0}; }

}  // namespace

std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const PlanarModel& model,
                                            const PlanarDomain& domain,
                                            const std::vector<CurveDivision>& divisions) {
  std::set<int> divided;
  for (const CurveDivision& division : divisions)
    for (const int c : entities_named(curve_entities(model), "curve", division.name)) divided.insert(c);
  std::vector<FineSpot> spots;
  const Mesh& mesh = domain.boundary;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (std::ranges::any_of(domain.model_curves[mesh.line_curve[l]],
                            [&](int c) { return divided.contains(c); }))
      spots.push_back(spot_of_edge(mesh.points[mesh.lines[l][0]], mesh.points[mesh.lines[l][1]]));
  return as_near(std::move(size), spots);
}

std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const SurfaceModel& model,
                                            const std::vector<CurveDivision>& divisions) {
  const std::vector<CurveChain> chains = curve_chains(model);
  const auto divided = divide_chains(model.fine, chains, divisions);
  std::vector<FineSpot> spots;
  for (std::size_t c = 0; c < chains.size(); ++c)
    for (std::size_t k = 1; k < divided[c].size(); ++k)
      spots.push_back(spot_of_edge(fine_point_at(model.fine, chains[c], divided[c][k - 1]),
                                   fine_point_at(model.fine, chains[c], divided[c][k])));
  return as_near(std::move(size), spots);
}

}  // namespace delquad
