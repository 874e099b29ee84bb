#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "io/mesh_io.h"
#include "suite/suite_list.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json read_json(const fs::path& file) { return Json::parse(std::ifstream(file)); }

std::string result_text(const std::string& program) {
  return "program = \"" + program +
         "\"\nversion = \"1.2\"\ncommand = \"mesh {input}\"\nauthors = [\"A. Nother\"]\n";
}

/// Meshes of ours pass for those of another program. One for all tests: it takes a while.
class SuiteCommands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const auto written = delquad({"suite", "models", "-o", *folder_ / "models"});
    ASSERT_EQ(written.exit_code, 0) << written.err;
    for (const char* model : {"gear.toml", "circles.toml", "torus.step", "sphere_noisy.obj"}) {
      const std::string stem = fs::path(model).stem();
      const fs::path mesh = *folder_ / (stem + (stem == "torus" ? ".obj" : ".msh"));
      const auto meshed = delquad(
          {"mesh", *folder_ / "models" / model, "-o", mesh, "--size", size_of(stem), "--quality", "fast"});
      ASSERT_EQ(meshed.exit_code, 0) << meshed.err;
    }
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::string size_of(const std::string& name) {
    for (const SuiteModel& model : suite().models)
      if (model.name == name) return model.sizes[0];
    return "";
  }
  static fs::path models() { return *folder_ / "models"; }
  static fs::path mesh(const std::string& file) { return *folder_ / file; }

  static TemporaryFolder* folder_;
};

TemporaryFolder* SuiteCommands::folder_ = nullptr;

