// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/experiment.h"
#include "geometry/mesh/half_edges.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

const fs::path kSuite = fs::path(DELQUAD_EXPERIMENTS) / "suite";

TEST(Suite, HasItsFamilies) {
  std::set<std::string> names;
  std::set<fs::path> used;
  for (const auto& [family, models] :
       {std::pair("planar", 14), {"cad", 14}, {"triangles", 12}, {"hard", 14}, {"metric", 14}}) {
    const Experiment experiment = Experiment::read(kSuite / (std::string(family) + ".toml"));
    EXPECT_TRUE(experiment.title.starts_with("Suite 2: ")) << family;
    ASSERT_EQ(experiment.n_cases(), models * 3u) << family;
    for (std::size_t i = 0; i < experiment.n_cases(); ++i) {
      const Case c = experiment.read_variant(i);
      EXPECT_TRUE(names.insert(c.name).second) << c.name;
      EXPECT_EQ(c.name.substr(c.name.size() - 2), "_" + std::to_string(i % 3 + 1));
    }
    for (const fs::path& file : experiment.files())
      if (file.parent_path().filename() == "models") used.insert(file.filename());
  }
  for (const auto& entry : fs::directory_iterator(kSuite / "models"))
    EXPECT_TRUE(used.contains(entry.path().filename())) << entry.path() << " is in no experiment";
}

/// Euler's number of a triangulation, and its edges that are open or wrong.
struct Shape {
  int euler = 0, open = 0, wrong = 0;
};

Shape shape_of(const Mesh& mesh) {
  Shape shape;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  int edges = 0;
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    ++edges;
    shape.open += edge.size() == 1;
    shape.wrong += edge.size() > 2 || (edge.size() == 2 && edge[0].forward == edge[1].forward);
  });
  shape.euler = static_cast<int>(mesh.points.size() + mesh.triangles.size()) - edges;
  return shape;
}

double volume(const Mesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six += dot(mesh.points[a], cross(mesh.points[b], mesh.points[c]));
  return six / 6;
}

TEST(Suite, TriangulationsAreManifoldsOfTheirGenus) {
  const std::set<std::string> open = {"torus_holes", "terrain", "terrain_holes"};
  for (const auto& [name, euler] : std::map<std::string, int>{{"sphere_noisy", 2},
                                                              {"sphere_graded", 2},
                                                              {"torus_noisy", 0},
                                                              {"torus_holes", -4},
                                                              {"knot", 0},
                                                              {"washer", 0},
                                                              {"star_prism", 2},
                                                              {"genus3", -4},
                                                              {"genus3_noisy", -4},
                                                              {"blobs", 2},
                                                              {"terrain", 1},
                                                              {"terrain_holes", -3}}) {
    const Mesh mesh = read_mesh(kSuite / "models" / (name + ".obj.gz"));
    const Shape shape = shape_of(mesh);
    EXPECT_EQ(shape.euler, euler) << name;
    EXPECT_EQ(shape.open > 0, open.contains(name)) << name;
    EXPECT_EQ(shape.wrong, 0) << name;
    EXPECT_TRUE(open.contains(name) || volume(mesh) > 0) << name;
  }
}

/// Meshes of ours stand for finished meshes of another program, which a peer copies.
struct Finished {
  Folder work;
  std::string cases = {};

