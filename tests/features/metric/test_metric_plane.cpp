// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

MeshProblem square(double side = 1) {
  return problem_of(polygons({{{0, 0}, {side, 0}, {side, side}, {0, side}}}));
}

MeshProblem by_sizes(MeshProblem problem, const std::string& h1, const std::string& h2,
                     const std::string& theta = "0") {
  problem.metric.sizes = {h1, h2, theta};
  return problem;
}

double value(const MeshResult& result, const char* key) { return result.metrics.values.at(key); }

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& v : mesh.quads) {
    const Vec3 d1 = mesh.points[v[2]] - mesh.points[v[0]], d2 = mesh.points[v[3]] - mesh.points[v[1]];
    sum += cross(d1, d2).z / 2;
  }
  return sum;
}

// hx = 0.1 and rows that grow from the middle: a structured grid of the unit square.
TEST(MetricPlane, LinearLayersAreAGrid) {
  for (const char* h0 : {"0.001", "0.0001"}) {
    const MeshResult result =
        mesh(by_sizes(square(), "0.1", std::string(h0) + "+2*(0.1-" + h0 + ")*abs(y-0.5)"), "good");
    EXPECT_TRUE(result.soundness.sound());
    EXPECT_EQ(value(result, "n_irregular"), 0);
    EXPECT_EQ(value(result, "metric_in_range"), 100);
    EXPECT_GT(value(result, "metric_eta_worst"), 0.99);
    EXPECT_EQ(value(result, "n_triangles"), 0);
    EXPECT_NEAR(area(result.mesh), 1, 1e-12);
  }
}

// A constant metric along the axes: 5 by 100 rectangles, all alike.
TEST(MetricPlane, AConstantMetricIsAGridOfEqualRectangles) {
  const MeshResult result = mesh(by_sizes(square(), "0.2", "0.01"), "DB");
  ASSERT_EQ(result.mesh.quads.size(), 500u);
  EXPECT_NEAR(value(result, "metric_eta_worst"), 1, 1e-6);
  EXPECT_NEAR(value(result, "metric_edge_min"), 1, 1e-6);
  EXPECT_NEAR(value(result, "metric_edge_max"), 1, 1e-6);
  EXPECT_NEAR(result.prepared->size.expected_quads, 500, 1);
}

TEST(MetricPlane, TheComplexityIsTheNumberOfQuads) {
  MeshProblem problem = by_sizes(square(), "1", "1+10*x", "0.5+y");
  problem.metric.complexity = 800;
  EXPECT_NEAR(prepare(problem)->size.expected_quads, 800, 16);
  // Boundaries that do not follow the axes need more; by sizes that are larger there are as many as are
  // asked.
  problem.quads = 800;
  const MeshResult result = mesh(problem, "good");
  EXPECT_NEAR(static_cast<double>(result.mesh.quads.size()), 800, 24);
  EXPECT_GT(value(result, "metric_in_range"), 80);
  problem.quads.reset();
  problem.refine = 2;
  EXPECT_GT(value(mesh(problem, "good"), "metric_tau"), 85);
}

// Nodes of the outline lie on the true circle although the flat plane knows a polygon.
TEST(MetricPlane, NodesLieOnTheTrueCurves) {
  const MeshProblem problem =
      by_sizes(problem_of(ModelMaker().circle({0, 0}, 1, "outer", "ring").circle({0.2, 0}, 0.3, "inner")),
               "0.02+0.1*abs(y)", "0.15", "pi/2");
  const MeshResult result = mesh(problem, "good");
  ASSERT_TRUE(result.soundness.sound());
  for (std::size_t l = 0; l < result.mesh.lines.size(); ++l)
    for (const int v : result.mesh.lines[l]) {
      const Vec3 p = result.mesh.points[v];
      const bool is_inner = result.mesh.curves[result.mesh.line_curve[l]].names.at(0) == "inner";
      EXPECT_NEAR(is_inner ? std::hypot(p.x - 0.2, p.y) : std::hypot(p.x, p.y), is_inner ? 0.3 : 1, 1e-14);
    }
  EXPECT_GT(value(result, "metric_eta_mean"), 0.8);
}

