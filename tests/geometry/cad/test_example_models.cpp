// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

using std::numbers::pi;

/// Tolerance of areas and volumes against closed forms: the triangulation is as fine as 0.15 radians.
constexpr double kFineExample = 4e-3;

std::filesystem::path write_file(const TemporaryFolder& folder, const std::string& name, CadFormat format) {
  const auto path = folder / (name + (format == CadFormat::kStep ? ".step" : ".brep"));
  std::ofstream out(path, std::ios::binary);
  write_example(name, format, out);
  return path;
}

struct ShapeCounts {
  const char* name;
  std::size_t faces, curves, corners;
  int euler;
  std::size_t free_curves = 0;
  std::map<std::string, int> named = {};  ///< faces by name
};

void PrintTo(const ShapeCounts& topology, std::ostream* out) { *out << topology.name; }

std::size_t count_free_curves(const Mesh& mesh) {
  std::set<std::pair<int, int>> free;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) free.insert({edge[0].lo, edge[0].hi});
  });
  std::set<int> curves;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (free.count(std::minmax(mesh.lines[l][0], mesh.lines[l][1]))) curves.insert(mesh.line_curve[l]);
  return curves.size();
}

std::map<std::string, int> face_names(const Mesh& mesh) {
  std::map<std::string, int> names;
  for (const Entity& region : mesh.regions)
    for (const std::string& name : region.names) ++names[name];
  return names;
}

void expect_topology(const SurfaceModel& model, const ShapeCounts& expected) {
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  expect_sound(model);
  EXPECT_EQ(model.fine.regions.size(), expected.faces);
  EXPECT_EQ(model.fine.curves.size(), expected.curves);
  EXPECT_EQ(model.corners.size(), expected.corners);
  const SurfaceCounts n = count(model.fine);
  EXPECT_EQ(n.euler, expected.euler);
  EXPECT_EQ(n.crowded_sides, 0);
  EXPECT_EQ(count_free_curves(model.fine), expected.free_curves);
  EXPECT_EQ(n.free_sides == 0, expected.free_curves == 0);
  // Nothing had to be healed or turned; open ones are said to be open.
  EXPECT_EQ(model.warnings.size(), expected.free_curves > 0 ? 1u : 0u);
  for (const Warning& warning : model.warnings) EXPECT_EQ(warning.text.find("the surface is open"), 0u);
  if (expected.free_curves == 0) {
    EXPECT_GT(n.volume, 0);
  }
}

class ExampleModels : public ::testing::TestWithParam<ShapeCounts> {};

TEST_P(ExampleModels, AreWholeByEveryWay) {
  const TemporaryFolder folder;
  const ShapeCounts& expected = GetParam();
  expect_topology(read_cad(write_file(folder, expected.name, CadFormat::kBrep)), expected);
  for (const SurfaceModel& model :
       {read_cad(write_file(folder, expected.name, CadFormat::kStep)), read_example(expected.name)}) {
    expect_topology(model, expected);
    std::map<std::string, int> names = expected.named;
    names[expected.name] = static_cast<int>(expected.faces);  // the product
    EXPECT_EQ(face_names(model.fine), names);
  }
}

TEST_P(ExampleModels, AreTheSameBytesEachTime) {
  for (const CadFormat format : {CadFormat::kStep, CadFormat::kBrep}) {
    std::ostringstream first, second;
    write_example(GetParam().name, format, first);
    write_example(GetParam().name, format, second);
    EXPECT_TRUE(first.str() == second.str());
  }
}

const std::vector<ShapeCounts> kTopologies = {
    // Genus 5. The bent plate has 36 curves; holes, bore and boss add 13 closed ones.
    {"bracket", 22, 49, 24, -8, 0, {{"base", 1}, {"body", 16}, {"bore", 1}, {"holes", 4}}},
    // 7 x 4 corners of patches and the two ends of slivers inside of sides.
    {"hood", 18, 47, 30, 1, 20},
    {"pipe_tee", 2, 4, 0, -1, 3, {{"pipe", 1}, {"branch", 1}}},
    {"sphere", 1, 0, 0, 2},
    {"torus", 1, 0, 0, 0},
    {"wing_body", 8, 14, 10, 2, 0, {{"fuselage", 2}, {"tips", 2}, {"wing", 4}}},
    // Two pipes with a fillet outside, two inside, three ends; genus 2.
    {"blended_tee", 8, 9, 0, -2, 0},
    {"cone_tip", 5, 6, 2, 0, 0},
    {"cross_drilled", 11, 26, 14, -6, 0},
    // Two straight parts and a bend outside and inside, two ends.
    {"elbow", 8, 8, 0, 0, 0},
    // A fin has 5 faces, 12 curves and 8 corners; the tube 4 faces and 4 curves; a fin cuts its seam in two
    // places.
    {"fins", 9 * 5 + 4, 9 * 12 + 4 + 2, 9 * 8 + 2, 0, 0},
    {"free_form", 1, 11, 11, -2, 11},
    // Four sides and two ends.
    {"loft", 6, 12, 8, 2, 0},
    // Two bends, and of the outline two sides of each face, a step and two ends; six holes.
    {"sheet", 3, 18, 10, -5, 16},
    // Five sides outside and the rim, five of each space inside, six holes in walls.
    {"thin_box", 6 + 4 * 5 + 6, 72, 40, 2 - 2 * 6, 0},
    // A block's six sides, four fillets, a hole.
    {"variable_fillet", 6 + 4 + 1, 26, 16, 0, 0},
};

