// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/triangle_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "base/box.h"
#include "base/disjoint_sets.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/stray_points.h"
#include "geometry/mesh/weld.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

using Triangle = std::array<int, 3>;

Triangle sorted_vertices(Triangle v) {
  std::sort(v.begin(), v.end());
  return v;
}

/// Number of removed triangles, and place of the first.
struct Dropped {
  int count = 0;
  Vec3 first;
};
template <class Keep>
Dropped drop_triangles(Mesh& mesh, Keep keep) {
  Dropped dropped;
  keep_triangles(mesh, [&](size_t t) {
    const bool stays = keep(t);
    if (!stays && dropped.count++ == 0) dropped.first = mesh.points[mesh.triangles[t][0]];
    return stays;
  });
  return dropped;
}

void leave_out_flat(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings) {
  const FlatTriangles flat = take_out_flat_triangles(mesh, source);
  if (flat.count > 0)
    warnings.push_back(fmt::format("left out {} without area (the first at {})",
                                   counted(flat.count, "triangle"), show_point(flat.first)));
}

/// Gives a triangle that also replaces one of another region a region with the names of both.
class CommonRegions {
 public:
  explicit CommonRegions(Mesh& mesh) : mesh_(mesh) {}

  void join(int triangle, int other) {
    const int own = mesh_.triangle_region[triangle];
    if (own == other) return;
    const auto [at, is_new] = common_.emplace(std::pair(own, other), static_cast<int>(mesh_.regions.size()));
    if (is_new) {
      Entity both = mesh_.regions[own];
      for (const std::string& name : mesh_.regions[other].names)
        if (std::ranges::find(both.names, name) == both.names.end()) both.names.push_back(name);
      both.tag = 1 + std::ranges::max(mesh_.regions, {}, &Entity::tag).tag;
      mesh_.regions.push_back(std::move(both));
    }
    mesh_.triangle_region[triangle] = at->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::pair<int, int>, int> common_;
};

/// Triangles on the same vertices, where there are several; ascending.
std::vector<std::vector<int>> find_copies(const Mesh& mesh) {
  std::vector<int> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<Triangle> keys;
  for (const Triangle& v : mesh.triangles) keys.push_back(sorted_vertices(v));
  std::sort(order.begin(), order.end(),
            [&](int s, int t) { return keys[s] != keys[t] ? keys[s] < keys[t] : s < t; });
  std::vector<std::vector<int>> copies;
  for (size_t i = 1; i < order.size(); ++i) {
    if (keys[order[i]] != keys[order[i - 1]]) continue;
    if (copies.empty() || copies.back().back() != order[i - 1]) copies.push_back({order[i - 1]});
    copies.back().push_back(order[i]);
  }
  return copies;
}

/// Takes out small folds: pairs of triangles back to back that others meet on some sides, and none on others.
void take_out_folds(Mesh& mesh, std::vector<Warning>& warnings) {
  constexpr double kSmall = 0.02;  // of the diagonal: much less than usual sizes
  std::vector<int> pair_of(mesh.triangles.size(), -1);
  int n_pairs = 0;
  for (const std::vector<int>& copies : find_copies(mesh)) {
    const Triangle &a = mesh.triangles[copies[0]], &b = mesh.triangles[copies[1]];
    const auto same = std::ranges::find(b, a[0]) - b.begin();
    if (copies.size() != 2 || b[(same + 1) % 3] == a[1]) continue;
    pair_of[copies[0]] = pair_of[copies[1]] = n_pairs++;
  }
  if (n_pairs == 0) return;
  DisjointSets folds(n_pairs);
  std::vector<std::array<int, 2>> on_edge;  // pairs that only they are on an edge, or with others
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    int pair = -1;
    for (const HalfEdge& half : edge) {
      const int other = pair_of[half.element];
      if (pair >= 0 && other >= 0) folds.join(pair, other);
      pair = std::max(pair, other);
    }
    const bool is_alone =
        std::ranges::all_of(edge, [&](const HalfEdge& h) { return pair_of[h.element] >= 0; });
    if (pair >= 0 && (edge.size() == 2 || !is_alone)) on_edge.push_back({pair, is_alone ? 0 : 1});
  });
  std::vector<std::array<char, 2>> sides(n_pairs);
  for (const auto& [pair, kind] : on_edge) sides[folds.root(pair)][kind] = 1;
  std::vector<std::optional<Box<Vec3>>> boxes(n_pairs);
  for (size_t t = 0; t < pair_of.size(); ++t)
    for (const int v : mesh.triangles[t]) {
      if (pair_of[t] < 0) break;
      auto& box = boxes[folds.root(pair_of[t])];
      box ? box->add(mesh.points[v]) : void(box = {mesh.points[v], mesh.points[v]});
    }
  const double least = kSmall * diagonal(mesh.points);
  const Dropped dropped = drop_triangles(mesh, [&](size_t t) {
    const int fold = pair_of[t] < 0 ? -1 : folds.root(pair_of[t]);
    return fold < 0 || !sides[fold][0] || !sides[fold][1] || norm(boxes[fold]->size()) > least;
  });
  if (dropped.count > 0)
    warnings.push_back(fmt::format("left out {} in small folds without thickness (the first at {})",
                                   counted(dropped.count, "triangle"), show_point(dropped.first)));
}