  Finished() {
    fs::create_directory(work / "meshes");
    write_text(work / "theirs.toml",
               "[[peer]]\nname = 'theirs'\nversion = ['echo', '1.2']\n"
               "command = ['cp', 'meshes/{case}.msh', '{output}']\nkeeps_boundary = false\n");
  }
  /// A case of the suite at its first size.
  void add(const std::string& model, const std::string& file, const std::string& size) {
    cases += "[[case]]\nname = \"" + model + "\"\nmodel = \"" + (kSuite / "models" / file).string() +
             "\"\nsize = " + size + "\n";
  }
  fs::path file(const std::string& model) const { return work / "meshes" / (model + ".msh"); }
  void mesh(const std::string& model, const std::string& of_file, const std::string& size) const {
    const auto run = delquad(
        {"mesh", kSuite / "models" / of_file, "-o", file(model), "--size", size, "--quality", "fast"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  ProgramResult run(Strings more = {}) const {
    write_text(work / "e.toml", "pipelines = ['DB']\n" + cases);
    more.insert(more.begin(), {"run", work / "e.toml", "--peer", work / "theirs.toml", "--pipelines",
                               "theirs", "-o", work / "out", "--pictures", "none"});
    return delquad(more);
  }
  Json record(const std::string& model) const {
    return Json::parse(std::ifstream(work / "out" / model / "theirs/record.json"));
  }
  std::string reason(const std::string& model) const { return record(model).value("reason", ""); }
};

TEST(Suite, FinishedMeshesAreMeasuredAsAPeersAre) {
  Finished theirs;
  const std::map<std::string, std::pair<std::string, std::string>> models = {
      {"gear", {"gear.toml", "0.06"}},
      {"circles", {"circles.toml", "0.05"}},
      {"torus", {"torus.step", "4"}},
      {"sphere_noisy", {"sphere_noisy.obj.gz", "0.16"}}};
  for (const auto& [model, of] : models) {
    theirs.add(model, of.first, of.second);
    theirs.mesh(model, of.first, of.second);
  }
  // Meshes of other models, a file that is none, and no file.
  theirs.add("ring_gear", "ring_gear.toml", "0.06");
  theirs.add("bracket", "bracket.step", "4");
  theirs.add("hood", "hood.step", "64");
  theirs.add("loft", "loft.step", "4");
  fs::copy(theirs.file("gear"), theirs.file("ring_gear"));
  fs::copy(theirs.file("torus"), theirs.file("bracket"));
  write_text(theirs.file("hood"), "v 1 x\n");
  EXPECT_EQ(theirs.run().exit_code, 1);
  for (const auto& [model, of] : models) {
    ASSERT_EQ(delquad({"metrics", theirs.file(model), "--size", of.second, "--json", theirs.work / "m.json"})
                  .exit_code,
              0);
    const Json wanted = Json::parse(std::ifstream(theirs.work / "m.json")).at("metrics");
    const Json record = theirs.record(model);
    for (const char* key : {"n_quads", "eta_mean", "eta_worst", "d4", "tau"})
      EXPECT_NEAR(record.at("metrics").at(key), wanted.at(key), 1e-9) << model << " " << key;
    EXPECT_EQ(record.at("sound"), true) << model;
  }
  EXPECT_TRUE(holds(theirs.reason("ring_gear"), "% of the domain's area"));
  EXPECT_TRUE(holds(theirs.reason("bracket"), "% of the model's area"));
  EXPECT_TRUE(holds(theirs.reason("hood"), "cannot be read"));
  EXPECT_TRUE(holds(theirs.reason("loft"), "meshes/loft.msh"));
  const auto again = delquad({"rerun", theirs.work / "out/gear/theirs/record.json"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  // A mesh belongs to the key of its cell alone.
  const auto listed = [&] { return theirs.run({"--dry-run"}).out; };
  EXPECT_TRUE(holds(listed(), "done           gear theirs"));
  fs::copy_file(theirs.file("circles"), theirs.file("gear"), fs::copy_options::overwrite_existing);
  EXPECT_TRUE(holds(listed(), "outdated       gear theirs", "done           circles theirs"));
}

TEST(Suite, PeersGetPackedModelsUnpacked) {
  Finished theirs;
  theirs.add("sphere_noisy", "sphere_noisy.obj.gz", "0.16");
  write_text(theirs.work / "theirs.toml",
             "[[peer]]\nname = 'theirs'\nversion = ['echo', '1']\ninput = 'obj'\noutput = 'obj'\n"
             "command = ['cp', '{input}', '{output}']\n");
  theirs.run();
  EXPECT_EQ(theirs.record("sphere_noisy").at("metrics").at("n_triangles"), 6912);
}

TEST(SuiteLong, MeshesBesideTheModelAreRefused) {
  Finished theirs;
  const auto moved = [&](const std::string& model, const std::string& of, const std::string& size, Vec3 by) {
    theirs.add(model, of, size);
    theirs.mesh(model, of, size);
    Mesh m = read_mesh(theirs.file(model));
    for (Vec3& p : m.points) p = p + by;
    write_mesh(theirs.file(model), m);
  };
  moved("gear", "gear.toml", "0.06", {0.2, 0, 0});
  moved("torus", "torus.step", "4", {0, 8, 0});
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
  theirs.add("fracture_network", "fracture_network.toml", "0.05");
  write_mesh(theirs.file("fracture_network"), grid);
  EXPECT_EQ(theirs.run().exit_code, 1);
  for (const char* model : {"gear", "torus"})
    EXPECT_TRUE(holds(theirs.reason(model), "no mesh of this model"));
  EXPECT_TRUE(holds(theirs.reason("fracture_network"), "do not follow the curves"));
}

/// Each hard model is meshed soundly by `fast`, or refused with one message; but for one that takes long.
TEST(SuiteLong, HardModelsAreSoundOrRefused) {
  const Folder work;
  const Experiment hard = Experiment::read(kSuite / "hard.toml");
  for (std::size_t i = 0; i < hard.n_cases(); i += 3) {
    const Case c = hard.read_variant(i);
    const fs::path file = c.model_file.empty() ? model_path(c) : c.model_file;
    if (file.stem() == "tiny_edges") continue;
    const auto run =
        delquad({"mesh", file, "-o", work / "m.msh", "--size", c.size.text, "--quality", "fast"});
    if (run.exit_code == 0) continue;
    EXPECT_EQ(run.exit_code, 2) << c.name << ": " << run.err;
    EXPECT_TRUE(holds(run.err, file.filename()));
  }
}

TEST(Suite, ItsCommandIsRefusedWithTheNewWay) {
  const auto run = delquad({"suite", "models", "-o", "x"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(holds(run.err, "delquad run experiments/suite/planar.toml"));
}

}  // namespace
}  // namespace delquad::testing_support