INSTANTIATE_TEST_SUITE_P(All, ExampleModels, ::testing::ValuesIn(kTopologies),
                         [](const auto& param) { return param.param.name; });

TEST(ExampleModels, AreAllListedAndTested) {
  std::vector<std::string> listed, tested;
  for (const Example& example : example_models()) listed.push_back(example.name);
  for (const ShapeCounts& topology : kTopologies) tested.push_back(topology.name);
  EXPECT_EQ(listed, tested);
}

TEST(ExampleModels, RoundOnesHaveTheirAreaAndVolume) {
  const SurfaceCounts sphere = count(read_example("sphere").fine), torus = count(read_example("torus").fine);
  EXPECT_NEAR(sphere.area / (4 * pi * 100), 1, kFineExample);
  EXPECT_NEAR(sphere.volume / (4 * pi * 1000 / 3), 1, 2 * kFineExample);
  EXPECT_NEAR(torus.area / (4 * pi * pi * 20 * 8), 1, kFineExample);
  EXPECT_NEAR(torus.volume / (2 * pi * pi * 20 * 64), 1, 2 * kFineExample);
}

TEST(ExampleModels, BracketHasItsVolume) {
  const double plate = 60 * ((80 - 16) * 8 + (66 - 16) * 8 + pi / 4 * (16 * 16 - 8 * 8));
  const double spandrel = 1 - pi / 4;  // between a quarter of a unit circle and its square
  const double corners = 2 * 8 * spandrel * (10 * 10 + 15 * 15);
  const double centroid = (10 - 3 * pi) / (12 - 3 * pi);  // of the spandrel, from the square's sides
  const double fillet = 2 * pi * (15 + 3 * centroid) * spandrel * 3 * 3;
  const double holes = pi * (9 * 9 * 16 + 4 * 4 * 4 * 8);
  const double volume = plate - corners + pi * 15 * 15 * 8 + fillet - holes;
  EXPECT_NEAR(count(read_example("bracket").fine).volume / volume, 1, kFineExample);
}

TEST(ExampleModels, PipeTeeHasItsArea) {
  constexpr double kPipe = 20, kBranch = 15, kLength = 120, kHeight = 60;
  constexpr int kSamples = 1000;
  double area = 2 * pi * kPipe * kLength + 2 * pi * kBranch * kHeight;
  for (int k = 0; k < kSamples; ++k) {
    const double phi = 2 * pi * (k + 0.5) / kSamples, y = kBranch * std::sin(phi);
    const double z = std::sqrt(kPipe * kPipe - y * y);                    // where the pipes meet
    area -= 2 * pi / kSamples * kBranch * z;                              // of the branch, inside the pipe
    area -= 2 * pi / kSamples * (kBranch * kBranch - y * y) * kPipe / z;  // of the pipe, inside the branch
  }
  EXPECT_NEAR(count(read_example("pipe_tee").fine).area / area, 1, kFineExample);
}

TEST(ExampleModels, WingBodyIsSymmetricWithSharpTrailingEdges) {
  const Mesh mesh = read_example("wing_body").fine;
  double area_left = 0, area_right = 0, span = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
    (p.y + q.y + r.y > 0 ? area_left : area_right) += norm(cross(q - p, r - p)) / 2;
    span = std::max(span, p.y);
  }
  EXPECT_NEAR(area_left / area_right, 1, kFineExample);
  EXPECT_NEAR(span, 50, 1e-6);
  double sharpest = pi;  // between the sides of the surface
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    std::array<Vec3, 2> normal;
    for (const std::size_t k : {0, 1}) {
      const auto& [a, b, c] = mesh.triangles[edge[k].element];
      normal[k] = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    }
    const double cosine = dot(normal[0], normal[1]) / (norm(normal[0]) * norm(normal[1]));
    sharpest = std::min(sharpest, pi - std::acos(std::clamp(cosine, -1.0, 1.0)));
  });
  EXPECT_NEAR(sharpest, 2 * std::atan(0.10 / 0.65), 0.03);
}

TEST(ExampleModels, HoodIsSmoothWithTwoSliversOnItsOutline) {
  const Mesh mesh = read_example("hood").fine;
  std::vector<double> length(mesh.curves.size(), 0);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    length[mesh.line_curve[l]] += norm(mesh.points[mesh.lines[l][0]] - mesh.points[mesh.lines[l][1]]);
  std::ranges::sort(length);
  for (const int k : {0, 1}) EXPECT_NEAR(length[k], 1.2, 0.01);
  EXPECT_GT(length[2], 100);
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) return;
    std::array<Vec3, 2> normal;
    for (const std::size_t k : {0, 1}) {
      const auto& [a, b, c] = mesh.triangles[edge[k].element];
      normal[k] = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    }
    constexpr double kSmooth = 0.2;  // radians: of the triangulation
    EXPECT_GT(dot(normal[0], normal[1]), std::cos(kSmooth) * norm(normal[0]) * norm(normal[1]));
  });
}

TEST(ExampleModels, UnknownOnesAreRefused) {
  const std::initializer_list<const char*> parts = {"unknown example 'brackett'", "known: bracket, hood, "};
  std::ostringstream out;
  expect_input_error([&] { write_example("brackett", CadFormat::kStep, out); }, parts);
  expect_input_error([] { read_example("brackett"); }, parts);
}

}  // namespace
}  // namespace delquad
