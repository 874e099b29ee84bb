#include "experiments/sweep/variant_work.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <new>
#include <system_error>
#include <utility>

#include "base/activity.h"
#include "base/box.h"
#include "base/stopwatch.h"
#include "base/system.h"
#include "delquad/error.h"
#include "experiments/sweep/folders.h"
#include "io/diagram.h"
#include "io/digest.h"
#include "io/formats/vtu.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/metrics.h"
#include "metrics/solve/solver_metrics.h"
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

constexpr int kFewestAcross = 44, kMostAcross = 160;  // crosses along the longer side of the domain
constexpr int kSamplesAcross = 120;

/// The field at the nodes of a regular grid that lie inside the domain.
std::vector<CrossGlyph> sample_crosses(const Prepared& p) {
  const Box<Vec3> box = Box<Vec3>::around(std::span(p->boundary.points));
  const Vec2 low{box.low.x, box.low.y}, high{box.high.x, box.high.y};
  const double detail = std::sqrt(static_cast<double>(p->boundary.points.size()));
  const int across = std::clamp(static_cast<int>(detail), kFewestAcross, kMostAcross);
  const double step = std::max(high.x - low.x, high.y - low.y) / across;
  std::vector<CrossGlyph> glyphs;
  int where = -1;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const Vec2 u = low + Vec2{(i + 0.5) * step, (j + 0.5) * step};
      if (u.x > high.x || u.y > high.y) continue;
      if (const auto cross = p.cross_at(u, where)) glyphs.push_back({u, cross->angle(), 0.8 * step});
    }
  return glyphs;
}

/// Cuts each edge that is longer than `step` in the middle, until there are none; the mesh stays conforming.
void refine(std::vector<Vec2>& points, std::vector<std::array<int, 3>>& triangles, double step) {
  for (bool changed = true; changed;) {
    changed = false;
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      if (norm(points[b] - points[a]) <= step) return -1;
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) points.push_back(0.5 * (points[a] + points[b]));
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& t : triangles) {
      const int m[3] = {middle(t[1], t[2]), middle(t[2], t[0]),
                        middle(t[0], t[1])};  // opposite to each vertex
      const int cuts = (m[0] >= 0) + (m[1] >= 0) + (m[2] >= 0);
      changed = changed || cuts > 0;
      // With one cut or two, k is the vertex opposite to the side that differs from the others.
      int k = 0;
      while (k < 2 && (m[k] >= 0) != (cuts == 1)) ++k;
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = m[(k + 2) % 3], ca = m[(k + 1) % 3];
      if (cuts == 0) {
        finer.push_back(t);
      } else if (cuts == 1) {
        finer.insert(finer.end(), {{a, b, m[k]}, {a, m[k], c}});
      } else if (cuts == 2) {
        finer.insert(finer.end(), {{a, ab, ca}, {ab, b, c}, {ab, c, ca}});
      } else {
        finer.insert(finer.end(),
                     {{t[0], m[2], m[1]}, {m[2], t[1], m[0]}, {m[1], m[0], t[2]}, {m[0], m[1], m[2]}});
      }
    }
    triangles = std::move(finer);
  }
}

/// Draws the fields of a case: folder/cross.svg and folder/size.svg; of a size that is the same everywhere,
/// the outline and the number.
void draw_case(const Prepared& prepared, const std::string& name, const std::filesystem::path& folder) {
  if (prepared.is_surface()) return;  // fields of surfaces live in the parameter planes of their patches
  std::vector<SingularityMark> marks;
  for (const PlacedSingularity& s : prepared->crosses.singularities)
    marks.push_back({{s.at.x, s.at.y}, s.index});
  draw_crosses(folder / "cross.svg", prepared->boundary, sample_crosses(prepared), marks,
               name + ": cross field");
  TriPatch tri = *prepared.background();
  refine(tri.points, tri.triangles, diagonal(prepared->boundary) / kSamplesAcross);
  Mesh samples;
  samples.triangles = std::move(tri.triangles);
  samples.triangle_region.assign(samples.triangles.size(), 0);
  samples.regions = {{1, {}}};
  std::vector<double> sizes;
  int hint = -1;
  for (const Vec2& u : tri.points) {
    samples.points.push_back({u.x, u.y, 0});
    sizes.push_back(prepared->size.field->at(samples.points.back(), hint));
  }
  if (std::ranges::all_of(sizes, [&](double size) { return size == sizes[0]; }))
    draw_crosses(folder / "size.svg", prepared->boundary, {}, {},
                 fmt::format("{}: size {:.4g} everywhere", name, sizes[0]));
  else
    draw_scalar(folder / "size.svg", samples, sizes, name + ": size field");
}

