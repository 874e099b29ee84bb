// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/places_inside.h"
#include "metrics/judgement/criteria.h"
#include "metrics/shape.h"
#include "smoothing/surface/surface_lift.h"
#include "tests/smoothing/meshed_surface.h"
#include "tests/support/polygon_face.h"

namespace delquad {
namespace {

/// A model that has been meshed, ready to be lifted.
struct Meshed : MeshedSurface {
  Meshed(SurfaceModel given, double h) : MeshedSurface(std::move(given), h, false) {
    std::vector<SurfaceTracks::Patch> patches;
    for (std::size_t p = 0; p < quads.size(); ++p) {
      const SurfacePatch& patch = domain.patches[p];
      std::vector<std::array<int, 2>> sides;
      for (const auto& q : quads[p].quads)
        for (int k = 0; k < 4; ++k) sides.push_back({q[k], q[(k + 1) % 4]});
      inside[p] = places_inside(patch, model, quads[p].points, sides, nodes.points);
      patches.push_back({&patch, nullptr, &quads[p], &inside[p]});
    }
    tracks.emplace(model, size, domain, nodes, std::move(patches));
    places = tracks->points();
  }

  double worst() const {
    Mesh mesh;
    mesh.points = places, mesh.quads = tracks->quads();
    const auto etas = quad_etas(mesh);
    return *std::ranges::min_element(etas);
  }