void remove_duplicates(Mesh& mesh, std::vector<Warning>& warnings) {
  std::vector<char> twin(mesh.triangles.size(), 0);
  CommonRegions regions(mesh);
  for (const std::vector<int>& copies : find_copies(mesh))
    for (size_t i = 1; i < copies.size(); ++i) {
      twin[copies[i]] = 1;
      regions.join(copies[0], mesh.triangle_region[copies[i]]);
    }
  const Dropped dropped = drop_triangles(mesh, [&](size_t t) { return !twin[t]; });
  if (dropped.count == 0) return;
  warnings.push_back(fmt::format("left out {} on the vertices of another (the first at {})",
                                 counted(dropped.count, "triangle"), show_point(dropped.first)));
}

/// Returns whether the points of triangles lie in one plane, up to single precision.
bool are_in_plane(const Mesh& mesh, const std::vector<int>& triangles, double tolerance) {
  Vec3 normal{};
  const auto corner = [&](int t, int k) { return mesh.points[mesh.triangles[t][k]]; };
  for (const int t : triangles) {
    const Vec3 area = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    if (norm(area) > norm(normal)) normal = area;
  }
  const Vec3 from = corner(triangles[0], 0);
  return std::ranges::all_of(triangles, [&](int t) {
    return std::ranges::all_of(mesh.triangles[t], [&](int v) {
      return std::abs(dot(mesh.points[v] - from, normal)) <= tolerance * norm(normal);
    });
  });
}

/// Removes flat parts with the outline of an earlier part, such as a common face of two bodies with other
/// diagonals. Branching edges are their outlines.
void take_out_flat_copies(Mesh& mesh, std::vector<Warning>& warnings) {
  DisjointSets sets(mesh.triangles.size());
  std::vector<std::pair<int, std::array<int, 2>>> bounds;  // a triangle and its branching edge
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2) sets.join(edge[0].element, edge[1].element);
    for (const HalfEdge& half : edge)
      if (edge.size() != 2) bounds.push_back({half.element, {half.lo, half.hi}});
  });
  const std::vector<int> part = sets.roots();
  std::map<int, std::vector<std::array<int, 2>>> outlines;
  for (const auto& [t, edge] : bounds) outlines[part[t]].push_back(edge);
  std::map<std::vector<std::array<int, 2>>, std::vector<int>> alike;  // parts by their outline
  for (const auto& [p, outline] : outlines) alike[outline].push_back(p);
  std::map<int, std::vector<int>> triangles_of;  // of parts with the outline of another
  for (const auto& [outline, parts] : alike)
    for (const int p : parts)
      if (parts.size() > 1) triangles_of[p];
  if (triangles_of.empty()) return;
  for (int t = 0; t < static_cast<int>(part.size()); ++t)
    if (const auto of_part = triangles_of.find(part[t]); of_part != triangles_of.end())
      of_part->second.push_back(t);
  constexpr double kFlat = 1e-6;  // of the diagonal: some units in the last place of single precision
  const double tolerance = kFlat * diagonal(mesh.points);
  std::set<int> copies;
  CommonRegions regions(mesh);
  for (const auto& [outline, parts] : alike) {
    int first = -1;
    for (const int p : parts) {
      if (parts.size() < 2 || !are_in_plane(mesh, triangles_of[p], tolerance)) continue;
      if (first >= 0) {
        copies.insert(p);
        for (const int t : triangles_of[first]) regions.join(t, mesh.triangle_region[triangles_of[p][0]]);
      } else {
        first = p;
      }
    }
  }
  const Dropped dropped = drop_triangles(mesh, [&](size_t t) { return !copies.contains(part[t]); });
  if (dropped.count == 0) return;
  warnings.push_back(fmt::format("left out {} of {} that lie on others of the same outline (the first at {})",
                                 counted(dropped.count, "triangle"), counted(std::ssize(copies), "flat part"),
                                 show_point(dropped.first)));
}

