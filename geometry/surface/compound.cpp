// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "base/disjoint_sets.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "delquad/error.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/compound_projector.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {

namespace {

using Groups = EntityGroups;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Returns for each line the faces of its two triangles; -1, -1 for another number.
std::vector<std::array<int, 2>> faces_of_lines(const Mesh& mesh) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<std::array<int, 2>> faces(mesh.lines.size(), {-1, -1});
  for (size_t i = 0; i < faces.size(); ++i) {
    const auto edge = sides_of_edge(sides, mesh.lines[i][0], mesh.lines[i][1]);
    if (edge.size() != 2) continue;
    faces[i] = {mesh.triangle_region[edge[0].element], mesh.triangle_region[edge[1].element]};
  }
  return faces;
}

/// Returns the group of each face; -1: none. Throws InputError for impossible groups.
std::vector<int> check_groups(const SurfaceModel& model, const Groups& groups) {
  const Mesh& mesh = model.fine;
  std::vector<int> group_of(mesh.regions.size(), -1);
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const int face : groups[g]) {
      if (face < 0 || face >= static_cast<int>(group_of.size())) {
        throw InputError(fmt::format("{}: compound {}: no face has index {}: expected 0 to {}", model.source,
                                     g + 1, face, int(group_of.size()) - 1));
      }
      if (group_of[face] >= 0) {
        throw InputError(fmt::format("{}: face {} is named twice in compounds: expected once", model.source,
                                     mesh.regions[face].tag));
      }
      group_of[face] = static_cast<int>(g);
    }
  }
  DisjointSets sets(group_of.size());
  for (const auto& [f, g] : faces_of_lines(mesh)) {
    if (f >= 0 && group_of[f] >= 0 && group_of[f] == group_of[g]) sets.join(f, g);
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const int face : groups[g]) {
      if (sets.root(face) == sets.root(groups[g][0])) continue;
      throw InputError(
          fmt::format("{}: compound {}: face {} does not reach face {} along the curves between its "
                      "faces: expected faces that hang together",
                      model.source, g + 1, mesh.regions[face].tag, mesh.regions[groups[g][0]].tag));
    }
  }
  return group_of;
}

/// Returns one entity for several: the least tag, and all names once.
Entity merged(const std::vector<Entity>& entities, const std::vector<int>& members) {
  Entity all = entities[members[0]];
  for (const int i : members) {
    all.tag = std::min(all.tag, entities[i].tag);
    for (const std::string& name : entities[i].names) {
      if (std::find(all.names.begin(), all.names.end(), name) == all.names.end()) all.names.push_back(name);
    }
  }
  return all;
}

std::vector<Entity> merged(const std::vector<Entity>& entities, const Groups& members) {
  std::vector<Entity> all;
  for (const auto& some : members) all.push_back(merged(entities, some));
  return all;
}

/// Sets tags. If several curves have one tag, the first keeps it.
void set_tags_of_pieces(std::vector<Entity>& curves) {
  int greatest = 0;
  for (const Entity& curve : curves) greatest = std::max(greatest, curve.tag);
  std::set<int> taken;
  for (Entity& curve : curves)
    if (!taken.insert(curve.tag).second) curve.tag = ++greatest;
}

/// Returns the kind of each line: the same for curves with the same names and number of triangles.
std::vector<int> kinds_of_lines(const Mesh& mesh) {
  std::map<std::pair<std::vector<std::string>, std::size_t>, int> kind_of;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<int> kinds;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    kinds.push_back(
        kind_of
            .try_emplace({mesh.curves[mesh.line_curve[l]].names, sides_of_edge(sides, a, b).size()},
                         static_cast<int>(kind_of.size()))
            .first->second);
  }
  return kinds;
}

/// Joins the lines again. Returns the former curves of each curve.
Groups rechain(SurfaceModel& model, const std::vector<char>& corner) {
  const std::vector<int> old_curve = model.fine.line_curve;
  Groups members;
  for (const auto& chain : chain_lines(model, kinds_of_lines(model.fine), corner)) {
    std::vector<int> curves;
    for (const int line : chain) curves.push_back(old_curve[line]);
    sort_unique(curves);
    members.push_back(std::move(curves));
  }
  model.fine.curves = merged(model.fine.curves, members);
  set_tags_of_pieces(model.fine.curves);
  return members;
}

