// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/background_mesh.h"
#include "features/curves/mesh_planar_curves.h"
#include "geometry/planar/planar_model.h"
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

struct Shape {
  const char* name;
  PatchBoundary boundary;
};

std::vector<Shape> unfriendly_shapes() {
  return {
      {"square", shapes::rectangle(1, 1, 20, 20)},
      {"slab", shapes::rectangle(1, 1e-3, 3, 1, 0.4)},
      {"single triangle", shapes::polygon({{0, 0}, {1, 0}, {0, 1}})},
      {"one degree", shapes::polygon({{0, 0}, {1, 0}, {1, 0.01745}}, 10)},
      {"needle", shapes::polygon({{0, 0}, {1, 0}, {1, 1e-11}}, 10)},
      {"slit", shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0.5, 1}, {0.5, 0.01}, {0.499999, 1}, {0, 1}}, 5)},
      {"tiny edge", shapes::polygon({{0, 0}, {0.5, 0}, {0.5 + 1e-9, 0}, {1, 0}, {1, 1}, {0, 1}})},
      {"far away", shapes::polygon({{1e8, 1e8}, {1e8 + 1, 1e8}, {1e8 + 1, 1e8 + 1}}, 7)},
      {"plate", shapes::plate_with_holes(2, 50, 4, 0.14, 40)},
      {"annulus", shapes::annulus(0.01, 1, 12, 80)},
  };
}

/// Sum of the lengths of the boundary's sides, each of which must lie on the edge that its first vertex
/// names.
double traced_length(const BackgroundMesh& background, const PatchBoundary& patch) {
  const TriPatch& tri = background.triangles();
  double sum = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] >= 0) continue;
      const int v = tri.triangles[t][(k + 1) % 3], w = tri.triangles[t][(k + 2) % 3];
      const auto& on = background.boundary_points()[v];
      const Vec2 a = patch.points[on.from], b = patch.points[on.to];
      const double tolerance = 1e-12 * (1 + norm(a));  // rounding of split points
      EXPECT_LE(norm(a + on.t * (b - a) - tri.points[v]), tolerance);
      EXPECT_LE(shapes::segment_distance(tri.points[w], a, b), tolerance);
      EXPECT_NEAR(cross(on.tangent, b - a), 0, 1e-12 * norm(b - a));
      sum += norm(tri.points[w] - tri.points[v]);
    }
  }
  return sum;
}

void expect_sound(const BackgroundMesh& background, const PatchBoundary& patch) {
  const TriPatch& tri = background.triangles();
  EXPECT_EQ(check_invariants(tri), std::vector<std::string>{});
  double sum = 0, length = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) sum += area(tri, static_cast<int>(t));
  for (const auto& [i, j] : patch.edges) length += norm(patch.points[j] - patch.points[i]);
  const double scale = norm(patch.points[0]) + length;
  EXPECT_NEAR(sum, area(patch), 1e-14 * scale * scale);
  EXPECT_NEAR(traced_length(background, patch), length, 1e-11 * scale);
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    EXPECT_EQ(background.boundary_points()[i].from, patch.point_node[i]);
    EXPECT_EQ(background.boundary_points()[i].t, 0);
  }
  // Coarse: refinement is capped at 8 vertices a boundary point, and 1000.
  EXPECT_LE(tri.points.size(), 8 * patch.points.size() + 1000 + 10);
}

TEST(BackgroundMesh, EndsBesideAPointNearerToAnEdgeThanRounding) {
  // The last corner but one lies 1e-200 from the left side. Splits of that side move nothing.
  const PatchBoundary patch = shapes::polygon({{0, 0}, {2, 0}, {2, 2}, {1e-200, 1}, {0, 2}});
  const TriPatch tri = background_of(patch)->triangles();
  double sum = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) sum += area(tri, static_cast<int>(t));
  EXPECT_NEAR(sum, area(patch), 1e-12);
}

TEST(BackgroundMesh, CoversUnfriendlyShapes) {
  for (const auto& [name, boundary] : unfriendly_shapes()) {
    SCOPED_TRACE(name);
    expect_sound(*background_of(boundary), boundary);
  }
}

TEST(BackgroundMesh, CoversRandomPolygons) {
  for (int seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const auto boundary = shapes::random_polygon_with_holes(seed, seed % 2 ? 0.05 : 0);
    expect_sound(*background_of(boundary), boundary);
  }
}

