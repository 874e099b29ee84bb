// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

constexpr double kSize = 0.5, kHigh = 0.2, kLong = 12;
constexpr int kLayers = 5;

Vec2 on_interface(int i, double x) { return {x, i * kHigh + 0.3 * std::sin(0.5 * x)}; }

/// Layers of less than half the size between a slanted fault and a straight one. The middle one is cut in two
/// wedges of one degree.
PlanarModel stack_of_layers() {
  ModelMaker model;
  const auto add = [&](std::shared_ptr<const Curve> shape, const std::string& name) {
    model.curve(std::move(shape), name);
    return static_cast<int>(model.curves.size()) - 1;
  };
  const auto from = [](int i) { return 0.8 * i * kHigh; };
  const auto spline = [&](int i, int to) {
    std::vector<Vec2> points;
    for (int k = 0; k <= 48; ++k) {
      const double t = k / 48.0, x = from(i) + t * (kLong - from(i));
      points.push_back((1 - t) * on_interface(i, x) + t * on_interface(to, x));
    }
    return make_spline(points);
  };
  std::vector<int> interfaces, left, right;
  for (int i = 0; i <= kLayers; ++i)
    interfaces.push_back(add(spline(i, i), "interface_" + std::to_string(i)));
  for (int i = 0; i < kLayers; ++i) {
    left.push_back(add(make_segment(on_interface(i, from(i)), on_interface(i + 1, from(i + 1))), "fault"));
    right.push_back(add(make_segment(on_interface(i, kLong), on_interface(i + 1, kLong)), "end"));
  }
  const int cut = kLayers / 2;
  for (int i = 0; i < kLayers; ++i) {
    const std::string name = "layer_" + std::to_string(i);
    if (i != cut) model.loop_of({interfaces[i], right[i], interfaces[i + 1], left[i]}, name);
  }
  const int wedge = add(spline(cut, cut + 1), "wedge");
  return model.loop_of({interfaces[cut], right[cut], wedge}, "lower")
      .loop_of({wedge, interfaces[cut + 1], left[cut]}, "upper");
}

MeshProblem problem_of(PlanarModel model, const std::string& thin) {
  MeshProblem problem = problem_of(std::move(model), kSize);
  problem.options.set("curves.thin", thin);
  return problem;
}

std::vector<Vec3> nodes_on(const Mesh& mesh, const std::string& name) {
  std::vector<Vec3> nodes;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (mesh.curves[mesh.line_curve[l]].names == std::vector{name})
      for (const int v : mesh.lines[l]) nodes.push_back(mesh.points[v]);
  return nodes;
}

/// How far nodes of interfaces are from facing one of the next, in sizes: the mean away from the ends.
double mean_offset(const Mesh& mesh) {
  double sum = 0;
  int n = 0;
  for (int i = 0; i < kLayers; ++i) {
    const auto next = nodes_on(mesh, "interface_" + std::to_string(i + 1));
    if (i == kLayers / 2) continue;
    for (const Vec3& x : nodes_on(mesh, "interface_" + std::to_string(i))) {
      if (x.x < 3 || x.x > kLong - 2) continue;
      const double slope = 0.15 * std::cos(0.5 * x.x);
      double least = std::numeric_limits<double>::infinity();
      for (const Vec3& y : next)
        least = std::min(least, std::abs(y.x - x.x + slope * (y.y - x.y)) / std::hypot(1, slope));
      sum += least / kSize;
      ++n;
    }
  }
  return sum / n;
}

