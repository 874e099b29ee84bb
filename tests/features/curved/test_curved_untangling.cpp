// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/curved_geometry.h"
#include "features/curved/raise_order.h"
#include "features/curved/untangle_curved.h"
#include "geometry/mesh/element_nodes.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kOuter = 1, kInner = 0.5;

/// Between two circles around the origin; curve 0 is the outer one.
class RingGeometry final : public ModelGeometry {
 public:
  explicit RingGeometry(const Mesh& mesh) : mesh_(mesh) {}
  std::vector<Vec3> on_line(int line, std::span<const double> parts) const override {
    const Vec3 &a = mesh_.points[mesh_.lines[line][0]], &b = mesh_.points[mesh_.lines[line][1]];
    const double from = std::atan2(a.y, a.x),
                 turn = std::remainder(std::atan2(b.y, b.x) - from, 2 * std::numbers::pi);
    std::vector<Vec3> points;
    for (const double part : parts) {
      const double angle = from + part * turn;
      points.push_back(norm(a) * Vec3{std::cos(angle), std::sin(angle), 0});
    }
    return points;
  }
  std::optional<Vec3> on_curve(int curve, const Vec3& x) const override {
    return ((curve == 0 ? kOuter : kInner) / norm(x)) * x;
  }
  bool slides(int) const override { return true; }
  Vec3 on_face(int, const Vec3& x) const override { return x; }

 private:
  const Mesh& mesh_;
};

Mesh ring(int order) {
  MeshProblem problem = ModelMaker().circle({0, 0}, kOuter).circle({0, 0}, kInner).problem(0.25);
  problem.order = order;
  problem.options.set("curves.agreement", 0.0);  // no grid
  return mesh(problem, "DBCO").mesh;
}

double least_proven(const std::vector<JacobianBounds>& bounds) {
  return std::ranges::min(bounds, {}, &JacobianBounds::proven).proven;
}

UntanglingSummary untangle(Mesh& mesh, std::vector<JacobianBounds>& bounds, std::vector<int> stay = {}) {
  const Mesh given = mesh;
  const RingGeometry geometry(given);
  return untangle_curved(mesh, geometry, {std::vector<double>(mesh.quads.size(), 1), std::move(stay)},
                         bounds);
}

TEST(CurvedUntangling, NodesOfLinesSlideAlongTheirCurve) {
  for (const int order : {2, 3}) {
    Mesh m = ring(order);
    const std::vector<int> line = nodes_of_line(m, 0);
    const Vec3 a = m.points[line.front()], b = m.points[line.back()];
    const double radius = norm(a);
    // All nodes between its ends come next to the first of them.
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
      const Vec3 x = a + ((order == 2 ? 0.12 : 0.04) * static_cast<double>(k)) * (b - a);
      m.points[line[k]] = (radius / norm(x)) * x;
    }
    std::vector<JacobianBounds> bounds = jacobian_bounds(m);
    ASSERT_LT(least_proven(bounds), kPoorJacobian) << order;
    const UntanglingSummary summary = untangle(m, bounds);
    EXPECT_GT(summary.improved, 0);
    EXPECT_GT(least_proven(bounds), kPoorJacobian) << order;
    EXPECT_GT(least_proven(jacobian_bounds(m)), kPoorJacobian) << order;
    for (std::size_t l = 0; l < m.lines.size(); ++l)
      for (const int v : nodes_of_line(m, l))
        EXPECT_NEAR(norm(m.points[v]), m.line_curve[l] == 0 ? kOuter : kInner, 1e-12);
  }
}

/// A vertex inside of the face comes so near to the opposite corner of a quad that this is almost a triangle.
int squeeze(Mesh& m) {
  m = ring(1);
  std::vector<char> on_line(m.points.size(), 0);
  for (const auto& line : m.lines)
    for (const int v : line) on_line[v] = 1;
  int squeezed = -1;
  for (const auto& quad : m.quads)
    for (int k = 0; k < 4 && squeezed < 0; ++k)
      if (!on_line[quad[k]]) {
        squeezed = quad[k];
        const Vec3& opposite = m.points[quad[(k + 2) % 4]];
        m.points[squeezed] = opposite + 0.46 * (m.points[squeezed] - opposite);
      }
  const Mesh given = m;
  raise_order(m, 2, RingGeometry(given));
  return squeezed;
}