/// The energy at every evaluation of a smoothing, as its summary has them: a curve for each patch and each
/// time that the frames were taken, dots where the points went on.
void draw_convergence(const std::filesystem::path& path, const Summaries& summaries,
                      const std::string& title) {
  using Lists = std::vector<std::vector<double>>;
  const Lists& energies = summaries.get<Lists>("smoothing", "energy_by_evaluation");
  const Lists& firsts = summaries.get<Lists>("smoothing", "first_of_frames");
  const Lists& accepted = summaries.get<Lists>("smoothing", "accepted_evaluations");
  const auto has = [](const std::vector<double>& list, std::size_t i) {
    return std::ranges::binary_search(list, static_cast<double>(i));
  };
  Diagram diagram{title, {"evaluation"}, {"energy (1: squares of the wanted size)"}, DiagramKind::kLines, {}};
  for (std::size_t patch = 0; patch < energies.size(); ++patch)
    for (std::size_t i = 0; i < energies[patch].size(); ++i) {
      if (has(firsts[patch], i)) diagram.series.emplace_back();
      const Vec2 p = {static_cast<double>(i + 1), energies[patch][i]};
      diagram.series.back().points.push_back(p);
      if (has(accepted[patch], i)) diagram.series.back().marked.push_back(p);
    }
  draw_diagram(path, diagram);
}

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

/// Those of a folder that need not be there.
void move_files(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from)) return;
  for (const auto& entry : fs::directory_iterator(from)) fs::rename(entry, to / entry.path().filename());
}

void remove_scratch(const Cell& cell) {
  std::error_code ignored;
  fs::remove_all(scratch_of(cell.folder), ignored);
}

/// Each names its case.
void say_warnings(const Case& c, const std::vector<Warning>& warnings) {
  for (const std::string& line : lines_of(warnings))
    say(fmt::format("warning: {}{}", line.starts_with(c.name) ? "" : c.folder + ": ", line));
}

}  // namespace

void say(const std::string& text) {
  // In one piece: several processes may speak at once.
  fmt::print(stderr, "{}\n", (errors_have_a_terminal() ? "\r\x1b[2K" : "") + text);
}

bool is_done(const Cell& cell) {
  const std::string state = state_of_cell(cell.folder, cell.identity.key);
  return state == "done" || state == kNotApplicable;
}

void VariantWork::prepare() {
  const DoingStage preparing("fields");
  prepared = delquad::prepare(c);
  say_warnings(c, prepared->warnings);
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
  const Peer* peer = cell.identity.peer;
  MeshResult result = c.adapt           ? mesh_cell(c, *cell.word, peer, scratch)
                      : peer != nullptr ? run_peer(*peer, c, prepared, name, scratch, cell.reference)
                                        : meshing->finish();
  if (const std::string& why = cell.identity.no_peer_version; !why.empty())
    result.warnings.push_back(name + ": its version is unknown: " + why);
  say_warnings(c, result.warnings_on_mesh());
  // What others make is shown as it is.
  if (peer == nullptr && !allow_unsound) require_sound(name, result);
  if (!result.soundness.accepted()) say(fmt::format("warning: {}: {}", name, result.soundness.complaint()));
  for (const std::string& failure : measure_by_solvers(cell.identity, c, result))
    say(fmt::format("warning: {} {}: {}", c.folder, cell.word->text, failure));
  // Before anything of the cell is in place: it may take long.
  if (peer == nullptr) fs::remove_all(scratch);
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
    for (const std::string field : {"cross.svg", "size.svg"})  // of all cells of the variant
      if (const fs::path picture = folder / c.folder / field; pictures && fs::exists(picture))
        identity.files["../" + field] = mark_of(picture);
    write_text_file(at / "record.json", run_record(c, *cell.word, result, &identity));
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
        write_text_file(at / "record.json",
                        failure_record(c, *cell.word, status, why.kind, why.reason, &identity));
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
