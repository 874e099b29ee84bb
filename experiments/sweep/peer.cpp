// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "base/activity.h"
#include "base/calibration.h"
#include "base/located.h"
#include "base/system.h"
#include "delquad/domain.h"
#include "experiments/sweep/adapt_loop.h"
#include "experiments/sweep/process_tree.h"
#include "experiments/sweep/run_program.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/half_edges.h"
#include "io/mesh_io.h"
#include "metrics/shape.h"
#include "metrics/surface/surface_report.h"
#include "metrics/tables/result_records.h"

namespace delquad {

namespace {

/// The record of the cell, if it is of the same case, options and program.
std::optional<nlohmann::json> valid_record(const ReferenceCell& cell) {
  if (cell.folder.empty()) return std::nullopt;
  std::ifstream in(cell.folder / "record.json");
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || json.value("key", "") != cell.key) return std::nullopt;
  return json;
}

/// Found in a process of its own: whatever becomes of that, it is not the peer that failed.
std::optional<double> quads_of_pipeline(const Prepared& prepared, const std::string& word) {
  const StageScope counting("our pipeline that the peer is calibrated to");
  const TemporaryFolder scratch;
  const std::filesystem::path file = scratch.path() / "quads";
  std::optional<ProcessFailure> failure;
  std::optional<Job> job(std::in_place);
  job->work = [&] { std::ofstream(file) << fmt::format("{}", count_of_quads(mesh(prepared, word).mesh)); };
  job->failed = [&](const ProcessFailure& why) { failure = why; };
  run_jobs([&] { return std::exchange(job, std::nullopt); }, {});
  if (failure && failure->kind == "bad input") return std::nullopt;
  if (failure)
    throw JobFailed(
        {failure->kind, fmt::format("our pipeline {}, whose number of quads it was to have, failed: {}; "
                                    "the peer was not run",
                                    word, failure->reason)});
  double quads = 0;
  if (!(std::ifstream(file) >> quads)) throw InputError(file.string() + ": cannot be written");
  return quads;
}

}  // namespace

std::optional<double> reference_quads(const Prepared& prepared, const std::string& word,
                                      const ReferenceCell& cell) {
  if (const auto record = valid_record(cell)) {
    if (record->value("status", "") != "ok") return std::nullopt;
    const nlohmann::json& metrics = record->at("metrics");
    return metrics.at("n_quads").get<double>() + 0.5 * metrics.at("n_triangles").get<double>();
  }
  return quads_of_pipeline(prepared, word);
}

Prepared prepare_scaled(const Prepared& prepared, double scale) {
  MeshProblem problem = prepared.problem();
  problem.quads.reset();
  problem.refine = 1 / scale;
  return prepare(std::move(problem));
}

