#include "sweep/peer.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <numeric>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "mesh/check_invariants.h"
#include "mesh/half_edges.h"
#include "metrics/surface/surface_report.h"
#include "sweep/command_files.h"
#include "sweep/run_program.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kVersionSeconds = 30;   // after which a program that only tells its version hangs
constexpr std::size_t kLongestLine = 200;  // of a program's output, in a message

/// What a program said went wrong: its first line with "error" in it, else its last.
std::string complaint(const fs::path& log) {
  std::ifstream in(log);
  std::string line, last;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    last = line.substr(0, kLongestLine);
    if (last.find("rror") != std::string::npos) break;
  }
  return last.empty() ? "" : ": " + last;
}

/// `good`: exit codes.
void check_run(const std::string& program, const ProgramRun& run, const std::vector<int>& good,
               const fs::path& log) {
  const std::string end = how_it_ended(run, good);
  if (!end.empty()) throw PeerError(program + ": " + end + (run.error == 0 ? complaint(log) : ""));
}

/// A program with a slash in it counts from the peer's folder, and so do files that lie there.
std::vector<std::string> located_command(const Peer& peer, std::vector<std::string> words) {
  if (words[0].find('/') != std::string::npos)
    words[0] = fs::absolute(peer.folder / words[0]).lexically_normal().string();
  for (std::size_t i = 1; i < words.size(); ++i)
    if (const fs::path file = file_of_word(peer.folder, words, i); !file.empty()) words[i] = file.string();
  return words;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

std::vector<std::string> fill_in(const Peer& peer, const Case& c, const fs::path& input,
                                 const std::string& output) {
  std::vector<std::string> words = located_command(peer, peer.command);
  for (std::string& word : words) {
    if (word.find("{size}") != std::string::npos) {
      const auto size = uniform_size(c);
      if (!size) throw PeerError("'" + peer.name + "' is told one number for the size, which varies here");
      replace_all(word, "{size}", fmt::format("{}", *size));
    }
    replace_all(word, "{input}", input.string());
    replace_all(word, "{output}", output);
    replace_all(word, "{seed}", std::to_string(c.seed));
  }
  return words;
}

Vec3 area_vector(const Mesh& mesh, std::span<const int> v) {
  Vec3 twice{0, 0, 0};
  for (std::size_t k = 1; k + 1 < v.size(); ++k)
    twice = twice + cross(mesh.points[v[k]] - mesh.points[v[0]], mesh.points[v[k + 1]] - mesh.points[v[0]]);
  return 0.5 * twice;
}

/// By `part` of each element's area vector.
template <class Part>
double sum_areas(const Mesh& mesh, Part part) {
  double sum = 0;
  for_each_element(mesh, [&](int, const auto& v) { sum += part(area_vector(mesh, v)); });
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

void check_planar(const Peer& peer, const PreparedProblem& prepared, Mesh& mesh) {
  for (Vec3& p : mesh.points) p.z = prepared.boundary.points[0].z;
  if (area_in_plane(mesh) < 0) {
    for (auto& v : mesh.triangles) std::ranges::reverse(v);
    for (auto& v : mesh.quads) std::ranges::reverse(v);
  }
  double area = 0;
  for (const PreparedPatch& patch : prepared.patches)
    for (const auto& [a, b] : patch.boundary.edges)
      area += 0.5 * cross(patch.boundary.points[a], patch.boundary.points[b]);
  const double tolerance = peer.keeps_boundary ? 1e-6 : 0.02;  // chords of another boundary
  const double covered = area_in_plane(mesh) / area;
  if (!(std::abs(covered - 1) <= tolerance))
    throw PeerError(fmt::format("its mesh covers {:.6g} % of the domain's area", 100 * covered));
  if (const int missing = peer.keeps_boundary ? missing_edges(prepared.boundary, mesh) : 0; missing > 0)
    throw PeerError(
        fmt::format("{} of {} boundary edges are not in its mesh", missing, prepared.boundary.lines.size()));
}

void check_surface(const PreparedProblem& prepared, const Mesh& mesh) {
  constexpr double kCovered = 0.1;  // chords of curved faces take some of the area
  const Mesh& model = prepared.surface->model.fine;
  const double covered = area_in_space(mesh) / area_in_space(model);
  if (!(std::abs(covered - 1) <= kCovered))
    throw PeerError(fmt::format("its mesh covers {:.4g} % of the model's area", 100 * covered));
  const int free_edges = topology_of(mesh).free_edges;
  if (free_edges > 0 && topology_of(model).watertight())
    throw PeerError(fmt::format("its mesh has {} open edges, the model none", free_edges));
}

}  // namespace

std::string peer_version(const Peer& peer) {
  std::string pattern = (fs::temp_directory_path() / "delquad-XXXXXX").string();
  const int file = mkstemp(pattern.data());
  if (file < 0) throw PeerError(fs::temp_directory_path().string() + ": cannot be written to");
  close(file);
  const fs::path log = pattern;
  const auto words = located_command(peer, peer.version);
  try {
    check_run(words[0], run_program(words, fs::temp_directory_path(), log, kVersionSeconds), {0}, log);
    std::ifstream in(log);
    std::string line;
    std::getline(in, line);
    if (line.empty()) throw PeerError(fmt::format("{}: prints no version", fmt::join(words, " ")));
    fs::remove(log);
    return line;
  } catch (...) {
    fs::remove(log);
    throw;
  }
}

void check_peer_mesh(const Peer& peer, const PreparedProblem& prepared, Mesh& mesh) {
  if (mesh.triangles.empty() && mesh.quads.empty()) throw PeerError("its mesh has no triangles and no quads");
  for (const Vec3& p : mesh.points)
    if (!std::isfinite(p.x + p.y + p.z)) throw PeerError("its mesh has a point that is not finite");
  // On surfaces faces may be turned against each other, and any number of them meet in a curve.
  const std::vector<char> branching(prepared.surface ? mesh.curves.size() : 0, 1);
  const std::vector<std::string> violations = check_invariants(mesh, branching);
  if (!violations.empty())
    throw PeerError(
        fmt::format("its mesh is not sound ({} violations): {}", violations.size(), violations[0]));
  prepared.surface ? check_surface(prepared, mesh) : check_planar(peer, prepared, mesh);
}

RunResult run_peer(const Peer& peer, const Case& c, const PreparedProblem& prepared, const std::string& label,
                   const fs::path& scratch) {
  fs::remove_all(scratch);
  fs::create_directories(scratch);
  const fs::path folder = fs::absolute(scratch), log = folder / "peer.log";
  const std::string output = "output" + peer.output;
  const auto words = fill_in(peer, c, write_peer_input(peer, c, prepared, folder), output);
  const ProgramRun run = run_program(words, folder, log);
  check_run(words[0], run, peer.exit_codes, log);
  if (!fs::exists(folder / output)) throw PeerError(words[0] + ": wrote no mesh" + complaint(log));
  RunResult result;
  try {
    result.mesh = read_mesh(folder / output);
    check_peer_mesh(peer, prepared, result.mesh);
  } catch (const InputError& error) {
    std::string reason = error.what();
    replace_all(reason, folder.string() + "/", "");
    throw PeerError("its mesh cannot be read: " + reason);
  }
  fs::remove(folder / output);
  if (WEXITSTATUS(run.status) != 0)
    result.warnings.push_back(
        fmt::format("{}: ended with exit code {}{}", label, WEXITSTATUS(run.status), complaint(log)));
  result.log.add_seconds("peer", run.cpu_seconds);
  result.seconds = run.seconds;
  result.peak_memory = run.peak_memory;
  result.metrics =
      evaluate_metrics(result.mesh, prepared.size.get(), prepared.given_size.get(), prepared.options);
  result.soundness = check_elements(prepared, result.mesh);
  const std::vector<double> etas = quad_etas(result.mesh);
  result.bad_elsewhere =
      static_cast<int>(std::ranges::count_if(etas, [](double eta) { return eta < kBadEta; }));
  return result;
}

}  // namespace delquad
