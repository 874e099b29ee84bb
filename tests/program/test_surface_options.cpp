#include <gtest/gtest.h>

#include <fstream>

#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {
namespace {

/// Two unit squares that meet at a right angle, 1e-4 apart or at common vertices.
std::string roof(bool torn) {
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 1\n1 1 1\n";
  if (!torn) return "OFF\n6 4 0\n" + points + "3 0 1 2\n3 0 2 3\n3 1 4 5\n3 1 5 2\n";
  return "OFF\n8 4 0\n" + points + "1.0001 0 0\n1.0001 1 0\n3 0 1 2\n3 0 2 3\n3 6 4 5\n3 6 5 7\n";
}

/// Faces and curves of the roof, meshed with these options; -1: the program failed.
std::pair<int, int> faces_and_curves(const std::vector<std::string>& options, bool torn = false) {
  const TemporaryFolder folder;
  std::ofstream(folder / "roof.off") << roof(torn);
  std::vector<std::string> arguments = {"mesh", folder / "roof.off", "-o", folder / "roof.msh", "--size",
                                        "0.25", "--curves",          "all"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto run = delquad(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  if (run.exit_code != 0) return {-1, -1};
  const Mesh mesh = read_mesh(folder / "roof.msh");
  EXPECT_TRUE(mesh.triangles.empty());
  return {static_cast<int>(mesh.regions.size()), static_cast<int>(mesh.curves.size())};
}

TEST(SurfaceOptions, CompoundsAndAnglesJoinFaces) {
  EXPECT_EQ(faces_and_curves({}), std::pair(2, 7));
  EXPECT_EQ(faces_and_curves({"--compound", "tangent"}), std::pair(2, 7));
  // The outline turns by 90 degrees where the ridge ends, too, which is a corner unless the angle allows it.
  EXPECT_EQ(faces_and_curves({"--compound", "all"}), std::pair(1, 6));
  EXPECT_EQ(faces_and_curves({"--feature-angle", "89"}), std::pair(2, 7));
  EXPECT_EQ(faces_and_curves({"--feature-angle", "91"}).first, 1);
}

TEST(SurfaceOptions, NarrowFacesAreIgnored) {
  // Both are half a length wide: twice the area by the outline.
  EXPECT_EQ(faces_and_curves({"--ignore-below", "0.49"}), std::pair(2, 7));
  EXPECT_EQ(faces_and_curves({"--ignore-below", "0.51"}), std::pair(1, 6));
}

TEST(SurfaceOptions, WeldingClosesGaps) {
  EXPECT_EQ(faces_and_curves({}, true), std::pair(2, 8));
  EXPECT_EQ(faces_and_curves({"--weld", "1e-3"}, true), std::pair(2, 7));
}

TEST(SurfaceOptions, NonsenseIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "roof.off") << roof(false);
  write_text(folder / "square.toml", kSquare);
  const auto refused = [&](const std::string& model, const std::vector<std::string>& options,
                           const std::string& part) {
    std::vector<std::string> arguments = {"mesh", folder / model, "-o", folder / "out.msh", "--size", "0.25"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto run = delquad(arguments);
    EXPECT_EQ(run.exit_code, 2) << part;
    EXPECT_TRUE(contains(run.err, part)) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.msh"));
  };
  refused("roof.off", {"--compound", "some"}, "--compound: compound 'some': expected all or tangent");
  for (const char* angle : {"0", "-5", "181", "nan", "inf"})
    refused("roof.off", {"--feature-angle", angle}, "--feature-angle: '");
  for (const char* part : {"-1e-3", "0.2", "nan"}) refused("roof.off", {"--weld", part}, "--weld: '");
  refused("roof.off", {"--weld", "wide"}, "--weld");
  for (const char* length : {"0", "-1", "nan", "inf"})
    refused("roof.off", {"--ignore-below", length}, "--ignore-below: '");
  refused("roof.off", {"--ignore-below", "3"}, "expected a length far below the diagonal");
  refused("square.toml", {"--glue"}, "--glue: the model is planar: glue is for surfaces\n");
  refused("square.toml", {"--compound", "all"}, "--compound: the model is planar");
}

TEST(SurfaceOptions, BestWidensRoundHolesUnlessThatIsSaid) {
  const TemporaryFolder folder;
  std::ofstream(folder / "roof.off") << roof(false);
  const auto widens = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"mesh", folder / "roof.off", "-o", folder / "roof.msh", "--size", "0.25",
                                     "--json", folder / "r"});
    const auto run = delquad(options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return contains(read_text(folder / "r"), "\"round_holes\": true");
  };
  EXPECT_TRUE(widens({"--quality", "best"}));
  EXPECT_FALSE(widens({"--quality", "best", "--set", "curves.round_holes=false"}));
  EXPECT_FALSE(widens({"--quality", "good"}));
  EXPECT_FALSE(widens({"--pipeline", "DBCQO"}));
}

TEST(SurfaceOptions, ModelFilesNameASurface) {
  const TemporaryFolder folder;
  std::ofstream(folder / "roof.off") << roof(false);
  const std::string model = "model = \"roof.off\"\nsize = 0.25\n[surface]\n";
  write_text(folder / "roof.toml", model + "compound = \"all\"\n");
  const auto run = delquad({"mesh", folder / "roof.toml", "-o", folder / "roof.msh", "--json", folder / "r"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_mesh(folder / "roof.msh").regions.size(), 1u);
  EXPECT_TRUE(contains(read_text(folder / "r"), "\"compound\": \"all\""));

  write_text(folder / "roof.toml", model + "mirror = { point = [0, 0, 0], normal = [1, 0, 0] }\n");
  ASSERT_EQ(delquad({"mesh", folder / "roof.toml", "-o", folder / "roof.msh"}).exit_code, 0);
  const Mesh mesh = read_mesh(folder / "roof.msh");
  EXPECT_EQ(mesh.regions.size(), 3u);
  EXPECT_EQ(mesh.quads.size(), 4u * 16);

  write_text(folder / "roof.toml", model + "compound = [[1, 7]]\n");
  const auto bad = delquad({"mesh", folder / "roof.toml", "-o", folder / "out.msh"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_TRUE(contains(bad.err, "roof.toml:3: compound 1: the model has no face 7")) << bad.err;
}

TEST(SurfaceOptions, ExperimentsSkipAbsentData) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "data");
  std::ofstream(folder / "data" / "roof.off") << roof(false);
  write_text(folder / "e.toml",
             "size = 0.25\npipelines = [\"D\", \"DB\"]\n[[case]]\nname = \"roof\"\ndata = \"roof.off\"\n"
             "[[case]]\nname = \"hut\"\ndata = \"sub/hut.step\"\n");
  const auto run = delquad({"run", folder / "e.toml", "-o", folder / "out", "--data", folder / "data"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "hut: data not found, skipped: ")) << run.err;
  EXPECT_TRUE(contains(run.err, "sub/hut.step")) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "out/roof/DB/mesh.msh"));
  const std::string table = read_text(folder / "out/table.md");
  EXPECT_TRUE(contains(table, "skipped |")) << table;
  EXPECT_TRUE(contains(table, "- hut: data not found, skipped: ")) << table;
  EXPECT_TRUE(contains(read_text(folder / "out/table.csv"), "hut,DB,skipped: data not found"));
  EXPECT_TRUE(contains(read_text(folder / "out/hut/DB/record.json"), "\"status\": \"skipped\""));

  // Elsewhere there is none of it.
  const auto none = delquad({"run", folder / "e.toml", "-o", folder / "none", "--data", folder / "nowhere"});
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "none/roof/DB/mesh.msh"));
}

}  // namespace
}  // namespace delquad::testing_support