TEST(ThinRows, OfAStackFaceEachOther) {
  MeshProblem by_size = problem_of(stack_of_layers(), "refine");
  by_size.options.set("curves.agreement", 0.0);
  const MeshResult refined = mesh(by_size, "DBCO");
  const MeshResult rows = mesh(problem_of(stack_of_layers(), "rows"), "DBCO");
  EXPECT_TRUE(rows.mesh.triangles.empty());
  // Behind wedges nodes come from two rows to one.
  EXPECT_LT(mean_offset(rows.prepared->boundary), 0.06);
  EXPECT_LT(mean_offset(rows.mesh), 0.06);
  EXPECT_GT(rows.metrics.values.at("scaled_jacobian_mean"), 0.9);
  EXPECT_GT(rows.metrics.values.at("scaled_jacobian_mean"),
            refined.metrics.values.at("scaled_jacobian_mean"));
  EXPECT_GT(rows.metrics.values.at("scaled_jacobian_min"), std::sin(0.9 * std::numbers::pi / 180));
}

/// Long waves of a block with three thin layers in its middle; all is symmetric and periodic.
PlanarModel block() {
  ModelMaker model;
  const auto add = [&](std::shared_ptr<const Curve> shape, const std::string& name, int i) {
    model.curve(std::move(shape), name + std::to_string(i));
  };
  const std::vector<double> heights{0, 20, 23, 26, 30, 60};
  const int n = static_cast<int>(heights.size()) - 1;
  const auto at = [&](int i, double x) {
    return Vec2{x, heights[i] + (i % n == 0 ? 0 : 1.5 * std::cos(std::numbers::pi * x / 100))};
  };
  for (int i = 0; i <= n; ++i) {
    std::vector<Vec2> points;
    for (int x = 0; x <= 200; x += 10) points.push_back(at(i, x));
    add(make_spline(points), "interface_", i);
  }
  for (int i = 0; i < n; ++i) add(make_segment(at(i, 0), at(i + 1, 0)), "left_", i);
  for (int i = 0; i < n; ++i) add(make_segment(at(i, 200), at(i + 1, 200)), "right_", i);
  for (int i = 0; i < n; ++i)
    model.loop_of({i, 2 * n + 1 + i, i + 1, n + 1 + i}, "layer_" + std::to_string(i));
  return model;
}

TEST(ThinRows, GoWithDivisionsPeriodicSidesMirrorsAndGrids) {
  MeshProblem divided, periodic, mirrored, grids;
  divided.divisions = {{"interface_2", 31}};
  for (int i = 0; i < 5; ++i)
    periodic.periodic.push_back(
        {"left_" + std::to_string(i), "right_" + std::to_string(i), {.shift = {200, 0, 0}}});
  periodic.periodic.push_back({"interface_0", "interface_5", {.shift = {0, 60, 0}}});
  mirrored.symmetry.planes = {{{100, 0, 0}, {1, 0, 0}}};
  grids.mapped.names = {"layer_2", "layer_4"};
  for (const auto& [problem, least] :
       {std::pair(&divided, 0.95), {&periodic, 0.99}, {&mirrored, 0.99}, {&grids, 0.99}}) {
    problem->model = block();
    problem->size.field = make_constant_size(8);
    const MeshResult refined = mesh(*problem, "DBCO");
    problem->options.set("curves.thin", std::string("rows"));
    const MeshResult rows = mesh(*problem, "DBCO");
    EXPECT_TRUE(rows.soundness.sound());
    EXPECT_GT(rows.metrics.values.at("scaled_jacobian_mean"), least);
    // Thin faces of surfaces have single rows anyway.
    if (problem != &mirrored) {
      EXPECT_GT(rows.metrics.values.at("scaled_jacobian_mean"),
                refined.metrics.values.at("scaled_jacobian_mean"));
    }
    EXPECT_EQ(rows.mesh.periodic.size(), problem->periodic.size());
    if (problem == &divided) {
      EXPECT_EQ(nodes_on(rows.mesh, "interface_2").size(), 2 * 31u);
    }
  }
}

