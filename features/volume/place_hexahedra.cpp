// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/place_hexahedra.h"

#include <algorithm>

#include "features/volume/frame_field.h"
#include "features/volume/lattice_points.h"
#include "features/volume/select_cells.h"
#include "features/volume/skin.h"

namespace delquad {

void place_hexahedra(Mesh& volume) {
  const Skin skin(volume.points, volume.quads);
  const FrameField field(volume.points, volume.quads, skin);
  const Lattice lattice = fill_with_points(volume.points, volume.quads, skin, field);
  auto candidates = find_hexahedra(lattice.points, lattice.best, volume.quads, skin);
  auto hexahedra = select_hexahedra(lattice.points, volume.quads, candidates);
  const auto is_enclosed = enclosed_points(lattice.points.size(), volume.quads, hexahedra);
  auto beside = lattice.beside;
  for (std::size_t v = 0; v < beside.size(); ++v)
    if (is_enclosed[v])
      beside[v].clear();
    else
      std::erase_if(beside[v], [&](int w) { return is_enclosed[w]; });
  const auto more = find_hexahedra(lattice.points, beside, volume.quads, skin);
  candidates = hexahedra;
  candidates.insert(candidates.end(), more.begin(), more.end());
  std::ranges::sort(candidates);
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  hexahedra = select_hexahedra(lattice.points, volume.quads, candidates);
  separate_sides(lattice.points, volume.quads, hexahedra);

  std::vector<int> index(lattice.points.size(), -1);
  for (std::size_t v = 0; v < volume.points.size(); ++v) index[v] = static_cast<int>(v);
  for (Hexahedron hex : hexahedra) {
    for (int& v : hex) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(volume.points.size());
        volume.points.push_back(lattice.points[v]);
      }
      v = index[v];
    }
    volume.hexahedra.push_back(hex);
    volume.hex_volume.push_back(0);
  }
}

}  // namespace delquad