TEST_F(SuiteCommands, ModelsAreWrittenForOthers) {
  const Json cases = read_json(models() / "cases.json");
  EXPECT_EQ(cases.at("suite"), suite().version);
  ASSERT_EQ(cases.at("cases").size(), 120u);
  for (const Json& c : cases.at("cases")) {
    EXPECT_TRUE(fs::exists(models() / c.at("model").get<std::string>())) << c;
    if (c.at("family") != "planar") continue;
    const Mesh lines = read_msh(models() / c.at("boundary").get<std::string>());
    EXPECT_FALSE(lines.lines.empty()) << c;
    EXPECT_TRUE(lines.quads.empty()) << c;
  }
  const auto dry = delquad({"run", models() / "suite.toml", "-o", *folder_ / "none", "--dry-run"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_EQ(std::ranges::count(dry.out, '\n'), 240);
}

TEST_F(SuiteCommands, AddMeasuresAndRanks) {
  const TemporaryFolder work;
  fs::create_directory(work / "in");
  std::ofstream(work / "in/result.toml") << result_text("theirs");
  fs::copy(mesh("gear.msh"), work / "in/gear_1.msh");
  fs::copy(mesh("circles.msh"), work / "in/circles_1.msh");
  fs::copy(mesh("torus.obj"), work / "in/torus_1.obj");
  fs::copy(mesh("sphere_noisy.msh"), work / "in/sphere_noisy_1.msh");
  // Meshes of something else: another model, the right area in another place, a file that is none.
  fs::copy(mesh("gear.msh"), work / "in/ring_gear_1.msh");
  fs::copy(mesh("torus.obj"), work / "in/bracket_1.obj");
  std::ofstream(work / "in/hood_1.obj") << "v 1 2\n";
  const auto added = delquad({"suite", "add", work / "in", "-o", work / "out"});
  ASSERT_EQ(added.exit_code, 0) << added.err;
  EXPECT_TRUE(contains(added.out, "theirs: 4 meshes measured, 3 refused, 113 missing")) << added.out;
  const auto record = [&](const std::string& name) {
    return read_json(work / "out/theirs" / name / "theirs/record.json");
  };
  // As the program measures a mesh by itself.
  for (const char* file : {"gear_1.msh", "circles_1.msh", "torus_1.obj", "sphere_noisy_1.msh"}) {
    const std::string name = fs::path(file).stem(), model = name.substr(0, name.size() - 2);
    ASSERT_EQ(delquad({"metrics", work / "in" / file, "--size", size_of(model), "--json", work / "m.json"})
                  .exit_code,
              0);
    const Json wanted = read_json(work / "m.json").at("metrics");
    for (const char* key : {"n_quads", "eta_mean", "eta_worst", "d4", "tau"})
      EXPECT_NEAR(record(name).at("metrics").at(key), wanted.at(key), 1e-9) << name << " " << key;
    EXPECT_EQ(record(name).at("sound"), true) << name;
  }
  EXPECT_TRUE(contains(record("ring_gear_1").at("reason"), "% of the domain's area"))
      << record("ring_gear_1");
  EXPECT_TRUE(contains(record("bracket_1").at("reason"), "% of the model's area")) << record("bracket_1");
  EXPECT_TRUE(contains(record("hood_1").at("reason"), "hood_1.obj:1")) << record("hood_1");
  EXPECT_TRUE(contains(record("loft_3").at("reason"), "there is no loft_3.msh")) << record("loft_3");

  EXPECT_EQ(read_text(work / "out/theirs/result.toml"), result_text("theirs"));

  const auto table = delquad({"suite", "table", work / "out"});
  ASSERT_EQ(table.exit_code, 0) << table.err;
  const Json rows = read_json(work / "out/ranking/table.json").at("rows");
  EXPECT_EQ(rows.at(0).at("values").at("solved"), 4);
  EXPECT_EQ(rows.at(0).at("values").at("failed"), 116);
  EXPECT_TRUE(contains(table.out, "| theirs ")) << table.out;
  EXPECT_EQ(delquad({"report", work / "out", "-o", work / "page.html"}).exit_code, 0);
}

TEST_F(SuiteCommands, AddRefusesMeshesBesideTheModel) {
  const TemporaryFolder work;
  fs::create_directory(work / "in");
  std::ofstream(work / "in/result.toml") << result_text("moved");
  const auto moved = [&](const std::string& from, const std::string& to, Vec3 by) {
    Mesh m = read_mesh(mesh(from));
    for (Vec3& p : m.points) p = p + by;
    write_mesh(work / "in" / to, m);
  };
  moved("gear.msh", "gear_1.msh", {0.2, 0, 0});
  moved("torus.obj", "torus_1.obj", {0, 8, 0});
  // A grid over the plate of discs, which knows nothing of them.
  Mesh grid;
  constexpr int kX = 40, kY = 20;
  for (int i = 0; i <= kX; ++i)
    for (int j = 0; j <= kY; ++j) grid.points.push_back({2.0 * i / kX, 1.0 * j / kY, 0});
  for (int i = 0; i < kX; ++i)
    for (int j = 0; j < kY; ++j) {
      const int a = i * (kY + 1) + j, b = a + kY + 1;
      grid.quads.push_back({a, b, b + 1, a + 1});
    }
  grid.quad_region.assign(grid.quads.size(), 0);
  grid.regions = {{1, {}}};
  write_mesh(work / "in/fracture_network_1.msh", grid);
  const auto added = delquad({"suite", "add", work / "in", "-o", work / "out"});
  ASSERT_EQ(added.exit_code, 0) << added.err;
  EXPECT_TRUE(contains(added.out, "0 meshes measured, 3 refused")) << added.out;
  const auto reason = [&](const std::string& name) -> std::string {
    return read_json(work / "out/moved" / name / "moved/record.json").at("reason");
  };
  EXPECT_TRUE(contains(reason("gear_1"), "no mesh of this model")) << reason("gear_1");
  EXPECT_TRUE(contains(reason("torus_1"), "no mesh of this model")) << reason("torus_1");
  EXPECT_TRUE(contains(reason("fracture_network_1"), "do not follow the curves"))
      << reason("fracture_network_1");
}

TEST_F(SuiteCommands, AddRefusesMistakes) {
  const TemporaryFolder work;
  fs::create_directory(work / "in");
  const auto refused = [&](const std::string& part) {
    const auto run = delquad({"suite", "add", work / "in", "-o", work / "out"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(contains(run.err, part)) << run.err;
    EXPECT_FALSE(fs::exists(work / "out"));
  };
  refused("result.toml");
  std::ofstream(work / "in/result.toml") << result_text("Their Mesher");
  refused("result.toml:1: program 'Their Mesher': expected small letters");
  std::ofstream(work / "in/result.toml") << result_text("models");
  refused("program 'models'");
  std::ofstream(work / "in/result.toml") << result_text("theirs") << "autor = 1\n";
  refused("autor");
  std::ofstream(work / "in/result.toml") << result_text("theirs");
  refused("no mesh of any case");
  for (const char* name : {"gear_1.msh", "gear_1.obj"}) std::ofstream(work / "in" / name) << "";
  refused("expected one of them");
}

TEST_F(SuiteCommands, AddLeavesRunsAlone) {
  const TemporaryFolder work;
  fs::create_directories(work / "in");
  std::ofstream(work / "in/result.toml") << result_text("run");
  fs::copy(mesh("gear.msh"), work / "in/gear_1.msh");
  std::ofstream(work / "e.toml")
      << "title = \"Suite 1\"\npipelines = [\"DB\"]\n[[case]]\nname = \"gear_1\"\nsize = 0.5\n" + kSquare;
  ASSERT_EQ(delquad({"run", work / "e.toml", "-o", work / "out/run"}).exit_code, 0);
  const auto run = delquad({"suite", "add", work / "in", "-o", work / "out"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(contains(run.err, "holds the results of a run")) << run.err;
  EXPECT_TRUE(fs::exists(work / "out/run/gear_1/DB/mesh.msh"));
}

}  // namespace
}  // namespace delquad::testing_support
