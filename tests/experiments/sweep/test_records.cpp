// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/draw_figures.h"
#include "experiments/sweep/experiment_copy.h"
#include "experiments/sweep/merge.h"
#include "experiments/sweep/run_experiment.h"
#include "experiments/sweep/verify.h"
#include "io/digest.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

const std::string kRecordSquare = "[[case]]\nname = 'square'\nloop = { rectangle = [[0, 0], [1, 1]] }\n";
const std::string kSizes =
    "pipelines = ['D', 'DB']\n[matrix]\nsize = [0.3, 0.25]\nseed = [1, 2]\n" + kRecordSquare;
constexpr std::size_t kCells = 8;

void replace(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

class Records : public testing::Test {
 protected:
  fs::path write(const std::string& text) { return write_text(folder_ / "e.toml", text); }
  Outcome run(const std::string& text, const SweepOptions& options = {}) {
    return run_experiment(Experiment::read(write(text), folder_ / "data"), out(), options);
  }
  fs::path out(const std::string& name = "out") const { return folder_ / name; }
  fs::path cell(const std::string& variant = "square@seed=1,size=0.25",
                const std::string& word = "DB") const {
    return out() / variant / word;
  }
  std::string state(const std::string& text) {
    return list_cells(Experiment::read(write(text), folder_ / "data"), out());
  }
  Strings findings() const { return verify_results(out(), folder_ / "data").findings; }
  /// Expects just one finding, which has these parts.
  void expect_finding(std::initializer_list<const char*> parts) const {
    const Strings found = findings();
    ASSERT_EQ(found.size(), 1u) << (found.empty() ? "" : found[1]);
    for (const char* part : parts) EXPECT_TRUE(holds(found[0], part));
  }
  Folder folder_;
};

TEST_F(Records, AFolderIsEnoughToMakeItAgain) {
  fs::create_directories(folder_ / "study/scripts");
  fs::create_directories(folder_ / "models");
  write_text(folder_ / "models/plate.toml", "loop = { rectangle = [[0, 0], [2, 1]] }\nsize = 0.25\n");
  write_text(folder_ / "study/published.toml", "source = 'a table'\n[[row]]\nname = 'theirs'\nd4 = 90\n");
  write_text(folder_ / "study/scripts/lines.sh", "grep -c '' \"$1\"\n");
  const fs::path file = write_text(
      folder_ / "study/e.toml",
      "pipelines = ['DB']\nreference = 'published.toml'\n[[metric]]\nname = 'lines'\ncommand = ['sh', "
      "'scripts/lines.sh', '{mesh}']\n[[case]]\nname = 'plate'\nmodel = '../models/plate.toml'\n");
  run_experiment(Experiment::read(file), out());
  fs::rename(out(), out("elsewhere"));
  fs::remove_all(folder_ / "study");
  fs::remove_all(folder_ / "models");
  const Rerun again = rerun_record(out("elsewhere") / "plate/DB/record.json");
  EXPECT_TRUE(again.same_mesh);
  EXPECT_TRUE(again.differences.empty()) << again.differences[0];
  EXPECT_TRUE(again.values.empty()) << again.values[0];
  const Json record = Json::parse(read_text(out("elsewhere") / "plate/DB/record.json"));
  EXPECT_TRUE(record.at("experiment").get<std::string>().starts_with("experiment/"));
}

TEST_F(Records, ACopyThatWasChangedIsRefused) {
  run(kSizes);
  const Json record = Json::parse(read_text(cell() / "record.json"));
  const fs::path copy = out() / record.at("experiment").get<std::string>();
  EXPECT_EQ(read_text(copy), kSizes);
  write_text(copy, kSizes + "# a word\n");
  expect_finding({"e.toml", "bytes, expected"});
  run(kSizes);
  EXPECT_EQ(read_text(copy), kSizes) << "is mended";
  fs::remove_all(out() / "experiment");
  EXPECT_TRUE(rerun_record(cell() / "record.json").same_mesh) << "by the record alone";
}

/// A cell of another problem than the experiment asks for is found, however it came there.
TEST_F(Records, VerifyComparesTheExperimentAsItIsNow) {
  const auto text = [](const std::string& keys) {
    return "pipelines = ['DB']\n" + kRecordSquare + "size = 0.25\n" + keys;
  };
  run(text(""));
  fs::rename(out(), out("before"));
  run(text("order = 2\nseed = 3\n"));
  fs::remove_all(out() / "square");
  fs::copy(out("before") / "square", out() / "square", fs::copy_options::recursive);
  ASSERT_FALSE(findings().empty());
  EXPECT_TRUE(holds(findings()[0], "square/DB/record.json: has another problem than the experiment has now"));
}

TEST_F(Records, OfOlderVersionsAreRefused) {
  run(kSizes);
  const fs::path file = cell() / "record.json", study = out() / "study.json";
  std::string old = read_text(file), older = read_text(study);
  replace(old, "\"record\": 3", "\"record\": 2");
  write_text(file, old);
  expect_input_error([&] { rerun_record(file); }, {"record.json", "record of version 2: expected version 3"});
  EXPECT_TRUE(holds(findings().at(1), "record of version 2: expected version 3"));
  replace(older, "\"record\": 3", "\"record\": 2");
  write_text(study, older);
  expect_input_error([&] { read_study(out()); }, {"study.json", "record of version 2: expected version 3"});
}

/// Models that are no part of the copy are found by name and digest, wherever they lie.
TEST_F(Records, DataIsFoundByNameAndDigest) {
  fs::create_directories(folder_ / "data/parts");
  write_mesh(folder_ / "data/parts/lens.msh", testing_support::lens(64, 12, 0.45));
  run("pipelines = ['DB']\n[[case]]\nname = 'lens'\ndata = 'parts/lens.msh'\nsize = 0.3\n");
  const fs::path record = out() / "lens/DB/record.json";
  fs::create_directories(folder_ / "other/deep/down");
  fs::rename(folder_ / "data/parts/lens.msh", folder_ / "other/deep/down/lens.msh");
  const Rerun again = rerun_record(record, folder_ / "other");
  EXPECT_TRUE(again.same_mesh && again.differences.empty() && again.values.empty());
  const std::string digest = Json::parse(read_text(record)).at("digests").at("model");
  expect_input_error([&] { rerun_record(record, folder_ / "data"); }, {"lens.msh", digest.c_str(), "--data"});
  write_mesh(folder_ / "data/parts/lens.msh", testing_support::lens(64, 12, 0.4));
  expect_input_error([&] { rerun_record(record, folder_ / "data"); },
                     {"parts/lens.msh has the digest", digest.c_str()});
}

TEST_F(Records, CellsAreAddressedByWhatTheyAre) {
  run(kSizes);
  std::string more = kSizes;
  replace(more, "[0.3, 0.25]", "[0.5, 0.3, 0.4, 0.25]");
  replace(more, "[1, 2]", "[7, 1, 2]");
  replace(more, "['D', 'DB']", "['F', 'D', 'DB']");
  replace(more, kRecordSquare,
          "[[case]]\nname = 'first'\nloop = { rectangle = [[0, 0], [2, 1]] }\n" + kRecordSquare);
  const auto before = fs::last_write_time(cell() / "record.json");
  const Outcome outcome = run(more);
  EXPECT_EQ(fs::last_write_time(cell() / "record.json"), before) << "is left alone";
  ASSERT_EQ(outcome.table.rows.size(), 24u);
  EXPECT_EQ(outcome.table.rows[0].group.substr(0, 5), "first");
  const Rerun again = rerun_record(cell() / "record.json");
  EXPECT_TRUE(again.same_mesh && again.differences.empty() && again.values.empty());
  EXPECT_TRUE(findings().empty()) << findings()[0];
}

TEST_F(Records, RerunComparesValues) {
  run(kSizes);
  const fs::path file = cell() / "record.json";
  Json record = Json::parse(read_text(file));
  record["metrics"]["eta_mean"] = record["metrics"]["eta_mean"].get<double>() + 1e-15;
  record["seconds"]["matching"] = 1000;
  record["valences"]["4"] = 1;
  write_text(file, record.dump(2) + "\n");
  const Rerun again = rerun_record(file);
  EXPECT_TRUE(again.same_mesh);
  ASSERT_EQ(again.values.size(), 2u);
  EXPECT_EQ(again.values[0].find("value metrics eta_mean: "), 0u) << again.values[0];
  EXPECT_EQ(again.values[1].find("value valences 4: 1 in the record, "), 0u) << again.values[1];
}

TEST_F(Records, RerunTakesMeasuresByCommandAgain) {
  write_text(folder_ / "one.sh", "echo 1\n");
  const std::string metric =
      "[[metric]]\nname = 'm'\ncommand = ['sh', 'one.sh', '{mesh}']\n" + kRecordSquare + "size = 0.3\n";
  run("pipelines = ['DB']\n" + metric);
  const fs::path file = cell("square") / "record.json";
  EXPECT_TRUE(rerun_record(file).values.empty());
  std::string text = read_text(file);
  replace(text, "\"m\": 1.0", "\"m\": 2.0");
  write_text(file, text);
  const Rerun again = rerun_record(file);
  ASSERT_EQ(again.values.size(), 1u);
  EXPECT_EQ(again.values[0], "value metrics m: 2.0 in the record, 1.0 now");
}

TEST_F(Records, SayWhatTheyWereMadeOn) {
  run(kSizes);
  const Json record = Json::parse(read_text(cell() / "record.json"));
  const std::string started = record.at("started");
  ASSERT_EQ(started.size(), 20u);
  EXPECT_EQ(started[10], 'T');
  EXPECT_EQ(started.back(), 'Z');
  EXPECT_GT(record.at("machine").at("processors").get<int>(), 0);
  EXPECT_TRUE(record.at("machine").at("load_average").is_number());
  EXPECT_TRUE(record.at("machine").at("cpu").is_string());
  EXPECT_FALSE(record.at("versions").at("opencascade").get<std::string>().empty());
}

TEST_F(Records, WhatIsWellIsSaidToBe) {
  write_mesh(folder_ / "lens.msh", testing_support::lens(64, 12, 0.45));
  run("pipelines = ['D', 'DBCO']\n[[case]]\nname = 'lens'\nmodel = 'lens.msh'\nsize = { base = 0.5, "
      "curvature = 24 }\n[[case]]\nname = 'counted'\nmodel = 'lens.msh'\nquads = 300\n" +
      kRecordSquare + "size = '0.1 + 0.1*x'\n[[case]]\nname = 'bad'\nsize = 'x - 5'\n" +
      "loop = { circle = { centre = [0, 0], radius = 1 } }\n");
  const Verification result = verify_results(out(), folder_ / "data");
  EXPECT_EQ(result.cells, 8u);
  EXPECT_EQ(result.measured, 6u);
  EXPECT_TRUE(result.findings.empty()) << result.findings[0];
}

TEST_F(Records, VerifyFindsWhatWasChanged) {
  run(kSizes);
  ASSERT_TRUE(findings().empty()) << findings()[0];
  const fs::path saved = out("saved"), mesh = cell() / "mesh.msh", record = cell() / "record.json";
  fs::copy(out(), saved, fs::copy_options::recursive);
  const auto restore = [&] {
    fs::remove_all(out());
    fs::copy(saved, out(), fs::copy_options::recursive);
  };
  fs::resize_file(mesh, fs::file_size(mesh) / 2);
  expect_finding({"size=0.25/DB/mesh.msh: holds ", " bytes, expected "});
  restore();
  std::string text = read_text(mesh);
  char& digit = text[text.find_last_of("0123456789")];
  digit = digit == '1' ? '2' : '1';
  write_text(mesh, text);
  expect_finding({"mesh.msh: was changed"});
  restore();
  fs::remove(cell() / "mesh.vtu");
  expect_finding({"mesh.vtu: is missing"});
  restore();
  text = read_text(out() / "table.csv");
  text[text.find("DB") + 1] = 'C';
  write_text(out() / "table.csv", text);
  expect_finding({"table.csv: is not what these records make"});
  restore();
  for (const char* name : {"picture.svg", "fields.vtu"}) {
    write_text(cell() / name, read_text(cell() / name) + " ");
    expect_finding({name, ": holds "});
    restore();
  }
  text = read_text(out() / "study.json");
  replace(text, "\"title\": \"e\"", "\"title\": \"f\"");
  write_text(out() / "study.json", text);
  EXPECT_GE(findings().size(), 1u);
  EXPECT_TRUE(holds(findings()[0], "study.json: was changed"));
  write_text(out() / "study.json", "{");
  EXPECT_GE(findings().size(), 2u);
  EXPECT_TRUE(
      holds(findings()[1], "study.json:1:2: does not describe an experiment's results: it ends there"));
  restore();
  fs::remove_all(cell());
  EXPECT_EQ(findings().size(), 6u) << "a cell, tables in four formats, and runs";
  EXPECT_TRUE(holds(findings()[0], "1 of 8 cells have no result"));
  restore();
  write_text(record, "{}");
  EXPECT_TRUE(holds(findings()[0], "record.json: was changed"));
}

/// Enough cases and pipelines for figures and for tables that go to print.
TEST_F(Records, VerifySeesFiguresBibliographyAndSwappedFolders) {
  std::string text = "pipelines = ['DB', 'DBC']\n";
  for (const std::string n : {"1", "2", "3"})
    text += "[[case]]\nname = \"r" + n + "\"\nsize = 0.4\nloop = { rectangle = [[0, 0], [1, " + n + "]] }\n";
  run(text);
  const bool has_figures = draw_figures({out()}).empty();
  ASSERT_TRUE(findings().empty()) << findings()[0];
  EXPECT_EQ(verify_results(out(), folder_ / "data").undrawn, "");
  std::vector<const char*> names = {"references.bib", "tables.tex", "summary.md", "pairs.csv"};
  if (has_figures) names.insert(names.end(), {"figures/profile_tau.svg", "figures/effects_tau.pdf"});
  for (const char* name : names) {
    const std::string before = read_text(out() / name);
    write_text(out() / name, before + " ");
    EXPECT_EQ(findings().size(), 1u) << name;
    expect_finding({std::string(name).c_str(), "is not what these records make"});
    write_text(out() / name, before);
  }
  if (has_figures) {
    write_text(out() / "figures/mine.svg", "of mine");
    EXPECT_TRUE(findings().empty()) << "files of others are theirs";
    fs::copy_file(out() / "figures/effects_tau.svg", out() / "figures/effects_other.svg");
    expect_finding({"effects_other.svg", "is not what these records make"});
    fs::remove(out() / "figures/effects_other.svg");
  }
  const auto swap = [&](const fs::path& a, const fs::path& b) {
    fs::rename(a, out() / "aside");
    fs::rename(b, a);
    fs::rename(out() / "aside", b);
  };
  swap(out() / "r1" / "DB", out() / "r1" / "DBC");
  ASSERT_EQ(findings().size(), 2u);
  EXPECT_TRUE(holds(findings()[0], "is the record of r1 {} DBC, in the folder of another cell"));
  swap(out() / "r1" / "DB", out() / "r1" / "DBC");
  swap(out() / "r2", out() / "r3");
  EXPECT_GE(findings().size(), 4u);
}

/// A number that was changed is found, though nothing else says so.
TEST_F(Records, VerifyMeasuresAgain) {
  run(kSizes);
  const fs::path file = cell() / "record.json";
  std::string text = read_text(file);
  replace(text, "\"seed\": 1", "\"seed\": 1 ");
  write_text(file, text);
  EXPECT_EQ(findings().size(), 6u)
      << "the record, tables in four formats and runs, in which it has failed now";
  EXPECT_TRUE(holds(findings()[0], "record.json: was changed"));
  Json record = Json::parse(text);
  record.erase("digest");
  for (const char* key : {"eta_mean", "tau"}) {
    Json other = record;
    other["metrics"][key] = record["metrics"][key].get<double>() * (1 + 1e-7);
    write_text(file, sealed(other.dump(2) + "\n"));
    const Strings found = findings();
    ASSERT_GE(found.size(), 1u) << key;
    EXPECT_TRUE(holds(found[0], std::string("record.json: ") + key + " is "));
  }
}

TEST_F(Records, ATruncatedMeshIsMadeAgain) {
  run(kSizes);
  const std::string whole = read_text(cell() / "mesh.msh");
  EXPECT_FALSE(holds(state(kSizes), "damaged"));
  fs::resize_file(cell() / "mesh.msh", whole.size() - 1);
  EXPECT_TRUE(holds(state(kSizes), "damaged        square@seed=1,size=0.25 DB"));
  run(kSizes);
  EXPECT_EQ(read_text(cell() / "mesh.msh"), whole);
  EXPECT_TRUE(findings().empty()) << findings()[0];
}

/// A number that was changed reaches no table.
TEST_F(Records, AnEditedRecordIsOneFailedCell) {
  run(kSizes);
  const fs::path file = cell() / "record.json";
  std::string text = read_text(file);
  replace(text, "\"eta_mean\": 0.", "\"eta_mean\": 1.");
  write_text(file, text);
  const Outcome outcome = make_tables(read_results(out()));
  EXPECT_EQ(outcome.others_failed, 1u);
  const auto records = read_records(out());
  const auto edited = std::ranges::find(records, "damaged", &CellRecord::kind);
  ASSERT_NE(edited, records.end());
  EXPECT_EQ(edited->group, "square@seed=1,size=0.25");
  EXPECT_TRUE(holds(edited->reason, "was changed"));
}

/// Whatever a record has become, it is one cell that failed, which is made again.
TEST_F(Records, ADamagedRecordIsOneFailedCell) {
  run(kSizes);
  const fs::path file = cell() / "record.json";
  const std::string whole = read_text(file);
  std::mt19937 random(7);
  Strings texts = {"", "{}", "[1]", "null", "\x01\xff", "{\"case\": 3}"};
  for (const char* key : {"metrics", "variant", "status", "digests", "pipeline"}) {
    Json record = Json::parse(whole);
    record[key] = 3;
    texts.push_back(record.dump());
  }
  for (int i = 0; i < 20; ++i) texts.push_back(whole.substr(0, random() % (whole.size() - 2)));
  for (const std::string& text : texts) {
    write_text(file, text);
    EXPECT_TRUE(holds(state(kSizes), "damaged        square@seed=1,size=0.25 DB")) << text;
    const Outcome outcome = make_tables(out());
    if (text.find("\"digests\":3") != std::string::npos) continue;  // which tables do not need
    EXPECT_EQ(outcome.others_failed, 1) << text;
    const auto is_named = [&](const CellRecord& record) {
      return record.kind == "damaged" && record.group == "square@seed=1,size=0.25" &&
             record.pipeline == "DB" && record.reason.starts_with("damaged record: " + file.string() + ":") &&
             record.reason.find("json.exception") == std::string::npos;
    };
    const std::vector<CellRecord> records = read_records(out());
    EXPECT_EQ(records.size(), kCells);
    EXPECT_EQ(std::ranges::count_if(records, is_named), 1) << text;
  }
  EXPECT_EQ(run(kSizes).others_failed, 0);
  EXPECT_TRUE(findings().empty()) << findings()[0];
}

/// In words of our own, with the place.
TEST_F(Records, DamageIsToldPlainly) {
  run(kSizes);
  const fs::path file = cell() / "record.json";
  const std::string whole = read_text(file);
  const auto reason = [&](const std::string& text) {
    write_text(file, text);
    for (const CellRecord& record : read_records(out()))
      if (record.kind == "damaged") return record.reason.substr(std::string("damaged record: ").size());
    return std::string();
  };
  const std::string name = file.string();
  EXPECT_EQ(reason(""), name + ":1:1: it ends there, too early");
  EXPECT_EQ(reason("{\n  \"case\": \"a\",\n  oops"), name + ":3:3: no JSON there");
  EXPECT_EQ(reason("{\n\"case\": \"a"), name + ":2:11: it ends there, too early");
  EXPECT_EQ(reason("{\"record\": 3}"), name + ": 'case' is missing");
  EXPECT_EQ(reason("{\"record\": 3, \"case\": 3}"), name + ": a value in it is not of the expected kind");
  const std::string cut = whole.substr(0, whole.find(',', whole.size() / 2) + 1);
  EXPECT_TRUE(holds(reason(cut), "it ends there, too early"));
}

TEST_F(Records, PicturesCanBeLeftOut) {
  run(kSizes, {.pictures = false});
  for (const auto& entry : fs::recursive_directory_iterator(out())) {
    EXPECT_NE(entry.path().extension(), ".svg") << entry.path();
    EXPECT_NE(entry.path().filename(), "fields.vtu") << entry.path();
  }
  EXPECT_TRUE(findings().empty()) << findings()[0];
  EXPECT_FALSE(holds(state(kSizes), "to do"));
}

TEST_F(Records, ShardsOfSeveralFoldersAreMerged) {
  run(kSizes);
  const Experiment experiment = Experiment::read(folder_ / "e.toml");
  for (std::size_t i = 0; i < 3; ++i)
    run_experiment(experiment, out("part" + std::to_string(i)), {.shard = {i, 3}});
  const std::vector<fs::path> parts = {out("part2"), out("part0"), out("part1")};
  merge_results(parts, out("all"));
  const auto values = [&](const fs::path& folder) {
    std::vector<std::pair<std::string, double>> all;
    for (const CellRecord& r : read_records(folder))
      all.emplace_back(r.group + r.pipeline, r.values.at("n_vertices"));
    return all;
  };
  EXPECT_EQ(values(out("all")), values(out()));
  EXPECT_TRUE(verify_results(out("all"), "").findings.empty());
  EXPECT_TRUE(rerun_record(out("all") / "square@seed=1,size=0.25/DB/record.json").values.empty());
  expect_input_error([&] { merge_results(parts, out("all")); }, {"all", "is there already"});
  expect_input_error([&] { merge_results(parts, out("part0") / "inside"); }, {"inside", "lies inside of"});
}

TEST_F(Records, FoldersAreMergedByRelativePaths) {
  run(kSizes);
  const fs::path before = fs::current_path();
  fs::current_path(out().parent_path());
  merge_results({out().filename(), out().filename()}, "all");
  const bool is_there = fs::exists("all/study.json");
  expect_input_error([&] { merge_results({out().filename()}, out().filename() / "inside"); },
                     {"lies inside of"});
  fs::current_path(before);
  EXPECT_TRUE(is_there);
}

TEST_F(Records, OtherValuesAndCasesAreMerged) {
  run("pipelines = ['DB']\n[matrix]\nsize = [0.3]\n" + kRecordSquare);
  const std::string other = "pipelines = ['DB', 'F']\n[matrix]\nsize = [0.25, 0.3]\n" + kRecordSquare +
                            "[[case]]\nname = 'disc'\nloop = { circle = { centre = [0, 0], radius = 1 } }\n";
  run_experiment(Experiment::read(write(other)), out("more"));
  merge_results({out(), out("more")}, out("all"));
  const Outcome outcome = make_tables(out("all"));
  EXPECT_EQ(outcome.table.rows.size(), 8u);
  EXPECT_EQ(outcome.others_failed + outcome.bad_inputs, 0);
  const Verification result = verify_results(out("all"), "");
  EXPECT_EQ(result.cells, 8u);
  EXPECT_TRUE(result.findings.empty()) << result.findings[0];
  for (const char* cell : {"square@size=0.3/DB", "disc@size=0.25/F"}) {
    const Rerun again = rerun_record(out("all") / cell / "record.json");
    EXPECT_TRUE(again.same_mesh && again.differences.empty() && again.values.empty()) << cell;
  }
}

TEST_F(Records, MergingRefusesWhatDoesNotFit) {
  run("pipelines = ['DB']\n" + kRecordSquare + "size = 0.3\n");
  run_experiment(Experiment::read(write("pipelines = ['DB']\n" + kRecordSquare + "size = 0.25\n")),
                 out("finer"));
  expect_input_error(
      [&] {
        merge_results({out(), out("finer")}, out("all"));
      },
      {"square DB differs between", "out/square", "finer/square"});
  run_experiment(Experiment::read(write("pipelines = ['DB']\n[matrix]\nsize = [0.3]\n" + kRecordSquare)),
                 out("varied"));
  expect_input_error([&] { merge_results({out(), out("varied")}, out("all")); }, {"varied", "[\"size\"]"});
  const fs::path named =
      write_text(folder_ / "f.toml", "pipelines = ['DB']\n" + kRecordSquare + "size = 0.3\n");
  run_experiment(Experiment::read(named), out("named"));
  expect_input_error([&] { merge_results({out(), out("named")}, out("all")); }, {"'f', not of 'e'"});
  expect_input_error([&] { merge_results({out(), folder_.path() / "nowhere"}, out("all")); }, {"nowhere"});
  EXPECT_FALSE(fs::exists(out("all")));
  for (const std::string& name : folder_.names()) EXPECT_FALSE(holds(name, ".all"));
}

/// A file that is not as it was written is never handed on.
TEST_F(Records, MergingLeavesDamagedCells) {
  run(kSizes);
  fs::copy(out(), out("copy"), fs::copy_options::recursive);
  const fs::path cell = "square@seed=1,size=0.25/DB";
  const auto damage = [&](const fs::path& folder) {
    fs::resize_file(folder / cell / "mesh.msh", fs::file_size(folder / cell / "mesh.msh") / 2);
  };
  damage(out());
  for (const auto& [a, b, to] : {std::tuple("out", "copy", "all"), std::tuple("copy", "out", "more")}) {
    merge_results({out(a), out(b)}, out(to));
    EXPECT_TRUE(verify_results(out(to), "").findings.empty()) << a;
  }
  damage(out("copy"));
  expect_input_error(
      [&] {
        merge_results({out(), out("copy")}, out("none"));
      },
      {"square@seed=1,size=0.25/DB/mesh.msh", "remove the folder of the cell"});
  EXPECT_FALSE(fs::exists(out("none")));
}

/// A cell that was done in one folder is taken before one that failed in another.
TEST_F(Records, MergingTakesWhatWasDone) {
  const std::string text = "pipelines = ['DB']\n[[case]]\nname = 'lens'\ndata = 'lens.msh'\nsize = 0.3\n";
  run(text);
  ASSERT_TRUE(read_records(out())[0].skipped);
  fs::create_directories(folder_ / "data");
  write_mesh(folder_ / "data/lens.msh", testing_support::lens(64, 12, 0.45));
  run_experiment(Experiment::read(folder_ / "e.toml", folder_ / "data"), out("done"));
  merge_results({out(), out("done")}, out("all"));
  EXPECT_EQ(read_records(out("all"))[0].reason, "");
  EXPECT_TRUE(verify_results(out("all"), folder_ / "data").findings.empty());
}

/// Turned, scaled, mirrored and renamed copies are one domain; so are those that the file calls so.
TEST_F(Records, TellWhichCasesAreOneGeometry) {
  run("pipelines = ['DB']\nquads = 20\n"
      "[[case]]\nname = 'plate'\nloop = [{ rectangle = [[0, 0], [3, 2]] }, { circle = { centre = [1, 1], "
      "radius = 0.5 } }]\n"
      "[[case]]\nname = 'turned'\nloop = [{ polygon = [[10, 0], [10, 6], [6, 6], [6, 0]] }, { circle = { "
      "centre = [8, 4], radius = 1 } }]\n"
      "[[case]]\nname = 'other'\nloop = [{ rectangle = [[0, 0], [3, 2]] }, { circle = { centre = [1.001, 1], "
      "radius = 0.5 } }]\n"
      "[[case]]\nname = 'disc'\nloop = { circle = { centre = [0, 0], radius = 1 } }\n"
      "[[case]]\nname = 'square'\ndomain = 'disc'\nloop = { rectangle = [[0, 0], [1, 1]] }\n");
  std::map<std::string, std::string> domains;
  for (const CellRecord& record : read_records(out())) domains[record.name] = domain_of(record);
  EXPECT_EQ(domains, (std::map<std::string, std::string>{{"plate", "plate"},
                                                         {"turned", "plate"},
                                                         {"other", "other"},
                                                         {"disc", "disc"},
                                                         {"square", "disc"}}));
  EXPECT_TRUE(holds(read_text(out() / "table.md"), "turned is the domain plate"));
}

/// An ellipse of chords, with a hole.
std::string polygons(int sides, double radius_of_hole) {
  std::string loops;
  for (const auto& [a, b, n] :
       {std::array{2.0, 1.0, double(sides)}, {radius_of_hole, radius_of_hole, sides / 2.0}}) {
    loops += loops.empty() ? "{ polygon = [" : ", { polygon = [";
    for (int k = 0; k < n; ++k)
      loops += fmt::format("{}[{}, {}]", k > 0 ? ", " : "", a * std::cos(2 * M_PI * k / n),
                           b * std::sin(2 * M_PI * k / n));
    loops += "] }";
  }
  return "loop = [" + loops + "]\n";
}

/// Outlines of one curve by chords of several sizes are one domain. Outlines of another curve are another
/// domain. Corners of polygons do not count as chords.
TEST_F(Records, OutlinesOfOneCurveAreOneGeometry) {
  std::string text = "pipelines = ['DB']\nquads = 20\n";
  const auto add = [&](const std::string& name, const std::string& lines) {
    text += "[[case]]\nname = \"" + name + "\"\n" + lines;
  };
  for (const int sides : {40, 80, 160, 400}) add("of_" + std::to_string(sides), polygons(sides, 0.4));
  for (const int sides : {40, 80}) add("other_" + std::to_string(sides), polygons(sides, 0.45));
  add("l_1", "loop = { polygon = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]] }\n");
  add("l_2", "loop = { polygon = [[0, 0], [2, 0], [2, 1], [1, 1.001], [1, 2], [0, 2]] }\n");
  for (const int n : {24, 48}) {
    write_mesh(folder_ / fmt::format("can_{}.obj", n), testing_support::can(n, n / 8));
    add(fmt::format("can_{}", n), fmt::format("model = 'can_{}.obj'\n", n));
  }
  const StudyFile study = describe(Experiment::read(write(text)));
  const std::map<std::string, std::string> domains = domains_of(study);
  std::map<std::string, std::string> expected = {{"l_1", "l_1"}, {"l_2", "l_2"}};
  for (const char* n : {"40", "80", "160", "400"}) expected[std::string("of_") + n] = "of_40";
  for (const char* n : {"40", "80"}) expected[std::string("other_") + n] = "other_40";
  for (const char* n : {"24", "48"}) expected[std::string("can_") + n] = "can_24";
  EXPECT_EQ(domains, expected);
}

}  // namespace
}  // namespace delquad