TEST(ThinRows, EndInWedgesWithoutFlatQuads) {
  for (const double degrees : {0.6, 2.0, 5.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec2 tip{0, 0}, low{30, 0}, high{30 * std::cos(angle), 30 * std::sin(angle)};
    const PlanarModel model = ModelMaker().polygon({tip, low, high}, {"low", "end", "high"}, "wedge");
    const MeshResult result = mesh(problem_of(model, "rows"), "DBCO");
    EXPECT_TRUE(result.soundness.sound());
    double at_tip = 1, elsewhere = 1;
    for (const auto& quad : result.mesh.quads) {
      bool has_tip = false;
      double least = 1;
      for (int k = 0; k < 4; ++k) {
        const Vec3 x = result.mesh.points[quad[k]], a = result.mesh.points[quad[(k + 1) % 4]] - x,
                   b = result.mesh.points[quad[(k + 3) % 4]] - x;
        least = std::min(least, cross(a, b).z / (norm(a) * norm(b)));
        has_tip = has_tip || norm(x) < 1e-9;
      }
      double& of = has_tip ? at_tip : elsewhere;
      of = std::min(of, least);
    }
    EXPECT_NEAR(at_tip, std::sin(angle), 0.01 * std::sin(angle)) << degrees;
    EXPECT_GT(elsewhere, 0.3) << degrees;
  }
}

/// Half a ring of width 2 on a cone: its arcs want 9 and 16 edges.
TEST(ThinRows, OfNarrowFacesDoNotEnd) {
  const SurfaceModel face = testing_support::grid_surface({.nu = 60, .nv = 6}, [](double u, double v) {
    const double angle = std::numbers::pi * (1 - u), radius = 3 + 2 * v;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), 0.3 * radius};
  });
  const auto irregular = [&](const std::string& thin) {
    MeshProblem problem = problem_of(TriangleModel{face.fine}, 1);
    problem.options.set("curves.thin", thin);
    const MeshResult result = mesh(problem, "DBQO");
    EXPECT_TRUE(result.soundness.sound());
    return result.metrics.values.at("n_irregular");
  };
  EXPECT_GT(irregular("refine"), 0);
  EXPECT_EQ(irregular("rows"), 0);
}

TEST(ThinRows, AreTheSameForAnyNumberOfThreads) {
  const MeshResult one = mesh(problem_of(stack_of_layers(), "rows"), "DBCO", {.threads = 1});
  const MeshResult three = mesh(problem_of(stack_of_layers(), "rows"), "DBCO", {.threads = 3});
  ASSERT_EQ(one.mesh.quads, three.mesh.quads);
  for (std::size_t i = 0; i < one.mesh.points.size(); ++i)
    EXPECT_EQ(norm(one.mesh.points[i] - three.mesh.points[i]), 0);
}

TEST(ThinRows, RefuseWhatCannotBe) {
  Options options;
  expect_input_error([&] { options.set("curves.thin", std::string("columns")); }, {"curves.thin", "rows"});
  expect_input_error([&] { options.set("curves.aspect", 0.5); }, {"curves.aspect", "1 to 100"});
  expect_input_error([&] { options.set("curves.gap_rows", -1LL); }, {"curves.gap_rows"});
}

/// A circle with a hole off its middle: the gap is between 0.1 and .9.
PlanarModel channel() {
  return ModelMaker().circle({0, 0}, 1.5, "outer", "gap").circle({0.4, 0}, 1, "inner");
}