namespace {

namespace fs = std::filesystem;

constexpr unsigned kVersionSeconds = 30;  // after which a program that only tells its version hangs
/// With which a program ends that cannot be told the case, the reason in its last line.
constexpr int kNotApplicableExit = 77;
constexpr CalibrationLimits kCalibration = {.tolerance = kEquallyMany, .most_runs = 8};
constexpr const char* kKept = "kept";  // folder of the closest run so far, beside the folder of the last run

/// `good`: exit codes.
void check_run(const std::string& program, const ProgramRun& run, const std::vector<int>& good,
               const fs::path& log) {
  const std::string end = how_it_ended(run, good);
  if (!end.empty()) throw PeerError(program + ": " + end + (run.error == 0 ? complaint(log) : ""));
}

/// By `part` of each element's area vector.
template <class Part>
double sum_areas(const Mesh& mesh, Part part) {
  double sum = 0;
  for_each_element(mesh, [&](int, const auto& v) { sum += part(0.5 * area_vector(corners_of(mesh, v))); });
  return sum;
}

double area_in_space(const Mesh& mesh) {
  return sum_areas(mesh, [](const Vec3& a) { return norm(a); });
}

double area_in_plane(const Mesh& mesh) {
  return sum_areas(mesh, [](const Vec3& a) { return a.z; });
}

/// For each of `points` the index of the first of `mesh` within `tolerance`, -1: none.
std::vector<int> find_points(const std::vector<Vec3>& points, const Mesh& mesh, double tolerance) {
  std::vector<int> order(mesh.points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto x_of = [&](int i) { return mesh.points[i].x; };
  std::ranges::stable_sort(order, {}, x_of);
  std::vector<int> found;
  for (const Vec3& p : points) {
    int index = -1;
    for (auto at = std::ranges::lower_bound(order, p.x - tolerance, {}, x_of);
         at != order.end() && x_of(*at) <= p.x + tolerance && index < 0; ++at)
      if (norm(mesh.points[*at] - p) <= tolerance) index = *at;
    found.push_back(index);
  }
  return found;
}

/// How many edges of the boundary are no edges of the mesh.
int missing_edges(const Mesh& boundary, const Mesh& mesh) {
  constexpr double kTolerance = 1e-9;  // diagonals: text with ten digits
  const std::vector<int> node = find_points(boundary.points, mesh, kTolerance * diagonal(boundary));
  std::vector<std::array<int, 2>> edges;
  for (const HalfEdge& side : sorted_half_edges(mesh)) edges.push_back({side.lo, side.hi});
  int missing = 0;
  for (const auto& [a, b] : boundary.lines)
    missing += !std::ranges::binary_search(
        edges, std::array{std::min(node[a], node[b]), std::max(node[a], node[b])});
  return missing;
}

/// Whether its planar meshes must have our boundary edges: Gmsh divides curves itself.
bool has_given_edges(const Peer& peer, const Prepared& prepared) {
  return peer.keeps_boundary && (peer.input != kGmshScript || domain_curves(prepared).empty());
}

void check_planar(const Peer& peer, const Prepared& prepared, Mesh& mesh) {
  for (Vec3& p : mesh.points) p.z = prepared->boundary.points[0].z;
  if (area_in_plane(mesh) < 0) {
    for (auto& v : mesh.triangles) std::ranges::reverse(v);
    for (auto& v : mesh.quads) std::ranges::reverse(v);
  }
  const Mesh boundary = boundary_of(prepared);
  double area = 0;
  for (std::size_t i = 0; i < prepared.n_patches(); ++i) {
    const std::vector<int>& node = prepared.patch(i).point_node;
    for (const auto& [a, b] : prepared.patch(i).edges)
      area += 0.5 * cross(boundary.points[node[a]], boundary.points[node[b]]).z;
  }
  const bool keeps = has_given_edges(peer, prepared);
  const double tolerance = keeps ? 1e-6 : 0.02;  // chords of another boundary
  const double covered = area_in_plane(mesh) / area;
  if (!(std::abs(covered - 1) <= tolerance))
    refuse<PeerError>("its mesh covers {:.6g} % of the domain's area", 100 * covered);
  if (const int missing = keeps ? missing_edges(boundary, mesh) : 0; missing > 0)
    refuse<PeerError>("{} of {} boundary edges are not in its mesh", missing, boundary.lines.size());
}

void check_surface(const Prepared& prepared, const Mesh& mesh) {
  constexpr double kCovered = 0.1;  // chords of curved faces take some of the area
  const Mesh& model = prepared.fine();
  const double covered = area_in_space(mesh) / area_in_space(model);
  if (!(std::abs(covered - 1) <= kCovered))
    refuse<PeerError>("its mesh covers {:.4g} % of the model's area", 100 * covered);
  const int free_edges = topology_of(mesh).free_edges;
  if (free_edges > 0 && topology_of(model).watertight())
    refuse<PeerError>("its mesh has {} open edges, the model none", free_edges);
}

/// Its size where that is uniform; for a peer that has a field besides, the largest.
double size_argument(const PeerTask& task) {
  if (const auto size = uniform_size(task.c)) return task.scale * *size;
  if (task.peer.size_field.empty() || followed_metric(task.prepared))
    throw NotApplicable("'" + task.peer.name + "' takes one size, and the size varies here");
  return std::ranges::max(sample_sizes(task).delta);
}

/// A case is not applicable if the program is not there to tell its version.
std::string version_of_peer(const Peer& peer) {
  try {
    return peer_version(peer);
  } catch (const PeerError& error) {
    throw NotApplicable(error.what());
  }
}

/// The result of a program for a task.
struct PeerRun {
  Mesh mesh;
  ProgramRun program;
};

void check_end(const Peer& peer, const std::string& program, const ProgramRun& run, const fs::path& log) {
  if (run.error == ENOENT) throw NotApplicable(program + " is not installed");
  const auto is_good = [&](int code) {
    return std::ranges::find(peer.exit_codes, code) != peer.exit_codes.end();
  };
  if (run.error == 0 && run.exit_code() == kNotApplicableExit && !is_good(kNotApplicableExit)) {
    const std::vector<std::string> said = lines_printed(log);
    throw NotApplicable(said.empty() ? "" : said.back());
  }
  check_run(program, run, peer.exit_codes, log);
}

/// In `folder`, which is empty.
PeerRun run_once(const PeerTask& task, const fs::path& folder) {
  const Peer& peer = task.peer;
  if (task.prepared.problem().metric.asks() && !(peer.metrics && followed_metric(task.prepared)))
    throw NotApplicable("'" + peer.name + "' is told sizes, and the case has a metric");
  const fs::path log = folder / "peer.log", input = write_peer_input(task, folder);
  const fs::path field =
      peer.size_field.empty() ? fs::path() : write_size_field(sample_sizes(task), peer.size_field, folder);
  const std::string output = "output." + peer.output;
  const auto words = peer_command(task, input, output, field);
  const StageScope meshing("the peer");
  PeerRun result;
  result.program = run_program(words, folder, log);
  check_end(peer, words[0], result.program, log);
  if (!fs::exists(folder / output)) throw PeerError(words[0] + ": wrote no mesh" + complaint(log));
  try {
    result.mesh = read_mesh(folder / output);
    require_straight(result.mesh, output);
    check_peer_mesh(peer, task.prepared, result.mesh);
  } catch (const InputError& error) {
    std::string reason = error.what();
    reason = replace_all(reason, folder.string() + "/", "");
    throw PeerError("its mesh cannot be read: " + reason);
  }
  fs::remove(folder / output);
  return result;
}

/// At another scale of its sizes. The boundary of a planar model is made anew at it: our own edges would ask
/// for our own size. Lines that are given, and surfaces, stay.
PeerRun run_scaled(const Peer& peer, const Case& c, const Prepared& prepared, double scale,
                   const fs::path& folder) {
  if (planar_model(c) == nullptr || scale == 1) return run_once({peer, c, prepared, scale, scale}, folder);
  return run_once({peer, c, prepare_scaled(prepared, scale), scale, 1}, folder);
}

/// Everything in the folder but what is kept.
void move_all_but_kept(const fs::path& from, const fs::path& to) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(from))
    if (entry.path().filename() != kKept) files.push_back(entry.path());
  for (const fs::path& file : files) fs::rename(file, to / file.filename());
}

