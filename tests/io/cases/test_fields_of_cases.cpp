// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/treatment/treatment.h"
#include "features/crosses/size_aware.h"
#include "io/cases/case_file.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "smoothing/optimisation/track_optimisation.h"
#include "tests/support/files.h"
#include "tests/support/prepare_case.h"

namespace delquad {
namespace {

class Cases : public testing::Test {
 protected:
  Case read(const std::string& text) { return read_model_case(write_text(folder_ / "c.toml", text)); }
  static double size_at(const MeshingSetup& p, double x, double y) {
    int hint = -1;
    return p.size.field->at({x, y, 0}, hint);
  }
  const std::string square_ = "loop = { rectangle = [[0, 0], [1, 1]] }\n";
  Folder folder_;
};

TEST_F(Cases, Layers) {
  const std::string sides =
      "loop = { rectangle = [[0, 0], [1, 1]], boundary = ['s', 'e', 'n', 'w'] }\nsize = 0.1\n";
  const Case c = read(sides +
                      "layer = [{ on = 's', first = 0.001, number = 3 },\n"
                      "{ on = ['n', 'w'], first = 0.01, growth = 1.5, thickness = 0.1, fan = 70 }]");
  ASSERT_EQ(c.layers.size(), 2u);
  EXPECT_EQ(c.layers[0].on, Strings{"s"});
  EXPECT_EQ(c.layers[0].number, 3);
  EXPECT_EQ(c.layers[0].growth, 1.2);
  EXPECT_EQ(c.layers[1].on, (Strings{"n", "w"}));
  EXPECT_EQ(c.layers[1].thickness, 0.1);
  EXPECT_EQ(c.layers[1].fan, 70);
  EXPECT_EQ(read_files(c).layers.size(), 2u);
}

TEST_F(Cases, AFileGivesTheSize) {
  write_text(
      folder_ / "h.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
      "$Elements\n1\n1 3 2 0 1 1 2 3 4\n$EndElements\n"
      "$NodeData\n1\n\"h\"\n1\n0\n3\n0\n1\n4\n1 0.1\n2 0.2\n3 0.2\n4 0.1\n$EndNodeData\n"
      "$NodeData\n1\n\"bad\"\n1\n0\n3\n0\n1\n4\n1 0.1\n2 0.2\n3 -1\n4 0.1\n$EndNodeData\n");
  for (const char* size : {"size = 'h.msh:h'\n", "size = { base = 'h.msh:h', max = 0.5 }\n"}) {
    const MeshingSetup p = prepare_case(read(square_ + size));
    EXPECT_DOUBLE_EQ(size_at(p, 0.25, 0.7), 0.125) << size;
    EXPECT_DOUBLE_EQ(size_at(p, 3, 0.5), 0.2) << size;
  }
  const auto prepare = [&](const std::string& size) {
    prepare_case(read(square_ + "size = \"" + size + "\"\n"));
  };
  expect_input_error([&] { prepare("h.msh:bad"); }, {"the nodal size 2"});
  expect_input_error([&] { prepare("h.msh"); }, {"c.toml:2: "});
  expect_input_error([&] { prepare("none.msh"); }, {"none.msh"});
}

TEST_F(Cases, NamesHaveSizes) {
  const std::string model =
      "loop = [{ rectangle = [[0, 0], [1, 1]], boundary = ['bottom', '', 'top', ''] },\n"
      "        { circle = { centre = [0.5, 0.5], radius = 0.2 }, region = 'core' }]\n"
      "embed = { point = [0.9, 0.9], name = 'sensor' }\n[size]\nbase = 0.2\n";
  const MeshingSetup p = prepare_case(
      read(model + "on = [{ name = 'bottom', size = 0.05 }, { name = 'core', size = 0.04, growth = 0.5 },\n"
                   "      { name = 'sensor', size = 0.03, reach = 0.05 }]\n"));
  EXPECT_DOUBLE_EQ(size_at(p, 0.1, 0), 0.05);
  EXPECT_NEAR(size_at(p, 0.1, 0.1), 0.05 + 0.3 * 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(size_at(p, 0.45, 0.55), 0.04);
  EXPECT_NEAR(size_at(p, 0.5, 0.65), 0.04, 1e-12);
  EXPECT_NEAR(size_at(p, 0.2, 0.5), 0.04 + 0.5 * 0.1, 1e-4);  // the core has chords
  EXPECT_NEAR(size_at(p, 0.9, 0.86), 0.03, 1e-12);
  EXPECT_NEAR(size_at(p, 0.9, 0.75), 0.03 + 0.3 * 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(size_at(p, 0, 0.98), 0.2);
  const MeshingSetup turns =
      prepare_case(read(model + "on = { name = 'core', curvature = 48 }\ncurvature = 24\n"));
  EXPECT_NEAR(size_at(turns, 0.7, 0.5), 2 * std::numbers::pi * 0.2 / 48, 1e-4);
  EXPECT_NEAR(size_at(turns, 0.8, 0.5), 2 * std::numbers::pi * 0.2 / 48 + 0.3 * 0.1, 1e-3);
  const MeshingSetup around =
      prepare_case(read("loop = [{ circle = { centre = [0, 0], radius = 2 }, region = 'rim' },\n"
                        "        { circle = { centre = [0, 0], radius = 0.5 }, hole = true }]\n"
                        "[size]\nbase = 1\non = { name = 'rim', curvature = 48 }\nmin = 0.01\n"));
  EXPECT_NEAR(size_at(around, 0.5, 0), 2 * std::numbers::pi * 0.5 / 48, 1e-4);
  EXPECT_NEAR(size_at(around, 2, 0), 2 * std::numbers::pi * 2 / 48, 1e-3);
  const MeshingSetup all = prepare_case(read(model + "curvature = 24\nmin = 0.06\n"));
  EXPECT_NEAR(size_at(all, 0.7, 0.5), 0.06, 1e-4);
  const MeshingSetup by_number = prepare_case(read(model + "on = { name = 'curve_2', size = 0.05 }\n"));
  EXPECT_DOUBLE_EQ(size_at(by_number, 1, 0.5), 0.05);
}

TEST_F(Cases, CurvesAreDivided) {
  const std::string model =
      "loop = { rectangle = [[0, 0], [2, 1]], boundary = ['bottom', 'right', 'top', 'left'] }\nsize = 0.1\n";
  const MeshingSetup p =
      prepare_case(read(model + "divide = [{ name = 'bottom', edges = 8, progression = 1.5 },\n"
                                "          { name = 'top', edges = 30, bump = 0.25 }]\n"));
  std::vector<double> bottom, top;
  for (const Vec3& x : p.boundary.points) {
    if (x.y == 0) bottom.push_back(x.x);
    if (x.y == 1) top.push_back(x.x);
  }
  std::ranges::sort(bottom);
  std::ranges::sort(top);
  ASSERT_EQ(bottom.size(), 9u);
  for (std::size_t k = 2; k < bottom.size(); ++k)
    EXPECT_NEAR((bottom[k] - bottom[k - 1]) / (bottom[k - 1] - bottom[k - 2]), 1.5, 1e-9);
  ASSERT_EQ(top.size(), 31u);
  EXPECT_NEAR((top[1] - top[0]) / (top[16] - top[15]), 0.25, 0.02);  // no edge is in the middle
  EXPECT_NEAR(top[1] - top[0], top[30] - top[29], 1e-12);
  // Sizes near the curve are the lengths of its edges, smaller or larger.
  const MeshingSetup one =
      prepare_case(read(model + "divide = { name = 'bottom', edges = 8, progression = 1.5 }\n"));
  EXPECT_GT(size_at(one, 1.9, 0), 0.8 * (bottom[8] - bottom[7]));
  EXPECT_NEAR(size_at(one, 0, 0), bottom[1] - bottom[0], 1e-9);
  EXPECT_EQ(size_at(one, 1, 0.9), 0.1);
}

TEST_F(Cases, GridsWithCorners) {
  const std::string model =
      "loop = [{ polygon = [[0, 0], [1, -0.2], [2, 0], [2, 1], [0, 1]], region = 'house' },\n"
      "        { rectangle = [[3, 0], [4, 1]], region = 'hall' }]\n"
      "embed = { point = [2, 1], name = 'tip' }\nsize = 0.2\n";
  const auto grids = [&](const std::string& mapped) {
    int n = 0;
    for (const PatchSetup& patch : prepare_case(read(model + "mapped = " + mapped + "\n")).patches)
      n += patch.grid.has_value();
    return n;
  };
  const std::string house = "{ name = 'house', corners = [[0, 0], [2, 0], 'tip', [0, 1]] }";
  EXPECT_EQ(grids(house), 1);
  EXPECT_EQ(grids("[\"hall\", " + house + "]"), 2);
  EXPECT_EQ(grids("\"auto\""), 2);
}

TEST_F(Cases, DividedCurvesHaveCornersAndOthersAcross) {
  // Corners of a polyline and an interface that ends on it are nodes; the numbers of edges are kept.
  const MeshingSetup p =
      prepare_case(read("curve = [{ name = 'wall', polyline = [[0, 0], [1, 0.2], [2, 0]] },\n"
                        "         { name = 'rest', polyline = [[2, 0], [2, 1], [0, 1], [0, 0]] }]\n"
                        "loop = { curves = ['wall', 'rest'] }\n"
                        "embed = { segment = [[1.5, 0.1], [1.5, 1]], name = 'stiffener' }\nsize = 0.1\n"
                        "divide = [{ name = 'wall', edges = 11 }, { name = 'stiffener', edges = 5 }]\n"));
  std::vector<int> edges(p.boundary.curves.size(), 0);
  for (const int c : p.boundary.line_curve) ++edges[c];
  EXPECT_EQ(edges[0], 11);
  EXPECT_EQ(edges[2], 5);
  expect_input_error(
      [&] {
        prepare_case(
            read("curve = [{ name = 'wall', polyline = [[0, 0], [1, 0.2], [2, 0], [0, 1]] },\n"
                 "         { name = 'rest', segment = [[0, 1], [0, 0]] }]\n"
                 "loop = { curves = ['wall', 'rest'] }\nsize = 0.1\n"
                 "divide = { name = 'wall', edges = 2 }\n"));
      },
      {"3 pieces: expected at least 3"});
}

TEST_F(Cases, SourcesAndGradationShapeTheSize) {
  const MeshingSetup p =
      prepare_case(read(square_ + "[size]\nbase = 0.2\nsource = { at = [0, 0], to = [1, 0], near = 0.05, far "
                                  "= 0.2, radius_near = 0.1, radius_far = 0.4 }\n"));
  EXPECT_DOUBLE_EQ(size_at(p, 0.5, 0.05), 0.05);
  EXPECT_NEAR(size_at(p, 0.5, 0.25), 0.125, 1e-12);
  EXPECT_DOUBLE_EQ(size_at(p, 0.5, 0.9), 0.2);

  const std::string step = square_ + "[size]\nbase = 'x < 0.5 ? 0.02 : 0.2'\n";
  EXPECT_DOUBLE_EQ(size_at(prepare_case(read(step)), 0.6, 0.5), 0.2);
  EXPECT_LT(size_at(prepare_case(read(step + "gradation = 0.2\n")), 0.6, 0.5), 0.07);
}

TEST_F(Cases, CrossFieldIsCheckedAgainstEuler) {
  const MeshingSetup disk =
      prepare_case(read("loop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.1\n"));
  ASSERT_TRUE(disk.crosses.index_sum_and_expected);
  EXPECT_EQ(disk.crosses.index_sum_and_expected->first, 4);
  EXPECT_EQ(disk.crosses.index_sum_and_expected->second, 4);
  EXPECT_EQ(disk.crosses.singularities.size(), 4u);
  EXPECT_TRUE(disk.warnings.empty());
}

TEST_F(Cases, AnalyticCrosses) {
  int hint = -1;
  const MeshingSetup angle = prepare_case(read(square_ + "size = 0.1\ncross = 0.3\n"));
  EXPECT_NEAR(angle.patches[0].cross->at({0.5, 0.5}, hint).angle(), 0.3, 1e-12);
  const MeshingSetup gradient =
      prepare_case(read(square_ + "size = '0.1 + 0.01*x + 0.02*y'\ncross = 'gradient'\n"));
  hint = -1;
  EXPECT_NEAR(gradient.patches[0].cross->at({0.5, 0.5}, hint).angle(),
              std::atan2(0.02, 0.01) - std::acos(0.0), 1e-6);
}

TEST_F(Cases, SizeAwareCrossesSaveDislocations) {
  const std::string lewis = "loop = { rectangle = [[-1.25, -0.5], [1.25, 1.25]] }\n";
  const Case c = read(lewis + "size = '0.01*(1 + 30*(x - y^2)^2 + (1 - x)^2)'\ncross = 'size-aware'\n");
  const MeshingSetup p = prepare_case(c);
  ASSERT_TRUE(p.crosses.dislocations);
  EXPECT_LT(p.crosses.dislocations->second, 0.6 * p.crosses.dislocations->first);
  EXPECT_EQ(p.crosses.index_sum_and_expected, std::pair(4, 4));
  EXPECT_GT(p.crosses.singularities.size(), 4u);
  for (const char* word : {"DB", "PB"}) {
    Case aligned = c;
    aligned.cross.text = "boundary";
    const auto before = run_pipeline(prepare_case(aligned), parse_pipeline(word)).metrics.values;
    const auto after = run_pipeline(p, parse_pipeline(word)).metrics.values;
    for (const char* metric : {"eta_mean", "d4", "tau"})
      EXPECT_GT(after.at(metric), before.at(metric)) << word;
  }
}

TEST_F(Cases, RowsEndWhereCirclesDiffer) {
  const std::string ring =
      "loop = [{ circle = { centre = [0, 0], radius = 1 } }, { circle = { centre = [0, 0], radius = 0.4 } "
      "}]\n";
  // The circles' difference, and what the absolute value makes of the background mesh's noise.
  const double ends = expected_row_ends(prepare_case(read(ring + "size = 0.025\n")));
  EXPECT_NEAR(ends, 2 * std::numbers::pi * 0.6 / 0.025, 30);
  EXPECT_NEAR(expected_row_ends(prepare_case(read(square_ + "size = 0.025\n"))), 0, 1e-6);
  const MeshingSetup aware = prepare_case(read(ring + "size = 0.025\ncross = 'size-aware'\n"));
  EXPECT_GT(expected_row_ends(aware), 2 * std::numbers::pi * 0.6 / 0.025);
}

// The finer the mesh, the more rows end; the size-aware field keeps its part of them.
TEST_F(Cases, SizeAwareCrossesScaleWithTheSize) {
  const auto dislocations = [&](const std::string& factor) {
    return *prepare_case(read("loop = { rectangle = [[-1.25, -0.5], [1.25, 1.25]] }\nsize = \"" + factor +
                              "*(1 + 30*(x - y^2)^2 + (1 - x)^2)\"\ncross = \"size-aware\"\n"))
                .crosses.dislocations;
  };
  const auto coarse = dislocations("0.01"), fine = dislocations("0.0025");
  EXPECT_NEAR(fine.first, 4 * coarse.first, 0.05 * fine.first);
  EXPECT_NEAR(fine.second, 4 * coarse.second, 0.1 * fine.second);
}

TEST_F(Cases, SizeAwareCrossesOfConstantSizesFollowTheBoundary) {
  // Two patches: a square and the square inside it.
  const std::string text = square_ +
                           "pattern = { polygon = [[0.4, 0.3], [0.7, 0.4], [0.6, 0.7], [0.3, 0.6]], region = "
                           "'in', count = [1, 1], step = [0, 0] }\nsize = 0.05\n";
  const MeshingSetup aligned = prepare_case(read(text)),
                     aware = prepare_case(read(text + "cross = 'size-aware'\n"));
  ASSERT_EQ(aware.patches.size(), 2u);
  EXPECT_EQ(aware.crosses.index_sum_and_expected, aligned.crosses.index_sum_and_expected);
  EXPECT_EQ(aware.crosses.dislocations->first, aware.crosses.dislocations->second);
  for (const MeshingSetup* setup : {&aligned, &aware})
    for (const PatchSetup& patch : setup->patches)
      for (const auto& [i, j] : patch.boundary.edges) {
        int hint = -1;
        const Vec2 a = patch.boundary.points[i], b = patch.boundary.points[j];
        const Cross along = Cross::along(b - a), z = patch.cross->at(0.5 * (a + b), hint);
        EXPECT_NEAR(z.c * along.s - z.s * along.c, 0, 1e-9);
      }
}

TEST_F(Cases, OptionsReachTheStages) {
  const Case c = read(square_ +
                      "size = 0.1\ninsertion = { h_max = 1.2, rejection = 0.6 }\n"
                      "recombination = { treatment = 'none' }\n");
  const FrontalOptions insertion = insertion_options(c.options);
  EXPECT_EQ(insertion.h_max, 1.2);
  EXPECT_EQ(insertion.rejection, 0.6);
  EXPECT_EQ(recombination_options(c.options).treatment, Treatment::kNone);
  const MeshResult result = run_pipeline(prepare_case(c), parse_pipeline("FB"));
  EXPECT_TRUE(result.log.summaries.has("recombination"));
  EXPECT_FALSE(result.log.summaries.has("treatment"));
}

TEST_F(Cases, OptimisationOptionsReachTheStage) {
  const Case c = read(
      square_ + "size = 0.1\noptimisation = { passes = 1, iterations = 3, size = 0, alignment = 0.5 }\n");
  EXPECT_EQ(optimisation_options(c.options).passes, 1);
  EXPECT_EQ(optimisation_options(c.options).iterations, 3);
  EXPECT_EQ(optimisation_options(c.options).size, 0);
  EXPECT_EQ(optimisation_options(c.options).alignment, 0.5);
  const MeshResult result = run_pipeline(prepare_case(c), parse_pipeline("FBO"));
  const Summaries& done = result.log.summaries;
  ASSERT_TRUE(done.has("optimisation"));
  EXPECT_GT(done.number("optimisation", "iterations"), 0);
  EXPECT_LT(done.number("optimisation", "energy_after"), done.number("optimisation", "energy_before"));
}

TEST_F(Cases, HopelessSizesAreRefusedEarly) {
  Case c = read(square_ +
                "pattern = { circle = { centre = [0.1, 0.1], radius = 0.001 }, count = [5, 5], step = [0.2, "
                "0.2] }\nsize = 1e-6\n");
  expect_input_error([&] { prepare_case(c); }, {"c.toml:3", "1e+12 quads", "50000000"});
  c = read(square_ + "size = 0.1\n");
  c.max_elements = 99;
  expect_input_error([&] { prepare_case(c); }, {"about 100 quads", "99"});
}

TEST_F(Cases, MostPointsFollowMostElements) {
  MeshingSetup p = prepare_case(read(square_ + "size = 0.1\n"));
  p.settings.max_elements = 20;  // far less than what was checked
  expect_input_error([&] { run_pipeline(p, parse_pipeline("F")); }, {"c.toml", "stopped at 80 points", "20"});
}

TEST_F(Cases, PatchesShareTheirInterface) {
  const Case c = read(
      "size = 0.1\n[[loop]]\nrectangle = [[0, 0], [1, 1]]\n"
      "[[loop]]\ncircle = { centre = [0.5, 0.5], radius = 0.25 }\nregion = 'inside'\n"
      "[[loop]]\nrectangle = [[2, 0], [3, 1]]\n");
  for (const char* word : {"F", "D", "FB", "DB"}) {
    const MeshResult result = run_pipeline(prepare_case(c), parse_pipeline(word));
    EXPECT_EQ(check_invariants(result.mesh), Strings{}) << word;
    EXPECT_EQ(result.mesh.regions.size(), 3u);
  }
}

}  // namespace
}  // namespace delquad
