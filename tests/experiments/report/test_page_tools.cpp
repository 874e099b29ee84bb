// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/experiments/report/browser.h"
#include "tests/support/files.h"

namespace delquad::testing_support {
namespace {

/// Two cases with three seeds; DG leaves triangles, F has nothing but.
const std::string kSeedsExperiment = R"(
title = "Seeds"
pipelines = ["F", "DB", "DG"]
size = 0.25
[matrix]
seed = [1, 2, 3]
[[case]]
name = "disc"
loop = { circle = { centre = [0, 0], radius = 1 } }
[[case]]
name = "square"
loop = { rectangle = [[0, 0], [1, 1]] }
)";

/// A script that asks the page of the seeds; all are asked in one start of the browser.
class Question {
 public:
  explicit Question(const char* script) : place_(scripts().size()) { scripts().emplace_back(script); }
  std::size_t place() const { return place_; }
  static Strings& scripts() {
    static Strings all;
    return all;
  }

 private:
  std::size_t place_;
};

class PageToolsPrograms : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (find_browser().program.empty()) return;
    seeds_ = std::make_unique<Folder>();
    run_into(*seeds_, "seeds", kSeedsExperiment);
    report(*seeds_);
    answers_ = ask_page(find_browser().program, *seeds_, Question::scripts());
  }
  static void TearDownTestSuite() { seeds_.reset(); }
  void SetUp() override {
    NEEDS_BROWSER(browser);
    browser_ = browser;
  }
  static void report(const Folder& folder) {
    ASSERT_EQ(delquad({"report", folder / "results", "-o", folder / "r.html"}).exit_code, 0);
  }
  /// A page of the test's own: its r.html, with results in results/seeds. All tests share the cells.
  void make_page(const std::string& experiment) {
    fs::copy(*seeds_ / "results", folder_ / "results", fs::copy_options::recursive);
    const ProgramResult made = run_into(folder_, "seeds", experiment);
    ASSERT_TRUE(made.exit_code == 0 || made.exit_code == 3) << made.err;
    report(folder_);
  }
  static Json answer(const Question& question) { return answers_.at(question.place()); }
  Json ask(const std::string& script, const std::string& window = "800,600") {
    return ask_page(browser_, folder_, {script}, window)[0];
  }
  static Json record(const std::string& cell) {
    return Json::parse(read_text(*seeds_ / "results/seeds" / cell / "record.json"));
  }

  std::string browser_;
  Folder folder_;
  static inline std::unique_ptr<Folder> seeds_;
  static inline std::vector<Json> answers_;
};

std::string decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned held = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    held = held << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 255);
  }
  return bytes;
}

