// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/read_described.h"
#include "io/mesh_formats.h"
#include "tests/program/program.h"
#include "tests/support/needs_file.h"

namespace delquad::testing_support {
namespace {

TEST(MeshCommand, HelpHasTheOptionsOfAllDescriptions) {
  const std::string help = delquad({"mesh", "--help"}).out;
  int options = 0;
  for (const TomlKeys& keys : {keys_of<MeshProblem>(), keys_of<SizeSpec>(), keys_of<SurfaceSpec>()})
    for (const TomlKey& key : keys) {
      if (key.option == nullptr) continue;
      ++options;
      EXPECT_TRUE(holds(help, std::string("  ") + key.option)) << key.option;
      EXPECT_TRUE(holds(help, ": " + key.about)) << key.option;
    }
  EXPECT_GT(options, 20);
}

TEST(MeshCommand, AFullDiskLeavesNothing) {
  NEEDS_FILE("/dev/full");
  const Folder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  const auto refused = [&](const std::string& name, long long room, const char* why) {
    Strings words = {"mesh", "-q", model, "-o", folder / name, "--size", "0.04"};
    if (name.ends_with(".stl")) words.emplace_back("--triangles");
    const ProgramResult result = run_program(DELQUAD_PROGRAM, {words, room, {}});
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_TRUE(holds(result.err, "error: ", why));
    return result.err;
  };
  for (const MeshFormat& format : mesh_formats()) {
    if (!can_write(format) || !format.package.empty() || !format.has_faces) continue;
    const std::string link = "link" + format.extensions[0];
    EXPECT_TRUE(holds(refused("out" + format.extensions[0], 4096, "File too large"), folder.path()));
    EXPECT_EQ(folder.names(), Strings{"model.toml"});
    fs::create_symlink("/dev/full", folder / link);
    if (format.extensions[0] == ".xdmf") fs::create_symlink("/dev/full", folder / "link.h5");
    EXPECT_TRUE(holds(refused(link, 0, "No space left"), "link."));
    fs::remove(folder / link);
    fs::remove(folder / "link.h5");
    EXPECT_EQ(folder.names(), Strings{"model.toml"});
  }
}

TEST(MetricsCommand, ElementsThatAreNotProvenAreCounted) {
  const Folder folder;
  Mesh mesh = curved_grid(3, 3, 2, false);
  mesh.points[nodes_of_quad(mesh, 4)[4]] = mesh.points[mesh.quads[4][0]];  // the middle in a corner
  write_mesh(folder / "a.vtu", mesh);
  const std::string out = delquad({"metrics", folder / "a.vtu"}).out;
  EXPECT_TRUE(holds(out, "unproven              1 "));
}

}  // namespace
}  // namespace delquad::testing_support
