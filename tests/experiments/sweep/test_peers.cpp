// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <sys/wait.h>

#include "delquad/mesher.h"
#include "experiments/sweep/domain_brep.h"
#include "experiments/sweep/run_experiment.h"
#include "experiments/sweep/run_program.h"
#include "experiments/sweep/verify.h"
#include "metrics/tables/result_records.h"
#include "tests/support/files.h"
#include "tests/support/needs_file.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

const std::string kPeerSquare =
    "[[case]]\nname = 'square'\nsize = 0.25\nloop = { rectangle = [[0, 0], [1, 1]] }\n";

/// Experiments with meshers that are shell scripts, which get the files to read and to write.
class Peers : public testing::Test {
 protected:
  /// The entry of a script that works on $1 and $2.
  std::string peer(const std::string& name, const std::string& script, const std::string& keys = "") {
    write_text(folder_ / (name + ".sh"), "#!/bin/sh\n" + script + "\n");
    fs::permissions(folder_ / (name + ".sh"), fs::perms::owner_all);
    return "[[peer]]\nname = \"" + name + "\"\ncommand = [\"./" + name +
           ".sh\", \"{input}\", \"{output}\"]\nversion = [\"echo\", \"1.0\"]\ninput = \"msh\"\n" + keys;
  }
  Experiment experiment(const std::string& pipelines, const std::string& text) {
    return Experiment::read(write_text(folder_ / "peers.toml", "pipelines = " + pipelines + "\n" + text));
  }
  std::string out() const { return (folder_ / "out").string(); }
  /// A mesh of the square by our own, for scripts to copy.
  std::string good_mesh() {
    const fs::path file = write_text(folder_ / "own.toml", "pipelines = ['DB']\n" + kPeerSquare);
    run_experiment(Experiment::read(file), folder_ / "own");
    return (folder_ / "own" / "square" / "DB" / "mesh.msh").string();
  }
  std::map<std::string, CellRecord> records() const {
    std::map<std::string, CellRecord> by_name;
    for (CellRecord& record : read_records(out())) by_name[record.pipeline] = std::move(record);
    return by_name;
  }

  Folder folder_;
};

/// Measures that look at the word are told of words alone.
TEST_F(Peers, AreVerifiedAsTheyWereMeasured) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // measures stay for the rest of a process
  const auto verified = [&] {
    add_metric({"letters", "letters", "", Better::kLower, 1, "a test"},
               [](const MetricInput& in) { return static_cast<double>(in.pipeline.size()); });
    run_experiment(experiment("[\"DB\", \"copy\"]",
                              peer("copy", "cp '" + good_mesh() + "' $2", "output = 'msh'\n") + kPeerSquare),
                   out());
    const Verification found = verify_results(out(), "");
    return found.measured == 2 && found.findings.empty() && records().at("DB").values.at("letters") == 2;
  };
  EXPECT_EXIT(std::exit(verified() ? 0 : 1), testing::ExitedWithCode(0), "");
}

TEST_F(Peers, AreMeasuredAsOurs) {
  const std::string text = peer("copy", "echo hello; cp '" + good_mesh() + "' $2") + kPeerSquare;
  const Experiment e = experiment("[\"DB\", \"copy\"]", text);
  const Outcome outcome = run_experiment(e, out());
  EXPECT_EQ(outcome.others_failed + outcome.bad_inputs, 0);
  const auto cells = records();
  for (const char* key : {"n_quads", "eta_mean", "eta_worst", "tau"})
    EXPECT_EQ(cells.at("copy").values.at(key), cells.at("DB").values.at(key)) << key;
  EXPECT_TRUE(std::isnan(cells.at("copy").values.at("seconds")));
  EXPECT_GT(cells.at("copy").values.at("seconds_total"), 0);
  const fs::path cell = fs::path(out()) / "square" / "copy";
  EXPECT_EQ(read_text(cell / "peer.log"), "hello\n");
  EXPECT_EQ(read_mesh(cell / "input.msh").lines.size(), 16u);
  const auto record = Json::parse(read_text(cell / "record.json"));
  EXPECT_EQ(record.at("peer").at("version_line"), "1.0");
  EXPECT_EQ(record.at("peer").at("command").size(), 3u);
  const Rerun again = rerun_record(cell / "record.json");
  EXPECT_TRUE(again.same_mesh);
  EXPECT_TRUE(again.differences.empty());
  EXPECT_TRUE(again.values.empty()) << again.values[0];
}

