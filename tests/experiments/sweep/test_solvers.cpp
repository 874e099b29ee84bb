// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/cells.h"
#include "experiments/sweep/run_experiment.h"
#include "experiments/sweep/schema.h"
#include "experiments/sweep/verify.h"
#include "metrics/solve/solver_metrics.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr const char* kSolverSquare =
    "[[case]]\nname = 'square'\nloop = { rectangle = [[0, 0], [1, 1]] }\nsize = 0.1\n";
constexpr const char* kBall = "[[case]]\nname = 'ball'\nexample = 'sphere'\nsize = 12\n";

class Solvers : public testing::Test {
 protected:
  Experiment read(const std::string& head, const std::string& cases = kSolverSquare) {
    return Experiment::read(write_text(folder_ / "e.toml", head + cases));
  }
  Outcome run(const std::string& head, const std::string& cases = kSolverSquare) {
    return run_experiment(read(head, cases), folder_ / "out");
  }
  Json record(const std::string& cell) {
    return Json::parse(std::ifstream(folder_ / "out" / cell / "record.json"));
  }
  Folder folder_;
};

TEST_F(Solvers, MeasureEveryMeshWhereTheyAreAskedFor) {
  const Outcome outcome =
      run("pipelines = ['D', 'DB']\nsolver = ['poisson', 'elasticity']\ncolumns = ['poisson_h1']\n");
  EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0);
  for (const char* word : {"D", "DB"}) {
    const Json json = record(std::string("square/") + word);
    const Mesh mesh = read_mesh(folder_ / "out" / "square" / word / "mesh.msh");
    for (const std::string& solver : solver_names())
      for (const auto& [key, value] : measure_by_solver(mesh, solver).values)
        EXPECT_NEAR(json["metrics"][key].get<double>() / value, 1, 1e-9) << word << ' ' << key;
    EXPECT_TRUE(json["seconds"].contains("solvers"));
    EXPECT_FALSE(json.contains("failed_metrics"));
  }
  EXPECT_EQ(outcome.table.rows.at(1).values.at("poisson_h1"), record("square/DB")["metrics"]["poisson_h1"]);
  fs::remove_all(folder_ / "out");
  run("pipelines = ['DB']\n");
  EXPECT_FALSE(record("square/DB")["metrics"].contains("poisson_h1"));
}

TEST_F(Solvers, BelongToWhatDeterminesACell) {
  const auto key = [&](const std::string& head) {
    const Experiment experiment = read("pipelines = ['DB']\n" + head);
    return identify(experiment, experiment.read_variant(0), "model", experiment.parsed[0]).key;
  };
  const std::string none = key(""), one = key("solver = ['poisson']\n"),
                    two = key("solver = ['poisson', 'elasticity']\n");
  EXPECT_EQ(none, key("solver = []\n"));
  EXPECT_NE(none, one);
  EXPECT_NE(one, two);
}

TEST_F(Solvers, SayWhyThereIsNoValueAndAreNotAskedAgain) {
  const std::string head = "pipelines = ['DB']\nsolver = ['elasticity', 'poisson']\n";
  const Outcome outcome = run(head, kBall);
  EXPECT_EQ(outcome.metrics_failed, 0);
  const Json json = record("ball/DB");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_TRUE(json["metrics"]["elasticity_h1"].is_null());
  EXPECT_GT(json["metrics"]["poisson_h1"], 0);
  EXPECT_TRUE(holds(json["failed_metrics"]["elasticity"].get<std::string>(), "planar"));
  EXPECT_TRUE(std::ranges::any_of(outcome.table.notes, [](const std::string& note) {
    return note.find("no 'elasticity' of ball DB: elasticity needs a planar mesh") != note.npos;
  }));
  const fs::path file = folder_ / "out" / "ball" / "DB" / "record.json";
  const auto written = fs::last_write_time(file);
  run(head, kBall);
  EXPECT_EQ(fs::last_write_time(file), written);
}

TEST_F(Solvers, AreThoseOfTheSchema) {
  const Json names = Json::parse(experiment_schema())["properties"]["solver"]["items"]["enum"];
  EXPECT_EQ(names.get<Strings>(), solver_names());
}

constexpr const char* kLayer =
    "[[case]]\nname = 'layer'\nloop = { rectangle = [[0, 0], [1, 1]] }\nquads = 300\n"
    "solution = 'tanh(30*(x^2+y^2-0.5))'\nsize = '0.02+0.2*abs(x^2+y^2-0.5)'\n";

TEST_F(Solvers, MeshesFollowASolution) {
  const Outcome outcome =
      run("pipelines = ['DB']\nsolver = ['poisson']\n[matrix]\nadapt.kind = ['uniform', 'given', 'squares', "
          "'stretched']\nadapt.meshes = [3]\n",
          kLayer);
  EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0);
  std::map<std::string, double> h1;
  for (const std::string kind : {"uniform", "given", "squares", "stretched"}) {
    const Json json = record("layer@kind=" + kind + ",meshes=3/DB");
    h1[kind] = json["metrics"]["poisson_h1"];
    EXPECT_NEAR(json["metrics"]["n_quads"].get<double>(), 300, 45) << kind;
    EXPECT_EQ(json["seconds"].contains("loop"), kind == "squares" || kind == "stretched");
  }
  EXPECT_LT(h1["given"], 0.8 * h1["uniform"]);
  EXPECT_LT(h1["squares"], 0.8 * h1["uniform"]);
  EXPECT_LT(h1["stretched"], 0.75 * h1["squares"]);
  const Rerun again = rerun_record(folder_ / "out" / "layer@kind=stretched,meshes=3" / "DB" / "record.json");
  EXPECT_TRUE(again.same_mesh);
  EXPECT_TRUE(again.values.empty());
  fs::remove_all(folder_ / "out");
  // The domain stays where its solution is.
  run("pipelines = ['DB']\nsolver = ['poisson']\n[matrix]\nadapt.kind = ['uniform', 'stretched']\nseed = "
      "[3]\n",
      kLayer);
  EXPECT_NEAR(record("layer@kind=uniform,seed=3/DB")["metrics"]["poisson_h1"], h1["uniform"],
              0.2 * h1["uniform"]);
  EXPECT_LT(record("layer@kind=stretched,seed=3/DB")["metrics"]["poisson_h1"], 1.1 * h1["stretched"]);
}

}  // namespace
}  // namespace delquad