MeshProblem ring(double outer, double inner) {
  return problem_of(ModelMaker().circle({0, 0}, outer, "outer", "ring").circle({0, 0}, inner, "inner"));
}

// Rows that are thinner than the sagitta of their length, and a hole that is smaller than all lengths. Sides
// along bends become shorter, and lengths grow from there on.
TEST(MetricPlane, BendsAndSmallHolesStayUpright) {
  for (const MeshProblem& problem :
       {by_sizes(ring(1, 0.5), "0.0005+0.2*(sqrt(x^2+y^2)-0.5)", "0.05", "atan2(y,x)"),
        by_sizes(ring(1, 0.001), "0.2", "0.04")}) {
    const MeshResult result = mesh(problem, "good");
    EXPECT_TRUE(result.soundness.sound());
    EXPECT_GT(value(result, "metric_eta_worst"), 0.2);
    EXPECT_GT(value(result, "metric_in_range"), 85);
  }
}

// Regions side by side, one of them twice on the same curve, and a line inside of one.
TEST(MetricPlane, RegionsAndEmbeddedCurvesStay) {
  const MeshProblem problem =
      problem_of(ModelMaker()
                     .loop({make_polyline({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}})}, "a", {"left"})
                     .loop({make_polyline({{1, 1}, {1, 0}, {2, 0}, {2, 1}, {1, 1}})}, "b", {"right"})
                     .curve(make_segment({0.2, 0.3}, {0.8, 0.6}), "inside")
                     .point({1.5, 0.25}, "spot"));
  const MeshResult result = mesh(by_sizes(problem, "0.1", "0.02+0.05*y"), "good");
  ASSERT_TRUE(result.soundness.sound());
  EXPECT_NEAR(area(result.mesh), 2, 1e-12);
  EXPECT_EQ(result.mesh.regions.size(), 2u);
  EXPECT_NEAR(length_named(result.mesh, "inside"), std::hypot(0.6, 0.3), 1e-12);
  ASSERT_EQ(result.mesh.named_points.size(), 1u);
  EXPECT_NEAR(norm(result.mesh.points[result.mesh.named_points[0].point] - Vec3{1.5, 0.25, 0}), 0, 1e-9);
}

// A shock that is a hundred times thinner than the largest quads.
TEST(MetricPlane, FollowsASolutionAndStaysUpright) {
  MeshProblem problem = square();
  problem.metric.solution = "tanh(50*(x^2+y^2-0.5))";
  problem.metric.gradation = 1.5;
  problem.metric.complexity = 1000;
  for (const CrossKind kind : {CrossKind::kSizeAware, CrossKind::kMetric}) {
    problem.cross.kind = kind;
    const MeshResult result = mesh(problem, "DBCO");
    EXPECT_TRUE(result.soundness.sound());
    EXPECT_EQ(value(result, "n_inverted"), 0);
    EXPECT_GT(value(result, "metric_eta_mean"), 0.85);
    EXPECT_GT(value(result, "metric_in_range"), 90);
    EXPECT_NEAR(value(result, "n_quads"), 1000, 60);
  }
}

TEST(MetricPlane, CrossesGoAlongTheAxesWhereTheyAreAsked) {
  MeshProblem problem = by_sizes(square(4), "0.2", "0.05", "0.3");
  problem.cross.kind = CrossKind::kBoundary;
  const double without = value(mesh(problem, "DB"), "metric_aligned");
  problem.cross.kind = CrossKind::kMetric;
  EXPECT_GT(value(mesh(problem, "DB"), "metric_aligned"), without + 5);
}

