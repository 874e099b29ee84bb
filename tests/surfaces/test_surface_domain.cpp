#include "surfaces/surface_domain.h"

#include <gtest/gtest.h>

#include <map>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/recombination/treatment.h"
#include "geometry/surface/improve_triangulation.h"
#include "tests/support/surfaces.h"

namespace delquad {
namespace {

namespace surfaces = testing_support;

struct Meshed {
  Mesh mesh;
  std::vector<std::string> warnings;
};

Meshed mesh_surface(SurfaceModel model, double h) {
  improve_triangulation(model);
  const auto size = make_constant_size(h);
  Flattening flattening = flatten(model);
  EXPECT_TRUE(flattening.failed.empty());
  const SurfaceDomain domain = make_surface_domain(model, std::move(flattening), *size, *make_lemon_solver());
  Mesh mesh = domain.boundary;
  for (const SurfacePatch& patch : domain.patches) {
    EXPECT_EQ(patch.boundary.edges.size() % 2, 0u);
    const HarmonicCrossField cross(patch.background);
    const SurfacePatchSize delta(patch, model.fine, *size);
    const TriPatch tri = mesh_frontal(patch.boundary, *make_linf_delquad(), cross, delta);
    const QuadPatch quads = treat_paper(recombine(tri, *make_lemon_solver()), delta);
    EXPECT_TRUE(quads.triangles.empty());
    std::vector<int> node = patch.boundary.point_node;
    int hint = -1;
    for (size_t i = node.size(); i < quads.points.size(); ++i) {
      node.push_back(static_cast<int>(mesh.points.size()));
      mesh.points.push_back(lift(patch, model, quads.points[i], hint));
    }
    for (auto q : quads.quads) {
      for (int& v : q) v = node[v];
      mesh.quads.push_back(q);
      mesh.quad_region.push_back(patch.map.face);
    }
  }
  return {std::move(mesh), domain.warnings};
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
