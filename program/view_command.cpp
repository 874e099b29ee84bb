// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "base/process.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/view.h"

namespace delquad {
namespace {

struct ViewArguments {
  std::filesystem::path mesh, output;
};

/// In a browser of its own, where there is a display; that there is none, or no browser, is no error.
void open_in_browser(const std::filesystem::path& page) {
  const auto given = [](const char* name) { return std::getenv(name) != nullptr && *std::getenv(name) != 0; };
  if (!given("DISPLAY") && !given("WAYLAND_DISPLAY")) return;
  start_detached("xdg-open", std::filesystem::absolute(page).string());
}

int view_command(const ViewArguments& arguments) {
  ReadNotes notes;
  const std::filesystem::path page = page_of(arguments.mesh, arguments.output);
  check_distinct({{"the mesh", arguments.mesh}, {"-o", page}});
  check_output(page);
  const Mesh mesh = read_mesh(arguments.mesh, &notes);
  view(page, mesh, arguments.mesh.filename().string(), {.warnings = notes});
  return kDone;
}

}  // namespace

std::filesystem::path page_of(const std::filesystem::path& mesh, const std::filesystem::path& page) {
  return page.empty() ? std::filesystem::path(mesh.string() + ".html") : page;
}

void view(const std::filesystem::path& page, const Mesh& mesh, const std::string& title,
          const ViewNotes& notes) {
  write_view(page, mesh, title, notes);
  fmt::print("view: {}\n", page.string());
  open_in_browser(page);
}

void add_view(CLI::App& app, Commands& commands) {
  const auto [command, arguments] =
      add_command(app, commands, "view", "Show a mesh in a browser: shape, sizes, names, worst quads",
                  view_command, true);
  command->add_option("mesh", arguments.mesh, "mesh file")->required();
  command->add_option("-o,--output", arguments.output, "page to write (.html); default: MESH.html beside it");
}

}  // namespace delquad
