// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// "u", "w", a vector "flow" and "k" of elements.
std::vector<MeshField> some_fields(const Mesh& mesh) {
  std::vector<MeshField> fields{
      {"u", true, 1, {}}, {"w", true, 1, {}}, {"flow", true, 3, {}}, {"k", false, 1, {}}};
  for (const Vec3& p : mesh.points) {
    fields[0].values.push_back(std::tanh(10 * (p.x + p.y - 1)));
    fields[1].values.push_back(p.x > 0.5 ? 1 : 0);
    fields[2].values.insert(fields[2].values.end(), {p.x, 2 * p.y, 3});
  }
  fields[3].values.assign(mesh.quads.size(), 7);
  return fields;
}

const MeshField& field_of(const MeshWithFields& read, const std::string& name) {
  return *std::ranges::find(read.fields, name, &MeshField::name);
}

TEST(AdaptCommand, ASolutionAndTheNextMesh) {
  const Workplace folder;
  const Mesh mesh = quad_grid(16, 16);
  for (const auto& [name, next] : {std::pair("a.vtu", "b.msh"), {"a.msh", "b.vtu"}}) {
    write_fields(folder / name, mesh, some_fields(mesh));
    const ProgramResult result = folder.run("adapt " + std::string(name) + ":u --quads 500 -o " + next +
                                            " --goal-weight w --h-max 0.3 --quality fast");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, "u: error ", "estimated on the 256 elements of before; ",
                      "with the fields flow, u, w, k (of elements)\n"));
    const MeshWithFields made = read_fields(folder / next);
    EXPECT_NEAR(static_cast<double>(made.mesh.quads.size()), 500, 60);
    EXPECT_EQ(made.mesh.curves[0].names[0], "south");
    const std::vector<double>&u = field_of(made, "u").values, &flow = field_of(made, "flow").values;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const Vec3& p = made.mesh.points[i];
      EXPECT_NEAR(u[i], std::tanh(10 * (p.x + p.y - 1)), 0.1);
      EXPECT_NEAR(flow[3 * i], p.x, 1e-12);
      EXPECT_NEAR(flow[3 * i + 1], 2 * p.y, 1e-12);
    }
    EXPECT_EQ(field_of(made, "k").values, std::vector<double>(made.mesh.quads.size(), 7));
  }
}

TEST(AdaptCommand, ModelsAndOtherFormats) {
  const Workplace folder;
  const Mesh mesh = quad_grid(16, 16);
  write_fields(folder / "a.vtu", mesh, some_fields(mesh));
  write_text(folder / "m.toml", kSquare + "size = 0.25\n");
  write_text(folder / "l.toml", kSquare + "[[layer]]\non = 'left'\nfirst = 0.01\nnumber = 3\n");
  const ProgramResult result = folder.run(
      "adapt a.vtu:u --error 0.03 --norm inf --model m.toml -o b.inp --transfer bounded --isotropic");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(holds(result.out, "(maximum), of its gradient"));
  const MeshWithFields beside = read_fields(folder / "b.vtu");
  EXPECT_EQ(beside.mesh.quads.size(), read_mesh(folder / "b.inp").quads.size());
  EXPECT_EQ(beside.mesh.curves[0].names[0], "bottom");
  EXPECT_TRUE(holds(folder.run("adapt a.vtu:u --quads 300 --model l.toml -o c.msh").err,
                    "layers do not go with a metric"));
  EXPECT_FALSE(fs::exists(folder / "c.msh"));
}

