// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kMeshRounding = 1e-12;

/// A pentagon of five quads round its center: the center has valence 5, nothing else is interior.
Mesh pentagon() {
  Mesh mesh;
  mesh.points.push_back({0, 0, 0});
  for (int k = 0; k < 10; ++k) {
    const double t = k * std::numbers::pi / 5, r = k % 2 == 0 ? 1 : std::cos(std::numbers::pi / 5);
    mesh.points.push_back({r * std::cos(t), r * std::sin(t), 0});
  }
  for (int k = 0; k < 5; ++k) mesh.quads.push_back({0, 1 + (2 * k + 9) % 10, 1 + 2 * k, 2 + 2 * k});
  mesh.quad_region.assign(5, 0);
  mesh.regions = {{1, {}}};
  return mesh;
}

TEST(Metrics, OfASquareGrid) {
  const auto values = evaluate_metrics(quad_grid(4, 3, 4, 3), nullptr).values;
  EXPECT_EQ(values.at("n_elements"), 12);
  EXPECT_EQ(values.at("n_quads"), 12);
  EXPECT_EQ(values.at("n_triangles"), 0);
  EXPECT_EQ(values.at("n_vertices"), 20);
  EXPECT_EQ(values.at("n_edges"), 31);
  EXPECT_EQ(values.at("percent_quads"), 100);
  EXPECT_EQ(values.at("d4"), 100);
  EXPECT_EQ(values.at("d_min"), 4);
  EXPECT_EQ(values.at("d_max"), 4);
  EXPECT_EQ(values.at("n_irregular"), 0);
  EXPECT_EQ(values.at("n_inverted"), 0);
  for (const char* key :
       {"eta_mean", "eta_worst", "eta_p1", "eta_p50", "scaled_jacobian_min", "scaled_jacobian_mean"}) {
    EXPECT_NEAR(values.at(key), 1, kMeshRounding) << key;
  }
  EXPECT_NEAR(values.at("angle_min"), 90, 90 * kMeshRounding);
  EXPECT_NEAR(values.at("angle_max"), 90, 90 * kMeshRounding);
}

TEST(Metrics, OfTheFiveQuadsOfAPentagon) {
  const MeshMetrics metrics = evaluate_metrics(pentagon(), nullptr);
  EXPECT_EQ(metrics.values.at("d4"), 0);
  EXPECT_EQ(metrics.values.at("d_min"), 5);
  EXPECT_EQ(metrics.values.at("d_max"), 5);
  EXPECT_EQ(metrics.values.at("n_irregular"), 1);
  EXPECT_EQ(metrics.valences, (std::map<int, long long>{{5, 1}}));
  EXPECT_EQ(metrics.quad_valences, metrics.valences);
  // Each quad has angles of 72, 90, 108 and 90 degrees.
  EXPECT_NEAR(metrics.values.at("eta_mean"), 0.8, kMeshRounding);
  EXPECT_NEAR(metrics.values.at("scaled_jacobian_min"), std::sin(72 * std::numbers::pi / 180), kMeshRounding);
  EXPECT_NEAR(metrics.values.at("angle_min"), 72, 100 * kMeshRounding);
  EXPECT_NEAR(metrics.values.at("angle_max"), 108, 100 * kMeshRounding);
}

TEST(Metrics, InterfacesBetweenRegionsAreInterior) {
  Mesh mesh = quad_grid(4, 4);
  mesh.regions.push_back({2, {"right"}});
  mesh.curves.push_back({5, {"interface"}});
  for (size_t q = 0; q < mesh.quads.size(); ++q) mesh.quad_region[q] = q % 4 < 2 ? 0 : 1;
  for (int j = 0; j < 4; ++j) {
    mesh.lines.push_back({5 * j + 2, 5 * j + 7});
    mesh.line_curve.push_back(4);
  }
  ASSERT_EQ(check_invariants(mesh), Strings());
  EXPECT_EQ(evaluate_metrics(mesh, nullptr).valences, (std::map<int, long long>{{4, 9}}));
}

TEST(Metrics, OfATriangleMeshLeaveQuadMeasuresUndefined) {
  const MeshMetrics metrics = evaluate_metrics(triangle_grid(4, 4), nullptr);
  for (const char* key : {"eta_mean", "eta_worst", "eta_p5", "d4", "n_irregular", "scaled_jacobian_min"}) {
    EXPECT_TRUE(std::isnan(metrics.values.at(key))) << key;
  }
  EXPECT_EQ(metrics.values.at("percent_quads"), 0);
  EXPECT_EQ(metrics.values.at("n_elements"), 32);
  EXPECT_EQ(metrics.values.at("n_inverted"), 0);
  EXPECT_EQ(metrics.valences, (std::map<int, long long>{{6, 9}}));
  EXPECT_EQ(metrics.values.at("d_min"), 6) << "triangles, where there are no quads";
  EXPECT_NEAR(metrics.values.at("angle_min"), 45, 100 * kMeshRounding);
}

