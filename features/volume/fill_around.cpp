// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_around.h"

#include <algorithm>

#include "base/cancel.h"
#include "features/volume/body_parts.h"
#include "features/volume/fill_void.h"
#include "geometry/mesh/cell_shapes.h"

namespace delquad {

namespace {

/// Returns the cells with one of these faces, or else those that share a vertex with one.
std::vector<int> cells_at(const Mesh& body, const std::vector<OpenFace>& faces,
                          const std::vector<int>& lost) {
  std::vector<int> owners;
  std::vector<char> at(body.points.size(), 0);
  for (const int f : lost) {
    if (faces[f].owner < 0) owners.push_back(-1 - faces[f].owner);
    for (const int v : faces[f].corners()) at[v] = 1;
  }
  for (std::size_t i = 0, n = owners.empty() ? n_solids(body) : 0; i < n; ++i)
    if (std::ranges::any_of(solid_at(body, i).nodes, [&](int v) { return at[v]; }))
      owners.push_back(static_cast<int>(i));
  return owners;
}

}  // namespace

std::vector<int> fill_around(Mesh& body, bool improve) {
  drop_cells(body, {});
  for (;;) {
    check_cancelled();
    const std::vector<OpenFace> faces = open_faces(body);
    if (faces.empty()) return {};
    Filling filling = fill_void(boundary_of(body, faces), improve);
    if (filling.lost.empty()) {
      body.points = filling.points;
      body.hexahedra.clear(), body.hex_volume.clear(), body.prisms.clear(), body.prism_volume.clear();
      for (const Cell& cell : filling.cells) add_cell(body, nodes_of(cell), 0);
      return {};
    }
    const std::vector<int> cells = cells_at(body, faces, filling.lost);
    drop_cells(body, cells);
    if (!cells.empty()) continue;
    for (int& f : filling.lost) f = faces[f].owner;
    return filling.lost;
  }
}

}  // namespace delquad