// Steps in time: the mesh is fine where any of them asks for it, and has the last one's values.
TEST(AdaptCommand, WarnsOfLongQuads) {
  const Workplace folder;
  const Mesh mesh = quad_grid(16, 16);
  MeshField field{"u", true, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(p.x * p.x);
  write_fields(folder / "a.vtu", mesh, {field});
  const auto warns = [&](const std::string& options) {
    const ProgramResult result = folder.run("adapt a.vtu:u --quads 1000 --quality fast -o b.vtu " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return holds(result.err, "times as long as wide: --aspect 20 limits");
  };
  EXPECT_TRUE(warns(""));
  EXPECT_FALSE(warns("--aspect 20"));
}

TEST(AdaptCommand, SeveralFiles) {
  const Workplace folder;
  const Mesh mesh = quad_grid(16, 16);
  const auto step = [&](const char* name, double at) {
    std::vector<MeshField> fields = some_fields(mesh);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      fields[0].values[i] = std::tanh(20 * (mesh.points[i].x - at));
    write_fields(folder / name, mesh, fields);
  };
  step("a.vtu", 0.2), step("b.msh", 0.8);
  const ProgramResult result = folder.run("adapt a.vtu:u b.msh:u --quads 400 -o n.vtu --quality fast");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(holds(result.out, "a.vtu:u: error ", "b.msh:u: error "));
  const MeshWithFields made = read_fields(folder / "n.vtu");
  const std::vector<double>& u = field_of(made, "u").values;
  std::array<int, 3> near{};
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double x = made.mesh.points[i].x;
    EXPECT_NEAR(u[i], std::tanh(20 * (x - 0.8)), 0.2);
    for (int k = 0; k < 3; ++k)
      if (std::abs(x - 0.2 - 0.3 * k) < 0.1) ++near[k];
  }
  EXPECT_GT(std::min(near[0], near[2]), 2 * near[1]);
}

// The elements of the next mesh have the order of this mesh.
TEST(AdaptCommand, CurvedElements) {
  const Workplace folder;
  const Mesh mesh = curved_grid(12, 12, 2, false);
  std::vector<double> u;
  for (const Vec3& p : mesh.points) u.push_back(std::tanh(p.x + p.y - 12));
  write_fields(folder / "a.msh", mesh, {{"u", true, 1, u}});
  const ProgramResult result = folder.run("adapt a.msh:u --quads 150 -o b.vtu --quality fast");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const MeshWithFields made = read_fields(folder / "b.vtu");
  EXPECT_EQ(made.mesh.order, 2);
  for (std::size_t i = 0; i < made.mesh.points.size(); ++i)
    EXPECT_NEAR(made.fields[0].values[i], std::tanh(made.mesh.points[i].x + made.mesh.points[i].y - 12), 0.1);
}

// Squares are a size, which goes with what a metric does not.
TEST(AdaptCommand, SquaresKeepLayersAndPeriodicSides) {
  const Workplace folder;
  write_fields(folder / "a.vtu", quad_grid(16, 16), some_fields(quad_grid(16, 16)));
  write_text(folder / "m.toml", kSquare +
                                    "periodic = [{ from = 'left', to = 'right', translate = [1, 0] }]\n"
                                    "[[layer]]\non = 'bottom'\nfirst = 0.004\nnumber = 3\n");
  const ProgramResult result =
      folder.run("adapt a.vtu:u --quads 500 --isotropic --model m.toml -o b.vtu --quality fast");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Mesh mesh = read_mesh(folder / "b.vtu");
  EXPECT_NEAR(static_cast<double>(mesh.quads.size()), 500, 50);
  std::vector<double> left, right;
  for (const Vec3& p : mesh.points) {
    if (p.x == 0) left.push_back(p.y);
    if (p.x == 1) right.push_back(p.y);
  }
  std::ranges::sort(left);
  std::ranges::sort(right);
  EXPECT_EQ(left, right);
  EXPECT_NEAR(left[1], 0.004, 1e-12);
}

TEST(AdaptCommand, WrongFields) {
  const Workplace folder;
  const Mesh mesh = quad_grid(4, 4), other = quad_grid(5, 5);
  std::vector<MeshField> fields = some_fields(mesh);
  for (const auto& [name, value] :
       {std::pair("bad", 0.0), {"flat", 3.0}, {"huge", 1e300}, {"tiny", 1e-300}}) {
    fields.push_back({name, true, 1, std::vector<double>(25, value)});
    if (value != 3) fields.back().values[12] = value == 0 ? std::nan("") : 0;
  }
  write_fields(folder / "a.vtu", mesh, fields);
  write_fields(folder / "b.msh", other, some_fields(other));
  write_mesh(folder / "c.vtu", mesh);
  for (const auto& [words, message] :
       {std::pair("u --quads 100", "expected FILE:FIELD"),
        {"a.vtu --quads 100", "has the fields 'bad', 'flat', 'flow', 'huge', 'tiny', 'u', 'w': say which"},
        {"a.vtu:nothing --quads 100", "has no field 'nothing'"},
        {"a.vtu:bad --quads 100", "the field bad is nan at (0.5, 0.5)"},
        {"a.vtu:flat --quads 100", "flat: constant or linear"},
        {"a.vtu:huge --quads 100",
         "the field huge has values up to 1e+300: expected between 1e-90 and 1e+90"},
        {"a.vtu:tiny --quads 100", "the field tiny has values up to 1e-300"},
        {"a.vtu:u --quads 0.5", "the 4 sides of the outline need 1 at least"},
        {"a.vtu:u --quads 9 --goal-weight flow", "expected one number"},
        {"a.vtu:u b.msh:u --quads 100", "its mesh differs from the mesh of"},
        {"c.vtu:eta --quads 100", "the field 'eta' is of elements: expected one of points"},
        {"a.vtu:u --quads 9 -o a.inp", "is the same file as the solution"},
        {"a.vtu:u", "expected --quads N"},
        {"a.vtu:u --quads 100 --goal-weight bad", "the field of weights is nan"}}) {
    const ProgramResult result =
        folder.run("adapt " + std::string(words) + (holds(words, "-o") ? "" : " -o n.msh"));
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_TRUE(holds(result.err, message));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(folder / "n.msh"));
  }
}

}  // namespace
}  // namespace delquad::testing_support