TEST_F(Peers, AnotherVersionIsAnotherCell) {
  const std::string text = peer("copy", "cp '" + good_mesh() + "' $2") + kPeerSquare;
  run_experiment(experiment("[\"copy\"]", text), out());
  EXPECT_EQ(list_cells(experiment("[\"copy\"]", text), out()), "done           square copy\n");
  std::string newer = text;
  newer.replace(newer.find("1.0"), 3, "2.0");
  EXPECT_EQ(list_cells(experiment("[\"copy\"]", newer), out()), "outdated       square copy\n");
}

/// Its mesh counts, but results of another version would be taken for its.
TEST_F(Peers, SayWhenTheyDoNotTellTheirVersion) {
  std::string text = peer("copy", "cp '" + good_mesh() + "' $2") + kPeerSquare;
  const std::string tells = "[\"echo\", \"1.0\"]";
  for (const auto& [version, why] : {std::pair("[\"true\"]", "true: prints no version"),
                                     std::pair("[\"sh\", \"-c\", \"exit 3\"]", "sh: ended with exit code 3"),
                                     std::pair("[\"no-such-mesher\"]", "no-such-mesher: not found")}) {
    fs::remove_all(out());
    std::string silent = text;
    silent.replace(silent.find(tells), tells.size(), version);
    const Outcome outcome = run_experiment(experiment("[\"copy\"]", silent), out());
    EXPECT_EQ(outcome.others_failed, 0);
    const std::string warning = std::string("square copy: its version is unknown: ") + why;
    const auto said = [&](const std::string& line) { return line.find(warning) != std::string::npos; };
    EXPECT_TRUE(std::ranges::any_of(records().at("copy").warnings, said)) << why;
    EXPECT_TRUE(std::ranges::any_of(outcome.table.notes, said)) << why;
  }
  text.replace(text.find(tells), tells.size(), "[\"sh\", \"-c\", \"echo; echo 7\"]");
  run_experiment(experiment("[\"copy\"]", text), out());
  EXPECT_TRUE(records().at("copy").warnings.empty());
  EXPECT_TRUE(
      holds(read_text(fs::path(out()) / "square" / "copy" / "record.json"), "\"version_line\": \"7\""));
}

TEST_F(Peers, AnotherScriptIsAnotherCell) {
  const std::string good = good_mesh(), text = peer("copy", "cp '" + good + "' $2") + kPeerSquare;
  run_experiment(experiment("[\"copy\"]", text), out());
  const auto record = Json::parse(read_text(fs::path(out()) / "square" / "copy" / "record.json"));
  EXPECT_TRUE(record.at("peer").at("content").contains("./copy.sh"));
  peer("copy", "cp '" + good + "' $2 # again");
  EXPECT_EQ(list_cells(experiment("[\"copy\"]", text), out()), "outdated       square copy\n");
}

TEST_F(Peers, FilesOfAnEarlierRunAreRemoved) {
  const std::string good = good_mesh();
  const std::string text = peer("copy", "echo 1 > notes.txt; cp '" + good + "' $2") + kPeerSquare;
  const fs::path notes = fs::path(out()) / "square" / "copy" / "notes.txt",
                 others = out() + "/square/copy/mine";
  run_experiment(experiment("[\"copy\"]", text), out());
  EXPECT_TRUE(fs::exists(notes));
  write_text(others, "of others");
  peer("copy", "cp '" + good + "' $2");
  run_experiment(experiment("[\"copy\"]", text), out());
  EXPECT_FALSE(fs::exists(notes));
  EXPECT_TRUE(fs::exists(others));
}

/// Arguments that name files beside the experiment stand for them, and are part of the cell, too.
TEST_F(Peers, ScriptsAreFoundBesideTheExperiment) {
  write_text(folder_ / "copy.sh", "cp '" + good_mesh() + "' $2\n");
  const std::string text =
      "[[peer]]\nname = 'copy'\ncommand = ['sh', 'copy.sh', '{input}', '{output}']\n"
      "version = ['echo', '1.0']\ninput = 'msh'\n" +
      kPeerSquare;
  EXPECT_EQ(run_experiment(experiment("[\"copy\"]", text), out()).others_failed, 0);
  write_text(folder_ / "copy.sh", "exit 3\n");
  EXPECT_EQ(list_cells(experiment("[\"copy\"]", text), out()), "outdated       square copy\n");
}

