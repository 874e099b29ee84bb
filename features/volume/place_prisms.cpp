// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "geometry/mesh/cell_shapes.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

using Prism = std::array<int, 6>;

constexpr double kLeastOfPrisms = 0.2;

std::array<Quad, 3> quads_of(const Prism& p) {
  return {{{p[0], p[1], p[4], p[3]}, {p[1], p[2], p[5], p[4]}, {p[2], p[0], p[3], p[5]}}};
}

}  // namespace

void place_prisms(Mesh& volume) {
  std::map<Quad, Quad> open;                                             // by nodes
  std::map<std::array<int, 2>, std::vector<std::array<int, 2>>> beyond;  // of directed sides
  for (const Quad& quad : open_faces(volume).quads) {
    open.emplace(side_key(quad), quad);
    for (int k = 0; k < 4; ++k)
      beyond[{quad[k], quad[(k + 1) % 4]}].push_back({quad[(k + 2) % 4], quad[(k + 3) % 4]});
  }
  std::vector<std::pair<double, Prism>> found;
  for (const auto& [key, quad] : open)
    for (const int k : {0, 1}) {
      const int a = quad[k], b = quad[k + 1], e = quad[k + 2], d = quad[(k + 3) % 4];
      for (const auto& [c, f] : beyond[{e, b}]) {
        const Prism prism = {a, b, c, d, e, f};
        const auto sides = quads_of(prism);
        const auto third = open.find(side_key(sides[2]));
        if (third == open.end() || !same_turn(third->second, sides[2]) || key > side_key(sides[1]) ||
            key > third->first)
          continue;
        const auto corners = corners_of(volume.points, prism);
        if (const double jacobian = scaled_jacobian(corners);
            jacobian >= kLeastOfPrisms && is_positive(corners))
          found.emplace_back(-jacobian, prism);
      }
    }
  std::ranges::sort(found);
  for (const auto& [worst, prism] : found) {
    const auto sides = quads_of(prism);
    if (!std::ranges::all_of(sides, [&](const Quad& s) { return open.contains(side_key(s)); })) continue;
    for (const Quad& side : sides) open.erase(side_key(side));
    add_cell(volume, prism, 0);
  }
  for (bool changed = true; changed;) {
    VoidFaces faces = open_faces(volume);
    std::vector<int> crossing;
    for (const int f : untangle(volume.points, faces.quads, faces.triangles))
      if (faces.nodes(f).size() == 3) crossing.push_back(-1 - faces.owners[f]);
    changed = !crossing.empty();
    drop_cells(volume, crossing);
  }
}

}  // namespace delquad
