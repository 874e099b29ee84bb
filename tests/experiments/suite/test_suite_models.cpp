#include <gtest/gtest.h>

#include <set>

#include "experiments/suite/model_makers.h"
#include "experiments/suite/random.h"
#include "experiments/suite/suite_list.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

/// For names of tests.
static void PrintTo(const SuiteModel& model, std::ostream* out) { *out << model.name; }

namespace {

TEST(Suite, HasItsFamilies) {
  std::map<std::string, int> families;
  std::set<std::string> names;
  for (const SuiteModel& model : suite().models) {
    EXPECT_TRUE(names.insert(model.name).second) << model.name;
    EXPECT_EQ(model.sizes.size(), model.family == SuiteFamily::kPublic ? 1u : 3u) << model.name;
    EXPECT_FALSE(model.about.empty()) << model.name;
    ++families[name_of(model.family)];
  }
  EXPECT_EQ(
      families,
      (std::map<std::string, int>{
          {"planar", 14}, {"CAD", 14}, {"triangles", 12}, {"hard", 14}, {"metric", 14}, {"public", 80}}));
  EXPECT_EQ(suite().version, 2);
}

class SuiteModels : public ::testing::TestWithParam<SuiteModel> {};

TEST_P(SuiteModels, HaveTheirChecksum) {
  const SuiteModel& model = GetParam();
  if (model.extension == ".step" && !DELQUAD_HAS_CAD) GTEST_SKIP() << "without OpenCASCADE";
  const std::string content = make_suite_model(model);
  EXPECT_EQ(suite_digest(model, content), model.sha256);
  EXPECT_EQ(make_suite_model(model), content);
}

INSTANTIATE_TEST_SUITE_P(All, SuiteModels, ::testing::ValuesIn(select_models({})),
                         [](const auto& param) { return param.param.name; });

SuiteModel file_of_kind(const char* extension) {
  return {"", "", SuiteFamily::kHard, {}, "", extension, "", "", {}};
}

/// FIPS 180-4's own example.
TEST(SuiteDigest, IsSha256) {
  EXPECT_EQ(suite_digest(file_of_kind(".toml"), "abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(SuiteDigest, OfStepIgnoresHeaderAndLastDigits) {
  const SuiteModel step = file_of_kind(".step");
  const std::string data = "\nDATA;\n#12 = CARTESIAN_POINT('P1',(1.25,-0.,3.E-02));\n#3 = VERTEX(#12);\n";
  const std::string digest = suite_digest(step, "HEADER;" + data);
  EXPECT_EQ(suite_digest(step, "HEADER; other" + data), digest);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = data;
    changed.replace(changed.find(from), from.size(), to);
    return suite_digest(step, "HEADER;" + changed);
  };
  EXPECT_EQ(with("1.25", "1.2500000000001"), digest);
  EXPECT_EQ(with("-0.", "1.E-17"), digest);
  EXPECT_EQ(with("#12 = C", "#12 = \nC"), digest);
  EXPECT_NE(with("1.25", "1.25001"), digest);
  EXPECT_NE(with("3.E-02", "3.E-03"), digest);
  EXPECT_NE(with("#12)", "#13)"), digest);
  EXPECT_NE(with("P1", "P2"), digest);
}

/// SplitMix64 from 1234567: the first number is 6457827717110365317.
TEST(SuiteRandom, IsSplitMix) {
  Random random(1234567);
  EXPECT_EQ(random.between(0, 1), static_cast<double>(6457827717110365317u >> 11) / 9007199254740992.0);
}

/// Of a triangulation by the edges of its triangles.
struct Shape {
  int euler = 0, open = 0, wrong = 0;
};

Shape shape_of(const Mesh& mesh) {
  Shape shape;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  int edges = 0;
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    ++edges;
    shape.open += edge.size() == 1;
    shape.wrong += edge.size() > 2 || (edge.size() == 2 && edge[0].forward == edge[1].forward);
  });
  shape.euler = static_cast<int>(mesh.points.size() + mesh.triangles.size()) - edges;
  return shape;
}

double volume(const Mesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six += dot(mesh.points[a], cross(mesh.points[b], mesh.points[c]));
  return six / 6;
}

TEST(SuiteTriangles, AreManifoldsOfTheirGenus) {
  const std::map<std::string, int> euler = {{"sphere_noisy", 2}, {"sphere_graded", 2}, {"torus_noisy", 0},
                                            {"torus_holes", -4}, {"knot", 0},          {"washer", 0},
                                            {"star_prism", 2},   {"genus3", -4},       {"genus3_noisy", -4},
                                            {"blobs", 2},        {"terrain", 1},       {"terrain_holes", -3}};
  const std::set<std::string> open = {"torus_holes", "terrain", "terrain_holes"};
  for (const SuiteMaker<Mesh>& model : triangle_suite_models()) {
    if (!euler.contains(model.name)) continue;  // of the family hard
    const Mesh mesh = model.make();
    const Shape shape = shape_of(mesh);
    EXPECT_EQ(shape.euler, euler.at(model.name)) << model.name;
    EXPECT_EQ(shape.open > 0, open.contains(model.name)) << model.name;
    EXPECT_EQ(shape.wrong, 0) << model.name;
    EXPECT_TRUE(open.contains(model.name) || volume(mesh) > 0) << model.name;
  }
}

}  // namespace
}  // namespace delquad