TEST_F(Peers, ThatFailLeaveWhatTheyReadAndPrinted) {
  const std::string text =
      peer("fails", "echo no luck; exit 3") + peer("hangs", "echo wait; sleep 100") + kPeerSquare;
  SweepOptions options;
  options.limits.seconds = 2;
  run_experiment(experiment("[\"fails\", \"hangs\"]", text), out(), options);
  for (const auto& [name, printed] : {std::pair("fails", "no luck\n"), std::pair("hangs", "wait\n")}) {
    const fs::path cell = fs::path(out()) / "square" / name;
    EXPECT_EQ(read_text(cell / "peer.log"), printed);
    EXPECT_EQ(read_mesh(cell / "input.msh").lines.size(), 16u);
    const auto record = Json::parse(read_text(cell / "record.json"));
    EXPECT_EQ(record.at("status"), "failed");
    EXPECT_TRUE(record.at("files").contains("peer.log"));
  }
}

/// Whatever a peer does, it costs its own cell and no other.
TEST_F(Peers, FailAlone) {
  const std::string good = good_mesh();
  Mesh broken = read_mesh(good);
  broken.quads.pop_back();
  broken.quad_region.pop_back();
  broken.lines.clear();
  broken.line_curve.clear();
  write_mesh(folder_ / "hole.msh", broken);
  Mesh moved = read_mesh(good);
  for (Vec3& p : moved.points) p.x += p.y * (1 - p.y) * 1e-3;  // as much area, another boundary
  write_mesh(folder_ / "moved.msh", moved);
  Mesh folded = read_mesh(good);
  std::swap(folded.quads[0][1], folded.quads[0][2]);
  write_mesh(folder_ / "folded.msh", folded);
  const auto copy = [&](const char* name) { return "cp '" + (folder_ / name).string() + "' $2"; };
  const std::string text = peer("crash", "kill -SEGV $$") + peer("code", "echo 'Error: no luck'; exit 3") +
                           peer("garbage", "head -c 3000 /dev/urandom > $2") + peer("mute", "true") +
                           peer("empty", ": > $2") + peer("hole", copy("hole.msh")) +
                           peer("moved", copy("moved.msh")) + peer("folded", copy("folded.msh")) +
                           kPeerSquare;
  const Outcome outcome = run_experiment(
      experiment(
          "[\"crash\", \"code\", \"garbage\", \"DB\", \"mute\", \"empty\", \"hole\", \"moved\", \"folded\"]",
          text),
      out());
  EXPECT_EQ(outcome.others_failed, 8);
  auto cells = records();
  EXPECT_EQ(cells.at("DB").reason, "");
  cells.erase("DB");
  const std::map<std::string, std::string> reasons = {{"crash", "ended by signal 11"},
                                                      {"code", "ended with exit code 3: Error: no luck"},
                                                      {"garbage", "its mesh cannot be read: output.msh"},
                                                      {"mute", "wrote no mesh"},
                                                      {"empty", "its mesh cannot be read"},
                                                      {"hole", "its mesh covers 93.75 %"},
                                                      {"moved", "boundary edges are not in its mesh"},
                                                      {"folded", "is not sound"}};
  for (const auto& [name, record] : cells) {
    EXPECT_EQ(record.kind, "peer") << name;
    EXPECT_TRUE(holds(record.reason, reasons.at(name))) << name << ": " << record.reason;
  }
}

/// Meshes of others are shown as they are, and said to be what they are.
TEST_F(Peers, MayMakeMeshesThatAreNotSound) {
  const std::string good = good_mesh();
  Mesh inverted = read_mesh(good);
  const auto middle = std::ranges::find_if(inverted.points, [](const Vec3& p) {
    return norm(p - Vec3{0.5, 0.5, 0}) < 1e-9;
  });
  ASSERT_NE(middle, inverted.points.end());
  *middle = {0.9, 0.9, 0};
  write_mesh(folder_ / "inverted.msh", inverted);
  const std::string text = peer("bad", "cp '" + (folder_ / "inverted.msh").string() + "' $2") +
                           peer("good", "cp '" + good + "' $2") + kPeerSquare;
  const Outcome outcome = run_experiment(experiment("[\"DB\", \"bad\", \"good\"]", text), out());
  EXPECT_EQ(outcome.others_failed + outcome.bad_inputs + outcome.unsound, 0);
  const auto cells = records();
  EXPECT_TRUE(cells.at("DB").unsound.empty());
  EXPECT_TRUE(cells.at("good").unsound.empty());
  ASSERT_FALSE(cells.at("bad").unsound.empty());
  EXPECT_TRUE(holds(cells.at("bad").unsound[0], "inverted or flat"));
  EXPECT_EQ(cells.at("bad").values.at("eta_worst"), 0);
  ASSERT_EQ(outcome.table.rows.size(), 3u);
  EXPECT_EQ(outcome.table.rows[1].unsound, "unsound");
  EXPECT_TRUE(holds(to_markdown(outcome.table), "| bad (unsound) ", "square bad is not sound: "));
  EXPECT_TRUE(rerun_record(fs::path(out()) / "square" / "bad" / "record.json").same_mesh);
}