TEST(CurvedUntangling, VerticesMoveWhereNodesAloneDoNotHelp) {
  Mesh m;
  const int squeezed = squeeze(m);
  const Vec3 before = m.points[squeezed];
  std::vector<JacobianBounds> bounds = jacobian_bounds(m);
  ASSERT_LT(least_proven(bounds), kLowJacobian);
  const UntanglingSummary summary = untangle(m, bounds);
  EXPECT_TRUE(summary.moved_vertices);
  EXPECT_GT(least_proven(jacobian_bounds(m)), kLowJacobian);
  EXPECT_GT(norm(m.points[squeezed] - before), 0);
  for (std::size_t l = 0; l < m.lines.size(); ++l)
    for (const int v : nodes_of_line(m, l))
      EXPECT_NEAR(norm(m.points[v]), m.line_curve[l] == 0 ? kOuter : kInner, 1e-12);
}

TEST(CurvedUntangling, NodesThatStayDoNotMove) {
  Mesh m;
  const int squeezed = squeeze(m);
  const Vec3 before = m.points[squeezed];
  std::vector<JacobianBounds> bounds = jacobian_bounds(m);
  untangle(m, bounds, {squeezed});
  EXPECT_EQ(m.points[squeezed], before);
}

TEST(CurvedUntangling, NothingMovesWhereNothingIsPoor) {
  Mesh m = ring(2);
  const std::vector<Vec3> before = m.points;
  std::vector<JacobianBounds> bounds = jacobian_bounds(m);
  const UntanglingSummary summary = untangle(m, bounds);
  EXPECT_EQ(summary.poor, 0);
  EXPECT_EQ(m.points, before);
}

TEST(CurvedUntangling, EnoughIsStillABound) {
  const Mesh m = ring(3);
  for (std::size_t q = 0; q < m.quads.size(); ++q) {
    std::vector<Vec3> places;
    for (const int v : nodes_of_quad(m, q)) places.push_back(m.points[v]);
    const JacobianBounds close = element_bounds(places, 3), rough = element_bounds(places, 3, 0.2);
    EXPECT_LE(rough.proven, close.found);
    EXPECT_GE(rough.proven, 0.2);
  }
}

TEST(CurveCorners, AnglesAreThoseOfTheCurves) {
  // A half disc in one quad: two right angles at the diameter's ends, two flat ones on the arc.
  Mesh m;
  constexpr double kThird = std::numbers::pi / 3;
  for (int k = 0; k <= 3; ++k) m.points.push_back({std::cos(k * kThird), std::sin(k * kThird), 0});
  m.quads = {{0, 1, 2, 3}};
  m.quad_region = {0};
  m.regions = {{1, {}}};
  m.curves = {{1, {}}, {2, {}}};
  m.lines = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  m.line_curve = {0, 0, 0, 1};
  class HalfDisc final : public ModelGeometry {
   public:
    std::vector<Vec3> on_line(int line, std::span<const double> parts) const override {
      std::vector<Vec3> points;
      for (const double part : parts) {
        const double angle = (line + part) * kThird;
        points.push_back(line == 3 ? Vec3{2 * part - 1, 0, 0} : Vec3{std::cos(angle), std::sin(angle), 0});
      }
      return points;
    }
    std::optional<Vec3> on_curve(int, const Vec3& x) const override { return x; }
    bool slides(int) const override { return false; }
    Vec3 on_face(int, const Vec3& x) const override { return x; }
  };
  const std::vector<CurveCorner> corners = curve_corners(m, HalfDisc());
  ASSERT_EQ(corners.size(), 4u);
  const double right = std::numbers::pi / 2;
  for (const CurveCorner& c : corners)
    EXPECT_NEAR(c.angle, c.corner == 0 || c.corner == 3 ? right : 2 * right, 1e-4);
}

}  // namespace
}  // namespace delquad
