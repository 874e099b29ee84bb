// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>

#include "delquad/extend.h"
#include "experiments/sweep/run_experiment.h"
#include "experiments/sweep/verify.h"
#include "metrics/tables/result_records.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

const std::string kCalibratedSquare =
    "[[case]]\nname = 'square'\nsize = 0.1\nloop = { rectangle = [[0, 0], [1, 1]] }\n";
const std::string kGraded =
    "[[case]]\nname = 'graded'\nsize = '0.1 + 0.05*x'\nloop = { rectangle = [[0, 0], [1, 1]] }\n";

/// A square of n times n quads: a script that needs n in $n.
const std::string kGrid =
    "awk -v n=\"$n\" 'BEGIN { for (j = 0; j <= n; ++j) for (i = 0; i <= n; ++i) print \"v\", i / n, j / n, "
    "0\n"
    "for (j = 0; j < n; ++j) for (i = 1; i <= n; ++i) { a = j * (n + 1) + i; print \"f\", a, a + 1, a + n + "
    "2, a + n + 1 } }' > $2";
/// n = 1.3/size.
const std::string kCoarserGrid = "n=$(awk -v h=\"$3\" 'BEGIN { print int(1 / (1.3 * h) + .5) }')\n" + kGrid;

class CalibratedPeers : public testing::Test {
 protected:
  /// The entry of a script that gets input, output and what `arguments` says.
  std::string peer(const std::string& name, const std::string& script,
                   const std::string& arguments = "\"{size}\"", const std::string& keys = "") {
    write_text(folder_ / (name + ".sh"), "#!/bin/sh\n" + script + "\n");
    fs::permissions(folder_ / (name + ".sh"), fs::perms::owner_all);
    return "[[peer]]\nname = \"" + name + "\"\ncommand = [\"./" + name + ".sh\", \"{input}\", \"{output}\"" +
           (arguments.empty() ? "" : ", " + arguments) +
           "]\nversion = ['echo', '1.0']\ninput = 'msh'\noutput = 'obj'\nkeeps_boundary = false\n" + keys;
  }
  Experiment experiment(const std::string& text) {
    return Experiment::read(write_text(folder_ / "peers.toml", text));
  }
  fs::path out() const { return folder_ / "out"; }
  std::map<std::string, CellRecord> records() const {
    std::map<std::string, CellRecord> by_name;
    for (CellRecord& record : read_records(out())) by_name[record.pipeline] = std::move(record);
    return by_name;
  }
  Json record_of(const std::string& name, const std::string& pipeline) const {
    return Json::parse(read_text(out() / name / pipeline / "record.json"));
  }

  Folder folder_;
};

TEST_F(CalibratedPeers, HaveOurNumberOfQuads) {
  const std::string peers =
      peer("grid", kCoarserGrid) + peer("plain", kCoarserGrid, "\"{size}\"", "calibrate = 'none'\n");
  const Outcome outcome = run_experiment(
      experiment("pipelines = ['DB', 'grid', 'plain']\ncalibrate = 'quads'\n" + peers + kCalibratedSquare),
      out());
  EXPECT_EQ(outcome.others_failed + outcome.bad_inputs, 0);
  const auto cells = records();
  EXPECT_EQ(cells.at("DB").values.at("n_quads"), 100);
  EXPECT_EQ(cells.at("grid").values.at("n_quads"), 100);
  EXPECT_EQ(cells.at("plain").values.at("n_quads"), 64);
  EXPECT_FALSE(cells.at("plain").calibration);
  ASSERT_TRUE(cells.at("grid").calibration);
  const CalibrationRecord& done = *cells.at("grid").calibration;
  EXPECT_EQ(done.to, "DB");
  EXPECT_EQ(done.wanted, 100);
  EXPECT_EQ(done.quads, 100);
  EXPECT_GT(done.runs, 1);
  EXPECT_NEAR(done.size_factor, 1 / 1.3, 0.04);
  EXPECT_TRUE(holds(to_markdown(outcome.table),
                    "- square grid: size times 0.8, so that it has DB's number of quads"));
  for (const Table* table : {&outcome.table, &outcome.pairs})
    EXPECT_EQ(std::ranges::count(table->notes,
                                 "Calibrated, by their sizes, to DB's number of quads: grid. Not calibrated, "
                                 "beside it: plain -36 %"),
              1)
        << table->title;
  EXPECT_TRUE(rerun_record(out() / "square" / "grid" / "record.json").same_mesh);
}