TEST(MetricPlane, WithoutDirectionsItIsASize) {
  MeshProblem by_size = square();
  by_size.size.field = make_expression_size("0.05+0.1*x");
  MeshProblem by_metric = square();
  by_metric.metric.function = [](std::span<const Vec2> points, std::span<Tensor2> metric) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double h = 0.05 + 0.1 * points[i].x;
      metric[i] = {1 / (h * h), 0, 1 / (h * h)};
    }
  };
  const Mesh a = mesh(by_size, "good").mesh, b = mesh(by_metric, "good").mesh;
  ASSERT_EQ(a.quads, b.quads);
  for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_LT(norm(a.points[i] - b.points[i]), 1e-9);
}

// For constants to the last bit, around a hole that is smaller, too.
TEST(MetricPlane, AConstantWithoutDirectionsIsThatSize) {
  for (const char* h : {"0.1", "0.25"}) {
    MeshProblem by_size = ring(1, 0.05);
    by_size.size.text = h;
    const Mesh expected = mesh(by_size, "good").mesh,
               found = mesh(by_sizes(ring(1, 0.05), h, h), "good").mesh;
    EXPECT_EQ(expected.points, found.points);
    EXPECT_EQ(expected.quads, found.quads);
  }
}

// Limits, a complexity and the gradation of a metric are those which the size has.
TEST(MetricPlane, WithoutDirectionsItsLimitsAreThoseOfASize) {
  const std::string h = "0.01+abs(x-0.5)";
  MeshProblem problem = by_sizes(square(), h, h);
  problem.metric.limits = {.min = 0.02, .max = 0.1};
  problem.metric.gradation = std::exp(0.2);
  MeshProblem by_size = square();
  by_size.size.text = "max(0.02, min(0.1, " + h + "))";
  by_size.size.gradation = 0.2;
  const Mesh expected = mesh(by_size, "good").mesh, found = mesh(problem, "good").mesh;
  ASSERT_EQ(expected.quads, found.quads);
  for (std::size_t i = 0; i < found.points.size(); ++i)
    EXPECT_LT(norm(expected.points[i] - found.points[i]), 1e-9);
  problem.metric.sizes = {"0.02+0.3*x^2", "0.02+0.3*x^2", "0"};
  problem.metric.complexity = 800;
  EXPECT_NEAR(prepare(problem)->size.expected_quads, 800, 24);
}

// Rows whose height is a hundredth of their length, and elements with nodes on the true circles, of which one
// closes but for rounding.
TEST(MetricPlane, CurvedElementsOfThinRowsAreProven) {
  MeshProblem problem = by_sizes(ring(1, 0.5), "0.001+0.2*(sqrt(x^2+y^2)-0.5)", "0.1", "atan2(y,x)");
  std::get<PlanarModel>(problem.model).curves[1].shape = make_parametric_curve(
      [](double t) {
        return Vec2{0.5 * std::cos(t), 0.5 * std::sin(t)};
      },
      0, 2 * std::numbers::pi);
  problem.metric.gradation = 2;
  for (const int order : {2, 3}) {
    problem.order = order;
    problem.seed = order == 3 ? 5 : 0;
    const MeshResult result = mesh(problem, "good");
    ASSERT_TRUE(result.soundness.sound());
    const Mesh& made = result.mesh;
    EXPECT_EQ(proven_jacobians(made).unproven, 0);
    ASSERT_EQ(made.order, order);
    for (std::size_t l = 0; l < made.lines.size(); ++l)
      for (int k = 0; k < order - 1; ++k) {
        const Vec3& p = made.points[made.line_nodes[l * (order - 1) + k]];
        const bool is_inner = made.curves[made.line_curve[l]].names.at(0) == "inner";
        EXPECT_NEAR(std::hypot(p.x, p.y), is_inner ? 0.5 : 1, 1e-9);
      }
  }
}

TEST(MetricPlane, ASeedTurnsTheMeshAndNotTheDomain) {
  MeshProblem problem = by_sizes(square(), "0.1", "0.02");
  problem.seed = 3;
  const MeshResult result = mesh(problem, "DB");
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_NEAR(area(result.mesh), 1, 1e-12);
  for (const Vec3& p : result.mesh.points) EXPECT_TRUE(p.x > -1e-12 && p.x < 1 + 1e-12 && p.y > -1e-12);
}

