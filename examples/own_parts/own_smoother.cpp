// SPDX-License-Identifier: GPL-3.0-or-later
// S: moves every inner point part of the way to the mean of its neighbors, as long as no triangle gets flat.
#include <delquad/bench.h>
#include <delquad/extend.h>

namespace {

using namespace delquad;

double twice_area(const std::vector<Vec2>& points, const std::array<int, 3>& t) {
  return cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

void smooth(const StageInput& in, PatchMesh& patch, StageLog& log) {
  TriPatch& mesh = patch.triangles;
  const double weight = in.options.number("laplace.weight");
  const int n = static_cast<int>(mesh.points.size());
  std::vector<std::vector<int>> around(mesh.points.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (const int v : mesh.triangles[t]) around[v].push_back(t);

  long long moved = 0, refused = 0;
  double furthest = 0;  // in sizes
  for (long long step = 0; step < in.options.integer("laplace.steps"); ++step)
    for (int v = mesh.n_boundary; v < n; ++v) {
      Vec2 sum{};
      for (const int t : around[v])
        for (const int w : mesh.triangles[t])
          if (w != v) sum += mesh.points[w];  // each neighbor twice
      const Vec2 before = mesh.points[v];
      const Vec2 mean = (0.5 / static_cast<double>(around[v].size())) * sum;
      mesh.points[v] = before + weight * (mean - before);
      bool good = true;
      for (const int t : around[v]) good = good && twice_area(mesh.points, mesh.triangles[t]) > 0;
      if (!good) mesh.points[v] = before;
      ++(good ? moved : refused);
      int hint = -1;
      furthest = std::max(furthest, norm(mesh.points[v] - before) / in.size.at(before, hint));
    }
  log.summaries.add("laplace", {{"moved", moved}, {"refused", refused}, {"furthest", furthest, Over::kMost}});
}

}  // namespace

int main(int argc, char** argv) {
  add_options({.name = "laplace",
               .help = "options of S",
               .keys = {{.name = "steps", .help = "how often", .value = 5, .least = 0, .most = 1000},
                        {.name = "weight", .help = "part of the way", .value = 0.5, .above = 0, .most = 1}}});
  add_stage({'S', "Laplacian smoothing", PatchForm::kTriangles, PatchForm::kTriangles, smooth});
  return run_program(argc, argv);
}
