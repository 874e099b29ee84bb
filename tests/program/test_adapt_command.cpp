#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/grid_mesh.h"

namespace delquad::testing_support {
namespace {

PointData two_fields(const Mesh& mesh) {
  PointData data;
  for (const Vec3& p : mesh.points) {
    data["u"].push_back(std::tanh(10 * (p.x + p.y - 1)));
    data["w"].push_back(p.x > 0.5 ? 1 : 0);
  }
  return data;
}

TEST(AdaptCommand, ASolutionAndTheNextMesh) {
  const TemporaryFolder folder;
  const Mesh mesh = quad_grid(16, 16);
  for (const auto& [name, next] : {std::pair("a.vtu", "b.msh"), {"a.msh", "b.vtu"}}) {
    write_point_data(folder / name, mesh, two_fields(mesh));
    const ProgramResult result =
        delquad({"adapt", (folder / name).string() + ":u", "--quads", "500", "-o", folder / next,
                 "--goal-weight", "w", "--h-max", "0.3", "--quality", "fast"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "u: error ")) << result.out;
    EXPECT_TRUE(contains(result.out, "estimated by 256 elements; expected ")) << result.out;
    const PointField made = read_point_field(folder / next, "");
    EXPECT_NEAR(static_cast<double>(made.mesh.quads.size()), 500, 60);
    EXPECT_EQ(made.mesh.curves[0].names[0], "south");
    const std::vector<double>& u = made.components.at("u");
    for (std::size_t i = 0; i < u.size(); ++i) {
      const Vec3& p = made.mesh.points[i];
      EXPECT_NEAR(u[i], std::tanh(10 * (p.x + p.y - 1)), 0.1);
    }
  }
}

TEST(AdaptCommand, ModelsAndOtherFormats) {
  const TemporaryFolder folder;
  const Mesh mesh = quad_grid(16, 16);
  write_point_data(folder / "a.vtu", mesh, two_fields(mesh));
  const auto model = write_text(folder / "m.toml", kSquare + "size = 0.25\n");
  const std::string u = (folder / "a.vtu").string() + ":u";
  const ProgramResult result = delquad({"adapt", u, "--error", "0.03", "--norm", "inf", "--model", model,
                                        "-o", folder / "b.inp", "--transfer", "bounded", "--isotropic"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "maximum of interpolation")) << result.out;
  const PointField beside = read_point_field(folder / "b.vtu", "u");
  EXPECT_EQ(beside.mesh.quads.size(), read_mesh(folder / "b.inp").quads.size());
  EXPECT_EQ(beside.mesh.curves[0].names[0], "bottom");
  const auto layered =
      write_text(folder / "l.toml", kSquare + "[[layer]]\non = \"left\"\nfirst = 0.01\nnumber = 3\n");
  EXPECT_TRUE(
      contains(delquad({"adapt", u, "--quads", "300", "--model", layered, "-o", folder / "c.msh"}).err,
               "layers do not go with a metric"));
}

TEST(AdaptCommand, WrongFields) {
  const TemporaryFolder folder;
  const Mesh mesh = quad_grid(4, 4), other = quad_grid(5, 5);
  PointData data = two_fields(mesh);
  data["bad"].assign(25, 0);
  data["bad"][12] = std::numeric_limits<double>::quiet_NaN();
  data["flat"].assign(25, 3);
  write_point_data(folder / "a.vtu", mesh, data);
  write_point_data(folder / "b.msh", other, two_fields(other));
  write_mesh(folder / "c.vtu", mesh);
  const auto said = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "adapt");
    words.insert(words.end(), {"-o", folder / "n.msh"});
    const ProgramResult result = delquad(words);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    return result.err;
  };
  const std::string a = folder / "a.vtu", b = folder / "b.msh", c = folder / "c.vtu";
  EXPECT_TRUE(contains(said({"u", "--quads", "100"}), "expected FILE:FIELD"));
  EXPECT_TRUE(contains(said({a, "--quads", "100"}), "has the fields 'bad', 'flat', 'u', 'w': say which"));
  EXPECT_TRUE(contains(said({a + ":nothing", "--quads", "100"}), "has no field 'nothing'"));
  EXPECT_TRUE(contains(said({a + ":bad", "--quads", "100"}), "the field bad is nan at (0.5, 0.5)"));
  EXPECT_TRUE(contains(said({a + ":flat", "--quads", "100"}), "flat: constant or linear"));
  EXPECT_TRUE(contains(said({a + ":u", b + ":u", "--quads", "100"}), "its mesh is another one"));
  EXPECT_TRUE(contains(said({c + ":eta", "--quads", "100"}),
                       "the field 'eta' is of elements: expected one of points"));
  EXPECT_TRUE(contains(delquad({"adapt", a + ":u", "--quads", "9", "-o", folder / "a.inp"}).err,
                       "is the same file as the solution"));
  EXPECT_TRUE(contains(said({a + ":u"}), "expected one of both"));
  EXPECT_TRUE(
      contains(said({a + ":u", "--quads", "100", "--goal-weight", "bad"}), "the field of weights is nan"));
}

}  // namespace
}  // namespace delquad::testing_support
