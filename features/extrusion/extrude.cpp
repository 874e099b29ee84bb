// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <utility>

#include "base/cancel.h"
#include "base/parallel_each.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/extrusion/layers.h"
#include "features/extrusion/section.h"
#include "geometry/mesh/find_crossings.h"
#include "io/entity_names.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

/// Numbers of the swept points, layer by layer.
class Levels {
 public:
  Levels(const Section& section, const LayeredPoints& layered)
      : n_(static_cast<int>(section.mesh.points.size())),
        n_levels_(layered.n_layers + (layered.is_closed ? 0 : 1)),
        is_closed_(layered.is_closed) {}
  int point(int i, int level) const { return level % n_levels_ * n_ + i; }
  int section_point(int point) const { return point % n_; }
  /// How many layers of nodes lie between two points, the shorter way round.
  int distance(int a, int b) const {
    const int d = std::abs(a / n_ - b / n_);
    return is_closed_ ? std::min(d, n_levels_ - d) : d;
  }

 private:
  int n_, n_levels_;
  bool is_closed_;
};

/// Layer after layer, each in the order of the quads.
std::vector<std::array<int, 8>> make_hexahedra(const Section& section, const LayeredPoints& layered) {
  const Levels at(section, layered);
  std::vector<std::array<int, 8>> hexahedra;
  hexahedra.reserve(section.mesh.quads.size() * static_cast<std::size_t>(layered.n_layers));
  for (int layer = 0; layer < layered.n_layers; ++layer)
    for (const auto& [a, b, c, d] : section.mesh.quads)
      hexahedra.push_back({at.point(a, layer), at.point(b, layer), at.point(c, layer), at.point(d, layer),
                           at.point(a, layer + 1), at.point(b, layer + 1), at.point(c, layer + 1),
                           at.point(d, layer + 1)});
  return hexahedra;
}

/// Parts whose hexahedra would have a negative volume run the other way round.
void turn_towards_path(Section& section, const LayeredPoints& layered) {
  const std::vector<std::array<int, 8>> hexahedra = make_hexahedra(section, layered);
  const std::size_t n = section.mesh.quads.size();
  std::vector<double> volume(hexahedra.size());
  parallel_each(hexahedra.size(),
                [&](std::size_t i) { volume[i] = signed_volume(corners_of(layered.points, hexahedra[i])); });
  std::vector<double> of_part(section.n_parts, 0);
  for (std::size_t i = 0; i < volume.size(); ++i) of_part[section.part[i % n]] += volume[i];
  for (std::size_t q = 0; q < n; ++q)
    if (of_part[section.part[q]] < 0) std::swap(section.mesh.quads[q][1], section.mesh.quads[q][3]);
  for (WallEdge& wall : section.walls)
    if (of_part[section.part[wall.quad]] < 0) std::swap(wall.a, wall.b);
}

/// Gives nameless entities a name by their number.
std::vector<Entity> with_names(std::vector<Entity> entities, int dim) {
  const std::vector<std::string> names = group_names(entities, dim);
  for (std::size_t i = 0; i < entities.size(); ++i)
    if (entities[i].names.empty()) entities[i].names = {names[i]};
  return entities;
}

/// Numbers above 0 that no entity has, the least first.
class FreeTags {
 public:
  explicit FreeTags(const std::vector<Entity>& entities) {
    for (const Entity& entity : entities) taken_.insert(entity.tag);
  }
  int take() {
    while (taken_.contains(next_)) ++next_;
    return next_++;
  }

 private:
  std::set<int> taken_;
  int next_ = 1;
};

void require_positive(const Section& section, const std::vector<Entity>& volumes,
                      const std::vector<Vec3>& points, const std::vector<std::array<int, 8>>& hexahedra) {
  std::vector<char> is_bad(hexahedra.size(), 0);
  parallel_each(hexahedra.size(), [&](std::size_t i) {
    if (i % 1024 == 0) check_cancelled();
    is_bad[i] = !is_positive(corners_of(points, hexahedra[i]));
  });
  const auto n_bad = std::ranges::count(is_bad, 1);
  if (n_bad == 0) return;
  std::size_t worst = hexahedra.size();
  double least = 2;
  for (std::size_t i = 0; i < hexahedra.size(); ++i) {
    if (!is_bad[i]) continue;
    const double value = scaled_jacobian(corners_of(points, hexahedra[i]));
    if (value < least) least = value, worst = i;
  }
  Vec3 centre;
  for (const int v : hexahedra[worst]) centre = centre + 0.125 * points[v];
  const std::size_t n = section.mesh.quads.size();
  throw InputError(fmt::format(
      "{} of {} hexahedra are inverted or flat, the worst in layer {} of '{}' at {} with a scaled Jacobian "
      "of {:.3g}. The sweep is too thick, or bends too much, for the section [inverted-hexahedra]",
      n_bad, hexahedra.size(), worst / n + 1, volumes[section.mesh.quad_region[worst % n]].names[0],
      show_point(centre), least));
}

