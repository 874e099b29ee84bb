#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {
namespace {

/// The unit cube as twelve triangles.
const std::string kCube =
    "OFF\n8 12 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 "
    "4 7\n";

TEST(SurfaceModels, ACubeBecomesItsGrid) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube;
  const auto run = delquad({"mesh", folder / "cube.off", "-o", folder / "cube.msh", "--size", "0.125",
                            "--json", folder / "cube.json", "--curves", "all"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Mesh mesh = read_mesh(folder / "cube.msh");
  EXPECT_EQ(mesh.quads.size(), 6u * 64);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_EQ(mesh.points.size(), mesh.quads.size() + 2);  // Euler: a closed surface of genus 0
  EXPECT_EQ(mesh.regions.size(), 6u);
  EXPECT_EQ(mesh.curves.size(), 12u);
  // What was written is a model again.
  const auto again = delquad({"mesh", folder / "cube.msh", "-o", folder / "again.msh", "--size", "0.25"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("384 quads"), std::string::npos) << again.err;
  EXPECT_EQ(read_mesh(folder / "again.msh").quads.size(), 6u * 16);
}

TEST(SurfaceModels, EveryNumberOfThreadsGivesTheSameBytes) {
  const TemporaryFolder folder;
  // A slab of 4 x 3 pillars of many heights: 64 faces of many sizes.
  std::ofstream off(folder / "slab.off");
  off << "OFF\n" << 8 * 12 << " " << 12 * 12 << " 0\n";
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 8; ++k)
      off << 2 * (i % 4) + (k & 1) << " " << 2 * (i / 4) + ((k >> 1) & 1) << " " << (k >> 2) * (1 + 0.3 * i)
          << "\n";
  for (int i = 0; i < 12; ++i)
    for (const char* t : {"0 2 1", "1 2 3", "4 5 6", "5 7 6", "0 1 4", "1 5 4", "2 6 3", "3 6 7", "0 4 2",
                          "2 4 6", "1 3 5", "3 7 5"})
      off << "3 " << 8 * i + t[0] - '0' << " " << 8 * i + t[2] - '0' << " " << 8 * i + t[4] - '0' << "\n";
  off.close();
  std::string first;
  for (const char* threads : {"1", "2", "4"}) {
    const auto run = delquad({"mesh", folder / "slab.off", "-o", folder / "slab.msh", "--size", "0.13",
                              "--threads", threads, "--json", folder / "slab.json", "-v"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string bytes = read_text(folder / "slab.msh");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads << " threads";
    const std::string record = read_text(folder / "slab.json");
    for (const char* step : {"read", "maps", "curves", "fields", "insertion", "matching", "treatment",
                             "projection", "metrics", "write"}) {
      EXPECT_TRUE(contains(record, "\"" + std::string(step) + "\": ")) << step;
      EXPECT_TRUE(contains(run.out, step)) << step;
    }
  }
  EXPECT_EQ(delquad({"mesh", folder / "slab.off", "-o", folder / "x.msh", "--size", "1", "--threads", "0"})
                .exit_code,
            2);
}

TEST(SurfaceModels, ExperimentsTakeThem) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube;
  std::ofstream(folder / "e.toml")
      << "title = \"cube\"\npipelines = [\"D\", \"DB\"]\n[[case]]\nname = \"cube\"\n"
         "model = \"cube.off\"\nsize = 0.25\n";
  const auto run = delquad({"run", folder / "e.toml", "-o", folder / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* file : {"mesh.msh", "mesh.vtu", "picture.svg", "record.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out/cube/DB" / file)) << file;
  }
}

TEST(SurfaceModels, BadOnesAreRefusedWithTheirName) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube.substr(0, 60);
  std::ofstream(folder / "part.step") << "ISO-10303-21;\nnonsense\n";
  for (const char* name : {"cube.off", "part.step"}) {
    const auto run = delquad({"mesh", folder / name, "-o", folder / "out.msh", "--size", "0.1"});
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_TRUE(contains(run.err, name)) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.msh"));
  }
}

TEST(SurfaceModels, ASizeIsNeeded) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube;
  const auto run = delquad({"mesh", folder / "cube.off", "-o", folder / "out.msh"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(contains(run.err, "size")) << run.err;
}

TEST(SurfaceModels, ASizeLargerThanTheModelGivesOneQuadAFace) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube;
  const auto run = delquad({"mesh", folder / "cube.off", "-o", folder / "out.msh", "--size", "1e6"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "curve 1 is 1e-06 times the size long")) << run.err;
  EXPECT_EQ(read_mesh(folder / "out.msh").quads.size(), 6u);
}

TEST(SurfaceModels, TheReportIsPrintedAndRecorded) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube;
  const auto run = delquad({"mesh", folder / "cube.off", "-o", folder / "out.msh", "--size", "0.25", "--json",
                            folder / "out.json", "--keep-going", "-v"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(contains(
      run.out, "mesh: watertight, Euler characteristic 2; the model is watertight, Euler characteristic 2"))
      << run.out;
  std::ifstream in(folder / "out.json");
  std::stringstream record;
  record << in.rdbuf();
  for (const char* part :
       {"\"nonconforming_edges\": 0", "\"worst_face\": 1", "\"mesh_to_surface\"", "\"by_patch\""})
    EXPECT_TRUE(contains(record.str(), part)) << part;
}

/// A sphere of radius 1 as an octahedron split a few times.
std::string sphere_off(int n) {
  std::string points, faces;
  int n_points = 0, n_faces = 0;
  for (int octant = 0; octant < 8; ++octant) {
    const auto node = [&](int i, int j) {
      double x = i, y = j, z = n - i - j;
      const double r = std::sqrt(x * x + y * y + z * z);
      x *= (octant & 1 ? -1 : 1) / r, y *= (octant & 2 ? -1 : 1) / r, z *= (octant & 4 ? -1 : 1) / r;
      points += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
      return n_points++;
    };
    const bool turned = std::popcount(static_cast<unsigned>(octant)) % 2 == 1;
    const auto add = [&](int a, int b, int c) {
      if (turned) std::swap(b, c);
      faces += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
      ++n_faces;
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        add(node(i, j), node(i + 1, j), node(i, j + 1));
        if (i + j + 1 < n) add(node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
      }
  }
  return "OFF\n" + std::to_string(n_points) + " " + std::to_string(n_faces) + " 0\n" + points + faces;
}

TEST(SurfaceModels, SizesFollowCurvature) {
  const TemporaryFolder folder;
  std::ofstream(folder / "ball.off") << sphere_off(8);
  const auto quads = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"mesh", folder / "ball.off", "-o", folder / "ball.msh"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = delquad(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return static_cast<double>(read_mesh(folder / "ball.msh").quads.size());
  };
  // Area 4 pi over the square of a turn's part.
  const double exact = 4 * 3.14159 / std::pow(2 * 3.14159 / 24, 2);
  EXPECT_NEAR(quads({"--size", "1", "--curvature", "24"}), exact, 0.25 * exact);
  EXPECT_NEAR(quads({"--size-max", "1", "--curvature", "24", "--size-min", "0.5"}), 4 * 3.14159 / 0.25, 20);
  EXPECT_GT(quads({"--size", "0.1 + 0.4*abs(z)", "--gradation", "0.2"}),
            quads({"--size", "0.1 + 0.4*abs(z)"}));
}

TEST(SurfaceModels, SourcesHaveThreeCoordinates) {
  const TemporaryFolder folder;
  std::ofstream(folder / "ball.off") << sphere_off(8);
  const auto quads_near =
      [&](const std::string& at, double z) {
        std::ofstream(folder / "e.toml")
            << "pipelines = [\"DB\"]\n[[case]]\nname = \"ball\"\nmodel = \"ball.off\"\nsize = { base = 0.3, "
               "source = [{ at = "
            << at << ", near = 0.05, far = 0.3, radius_near = 0.2, radius_far = 0.6 }], gradation = 0.5 }\n";
        const auto run = delquad({"run", folder / "e.toml", "-o", folder / "out"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        const Mesh mesh = read_mesh(folder / "out/ball/DB/mesh.msh");
        return std::ranges::count_if(mesh.points, [&](const Vec3& p) { return std::abs(p.z - z) < 0.1; });
      };
  EXPECT_GT(quads_near("[0, 0, 1]", 1), 5 * quads_near("[0, 0, -1]", 1));
}

TEST(SurfaceModels, SizesThatMeanNothingAreRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.off") << kCube;
  std::ofstream(folder / "square.toml") << kSquare;
  const auto refused = [&](const std::string& model, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"mesh", folder / model, "-o", folder / "x.msh"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = delquad(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "x.msh"));
    return run.err;
  };
  EXPECT_TRUE(contains(refused("cube.off", {"--size", "boundary"}), "'boundary'"));
  EXPECT_TRUE(contains(refused("cube.off", {"--curvature", "24"}), "needs a size"));
  EXPECT_TRUE(contains(refused("cube.off", {"--size", "1", "--size-min", "0.1"}), "'curvature'"));
  EXPECT_TRUE(
      contains(refused("cube.off", {"--size-max", "1", "--curvature", "9", "--size-min", "2"}), "larger"));
  refused("cube.off", {"--size", "1", "--curvature", "2"});
  refused("cube.off", {"--size", "1", "--gradation", "0"});
  refused("cube.off", {"--size", "1", "--size-max", "nan"});
}

}  // namespace
}  // namespace delquad::testing_support
