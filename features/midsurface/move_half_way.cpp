// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "base/parallel_each.h"
#include "features/midsurface/opposite_sides.h"
#include "features/midsurface/planes.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/triangulated_model.h"

namespace delquad {

void OppositeSides::add_to(SurfaceModel& model) const {
  if (joined_) {
    SurfaceModel plates = make_surface_model(*joined_, {.source = source});
    plates.fine.unit = fine.unit;
    plates.loose.insert(plates.loose.end(), model.loose.begin(), model.loose.end());
    plates.warnings = model.warnings;  // its own ones tell that it is open and branches
    model = std::move(plates);
    return;
  }
  Mesh& mesh = model.fine;
  const auto is_meshed = [&](int f) { return std::ranges::binary_search(faces_, f); };
  for (std::size_t g = 0; g < is_narrow_.size(); ++g)
    if (!is_narrow_[g] && !is_meshed(static_cast<int>(g)))
      for (const auto& [f, part] : parts_facing(static_cast<int>(g)))
        if (part >= kFacedPart && is_meshed(f)) add_names(fine.regions[g].names, {}, mesh.regions[f].names);
  const std::vector<HalfEdge> sides = sorted_half_edges(fine);
  std::map<int, int> thinner;  // by curve of a step, the face beside it
  for (std::size_t l = 0; l < fine.lines.size(); ++l) {
    const auto edge = sides_of_edge(sides, fine.lines[l][0], fine.lines[l][1]);
    if (edge.size() != 2) continue;
    for (const int k : {0, 1}) {
      const int f = region_of(fine, edge[k].element), r = region_of(fine, edge[1 - k].element);
      if (is_narrow_[f] || !is_narrow_[r]) continue;
      if (is_meshed(f))
        add_names(fine.regions[r].names, fine.regions[f].names, mesh.curves[fine.line_curve[l]].names);
      const auto is_thinner = [&](const auto& g) {
        return !is_narrow_[g.first] && median_thickness[g.first] < median_thickness[f];
      };
      if (side_of_step(r) >= 0 && std::ranges::none_of(shared[r], is_thinner))
        thinner.emplace(fine.line_curve[l], f);
    }
  }
  const std::vector<std::vector<int>> points = points_of_curves(fine);
  for (const auto& [curve, face] : thinner) {
    const auto parts = parts_facing(face);
    if (parts.empty()) continue;
    const int opposite = std::ranges::max_element(parts, {}, [](const auto& p) { return p.second; })->first;
    LooseLine line{{}, {}, source + ": a step of the thickness"};
    for (const int v : points[curve]) line.points.push_back(nearest(opposite, fine.points[v]));
    model.loose.push_back(std::move(line));
  }
}

int OppositeSides::opposite_near(const Vec3& x) const {
  double least = std::numeric_limits<double>::max();
  int opposite = faces_[0];
  for (const int f : faces_)
    for (const Sample& s : samples[f])
      if (const double d = norm(s.at - x); d < least && is_faced(f, s)) least = d, opposite = s.opposite;
  return opposite;
}

void OppositeSides::move_half_way(Mesh& mesh) const {
  const std::size_t n = mesh.triangles.size() + mesh.quads.size();
  std::vector<std::vector<int>> corners;
  for_each_element(mesh, [&](int, const auto& v) { corners.emplace_back(v.begin(), v.end()); });
  const auto middle_of = [&](std::size_t e) {
    Vec3 sum;
    for (const int v : corners[e])
      sum = sum + (1.0 / static_cast<double>(corners[e].size())) * mesh.points[v];
    return sum;
  };
  mesh.thickness.assign(n, 0);
  if (joined_) {
    const NearestTriangle nearest_plate(joined_->points, joined_->triangles);
    parallel_each(n, [&](std::size_t e) {
      mesh.thickness[e] = joined_->thickness[nearest_plate.find(middle_of(e)).triangle];
    });
    return;
  }
  std::vector<int> opposite(n, -1);
  std::vector<std::vector<Vec3>> ways(n);
  parallel_each(n, [&](std::size_t e) {
    const std::vector<int>& v = corners[e];
    const Vec3 middle = middle_of(e);
    Vec3 normal;
    for (std::size_t k = 0; k < v.size(); ++k)
      normal = normal + cross(mesh.points[v[k]], mesh.points[v[(k + 1) % v.size()]]);
    if (norm(normal) > 0) {
      const Sample seen = look(middle, (inward_sign / norm(normal)) * normal, 0);
      if (seen.opposite >= 0 && side_[seen.opposite] >= 0 &&
          !std::ranges::binary_search(faces_, seen.opposite))
        opposite[e] = seen.opposite;
    }
    if (opposite[e] < 0) opposite[e] = opposite_near(middle);
    for (const int i : v) ways[e].push_back(nearest(opposite[e], mesh.points[i]) - mesh.points[i]);
  });
  std::vector<Planes> at(mesh.points.size());
  for (std::size_t e = 0; e < n; ++e)
    for (std::size_t k = 0; k < corners[e].size(); ++k) {
      const double length = norm(ways[e][k]);
      if (length > 0) at[corners[e][k]].add((1 / length) * ways[e][k], length / 2);
      mesh.thickness[e] += length / static_cast<double>(corners[e].size());
    }
  for (std::size_t i = 0; i < at.size(); ++i) mesh.points[i] = mesh.points[i] + at[i].shift();
}

}  // namespace delquad