TEST(MetricPlane, SameBytesForEveryNumberOfThreads) {
  MeshProblem problem = by_sizes(square(), "0.05", "0.01+0.1*x", "y");
  const Mesh one = mesh(problem, "good", {.threads = 1}).mesh,
             two = mesh(problem, "good", {.threads = 2}).mesh;
  EXPECT_EQ(one.quads, two.quads);
  EXPECT_EQ(one.points, two.points);
}

TEST(MetricPlane, RefusesWhatIsNoMetricWithItsPlace) {
  const auto meshed = [](const std::array<std::string, 3>& tensor) {
    MeshProblem problem = square();
    problem.metric.tensor = {tensor.begin(), tensor.end()};
    problem.metric.where = "model.toml:7";
    mesh(problem, "DB");
  };
  expect_input_error(
      [&] {
        meshed({"1", "2", "1"});
      },
      {"model.toml:7", "[1, 2, 1] (m11, m12, m22) at (0, 0)"});
  expect_input_error([&] { meshed({"100/(x-0.3)*abs(x-0.3)", "0", "100"}); }, {"m11, m12, m22) at ("});
  expect_input_error([&] { meshed({"sqrt(x-0.5)", "0", "1"}); }, {"nan, 0, 1]"});
  expect_input_error([&] { meshed({"1e24", "0", "1"}); }, {"[1e+24, 0, 1]", "differ"});
  expect_input_error([&] { meshed({"1e12", "0", "1e12"}); }, {"1e+12 quads", "max-elements"});
  MeshProblem negative = by_sizes(square(), "0.1", "0.5-y");
  negative.metric.where = "model.toml:7";
  expect_refused(negative, "DB", {"model.toml:7", "h2 -0.5", "at (1, 1)"});
  expect_input_error([&] { meshed({"1", "0", "z"}); }, {"model.toml:7", "z"});
}

