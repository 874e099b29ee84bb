// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <set>
#include <string>
#include <vector>

#include "delquad/hexahedra.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

LayerSpec layers_beside(const LayerSpec& layers, const Mesh& skin) {
  constexpr double kMostFan = 120;  // degrees
  std::vector<char> has_layers(skin.regions.size(), 0);
  for (const std::string& name : layers.on)
    for (const int r : find_entities(skin.regions, "region", name, layers.where)) has_layers[r] = 1;
  const std::vector<HalfEdge> sides = sorted_half_edges(skin);
  std::set<std::string> on, into;
  for (std::size_t l = 0; l < skin.lines.size(); ++l) {
    std::set<int> with, without;
    for (const HalfEdge& side : sides_of_edge(sides, skin.lines[l][0], skin.lines[l][1])) {
      const int region = region_of(skin, side.element);
      (has_layers[region] != 0 ? with : without).insert(region);
    }
    if (with.empty() || without.empty()) continue;
    on.insert(fmt::format("curve_{}", skin.curves[skin.line_curve[l]].tag));
    for (const int region : without) into.insert(fmt::format("region_{}", skin.regions[region].tag));
  }
  LayerSpec beside = layers;
  beside.on.assign(on.begin(), on.end());
  beside.into.assign(into.begin(), into.end());
  beside.fan = kMostFan;
  return beside;
}

}  // namespace delquad