TEST(BackgroundMesh, HasFewSmallAnglesAndTriangles) {
  const auto boundary = shapes::plate_with_holes(2, 50, 4, 0.14, 40);
  const auto background = background_of(boundary);
  const TriPatch& tri = background->triangles();
  EXPECT_LE(tri.triangles.size(), 4 * boundary.edges.size());
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    double longest = 0, product = 1;
    for (int k = 0; k < 3; ++k) {
      const double side = norm(tri.points[tri.triangles[t][k]] - tri.points[tri.triangles[t][(k + 1) % 3]]);
      longest = std::max(longest, side);
      product *= side;
    }
    // Twice the area is the product of two sides and a sine: the two longest ones make the smallest angle.
    double shortest = longest;
    for (int k = 0; k < 3; ++k) {
      shortest = std::min(shortest,
                          norm(tri.points[tri.triangles[t][k]] - tri.points[tri.triangles[t][(k + 1) % 3]]));
    }
    const double sine = 2 * area(tri, static_cast<int>(t)) * shortest / product;
    EXPECT_GE(sine, std::sqrt(0.125) - 1e-9);
  }
}

/// The sides of the slits are 1e-6 of their edges apart; that is no reason for small triangles.
TEST(BackgroundMesh, IsNoFinerWhereLinesCross) {
  PlanarModel model = polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  model.curves.push_back({make_segment({0.2, 0.3}, {0.8, 0.57}), "", ""});
  model.curves.push_back({make_segment({0.2, 0.6}, {0.8, 0.27}), "", ""});
  const PlanarDomain domain = make_domain(model, *make_constant_size(0.02));
  ASSERT_EQ(domain.patches.size(), 1u);
  const BackgroundMesh background(domain.patches);
  EXPECT_LT(background.triangles().triangles.size(), 4 * domain.boundary.lines.size());
}

/// Slivers where a patch has slits, too.
TEST(BackgroundMesh, CoversUnfriendlyShapesThatMeetThemselves) {
  for (Shape& shape : unfriendly_shapes()) {
    SCOPED_TRACE(shape.name);
    shape.boundary.point_node.back() = shape.boundary.point_node.front();
    const BackgroundMesh background(std::span(&shape.boundary, 1));
    EXPECT_EQ(check_invariants(background.triangles()), std::vector<std::string>{});
    EXPECT_LE(background.triangles().points.size(), 8 * shape.boundary.points.size() + 1010);
  }
}

TEST(BackgroundMesh, IsTheSameTwice) {
  const auto boundary = shapes::plate_with_holes(2, 50, 4, 0.14, 40);
  const auto first = background_of(boundary);
  const std::vector<std::vector<int>> shift_the_heap(1000, std::vector<int>(17));
  const auto second = background_of(boundary);
  EXPECT_EQ(first->triangles().points, second->triangles().points);
  EXPECT_EQ(first->triangles().triangles, second->triangles().triangles);
}

TEST(BackgroundMesh, RefusesUnsoundBoundaries) {
  EXPECT_THROW(BackgroundMesh(std::span<const PatchBoundary>()), InputError);
  EXPECT_THROW(background_of(shapes::polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}})),
               InputError);  // crosses itself
  EXPECT_THROW(background_of(shapes::polygon({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}})),
               InputError);  // touches itself
  EXPECT_THROW(background_of(shapes::polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}})),
               InputError);  // a point twice
}

TEST(BackgroundMesh, RefusesBoundariesThatRunTheWrongWayRound) {
  const auto refused = [](const PatchBoundary& boundary) {
    return message_of([&] { background_of(boundary); }).find("turned inside out") != std::string::npos;
  };
  const auto turned = [](PatchBoundary boundary, std::size_t from) {
    for (std::size_t e = from; e < boundary.edges.size(); ++e)
      std::swap(boundary.edges[e][0], boundary.edges[e][1]);
    return boundary;
  };
  const PatchBoundary plate = shapes::plate_with_holes(1, 20, 1, 0.14, 12);
  EXPECT_FALSE(refused(plate));
  EXPECT_TRUE(refused(turned(plate, plate.edges.size() - 12)));  // its hole
  EXPECT_TRUE(refused(turned(shapes::rectangle(1, 1, 3, 3), 0)));
}

// --- locate
// ------------------------------------------------------------------------------------------------------

bool contains(const TriPatch& tri, int t, Vec2 u) {
  const auto& v = tri.triangles[t];
  for (int k = 0; k < 3; ++k) {
    if (orient2d(tri.points[v[k]], tri.points[v[(k + 1) % 3]], u) < 0) return false;
  }
  return true;
}

int first_containing(const TriPatch& tri, Vec2 u) {
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t) {
    if (contains(tri, t, u)) return t;
  }
  return -1;
}

double distance_to(const TriPatch& tri, int t, Vec2 u) {
  if (contains(tri, t, u)) return 0;
  double least = INFINITY;
  const auto& v = tri.triangles[t];
  for (int k = 0; k < 3; ++k) {
    least = std::min(least, shapes::segment_distance(u, tri.points[v[k]], tri.points[v[(k + 1) % 3]]));
  }
  return least;
}