void remove_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != kKept) files.push_back(entry.path());
  for (const fs::path& file : files) fs::remove_all(file);
}

/// The runs of a calibration, of which the closest is kept, with its files.
class Calibrated {
 public:
  Calibrated(const Peer& peer, const Case& c, const Prepared& prepared, const fs::path& folder, double wanted)
      : peer_(peer), c_(c), prepared_(prepared), folder_(folder), wanted_(wanted) {}

  PeerRun run() {
    done = calibrate_scale(wanted_, kCalibration, [&](double scale) { return quads_at(scale); });
    if (fs::exists(folder_ / kKept)) {
      remove_files(folder_);
      move_all_but_kept(folder_ / kKept, folder_);
      fs::remove(folder_ / kKept);
    }
    return std::move(*best_);
  }

  Calibration done = {};
  std::string failure = {};  ///< of the last run; empty: none

 private:
  std::optional<double> quads_at(double scale) {
    try {
      PeerRun run = run_scaled(peer_, c_, prepared_, scale, folder_);
      const double quads = count_of_quads(run.mesh), off = std::abs(std::log(quads / wanted_));
      if (best_ && !(off < off_)) return remove_files(folder_), quads;
      fs::remove_all(folder_ / kKept);
      fs::create_directory(folder_ / kKept);
      move_all_but_kept(folder_, folder_ / kKept);
      best_ = std::move(run);
      off_ = off;
      return quads;
    } catch (const PeerError& error) {
      if (!best_) throw;
      failure = error.what();
    } catch (const InputError& error) {  // there is no boundary of that size
      if (!best_) throw;
      failure = error.what();
    }
    return std::nullopt;
  }

  const Peer& peer_;
  const Case& c_;
  const Prepared& prepared_;
  const fs::path& folder_;
  double wanted_;
  std::optional<PeerRun> best_;
  double off_ = 0;
};

/// As close as it gets to the reference's number of quads; `log` receives how close.
PeerRun run_calibrated(const Peer& peer, const Case& c, const Prepared& prepared, const fs::path& folder,
                       const ReferenceCell& reference, StageLog& log) {
  const auto wanted = reference_quads(prepared, peer.calibrate_to, reference);
  if (!wanted || !(*wanted > 0)) {
    PeerRun run = run_once({peer, c, prepared}, folder);
    log.summaries.add(kCalibrationStep, {{"to", peer.calibrate_to}, {"size_factor", 1.0}, {"runs", 1LL}});
    return run;
  }
  Calibrated runs(peer, c, prepared, folder, *wanted);
  PeerRun run = runs.run();
  log.summaries.add(kCalibrationStep, {{"to", peer.calibrate_to},
                                       {"wanted_quads", *wanted},
                                       {"quads", runs.done.quads},
                                       {"size_factor", runs.done.scale},
                                       {"runs", static_cast<long long>(runs.done.runs)},
                                       {"tried", runs.done.tried}});
  if (!runs.failure.empty()) log.summaries.add(kCalibrationStep, {{"ended_by", runs.failure}});
  return run;
}

}  // namespace