/// The boundary as triangles, halves of quads along diagonals that two sides of a crack have in common.
void require_no_crossing(const Section& section, const LayeredPoints& layered) {
  const Levels at(section, layered);
  const std::vector<Vec3>& points = section.mesh.points;
  std::vector<std::array<int, 3>> triangles;
  if (!layered.is_closed)
    for (const int level : {0, layered.n_layers})
      for (const auto& [a, b, c, d] : section.mesh.quads) {
        triangles.push_back({at.point(a, level), at.point(b, level), at.point(c, level)});
        triangles.push_back({at.point(a, level), at.point(c, level), at.point(d, level)});
      }
  for (const WallEdge& wall : section.walls) {
    if (!wall.on_boundary) continue;
    const auto key = [&](int i) { return std::array{points[i].x, points[i].y, points[i].z}; };
    const auto [a, b] = key(wall.b) < key(wall.a) ? std::pair(wall.b, wall.a) : std::pair(wall.a, wall.b);
    for (int layer = 0; layer < layered.n_layers; ++layer) {
      triangles.push_back({at.point(a, layer), at.point(b, layer), at.point(b, layer + 1)});
      triangles.push_back({at.point(a, layer), at.point(b, layer + 1), at.point(a, layer + 1)});
    }
  }
  // Around a point hexahedra that are positive do not meet, but triangles in the place of warped quads may.
  const auto are_neighbours = [&](int first, int second) {
    for (const int a : triangles[first])
      for (const int b : triangles[second])
        if (at.section_point(a) == at.section_point(b) && (layered.is_straight || at.distance(a, b) <= 1))
          return true;
    return false;
  };
  if (const auto crossing = find_crossing(layered.points, triangles, are_neighbours))
    throw InputError(
        fmt::format("the swept body meets itself at {} [inverted-hexahedra]", show_point(crossing->at)));
}

void add_walls(const Section& section, const LayeredPoints& layered, Mesh& result) {
  const Levels at(section, layered);
  std::vector<Entity> curves = section.mesh.curves;
  const int nameless = static_cast<int>(curves.size());
  if (std::ranges::any_of(section.walls, [](const WallEdge& wall) { return wall.curve < 0; }))
    curves.push_back({FreeTags(curves).take(), {}});
  result.regions = with_names(std::move(curves), 1);
  for (int layer = 0; layer < layered.n_layers; ++layer)
    for (const WallEdge& wall : section.walls) {
      result.quads.push_back({at.point(wall.a, layer), at.point(wall.b, layer), at.point(wall.b, layer + 1),
                              at.point(wall.a, layer + 1)});
      result.quad_region.push_back(wall.curve < 0 ? nameless : wall.curve);
    }
}

/// Faces where the sweep starts and ends, after the faces of the walls.
void add_caps(const Section& section, const LayeredPoints& layered, Mesh& result) {
  const Levels at(section, layered);
  FreeTags tags(result.regions);
  for (const bool is_end : {false, true}) {
    const int first = static_cast<int>(result.regions.size());
    for (Entity face : result.volumes) {
      face.tag = tags.take();
      for (std::string& name : face.names) name += is_end ? " end" : " start";
      result.regions.push_back(std::move(face));
    }
    const int level = is_end ? layered.n_layers : 0;
    for (std::size_t q = 0; q < section.mesh.quads.size(); ++q) {
      std::array<int, 4> quad = section.mesh.quads[q];
      if (!is_end) std::swap(quad[1], quad[3]);
      for (int& v : quad) v = at.point(v, level);
      result.quads.push_back(quad);
      result.quad_region.push_back(first + section.mesh.quad_region[q]);
    }
  }
}

void add_point_curves(const Section& section, const LayeredPoints& layered, Mesh& result) {
  const Levels at(section, layered);
  for (const NamedPoint& named : section.mesh.named_points) result.curves.push_back(named.entity);
  result.curves = with_names(std::move(result.curves), 0);
  for (std::size_t c = 0; c < result.curves.size(); ++c)
    for (int layer = 0; layer < layered.n_layers; ++layer) {
      const int point = section.mesh.named_points[c].point;
      result.lines.push_back({at.point(point, layer), at.point(point, layer + 1)});
      result.line_curve.push_back(static_cast<int>(c));
    }
}

}  // namespace

Mesh extrude(const Mesh& mesh, const SweepPath& path, const SweepLayers& layers, ReadNotes* notes) {
  Section section = make_section(mesh, notes);
  LayeredPoints layered = place_layers(section, path, layers);
  turn_towards_path(section, layered);
  Mesh result;
  result.unit = mesh.unit;
  result.hexahedra = make_hexahedra(section, layered);
  result.volumes = with_names(mesh.regions, 2);
  require_positive(section, result.volumes, layered.points, result.hexahedra);
  require_no_crossing(section, layered);
  for (int layer = 0; layer < layered.n_layers; ++layer)
    result.hex_volume.insert(result.hex_volume.end(), section.mesh.quad_region.begin(),
                             section.mesh.quad_region.end());
  add_walls(section, layered, result);
  if (!layered.is_closed) add_caps(section, layered, result);
  add_point_curves(section, layered, result);
  result.points = std::move(layered.points);
  return result;
}

}  // namespace delquad