std::vector<char> marked_corners(const SurfaceModel& model) {
  std::vector<char> corner(model.fine.points.size(), 0);
  for (const int p : model.corners) corner[p] = 1;
  return corner;
}

/// Removes the lines inside of groups. Returns marks of their ends.
std::vector<char> drop_inner_lines(Mesh& mesh, const std::vector<int>& group_of) {
  std::vector<char> ends(mesh.points.size(), 0);
  const auto faces = faces_of_lines(mesh);
  keep_lines(mesh, [&](size_t i) {
    const auto [f, g] = faces[i];
    if (f < 0 || group_of[f] < 0 || group_of[f] != group_of[g]) return true;
    for (const int p : mesh.lines[i]) ends[p] = 1;
    return false;
  });
  return ends;
}

/// Joins the faces of each group, in the place of the first. Returns the former faces of each face.
Groups join_faces(Mesh& mesh, const std::vector<int>& group_of) {
  Groups members;
  std::map<int, int> face_of_group;
  std::vector<int> new_face;
  for (int face = 0; face < static_cast<int>(group_of.size()); ++face) {
    int number = static_cast<int>(members.size());
    if (group_of[face] >= 0) number = face_of_group.emplace(group_of[face], number).first->second;
    if (number == static_cast<int>(members.size())) members.emplace_back();
    members[number].push_back(face);
    new_face.push_back(number);
  }
  for (int& face : mesh.triangle_region) face = new_face[face];
  mesh.regions = merged(mesh.regions, members);
  return members;
}

/// Returns the direction of each face at points of its curves: the sum of the area vectors of its triangles
/// there.
std::map<std::array<int, 2>, Vec3> directions_at_curves(const Mesh& mesh) {
  std::vector<char> on_curve(mesh.points.size(), 0);
  for (const auto& [a, b] : mesh.lines) on_curve[a] = on_curve[b] = 1;
  std::map<std::array<int, 2>, Vec3> direction;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int p : mesh.triangles[t]) {
      if (!on_curve[p]) continue;
      Vec3& sum = direction[{mesh.triangle_region[t], p}];
      sum = sum + area_vector(mesh, t);
    }
  }
  return direction;
}

/// Returns the normal of the true surface beside the middle of a side on a curve. `direction` is the
/// direction of the triangles there. It differs by half of the angle by which the face turns over one
/// triangle, which exceeds smooth angles on a fillet.
Vec3 inward_normal(const SurfaceModel& model, int curve, const HalfEdge& side, const Vec3& direction) {
  constexpr double kStep = 0.02;  // step over the triangle's height
  const Mesh& mesh = model.fine;
  const auto [a, b] = side.run();
  const Vec3 along = mesh.points[b] - mesh.points[a], inwards = cross(direction, along);
  if (!(norm(inwards) > 0)) return {};  // triangles without area tell nothing
  const double step = kStep * norm(area_vector(mesh, side.element)) / norm(along);
  const Vec3 at = model.projector->to_curve(curve, 0.5 * (mesh.points[a] + mesh.points[b]));
  const Vec3 way =
      model.projector->to_face(mesh.triangle_region[side.element], at + (step / norm(inwards)) * inwards) -
      at;
  return way - (dot(way, along) / dot(along, along)) * along;
}

/// Warns of curves shorter than `length` that joined others. `members` has the former curves of each curve.
void report_short_curves(const std::vector<Entity>& old, const std::vector<double>& lengths, double length,
                         const Groups& members, std::vector<Warning>& warnings) {
  for (const auto& curves : members) {
    for (const int curve : curves) {
      if (!(lengths[curve] < length)) continue;
      std::string others;
      for (const int other : curves) {
        if (other != curve) others += fmt::format("{}{}", others.empty() ? "" : ", ", old[other].tag);
      }
      if (!others.empty())
        warnings.push_back({"short curves that became one with others", 1 / lengths[curve],
                            fmt::format("curve {}, {:.3g} long, became one with curve {}", old[curve].tag,
                                        lengths[curve], others)});
    }
  }
}

}  // namespace