std::vector<std::string> peer_command(const PeerTask& task, const fs::path& input, const std::string& output,
                                      const fs::path& size_field) {
  const Peer& peer = task.peer;
  const double factor = task.field_scale * task.field_scale;
  return filled_in(
      peer.folder, command_of_case(peer, task.c.name),
      {{"{size}", [&] { return fmt::format("{}", size_argument(task)); }},
       {"{quads}", [&] { return fmt::format("{:.0f}", task.prepared->size.expected_quads / factor); }},
       {"{size_field}", [&] { return size_field.string(); }},
       {"{input}", [&] { return input.string(); }},
       {"{output}", [&] { return output; }},
       {"{seed}", [&] { return std::to_string(task.c.seed); }},
       {"{version}", [&] { return version_of_peer(peer); }},
       {"{data}", [&] { return fs::absolute(task.c.data_folder).lexically_normal().string(); }}});
}

std::vector<std::string> command_of_case(const Peer& peer, const std::string& name) {
  std::vector<std::string> words = peer.command;
  for (std::string& word : words) word = replace_all(word, "{case}", name);
  return words;
}

const std::vector<std::string>& peer_placeholders() {
  static const std::vector<std::string> all = {"{input}", "{output}", "{size}", "{size_field}", "{quads}",
                                               "{seed}",  "{case}",   "{data}", "{version}"};
  return all;
}

std::string peer_version(const Peer& peer) {
  static std::map<std::pair<fs::path, std::vector<std::string>>, std::string> known;
  std::string& version = known[{peer.folder, peer.version}];
  if (!version.empty()) return version;
  const TemporaryFolder scratch;
  const fs::path log = scratch.path() / "version";
  const auto words = filled_in(peer.folder, peer.version, {});
  check_run(words[0], run_program(words, scratch.path(), log, kVersionSeconds), {0}, log);
  const std::vector<std::string> said = lines_printed(log);
  if (!said.empty()) return version = said[0];
  refuse<PeerError>("{}: prints no version", fmt::join(words, " "));
}

void check_peer_mesh(const Peer& peer, const Prepared& prepared, Mesh& mesh) {
  if (mesh.triangles.empty() && mesh.quads.empty()) throw PeerError("its mesh has no triangles and no quads");
  for (const Vec3& p : mesh.points)
    if (!std::isfinite(p.x + p.y + p.z)) throw PeerError("its mesh has a point that is not finite");
  // On surfaces faces may be turned against each other, and any number of them meet in a curve.
  const std::vector<char> branching(prepared.is_surface() ? mesh.curves.size() : 0, 1);
  const std::vector<std::string> violations = check_invariants(mesh, branching);
  if (!violations.empty())
    refuse<PeerError>("its mesh is not sound ({} violations): {}", violations.size(), violations[0]);
  prepared.is_surface() ? check_surface(prepared, mesh) : check_planar(peer, prepared, mesh);
  if (prepared.is_surface() || !has_given_edges(peer, prepared)) check_place(prepared, mesh);
}

MeshResult run_peer(const Peer& peer, const Case& c, const Prepared& prepared, const std::string& label,
                    const fs::path& scratch, const ReferenceCell& reference) {
  fs::remove_all(scratch);
  fs::create_directories(scratch);
  const fs::path folder = fs::absolute(scratch);
  StageLog log;
  PeerRun run = peer.calibrate_to.empty() ? run_once({peer, c, prepared}, folder)
                                          : run_calibrated(peer, c, prepared, folder, reference, log);
  MeshResult result = prepared.measure(std::move(run.mesh));
  result.log = std::move(log);
  result.warnings = prepared->warnings;
  if (const int code = run.program.exit_code(); code != 0)
    result.warnings.push_back(
        fmt::format("{}: ended with exit code {}{}", label, code, complaint(folder / "peer.log")));
  result.log.add_seconds("peer", run.program.cpu_seconds);
  result.seconds = run.program.seconds;
  result.peak_memory = run.program.peak_memory;
  return result;
}

MeshResult mesh_cell(const Case& c, const Pipeline& word, const Peer* peer, const fs::path& scratch) {
  return mesh_in_loop(c, [&](const Case& task) {
    const Prepared prepared = prepare(task);
    if (peer == nullptr) return mesh(prepared, word.text);
    Peer alone = *peer;
    if (c.adapt) alone.calibrate_to.clear();
    return run_peer(alone, task, prepared, c.name + " " + word.text, scratch);
  });
}

}  // namespace delquad