/// Two tables of the size: the one that was given, and what became of it.
TEST(Sizes, TablesSayAgainstWhichTauIs) {
  const Folder folder;
  write_mesh(folder / "lens.msh", testing_support::lens(64, 12, 0.45));
  const auto file = write_text(folder / "e.toml",
                               "pipelines = ['DB']\n"
                               "[[case]]\nname = 'plain'\nmodel = 'lens.msh'\nsize = 0.3\n"
                               "[[case]]\nname = 'bent'\nmodel = 'lens.msh'\n"
                               "size = { base = 0.5, curvature = 24 }\n");
  const Outcome outcome = run_experiment(Experiment::read(file), folder / "out");
  ASSERT_EQ(outcome.table.rows.size(), 2u);
  const auto& plain = outcome.table.rows[0].values;
  const auto& bent = outcome.table.rows[1].values;
  EXPECT_EQ(plain.at("tau"), plain.at("tau_given"));
  EXPECT_GT(bent.at("tau"), bent.at("tau_given") + 5);
  const std::string text = to_markdown(outcome.table);
  EXPECT_TRUE(holds(text, "- plain: uniform delta = 0.3\n",
                    "- bent: delta = 0.5 was made smaller for curvature: tau is measured against that",
                    "| tau given |"));
}

/// A mesh whose elements run the other way round is a good mesh.
TEST_F(Peers, MayRunClockwise) {
  Mesh turned = read_mesh(good_mesh());
  for (auto& v : turned.quads) std::ranges::reverse(v);
  write_mesh(folder_ / "turned.msh", turned);
  const std::string text = peer("turned", "cp '" + (folder_ / "turned.msh").string() + "' $2") + kPeerSquare;
  run_experiment(experiment("[\"turned\"]", text), out());
  EXPECT_NEAR(records().at("turned").values.at("eta_worst"), 1, 1e-9);
}