/// Whether our mesh is there already, is made beside, or is not asked for: the number is the same.
TEST_F(CalibratedPeers, NeedNoRecordOfOurs) {
  const std::string text =
      "pipelines = ['DB', 'grid']\ncalibrate = 'quads'\n" + peer("grid", kCoarserGrid) + kCalibratedSquare;
  Experiment alone = experiment(text);
  alone.parsed = alone.find_pipelines({"grid"});
  run_experiment(alone, out());
  EXPECT_EQ(records().at("grid").calibration->wanted, 100);
  const std::string record = read_text(out() / "square" / "grid" / "mesh.msh");
  run_experiment(experiment(text), folder_ / "both");
  EXPECT_EQ(read_text(folder_ / "both" / "square" / "grid" / "mesh.msh"), record);
}

/// Its failure is not told as the peer's, which is not run.
TEST_F(CalibratedPeers, AreNotBlamedForOurWord) {
  add_stage({'X', "crash", PatchForm::kQuads, PatchForm::kQuads,
             [](const StageInput&, PatchMesh&, StageLog&) { raise(SIGKILL); }});
  const std::string text = "pipelines = ['grid']\ncalibrate = 'quads'\ncalibrate_to = 'DBX'\n" +
                           peer("grid", kCoarserGrid) + kCalibratedSquare;
  EXPECT_EQ(run_experiment(experiment(text), out()).others_failed, 1);
  const CellRecord cell = records().at("grid");
  EXPECT_EQ(cell.kind, "crash");
  EXPECT_EQ(
      cell.reason.find("our pipeline DBX, whose number of quads it was to have, failed: ended by signal 9"),
      0u)
      << cell.reason;
  EXPECT_TRUE(holds(cell.reason, "; the peer was not run"));
  EXPECT_FALSE(fs::exists(out() / "square" / "grid" / "peer.log"));
}

TEST_F(CalibratedPeers, AreOtherCellsForAnotherWord) {
  const std::string peers = peer("grid", kCoarserGrid) + kCalibratedSquare;
  const std::string head = "pipelines = ['grid']\ncalibrate = 'quads'\n";
  run_experiment(experiment(head + "calibrate_to = 'DB'\n" + peers), out());
  EXPECT_EQ(list_cells(experiment(head + "calibrate_to = \"DB\"\n" + peers), out()),
            "done           square grid\n");
  EXPECT_EQ(list_cells(experiment(head + "calibrate_to = \"FB\"\n" + peers), out()),
            "outdated       square grid\n");
}

/// A mesher that divides each boundary edge in two: our edges at our size would make four times our number.
TEST_F(CalibratedPeers, GetTheBoundaryOfTheScaledSize) {
  const std::string edges = "n=$(awk '$1 == \"l\" { n += NF - 2 } END { print n / 2 }' $1)\n";
  std::string entry = peer("halves", edges + kGrid, "");
  entry.replace(entry.find("input = 'msh'"), 13, "input = 'obj'");
  const Outcome outcome = run_experiment(
      experiment("pipelines = ['DB', 'halves']\ncalibrate = 'quads'\n" + entry + kCalibratedSquare), out());
  EXPECT_EQ(outcome.others_failed, 0) << to_markdown(outcome.table);
  const auto cells = records();
  EXPECT_EQ(cells.at("halves").values.at("n_quads"), 100);
  EXPECT_NEAR(cells.at("halves").calibration->size_factor, 2, 0.05);
  EXPECT_EQ(read_mesh(out() / "square" / "halves" / "input.obj").lines.size(), 20u)
      << "of the run that was kept";
  EXPECT_FALSE(fs::exists(out() / "square" / "halves" / "kept"));
}

TEST_F(CalibratedPeers, SayHowFarTheyAreOff) {
  const Outcome outcome = run_experiment(experiment("pipelines = ['DB', 'deaf']\ncalibrate = 'quads'\n" +
                                                    peer("deaf", "n=8\n" + kGrid) + kCalibratedSquare),
                                         out());
  EXPECT_EQ(records().at("deaf").calibration->runs, 2);
  EXPECT_TRUE(
      holds(to_markdown(outcome.table),
            "square deaf: size times 1, and yet 1 of 1 meshes miss DB's number of quads, by -36 % at most"));
}