  std::optional<SurfaceTracks> tracks;
  std::vector<Vec3> places;
};

/// For each vertex, the shortest edge.
std::vector<double> shortest_edges(const Meshed& m) {
  std::vector<double> shortest(m.places.size(), 1e300);
  for (const auto& quad : m.tracks->quads())
    for (int k = 0; k < 4; ++k) {
      const int v = quad[k], w = quad[(k + 1) % 4];
      const double length = norm(m.places[w] - m.places[v]);
      shortest[v] = std::min(shortest[v], length), shortest[w] = std::min(shortest[w], length);
    }
  return shortest;
}

TEST(SurfaceTracks, PlacesOutsideThePatchGetAPositionInside) {
  const Meshed m(bump(40, 0.4), 0.12);
  const SurfacePatch& patch = m.domain.patches.at(0);
  for (int v = 0; v < static_cast<int>(m.places.size()); v += 7) {
    if (m.tracks->is_on_curve(v) || v < static_cast<int>(m.nodes.points.size())) continue;
    const auto spot = m.tracks->track_place_near(v, {m.tracks->position(v), m.places[v]}, {1e9, -1e9, 1e12});
    int hint = -1;
    const auto [t, b] = patch.background->locate(spot.position, hint);
    Vec2 nearest;
    for (int k = 0; k < 3; ++k) nearest += b[k] * patch.map.flat.points[patch.map.flat.triangles[t][k]];
    EXPECT_LT(norm(nearest - spot.position), 1e-9);
  }
}

// Each third vertex goes most of the way to a neighbor of its own kind.
TEST(SurfaceLift, DisplacedVerticesFindBetterPlacesOnTheirTracks) {
  Meshed m(bump(40, 0.4), 0.12);
  const int n = static_cast<int>(m.places.size());
  for (const auto& quad : m.tracks->quads())
    for (int k = 0; k < 4; ++k) {
      const int v = quad[k], w = quad[(k + 1) % 4];
      if (v % 3 != 0 || m.tracks->is_on_curve(v) != m.tracks->is_on_curve(w)) continue;
      if (norm(m.tracks->axes(v)[0]) == 0) continue;
      const auto spot = m.tracks->track_place_near(v, {m.tracks->position(v), m.places[v]},
                                                   0.3 * m.places[v] + 0.7 * m.places[w]);
      m.tracks->put(v, spot);
      m.places[v] = spot.place;
      break;
    }
  ASSERT_LT(m.worst(), 0.1);
  const auto shortest_before = shortest_edges(m);
  Budget trials(10'000'000);
  EXPECT_GT(lift_worst_on_surface(*m.tracks, m.places, 0.3, 20, trials), n / 50);
  EXPECT_GT(m.worst(), 0.2);
  const auto shortest = shortest_edges(m);
  for (int v = 0; v < n; ++v) EXPECT_GT(shortest[v], 0.19 * *std::ranges::min_element(shortest_before)) << v;
  m.tracks->store(m.places);
  for (std::size_t c = 0; c < m.nodes.on_curve.size(); ++c)
    for (const CurveNode& node : m.nodes.on_curve[c])
      EXPECT_LT(norm(m.nodes.points[node.node] -
                     place_on_curve(m.model, m.domain.chains[c], m.domain.cut_face, node.s)),
                1e-12);
}

int folded(const Meshed& m) {
  return static_cast<int>(std::ranges::count_if(m.tracks->quads(), [&](const auto& q) {
    return quad_warp({m.places[q[0]], m.places[q[1]], m.places[q[2]], m.places[q[3]]}) > kFold;
  }));
}

TEST(SurfaceLift, FoldedQuadsAreUnfolded) {
  // A roof whose slopes turn by 143 degrees; its ridge is no curve and runs askew to the rows of quads.
  int before = 0, after = 0;
  for (const double skew : {0.1, 0.2, 0.3, 0.4, 0.5})
    for (const double h : {0.11, 0.13, 0.17}) {
      Meshed m(grid_surface({40, 40},
                            [&](double u, double v) {
                              const double x = 2 * u - 1;
                              return Vec3{x + skew * (2 * v - 1) * (1 - x * x), 2 * v - 1, -3 * std::abs(x)};
                            }),
               h);
      before += folded(m);
      Budget trials(10'000'000);
      lift_worst_on_surface(*m.tracks, m.places, 0.3, 20, trials);
      after += folded(m);
    }
  EXPECT_GT(before, 10);
  EXPECT_EQ(after, 0);
}

TEST(SurfaceLift, WhatIsGoodStays) {
  Meshed m(polygon_face({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 0.5), 0.5);
  const auto before = m.places;
  Budget trials(1000);
  EXPECT_EQ(lift_worst_on_surface(*m.tracks, m.places, 0.3, 20, trials), 0);
  EXPECT_EQ(m.places, before);
  EXPECT_EQ(trials.left(), 1000);
}

TEST(SurfaceLift, WhatPassesIsNotMended) {
  Meshed m(polygon_face({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 0.5), 0.5);
  const auto before = m.places;
  Budget trials(1000);
  const auto repair = [&](double size) {
    const auto field = make_constant_size(size);
    return repair_failing_on_surface(*m.tracks, m.places, {*field, {}, excess_of(criteria_presets()[0])}, 6,
                                     trials);
  };
  EXPECT_EQ(repair(0.5), 0);
  EXPECT_EQ(m.places, before);
  EXPECT_EQ(trials.left(), 1000);
  // Nothing helps against sides that are all too short.
  EXPECT_EQ(repair(5), 0);
  EXPECT_EQ(m.places, before);
  EXPECT_LT(trials.left(), 1000);
}

TEST(SurfaceLift, EndsOnceTheTrialsAreSpent) {
  Meshed m(grid_surface({40, 40},
                        [](double u, double v) {
                          const double x = 2 * u - 1;
                          return Vec3{x + 0.5 * (2 * v - 1) * (1 - x * x), 2 * v - 1, -3 * std::abs(x)};
                        }),
           0.11);
  const auto before = m.places;
  Budget none(0), all(10'000'000);
  EXPECT_EQ(lift_worst_on_surface(*m.tracks, m.places, 0.3, 20, none), 0);
  EXPECT_EQ(m.places, before);
  const int moved = lift_worst_on_surface(*m.tracks, m.places, 0.3, 20, all);
  EXPECT_GT(moved, 1);
  m.places = before;
  Budget some(1);  // the vertex that is at work finishes
  EXPECT_LE(lift_worst_on_surface(*m.tracks, m.places, 0.3, 20, some), 1);
}

}  // namespace
}  // namespace delquad
