// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/mesher.h"
#include "io/cases/case_file.h"
#include "io/cases/read_problem.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// The indented block of a page that begins with this line.
std::string block_of(const std::string& page, const std::string& first) {
  std::istringstream in(read_text(fs::path(DELQUAD_EXPERIMENTS) / "../docs" / page));
  std::string block;
  for (std::string line; std::getline(in, line);) {
    const bool is_indented = line.starts_with("    ");
    if (block.empty() && line != "    " + first) continue;
    if (!is_indented) break;
    block += line.substr(4) + "\n";
  }
  return block;
}

int lines_named(const Mesh& mesh, const std::string& name) {
  return static_cast<int>(std::ranges::count_if(
      mesh.line_curve, [&](int c) { return std::ranges::count(mesh.curves[c].names, name) > 0; }));
}

TEST(Documents, TheExampleOfManyKeysIsMeshed) {
  const Folder folder;
  const std::string text = block_of("meshing.md", "# channel.toml: one period of a heated channel");
  ASSERT_FALSE(text.empty());
  const Case c = read_model_case(write_text(folder / "channel.toml", text));
  const MeshResult result = mesh(read_files(c), "DBCO");
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  const Mesh& m = result.mesh;
  EXPECT_TRUE(m.triangles.empty());
  EXPECT_EQ(m.regions.size(), 2u);
  EXPECT_EQ(lines_named(m, "tube"), 48);
  EXPECT_EQ(lines_named(m, "left"), lines_named(m, "right"));
  EXPECT_GT(lines_named(m, "vane"), 0);
  EXPECT_EQ(m.named_points.size(), 1u);
  EXPECT_EQ(m.periodic.size(), 1u);
  EXPECT_EQ(result.log.summaries.get<long long>("layers", "quads"), 9 * lines_named(m, "floor") + 8 * 48);
}

}  // namespace
}  // namespace delquad
