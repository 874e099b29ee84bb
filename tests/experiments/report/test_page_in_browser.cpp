// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/experiments/report/browser.h"
#include "tests/support/files.h"

namespace delquad::testing_support {
namespace {

/// No error, every picture drawn, and a policy that forbids every request: one would be an error.
void expect_sound(const ProgramResult& shown, std::size_t pictures) {
  EXPECT_EQ(count(shown.err, "CONSOLE"), 0u) << shown.err;
  EXPECT_EQ(count(shown.out, "default-src 'none'"), 1u);
  EXPECT_EQ(count(shown.out, "<html lang=\"en\" data-drawn=\"all\">"), 1u) << shown.out.substr(0, 300);
  EXPECT_EQ(count(shown.out, "<canvas"), pictures);
  EXPECT_EQ(count(shown.out, "data-drawn=\"yes\""), pictures);
}

/// Does what a reader does; the document's title tells after what all pictures looked different.
constexpr const char* kReader = R"(<script type="module">
const pictures = () => [...document.querySelectorAll("canvas")].map((c) => c.toDataURL());
const press = (key) => () => document.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", { key }));
const drag = () => {
  const canvas = document.querySelector("canvas"), { left, top } = canvas.getBoundingClientRect();
  canvas.setPointerCapture = canvas.releasePointerCapture = () => {};
  for (const [type, x] of [["pointerdown", 50], ["pointermove", 60], ["pointermove", 90], ["pointerup", 90]])
    canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, pointerType: "mouse", button: 0, buttons: 1, bubbles: true, clientX: left + x, clientY: top + 50 }));
};
const acts = { plus: press("+"), left: press("ArrowLeft"), up: press("ArrowUp"), drag, worst: () => document.querySelector(".closeups button").click(),
  whole: press("0"), right: press("ArrowRight"), reset: press("R"), wheel: () => document.querySelector("canvas").dispatchEvent(new WheelEvent("wheel", { ctrlKey: true, deltaY: -90 })) };
const seen = [];
const act = async () => {
  if (document.documentElement.dataset.drawn !== "all") return setTimeout(act, 50);
  for (const [name, run] of Object.entries(acts)) {
    const before = pictures();
    run();
    await new Promise((done) => setTimeout(done, 200));
    if (pictures().every((picture, i) => picture !== before[i])) seen.push(name);
  }
  document.title = "moved by " + seen.join(" ");
};
act();
</script>)";

void expect_moved_together(const std::string& browser, const Folder& folder) {
  // Without a screen there are no frames to wait for.
  const std::string timer = "<script>window.requestAnimationFrame = (act) => setTimeout(act, 10);</script>";
  write_text(folder / "read.html", timer + read_text(folder / "r.html") + kReader);
  const ProgramResult shown = open_page(browser, folder, "read.html");
  EXPECT_EQ(count(shown.err, "CONSOLE"), 0u) << shown.err;
  const auto title = shown.out.find("<title>");
  EXPECT_EQ(shown.out.substr(title, shown.out.find("</title>") - title),
            "<title>moved by plus left up drag worst whole right reset wheel");
}

/// The report of two meshes says something so many times, and its pictures move.
void expect_page(const std::string& browser, const Folder& folder, const char* results, const char* part,
                 std::size_t times) {
  ASSERT_EQ(delquad({"report", folder / results, "-o", folder / "r.html"}).exit_code, 0);
  const ProgramResult shown = open_page(browser, folder, "r.html");
  expect_sound(shown, 2);
  EXPECT_EQ(count(shown.out, part), times);
  expect_moved_together(browser, folder);
}

TEST(PageInBrowserPrograms, DrawsPlanarCases) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  run_into(folder, "square", kSquareExperiment);
  ASSERT_EQ(delquad({"report", folder / "results", "-o", folder / "r.html"}).exit_code, 0);
  const ProgramResult shown = open_page(browser, folder, "r.html");
  expect_sound(shown, 3);  // of one of two seeds
  EXPECT_EQ(count(shown.out, "class=\"missing failed\""), 3u);
  EXPECT_EQ(count(shown.out, "aria-label=\"Energy by evaluation\""), 1u);
  EXPECT_EQ(count(shown.out, "aria-label=\"Histogram of eta, DB\""), 1u);
  EXPECT_EQ(count(shown.out, "A square &lt;/script&gt; &amp; &lt;b&gt;more&lt;/b&gt;</h2>"), 1u);
}

TEST(PageInBrowserPrograms, DrawsSurfaces) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  // A tetrahedron, whose faces are flat.
  write_text(folder / "t.off",
             "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  const ProgramResult made = run_into(folder, "surface",
                                      "title = 'A surface'\npipelines = ['D', 'DB']\nsize = 0.2\n"
                                      "[[case]]\nname = 'tetrahedron'\nmodel = 't.off'\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  expect_page(browser, folder, "results", "watertight: yes", 2);
}

TEST(PageInBrowserPrograms, ShowsPeers) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  const std::string square =
      "[[case]]\nname = 'square'\nsize = 0.25\nloop = { rectangle = [[0, 0], [1, 1]] }\n";
  run_into(folder, "own", "pipelines = ['DB']\n" + square);
  const std::string mesh = (folder / "results/own/square/DB/mesh.msh").string();
  const ProgramResult made = run_into(folder, "peers",
                                      "pipelines = [\"DB\", \"copy\"]\n[[peer]]\nname = \"copy\"\nversion = "
                                      "[\"echo\", \"1.5\"]\ncommand = [\"sh\", \"-c\", \"cp '" +
                                          mesh + "' {output} # {input}\"]\n" + square);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  expect_page(browser, folder, "results/peers", "another mesher, version 1.5", 1);
}

/// The test would notice: a script that fails, and one that asks the network.
TEST(PageInBrowserPrograms, ErrorsAndRequestsAreSeen) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  run_into(folder, "square", kSquareExperiment);
  ASSERT_EQ(delquad({"report", folder / "results", "-o", folder / "r.html"}).exit_code, 0);
  const std::string page = read_text(folder / "r.html");
  for (const char* script : {"null.x", "fetch('http://127.0.0.1:9/').catch(() => {})",
                             "new Image().src = 'http://127.0.0.1:9/'"}) {
    write_text(folder / "bad.html", page + "<script>" + script + "</script>");
    EXPECT_GE(count(open_page(browser, folder, "bad.html").err, "CONSOLE"), 1u) << script;
  }
}

}  // namespace
}  // namespace delquad::testing_support