/// The first mesh stands when a further run fails, and its log and input are what is kept.
TEST_F(CalibratedPeers, KeepWhatTheyHaveWhenARunFails) {
  const std::string script = "echo \"size $3\"\n[ \"$3\" = 0.1 ] || exit 4\nn=8\n" + kGrid;
  const Outcome outcome = run_experiment(experiment("pipelines = ['DB', 'once']\ncalibrate = 'quads'\n" +
                                                    peer("once", script) + kCalibratedSquare),
                                         out());
  EXPECT_EQ(outcome.others_failed, 0);
  EXPECT_EQ(read_text(out() / "square" / "once" / "peer.log"), "size 0.1\n");
  EXPECT_TRUE(holds(records().at("once").calibration->ended_by, "exit code 4"));
  EXPECT_TRUE(holds(to_markdown(outcome.table), " % at most: "));
}

/// Nothing has failed where a mesher cannot be told a case.
TEST_F(CalibratedPeers, MayBeNotApplicable) {
  const std::string peers = peer("number", "true") + peer("surfaces", "true", "", "planar = 'none'\n") +
                            peer("code", "echo working; echo 'needs a cube'; exit 77", "") +
                            "[[peer]]\nname = 'absent'\ncommand = ['no-such-mesher', '{input}', "
                            "'{output}']\nversion = ['no-such-mesher']\n";
  const std::string text = "pipelines = ['DB', 'number', 'surfaces', 'code', 'absent']\n" + peers + kGraded;
  const Outcome outcome = run_experiment(experiment(text), out());
  EXPECT_EQ(outcome.others_failed + outcome.bad_inputs + outcome.unsound, 0);
  auto cells = records();
  cells.erase("DB");
  const std::map<std::string, std::string> reasons = {{"number", "takes one size"},
                                                      {"surfaces", "meshes no planar domains"},
                                                      {"code", "needs a cube"},
                                                      {"absent", "no-such-mesher is not installed"}};
  ASSERT_EQ(cells.size(), reasons.size());
  for (const auto& [name, cell] : cells) {
    EXPECT_EQ(cell.kind, "not applicable") << name;
    EXPECT_TRUE(holds(cell.reason, reasons.at(name))) << name << ": " << cell.reason;
    EXPECT_TRUE(holds(list_cells(experiment(text), out()), "not applicable graded " + name));
  }
  const std::string table = to_markdown(outcome.table);
  EXPECT_TRUE(
      holds(table, "| code     |   0 | not applicable |", "- graded code is not applicable: needs a cube"));
}

/// For a surface whose faces the case changes, the file would not do.
TEST_F(CalibratedPeers, AreNotGivenFilesOfChangedSurfaces) {
  write_mesh(folder_ / "lens.msh", testing_support::lens(24, 6, 0.45));
  const std::string text = "pipelines = ['file', 'mesh']\n" + peer("file", "exit 1", "") +
                           peer("mesh", "cp $1 $2", "", "surfaces = 'triangles'\n") +
                           "[[case]]\nname = 'lens'\nmodel = 'lens.msh'\nsize = 0.3\n"
                           "surface = { compound = 'all' }\n";
  std::string with_obj = text;
  with_obj.replace(with_obj.rfind("input = 'msh'"), 13, "input = 'obj'");
  EXPECT_EQ(run_experiment(experiment(with_obj), out()).others_failed, 0);
  EXPECT_EQ(records().at("file").kind, "not applicable");
  EXPECT_EQ(records().at("mesh").reason, "");
  EXPECT_GT(records().at("mesh").values.at("n_triangles"), 50);
}

TEST_F(CalibratedPeers, GetSizesAtPoints) {
  const std::string keep = "cp \"$3\" told.txt 2>/dev/null\nn=8\n" + kGrid;
  for (const char* format : {"points", "sol", "pos"}) {
    const std::string text =
        "pipelines = ['field']\n" +
        peer("field", keep, "\"{size_field}\"", "size_field = \"" + std::string(format) + "\"\n") + kGraded;
    EXPECT_EQ(run_experiment(experiment(text), out()).others_failed, 0) << format;
    EXPECT_TRUE(fs::exists(out() / "graded" / "field" / ("size." + std::string(format))));
  }
  const std::string text = "pipelines = ['field']\n" +
                           peer("field", keep, "\"{size_field}\"", "size_field = 'points'\n") + kGraded;
  run_experiment(experiment(text), out());
  std::ifstream points(out() / "graded" / "field" / "size.points");
  double x, y, z, delta;
  int n = 0;
  for (; points >> x >> y >> z >> delta; ++n) EXPECT_NEAR(delta, 0.1 + 0.05 * x, 1e-12);
  EXPECT_GT(n, 50);
}

