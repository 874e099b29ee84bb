// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/body_parts.h"

#include <algorithm>
#include <utility>

#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/drop_unused_points.h"

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

AngleAround::AngleAround(const Vec3& a, const Vec3& b, const Vec3& zero) : origin_(a) {
  const Vec3 along = b - a, out = zero - a;
  x_ = out - (dot(out, along) / dot(along, along)) * along;
  y_ = (1 / norm(along)) * cross(along, x_);
}

VoidFaces open_faces(const Mesh& body) {
  std::vector<std::pair<Quad, int>> all;  // with owners; triangles end with -1
  for (const Quad& q : body.quads) all.emplace_back(q, static_cast<int>(all.size()));
  for (const auto& [a, b, c] : body.triangles)
    all.emplace_back(Quad{a, b, c, -1}, static_cast<int>(all.size()));
  for (int i = 0; i < static_cast<int>(n_solids(body)); ++i) {
    const Solid cell = solid_at(body, i);
    for (int k = 0; k < static_cast<int>(cell.shape->sides.size()); ++k) {
      Quad side = cell.side(k);
      std::reverse(side.begin(), side.end() - (side[3] < 0));
      all.emplace_back(side, -1 - i);
    }
  }
  std::vector<std::pair<Quad, std::size_t>> keys;
  for (const auto& [nodes, owner] : all) keys.emplace_back(side_key(nodes), keys.size());
  std::ranges::sort(keys);
  std::vector<char> is_open(all.size(), 1);
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first) {
      is_open[keys[i - 1].second] = is_open[keys[i].second] = 0;
      ++i;
    }
  VoidFaces open;
  for (const bool is_triangle : {false, true})
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& [v, owner] = all[i];
      if (is_open[i] == 0 || (v[3] < 0) != is_triangle) continue;
      open.owners.push_back(owner);
      if (is_triangle)
        open.triangles.push_back({v[0], v[1], v[2]});
      else
        open.quads.push_back(v);
    }
  return open;
}

std::vector<int> keep_used_points(Mesh& part) {
  const std::vector<int> number = drop_unused_points(part);
  std::vector<int> had(part.points.size());
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] >= 0) had[number[v]] = static_cast<int>(v);
  return had;
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
