// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/sizes/named_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithms/fields/background_mesh.h"
#include "base/nearest_name.h"
#include "delquad/error.h"

namespace delquad {
namespace {

/// A curve of a model is seen by so many chords, and by its corners.
constexpr int kChordsOfNamed = 512;

std::string by_number(const std::string& kind, const Entity& entity) {
  return fmt::format("{}_{}", kind, entity.tag);
}

std::vector<double> sampled_parameters(const Curve& shape) {
  std::vector<double> t = shape.fixed_parameters();
  for (int k = 0; k <= kChordsOfNamed; ++k) t.push_back(static_cast<double>(k) / kChordsOfNamed);
  std::ranges::sort(t);
  return t;
}

Vec3 in_space(Vec2 p, double z) { return {p.x, p.y, z}; }

}  // namespace

NamedParts::NamedParts(const Mesh& mesh) {
  add_lines(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    add("region", mesh.regions[mesh.triangle_region[t]], {mesh.points[a], mesh.points[b], mesh.points[c]});
  }
}

NamedParts::NamedParts(const PlanarModel& model, const PlanarDomain& domain) {
  for (std::size_t i = 0; i < model.curves.size(); ++i) {
    const ModelCurve& curve = model.curves[i];
    Entity entity{static_cast<int>(i) + 1, {}};
    if (!curve.name.empty()) entity.names.push_back(curve.name);
    const std::vector<double> t = sampled_parameters(*curve.shape);
    for (std::size_t k = 1; k < t.size(); ++k)
      add("curve", entity,
          {in_space(curve.shape->point(t[k - 1]), 0), in_space(curve.shape->point(t[k]), 0), {}});
  }
  for (const NamedPoint& point : domain.boundary.named_points) {
    const Vec3& x = domain.boundary.points[point.point];
    add("point", point.entity, {x, x, {}});
  }
  add_regions(domain);
}

NamedParts::NamedParts(const PlanarDomain& domain) {
  add_lines(domain.boundary);
  add_regions(domain);
}

NamedParts::NamedParts(const std::vector<LooseLine>& loose) {
  for (const LooseLine& line : loose)
    for (std::size_t k = 0; k < line.points.size(); ++k)
      for (const std::string& name : line.names)
        parts_[name].push_back({line.points[k == 0 ? 0 : k - 1], line.points[k], {}});
}

void NamedParts::add(const std::string& kind, const Entity& entity, const Part& part) {
  for (const std::string& name : entity.names) parts_[name].push_back(part);
  if (const std::string number = by_number(kind, entity);
      std::ranges::find(entity.names, number) == entity.names.end())
    parts_[number].push_back(part);
}

void NamedParts::add_lines(const Mesh& mesh, std::size_t first_curve, std::size_t first_point) {
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    if (mesh.line_curve[l] < static_cast<int>(first_curve)) continue;
    const auto& [a, b] = mesh.lines[l];
    add("curve", mesh.curves[mesh.line_curve[l]], {mesh.points[a], mesh.points[b], {}});
  }
  for (std::size_t i = first_point; i < mesh.named_points.size(); ++i) {
    const Vec3& x = mesh.points[mesh.named_points[i].point];
    add("point", mesh.named_points[i].entity, {x, x, {}});
  }
}

void NamedParts::add_regions(const PlanarDomain& domain) {
  const BackgroundMesh background(domain.patches);
  const TriPatch& tri = background.triangles();
  const double z = domain.boundary.points.empty() ? 0 : domain.boundary.points[0].z;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& [a, b, c] = tri.triangles[t];
    const int region = domain.patch_region[background.triangle_patch()[t]];
    add("region", domain.boundary.regions[region],
        {in_space(tri.points[a], z), in_space(tri.points[b], z), in_space(tri.points[c], z)});
  }
}

std::vector<LocalSize> NamedParts::spots(const std::vector<NamedSize>& wanted) const {
  for (const NamedSize& w : wanted) {
    if (parts_.contains(w.name)) continue;
    std::vector<std::string> known;
    for (const auto& [name, parts] : parts_) known.push_back(name);
    throw InputError(fmt::format("{}: nothing is called '{}'{} [unknown-name]", w.where, w.name,
                                 suggestion_or_all(w.name, std::move(known))));
  }
  return known_spots(wanted);
}

std::vector<LocalSize> NamedParts::known_spots(const std::vector<NamedSize>& wanted) const {
  std::vector<LocalSize> spots;
  for (const NamedSize& w : wanted) {
    const auto at = parts_.find(w.name);
    if (at == parts_.end() || !(w.size > 0)) continue;
    for (const Part& part : at->second) spots.push_back({part.a, part.b, w.size, w.reach, w.growth, part.c});
  }
  return spots;
}

}  // namespace delquad