/// Peers that know a metric get tensors in the domain's own plane, which calibration scales; others would be
/// told something else.
TEST_F(CalibratedPeers, GetTensorsWhereThereIsAMetric) {
  const std::string script =
      "n=$(awk 'NR == 6 { print int(sqrt(sqrt($1 * $3)) / 1.3 + .5) }' $3)\nls $4 > told.txt\n" + kGrid;
  const std::string text =
      "pipelines = ['DB', 'tensor', 'sizes']\ncalibrate = 'quads'\n" +
      peer("tensor", script, "\"{size_field}\", \"{data}/{case}\"", "size_field = 'sol'\nmetrics = true\n") +
      peer("sizes", script, "\"{size_field}\"", "size_field = 'sol'\n") +
      "[[case]]\nname = 'square'\nmetric = { sizes = ['0.1', '0.025'] }\nloop = { rectangle = [[0, 0], [1, "
      "1]] }\n";
  fs::create_directories(folder_ / "data" / "square");
  write_text(folder_ / "data" / "square" / "here", "");
  Experiment e = Experiment::read(write_text(folder_ / "peers.toml", text), folder_ / "data");
  EXPECT_EQ(run_experiment(e, out()).others_failed, 0);
  const auto cells = records();
  EXPECT_EQ(cells.at("sizes").kind, "not applicable");
  EXPECT_TRUE(holds(cells.at("sizes").reason, "is told sizes, and the case has a metric"));
  ASSERT_EQ(cells.at("tensor").reason, "");
  EXPECT_EQ(cells.at("DB").values.at("n_quads"), 400);
  EXPECT_EQ(cells.at("tensor").values.at("n_quads"), 400);
  EXPECT_NEAR(cells.at("tensor").calibration->size_factor, 1 / 1.3, 0.04);
  const fs::path cell = out() / "square" / "tensor";
  EXPECT_EQ(read_text(cell / "told.txt"), "here\n");
  std::ifstream sol(cell / "size.sol");
  std::string word;
  for (int i = 0; i < 8; ++i) sol >> word;
  double xx, xy, yy;
  ASSERT_TRUE(sol >> xx >> xy >> yy);
  EXPECT_NEAR(yy / xx, 16, 1e-6);
  EXPECT_NEAR(xy / xx, 0, 1e-6);
  const Mesh lines = read_mesh(cell / "input.msh");
  for (const Vec3& p : lines.points)
    EXPECT_TRUE(p.x == 0 || p.x == 1 || p.y == 0 || p.y == 1) << p.x << " " << p.y;
}

TEST_F(CalibratedPeers, AreReadFromFilesOfTheirOwn) {
  fs::create_directory(folder_ / "meshers");
  const std::string entry = peer("grid", kCoarserGrid);
  fs::rename(folder_ / "grid.sh", folder_ / "meshers" / "grid.sh");
  write_text(folder_ / "meshers" / "grid.toml", entry);
  run_experiment(
      experiment("pipelines = ['DB', 'grid']\npeer_files = ['meshers/grid.toml']\n" + kCalibratedSquare),
      out());
  EXPECT_EQ(records().at("grid").values.at("n_quads"), 64);

  Experiment added = experiment("pipelines = ['DB']\ncalibrate = 'quads'\n" + kCalibratedSquare);
  EXPECT_EQ(added.add_peer_file(folder_ / "meshers" / "grid.toml"), Strings{"grid"});
  added.parsed = added.find_pipelines({"DB", "grid"});
  run_experiment(added, folder_ / "added");
  EXPECT_EQ(read_mesh(folder_ / "added" / "square" / "grid" / "mesh.msh").quads.size(), 100u);
  EXPECT_TRUE(rerun_record(folder_ / "added" / "square" / "grid" / "record.json").same_mesh);

  write_text(folder_ / "none.toml", "title = 'x'\n");
  expect_input_error([&] { added.add_peer_file(folder_ / "none.toml"); }, {"none.toml", "title"});
  write_text(folder_ / "none.toml", "");
  expect_input_error([&] { added.add_peer_file(folder_ / "none.toml"); }, {"none.toml", "[[peer]]"});
  expect_input_error([&] { added.add_peer_file(folder_ / "meshers" / "grid.toml"); }, {"second peer 'grid'"});
}

