// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/grids/grids.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/grids/mapped_grid.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/patches/places_inside.h"
#include "metrics/shape.h"
#include "metrics/size_efficiency.h"

namespace delquad {
namespace {

/// Limits of automatic grids: mean eta with more than two rows, worst eta, and mean fit of edge lengths to
/// the size. A free mesh has about these values.
constexpr double kLeastMeanEta = 0.88, kLeastEta = 0.55, kLeastFit = 0.9;

struct GridQuality {
  double mean = 0, worst = 1;
  double fit = 0;      ///< of the sides: length / delta, or its inverse where that is less
  double longest = 0;  ///< of the sides, in sizes
  bool pays(bool is_narrow) const {
    return is_narrow ? worst >= QuadLimits{}.eta && longest <= QuadLimits{}.longest
                     : worst >= kLeastEta && mean >= kLeastMeanEta && fit >= kLeastFit;
  }
};

class GridOfPatch {
 public:
  GridOfPatch(const MappedPatch& mapped, const MeshingSetup& p)
      : mapped_(mapped), problem_(p), patch_(p.patches[mapped.patch]) {}

  /// The grid; nothing where it would fold, at `fold`, or where it is not asked for and would be bad.
  std::optional<QuadPatch> make(Vec2& fold) const {
    std::vector<double> layers;
    for (int row = 1; row < mapped_.rows; ++row) layers.push_back(double(row) / mapped_.rows);
    if (mapped_.corners.empty() && mapped_.rows <= 0) layers = ring_layers(patch_.boundary, *patch_.size);
    const auto flat = interpolated_grid(patch_.boundary, patch_.boundary.points, mapped_.corners, layers);
    if (!flat) return std::nullopt;
    QuadPatch grid;
    grid.points = flat->points;
    grid.quads = flat->quads;
    grid.n_boundary = static_cast<int>(patch_.boundary.points.size());
    if (problem_.surface)
      if (auto other = by_space(grid, layers)) grid = std::move(*other);
    if (mapped_.corners.size() == 3 || !are_convex(grid.points, grid.quads))
      smooth_grid(grid, *patch_.cross, *patch_.size);
    if (!are_convex(grid.points, grid.quads, &fold)) return std::nullopt;
    if (!mapped_.is_requested && mapped_.rows <= 0 &&
        !quality_of(grid).pays(mapped_.rows < 0 || is_narrow(layers)))
      return std::nullopt;
    return grid;
  }

  Vec3 place(Vec2 u) const {
    int hint = -1;
    return patch_.lift(u, hint);
  }

 private:
  /// The grid by interpolation in space, where it is better.
  std::optional<QuadPatch> by_space(const QuadPatch& flat, const std::vector<double>& layers) const {
    const FlatPatch& map = problem_.surface->domain.patches[mapped_.patch].map;
    const Mesh& fine = problem_.surface->model.fine;
    std::vector<Vec3> nodes, points;
    for (const int node : patch_.boundary.point_node) nodes.push_back(problem_.boundary.points[node]);
    const auto grid = interpolated_grid(patch_.boundary, nodes, mapped_.corners, layers);
    if (!grid) return std::nullopt;
    for (const int v : map.fine_node) points.push_back(fine.points[v]);
    const NearestTriangle nearest(points, map.flat.triangles);
    QuadPatch moved = flat;
    int guess = -1;
    for (std::size_t i = nodes.size(); i < moved.points.size(); ++i) {
      const auto found = nearest.find_from(guess, grid->points[i]);
      guess = found.triangle;
      moved.points[i] = {};
      for (const int k : {0, 1, 2})
        moved.points[i] = moved.points[i] + found.weights[k] * map.flat.points[nearest.triangle(guess)[k]];
    }
    if (!are_convex(moved.points, moved.quads)) return std::nullopt;
    if (are_convex(flat.points, flat.quads) && quality_of(moved).mean < quality_of(flat).mean)
      return std::nullopt;
    return moved;
  }

  /// Two rows at most; of a ring three, where its width changes much.
  bool is_narrow(const std::vector<double>& layers) const {
    const auto& c = mapped_.corners;
    if (c.size() != 4) return c.empty() && layers.size() <= 2;
    const int n = static_cast<int>(patch_.boundary.points.size());
    return (c[1] - c[0] + n) % n <= 2 || (c[2] - c[1] + n) % n <= 2;
  }

  GridQuality quality_of(const QuadPatch& grid) const {
    PatchMesh mesh = grid_as(PatchForm::kQuads, grid);
    std::vector<Vec3> places;
    for (const int node : patch_.boundary.point_node) places.push_back(problem_.boundary.points[node]);
    for (const Vec3& x :
         places_inside(problem_, static_cast<std::size_t>(mapped_.patch), mesh, problem_.boundary.points))
      places.push_back(x);
    GridQuality quality;
    for (const auto& [a, b, c, d] : grid.quads) {
      const std::array corners{places[a], places[b], places[c], places[d]};
      const double eta = eta_of(element_shape(corners, area_vector(corners)).angle);
      quality.mean += eta / static_cast<double>(grid.quads.size());
      quality.worst = std::min(quality.worst, eta);
      for (const int k : {0, 1, 2, 3}) {
        const double length = adimensional_length(corners[k], corners[(k + 1) % 4], *problem_.size.field);
        quality.longest = std::max(quality.longest, length);
        quality.fit += std::min(length, 1 / length) / static_cast<double>(4 * grid.quads.size());
      }
    }
    return quality;
  }

  const MappedPatch& mapped_;
  const MeshingSetup& problem_;
  const PatchSetup& patch_;
};

}  // namespace

void add_grids(const MappedSpec& spec, const std::vector<MappedPatch>& mapped, MeshingSetup& p) {
  std::vector<std::optional<QuadPatch>> grids(mapped.size());
  parallel_for(
      mapped.size(),
      [&](std::size_t i) {
        const FaceScope face = patch_scope(p, static_cast<std::size_t>(mapped[i].patch));
        const GridOfPatch maker(mapped[i], p);
        Vec2 fold;
        grids[i] = maker.make(fold);
        if (grids[i] || !mapped[i].is_requested) return;
        const Vec3 at = maker.place(fold);
        throw InputError(fmt::format("{}: '{}' cannot be a grid: it would fold at {} [no-grid]", spec.where,
                                     region_label(p.boundary.regions[p.patches[mapped[i].patch].region]),
                                     show_point(at)));
      },
      [&](std::size_t i) { return static_cast<double>(p.patches[mapped[i].patch].boundary.points.size()); });
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    PatchSetup& patch = p.patches[mapped[i].patch];
    patch.grid = std::move(grids[i]);
    patch.grid_stays = mapped[i].is_requested || mapped[i].rows > 0;
    if (!patch.grid || !patch.grid_stays || p.plane.curve_places.empty()) continue;
    for (const int node : patch.boundary.point_node) p.plane.curve_places[node] = {};
  }
  for (const auto& [region, rows] : spec.rings) {
    if (rows > 0 && std::ranges::none_of(p.patches, [&](const PatchSetup& patch) {
          return patch.grid && has_name(p.boundary.regions[patch.region], region);
        }))
      p.warnings.push_back(
          {"rings that have no rows", 0,
           fmt::format("{} did not get {} rows: it is no ring, or its numbers of edges differ", region,
                       rows)});
  }
  const auto has_grid = [](const PatchSetup& patch) { return patch.grid.has_value(); };
  if (spec.automatic && std::ranges::none_of(p.patches, has_grid))
    p.warnings.push_back(spec.where + ": no face makes a good grid: all are meshed freely");
}

}  // namespace delquad