SurfaceModel make_compound(SurfaceModel model, const Groups& groups, const CompoundOptions& options) {
  const std::vector<int> group_of = check_groups(model, groups);
  std::vector<char> corner = marked_corners(model);
  const std::vector<char> changed = drop_inner_lines(model.fine, group_of);
  for (size_t p = 0; p < corner.size(); ++p) corner[p] = corner[p] && !changed[p];
  mark_turns(model.fine, radians(options.feature_angle), changed, corner);
  const Mesh former = model.fine;
  const Groups faces = join_faces(model.fine, group_of);
  Groups curves = rechain(model, corner);
  regroup(model, former, faces, std::move(curves));
  return model;
}

std::vector<char> tangent_curves(const SurfaceModel& model, double angle) {
  const Mesh& mesh = model.fine;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  const auto directions = directions_at_curves(mesh);
  // Both sides of a folded sheet have opposite normals, which no limit below 180 degrees admits.
  const auto agree = [&](const Vec3& m, const Vec3& n) {
    return angle >= 180 || (norm(m) > 0 && norm(n) > 0 && angle_between(m, n) < radians(angle));
  };
  std::vector<char> smooth(mesh.curves.size(), 0), sharp(mesh.curves.size(), 0);
  for (size_t i = 0; i < mesh.lines.size(); ++i) {
    const auto [a, b] = mesh.lines[i];
    const auto edge = sides_of_edge(sides, a, b);
    const int curve = mesh.line_curve[i];
    smooth[curve] = 1;
    if (sharp[curve]) continue;
    sharp[curve] = 1;
    if (edge.size() != 2) continue;
    const auto direction = [&, a = a, b = b](const HalfEdge& side) {
      const int face = mesh.triangle_region[side.element];
      return directions.at({face, a}) + directions.at({face, b});
    };
    const Vec3 m = direction(edge[0]), n = direction(edge[1]);
    if (agree(m, n) || (model.projector && agree(-1 * inward_normal(model, curve, edge[0], m),
                                                 inward_normal(model, curve, edge[1], n))))
      sharp[curve] = 0;
  }
  for (size_t c = 0; c < sharp.size(); ++c) smooth[c] = smooth[c] && !sharp[c];
  return smooth;
}

Groups tangent_groups(const SurfaceModel& model, double angle) {
  const Mesh& mesh = model.fine;
  const std::vector<char> smooth = tangent_curves(model, angle);
  const auto faces = faces_of_lines(mesh);
  DisjointSets sets(mesh.regions.size());
  for (size_t i = 0; i < faces.size(); ++i) {
    if (smooth[mesh.line_curve[i]]) sets.join(faces[i][0], faces[i][1]);
  }
  const std::vector<int> place = sets.places();
  Groups groups(place.size());
  for (std::size_t face = 0; face < place.size(); ++face)
    groups[place[face]].push_back(static_cast<int>(face));
  std::erase_if(groups, [](const auto& members) { return members.size() < 2; });
  return groups;
}

namespace {

/// Joins the lines again, as rechain(), with the data of the curves. Returns the former curves of each curve.
Groups join_again(SurfaceModel& model, const std::vector<char>& corner) {
  std::vector<Entity> old = model.fine.curves;
  Groups curves = rechain(model, corner);
  Mesh former = model.fine;
  former.curves = std::move(old);
  regroup(model, former, singleton_groups(former.regions.size()), curves);
  return curves;
}

/// Drops the corners of a chain within their tolerance of the line between the others. The farthest corner
/// stays, and both parts follow. Pieces that are no lines divide the chain.
void drop_corners(const Mesh& mesh, const std::vector<int>& chain, const CurveTolerance& tolerance,
                  std::vector<char>& corner) {
  const auto look = [&](std::size_t from, std::size_t to) {
    std::array<std::pair<double, std::size_t>, 2> farthest{};  // of all points, of corners
    for (std::size_t k = from + 1; k < to; ++k) {
      const Vec3& x = mesh.points[chain[k]];
      const double off =
          distance_to_segment(x, mesh.points[chain[from]], mesh.points[chain[to]]) / tolerance(x);
      farthest[0] = std::max(farthest[0], {off, k});
      if (corner[chain[k]]) farthest[1] = std::max(farthest[1], {off, k});
    }
    return farthest;
  };
  std::vector<std::array<std::size_t, 2>> parts;
  std::size_t begin = 0, last = 0;
  for (std::size_t k = 1; k < chain.size(); ++k) {
    if (!corner[chain[k]] && k + 1 < chain.size()) continue;
    if (look(last, k)[0].first > 1) {
      parts.push_back({begin, last});
      begin = k;
    }
    last = k;
  }
  parts.push_back({begin, last});
  while (!parts.empty()) {
    const auto [from, to] = parts.back();
    parts.pop_back();
    const auto [most, at_corner] = look(from, to);
    if (at_corner.second == 0) continue;
    if (most.first > 1)
      parts.insert(parts.end(), {{from, at_corner.second}, {at_corner.second, to}});
    else
      for (std::size_t k = from + 1; k < to; ++k) corner[chain[k]] = 0;
  }
}

}  // namespace