using CalibratedPeersPrograms = CalibratedPeers;
/// A graded size on a surface, as a view on our triangles.
TEST_F(CalibratedPeersPrograms, GmshFollowsSizesOnSurfaces) {
  if (std::system("gmsh --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
  Experiment e = experiment(
      "pipelines = ['DB']\ncalibrate = 'quads'\n[[case]]\nname = 'bracket'\nexample = 'bracket'\nsize = '3 + "
      "0.05*x'\n");
  e.add_peer_file(fs::path(DELQUAD_SOURCE_DIR) / "experiments/peers/adapters/gmsh.toml");
  e.parsed = e.find_pipelines({"DB", "gmsh"});
  run_experiment(e, out());
  const auto cells = records();
  ASSERT_EQ(cells.at("gmsh").reason, "");
  EXPECT_GT(cells.at("gmsh").values.at("tau"), 75) << "edges are as long as the size says";
  EXPECT_NEAR(cells.at("gmsh").calibration->quads / cells.at("gmsh").calibration->wanted, 1, 0.1);
}

/// The adapters that come with the project, each on a planar domain and on a surface: a mesh, or a reason why
/// not.
TEST_F(CalibratedPeersPrograms, AdaptersMeshOrSayWhyNot) {
  const fs::path folder = fs::path(DELQUAD_SOURCE_DIR) / "experiments/peers/adapters";
  Experiment e = experiment(
      "pipelines = ['DB']\ncalibrate = 'quads'\n"
      "[[case]]\nname = 'ring'\nsize = 0.1\nloop = [{ circle = { centre = [0, 0], radius = 1 } }, { circle = "
      "{ centre = [0, 0], radius = 0.3 } }]\n"
      "[[case]]\nname = 'sphere'\nexample = 'sphere'\nsize = 3\n");
  Strings pipelines = {"DB"};
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string text = read_text(entry.path());
    EXPECT_LE(std::ranges::count(text, '\n'), 50) << entry.path();
    if (entry.path().extension() != ".toml") continue;
    for (const std::string& name : e.add_peer_file(entry.path())) pipelines.push_back(name);
  }
  ASSERT_GE(pipelines.size(), 9u);
  e.parsed = e.find_pipelines(pipelines);
  run_experiment(e, out());
  int meshes = 0;
  for (const CellRecord& cell : read_records(out())) {
    EXPECT_TRUE(cell.reason.empty() || cell.kind == "not applicable")
        << cell.name << " " << cell.pipeline << ": " << cell.reason;
    if (!cell.reason.empty() || !cell.calibration) continue;
    ++meshes;
    EXPECT_NEAR(cell.calibration->quads / cell.calibration->wanted, 1, 0.15)
        << cell.name << " " << cell.pipeline;
    const bool keeps_triangles = cell.pipeline == "bamg-triangles";
    EXPECT_GT(cell.values.at("percent_quads"), keeps_triangles ? -1 : 50)
        << cell.name << " " << cell.pipeline;
  }
  if (meshes == 0) GTEST_SKIP() << "none of the other meshers is installed";
}

/// Programs that no package has: their adapters talk to stubs that take what the programs take.
TEST_F(CalibratedPeers, AdaptersSpeakToProgramsThatAreAbsentHere) {
  const fs::path bin = folder_ / "bin", wild = folder_ / "wild", programs = wild / "build/Build/bin";
  for (const fs::path& at : {bin, programs, wild / "config/prep_config", wild / "config/main_config"})
    fs::create_directories(at);
  const auto stub = [](const fs::path& file, const std::string& script) {
    write_text(file, "#!/bin/sh\n" + script);
    fs::permissions(file, fs::perms::owner_all);
  };
  stub(bin / "instant-meshes", "[ \"$1 $2 $3 $4 $5 $7\" = '-d -b -c 40 -s -o' ] && cp \"$9\" \"$8\"\n");
  stub(bin / "quadriflow",
       "[ \"$1 $2 $3 $4 $6 $8 ${10}\" = '-sharp -boundary -mcf -seed -f -i -o' ] && cp \"$9\" \"${11}\"\n");
  stub(bin / "mmgs_O3",
       "[ $1 = -h ] && echo '  -- MMGS, Release 5.8.0 (2024)' && exit\n"
       "[ \"$1 $3 $5 $7 $8 $9\" = '-in -sol -hausd -hgrad -1 -out' ] && cp \"$2\" \"${10}\"\n");
  fs::create_symlink(DELQUAD_PROGRAM, bin / "delquad");
  stub(bin / "TQMesh",
       "[ $# = 1 ] || { echo '  Version 1.4'; exit; }\n"
       "[ $(grep -c '^[01], [01], 1$' $1) = 4 ] && grep -q '^End exterior boundary$' $1 || exit 1\n"
       "printf 'MESH 1\\nVERTICES 4\\n0,0\\n1,0\\n1,1\\n0,1\\nQUADS 1\\n 0, 1, 2, 3, 1\\nTRIANGLES 0\\n' > "
       "out.txt\n");
  stub(bin / "gmsh",
       "[ $1 = --version ] && echo 4.15.2 && exit\n"
       "case \"$*\" in *'Mesh.Algorithm 11 '*) exec cp " +
           (folder_ / "square.msh").string() + " \"$4\" ;; esac\n");
  write_text(
      folder_ / "square.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
      "$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n");
  stub(programs / "quadwild", "[ $2 = 2 ] && [ -f \"$3\" ] && grep -v '^l' $1 > mesh_rem_p0.obj\n");
  stub(programs / "quad_from_patches",
       "[ $2 = 123 ] && grep scaleFact $3 && cp $1 mesh_rem_p0_123_quadrangulation_smooth.obj\n");
  write_text(wild / "config/prep_config/basic_setup_Mechanical.txt", "do_remesh 1\n");
  write_text(wild / "config/main_config/flow_noalign_lemon.txt",
             "alpha 0.005\nscaleFact 1\nscaleFactInt 2\n");
  const std::string path = std::getenv("PATH");
  setenv("PATH", (bin.string() + ":" + path).c_str(), 1);
  setenv("QUADWILD", wild.c_str(), 1);
  Experiment e = experiment(
      "pipelines = ['DB']\n[[case]]\nname = 'sphere'\nexample = 'sphere'\nsize = 3\n"
      "[[case]]\nname = 'square'\nsize = 1\nloop = { rectangle = [[0, 0], [1, 1]] }\n"
      "[[case]]\nname = 'touching'\nsize = 0.5\nloop = [{ rectangle = [[0, 0], [2, 1]] }, { polygon = [[0, "
      "0], [1, 0.3], [0.5, 0.7]] }]\n");
  for (const char* name : {"gmsh", "instant_meshes", "mmg", "quadriflow", "quadwild", "tqmesh"})
    e.add_peer_file(fs::path(DELQUAD_SOURCE_DIR) / "experiments/peers/adapters" /
                    (std::string(name) + ".toml"));
  e.parsed =
      e.find_pipelines({"instant-meshes", "mmg", "quadriflow-source", "quadwild", "tqmesh", "gmsh-quasi"});
  run_experiment(e, out());
  const std::string peers = DELQUAD_SOURCE_DIR "/experiments/peers/adapters/";
  const auto answer = [&](Strings words) { return run_program("/bin/sh", {std::move(words), 0, {}}); };
  EXPECT_EQ(answer({peers + "mmg.sh", "--version"}).out.find("5.8.0 (2024), delquad "), 0u);
  EXPECT_EQ(answer({peers + "gmsh.sh", "3.0.6", "11", "1", "a.geo", "a.msh"}).exit_code, 77);
  setenv("PATH", path.c_str(), 1);
  unsetenv("QUADWILD");
  const auto touching = record_of("touching", "tqmesh");
  EXPECT_EQ(touching.at("status"), "not applicable");
  EXPECT_TRUE(holds(touching.at("reason").get<std::string>(), "touch in a node")) << touching;
  Strings meshed;
  for (const CellRecord& cell : read_records(out())) {
    if (cell.reason.empty()) meshed.push_back(cell.name + " " + cell.pipeline);
    EXPECT_NE(record_of(cell.name, cell.pipeline).at("peer").at("version_line"), "") << cell.pipeline;
  }
  std::ranges::sort(meshed);
  EXPECT_EQ(meshed, (Strings{"sphere instant-meshes", "sphere mmg", "sphere quadriflow-source",
                             "sphere quadwild", "square gmsh-quasi", "square instant-meshes", "square tqmesh",
                             "touching instant-meshes"}));
  const std::string log = read_text(out() / "sphere" / "quadwild" / "peer.log");
  double factor = 0;
  ASSERT_EQ(std::sscanf(log.c_str(), "scaleFact %lf", &factor), 1) << log;
  EXPECT_NEAR(factor, 1, 0.15) << "our triangles have the size";
}

}  // namespace
}  // namespace delquad
