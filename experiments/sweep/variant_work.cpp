#include "experiments/sweep/variant_work.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <ostream>
#include <system_error>
#include <utility>

#include "base/activity.h"
#include "base/stopwatch.h"
#include "delquad/error.h"
#include "experiments/console/progress.h"
#include "experiments/sweep/case_pictures.h"
#include "experiments/sweep/cell_folder.h"
#include "experiments/sweep/measure_by_commands.h"
#include "io/digest.h"
#include "io/formats/vtu.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/solve/solver_metrics.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Where peers and measures by command work.
fs::path scratch_of(const fs::path& cell) {
  return cell.parent_path() / ("." + cell.filename().string() + ".work");
}

/// Those of a folder that need not be there.
void move_files(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from)) return;
  for (const auto& entry : fs::directory_iterator(from)) fs::rename(entry, to / entry.path().filename());
}

void remove_scratch(const Cell& cell) {
  std::error_code ignored;
  fs::remove_all(scratch_of(cell.folder), ignored);
}

}  // namespace

void say(const std::string& text) {
  // In one piece: several processes may speak at once.
  fmt::print(stderr, "{}\n", (isatty(STDERR_FILENO) != 0 ? "\r\x1b[2K" : "") + text);
}

bool is_done(const Cell& cell) {
  const std::string state = state_of_cell(cell.folder, cell.identity.key);
  return state == "done" || state == kNotApplicable;
}

void VariantWork::prepare() {
  const DoingStage preparing("fields");
  prepared = delquad::prepare(c);
  for (const std::string& line : lines_of(prepared->warnings)) say("warning: " + line);
  meshing.emplace(prepared);
  if (!pictures) return;
  try {
    prepare_folder(folder / c.folder);
    draw_case(prepared, c.folder, folder / c.folder);
  } catch (const InputError& error) {
    say(fmt::format("error: {}: no pictures of its fields: {}", c.folder, error.what()));
  }
}

void VariantWork::finish(const Cell& cell) {
  const DoingStage finishing("writing");
  const std::string label = c.folder + " " + cell.word->text;
  const fs::path scratch = scratch_of(cell.folder);
  const std::string name = c.name + " " + cell.word->text;
  MeshResult result = cell.identity.peer != nullptr
                          ? run_peer(*cell.identity.peer, c, prepared, name, scratch, cell.reference)
                          : meshing->finish();
  if (const std::string& why = cell.identity.no_peer_version; !why.empty())
    result.warnings.push_back(name + ": its version is unknown: " + why);
  for (const std::string& line : lines_of(result.warnings_on_mesh())) say("warning: " + line);
  // What others make is shown as it is.
  if (cell.identity.peer == nullptr && !allow_unsound) require_sound(name, result);
  if (!result.soundness.accepted()) say(fmt::format("warning: {}: {}", name, result.soundness.complaint()));
  for (const std::string& failure : measure_by_solvers(cell.identity, result))
    say(fmt::format("warning: {} {}: {}", c.folder, cell.word->text, failure));
  // Before anything of the cell is in place: it may take long.
  if (cell.identity.peer == nullptr) fs::remove_all(scratch);
  for (const std::string& failure : measure_by_commands(cell.identity, c, cell.word->text, scratch, result))
    say(fmt::format("error: {} {}: {}", c.folder, cell.word->text, failure));
  write_cell(cell.folder, [&](const fs::path& at) {
    move_files(scratch, at);
    const Stopwatch writing;
    write_mesh(at / "mesh.msh", result.mesh);
    write_vtu(at / "mesh.vtu", result.mesh, {{"eta", cell_etas(result.mesh)}});
    if (pictures) draw(at, label, result);
    result.log.add_time("write", writing.time());
    CellIdentity identity = cell.identity;
    identity.files = marks_of(at);
    write_file_atomically(at / "record.json",
                          [&](std::ostream& out) { out << run_record(c, *cell.word, result, &identity); });
  });
  remove_scratch(cell);
  progress->done();
}

void VariantWork::draw(const fs::path& folder_of_cell, const std::string& label,
                       const MeshResult& result) const {
  (prepared.is_surface() ? draw_surface : draw_mesh)(folder_of_cell / "picture.svg", result.mesh, label);
  if (result.log.summaries.has("smoothing"))
    draw_convergence(folder_of_cell / "convergence.svg", result.log.summaries, label + ": smoothing");
}

void VariantWork::fail(const Cell& cell, const ProcessFailure& why) const {
  give_up(cell, why.kind == kNotApplicable ? kNotApplicable : "failed", why);
}

void VariantWork::give_up(const Cell& cell, const std::string& status, const ProcessFailure& why) const {
  if (why.kind != "interrupted") try {
      write_cell(cell.folder, [&](const fs::path& at) {
        if (cell.identity.peer != nullptr) move_files(scratch_of(cell.folder), at);
        CellIdentity identity = cell.identity;
        identity.files = marks_of(at);
        write_file_atomically(at / "record.json", [&](std::ostream& out) {
          out << failure_record(c, *cell.word, status, why.kind, why.reason, &identity);
        });
      });
    } catch (const InputError& error) {
      say(fmt::format("error: {} {}: {}", c.folder, cell.word->text, error.what()));
    }
  remove_scratch(cell);
  if (why.kind == "interrupted")
    progress->interrupted();
  else if (status == "failed")
    progress->failed();
  else
    progress->done();
}

}  // namespace delquad
