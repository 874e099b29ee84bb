// SPDX-License-Identifier: GPL-3.0-or-later
// X: collapses a quad if two opposite corners have three quads each; they become one point with four quads.
#include <delquad/bench.h>
#include <delquad/extend.h>

#include <algorithm>

namespace {

using namespace delquad;

double worst_eta(const QuadPatch& mesh, const std::vector<int>& quads) {
  double worst = 1;
  for (const int q : quads) {
    const auto& v = mesh.quads[q];
    const auto& p = mesh.points;
    worst = std::min(worst, quad_eta(p[v[0]], p[v[1]], p[v[2]], p[v[3]]));
  }
  return worst;
}

/// The quads around each point; -1 among them stands for triangles.
std::vector<std::vector<int>> quads_around(const QuadPatch& mesh) {
  std::vector<std::vector<int>> around(mesh.points.size());
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
    for (const int v : mesh.quads[q]) around[v].push_back(q);
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) around[v].push_back(-1);
  return around;
}

/// Closes quad q between its corners k and k + 2, if that is a gain and leaves no quad worse than
/// `least_eta`.
bool close(QuadPatch& mesh, const std::vector<std::vector<int>>& around, int q, int k, double least_eta) {
  const auto corners = mesh.quads[q];
  const int kept = corners[k], gone = corners[k + 2];
  for (int i = 0; i < 4; ++i) {
    const std::vector<int>& quads = around[corners[i]];
    if (corners[i] < mesh.n_boundary || std::ranges::find(quads, -1) != quads.end()) return false;
    const std::size_t n = quads.size();
    if (i % 2 == k ? n != 3 : n < 4) return false;
  }
  const QuadPatch before = mesh;
  mesh.points[kept] = 0.5 * (mesh.points[kept] + mesh.points[gone]);
  std::vector<int> beside = around[kept];
  for (const int other : around[gone]) {
    std::ranges::replace(mesh.quads[other], gone, kept);
    beside.push_back(other);
  }
  std::erase(beside, q);
  if (worst_eta(mesh, beside) < least_eta) {
    mesh = before;
    return false;
  }
  mesh.quads.erase(mesh.quads.begin() + q);
  mesh.points.erase(mesh.points.begin() + gone);
  for (auto& quad : mesh.quads)
    for (int& v : quad) v -= v > gone ? 1 : 0;
  for (auto& triangle : mesh.triangles)
    for (int& v : triangle) v -= v > gone ? 1 : 0;
  return true;
}

void clean_up(const StageInput& in, PatchMesh& patch, StageLog& log) {
  QuadPatch& mesh = patch.quads;
  const double least_eta = in.options.number("diamonds.least_eta");
  long long closed = 0;
  auto around = quads_around(mesh);
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
    for (const int k : {0, 1})
      if (q < static_cast<int>(mesh.quads.size()) && close(mesh, around, q, k, least_eta)) {
        ++closed;
        around = quads_around(mesh);
      }
  log.summaries.add("diamonds", {{"closed", closed}});
}

}  // namespace

int main(int argc, char** argv) {
  add_options(
      {.name = "diamonds",
       .help = "options of X",
       .keys = {{.name = "least_eta", .help = "of the quads around", .value = 0.3, .least = 0, .most = 1}}});
  add_stage({'X', "closing of diamonds", PatchForm::kQuads, PatchForm::kQuads, clean_up});
  return run_program(argc, argv);
}