/// Nothing that a peer started outlives the limit of its cell.
TEST_F(Peers, HangUntilTheTimeout) {
  NEEDS_FILE("/proc/self/stat");
  const std::string pid = (folder_ / "pid").string();
  const std::string text = peer("hang", "sleep 600 & echo $! > '" + pid + "'; wait") + kPeerSquare;
  SweepOptions options;
  options.limits.seconds = 1;
  EXPECT_EQ(run_experiment(experiment("[\"hang\", \"DB\"]", text), out(), options).others_failed, 1);
  EXPECT_EQ(records().at("hang").kind, "timeout");
  EXPECT_EQ(records().at("DB").reason, "");
  const int sleeper = std::stoi(read_text(pid));
  // Killed, and then reaped by whoever inherits it: a dead one may still be in the list.
  const auto runs = [&] {
    std::ifstream stat("/proc/" + std::to_string(sleeper) + "/stat");
    std::string number, name, state;
    return static_cast<bool>(stat >> number >> name >> state) && state != "Z";
  };
  for (int k = 0; k < 500 && runs(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(runs());
  EXPECT_FALSE(fs::exists(fs::path(out()) / "square" / ".hang.peer"));
}

TEST_F(Peers, ProgramsEndWithTheirLimit) {
  const ProgramRun run = run_program({"sleep", "600"}, folder_.path(), folder_ / "log", 1);
  EXPECT_TRUE(WIFSIGNALED(run.status));
  EXPECT_EQ(run_program({"no-such-program"}, folder_.path(), folder_ / "log").error, ENOENT);
}

/// A ring and a disc with a hole by a spline. An arc and a point lie inside.
TEST_F(Peers, CurvesAreTheModels) {
  const auto file =
      write_text(folder_ / "ring.toml",
                 "[[loop]]\ncircle = { centre = [0, 0], radius = 1 }\n"
                 "[[loop]]\ncircle = { centre = [0, 0], radius = 0.5 }\nregion = 'disc'\n"
                 "[[curve]]\nname = 'blob'\nspline = [[0.2, 0], [0.14, 0.14], [0, 0.2], [-0.14, 0.14], "
                 "[-0.2, 0], [-0.14, -0.14], [0, -0.2], [0.14, -0.14], [0.2, 0]]\n"
                 "[[loop]]\ncurves = ['blob']\nhole = true\n"
                 "[[embed]]\narc = { centre = [0, 0], radius = 0.75, from = 0, to = 60 }\n"
                 "[[embed]]\npoint = [0, -0.75]\n");
  MeshProblem problem = read_model_file(file);
  problem.size.text = "0.1";
  problem.seed = 3;
  const Prepared prepared = prepare(problem);
  write_domain_brep(folder_ / "ring.brep", prepared);
  MeshProblem as_cad;
  as_cad.model = CadModel{folder_ / "ring.brep"};
  const ModelReport report = model_info(as_cad, 0.01).report;
  ASSERT_EQ(report.faces.size(), 2u);
  EXPECT_NEAR(report.area, std::numbers::pi - 0.125, 5e-3) << "without the hole";
  ASSERT_EQ(report.curves.size(), 3u);
  for (const double length : {1.25, std::numbers::pi, 2 * std::numbers::pi})
    EXPECT_TRUE(std::ranges::any_of(report.curves, [&](const CurveReport& curve) {
      return std::abs(curve.length / length - 1) < 2e-3;
    })) << length;
  const std::string text = read_text(folder_ / "ring.brep");
  EXPECT_TRUE(holds(text, "\n7 0 0 3 ")) << "the spline is cubic";
}

/// Gmsh itself: its size is ours, number or field, and it divides the curves of a model. It also gets
/// triangulations whose file it may not read.
using PeersPrograms = Peers;
TEST_F(PeersPrograms, GmshMeshesWhatWeMesh) {
  if (std::system("gmsh --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
  const std::string text =
      "[[peer]]\nname = 'gmsh'\nversion = ['gmsh', '--version']\n"
      "command = ['gmsh', '{input}', '-2', '-o', '{output}', '-nt', '1', '-setnumber', 'Mesh.RecombineAll', "
      "'1', '-setnumber', 'Mesh.Algorithm', '6']\n"
      "[[case]]\nname = 'graded'\nsize = '0.02 + 0.2*x'\n"
      "[[case.loop]]\nrectangle = [[0, 0], [1, 1]]\n[[case.loop]]\ncircle = { centre = [0.5, 0.5], radius = "
      "0.2 }\n"
      "region = 'disc'\n"
      "[[case]]\nname = 'turned'\nseed = 3\nsize = 0.1\nloop = { rectangle = [[0, 0], [2, 1]] }\n"
      "[[case]]\nname = 'inside'\nsize = 0.1\nembed = [{ arc = { centre = [0, 0], radius = 0.75, from = 0, "
      "to = 60 } }, { point = [0, -0.75] }]\nloop = { circle = { centre = [0, 0], radius = 1 } }\n"
      "[[case]]\nname = 'lens'\nsize = 0.1\nmodel = 'lens.obj'\n";
  write_mesh(folder_ / "lens.obj", testing_support::lens(64, 12, 0.45));
  run_experiment(experiment("[\"DB\", \"gmsh\"]", text), out());
  std::map<std::string, double> quads;
  for (const CellRecord& record : read_records(out())) {
    EXPECT_EQ(record.reason, "") << record.group << " " << record.pipeline;
    quads[record.name + record.pipeline] = record.values.at("n_elements");
  }
  const Mesh made = read_mesh(fs::path(out()) / "inside" / "gmsh" / "mesh.msh");
  const auto nodes_at = [&](double radius) {
    return std::ranges::count_if(made.points,
                                 [&](const Vec3& p) { return std::abs(norm(p) - radius) < 1e-8; });
  };
  EXPECT_GT(nodes_at(1), 50);
  EXPECT_GT(nodes_at(0.75), 8);
  EXPECT_TRUE(std::ranges::any_of(made.points, [](const Vec3& p) {
    return norm(p - Vec3{0, -0.75, 0}) < 1e-8;
  }));
  for (const char* name : {"graded", "turned", "inside", "lens"})
    EXPECT_NEAR(quads.at(std::string(name) + "gmsh") / quads.at(std::string(name) + "DB"), 1.1, 0.3) << name;
}

}  // namespace
}  // namespace delquad
