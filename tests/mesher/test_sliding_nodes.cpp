// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/case_file.h"
#include "io/mesh_io.h"
#include "tests/support/meshing.h"
#include "tests/support/prepare_case.h"

namespace delquad {
namespace {

class SlidingNodes : public testing::Test {
 protected:
  Case read(const std::string& text, long long seed = 0) {
    Case c = read_model_case(write_text(folder_ / "c.toml", text));
    c.seed = seed;
    return c;
  }
  static Mesh run(const MeshingSetup& prepared) { return meshed(prepared, "DBO").mesh; }
  TemporaryFolder folder_;
};

TEST_F(SlidingNodes, StayOnTheCirclesThatRegionsShare) {
  const Case c = read(
      "loop = [{ circle = { centre = [0, 0], radius = 1 } },\n"
      "        { circle = { centre = [0, 0], radius = 0.5 }, region = \"core\" }]\nsize = 0.09\n",
      3);
  const MeshingSetup prepared = prepare_case(c);
  const Mesh mesh = run(prepared);
  int moved = 0;
  for (const auto& line : mesh.lines)
    for (const int v : line) {
      const double r = norm(mesh.points[v]);
      EXPECT_LT(std::min(std::abs(r - 1), std::abs(r - 0.5)), 1e-12);
      moved += norm(mesh.points[v] - prepared.boundary.points[v]) > 1e-4;
    }
  EXPECT_GT(moved, 10);
  EXPECT_EQ(mesh.lines, prepared.boundary.lines);
}

TEST_F(SlidingNodes, GivenLinesAreKept) {
  const Case model = read("loop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.1\n");
  const std::filesystem::path lines = folder_ / "lines.msh";
  write_mesh(lines, prepare_case(model).boundary);
  const Case c = read_model_case(lines);
  const MeshingSetup prepared = prepare_case(c);
  const Mesh mesh = run(prepared);
  ASSERT_FALSE(mesh.quads.empty());
  for (std::size_t v = 0; v < prepared.boundary.points.size(); ++v)
    EXPECT_EQ(mesh.points[v], prepared.boundary.points[v]);
}

}  // namespace
}  // namespace delquad
