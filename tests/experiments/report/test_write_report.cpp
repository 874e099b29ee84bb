// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/experiments/report/report_results.h"
#include "tests/support/files.h"

namespace delquad::testing_support {
namespace {

Json data_of(const fs::path& page) {
  const std::string text = read_text(page), begin = "id=\"data\">", end = "</script>";
  const auto from = text.find(begin) + begin.size();
  return Json::parse(text.substr(from, text.find(end, from) - from));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Report, HasEveryCellWithItsPictureOrItsReason) {
  const Folder folder;
  ASSERT_EQ(run_into(folder, "square", kSquareExperiment).exit_code, 2);  // the broken case
  const ProgramResult result = delquad({"report", folder / "results/square", "-o", folder / "r.html"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::string page = read_text(folder / "r.html");
  EXPECT_EQ(count(page, "id=\"mesh-"), 6u);
  EXPECT_EQ(count(page, "<b>more</b>"), 0u);         // titles are text
  EXPECT_FALSE(holds(page, "WebGLRenderer=class"));  // no surfaces, no three.js
  const Json data = data_of(folder / "r.html");
  ASSERT_EQ(data["studies"].size(), 1u);
  const Json& study = data["studies"][0];
  EXPECT_EQ(study["title"], "A square </script> & <b>more</b>");
  ASSERT_EQ(study["sheets"].size(), 2u);  // two cases
  ASSERT_EQ(study["sheets"][0]["seeds"].size(), 2u);
  EXPECT_EQ(study["sheets"][0]["seeds"][1]["seed"], "2");
  const Json& done = study["sheets"][0]["seeds"][0]["cells"];
  ASSERT_EQ(done.size(), 3u);
  EXPECT_EQ(done[0]["mesh"]["quads"], 0);
  EXPECT_GT(done[1]["mesh"]["quads"], 0);
  EXPECT_FALSE(done[0].contains("closeups"));
  EXPECT_EQ(done[1]["closeups"].size(), 3u);
  EXPECT_FALSE(done[1].contains("energy"));
  EXPECT_FALSE(done[2]["energy"][0].empty());
  EXPECT_EQ(done[1]["closeups"][0]["eta"], done[1]["values"]["eta_worst"]);
  const Json& failed = study["sheets"][1]["seeds"][0]["cells"][0];
  EXPECT_EQ(failed["status"], "failed");
  EXPECT_FALSE(failed["reason"].get<std::string>().empty());
  EXPECT_EQ(study["tables"][0]["rows"].size(), 6u);
}

/// Faces that join smoothly are one patch: its quads lie in the file by faces, and not in the mesh.
TEST(Report, QuadsThatFailHaveAColour) {
  constexpr double kLeast = 3;
  const Folder folder;
  const ProgramResult made = run_into(folder, "lengths", R"(
pipelines = ["DBC"]
[[case]]
name = "part"
example = "bracket"
size = 4
surface = { compound = "tangent" }
criteria = { min_length = 3 }
)");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const fs::path cell = folder / "results/lengths/part/DBC";
  const Json criteria = Json::parse(read_text(cell / "record.json")).at("criteria");
  const Mesh mesh = read_mesh(cell / "mesh.msh");
  std::vector<std::size_t> shorter;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto side = [&](int k) {
      return norm(mesh.points[mesh.quads[q][(k + 1) % 4]] - mesh.points[mesh.quads[q][k]]);
    };
    if (std::min({side(0), side(1), side(2), side(3)}) < kLeast) shorter.push_back(q);
  }
  EXPECT_GT(shorter.size(), 0u);
  EXPECT_EQ(criteria.at("failing_quads").get<std::vector<std::size_t>>(), shorter);
  ASSERT_EQ(delquad({"report", folder / "results/lengths", "-o", folder / "r.html"}).exit_code, 0);
  const Json shown = data_of(folder / "r.html")["studies"][0]["sheets"][0]["seeds"][0]["cells"][0];
  EXPECT_EQ(shown["mesh"]["failing"], shorter.size());
}

/// Shares of vertices by the quads around them are counted as d4 is: a vertex with triangles is not regular.
TEST(Report, ValencesAreThoseOfD4) {
  const Folder folder;
  const ProgramResult made = run_into(folder, "disc",
                                      "pipelines = ['DB', 'DG']\nsize = 0.15\n[[case]]\nname = 'disc'\nloop "
                                      "= { circle = { centre = [0, 0], radius = 1 } }\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  ASSERT_EQ(delquad({"report", folder / "results", "-o", folder / "r.html"}).exit_code, 0);
  const Json cells = data_of(folder / "r.html")["studies"][0]["sheets"][0]["seeds"][0]["cells"];
  ASSERT_EQ(cells.size(), 2u);
  for (const Json& cell : cells) {
    const Json& around = cell["valences"];
    EXPECT_EQ(around["of"], "quads");
    double all = around["mixed"].get<double>();
    for (const Json& n : around["counts"]) all += n.get<double>();
    EXPECT_NEAR(100 * around["counts"]["4"].get<double>() / all, cell["values"]["d4"].get<double>(), 1e-9);
  }
  EXPECT_EQ(cells[0]["valences"]["mixed"], 0);
  EXPECT_GT(cells[1]["valences"]["mixed"], 0);
}

/// Figures that lie in the results are on the page, or it says where those lie that are too large.
TEST(Report, FiguresOfTheFolder) {
  const Folder folder;
  run_into(folder, "square", kSquareExperiment);
  fs::create_directories(folder / "results/square/figures");
  const std::string small = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\"/>";
  write_text(folder / "results/square/figures/b.svg", small);
  write_text(folder / "results/square/figures/a.svg", small + std::string(50'000'000, ' '));
  write_text(folder / "results/square/figures/notes.txt", "no figure");
  ASSERT_EQ(delquad({"report", folder / "results", "-o", folder / "r.html"}).exit_code, 0);
  const Json drawings = data_of(folder / "r.html")["studies"][0]["drawings"];
  ASSERT_EQ(drawings.size(), 2u);
  EXPECT_FALSE(drawings[0].contains("svg"));
  EXPECT_TRUE(holds(drawings[0]["left_out"].get<std::string>(), "figures/a.svg"));
  EXPECT_EQ(drawings[1]["name"], "b");
  EXPECT_EQ(drawings[1]["svg"], small);
}

TEST(Report, SameBytesTwice) {
  const Folder folder;
  run_into(folder, "square", kSquareExperiment);
  for (const char* name : {"a.html", "b.html"})
    ASSERT_EQ(delquad({"report", folder / "results", "-o", folder / name}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "a.html"), read_text(folder / "b.html"));
}

TEST(Report, SeveralExperimentsOfWhichSomeAreBroken) {
  const Folder folder;
  run_into(folder, "one", kSquareExperiment);
  run_into(folder, "two", kSquareExperiment);
  run_into(folder, "three", kSquareExperiment);
  fs::create_directories(folder / "results/not_an_experiment");
  write_text(folder / "results/two/square@seed=1/DB/record.json", "{ \"key\": ");
  write_text(folder / "results/three/square@seed=1/DB/mesh.msh", "rubbish");
  fs::remove(folder / "results/three/square@seed=2/DB/mesh.msh");
  const ProgramResult result = delquad({"report", folder / "results", "-o", folder / "r.html"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(holds(result.err, "results/two/square@seed=1/DB/record.json",
                    "results/three/square@seed=1/DB/mesh.msh", "results/three/square@seed=2/DB/mesh.msh"));
  const Json data = data_of(folder / "r.html");
  ASSERT_EQ(data["studies"].size(), 3u);
  EXPECT_TRUE(data["left_out"].empty());
  const Json& damaged = data["studies"][2]["sheets"][0]["seeds"][0]["cells"][1];
  EXPECT_EQ(damaged["status"], "failed");
  EXPECT_EQ(damaged["reason"].get<std::string>().find("damaged record: "), 0u);
  EXPECT_EQ(count(read_text(folder / "r.html"), "json.exception"), 0u);
  const Json& cell = data["studies"][1]["sheets"][0]["seeds"][0]["cells"][1];
  EXPECT_EQ(cell["status"], "ok");
  EXPECT_FALSE(cell.contains("mesh"));
  EXPECT_TRUE(holds(cell["no_picture"].get<std::string>(), "mesh.msh"));
}

/// Thousands of cells stay in the tables, and out of the sheets.
TEST(ReportLong, LargeSweeps) {
  const Folder folder;
  std::string seeds = "1";
  for (int seed = 2; seed <= 2100; ++seed) seeds += ", " + std::to_string(seed);
  const auto file =
      write_text(folder / "e.toml", "pipelines = ['DB']\nsize = 0.5\n[matrix]\nseed = [" + seeds +
                                        "]\n[[case]]\nname = 'a'\nloop = { rectangle = [[0, 0], [1, 1]] }\n");
  ASSERT_EQ(delquad({"run", file, "-o", folder / "out", "--shard", "0/2100"}).exit_code, 0);
  Json sealed_record = Json::parse(read_text(folder / "out/a@seed=1/DB/record.json"));
  sealed_record.erase("digest");
  const std::string record = sealed_record.dump(2), variant = "\"seed\": \"1\"";
  ASSERT_TRUE(holds(record, variant));
  for (int seed = 2; seed <= 2100; ++seed) {
    const fs::path cell = folder / ("out/a@seed=" + std::to_string(seed) + "/DB");
    fs::create_directories(cell);
    std::string other = record;
    other.replace(other.find(variant), variant.size(), "\"seed\": \"" + std::to_string(seed) + "\"");
    write_text(cell / "record.json", other);
  }
  ASSERT_EQ(delquad({"report", folder / "out", "-o", folder / "r.html"}).exit_code, 0);
  EXPECT_LT(fs::file_size(folder / "r.html"), 25'000'000u);
  const Json study = data_of(folder / "r.html")["studies"][0];
  ASSERT_EQ(study["sheets"].size(), 1u);
  EXPECT_EQ(study["sheets"][0]["seeds"].size(), 2000u);
  EXPECT_EQ(study["sheets"][0]["means"][0]["n"], 2100);
  EXPECT_EQ(study["cells_left_out"], 100);
  EXPECT_EQ(study["tables"][0]["rows"].size(), 1u);
}

TEST(Report, NothingToShow) {
  const Folder folder;
  fs::create_directories(folder / "empty");
  for (const char* name : {"empty", "absent"}) {
    const ProgramResult result = delquad({"report", folder / name, "-o", folder / "r.html"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, name));
    EXPECT_FALSE(fs::exists(folder / "r.html"));
  }
}

TEST(Report, StaysWhatItWasWhereItCannotBeWritten) {
  const Folder folder;
  run_into(folder, "square", kSquareExperiment);
  write_text(folder / "r.html", "before");
  const Strings arguments = {"report", folder / "results", "-o", folder / "r.html"};
  constexpr long long kTooLittle = 20'000;
  const ProgramResult full = run_program(DELQUAD_PROGRAM, {arguments, kTooLittle, {}});
  EXPECT_EQ(full.exit_code, 2) << full.err;
  EXPECT_EQ(read_text(folder / "r.html"), "before");
  EXPECT_EQ(delquad({"report", folder / "results", "-o", folder / "no/r.html"}).exit_code, 2);
}

}  // namespace
}  // namespace delquad::testing_support
