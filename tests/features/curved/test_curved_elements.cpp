// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/warning.h"
#include "features/curved/untangle_curved.h"
#include "geometry/mesh/element_nodes.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

MeshProblem curved_problem(Model model, int order, double size) {
  MeshProblem problem = problem_of(std::move(model), size);
  problem.order = order;
  return problem;
}

PlanarModel coarse_disc() { return ModelMaker().circle({0, 0}, 1); }

/// Two arcs leave the origin in the same direction.
PlanarModel cusp_of_arcs() {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto first = make_arc({0, 2}, 2, -90 * kDegree, -60 * kDegree);
  return ModelMaker().loop({first, make_segment(first->point(1), {std::cos(30 * kDegree), 0.5}),
                            make_arc({0, 1}, 1, -30 * kDegree, -90 * kDegree)});
}

double least_proven_of(const Mesh& mesh) {
  double least = 1;
  for (const JacobianBounds& b : jacobian_bounds(mesh)) least = std::min(least, b.proven);
  return least;
}

TEST(CurvedElements, QuadsWithFlatCornersOnACircleGetRings) {
  for (const double size : {1.0, 1.4})
    for (const int order : {2, 3}) {
      const MeshResult result = mesh(curved_problem(coarse_disc(), order, size), "DBCO");
      EXPECT_GT(result.log.summaries.get<long long>("flat_corners", "rings"), 0) << size << ", " << order;
      EXPECT_GT(least_proven_of(result.mesh), 0.2) << size << ", " << order;
      EXPECT_TRUE(check_invariants(result.mesh).empty());
      EXPECT_EQ(result.log.summaries.get<double>("curving", "least_elsewhere"), least_proven_of(result.mesh));
    }
}

TEST(CurvedElements, ACuspIsProvenAndToldApart) {
  for (const int order : {2, 3}) {
    const MeshResult result = mesh(curved_problem(cusp_of_arcs(), order, 0.1), "DBCO");
    EXPECT_EQ(result.log.summaries.find("refine_unsound"), nullptr) << order;
    EXPECT_GT(least_proven_of(result.mesh), 0) << order;
    EXPECT_EQ(result.log.summaries.get<long long>("curving", "below"), 1) << order;
    EXPECT_EQ(result.log.summaries.get<long long>("curving", "in_corners"), 1) << order;
    EXPECT_GT(result.log.summaries.get<double>("curving", "least_elsewhere"), kLowJacobian) << order;
    EXPECT_TRUE(is_reported(result.warnings, "corners of the model that allow no more"));
  }
}

/// Radians between the chords of a line's halves.
double turn_of_line(const Mesh& m, std::size_t line) {
  const std::vector<int> v = nodes_of_line(m, line);
  const Vec3 a = m.points[v[1]] - m.points[v[0]], b = m.points[v[2]] - m.points[v[1]];
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

TEST(CurvedElements, NoEdgeIsAHalfCircle) {
  // Chords of halves turn by half of what the edge does: by a right angle on a half circle.
  const MeshResult curved = mesh(curved_problem(ExampleModel{"cross_drilled"}, 2, 40), "DBCO");
  double most = 0;
  for (std::size_t l = 0; l < curved.mesh.lines.size(); ++l)
    most = std::max(most, turn_of_line(curved.mesh, l));
  EXPECT_LT(most, 0.9 * std::numbers::pi / 2);
  const MeshResult straight = mesh(curved_problem(ExampleModel{"cross_drilled"}, 1, 40), "DBCO");
  EXPECT_LT(straight.mesh.lines.size(), curved.mesh.lines.size());
}

TEST(CurvedElements, ThreadsDoNotMatter) {
  const MeshProblem problem = curved_problem(cusp_of_arcs(), 3, 0.3);
  Context one, two;
  one.threads = 1, two.threads = 2;
  const Mesh a = mesh(problem, "DBCO", one).mesh, b = mesh(problem, "DBCO", two).mesh;
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.quad_nodes, b.quad_nodes);
}

TEST(CurvedElements, MetricsAreThoseOfTheVerticesThatMoved) {
  const MeshResult result = mesh(curved_problem(coarse_disc(), 2, 1), "DBCO");
  EXPECT_EQ(result.metrics.values.at("n_quads"), static_cast<double>(result.mesh.quads.size()));
  EXPECT_TRUE(result.soundness.sound());
}

}  // namespace
}  // namespace delquad
