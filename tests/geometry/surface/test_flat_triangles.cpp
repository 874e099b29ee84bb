// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/triangle_repair.h"
#include "tests/support/meshing.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a])) / 2;
  return sum;
}

/// Edges in an odd number of triangles.
int odd_edges(const Mesh& mesh) {
  int odd = 0;
  for_each_edge(sorted_half_edges(mesh),
                [&](std::span<const HalfEdge> edge) { odd += edge.size() % 2 != 0; });
  return odd;
}

/// Makes T-junctions in a mesh and closes them by triangles without area.
class Caps {
 public:
  Caps(Mesh given, unsigned seed) : mesh(std::move(given)), random_(seed) {}

  /// The triangles at an edge are cut at points of their own; what opens between them is filled at random.
  void at_edge() {
    const auto t = static_cast<int>(below(mesh.triangles.size()));
    const int k = static_cast<int>(below(3)), a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
    const std::vector<int> here = cut(t, a, b), others = triangles_on(a, b);
    std::vector<int> gap = {b};
    gap.insert(gap.end(), here.rbegin(), here.rend());
    gap.push_back(a);
    if (others.size() == 1) {
      const std::vector<int> there = cut(others[0], a, b);
      gap.insert(gap.end(), there.begin(), there.end());
    }
    fill(std::move(gap));
  }

  /// A vertex becomes two in the same place, with two triangles between them.
  void at_vertex() {
    const auto t = below(mesh.triangles.size());
    const int v = mesh.triangles[t][0], w = add(Vec3(mesh.points[v]));
    for (const int x : {mesh.triangles[t][1], mesh.triangles[t][2]}) mesh.triangles.push_back({v, w, x});
    mesh.triangles[t][0] = w;
    mesh.triangle_region.assign(mesh.triangles.size(), 0);
  }

  void repeat_some_flat() {
    for (std::size_t t = mesh.triangles.size(); t-- > 0;)
      if (!has_area(mesh.points, mesh.triangles[t]) && below(3) == 0) push(mesh.triangles[t]);
  }

  void shuffle() {
    std::ranges::shuffle(mesh.triangles, random_);
    for (auto& v : mesh.triangles) std::ranges::rotate(v, v.begin() + static_cast<int>(below(3)));
  }

  Mesh mesh;

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  int add(const Vec3& p) {
    mesh.points.push_back(p);
    return static_cast<int>(mesh.points.size()) - 1;
  }
  void push(const std::array<int, 3>& v) {
    mesh.triangles.push_back(v);
    mesh.triangle_region.push_back(0);
  }
  std::vector<int> triangles_on(int a, int b) const {
    std::vector<int> on;
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
      if (std::ranges::count(mesh.triangles[t], a) > 0 && std::ranges::count(mesh.triangles[t], b) > 0)
        on.push_back(t);
    return on;
  }

  /// Cuts a triangle at up to three points of its side, at eighths: points from a to b.
  std::vector<int> cut(int t, int a, int b) {
    std::vector<int> at;
    for (int k = 1; k < 8 && at.size() < 3; ++k)
      if (below(3) == 0) at.push_back(add(mesh.points[a] + (k / 8.0) * (mesh.points[b] - mesh.points[a])));
    int last = a;
    for (const int m : at) {
      auto half = mesh.triangles[t];
      std::ranges::replace(half, b, m);
      push(half);
      std::ranges::replace(mesh.triangles[t], last, m);
      last = m;
    }
    return at;
  }

  /// Triangles of a polygon that runs to and fro.
  void fill(std::vector<int> gap) {
    while (gap.size() > 2) {
      const std::size_t n = gap.size(), i = below(n);
      std::array<int, 3> v = {gap[i], gap[(i + 1) % n], gap[(i + 2) % n]};
      if (below(2) == 0) std::swap(v[0], v[1]);
      push(v);
      gap.erase(gap.begin() + static_cast<long>((i + 1) % n));
    }
  }

  std::mt19937 random_;
};

