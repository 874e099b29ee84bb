// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/place_prisms.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "features/volume/fill_void.h"
#include "geometry/mesh/cell_shapes.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

using Quad = std::array<int, 4>;
using Prism = std::array<int, 6>;

constexpr double kLeastOfPrisms = 0.2;

/// Quads between hexahedra or the skin and the void, by their nodes, counterclockwise seen from outside of
/// the void.
std::map<Quad, Quad> open_quads(const Mesh& volume) {
  std::map<Quad, Quad> open;
  const auto toggle = [&](const Quad& quad) {
    const auto [at, is_new] = open.try_emplace(side_key(quad), quad);
    if (!is_new) open.erase(at);
  };
  for (const Quad& quad : volume.quads) toggle(quad);
  for (const auto& hex : volume.hexahedra)
    for (const Quad& side : solid_shape(CellShape::kHexahedron).sides)
      toggle({hex[side[3]], hex[side[2]], hex[side[1]], hex[side[0]]});
  return open;
}

std::array<Quad, 3> quads_of(const Prism& p) {
  return {{{p[0], p[1], p[4], p[3]}, {p[1], p[2], p[5], p[4]}, {p[2], p[0], p[3], p[5]}}};
}

/// The prisms that three quads enclose.
std::vector<Prism> find_prisms(const std::map<Quad, Quad>& open) {
  std::map<std::array<int, 2>, std::vector<Quad>> at;  // by directed first side
  for (const auto& [key, quad] : open)
    for (int k = 0; k < 4; ++k)
      at[{quad[k], quad[(k + 1) % 4]}].push_back(
          {quad[k], quad[(k + 1) % 4], quad[(k + 2) % 4], quad[(k + 3) % 4]});
  std::vector<Prism> prisms;
  for (const auto& [key, quad] : open)
    for (const int k : {0, 1}) {
      const int a = quad[k], b = quad[k + 1], e = quad[k + 2], d = quad[(k + 3) % 4];
      const auto found = at.find({e, b});
      if (found == at.end()) continue;
      for (const auto& [unused_e, unused_b, c, f] : found->second) {
        const Prism prism = {a, b, c, d, e, f};
        const auto sides = quads_of(prism);
        const bool is_first = key < side_key(sides[1]) && key < side_key(sides[2]);
        const auto across = at.find({a, d});
        if (is_first && across != at.end() && std::ranges::count(across->second, Quad{a, d, f, c}) > 0)
          prisms.push_back(prism);
      }
    }
  return prisms;
}

}  // namespace

void place_prisms(Mesh& volume) {
  std::map<Quad, Quad> open = open_quads(volume);
  std::vector<std::pair<double, Prism>> found;
  for (const Prism& prism : find_prisms(open)) {
    const auto corners = corners_of(volume.points, prism);
    if (const double jacobian = scaled_jacobian(corners); jacobian >= kLeastOfPrisms && is_positive(corners))
      found.emplace_back(-jacobian, prism);
  }
  std::ranges::sort(found);
  std::vector<Prism> prisms;
  for (const auto& [worst, prism] : found) {
    const auto sides = quads_of(prism);
    if (!std::ranges::all_of(sides, [&](const Quad& s) { return open.contains(side_key(s)); })) continue;
    for (const Quad& side : sides) open.erase(side_key(side));
    prisms.push_back(prism);
  }
  for (std::size_t before = prisms.size() + 1; prisms.size() < before;) {
    before = prisms.size();
    std::map<std::array<int, 3>, std::pair<std::array<int, 3>, std::size_t>> ends;
    for (std::size_t i = 0; i < prisms.size(); ++i) {
      const auto [a, b, c, d, e, f] = prisms[i];
      for (const std::array<int, 3>& end : {std::array{a, b, c}, std::array{d, f, e}}) {
        std::array<int, 3> key = end;
        std::ranges::sort(key);
        const auto [at, is_new] = ends.try_emplace(key, end, i);
        if (!is_new) ends.erase(at);
      }
    }
    std::vector<Quad> quads;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::size_t> owner;
    for (const auto& [key, quad] : open) quads.push_back(quad);
    for (const auto& [key, end] : ends) triangles.push_back(end.first), owner.push_back(end.second);
    std::vector<char> crosses(prisms.size(), 0);
    for (const int f : untangle(volume.points, quads, triangles))
      if (f >= static_cast<int>(quads.size())) crosses[owner[f - quads.size()]] = 1;
    std::size_t i = 0;
    for (const Prism& prism : prisms)
      if (crosses[i++] != 0)
        for (const Quad& side : quads_of(prism)) open.emplace(side_key(side), side);
    i = 0;
    std::erase_if(prisms, [&](const Prism&) { return crosses[i++] != 0; });
  }
  volume.prisms = std::move(prisms);
  volume.prism_volume.assign(volume.prisms.size(), 0);
}

}  // namespace delquad