TEST(Metrics, VertexWithATriangleIsNotRegular) {
  // Three quads and two triangles round the middle of a 2 x 2 grid whose first quad is cut there.
  Mesh mesh = quad_grid(2, 2);
  mesh.quads.erase(mesh.quads.begin());
  mesh.quad_region.pop_back();
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}};
  mesh.triangle_region = {0, 0};
  const MeshMetrics metrics = evaluate_metrics(mesh, nullptr);
  EXPECT_EQ(metrics.valences, (std::map<int, long long>{{5, 1}}));
  EXPECT_TRUE(metrics.quad_valences.empty());
  const auto& values = metrics.values;
  EXPECT_EQ(values.at("percent_quads"), 60);
  EXPECT_EQ(values.at("d_min"), 3) << "the quads alone";
  EXPECT_EQ(values.at("d_max"), 3);
  EXPECT_EQ(values.at("d4"), 0);
  EXPECT_NEAR(values.at("eta_mean"), 1, kMeshRounding) << "of the quads alone";
}

TEST(Metrics, BadQuadsCount) {
  Mesh mesh = quad_grid(2, 1, 2, 1);
  mesh.points[1] = {2.5, 0.5, 0};  // pulled through the east side
  const auto values = evaluate_metrics(mesh, nullptr).values;
  EXPECT_EQ(values.at("eta_worst"), 0);
  EXPECT_GE(values.at("n_inverted"), 1);
  EXPECT_LT(values.at("scaled_jacobian_min"), 0);
  EXPECT_GT(values.at("angle_max"), 180);

  Mesh turned = triangle_grid(1, 1);
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(evaluate_metrics(turned, nullptr).values.at("n_inverted"), 1);
}

TEST(Metrics, PercentilesAreNearestRanks) {
  // 100 rhombi apart from each other, with eta k / 100 for k = 1 to 100, in another order.
  Mesh mesh;
  for (int k = 0; k < 100; ++k) {
    const double eta = (k * 37 % 100 + 1) / 100.0, angle = eta * std::numbers::pi / 2;
    const int first = static_cast<int>(mesh.points.size());
    const Vec3 at = {3.0 * k, 0, 0}, along = {1, 0, 0}, side = {std::cos(angle), std::sin(angle), 0};
    for (const Vec3& p : {at, at + along, at + along + side, at + side}) mesh.points.push_back(p);
    mesh.quads.push_back({first, first + 1, first + 2, first + 3});
  }
  const MeshMetrics metrics = evaluate_metrics(mesh, nullptr);
  EXPECT_NEAR(metrics.values.at("eta_worst"), 0.01, kMeshRounding);
  EXPECT_NEAR(metrics.values.at("eta_p1"), 0.01, kMeshRounding);
  EXPECT_NEAR(metrics.values.at("eta_p5"), 0.05, kMeshRounding);
  EXPECT_NEAR(metrics.values.at("eta_p50"), 0.5, kMeshRounding);
  EXPECT_NEAR(metrics.values.at("eta_mean"), 0.505, kMeshRounding);
  EXPECT_TRUE(std::isnan(metrics.values.at("d_max"))) << "no vertex is interior";
}

TEST(Metrics, HistogramsHoldEveryElement) {
  const MeshMetrics metrics = evaluate_metrics(pentagon(), nullptr);
  const auto total = [](const Histogram& h) {
    return std::accumulate(h.counts.begin(), h.counts.end(), 0LL);
  };
  EXPECT_EQ(metrics.eta.counts.size(), 20u);
  EXPECT_EQ(metrics.angle.counts.size(), 36u);
  EXPECT_EQ(total(metrics.eta), 5);
  EXPECT_EQ(total(metrics.angle), 20);
  EXPECT_EQ(metrics.angle.counts[7], 5) << "72 degrees";
  EXPECT_EQ(metrics.angle.counts[10], 5) << "108 degrees";
  const MeshMetrics best = evaluate_metrics(quad_grid(1, 1), nullptr);
  EXPECT_EQ(best.eta.counts.back(), 1) << "eta 1 belongs to the last bin";
}

TEST(Metrics, RegistryAndValuesHaveTheSameKeys) {
  std::set<std::string> keys;
  for (const Metric& m : metric_registry()) {
    EXPECT_TRUE(keys.insert(m.key).second) << m.key;
    EXPECT_FALSE(m.title.empty() || m.source.empty()) << m.key;
    EXPECT_EQ(std::isnan(m.worst), m.better == Better::kNeither) << m.key;
  }
  for (const Mesh& mesh : {Mesh{}, quad_grid(2, 2), triangle_grid(2, 2)}) {
    const auto values = evaluate_metrics(mesh, nullptr).values;
    EXPECT_EQ(values.size(), keys.size());
    for (const auto& [key, value] : values) EXPECT_TRUE(keys.contains(key)) << key;
  }
}

}  // namespace
}  // namespace delquad
