// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/draw_figures.h"
#include "metrics/tables/tables.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

CellRecord cell(const std::string& name, const std::string& pipeline, double eta, double seconds) {
  CellRecord record;
  record.group = record.name = name;
  record.pipeline = pipeline;
  record.values = {{"n_quads", 100}, {"eta_mean", eta}, {"tau", 90}, {"d4", 95}, {"seconds_total", seconds}};
  return record;
}

CellRecord failed(const std::string& name, const std::string& pipeline, const std::string& kind) {
  CellRecord record;
  record.group = record.name = name;
  record.pipeline = pipeline;
  record.reason = record.kind = kind;
  record.skipped = kind == "not applicable" || kind == "data not found";
  return record;
}

/// Three cases: DB and peer are the better ones in turn, and one of the peer's cells failed.
std::vector<CellRecord> three_cases() {
  return {cell("a", "DB", 0.9, 1),   cell("a", "peer", 0.8, 2), cell("b", "DB", 0.6, 4),
          cell("b", "peer", 0.9, 2), cell("c", "DB", 0.5, 1),   failed("c", "peer", "crash")};
}

/// A beats B by 0.1 on each of twelve domains. It fails on the first `of_a`, B on the last of them.
std::vector<CellRecord> twelve_domains(int of_a, int of_b) {
  std::vector<CellRecord> records;
  for (int k = 0; k < 12; ++k) {
    const std::string name = "d" + std::to_string(k);
    records.push_back(k < of_a ? failed(name, "A", "crash") : cell(name, "A", 0.8 + 0.001 * k * k, 1));
    records.push_back(k > 11 - of_b ? failed(name, "B", "crash") : cell(name, "B", 0.7, 1));
  }
  return records;
}

struct Line {
  std::string label, marker;
  std::vector<Vec2> points;
};

class Figures : public testing::Test {
 protected:
  void write(const std::vector<CellRecord>& records, const std::vector<Hypothesis>& hypotheses = {}) {
    StudyResults results;
    results.records = records;
    results.study.hypotheses = hypotheses;
    for (const CellRecord& record : records)
      for (const auto& [list, name] :
           {std::pair(&results.study.cases, record.name), {&results.study.pipelines, record.pipeline}})
        if (std::ranges::find(*list, name) == list->end()) list->push_back(name);
    EXPECT_TRUE(write_tables(folder_.path(), make_tables(results)).empty());
  }

