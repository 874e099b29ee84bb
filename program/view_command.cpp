#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/view.h"

extern char** environ;

namespace delquad {
namespace {

struct ViewArguments {
  std::filesystem::path mesh, output;
};

/// In a browser of its own, where there is a display; that there is none, or no browser, is no error.
void open_in_browser(const std::filesystem::path& page) {
  const auto given = [](const char* name) { return std::getenv(name) != nullptr && *std::getenv(name) != 0; };
  if (!given("DISPLAY") && !given("WAYLAND_DISPLAY")) return;
  std::string program = "xdg-open", file = std::filesystem::absolute(page).string();
  std::array<char*, 3> arguments = {program.data(), file.data(), nullptr};
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_RDWR, 0);
  posix_spawnattr_t apart;
  posix_spawnattr_init(&apart);
  posix_spawnattr_setflags(&apart, POSIX_SPAWN_SETSID);
  pid_t child = 0;
  posix_spawnp(&child, program.c_str(), &silent, &apart, arguments.data(), environ);
  posix_spawnattr_destroy(&apart);
  posix_spawn_file_actions_destroy(&silent);
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