TEST(GapRows, FitBetweenArcs) {
  MeshProblem problem = problem_of(channel(), "refine");
  const MeshResult wide = mesh(problem, "DBCO");
  problem.options.set("curves.gap_rows", 3LL);
  const MeshResult fine = mesh(problem, "DBCO");
  // Across the narrowest place, along y = 0 from x = 1.4 to 1.5: quads whose boxes it crosses.
  const auto across = [](const Mesh& m) {
    int n = 0;
    for (const auto& quad : m.quads) {
      double low = 1e9, high = -1e9, left = 1e9;
      for (const int v : quad) {
        low = std::min(low, m.points[v].y), high = std::max(high, m.points[v].y);
        left = std::min(left, m.points[v].x);
      }
      n += low <= 0.001 && high > 0.001 && left > 1.3;
    }
    return n;
  };
  EXPECT_LT(across(wide.mesh), 3);
  EXPECT_GE(across(fine.mesh), 3);
  EXPECT_GT(fine.metrics.values.at("scaled_jacobian_mean"), wide.metrics.values.at("scaled_jacobian_mean"));
  const auto told = [](const MeshResult& result) {
    return std::ranges::count_if(result.warnings, [](const Warning& w) {
      return w.text.find("rows of quads in gaps") < w.text.size();
    });
  };
  problem.options.set("curves.gap_rows", 30LL);
  EXPECT_EQ(told(mesh(problem, "D")), 1);
  EXPECT_EQ(told(wide), 0);
}

/// The first edges of the holes are too long to show how near these are.
TEST(GapRows, FitBetweenSmallHoles) {
  MeshProblem problem =
      problem_of(ModelMaker().rectangle({0, 0}, {60, 40}).circle({25, 20}, 5).circle({36, 20}, 5), 4);
  problem.options.set("curves.gap_rows", 3LL);
  const Mesh made = mesh(problem, "DBCO").mesh;
  const auto between = std::ranges::count_if(made.quads, [&](const std::array<int, 4>& quad) {
    const auto has = [&](double sign) {
      return std::ranges::any_of(quad, [&](int v) { return sign * (made.points[v].y - 20.01) > 0; });
    };
    return has(1) && has(-1) &&
           std::ranges::all_of(quad, [&](int v) { return std::abs(made.points[v].x - 30.5) < 0.8; });
  });
  EXPECT_GE(between, 3);
}

/// A plate of triangles, half a size thick: quads across the middle of a rim.
TEST(GapRows, FitBetweenCurvesOfFaces) {
  constexpr double kThick = 0.1, kMiddle = 0.401;
  MeshProblem problem = problem_of(TriangleModel{testing_support::box(4, 1, 0.8, kThick), "plate"});
  problem.size.field = make_constant_size(2 * kThick);
  const auto across = [&](long long rows) {
    problem.options.set("curves.gap_rows", rows);
    const Mesh made = mesh(problem, "DBCO").mesh;
    return std::ranges::count_if(made.quads, [&](const std::array<int, 4>& quad) {
      const auto at = [&](double sign) {
        return std::ranges::any_of(quad, [&](int v) { return sign * (made.points[v].y - kMiddle) > 0; });
      };
      return at(1) && at(-1) && std::ranges::all_of(quad, [&](int v) { return made.points[v].x == 0; });
    });
  };
  EXPECT_EQ(across(0), 1);
  EXPECT_GE(across(3), 3);
}

/// Lines that are kept get no rows, and no wedges are cut from them.
TEST(ThinRows, LeaveGivenLinesAlone) {
  Mesh lines;
  const double high = 8 * std::tan(3 * std::numbers::pi / 180);
  for (int k = 0; k <= 16; ++k) lines.points.push_back({0.5 * k, 0, 0});
  for (int k = 16; k > 0; --k) lines.points.push_back({0.5 * k, high * k / 16, 0});
  const int n = static_cast<int>(lines.points.size());
  for (int i = 0; i < n; ++i) {
    lines.lines.push_back({i, (i + 1) % n});
    lines.line_curve.push_back(0);
  }
  lines.curves = {{1, {}}};
  const auto quads = [&](const std::string& thin) {
    MeshProblem problem = problem_of(LineModel{lines, {}, "wedge"});
    problem.allow_unsound = true;
    problem.options.set("curves.thin", thin);
    return mesh(problem, "DB").mesh.quads.size();
  };
  EXPECT_EQ(quads("rows"), quads("refine"));
}

}  // namespace
}  // namespace delquad