TEST(FlatTriangles, ClosedSurfacesStayClosedWhereverCapsLie) {
  int n_flat = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const Mesh whole = without_regions(seed % 3 == 0 ? box(2) : seed % 3 == 1 ? can(12, 2) : lens(8, 3, 0.5));
    Caps caps(whole, seed);
    for (unsigned i = 0; i < 1 + seed % 8; ++i) seed % 5 == 4 ? caps.at_vertex() : caps.at_edge();
    ASSERT_EQ(odd_edges(caps.mesh), 0) << "the test opens the surface, seed " << seed;
    if (seed % 2 == 1) caps.repeat_some_flat();
    caps.shuffle();
    n_flat += static_cast<int>(std::ranges::count_if(
        caps.mesh.triangles, [&](const auto& v) { return !has_area(caps.mesh.points, v); }));
    for (const Mesh& mesh : {caps.mesh, soup(caps.mesh)}) {
      const SurfaceModel model = make_surface_model(mesh);
      EXPECT_EQ(odd_edges(model.fine), 0) << "seed " << seed;
      EXPECT_EQ(violations(model), std::vector<std::string>{}) << "seed " << seed;
      EXPECT_NEAR(area(model.fine), area(whole), 1e-9) << "seed " << seed;
      EXPECT_NEAR(volume(model.fine), volume(whole), 1e-9) << "seed " << seed;
      EXPECT_EQ(model.fine.regions.size(), make_surface_model(whole).fine.regions.size()) << "seed " << seed;
    }
  }
  EXPECT_GT(n_flat, 1000);
}

/// An open one keeps its outline and its area.
TEST(FlatTriangles, OpenSurfacesKeepTheirOutlines) {
  const auto outline = [](const Mesh& mesh) {
    double length = 0;
    for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
      if (edge.size() == 1) length += norm(mesh.points[edge[0].hi] - mesh.points[edge[0].lo]);
    });
    return length;
  };
  for (unsigned seed = 0; seed < 100; ++seed) {
    Mesh whole = without_regions(box(2));
    whole.triangles.resize(8);  // a side
    whole.triangle_region.resize(8);
    Caps caps(whole, seed);
    for (int i = 0; i < 5; ++i) caps.at_edge();
    caps.shuffle();
    const SurfaceModel model = make_surface_model(caps.mesh);
    EXPECT_NEAR(area(model.fine), 1, 1e-9) << "seed " << seed;
    EXPECT_NEAR(outline(model.fine), 4, 1e-9) << "seed " << seed;
    EXPECT_EQ(violations(model), std::vector<std::string>{}) << "seed " << seed;
  }
}

/// Two caps that lie side by side, each on the longest side of the other: nothing with an area is beside
/// that.
TEST(FlatTriangles, TwoCapsBackToBack) {
  Mesh mesh = without_regions(box(1));
  auto& v = mesh.triangles[0];
  int k = 0;
  while (norm(mesh.points[v[(k + 1) % 3]] - mesh.points[v[k]]) > 1.2) ++k;
  const int a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3], n = static_cast<int>(mesh.points.size());
  for (const double s : {0.25, 0.5})
    mesh.points.push_back(mesh.points[a] + s * (mesh.points[b] - mesh.points[a]));
  v = {a, n, c};
  mesh.triangles.push_back({n, b, c});
  for (auto& w : mesh.triangles) {
    if (&w == &v || std::ranges::count(w, a) == 0 || std::ranges::count(w, b) == 0) continue;
    auto half = w;
    std::ranges::replace(half, a, n + 1);
    std::ranges::replace(w, b, n + 1);
    mesh.triangles.push_back(half);
    break;
  }
  mesh.triangles.insert(mesh.triangles.end(), {{a, b, n}, {b, a, n + 1}});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  ASSERT_EQ(odd_edges(mesh), 0);
  const SurfaceModel model = make_surface_model(mesh);
  EXPECT_EQ(odd_edges(model.fine), 0);
  EXPECT_NEAR(volume(model.fine), 1, 1e-12);
  EXPECT_EQ(model.fine.regions.size(), 6u);
}

/// A chain of thousands takes as many steps.
TEST(FlatTriangles, LongChainsEnd) {
  Mesh mesh = without_regions(box(1));
  auto v = mesh.triangles[0];
  const int n = 3000, first = static_cast<int>(mesh.points.size());
  for (int i = 1; i < n; ++i)
    mesh.points.push_back(mesh.points[v[0]] + (double(i) / n) * (mesh.points[v[1]] - mesh.points[v[0]]));
  const auto at = [&](int i) { return i == 0 ? v[0] : i == n ? v[1] : first + i - 1; };
  mesh.triangles[0] = {at(0), at(1), v[2]};
  for (int i = 1; i < n; ++i) {
    mesh.triangles.push_back({at(i), at(i + 1), v[2]});
    mesh.triangles.push_back({at(i), at(i - 1), at(n)});
  }
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  ASSERT_EQ(odd_edges(mesh), 0);
  const SurfaceModel model = make_surface_model(mesh);
  EXPECT_EQ(odd_edges(model.fine), 0);
  EXPECT_NEAR(volume(model.fine), 1, 1e-9);
}

}  // namespace
}  // namespace delquad