/// Warns of edges in more than two triangles, as of ribs or bodies that touch. Throws InputError if most
/// edges are, as for cells that fill a volume.
void warn_of_branches(const Mesh& mesh, const std::string& source, std::vector<Warning>& warnings) {
  int count = 0, n_edges = 0;
  Vec3 first;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    ++n_edges;
    if (edge.size() > 2 && count++ == 0) first = mesh.points[edge[0].lo];
  });
  if (count == 0) return;
  if (2 * count > n_edges)
    throw InputError(fmt::format(
        "{}: {} of {} edges have three triangles or more (the first at {}): expected a surface, not "
        "the sides of cells in a volume [cells-of-a-volume]",
        source, count, n_edges, show_point(first)));
  warnings.push_back(fmt::format("the surface branches at {} with three triangles or more (the first at {})",
                                 counted(count, "edge"), show_point(first)));
}

/// Returns for each line the number of a side along it. Removes lines that are no edges, or on the edge of an
/// earlier line.
std::vector<int> settle_lines(Mesh& mesh, std::vector<Warning>& warnings) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<int> side_of_line;
  std::vector<char> taken(3 * mesh.triangles.size(), 0);
  int stray = 0;
  Vec3 first_stray;
  keep_lines(mesh, [&](size_t i) {
    const auto edge = sides_of_edge(sides, mesh.lines[i][0], mesh.lines[i][1]);
    if (edge.empty()) {
      if (stray++ == 0) first_stray = mesh.points[mesh.lines[i][0]];
      return false;
    }
    const int side = side_number(mesh, edge[0]);
    if (taken[side]) return false;
    taken[side] = 1;
    side_of_line.push_back(side);
    return true;
  });
  if (stray > 0) {
    warnings.push_back(fmt::format("left out {} along no side of a triangle (the first at {})",
                                   counted(stray, "line"), show_point(first_stray)));
  }
  return side_of_line;
}

/// Returns the fans, as sets of corners. Corners of triangles that share an edge at their vertex belong to
/// one fan, also at branching edges. Corner 3 t + k is at the start of side 3 t + k.
DisjointSets fans(const Mesh& mesh) {
  DisjointSets corners(3 * mesh.triangles.size());
  const auto corner_at = [&](int side, int v) {
    return side_start(mesh, side) == v ? side : next_side(side);
  };
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    const int first = side_number(mesh, edge[0]);
    for (const HalfEdge& half : edge.subspan(1))
      for (const int v : {half.lo, half.hi})
        corners.join(corner_at(first, v), corner_at(side_number(mesh, half), v));
  });
  return corners;
}

/// Gives each fan at a vertex an own vertex.
void split_vertices(Mesh& mesh, std::vector<Warning>& warnings) {
  const std::vector<int> fan = fans(mesh).roots();
  std::vector<int> vertex_of_fan(fan.size(), -1);
  std::vector<char> used(mesh.points.size(), 0);
  int splits = 0;
  Vec3 first;
  for (int c = 0; c < static_cast<int>(fan.size()); ++c) {
    if (fan[c] != c) continue;
    int& v = vertex_of_fan[c];
    v = side_start(mesh, c);
    if (!used[v]) {
      used[v] = 1;
      continue;
    }
    if (splits++ == 0) first = mesh.points[v];
    mesh.points.push_back(Vec3(mesh.points[v]));
    v = static_cast<int>(mesh.points.size()) - 1;
  }
  for (std::size_t c = 0; c < fan.size(); ++c) mesh.triangles[c / 3][c % 3] = vertex_of_fan[fan[c]];
  if (splits > 0) {
    warnings.push_back(
        fmt::format("parted the surface where it touched itself at a vertex: {} (the first at {})",
                    counted(splits, "time"), show_point(first)));
  }
}

