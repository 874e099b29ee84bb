#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/suite/suite_list.h"
#include "io/mesh_io.h"
#include "tests/program/program.h"
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

std::string size_of(const std::string& name) {
  for (const SuiteModel& model : suite().models)
    if (model.name == name) return model.sizes[0];
  return "";
}

/// A submission: meshes of ours pass for those of another program.
struct Folder {
  TemporaryFolder work;
  fs::path in = work / "in", out = work / "out";

  explicit Folder(const std::string& program) {
    fs::create_directory(in);
    std::ofstream(in / "result.toml") << result_text(program);
  }
  fs::path operator/(const std::string& name) const { return work / name; }
  ProgramResult add() const { return delquad({"suite", "add", in, "-o", out}); }

  /// Meshes a model of the suite at its first size, as work/`file`.
  fs::path mesh(const std::string& model, const std::string& file) const {
    for (const SuiteModel& m : suite().models)
      if (m.name == model) std::ofstream(work / file_name(m)) << make_suite_model(m);
    const fs::path mesh = work / file;
    for (const char* extension : {".toml", ".step", ".obj"})
      if (const fs::path file_of_model = work / (model + extension); fs::exists(file_of_model)) {
        const auto run =
            delquad({"mesh", file_of_model, "-o", mesh, "--size", size_of(model), "--quality", "fast"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        break;
      }
    return mesh;
  }
};

TEST(SuiteCommands, ModelsAreWrittenForOthers) {
  const TemporaryFolder folder;
  const fs::path models = folder / "models";
  const auto written = delquad({"suite", "models", "-o", models});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  const Json cases = read_json(models / "cases.json");
  EXPECT_EQ(cases.at("suite"), suite().version);
  ASSERT_EQ(cases.at("cases").size(), (40u + 14 + 14) * 3 + 2);
  EXPECT_TRUE(contains(written.out, "78 of 80 public models are absent")) << written.out;
  for (const Json& c : cases.at("cases")) {
    EXPECT_TRUE(fs::exists(models / c.at("model").get<std::string>())) << c;
    if (c.at("boundary").is_null()) continue;
    const Mesh lines = read_mesh(models / c.at("boundary").get<std::string>());
    EXPECT_FALSE(lines.lines.empty()) << c;
    EXPECT_TRUE(lines.quads.empty()) << c;
  }
  const auto part =
      delquad({"suite", "models", "-o", folder / "part", "--family", "planar", "CAD", "--models", "gear"});
  ASSERT_EQ(part.exit_code, 0) << part.err;
  EXPECT_EQ(part.out, "Suite 2: 1 model, 0 of them public\n" + (folder / "part").string() + "\n");
  EXPECT_EQ(read_json(folder / "part/cases.json").at("cases").size(), 3u);
  const auto refused = [&](std::vector<std::string> arguments, const std::string& reason) {
    arguments.insert(arguments.begin(), {"suite", "models", "-o", folder / "none"});
    const auto run = delquad(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(contains(run.err, reason)) << run.err;
  };
  refused({"--models", "gaer"}, "'gaer' is none of the suite; did you mean 'gear'");
  refused({"--models", "wing_body", "--family", "planar"},
          "'wing_body' is none of planar: expected some of fractures, fracture_network");
  refused({"--family", "public", "--public", folder / "nowhere"}, "nowhere: is no folder");
  const auto dry = delquad({"run", models / "suite.toml", "-o", folder / "none", "--dry-run"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_TRUE(contains(dry.out, "cells: 412, of which 0 are done\n")) << dry.out;
}

TEST(SuiteCommands, AddMeasuresAndRanks) {
  const Folder work("theirs");
  work.mesh("gear", "in/gear_1.msh");
  work.mesh("circles", "in/circles_1.msh");
  work.mesh("torus", "in/torus_1.obj");
  work.mesh("sphere_noisy", "in/sphere_noisy_1.msh");
  // Meshes of something else: another model, the right area in another place, a file that is none.
  fs::copy(work / "in/gear_1.msh", work / "in/ring_gear_1.msh");
  fs::copy(work / "in/torus_1.obj", work / "in/bracket_1.obj");
  std::ofstream(work / "in/hood_1.obj") << "v 1 x\n";
  std::ofstream(work / "in/haer_1.obj") << "";
  const auto added = work.add();
  ASSERT_EQ(added.exit_code, 0) << added.err;
  EXPECT_TRUE(contains(added.out, "theirs: cases: 4 measured, 3 refused, 199 missing")) << added.out;
  EXPECT_EQ(added.err, "warning: haer_1.obj: is of no case, and was not measured\n");
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
  EXPECT_EQ(rows.at(0).at("values").at("failed"), 158);

  // In place of the first one.
  const auto part = delquad({"suite", "add", work / "in", "-o", work / "out", "--models", "gear"});
  ASSERT_EQ(part.exit_code, 0) << part.err;
  EXPECT_TRUE(contains(part.out, "theirs: cases: 1 measured, 0 refused, 2 missing")) << part.out;
  EXPECT_FALSE(fs::exists(work / "out/theirs/torus_1/theirs/record.json"));
  EXPECT_FALSE(fs::exists(work / "out/theirs/summary.md"));
  EXPECT_TRUE(contains(read_text(work / "out/models/suite.toml"), "torus_1")) << "the suite stays whole";
  EXPECT_TRUE(contains(table.out, "| theirs ")) << table.out;
  EXPECT_EQ(delquad({"report", work / "out", "-o", work / "page.html"}).exit_code, 0);
}

TEST(SuiteCommandsLong, AddRefusesMeshesBesideTheModel) {
  const Folder work("moved");
  const auto moved = [&](const std::string& model, const std::string& to, Vec3 by) {
    Mesh m = read_mesh(work.mesh(model, "in/" + to));
    for (Vec3& p : m.points) p = p + by;
    write_mesh(work / "in" / to, m);
  };
  moved("gear", "gear_1.msh", {0.2, 0, 0});
  moved("torus", "torus_1.obj", {0, 8, 0});
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
  const auto added = work.add();
  EXPECT_EQ(added.exit_code, 2) << added.err;
  EXPECT_TRUE(contains(added.out, "0 measured, 3 refused")) << added.out;
  const auto reason = [&](const std::string& name) -> std::string {
    return read_json(work / "out/moved" / name / "moved/record.json").at("reason");
  };
  EXPECT_TRUE(contains(reason("gear_1"), "no mesh of this model")) << reason("gear_1");
  EXPECT_TRUE(contains(reason("torus_1"), "no mesh of this model")) << reason("torus_1");
  EXPECT_TRUE(contains(reason("fracture_network_1"), "do not follow the curves"))
      << reason("fracture_network_1");
}

TEST(SuiteCommands, AddRefusesMistakes) {
  const Folder work("theirs");
  fs::remove(work / "in/result.toml");
  const auto refused = [&](const std::string& part) {
    const auto run = work.add();
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

TEST(SuiteCommands, AddLeavesRunsAlone) {
  const Folder work("run");
  std::ofstream(work / "in/gear_1.msh") << "";
  std::ofstream(work / "e.toml")
      << "title = \"Suite 2\"\npipelines = [\"DB\"]\n[[case]]\nname = \"gear_1\"\nsize = 0.5\n" + kSquare;
  ASSERT_EQ(delquad({"run", work / "e.toml", "-o", work / "out/run"}).exit_code, 0);
  const auto run = work.add();
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(contains(run.err, "holds the results of a run")) << run.err;
  EXPECT_TRUE(fs::exists(work / "out/run/gear_1/DB/mesh.msh"));
}

/// Public models come from the folders that are given, and are checked.
TEST(SuiteCommands, PublicModelsAreThoseThatWereFetched) {
  const TemporaryFolder work;
  const auto write = [&] {
    return delquad(
        {"suite", "models", "-o", work / "suite", "--models", "s16o_torus", "--public", work.path()});
  };
  const auto absent = write();
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_TRUE(contains(absent.err, "'make public_models' fetches it")) << absent.err;
  fs::create_directories(work / "hexme/original");
  std::ofstream(work / "hexme/original/s16o_torus.stp") << "changed";
  const auto changed = write();
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_TRUE(contains(changed.err, "s16o_torus.stp: SHA-256 is")) << changed.err;
}

/// Each hard model is meshed soundly by `fast`, or refused with one message; but for one that takes long.
TEST(SuiteCommandsLong, HardModelsAreSoundOrRefused) {
  const TemporaryFolder work;
  for (const SuiteModel& model : select_models({.families = {"hard"}})) {
    if (model.name == "tiny_edges") continue;
    std::ofstream(work / file_name(model)) << make_suite_model(model);
    const auto run = delquad({"mesh", work / file_name(model), "-o", work / "m.msh", "--size", model.sizes[0],
                              "--quality", "fast"});
    if (run.exit_code == 0) continue;
    EXPECT_EQ(run.exit_code, 2) << model.name << ": " << run.err;
    EXPECT_TRUE(contains(run.err, file_name(model))) << run.err;
  }
}

}  // namespace
}  // namespace delquad::testing_support
