// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/experiments/report/browser.h"
#include "tests/support/cells.h"
#include "tests/support/files.h"

namespace delquad::testing_support {
namespace {

/// A grid with two regions, a triangle and a named point.
Mesh mesh_to_look_at() {
  Mesh mesh = quad_grid(4, 4);
  mesh.regions.push_back({2, {"right </script>"}});
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) mesh.quad_region[q] = q % 4 < 2 ? 0 : 1;
  const auto [a, b, c, d] = mesh.quads.back();
  mesh.quads.pop_back();
  mesh.quad_region.pop_back();
  mesh.triangles = {{a, b, c}, {a, c, d}};
  mesh.triangle_region = {1, 1};
  mesh.named_points.push_back({6, {1, {"sensor"}}});
  return mesh;
}

/// Where there is a display, a browser would be opened for the user.
ProgramResult delquad_without_display(const Strings& arguments) {
  Strings words = {"-u", "WAYLAND_DISPLAY", "-u", "DISPLAY", DELQUAD_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program("/usr/bin/env", {std::move(words), 0, {}});
}

/// The page of a mesh, and what `script` returns there.
Json ask_view(const std::string& browser, const Folder& folder, const Mesh& mesh, const std::string& script) {
  write_mesh(folder / "m.msh", mesh);
  const ProgramResult result = delquad_without_display({"view", folder / "m.msh"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "view: " + (folder / "m.msh.html").string() + "\n");
  fs::rename(folder / "m.msh.html", folder / "r.html");
  return ask_page(browser, folder, {script})[0];
}

constexpr const char* kTryAll = R"js(
const canvas = all("canvas")[0], seen = {};
const after = async (name, act) => {
  const before = canvas.toDataURL();
  act();
  await wait(200);
  seen[name] = canvas.toDataURL() !== before;
};
for (const by of ["size", "names", "shape (\u03b7)"]) await after(by, () => choose(all("#coloured-by")[0], by));
for (const row of all(".names div")) await after(row.textContent.trim(), () => all("input", row)[0].click());
await after("all", () => all(".save button").find((b) => b.textContent === "all").click());
await after("only", () => all(".names button")[0].click());
await after("worst", () => all(".closeups button")[0].click());
await after("whole", () => all(".tools button")[2].click());
for (const axis of all("#cut-across")) {
  await after("cut", () => choose(axis, "0"));
  await after("uncut", () => choose(axis, ""));
}
return { seen, numbers: all(".numbers dd").map((n) => n.textContent), facts: all("#facts")[0].textContent };
)js";

TEST(ViewPrograms, ShowsCellsByShapeAndTakesThemAway) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  const auto told = ask_view(browser, folder, mixed_solid(), R"js(
const canvas = all("canvas")[0], seen = {};
const after = async (name, act) => {
  const before = canvas.toDataURL();
  act();
  await wait(200);
  seen[name] = canvas.toDataURL() !== before;
};
await after("shapes", () => choose(all("#coloured-by")[0], "cells"));
await after("cut", () => choose(all("#cut-across")[0], "0"));
await after("quality", () => choose(all("#coloured-by")[0], "shape (\u03b7)"));
await after("uncut", () => choose(all("#cut-across")[0], ""));
return { seen, facts: all("#facts")[0].textContent };
)js");
  EXPECT_EQ(told["facts"], "2 \u00d7 1 \u00d7 2 , 1 hexahedra, 2 prisms, 5 pyramids, 2 tetrahedra");
  EXPECT_EQ(told["seen"], Json({{"shapes", true}, {"cut", true}, {"quality", true}, {"uncut", true}}));
}

TEST(ViewPrograms, ShowsQualitySizesNamesAndWorstQuads) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  const auto told = ask_view(browser, folder, mesh_to_look_at(), kTryAll);
  const Strings acts = {"size",
                        "names",
                        "shape (\u03b7)",
                        "inside 8 elementsonly",
                        "right </script> 9 elements, 1 irregularonly",
                        "south 4 linesonly",
                        "sensor point, number 5",
                        "all",
                        "only",
                        "worst",
                        "whole"};
  for (const std::string& act : acts)
    EXPECT_EQ(told["seen"].value(act, false), true) << act << " in " << told;
  EXPECT_EQ(told["numbers"][0], "25");
  EXPECT_EQ(told["facts"], "1 \u00d7 1 ");
  EXPECT_FALSE(told["seen"].contains("cut")) << "a plane cannot be cut open";
}

TEST(ViewPrograms, ShowsCurvedSurfaces) {
  NEEDS_BROWSER(browser);
  const Folder folder;
  const auto told = ask_view(browser, folder, curved_grid(4, 3, 2, true), kTryAll);
  for (const char* act : {"size", "names", "south 4 linesonly", "worst", "whole", "cut", "uncut"})
    EXPECT_EQ(told["seen"].value(act, false), true) << act << " in " << told;
  EXPECT_TRUE(holds(told["facts"].get<std::string>(), "elements of order 2")) << told;
}

TEST(View, IsOpenedInABrowserWhereThereIsADisplay) {
  const Folder folder;
  write_mesh(folder / "m.msh", quad_grid(2, 2));
  write_text(folder / "xdg-open", "#!/bin/sh\necho \"$1\" > " + (folder / "opened.part").string() + "\nmv " +
                                      (folder / "opened.part").string() + " " + (folder / "opened").string() +
                                      "\n");
  fs::permissions(folder / "xdg-open", fs::perms::owner_all);
  for (const std::string display : {"", ":7"}) {
    const auto result = run_program(
        "/usr/bin/env",
        {{"-u", "WAYLAND_DISPLAY", "DISPLAY=" + display, "PATH=" + folder.path().string() + ":/usr/bin:/bin",
          DELQUAD_PROGRAM, "view", folder / "m.msh", "-o", folder / "page.html"},
         0,
         {}});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (int i = 0; i < 100 && display != "" && !fs::exists(folder / "opened"); ++i) usleep(50'000);
    EXPECT_EQ(fs::exists(folder / "opened"), display != "");
  }
  EXPECT_EQ(read_text(folder / "opened"), (folder / "page.html").string() + "\n");
}

TEST(View, OfAMeshThatIsMade) {
  const Folder folder;
  const auto model = write_text(folder / "m.toml", "loop = { rectangle = [[0, 0], [1, 1]] }\nsize = 0.25\n");
  const auto result = delquad_without_display({"mesh", model, "-o", folder / "m.msh", "--view"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(holds(read_text(folder / "m.msh.html"), "\"n_quads\":16"));
}

}  // namespace
}  // namespace delquad::testing_support
