// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/treatment/treatment.h"
#include "features/curves/mesh_surface_curves.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/patches/places_inside.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/surface/improve_triangulation.h"
#include "smoothing/surface/surface_lift.h"
#include "tests/support/meshing.h"
#include "tests/support/polygon_face.h"

namespace delquad {
namespace {

namespace surfaces = testing_support;

struct Meshed {
  Mesh mesh;
  std::vector<Warning> warnings;
  std::vector<SharpCorner> sharp_corners;
};

Meshed mesh_surface(SurfaceModel model, double h) {
  improve_triangulation(model);
  const SurfaceSize size(make_constant_size(h));
  Flattening flattening = flatten(model);
  EXPECT_TRUE(flattening.failed.empty());
  const SurfaceDomain domain =
      make_surface_domain(model, std::move(flattening), size, *make_primal_dual_solver());
  std::vector<QuadPatch> quads(domain.patches.size());
  std::vector<std::vector<Vec3>> inside(domain.patches.size());
  std::vector<SurfaceTracks::Patch> patches;
  for (std::size_t p = 0; p < quads.size(); ++p) {
    const SurfacePatch& patch = domain.patches[p];
    EXPECT_EQ(patch.boundary.edges.size() % 2, 0u);
    const HarmonicCrossField cross(patch.background);
    const SurfacePatchSize delta(patch, model.fine, size);
    const TriPatch tri = mesh_frontal(patch.boundary, *make_linf_delquad(), cross, delta);
    quads[p] = treat_paper(recombine(tri, *make_primal_dual_solver()), delta);
    EXPECT_TRUE(quads[p].triangles.empty());
    std::vector<std::array<int, 2>> sides;
    for (const auto& q : quads[p].quads)
      for (int k = 0; k < 4; ++k) sides.push_back({q[k], q[(k + 1) % 4]});
    inside[p] = places_inside(patch, model, quads[p].points, sides, domain.nodes.points);
    patches.push_back({&patch, nullptr, &quads[p], &inside[p]});
  }
  SurfaceNodes nodes = domain.nodes;
  SurfaceTracks tracks(model, size, domain, nodes, patches);
  std::vector<Vec3> places = tracks.points();
  Budget trials(10'000'000);
  lift_worst_on_surface(tracks, places, 0.3, 20, trials);
  tracks.store(places);
  Mesh mesh = domain.boundary;
  mesh.points = nodes.points;
  for (std::size_t p = 0; p < quads.size(); ++p) {
    const SurfacePatch& patch = domain.patches[p];
    std::vector<int> node = patch.boundary.point_node;
    for (const Vec3& x : inside[p]) {
      node.push_back(static_cast<int>(mesh.points.size()));
      mesh.points.push_back(x);
    }
    for (auto q : quads[p].quads) {
      for (int& v : q) v = node[v];
      mesh.quads.push_back(q);
      mesh.quad_region.push_back(patch.map.face);
    }
  }
  for (const auto& [patch, cap] : domain.caps)
    for (const auto& quad : cap.quads) {
      mesh.quads.push_back(quad);
      mesh.quad_region.push_back(domain.patches[patch].map.face);
    }
  drop_unused_points(mesh);
  return {std::move(mesh), domain.warnings, domain.sharp_corners};
}

/// Euler characteristic, and how many edges have one quad only.
std::pair<int, int> euler_and_free_edges(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> quads_at;
  for (const auto& q : mesh.quads) {
    for (int k = 0; k < 4; ++k) ++quads_at[std::minmax(q[k], q[(k + 1) % 4])];
  }
  int free = 0;
  for (const auto& [edge, n] : quads_at) free += n == 1;
  return {static_cast<int>(mesh.points.size()) - static_cast<int>(quads_at.size()) +
              static_cast<int>(mesh.quads.size()),
          free};
}

void expect_sound(const Meshed& meshed, int euler, bool closed) {
  const auto wrong = check_invariants(meshed.mesh);
  EXPECT_TRUE(wrong.empty()) << wrong[0];
  const auto [chi, free] = euler_and_free_edges(meshed.mesh);
  EXPECT_EQ(chi, euler);
  EXPECT_EQ(free == 0, closed) << free;
}

TEST(SurfaceDomain, ClosedSurfacesOfEveryGenusAreWatertightAndAllQuad) {
  expect_sound(mesh_surface(surfaces::round_sphere(12), 0.2), 2, true);
  expect_sound(mesh_surface(surfaces::torus(48, 20, 1, 0.4), 0.12), 0, true);
  expect_sound(mesh_surface(surfaces::double_torus(4), 0.3), -2, true);
}

TEST(SurfaceDomain, OpenSurfacesKeepTheirOutline) {
  expect_sound(mesh_surface(surfaces::cylinder(40, 10, 1, 2), 0.2), 0, false);
  expect_sound(mesh_surface(surfaces::bump(20, 0.3), 0.07), 1, false);
  expect_sound(mesh_surface(surfaces::cone(40, 20, 0.5), 0.1), 1, false);
}

TEST(SurfaceDomain, SizesLargerThanTheModelStillGiveAMesh) {
  const Meshed meshed = mesh_surface(surfaces::cylinder(40, 10, 1, 2), 50);
  EXPECT_TRUE(check_invariants(meshed.mesh).empty());
  EXPECT_FALSE(meshed.warnings.empty());
}

// A corner of 3.8 degrees: its one quad comes near to what the angle allows, all others are good.
TEST(SurfaceDomain, ASharpCornerCostsItsOwnQuadOnly) {
  const Meshed meshed = mesh_surface(surfaces::polygon_face({{0, 0}, {6, -0.2}, {6, 0.2}}, 0.1), 0.5);
  ASSERT_EQ(meshed.sharp_corners.size(), 1u);
  const SharpCorner& corner = meshed.sharp_corners[0];
  EXPECT_NEAR(corner.angle, 2 * std::atan2(0.2, 6), 1e-9);
  EXPECT_NEAR(corner.eta_bound, corner.angle / (std::numbers::pi / 2), 1e-9);
  const auto etas = quad_etas(meshed.mesh);
  for (size_t q = 0; q < etas.size(); ++q) {
    const auto& v = meshed.mesh.quads[q];
    const bool in_corner = std::find(v.begin(), v.end(), corner.node) != v.end();
    EXPECT_GT(etas[q], in_corner ? 0.9 * corner.eta_bound : 0.2);
  }
}

/// Between two parabolas over [-1, 1], which meet in two corners.
SurfaceModel lens(double half_width) {
  constexpr int kLines = 20;
  std::vector<Vec2> outline;
  for (int i = 0; i < kLines; ++i) {
    const double x = 2.0 * i / kLines - 1;
    outline.push_back({x, -half_width * (1 - x * x)});
  }
  for (int i = 0; i < kLines; ++i) {
    const double x = 1 - 2.0 * i / kLines;
    outline.push_back({x, half_width * (1 - x * x)});
  }
  SurfaceModel model = surfaces::polygon_face(outline, 1);
  model.corners = {0, kLines};
  return model;
}

// The sides are nearer to each other than a quarter of an edge for the first three edges.
TEST(SurfaceDomain, ACuspIsFilledByRows) {
  std::vector<Vec2> outline{{0, 0}, {10, 0}};
  for (int i = 20; i > 0; --i) outline.push_back({0.5 * i, 0.02 * 0.25 * i * i});
  SurfaceModel model = surfaces::polygon_face(outline, 0.25);
  model.corners = {0, 40, 48};
  const Meshed meshed = mesh_surface(model, 1);
  ASSERT_EQ(meshed.sharp_corners.size(), 1u);
  const SharpCorner& corner = meshed.sharp_corners[0];
  EXPECT_LT(corner.angle, 0.025);
  const auto etas = quad_etas(meshed.mesh);
  int in_corner = 0;
  for (size_t q = 0; q < etas.size(); ++q) {
    const auto& v = meshed.mesh.quads[q];
    const bool touches = std::find(v.begin(), v.end(), corner.node) != v.end();
    in_corner += touches;
    EXPECT_GT(etas[q], touches ? 0.999 * corner.eta_bound : 0.3);
  }
  EXPECT_EQ(in_corner, 1);
}

TEST(SurfaceDomain, ALensSmallerThanTheSizeIsMeshedWell) {
  for (const double half_width : {0.3, 0.1, 0.05}) {
    const Meshed meshed = mesh_surface(lens(half_width), 5);
    EXPECT_TRUE(check_invariants(meshed.mesh).empty());
    const auto etas = quad_etas(meshed.mesh);
    EXPECT_GT(*std::min_element(etas.begin(), etas.end()), half_width < 0.1 ? 0.08 : 0.12) << half_width;
  }
}

// Nodes of both circles must be as many, and no vertex may be left that only the gap's width keeps apart.
TEST(SurfaceDomain, ARingNarrowerThanTheSizeIsOneRowOfQuads) {
  const SurfaceModel ring = surfaces::grid_surface({80, 2, true}, [](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, r = 1 + 0.1 * v;
    return Vec3{r * std::cos(phi), -r * std::sin(phi), 0};
  });
  const Meshed meshed = mesh_surface(ring, 0.25);
  const auto etas = quad_etas(meshed.mesh);
  EXPECT_GT(*std::min_element(etas.begin(), etas.end()), 0.3);
}

/// Edges on the circles of a flat ring of inner radius 1.
std::vector<std::size_t> edges_of_ring(double outer, double agreement) {
  SurfaceModel ring = surfaces::grid_surface({160, 4, true}, [&](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, r = 1 + (outer - 1) * v;
    return Vec3{r * std::cos(phi), -r * std::sin(phi), 0};
  });
  const SurfaceSize size(make_constant_size(0.1));
  Flattening flattening = flatten(ring);
  const SurfaceDomain domain = make_surface_domain(
      ring, std::move(flattening), size, *make_primal_dual_solver(), nullptr, {}, {}, {}, {agreement});
  std::vector<std::size_t> edges;
  for (std::size_t c = 0; c < domain.chains.size(); ++c)
    if (domain.chains[c].closed()) edges.push_back(domain.nodes.on_curve[c].size() - 1);
  std::ranges::sort(edges);
  return edges;
}

TEST(SurfaceDomain, SidesThatDifferLittleGetEqualNumbersOfEdges) {
  const std::vector<std::size_t> by_size = edges_of_ring(1.2, 0), agreed = edges_of_ring(1.2, 3);
  ASSERT_EQ(by_size.size(), 2u);
  EXPECT_GE(by_size[1], by_size[0] + 10);
  EXPECT_EQ(agreed[0], agreed[1]);
  EXPECT_GT(agreed[0], by_size[0]);
  EXPECT_LT(agreed[1], by_size[1]);
  // Where one is half as long again, rows end all the same.
  EXPECT_GT(edges_of_ring(1.5, 3)[1], edges_of_ring(1.5, 3)[0] + 20);
}

/// Edges around both ends of a hole through a square plate; lengths in sizes, of which the hole is ten
/// around.
std::vector<std::size_t> edges_of_hole(double side, double depth, double agreement) {
  constexpr int kAround = 48, kSteps = 4, kProfile = 4 * kSteps;
  const double radius = 5 / std::numbers::pi;
  Mesh plate;
  for (int i = 0; i < kAround; ++i)
    for (int k = 0; k < kProfile; ++k) {
      const double phi = 2 * std::numbers::pi * i / kAround, s = double(k % kSteps) / kSteps;
      const double out[] = {0, s, 1, 1 - s}, high[] = {s, 1, 1 - s, 0};
      const Vec2 round{std::cos(phi), std::sin(phi)};
      const double square = side / 2 / std::max(std::abs(round.x), std::abs(round.y));
      const Vec2 at = (radius + out[k / kSteps] * (square - radius)) * round;
      plate.points.push_back({at.x, at.y, depth * high[k / kSteps]});
      const auto point = [&](int di, int dk) { return (i + di) % kAround * kProfile + (k + dk) % kProfile; };
      plate.triangles.push_back({point(0, 0), point(0, 1), point(1, 1)});
      plate.triangles.push_back({point(0, 0), point(1, 1), point(1, 0)});
    }
  plate.triangle_region.assign(plate.triangles.size(), 0);
  plate.regions.push_back({1, {}});
  SurfaceModel model = make_surface_model(std::move(plate));
  improve_triangulation(model);
  Flattening flattening = flatten(model);
  const SurfaceDomain domain = make_surface_domain(
      model, std::move(flattening), SurfaceSize(make_constant_size(1)), *make_primal_dual_solver(), nullptr,
      {}, {}, {}, {agreement, kMostAgreementSteps, true});
  std::map<int, std::size_t> edges;  // cuts part curves
  for (std::size_t c = 0; c < domain.chains.size(); ++c)
    if (std::ranges::all_of(domain.nodes.on_curve[c], [&](const CurveNode& n) {
          const Vec3 x = domain.nodes.points[n.node];
          return std::hypot(x.x, x.y) < 1.01 * radius && (x.z < 1e-9 || x.z > depth - 1e-9);
        }))
      edges[domain.chains[c].curve] += domain.nodes.on_curve[c].size() - 1;
  std::vector<std::size_t> counts;
  for (const auto& [curve, n] : edges) counts.push_back(n);
  return counts;
}

TEST(SurfaceDomain, SmallHolesGetTheEdgesOfTheSquareAroundThem) {
  const std::vector<std::size_t> by_length{10, 10};
  EXPECT_EQ(edges_of_hole(14, 4, 0), by_length);
  const std::vector<std::size_t> edges = edges_of_hole(14, 4, 3);
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_GE(edges[0], 12u);
  EXPECT_EQ(edges[0], edges[1]);
  // Not where quads of a deep bore would be narrow, nor where there is no room beside the hole.
  EXPECT_EQ(edges_of_hole(14, 20, 3), by_length);
  EXPECT_LE(edges_of_hole(5, 4, 3)[0], 10u);
}

// delta' of a known conformal map: the stretch of the map cancels in the lengths on the surface.
TEST(SurfaceDomain, EdgesOnACurvedCapHaveTheSizeInSpace) {
  const Mesh mesh = mesh_surface(surfaces::sphere_cap(60, 30, 1.2), 0.08).mesh;
  double sum = 0;
  int n = 0;
  for (const auto& q : mesh.quads) {
    for (int k = 0; k < 4; ++k, ++n) sum += norm(mesh.points[q[k]] - mesh.points[q[(k + 1) % 4]]);
  }
  EXPECT_NEAR(sum / n, 0.08, 0.006);
}

}  // namespace
}  // namespace delquad
