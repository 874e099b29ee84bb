#include "geometry/surface/tidy_model.h"

#include <algorithm>

#include "mesh/drop_unused_points.h"

namespace delquad {

namespace {

/// Renumbers `of`, and takes out the entities that it does not name. Returns the former number of each.
EntityGroups keep_used(std::vector<Entity>& entities, std::vector<int>& of) {
  std::vector<int> number(entities.size(), -1);
  for (const int e : of) number[e] = 0;
  EntityGroups former;
  for (std::size_t e = 0; e < number.size(); ++e) {
    if (number[e] < 0) continue;
    number[e] = static_cast<int>(former.size());
    entities[former.size()] = entities[e];
    former.push_back({static_cast<int>(e)});
  }
  entities.resize(former.size());
  for (int& e : of) e = number[e];
  return former;
}

}  // namespace

TidyGroups tidy_model(SurfaceModel& model) {
  Mesh& mesh = model.fine;
  std::vector<char> used(mesh.points.size(), 0), on_line(mesh.points.size(), 0);
  for (const auto& line : mesh.lines)
    for (const int v : line) used[v] = on_line[v] = 1;
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) used[v] = 1;
  std::vector<int> number(used.size());
  for (std::size_t p = 0, n = 0; p < used.size(); ++p) number[p] = used[p] ? static_cast<int>(n++) : -1;
  std::erase_if(model.corners, [&](int p) { return !on_line[p]; });
  for (int& p : model.corners) p = number[p];
  drop_unused_points(mesh);
  return {keep_used(mesh.regions, mesh.triangle_region), keep_used(mesh.curves, mesh.line_curve)};
}

}  // namespace delquad
