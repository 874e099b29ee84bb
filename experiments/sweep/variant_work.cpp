// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/variant_work.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <new>
#include <system_error>
#include <utility>

#include "base/activity.h"
#include "base/stopwatch.h"
#include "base/system.h"
#include "delquad/error.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/wanted_fields.h"
#include "io/digest.h"
#include "io/formats/vtu.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/tables/result_records.h"

namespace delquad {

namespace {

std::string clock_text(double seconds) {
  const auto s = static_cast<long long>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

SweepProgress::SweepProgress(std::size_t cells, PlaceInQueue place)
    : cells_(cells),
      place_(std::move(place)),
      shown_(errors_have_a_terminal() && verbosity() != Verbosity::kQuiet) {
  void* memory = mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  counts_ = new (memory) Counts;
}

SweepProgress::~SweepProgress() {
  if (shown_) fmt::print(stderr, "\r\x1b[2K");
  munmap(counts_, sizeof(Counts));
}

void SweepProgress::found(std::size_t cells) {
  found_ += cells;
  counts_->done += cells;
}

/// By the cells that were made here; before the first one, and for the experiments after it, by what their
/// files say.
std::string SweepProgress::time_left(std::size_t done) const {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  double left = 0;
  if (done > found_)
    left = elapsed * static_cast<double>(cells_ - done) / static_cast<double>(done - found_);
  else if (place_.seconds)
    left = std::max(0.0, *place_.seconds - elapsed);
  else
    return "";
  return ", about " + clock_text(left + place_.seconds_after.value_or(0)) +
         (place_.seconds_after ? " left" : " left for it");
}

void SweepProgress::draw() {
  if (!shown_ || cells_ == 0) return;
  constexpr std::size_t kWidth = 16;  // of the bar, in characters
  const std::size_t done = std::min<std::size_t>(counts_->done, cells_), failed = counts_->failed;
  const std::size_t filled = kWidth * done / cells_;
  const std::string place =
      place_.count > 1 ? fmt::format("{}/{} {}: ", place_.index + 1, place_.count, place_.name) : "";
  fmt::print(stderr, "\r\x1b[2K[{}{}] {}{}/{} cells{}{}", std::string(filled, '#'),
             std::string(kWidth - filled, '.'), place, done, cells_,
             failed > 0 ? fmt::format(", {} failed", failed) : "", time_left(done));
  std::fflush(stderr);
}

namespace {

/// Processor time that this program took until its libraries were loaded: as a peer's start counts, so does
/// ours.
const TimeSpent kStart = [] {
  const double seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return TimeSpent{seconds, seconds};
}();

/// eta of every cell in the order of VTU files (lines, triangles, quads); 0 where it has no meaning.
std::vector<double> cell_etas(const Mesh& mesh) {
  std::vector<double> etas(mesh.lines.size() + mesh.triangles.size(), 0.0);
  const std::vector<double> quads = quad_etas(mesh);
  etas.insert(etas.end(), quads.begin(), quads.end());
  return etas;
}

namespace fs = std::filesystem;

/// Where peers and measures by command work.
fs::path scratch_of(const fs::path& cell) {
  return cell.parent_path() / ("." + cell.filename().string() + ".work");
}

/// Moves the files of a folder that need not exist.
void move_files(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from)) return;
  for (const auto& entry : fs::directory_iterator(from)) fs::rename(entry, to / entry.path().filename());
}

void remove_scratch(const Cell& cell) {
  std::error_code ignored;
  fs::remove_all(scratch_of(cell.folder), ignored);
}

/// Each names its case.
void print_warnings(const Case& c, const std::vector<Warning>& warnings) {
  for (const std::string& line : lines_of(warnings))
    print_line(fmt::format("warning: {}{}", line.starts_with(c.name) ? "" : c.folder + ": ", line));
}

}  // namespace

void print_line(const std::string& text) {
  // In one piece: several processes may speak at once.
  fmt::print(stderr, "{}\n", (errors_have_a_terminal() ? "\r\x1b[2K" : "") + text);
}

bool is_done(const Cell& cell) {
  const std::string state = state_of_cell(cell.folder, cell.identity.key);
  return state == "done" || state == kNotApplicable;
}

void VariantWork::prepare() {
  const StageScope preparing("fields");
  prepared = delquad::prepare(c);
  print_warnings(c, prepared->warnings);
  meshing.emplace(prepared);
}

void VariantWork::finish(const Cell& cell) {
  const StageScope finishing("writing");
  const std::string label = c.folder + " " + cell.pipeline->text;
  const fs::path scratch = scratch_of(cell.folder);
  const std::string name = c.name + " " + cell.pipeline->text;
  const Peer* peer = cell.identity.peer;
  MeshResult result = c.adapt           ? mesh_cell(c, *cell.pipeline, peer, scratch)
                      : peer != nullptr ? run_peer(*peer, c, prepared, name, scratch, cell.reference)
                                        : meshing->finish();
  if (const std::string& why = cell.identity.no_peer_version; !why.empty())
    result.warnings.push_back(name + ": its version is unknown: " + why);
  print_warnings(c, result.warnings_on_mesh());
  // Meshes of peers are shown as they are.
  if (peer == nullptr && !allow_unsound) require_sound(name, result);
  if (!result.soundness.accepted())
    print_line(fmt::format("warning: {}: {}", name, result.soundness.complaint()));
  for (const std::string& failure : measure_by_solvers(cell.identity, c, result))
    print_line(fmt::format("warning: {} {}: {}", c.folder, cell.pipeline->text, failure));
  // Before anything of the cell is in place: it may take long.
  if (peer == nullptr) fs::remove_all(scratch);
  for (const std::string& failure :
       measure_by_commands(cell.identity, c, cell.pipeline->text, scratch, result))
    print_line(fmt::format("error: {} {}: {}", c.folder, cell.pipeline->text, failure));
  write_cell(cell.folder, [&](const fs::path& at) {
    move_files(scratch, at);
    const Stopwatch writing;
    write_mesh(at / "mesh.msh", result.mesh);
    result.log.add_time("write", writing.time());
    if (peer == nullptr) result.log.add_time("start", kStart);
    write_vtu(at / "mesh.vtu", result.mesh, {{"eta", cell_etas(result.mesh)}});
    if (pictures) {
      draw_mesh(at / "picture.svg", result.mesh, label);
      write_wanted(at / "fields.vtu", result.mesh, result.prepared);
    }
    CellIdentity identity = cell.identity;
    identity.files = marks_of(at);
    write_text_file(at / "record.json", run_record(c, *cell.pipeline, result, &identity));
  });
  remove_scratch(cell);
  progress->done();
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
        write_text_file(at / "record.json",
                        failure_record(c, *cell.pipeline, status, why.kind, why.reason, &identity));
      });
    } catch (const InputError& error) {
      print_line(fmt::format("error: {} {}: {}", c.folder, cell.pipeline->text, error.what()));
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
