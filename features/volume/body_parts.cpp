// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/body_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/mesh/cell_shapes.h"

namespace delquad {

std::vector<Triangle> halves_of(std::span<const Quad> quads) {
  std::vector<Triangle> halves;
  for (const auto& [a, b, c, d] : quads) halves.insert(halves.end(), {{a, b, c}, {a, c, d}});
  return halves;
}

Vec3 middle_of(const std::vector<Vec3>& points, std::span<const int> numbers) {
  Vec3 sum;
  for (const int v : numbers) sum = sum + 1.0 / static_cast<double>(numbers.size()) * points[v];
  return sum;
}

std::vector<OpenFace> open_faces(const Mesh& body) {
  std::vector<OpenFace> all;
  for (const Quad& q : body.quads) all.push_back({q, static_cast<int>(all.size())});
  for (const auto& [a, b, c] : body.triangles) all.push_back({{a, b, c, -1}, static_cast<int>(all.size())});
  for (int i = 0; i < static_cast<int>(n_solids(body)); ++i) {
    const Solid cell = solid_at(body, i);
    for (int k = 0; k < static_cast<int>(cell.shape->sides.size()); ++k) {
      Quad side = cell.side(k);
      std::reverse(side.begin(), side.end() - (side[3] < 0));
      all.push_back({side, -1 - i});
    }
  }
  std::vector<std::pair<Quad, int>> keys;
  for (const OpenFace& face : all) keys.emplace_back(side_key(face.corners()), static_cast<int>(keys.size()));
  std::ranges::sort(keys);
  std::vector<char> is_open(all.size(), 1);
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first) {
      is_open[keys[i - 1].second] = is_open[keys[i].second] = 0;
      ++i;
    }
  std::size_t i = 0;
  std::erase_if(all, [&](const OpenFace&) { return is_open[i++] == 0; });
  std::ranges::stable_sort(all, {}, [](const OpenFace& f) { return f.nodes[3] < 0; });
  return all;
}

Mesh part_with(const std::vector<Vec3>& points, std::span<const Quad> quads, std::vector<int>& numbers) {
  Mesh part;
  std::map<int, int> place;
  part.quads.assign(quads.begin(), quads.end());
  for (Quad& quad : part.quads)
    for (int& v : quad) {
      const auto [at, is_new] = place.try_emplace(v, static_cast<int>(numbers.size()));
      if (is_new) numbers.push_back(v), part.points.push_back(points[v]);
      v = at->second;
    }
  return part;
}

void add_cell(Mesh& mesh, std::span<const int> nodes, int volume) {
  for_each_shape(mesh, [&](const SolidShape& shape, auto& cells, std::vector<int>& volumes) {
    if (shape.n_corners != nodes.size()) return;
    std::ranges::copy(nodes, cells.emplace_back().begin());
    volumes.push_back(volume);
  });
}

void add_cells(Mesh& mesh, const Mesh& from, std::vector<int> numbers, int volume) {
  numbers.resize(from.points.size(), -1);
  for (std::size_t i = 0; i < n_solids(from); ++i) {
    std::vector<int> nodes;
    for (const int v : solid_at(from, i).nodes) {
      if (numbers[v] < 0) {
        numbers[v] = static_cast<int>(mesh.points.size());
        mesh.points.push_back(from.points[v]);
      }
      nodes.push_back(numbers[v]);
    }
    add_cell(mesh, nodes, volume);
  }
}

void drop_cells(Mesh& mesh, const std::vector<int>& cells) {
  std::vector<char> dropped(n_solids(mesh), 0);
  for (const int c : cells) dropped[c] = 1;
  std::size_t i = 0;
  for_each_shape(mesh, [&](const SolidShape&, auto& list, std::vector<int>& volumes) {
    std::erase_if(list, [&](const auto&) { return dropped[i++] != 0; });
    volumes.assign(list.size(), 0);
  });
}

}  // namespace delquad