Vec2 at(const TriPatch& tri, const BackgroundMesh::Location& location) {
  Vec2 sum;
  for (int k = 0; k < 3; ++k) sum += location.b[k] * tri.points[tri.triangles[location.triangle][k]];
  return sum;
}

/// Points inside, outside, on vertices and on sides.
std::vector<Vec2> query_points(const TriPatch& tri) {
  std::mt19937_64 random(7);
  std::vector<Vec2> points = tri.points;
  for (const auto& v : tri.triangles) points.push_back(0.5 * (tri.points[v[0]] + tri.points[v[1]]));
  for (int i = 0; i < 300; ++i) points.push_back(random_point(tri, random));
  for (int i = 0; i < 100; ++i)
    points.push_back({4 * shapes::uniform(random) - 2, 4 * shapes::uniform(random) - 2});
  return points;
}

void expect_located(const BackgroundMesh& background) {
  const TriPatch& tri = background.triangles();
  const int n = static_cast<int>(tri.triangles.size());
  std::mt19937_64 random(3);
  for (const Vec2 u : query_points(tri)) {
    int hint = -1;
    const auto found = background.locate(u, hint);
    EXPECT_EQ(hint, found.triangle);
    for (int i = 0; i < 5; ++i) {
      int other = static_cast<int>(random() % n);
      EXPECT_EQ(background.locate(u, other).triangle, found.triangle);
    }
    const int expected = first_containing(tri, u);
    double sum = 0;
    for (const double b : found.b) {
      EXPECT_GE(b, 0);
      sum += b;
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    if (expected >= 0) {
      EXPECT_EQ(found.triangle, expected);
      EXPECT_LE(norm(at(tri, found) - u), 1e-14);
      continue;
    }
    double least = INFINITY;
    for (int t = 0; t < n; ++t) least = std::min(least, distance_to(tri, t, u));
    EXPECT_NEAR(distance_to(tri, found.triangle, u), least, 1e-14);
    EXPECT_NEAR(norm(at(tri, found) - u), least, 1e-14);
  }
}

TEST(Locate, AgreesWithBruteForce) {
  for (const int seed : {1, 3, 5, 8}) {
    SCOPED_TRACE(seed);
    expect_located(*background_of(shapes::random_polygon_with_holes(seed, 0.1)));
  }
  expect_located(*background_of(shapes::rectangle(1, 1, 8, 8)));
  expect_located(*background_of(shapes::annulus(0.01, 1, 12, 40)));
}

TEST(Locate, VertexHasAllOfTheWeight) {
  const auto background = background_of(shapes::random_polygon_with_holes(4, 0.1));
  const TriPatch& tri = background->triangles();
  int hint = -1;
  for (std::size_t i = 0; i < tri.points.size(); ++i) {
    const auto found = background->locate(tri.points[i], hint);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(found.b[k], tri.triangles[found.triangle][k] == static_cast<int>(i) ? 1 : 0);
    }
  }
}

TEST(Locate, PlacesFarAwayAreThoseAtTheEndOfItsReach) {
  const auto background = background_of(shapes::rectangle(1, 1, 8, 8));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int hint = -1;
  for (const auto& [far, near] : {std::pair(Vec2{1e200, 0.3}, Vec2{1, 0.3}),
                                  {{0.3, -1e308}, {0.3, 0}},
                                  {{INFINITY, INFINITY}, {1, 1}},
                                  {{nan, nan}, {0, 0}}})
    EXPECT_LT(norm(at(background->triangles(), background->locate(far, hint)) - near), 1e-12);
}

/// A square with a square hole and the patch that fills it.
std::vector<PatchBoundary> touching_patches() {
  PatchBoundary inner = shapes::polygon({{1, 1}, {2, 1}, {2, 2}, {1, 2}}, 4);
  PatchBoundary outer = shapes::rectangle(3, 3, 6, 6);
  shapes::add_polygon(outer, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}, {4, 4, 4, 4});
  return {outer, inner};
}

TEST(BackgroundMesh, KeepsTouchingPatchesApart) {
  const auto patches = touching_patches();
  const BackgroundMesh background(patches);
  const TriPatch& tri = background.triangles();
  EXPECT_EQ(check_invariants(tri), std::vector<std::string>{});
  double sum[] = {0, 0};
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t) {
    const int patch = background.triangle_patch()[t];
    sum[patch] += area(tri, t);
    for (const int other : tri.neighbours[t]) {
      if (other >= 0) {
        EXPECT_EQ(background.triangle_patch()[other], patch);
      }
    }
    const Vec2 c = centroid(tri, t);
    EXPECT_EQ(patch, c.x > 1 && c.x < 2 && c.y > 1 && c.y < 2 ? 1 : 0);
  }
  EXPECT_NEAR(sum[0], 8, 1e-13);
  EXPECT_NEAR(sum[1], 1, 1e-13);
  expect_located(background);
}

}  // namespace
}  // namespace delquad