void check_contents(const Mesh& mesh, const std::string& source) {
  if (!mesh.quads.empty()) {
    throw InputError(fmt::format("{}: {}: expected a surface made of triangles", source,
                                 counted(static_cast<long long>(mesh.quads.size()), "quad")));
  }
  if (mesh.triangles.empty())
    throw InputError(source + ": no triangles: expected a surface made of triangles");
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    throw InputError(
        fmt::format("{}: point {} at {}: expected finite coordinates", source, i + 1, show_point(p)));
  }
  if (const auto strays = stray_points(mesh); !strays.empty())
    throw InputError(fmt::format("{}: {}", source, describe(strays[0], mesh)));
}

}  // namespace

void settle_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings) {
  warn_of_branches(mesh, source, warnings);
  orient_triangles(mesh, source, warnings, true);
  const std::vector<int> side_of_line = settle_lines(mesh, warnings);
  split_vertices(mesh, warnings);
  for (size_t i = 0; i < side_of_line.size(); ++i) {
    mesh.lines[i] = {side_start(mesh, side_of_line[i]), side_end(mesh, side_of_line[i])};
  }
}

namespace {

Mesh repaired(Mesh mesh, double weld_tolerance, const std::string& source, std::vector<Warning>& warnings) {
  check_contents(mesh, source);
  if (std::string welded = weld_open_edges(mesh, weld_tolerance); !welded.empty())
    warnings.push_back(std::move(welded));
  take_out_folds(mesh, warnings);
  remove_duplicates(mesh, warnings);
  leave_out_flat(mesh, source, warnings);
  take_out_flat_copies(mesh, warnings);
  if (mesh.triangles.empty()) throw InputError(source + ": no triangle has an area");
  settle_triangles(mesh, source, warnings);
  const auto unused = std::ranges::count(drop_unused_points(mesh), -1);
  if (unused > 0) warnings.push_back("left out " + counted(unused, "point") + " that no triangle uses");
  return mesh;
}

int count_open_edges(const Mesh& mesh) {
  int n = 0;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) { n += edge.size() == 1; });
  return n;
}

/// Warns of open edges that nearly meet others, if a trial shows that welding closes some.
void report_gaps(const Mesh& mesh, const std::string& source, std::vector<Warning>& warnings) {
  constexpr double kGap = 1e-5;  // over the diagonal: smaller than any element
  const double whole = diagonal(mesh.points);
  const PointNames names = names_at_open_edges(mesh, kGap * whole);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  double widest = 0;
  int gaps = 0;
  Vec3 first;
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    const double width = norm(mesh.points[i] - mesh.points[names[i]]);
    // Both ends coincide where the surface was separated.
    if (width == 0 || !sides_of_edge(sides, i, names[i]).empty()) continue;
    if (gaps++ == 0) first = mesh.points[i];
    widest = std::max(widest, width);
  }
  if (gaps == 0) return;
  const double digit = std::pow(10, std::floor(std::log10(widest / whole)));
  const double part = std::ceil(widest / whole / digit + 0.1) * digit;
  try {
    std::vector<Warning> unheard;
    const int open = count_open_edges(mesh),
              left = count_open_edges(repaired(mesh, part * whole, source, unheard));
    if (left < open)
      warnings.push_back(fmt::format(
          "{} at open edges no more than {:.2g} from others, the first at {}: --weld {:.0e} (weld_tolerance, "
          "a part of the diagonal) closes {} of {} [near-open-edges]",
          counted(gaps, "point"), widest, show_point(first), part, open - left, counted(open, "open edge")));
  } catch (const InputError&) {
    // Welding would leave no surface.
  }
}

}  // namespace

Mesh repair_triangles(Mesh mesh, double weld_tolerance, const std::string& source,
                      std::vector<Warning>& warnings) {
  mesh = repaired(std::move(mesh), weld_tolerance, source, warnings);
  report_gaps(mesh, source, warnings);
  return mesh;
}

}  // namespace delquad