SurfaceModel simplify_curves(SurfaceModel model, const CurveTolerance& tolerance,
                             const std::vector<char>& kept) {
  const Mesh& mesh = model.fine;
  std::vector<int> kinds = kinds_of_lines(mesh);
  for (std::size_t l = 0; l < kinds.size(); ++l)
    if (!kept.empty() && kept[mesh.line_curve[l]]) kinds[l] = -1 - mesh.line_curve[l];
  std::vector<std::set<int>> kinds_at(mesh.points.size());
  for (std::size_t l = 0; l < kinds.size(); ++l)
    for (const int v : mesh.lines[l]) kinds_at[v].insert(kinds[l]);
  std::vector<char> corner = marked_corners(model), stays(mesh.points.size(), 0);
  for (const NamedPoint& named : mesh.named_points) stays[named.point] = 1;
  for (std::size_t v = 0; v < stays.size(); ++v)
    stays[v] = stays[v] || (corner[v] && (kinds_at[v].size() != 1 || *kinds_at[v].begin() < 0));
  for (const EdgeChain& chain : chain_edges(mesh.lines, [&](int v) { return stays[v] != 0; }))
    drop_corners(mesh, chain.points, tolerance, corner);
  const std::vector<Entity> old = mesh.curves;
  const Groups curves = join_again(model, corner);
  for (const std::vector<int>& members : curves)
    if (members.size() > 1)
      model.warnings.push_back({"curves that became one with others", static_cast<double>(members.size()),
                                fmt::format("curve {} and {} others became one: their ends lie near the line "
                                            "between the ends that stay",
                                            old[members[0]].tag, members.size() - 1)});
  return model;
}

SurfaceModel merge_short_curves(SurfaceModel model, double length, const CompoundOptions& options,
                                const std::vector<char>& kept) {
  const Mesh& mesh = model.fine;
  struct LineFrom {
    int line, from;  ///< other point of the line
  };
  const std::vector<double> lengths = lengths_of_curves(mesh);
  std::vector<std::vector<LineFrom>> lines_at(mesh.points.size());
  for (int i = 0; i < static_cast<int>(mesh.lines.size()); ++i) {
    const auto [a, b] = mesh.lines[i];
    lines_at[a].push_back({i, b});
    lines_at[b].push_back({i, a});
  }
  const std::vector<int> kinds = kinds_of_lines(mesh);
  const auto stays = [&](int curve) { return !kept.empty() && kept[curve]; };
  std::vector<char> corner = marked_corners(model);
  bool joins = false;
  for (const int p : model.corners) {
    if (lines_at[p].size() != 2) continue;
    const auto [one, from] = lines_at[p][0];
    const auto [other, to] = lines_at[p][1];
    const int c = mesh.line_curve[one], d = mesh.line_curve[other];
    if (c == d || kinds[one] != kinds[other] || stays(c) || stays(d)) continue;
    if (!(std::min(lengths[c], lengths[d]) < length)) continue;
    if (!(turn_angle(mesh.points[from], mesh.points[p], mesh.points[to]) < radians(options.feature_angle)))
      continue;
    corner[p] = 0;
    joins = true;
  }
  if (!joins) return model;
  const std::vector<Entity> old = mesh.curves;
  const Groups curves = join_again(model, corner);
  report_short_curves(old, lengths, length, curves, model.warnings);
  return model;
}

}  // namespace delquad