  /// Lines of a figure, by axes of our own in place of matplotlib.
  std::vector<Line> lines(const std::string& figure) const {
    const char* kScript = R"(
import functools, importlib.util, pathlib, sys
spec = importlib.util.spec_from_file_location("figures", sys.argv[1])
figures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(figures)
class Axes:
    figure = property(lambda self: self)
    def plot(self, x, y, label="", markerfacecolor="", **_):
        print(label, markerfacecolor, " ".join(f"{a:.17g} {b:.17g}" for a, b in zip(x, y)), sep="|")
    def set(self, yticklabels=(), **_):
        for label in yticklabels: print(label.replace("\n", " "), "tick", "", sep="|")
    def __getattr__(self, name): return lambda *a, **k: None
folder, name = pathlib.Path(sys.argv[2]), sys.argv[3]
columns = figures.read(folder, "runs_columns.csv")
runs = figures.Runs(figures.read(folder, "runs.csv"), columns)
(figures.effects(folder, columns).get(name) or functools.partial(figures.COMPARISONS[name], runs=runs))(Axes())
)";
    const ProgramResult run =
        run_program("/usr/bin/python3",
                    {{"-c", kScript, DELQUAD_EXPERIMENTS "/figures.py", folder_.path(), figure}, 0, {}});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::vector<Line> found;
    std::istringstream out(run.out);
    for (std::string text; std::getline(out, text);) {
      Line& line = found.emplace_back();
      std::istringstream parts(text);
      std::getline(std::getline(parts, line.label, '|'), line.marker, '|');
      for (Vec2 p; parts >> p.x >> p.y;) line.points.push_back(p);
    }
    return found;
  }

  Strings drawn() const {
    Strings names;
    if (fs::exists(folder_ / kFigures))
      for (const auto& file : fs::directory_iterator(folder_ / kFigures))
        names.push_back(file.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  Folder folder_;
};

TEST_F(Figures, ProfilesHaveThePartWithinEachFactor) {
  write(three_cases());
  const std::vector<Line> profile = lines("profile_time");
  // DB: 1, 2, 1 times the least; peer: 2, 1, never. Lines go on to the right.
  ASSERT_EQ(profile.size(), 2u);
  const auto& db = profile[0].points;
  const auto& peer = profile[1].points;
  ASSERT_EQ(db.size(), 5u);
  EXPECT_EQ(db[2].x, 1);
  EXPECT_NEAR(db[2].y, 200.0 / 3, 1e-9);
  EXPECT_EQ(db[3].x, 2);
  EXPECT_EQ(db[3].y, 100);
  ASSERT_EQ(peer.size(), 4u) << "what failed is infinitely bad";
  EXPECT_NEAR(peer.back().y, 200.0 / 3, 1e-9);
  EXPECT_EQ(profile[0].label, "DB");
  EXPECT_EQ(profile[1].label, "peer (1 failed of 3)");
}

TEST_F(Figures, LossesOfEtaAreWhatIsMissingToOne) {
  write(three_cases());
  const std::vector<Line> profile = lines("profile_eta");
  EXPECT_NEAR(profile[0].points[3].x, 4, 1e-9) << "0.4 against 0.1 on b";
  EXPECT_NEAR(profile[1].points[2].x, 2, 1e-9) << "0.2 against 0.1 on a";
}

TEST_F(Figures, DotsAreTheSoundCells) {
  std::vector<CellRecord> records = three_cases();
  records[0].unsound = {"folded"};
  write(records);
  const std::vector<Line> dots = lines("time_quality");
  ASSERT_EQ(dots[0].points.size(), 2u);
  EXPECT_EQ(dots[0].points[0].x, 4);
  EXPECT_EQ(dots[0].points[0].y, 0.6);
  EXPECT_EQ(dots[0].label, "DB (1 not sound of 3)");
  EXPECT_EQ(dots[1].label, "peer (1 failed of 3)");
  EXPECT_EQ(lines("irregular_tau")[0].points[0].x, 5) << "d4 is 95 %";
}

/// Absent data says nothing of anybody. Cells that are not applicable count, and are named.
TEST_F(Figures, TellAbsentDataFromWhatIsNotApplicable) {
  std::vector<CellRecord> records = three_cases();
  for (const char* pipeline : {"DB", "peer"}) records.push_back(failed("d", pipeline, "data not found"));
  records.push_back(cell("e", "DB", 0.9, 1));
  records.push_back(failed("e", "peer", "not applicable"));
  records.push_back(cell("f", "DB", 0.9, 1));  // the peer's is not made yet
  write(records);
  EXPECT_EQ(lines("profile_tau")[1].label, "peer (1 failed, 1 not applicable of 4)");
}

TEST_F(Figures, EffectsSayWhatIsProvenAndWhatFailed) {
  struct Expected {
    int of_a, of_b;
    bool is_planned;
    std::string label, marker;
  };
  for (const auto& [of_a, of_b, is_planned, label, marker] :
       {Expected{0, 0, false, "B - A", "#0072b2"},
        {0, 0, true, "B - A", "#0072b2"},
        {1, 2, false, "B - A (B failed on 2, A failed on 1)", "white"},
        {1, 2, true, "B - A (B failed on 2, A failed on 1)", "white"}}) {
    write(twelve_domains(of_a, of_b),
          is_planned ? std::vector<Hypothesis>{{"", "A", "B", {"eta_mean"}}} : std::vector<Hypothesis>());
    const std::vector<Line> eta = lines("effects_eta_mean"), tau = lines("effects_tau");
    ASSERT_EQ(eta.size(), 3u);
    EXPECT_LT(eta[0].points[0].x, eta[1].points[0].x) << "the interval, and the effect in it";
    EXPECT_LT(eta[1].points[0].x, eta[0].points[1].x);
    EXPECT_EQ(eta[1].marker, marker);
    EXPECT_EQ(eta[2].label, label);
    EXPECT_EQ(tau.at(1).marker, "white") << "there is no difference";
  }
  write(twelve_domains(0, 0), {{"", "A", "B", {"d4"}}});
  EXPECT_EQ(lines("effects_eta_mean").at(1).marker, "white") << "not planned";
}

class FiguresPrograms : public Figures {
 protected:
  void SetUp() override {
    if (std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") != 0)
      GTEST_SKIP() << "python3-matplotlib is not installed";
  }
};

TEST_F(FiguresPrograms, AreTheSameBytesTwiceWithTheirFonts) {
  write(twelve_domains(0, 0));
  ASSERT_EQ(draw_figures({folder_.path()}), "");
  ASSERT_EQ(drawn().size(), 2u * (5 + 3)) << "no record has eta_worst";
  std::map<std::string, std::string> first;
  for (const std::string& name : drawn()) first[name] = read_text(folder_ / kFigures / name);
  ASSERT_EQ(draw_figures({folder_.path()}), "");
  for (const auto& [name, bytes] : first) EXPECT_EQ(read_text(folder_ / kFigures / name), bytes) << name;
  const std::string &svg = first.at("profile_eta.svg"), &pdf = first.at("profile_eta.pdf");
  EXPECT_TRUE(holds(svg, "width=\"244.8pt\"")) << "3.4 inches, a column";
  EXPECT_FALSE(holds(svg, "<text")) << "letters are shapes";
  EXPECT_TRUE(holds(svg, "<!-- A -->"));
  EXPECT_TRUE(holds(pdf, "/FontFile2"));
  EXPECT_FALSE(holds(pdf, "CreationDate"));
}

TEST_F(FiguresPrograms, GoWhenThereAreNoneAnyLonger) {
  write(three_cases());
  ASSERT_EQ(draw_figures({folder_.path()}), "");
  const std::size_t all = drawn().size();
  EXPECT_GE(all, 10u);
  for (const char* name : {"mine.svg", "profile_eta.csv"}) write_text(folder_ / kFigures / name, "<svg/>");
  ASSERT_EQ(draw_figures({folder_.path()}), "");
  EXPECT_EQ(drawn().size(), all + 1) << "an old one's data goes, files of others stay";
  std::vector<CellRecord> two_cases = three_cases();
  two_cases.resize(4);
  write(two_cases);
  ASSERT_EQ(draw_figures({folder_.path()}), "");
  EXPECT_EQ(std::ranges::count(drawn(), "profile_eta.svg"), 0) << "two cases are too few";
  EXPECT_EQ(std::ranges::count(drawn(), "mine.svg"), 1);
  std::vector<CellRecord> one_pipeline = three_cases();
  std::erase_if(one_pipeline, [](const CellRecord& r) { return r.pipeline == "peer"; });
  write(one_pipeline);
  ASSERT_EQ(draw_figures({folder_.path()}), "");
  EXPECT_EQ(drawn(), Strings{"mine.svg"});
}

/// Tables are whole without figures, and a script of one's own is run in the place of ours.
TEST_F(Figures, SayWhyTheyAreNotDrawn) {
  const auto say = [&](const std::string& script) {
    const fs::path file = write_text(folder_ / "script", "#!/bin/sh\n" + script);
    fs::permissions(file, fs::perms::owner_all);
    setenv("DELQUAD_FIGURES", file.c_str(), 1);
    try {
      const std::string why = draw_figures({folder_ / "a", folder_ / "b"});
      unsetenv("DELQUAD_FIGURES");
      return why;
    } catch (const InputError& error) {
      unsetenv("DELQUAD_FIGURES");
      return std::string("error: ") + error.what();
    }
  };
  EXPECT_EQ(say("echo No module named matplotlib; exit 3"),
            "figures are not drawn: No module named matplotlib: install python3-matplotlib, then call "
            "'delquad tables' on the folder");
  EXPECT_EQ(say("touch \"$1.seen\" \"$2.seen\""), "");
  EXPECT_TRUE(fs::exists(folder_ / "a.seen") && fs::exists(folder_ / "b.seen"));
  const std::string failed = say("echo first; echo the disk is full; exit 1");
  EXPECT_TRUE(failed.starts_with("error: figures are not drawn: ")) << failed;
  EXPECT_TRUE(failed.ends_with("ended with exit code 1: the disk is full")) << failed;
  setenv("DELQUAD_FIGURES", "/nowhere", 1);
  EXPECT_EQ(draw_figures({}),
            "figures are not drawn: DELQUAD_FIGURES: /nowhere cannot be run: expected the program that reads "
            "tables of results");
  unsetenv("DELQUAD_FIGURES");
}

}  // namespace
}  // namespace delquad