// Two triangles with h = 0.1 x 0.02, as Mmg writes them and as a view of Gmsh.
TEST(MetricPlane, ReadsTensorsFromFiles) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  write("a.mesh",
        "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        "Triangles\n2\n1 2 3 1\n1 3 4 1\nEnd\n");
  const std::string head = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n";
  const std::string sol =
      write("a.sol", head + "4\n1 3\n100 0 2500\n100 0 2500\n100 0 2500\n100 0 2500\nEnd\n");
  std::string view = "$NodeData\n1\n\"M\"\n1\n0\n3\n0\n9\n4\n";
  for (int i = 1; i <= 4; ++i) view += std::to_string(i) + " 100 0 0 0 2500 0 0 0 1\n";
  const std::string msh =
      write("a.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
            "$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n" +
                view + "$EndNodeData\n");
  // BAMG beside the same mesh, and VTU with its orders of components, at points and cells.
  const std::string rows = "100 0 2500\n100 0 2500\n100 0 2500\n100 0 2500\n";
  const std::string mtr = write("a.mtr", "4 3\n" + rows), metric = write("a.metric", "4 3\n" + rows);
  const auto vtu = [&](const char* name, bool is_of_points, int n, const std::string& tensor) {
    std::string values;
    for (int i = 0; i < (is_of_points ? 4 : 2); ++i) values += tensor + "\n";
    const std::string data = is_of_points ? "PointData" : "CellData";
    return write(
        name,
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
        "NumberOfCells=\"2\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 1 1 0 "
        "0 "
        "1 0</DataArray></Points><Cells><DataArray Name=\"connectivity\">0 1 2 0 2 3</DataArray><DataArray "
        "Name=\"offsets\">3 6</DataArray><DataArray Name=\"types\">5 5</DataArray></Cells><" +
            data + "><DataArray Name=\"M\" NumberOfComponents=\"" + std::to_string(n) + "\">" + values +
            "</DataArray></" + data + "></Piece></UnstructuredGrid></VTKFile>");
  };
  const std::string three = vtu("3.vtu", true, 3, "100 2500 0"),
                    four = vtu("4.vtu", false, 4, "100 0 0 2500"),
                    six = vtu("6.vtu", false, 6, "100 2500 7 0 0 0"),
                    nine = vtu("9.vtu", true, 9, "100 0 0 0 2500 0 0 0 7");
  for (const std::string& file : {sol, msh, msh + ":M"}) {
    MeshProblem problem = square();
    problem.metric.file = file;
    EXPECT_NEAR(prepare(problem)->size.expected_quads, 500, 1) << file;
  }
  for (const std::string& file : {mtr, metric, three, four, six, nine}) {
    const Vec2 at{0.5, 0.25};
    Tensor2 m;
    make_file_metric(file, file.ends_with(".vtu") ? "M" : "")({&at, 1}, {&m, 1});
    EXPECT_NEAR(m.xx, 100, 1e-9) << file;
    EXPECT_NEAR(m.xy, 0, 1e-9) << file;
    EXPECT_NEAR(m.yy, 2500, 1e-9) << file;
  }
  const auto refused = [&](const std::string& text, const char* says) {
    MeshProblem problem = square();
    problem.metric.file = write("a.sol", text);
    expect_refused(problem, "DB", {says});
  };
  refused(head + "3\n1 3\n1 0 1\n1 0 1\n1 0 1\nEnd\n", "values of 3 points: expected 4");
  refused(head + "4\n1 1\n1\n1\n1\n1\nEnd\n", "expected one of type 3");
  refused(head + "4\n1 3\n1 2 1\n1 0 1\n1 0 1\n1 0 1\n", "[1, 2, 1] (m11, m12, m22) at (0, 0)");
  refused("MeshVersionFormatted 2\n", "no SolAtVertices");
  const auto refused_file = [&](const std::string& file, std::initializer_list<const char*> parts) {
    expect_input_error([&] { make_file_metric(file); }, parts);
  };
  refused_file(write("a.mtr", "3 3\n" + rows), {"a.mtr:1: values of 3 points: expected 4"});
  refused_file(write("a.mtr", "4 1\n1\n1\n1\n1\n"), {"a.mtr:1: 1 numbers at each point: expected 3"});
  refused_file(write("a.mtr", "4 3\nnan 0 1\n" + rows), {"a.mtr:2: ", "nan"});
  refused_file(vtu("5.vtu", true, 5, "1 1 1 1 1"), {"M", "5 components: expected 3, 4, 6, 9"});
  refused_file(vtu("bad.vtu", true, 3, "1 1 2"), {"bad.vtu", "[1, 2, 1] (m11, m12, m22) at (0, 0)"});
  refused_file(vtu("few.vtu", true, 4, "1 0 1"), {"few.vtu: data array 'M': 12 values for 4 points"});
}

TEST(MetricPlane, RefusesWhatDoesNotGoWithIt) {
  MeshProblem problem = by_sizes(square(), "0.1", "0.2");
  MeshProblem other = problem;
  other.size.field = make_constant_size(0.1);
  expect_refused(other, "DB", {"a size does", "not go with a metric"});
  other = problem;
  other.symmetry.automatic = true;
  expect_refused(other, "DB", {"planes of symmetry"});
  other = problem;
  other.metric.gradation = 0.5;
  expect_refused(other, "DB", {"gradation 0.5", "above 1"});
  other = problem;
  other.metric.limits = {.min = 2, .max = 1};
  expect_refused(other, "DB", {"min 2 is above max 1"});
  other = problem;
  other.model = ExampleModel{"torus"};
  expect_refused(other, "DB", {"of a surface"});
  other = square();
  other.size.field = make_constant_size(0.1);
  other.cross.kind = CrossKind::kMetric;
  expect_refused(other, "DB", {"there is no metric"});
}

}  // namespace
}  // namespace delquad
