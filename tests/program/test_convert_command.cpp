// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_formats.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

std::string all_text(const fs::path& folder) {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) text += read_text(entry.path());
  return text;
}

/// A grid whose middle column is a named curve, with a named point and two regions.
Mesh grid_with_names() {
  Mesh mesh = quad_grid(4, 4);
  mesh.curves.push_back({5, {"rib"}});
  for (int j = 0; j < 4; ++j) {
    mesh.lines.push_back({5 * j + 2, 5 * (j + 1) + 2});
    mesh.line_curve.push_back(4);
  }
  mesh.regions = {{1, {"plate"}}, {2, {"right"}}};
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) mesh.quad_region[q] = q % 4 < 2 ? 0 : 1;
  mesh.named_points.push_back({6, {1, {"sensor"}}});
  return mesh;
}

TEST(ConvertCommand, TellsWhichNamesAFormatDoesNotHold) {
  const Folder folder;
  write_mesh(folder / "a.msh", grid_with_names());
  for (const MeshFormat& format : mesh_formats()) {
    if (format.write == nullptr || !format.has_faces) continue;
    const Folder out;
    Strings words = {"convert", folder / "a.msh", out / ("b" + format.extensions[0])};
    if (format.extensions[0] == ".stl") words.emplace_back("--triangles");
    const auto result = delquad(words);
    ASSERT_EQ(result.exit_code, 0) << format.extensions[0] << result.err;
    const std::string text = all_text(out.path());
    for (const char* name : {"plate", "right", "south", "rib", "sensor"})
      EXPECT_NE(bool(holds(text, name)), bool(holds(result.err, name)))
          << name << " in " << format.extensions[0] << ": " << result.err;
    if (format.read == nullptr) continue;
    const Mesh back = read_mesh(out / ("b" + format.extensions[0]));
    EXPECT_EQ(back.quads.size() + back.triangles.size() / 2, 16u) << format.extensions[0];
  }
}

TEST(ConvertCommand, FlatShellsStayShells) {
  const Workplace folder;
  write_mesh(folder / "a.bdf", quad_grid(2, 2));
  for (const char* command : {"convert a.bdf a.inp", "improve a.bdf -o a.inp"}) {
    ASSERT_EQ(folder.run(command).exit_code, 0) << command;
    EXPECT_TRUE(holds(read_text(folder / "a.inp"), "TYPE=S4,")) << command;
  }
}

TEST(ConvertCommand, KeepsFieldsAndOrderWhereItCan) {
  const Folder folder;
  const Mesh mesh = curved_grid(3, 2, 2, false);
  std::vector<double> u;
  for (const Vec3& p : mesh.points) u.push_back(p.x + 2 * p.y);
  write_fields(folder / "a.msh", mesh, {{"u", true, 1, u}});
  const auto there = delquad({"convert", folder / "a.msh", folder / "b.vtu"});
  ASSERT_EQ(there.exit_code, 0) << there.err;
  EXPECT_EQ(there.err, "");
  ASSERT_EQ(delquad({"convert", folder / "b.vtu", folder / "c.msh", "--binary"}).exit_code, 0);
  const MeshWithFields back = read_fields(folder / "c.msh");
  EXPECT_EQ(back.mesh.order, 2);
  ASSERT_EQ(back.fields.size(), 1u);
  for (std::size_t i = 0; i < back.mesh.points.size(); ++i)
    EXPECT_NEAR(back.fields[0].values[i], back.mesh.points[i].x + 2 * back.mesh.points[i].y, 1e-12);

  const auto straight = delquad({"convert", folder / "c.msh", folder / "d.obj"});
  EXPECT_EQ(straight.exit_code, 0);
  EXPECT_TRUE(holds(straight.err, "lost: fields", ": u\n", "lost: the order of the elements, 2"));
  EXPECT_EQ(read_mesh(folder / "d.obj").points.size(), 12u);

  Mesh named = mesh;
  named.regions[0].names = {"steel", "tagged"};
  write_mesh(folder / "n.msh", named);
  EXPECT_TRUE(
      holds(delquad({"convert", folder / "n.msh", folder / "n.bdf"}).err, "'.bdf' holds one each: tagged"));
  EXPECT_EQ(delquad({"convert", folder / "n.msh", folder / "n.inp"}).err, "");

  Mesh triangles = triangle_grid(2, 2);
  write_mesh(folder / "t.msh", triangles);
  const auto refused = delquad({"convert", folder / "t.msh", folder / "t.re2"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused.err, "triangle"));
}

}  // namespace
}  // namespace delquad::testing_support
