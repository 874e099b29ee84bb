// SPDX-License-Identifier: GPL-3.0-or-later
// Y: moves inner points half of the way to the mean of their neighbors, patch by patch, if the worst quad in
// space gets better.
#include <delquad/bench.h>
#include <delquad/extend.h>

namespace {

using namespace delquad;

/// Sum of the squared sides of all quads of a patch, in space. Boundary points stand for nodes.
double squares(const AllPatches& all, std::size_t patch) {
  const PatchMesh& mesh = all.patches[patch];
  const PatchBoundary& boundary = input_of(all, patch).boundary;
  const auto place = [&](int v) {
    return v < mesh.quads.n_boundary ? node_places(all)[boundary.point_node[v]]
                                     : mesh.inside[v - mesh.quads.n_boundary];
  };
  double sum = 0;
  for (const auto& v : mesh.quads.quads) {
    const Vec3 x[] = {place(v[0]), place(v[1]), place(v[2]), place(v[3])};
    for (int k = 0; k < 4; ++k) sum += dot(x[k] - x[(k + 1) % 4], x[k] - x[(k + 1) % 4]);
  }
  return sum;
}

void relax(QuadPatch& mesh) {
  std::vector<Vec2> sum(mesh.points.size());
  std::vector<int> count(mesh.points.size());
  for (const auto& quad : mesh.quads)
    for (int k = 0; k < 4; ++k)
      for (const int other : {quad[(k + 1) % 4], quad[(k + 3) % 4]}) {
        sum[quad[k]] += mesh.points[other];
        ++count[quad[k]];
      }
  for (std::size_t v = mesh.n_boundary; v < mesh.points.size(); ++v)
    if (count[v] > 0) mesh.points[v] = 0.5 * mesh.points[v] + (0.5 / count[v]) * sum[v];
}

void relax_all(const AllPatches& all, StageLog& log) {
  place_inside(all);
  long long relaxed = 0;
  for (std::size_t i = 0; i < all.patches.size(); ++i) {
    if (all.left_out[i]) continue;
    const PatchMesh before = all.patches[i];
    const double before_it = squares(all, i);
    relax(all.patches[i].quads);
    all.patches[i].inside.clear();
    place_inside(all);
    if (squares(all, i) > before_it)
      all.patches[i] = before;
    else
      ++relaxed;
  }
  log.summaries.add("relaxation", {{"patches", relaxed}});
}

}  // namespace

int main(int argc, char** argv) {
  add_stage({'Y', "relaxation in space", PatchForm::kQuads, PatchForm::kQuads,
             [](const StageInput&, PatchMesh&, StageLog&) {}, relax_all});
  return run_program(argc, argv);
}