/// The text of a PDF file, or nothing where no program here tells it.
std::string text_of_pdf(const fs::path& file) {
  if (!fs::exists("/usr/bin/pdftotext")) return "";
  const ProgramResult result = run_program("/usr/bin/pdftotext", {{"-layout", file.string(), "-"}, 0, {}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");  // complaints of a broken file
  return result.out;
}

const Question kSortsByAnyColumn(R"(
    const table = document.querySelector(".table"), rows = () => all("tbody tr", table).map((row) => row.cells);
    const place = all("thead th", table).findIndex((th) => th.dataset.key === "eta_mean");
    // The first column spans rows until the table is sorted.
    const column = () => rows().map((cells) => parseFloat(cells[cells.length - (all("thead th", table).length - place)].textContent.replace("~", "")));
    const head = table.querySelector('[data-key="eta_mean"]'), looks = [];
    for (let i = 0; i < 4; ++i) {
      looks.push([head.getAttribute("aria-sort"), column().map((v) => (isNaN(v) ? null : v)), all("td[rowspan], th[rowspan]", table).length]);
      head.querySelector("button").click();
    }
    table.querySelector('[data-key="name"] button').click();
    return { looks, names: all("tbody th.word", table).map((th) => th.textContent) };
  )");
TEST_F(PageToolsPrograms, SortsByAnyColumn) {
  const Json seen = answer(kSortsByAnyColumn);
  const Json& looks = seen.at("looks");
  const auto sorted = [](const Json& column, bool up) {
    std::vector<double> known;
    for (const Json& v : column)
      if (!v.is_null()) known.push_back(v);
    return known.size() == 4 && column[4].is_null() && column[5].is_null() &&
           (up ? std::ranges::is_sorted(known) : std::ranges::is_sorted(known, std::greater<>()));
  };
  EXPECT_TRUE(looks[0][0].is_null());
  EXPECT_EQ(looks[0][2], 2);
  EXPECT_EQ(looks[1][0], "ascending");
  EXPECT_TRUE(sorted(looks[1][1], true)) << looks[1];
  EXPECT_EQ(looks[1][2], 0);
  EXPECT_EQ(looks[2][0], "descending");
  EXPECT_TRUE(sorted(looks[2][1], false)) << looks[2];
  EXPECT_EQ(looks[3], looks[0]);
  EXPECT_EQ(seen["names"], (Json{"DB", "DB", "DG", "DG", "F", "F"}));
}

const Question kFiltersByCaseAndPipeline(R"(
    const table = document.querySelector(".table"), field = table.querySelector("input[type=search]"), looks = [];
    for (const text of ["SQUARE db", "dg", "nothing like it", ""]) {
      field.value = text;
      field.dispatchEvent(new Event("input"));
      looks.push([all("tbody th.word", table).map((th) => th.textContent), table.querySelector("output").textContent]);
    }
    return looks;
  )");
TEST_F(PageToolsPrograms, FiltersByCaseAndPipeline) {
  const Json seen = answer(kFiltersByCaseAndPipeline);
  EXPECT_EQ(seen[0], (Json{{"DB"}, "1 of 6 rows"}));
  EXPECT_EQ(seen[1], (Json{{"DG", "DG"}, "2 of 6 rows"}));
  EXPECT_EQ(seen[2][0], Json::array());
  EXPECT_EQ(seen[3][0].size(), 6u);
}

/// The columns that the experiment asks for, which fit a common screen; all of them on demand.
TEST_F(PageToolsPrograms, ShowsTheColumnsOfTheExperiment) {
  make_page("columns = ['tau', 'n_quads', 'eta_mean', 'warp_max']\nstep_times = true\n" + kSeedsExperiment);
  const Json seen = ask(R"(
    const table = document.querySelector(".table"), heads = () => all("thead th", table).map((th) => th.dataset.key), looks = [];
    const choice = table.querySelector("[data-choice=columns]"), scroll = table.querySelector(".scroll");
    const look = () => looks.push({ heads: heads(), cells: table.querySelectorAll("tbody tr")[1].querySelectorAll("td").length, fits: scroll.scrollWidth <= scroll.clientWidth,
                                    sorted: all("[aria-sort]", table).map((th) => th.dataset.key) });
    look();
    table.querySelector('[data-key="tau"] button').click();
    choose(choice, "all"), look();
    table.querySelector('[data-key="d4"] button').click();
    choose(choice, "chosen"), look();
    return { looks, pairs: all(".pairs thead th").map((th) => th.dataset.key) };
  )",
                        "1280,900");
  const Json wanted = {"group", "name", "n", "tau", "n_quads", "eta_mean", "warp_max"};
  const Json& looks = seen.at("looks");
  EXPECT_EQ(looks[0]["heads"], wanted);
  EXPECT_EQ(looks[0]["cells"], 5);
  EXPECT_TRUE(looks[0]["fits"]);
  EXPECT_GT(looks[1]["heads"].size(), 15u);
  EXPECT_EQ(looks[1]["cells"], looks[1]["heads"].size() - 2);
  EXPECT_EQ(looks[1]["sorted"], Json{"tau"});
  EXPECT_EQ(looks[2]["heads"], wanted);
  EXPECT_EQ(looks[2]["sorted"], Json::array());
  EXPECT_EQ(seen["pairs"].back(), "first_is") << "a column of words: " << seen["pairs"];
  EXPECT_EQ(std::ranges::count(seen["pairs"], "low"), 0);
}

const Question kSavesTablesAsTheRunWroteThem(R"(
    for (const button of all(".table-tools .save button")) await save(button);
    return saved;
  )");
TEST_F(PageToolsPrograms, SavesTablesAsTheRunWroteThem) {
  const Json saved = answer(kSavesTablesAsTheRunWroteThem);
  for (const char* extension : {".csv", ".tex", ".md"}) {
    const std::string name = std::string("seeds-table") + extension;
    ASSERT_TRUE(saved.contains(name)) << saved;
    EXPECT_EQ(decoded(saved[name]), read_text(*seeds_ / "results/seeds/table" += extension));
  }
}

/// A figure in each format: SVG that needs no style sheet and is the same in the dark, PNG, PDF with its
/// words.
const Question kSavesFigures(R"(
    const names = [];
    for (const title of ["Time by step", "Quads by"]) {
      const figure = all("figure.of-chart").find((f) => f.querySelector("h4").textContent.startsWith(title));
      for (const button of all(".save button", figure)) names.push(await save(button));
    }
    for (const button of all("canvas + .head .save button").slice(0, 3)) names.push(await save(button));
    const first = saved[names[0]];
    choose(document.getElementById("theme"), "dark");
    await save(all("figure.of-chart").find((f) => f.querySelector("h4").textContent === "Time by step").querySelector(".save button"));
    await wait(500);
    return { names, saved, same: first === saved[names[0]] };
  )");
TEST_F(PageToolsPrograms, SavesFigures) {
  const Json saved = answer(kSavesFigures);
  ASSERT_EQ(saved.at("names").size(), 9u) << saved;
  EXPECT_TRUE(saved["same"].get<bool>());
  for (std::size_t i = 0; i < 9; i += 3) {
    const auto file = [&](std::size_t k) {
      return decoded(saved["saved"][saved["names"][i + k].get<std::string>()]);
    };
    EXPECT_EQ(file(0).find("<svg"), 0u);
    EXPECT_EQ(count(file(0), "var("), 0u);
    EXPECT_GT(count(file(0), "<path") + count(file(0), "<rect"), 4u);
    EXPECT_EQ(file(1).substr(0, 4), "\x89PNG");
    EXPECT_EQ(file(2).substr(0, 5), "%PDF-");
    EXPECT_EQ(count(file(2), "/Subtype /Image"), 0u) << "vectors";
    EXPECT_EQ(file(2).substr(file(2).size() - 6), "%%EOF\n");
    write_text(folder_ / ("f" + std::to_string(i) + ".pdf"), file(2));
  }
  if (!fs::exists("/usr/bin/pdftotext")) GTEST_SKIP() << "poppler-utils is not installed";
  const std::string words = text_of_pdf(folder_ / "f0.pdf");
  EXPECT_TRUE(holds(words, "DB", "DG", "insertion", "matching"));
  text_of_pdf(folder_ / "f6.pdf");
}

/// Parts of a drawing that vectors here cannot say become an image; forbidden actions are not done.
TEST_F(PageToolsPrograms, SavesFiguresOfTheFolder) {
  make_page(kSeedsExperiment);
  const fs::path figures = folder_ / "results/seeds/figures";
  fs::create_directories(figures);
  const std::string head = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 100\">";
  write_text(figures / "a.svg", head +
                                    "<g transform=\"translate(10 20)\"><path d=\"m0 0 50 0q9 9 0 20z\" "
                                    "fill=\"#c00\"/><text x=\"20\" y=\"40\">plain</text></g></svg>");
  write_text(figures / "b.svg",
             head +
                 "<defs><linearGradient id=\"g\"><stop "
                 "stop-color=\"#c00\"/></linearGradient></defs><script>document.title = 'taken "
                 "over'</script><rect width=\"90\" height=\"50\" fill=\"url(#g)\" onclick=\"x()\"/></svg>");
  report(folder_);
  const Json saved = ask(R"(
    const buttons = all(".drawings .save button");
    for (const button of buttons) await save(button);
    return { saved, title: document.title, complaints: all(".drawings .failed").map((n) => n.textContent) };
  )");
  EXPECT_EQ(saved["title"], "Seeds");
  EXPECT_GE(saved["complaints"].size(), 2u);
  for (const Json& complaint : saved["complaints"]) EXPECT_EQ(complaint, "");
  EXPECT_EQ(count(decoded(saved.at("saved").at("seeds-a.pdf")), "/Subtype /Image"), 0u);
  EXPECT_EQ(count(decoded(saved.at("saved").at("seeds-b.pdf")), "/Subtype /Image"), 1u);
  EXPECT_EQ(count(decoded(saved.at("saved").at("seeds-b.svg")), "script"), 0u);
  EXPECT_EQ(count(decoded(saved.at("saved").at("seeds-b.svg")), "onclick"), 0u);
  write_text(folder_ / "a.pdf", decoded(saved.at("saved").at("seeds-a.pdf")));
  if (!fs::exists("/usr/bin/pdftotext")) GTEST_SKIP() << "poppler-utils is not installed";
  EXPECT_TRUE(holds(text_of_pdf(folder_ / "a.pdf"), "plain"));
}

const Question kShowsOneSeedAtATimeAndTheMeans(R"(
    const sheet = document.querySelector(".sheet"), choice = sheet.querySelector("[data-choice=seed]"), numbers = [];
    for (const place of ["0", "2", "0"]) {
      choose(choice, place);
      for (let i = 0; i < 100 && all("canvas[data-drawn]", sheet).length < 3; ++i) await wait(50);
      const card = all(".card", sheet).find((c) => c.querySelector(".name .word").textContent === "DB");
      const item = all(".numbers div", card).find((d) => d.querySelector("dt").textContent === "eta mean");
      numbers.push([item.querySelector("dd").textContent, card.querySelector("canvas").toDataURL().length]);
    }
    const means = all(".means tbody tr", sheet).map((tr) => tr.textContent.trim()), list = all("nav .of-sheet").map((a) => a.textContent);
    return { numbers, options: choice.options.length, means: all(".means tbody tr", sheet).map((tr) => [...tr.cells].map((c) => c.textContent)),
             heads: all(".means thead th", sheet).map((th) => th.textContent), list, sheets: all(".sheet").length };
  )");
TEST_F(PageToolsPrograms, ShowsOneSeedAtATimeAndTheMeans) {
  const Json seen = answer(kShowsOneSeedAtATimeAndTheMeans);
  const auto three = [](double v) {
    return std::to_string(v).substr(0, 1) + "." + std::to_string(std::lround(v * 1000));
  };
  const auto eta = [&](const char* seed) {
    return record(std::string("disc@seed=") + seed + "/DB").at("metrics").at("eta_mean").get<double>();
  };
  EXPECT_EQ(seen["sheets"], 2);
  EXPECT_EQ(seen["options"], 3);
  EXPECT_EQ(seen["list"][0], "disc (3 seeds)");
  EXPECT_EQ(seen["numbers"][0][0], three(eta("1")));
  EXPECT_EQ(seen["numbers"][1][0], three(eta("3")));
  EXPECT_NE(seen["numbers"][0][1], seen["numbers"][1][1]);
  EXPECT_EQ(seen["numbers"][0], seen["numbers"][2]);
  const auto column = std::ranges::find(seen["heads"], "eta mean") - seen["heads"].begin();
  const double mean = (eta("1") + eta("2") + eta("3")) / 3;
  EXPECT_NEAR(std::stod(seen["means"][1][static_cast<std::size_t>(column)].get<std::string>()), mean, 0.001);
  EXPECT_EQ(seen["means"][1][1], "3");
}

const Question kBoxesOfSeedsAndCases(R"(
    const label = () => document.querySelector(".spread svg.chart").getAttribute("aria-label"), labels = [label()];
    const [metric, cells] = ["metric", "cells"].map((name) => document.querySelector(`.spread [data-choice=${name}]`));
    labels.push(all(".spread rect.box").length);
    choose(cells, "1");
    labels.push(label(), all(".spread rect.box").length);
    choose(metric, all("option", metric).find((o) => o.textContent === "quads").value);
    labels.push(label());
    return labels;
  )");
TEST_F(PageToolsPrograms, BoxesOfSeedsAndCases) {
  const Json seen = answer(kBoxesOfSeedsAndCases);
  std::vector<double> all, square;
  for (const char* name : {"disc", "square"})
    for (const char* seed : {"1", "2", "3"}) {
      const Json metrics = record(std::string(name) + "@seed=" + seed + "/DB").at("metrics");
      all.push_back(metrics.at("eta_mean"));
      if (name == std::string("square")) square.push_back(metrics.at("n_quads"));
    }
  std::ranges::sort(all);
  std::ranges::sort(square);
  const auto median_in = [](const std::string& label) {
    const std::string before = "DB median ";
    return std::stod(label.substr(label.find(before) + before.size()));
  };
  EXPECT_NEAR(median_in(seen[0]), (all[2] + all[3]) / 2, 1e-4);
  EXPECT_TRUE(holds(seen[0].get<std::string>(), "of 6"));
  EXPECT_EQ(seen[1], 2);  // DB and DG; F has no eta
  EXPECT_TRUE(holds(seen[2].get<std::string>(), "of 3"));
  EXPECT_EQ(seen[3], 0);  // three values make no box
  EXPECT_EQ(median_in(seen[4]), square[1]);
}

const Question kColoursAndTheirRange(R"(
    const mesh = () => all("canvas").find((c) => c.getAttribute("aria-label").includes("by DB")).toDataURL(), looks = [];
    const bar = () => all("figure rect[data-eta]").map((r) => r.getAttribute("fill")).join();
    const look = () => looks.push(mesh() + bar() + document.querySelector(".scale").outerHTML);
    const [map, low, high] = ["map", "low", "high"].map((name) => document.getElementById(`colour-${name}`));
    look();
    choose(map, "cividis"), look();
    choose(low, "0.8"), look();
    choose(low, "1"), look();
    const complaint = all(".bar > .failed")[0].textContent;
    choose(low, "0"), choose(map, "viridis"), look();
    return { equal: looks.map((a) => looks.indexOf(a)), complaint };
  )");
TEST_F(PageToolsPrograms, ColoursAndTheirRange) {
  const Json seen = answer(kColoursAndTheirRange);
  EXPECT_EQ(seen["equal"], (Json{0, 1, 2, 2, 0}));
  EXPECT_NE(seen["complaint"], "");
}

const Question kLightAndDark(R"(
    const shades = () => [document.body, document.querySelector("table"), document.querySelector("canvas")].map((node) => {
      const { color, backgroundColor } = getComputedStyle(node);
      return [color, backgroundColor];
    });
    const looks = [shades()], pictures = [document.querySelector("canvas").toDataURL()];
    for (const theme of ["dark", "light"]) {
      choose(document.getElementById("theme"), theme);
      looks.push(shades());
      pictures.push(document.querySelector("canvas").toDataURL());
    }
    return { looks, same: [pictures[0] === pictures[1], pictures[0] === pictures[2]] };
  )");
TEST_F(PageToolsPrograms, LightAndDark) {
  const Json seen = answer(kLightAndDark);
  EXPECT_EQ(seen["looks"][0], seen["looks"][2]);
  EXPECT_EQ(seen["looks"][0][0][1], "rgb(255, 255, 255)");
  EXPECT_EQ(seen["looks"][1][0][1], "rgb(20, 24, 30)");
  EXPECT_NE(seen["looks"][0][2], seen["looks"][1][2]);
  EXPECT_EQ(seen["same"], (Json{false, true}));
}

/// Nothing but tables and the like, which scroll by themselves, is wider than a small telephone.
TEST_F(PageToolsPrograms, FitsATelephone) {
  make_page(kSeedsExperiment);
  std::string page;
  for (const char c : read_text(folder_ / "r.html"))
    page += c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  write_text(folder_ / "r.html", "<html data-drawn=\"all\"><iframe width=\"360\" height=\"800\" srcdoc=\"" +
                                     page + "\"></iframe></html>");
  const Json seen = ask(R"(
    const frame = document.querySelector("iframe");
    for (let i = 0; i < 1000 && frame.contentDocument.querySelectorAll("table").length < 3; ++i) {
      work();
      await wait(20);
    }
    const page = frame.contentDocument, wide = frame.contentWindow.innerWidth;
    const over = all("main *", page).filter((n) => !n.closest(".scroll, .paper, .on-paper") && n.getBoundingClientRect().right > wide + 1);
    return { wide, tables: all("table", page).length, page: page.documentElement.scrollWidth, over: over.map((n) => n.outerHTML.slice(0, 200)) };
  )");
  EXPECT_EQ(seen["wide"], 360);
  EXPECT_GE(seen["tables"], 3);
  EXPECT_LE(seen["page"], 360);
  EXPECT_EQ(seen["over"], Json::array());
}

/// Every column of every table is on paper, upright and across.
TEST_F(PageToolsPrograms, PrintsTablesWhole) {
  if (!fs::exists("/usr/bin/pdftotext")) GTEST_SKIP() << "poppler-utils is not installed";
  make_page("step_times = true\n" + kSeedsExperiment);
  const std::string header = read_text(folder_ / "results/seeds/table.md");
  const std::string page = read_text(folder_ / "r.html");
  for (const char* paper : {"A4 portrait", "A4 landscape"}) {
    write_text(folder_ / "p.html", page + "<style>@page { size: " + paper + "; }</style>");
    const fs::path pdf = folder_ / "p.pdf";
    browse(browser_, folder_, "p.html", {"--print-to-pdf=" + pdf.string(), "--virtual-time-budget=60000"});
    const std::string text = text_of_pdf(pdf);
    EXPECT_TRUE(
        holds(text, "vertices", "eta worst", "eta mean", "tau", "% quads", "insertion s", "total CPU s"));
  }
}

}  // namespace
}  // namespace delquad::testing_support
