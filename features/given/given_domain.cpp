// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/given/given_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/predicates.h"
#include "base/segment.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/tri_topology.h"
#include "geometry/mesh/turn_to_agree.h"
#include "geometry/patches/patch_outline.h"
#include "geometry/planar/arrangement.h"
#include "geometry/planar/domain_builder.h"

namespace delquad {
namespace {

Vec2 projected_to_xy(const Vec3& p) { return {p.x, p.y}; }

std::string text_of_edge(const Mesh& mesh, int a, int b) {
  const Vec3 &p = mesh.points[a], &q = mesh.points[b];
  return fmt::format("the edge from ({:.10g}, {:.10g}, {:.10g}) to ({:.10g}, {:.10g}, {:.10g})", p.x, p.y,
                     p.z, q.x, q.y, q.z);
}

/// All elements as polygons of three or four corners, triangles first.
struct Polygons {
  explicit Polygons(const Mesh& mesh) {
    for_each_element(mesh, [&](int, const auto& v) { corners.emplace_back(v.begin(), v.end()); });
    region = mesh.triangle_region;
    region.insert(region.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  }
  int next(int element, int k) const { return (k + 1) % static_cast<int>(corners[element].size()); }
  int at(int element, int k) const { return corners[element][k]; }

  std::vector<std::vector<int>> corners;
  std::vector<int> region;
};

void refuse_repeated_corners(const GivenMesh& given) {
  for_each_element(given.mesh, [&](int, auto v) {
    const Vec3 at = given.mesh.points[v[0]];
    std::ranges::sort(v);
    if (std::ranges::adjacent_find(v) != v.end())
      throw InputError(fmt::format(
          "{}: an element at ({:.10g}, {:.10g}, {:.10g}) has a corner twice: expected different corners",
          given.source, at.x, at.y, at.z));
  });
}

double area_of(const Mesh& mesh, const std::vector<int>& corners) {
  double area = 0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    area += cross(projected_to_xy(mesh.points[corners[k]]),
                  projected_to_xy(mesh.points[corners[(k + 1) % corners.size()]])) /
            2;
  return area;
}

/// Turns elements over until neighbors agree, and pieces of the mesh until their area is positive.
void turn_over(const GivenMesh& given, std::span<const HalfEdge> sides, Polygons& polygons) {
  std::vector<Neighbours> neighbours;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() > 2)
      throw InputError(fmt::format("{}: {} is in {} elements: expected at most two", given.source,
                                   text_of_edge(given.mesh, edge[0].lo, edge[0].hi), edge.size()));
    if (edge.size() == 2)
      neighbours.push_back({edge[0].element, edge[1].element, edge[0].forward != edge[1].forward});
  });
  const Turned turned = turn_to_agree(polygons.corners.size(), neighbours);
  if (turned.clash >= 0)
    throw InputError(given.source + ": the elements have no common side, as in a Moebius strip");
  for (const std::vector<int>& piece : turned.pieces) {
    double sum = 0;
    for (const int e : piece)
      sum += (turned.is_turned[e] ? -1 : 1) * area_of(given.mesh, polygons.corners[e]);
    for (const int e : piece)
      if ((turned.is_turned[e] != 0) != (sum < 0)) std::ranges::reverse(polygons.corners[e]);
  }
}

/// The edges that stay: they bound patches, or stand in one.
class FixedEdges {
 public:
  FixedEdges(const Mesh& mesh, std::span<const HalfEdge> sides, const Polygons& polygons) : mesh_(mesh) {
    neighbours_.resize(mesh.points.size());
    fences_at_.resize(mesh.points.size(), 0);
    std::set<std::pair<int, int>> lines;
    for (const auto& [a, b] : mesh.lines) lines.insert(std::minmax(a, b));
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      const auto [a, b] = std::pair{edge[0].lo, edge[0].hi};
      neighbours_[a].push_back(b);
      neighbours_[b].push_back(a);
      if (edge.size() != 2 || polygons.region[edge[0].element] != polygons.region[edge[1].element] ||
          lines.contains({a, b}))
        add(a, b);
    });
    keep_named_points();
    extend_single_edges();
  }
  bool contain(int a, int b) const { return edges_.contains(std::minmax(a, b)); }
  bool pass(int v) const { return fences_at_[v] > 0; }

 private:
  void add(int a, int b) {
    if (!edges_.insert(std::minmax(a, b)).second) return;
    ++fences_at_[a];
    ++fences_at_[b];
  }
  /// Two edges, one about opposite of the other, as one alone would enclose nothing.
  void keep_named_points() {
    for (const NamedPoint& named : mesh_.named_points) {
      if (fences_at_[named.point] > 0 || neighbours_[named.point].empty()) continue;
      const int first = neighbours_[named.point].front();
      add(named.point, first);
      extend(named.point, first);
    }
  }
  void extend_single_edges() {
    const std::set<std::pair<int, int>> edges = edges_;
    for (const auto& [a, b] : edges)
      if (fences_at_[a] == 1 && fences_at_[b] == 1) extend(b, a);
  }
  /// Goes on from v, away from `from`.
  void extend(int v, int from) {
    const auto ahead = [&](int w) {
      const Vec3 in = mesh_.points[v] - mesh_.points[from], out = mesh_.points[w] - mesh_.points[v];
      return w == from ? -2 : dot(in, out) / (norm(in) * norm(out));
    };
    add(v, *std::ranges::max_element(neighbours_[v], {}, ahead));
  }

  const Mesh& mesh_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> fences_at_;  ///< how many, by point
  std::set<std::pair<int, int>> edges_;
};

/// A side of an element, which runs from its corner to the next.
struct Side {
  int element = -1, corner = -1;
  bool operator==(const Side&) const = default;
};

/// Elements that hang together without crossing a fence, with one point for each corner of their outline.
class PatchMaker {
 public:
  PatchMaker(const GivenMesh& given, const Polygons& polygons, const FixedEdges& fences)
      : source_(given.source),
        mesh_(given.mesh),
        polygons_(polygons),
        fences_(fences),
        patch_(polygons.corners.size(), -1) {
    std::map<std::pair<int, int>, Side> side_at;
    for (std::size_t e = 0; e < polygons.corners.size(); ++e)
      for (std::size_t k = 0; k < polygons.corners[e].size(); ++k) {
        const Side side{static_cast<int>(e), static_cast<int>(k)};
        side_at[{start(side), end(side)}] = side;
      }
    twins_.resize(polygons.corners.size());
    for (std::size_t e = 0; e < polygons.corners.size(); ++e)
      for (std::size_t k = 0; k < polygons.corners[e].size(); ++k) {
        const Side side{static_cast<int>(e), static_cast<int>(k)};
        const auto found = side_at.find({end(side), start(side)});
        const bool is_fence = fences.contain(start(side), end(side));
        twins_[e].push_back(is_fence || found == side_at.end() ? Side{} : found->second);
      }
  }

  /// `node_of`: the boundary's point for each point of the mesh.
  void add_patches(const std::map<std::pair<int, int>, int>& curve_of, const std::vector<int>& node_of,
                   GivenDomain& result) {
    for (std::size_t e = 0; e < patch_.size(); ++e) {
      if (patch_[e] >= 0) continue;
      const std::vector<int> elements = collect(static_cast<int>(e));
      result.domain.patch_region.push_back(polygons_.region[e]);
      PatchBoundary& boundary = result.domain.patches.emplace_back();
      QuadPatch& quads = result.elements.emplace_back();
      std::map<std::pair<int, int>, int> point;  // of corners on the outline: element, corner
      add_outline(elements, curve_of, node_of, boundary, point);
      if (boundary.points.empty()) refuse_overlap(polygons_.at(static_cast<int>(e), 0));
      quads.points = boundary.points;
      quads.n_boundary = static_cast<int>(boundary.points.size());
      add_elements(elements, point, quads);
    }
  }

 private:
  /// The elements around a point hang together more than once.
  [[noreturn]] void refuse_overlap(int v) const {
    const Vec3& p = mesh_.points[v];
    throw InputError(
        fmt::format("{}: elements around ({:.10g}, {:.10g}, {:.10g}) cover each other [overlapping-elements]",
                    source_, p.x, p.y, p.z));
  }
  int start(const Side& s) const { return polygons_.at(s.element, s.corner); }
  int end(const Side& s) const { return start(next(s)); }
  Side next(const Side& s) const { return {s.element, polygons_.next(s.element, s.corner)}; }
  Side before(const Side& s) const {
    const int n = static_cast<int>(polygons_.corners[s.element].size());
    return {s.element, (s.corner + n - 1) % n};
  }
  const Side& twin(const Side& s) const { return twins_[s.element][s.corner]; }
  Vec2 at(int v) const { return projected_to_xy(mesh_.points[v]); }

  std::vector<int> collect(int first) {
    std::vector<int> elements{first};
    patch_[first] = first;
    for (std::size_t i = 0; i < elements.size(); ++i)
      for (const Side& across : twins_[elements[i]])
        if (across.element >= 0 && patch_[across.element] < 0) {
          patch_[across.element] = first;
          elements.push_back(across.element);
        }
    std::ranges::sort(elements);
    return elements;
  }

  using Cycle = std::vector<Side>;

  /// Round the outlines, each from its lexicographically smallest point, and those by these.
  std::vector<Cycle> cycles_of(const std::vector<int>& elements) const {
    std::set<std::pair<int, int>> done;
    std::vector<Cycle> cycles;
    for (const int e : elements)
      for (int k = 0; k < static_cast<int>(polygons_.corners[e].size()); ++k) {
        Side side{e, k};
        if (twin(side).element >= 0 || done.contains({e, k})) continue;
        Cycle cycle;
        while (done.insert({side.element, side.corner}).second) {
          cycle.push_back(side);
          side = next(side);
          while (twin(side).element >= 0) side = next(twin(side));
        }
        const auto key = [&](const Side& s) { return std::pair{at(start(s)).x, at(start(s)).y}; };
        std::ranges::rotate(cycle, std::ranges::min_element(cycle, {}, key));
        cycles.push_back(std::move(cycle));
      }
    std::ranges::stable_sort(cycles, {}, [&](const Cycle& cycle) {
      const Vec2 p = at(start(cycle[0]));
      return std::pair{p.x, p.y};
    });
    return cycles;
  }

  void add_outline(const std::vector<int>& elements, const std::map<std::pair<int, int>, int>& curve_of,
                   const std::vector<int>& node_of, PatchBoundary& boundary,
                   std::map<std::pair<int, int>, int>& point) const {
    const std::vector<Cycle> cycles = cycles_of(elements);
    std::map<std::pair<double, double>, int> visits;
    for (const Cycle& cycle : cycles)
      for (const Side& side : cycle) ++visits[{at(start(side)).x, at(start(side)).y}];
    for (const Cycle& cycle : cycles) {
      const int n = static_cast<int>(cycle.size()), base = static_cast<int>(boundary.points.size());
      for (int i = 0; i < n; ++i) {
        const Side& side = cycle[i];
        const Vec2 p = at(start(side));
        const int back = start(cycle[(i + n - 1) % n]);
        boundary.points.push_back(
            visits.at({p.x, p.y}) > 1 ? p + into_corner(at(back), p, at(end(side)), kOpening) : p);
        boundary.point_node.push_back(node_of[start(side)]);
        boundary.edges.push_back({base + i, base + (i + 1) % n});
        const auto curve = curve_of.find(std::minmax(start(side), end(side)));
        boundary.edge_curve.push_back(curve == curve_of.end() ? -1 : curve->second);
        // All elements at this corner.
        for (Side s = side; s.element >= 0; s = twin(before(s))) point[{s.element, s.corner}] = base + i;
      }
    }
  }

  void add_elements(const std::vector<int>& elements, const std::map<std::pair<int, int>, int>& on_outline,
                    QuadPatch& patch) const {
    std::map<int, std::vector<Side>> inside;  // corners by point
    for (const int e : elements)
      for (int k = 0; k < static_cast<int>(polygons_.corners[e].size()); ++k)
        if (const int v = polygons_.at(e, k); !fences_.pass(v))
          inside[v].push_back({e, k});
        else if (!on_outline.contains({e, k}))
          refuse_overlap(v);
    std::map<int, int> point;
    for (const auto& [v, corners] : inside) {
      std::size_t around = 0;
      Side side = corners[0];
      do {
        side = twin(before(side));
        ++around;
      } while (side.element >= 0 && side != corners[0] && around <= corners.size());
      if (around != corners.size()) refuse_overlap(v);
      point[v] = static_cast<int>(patch.points.size());
      patch.points.push_back(at(v));
    }
    for (const int e : elements) {
      std::array<int, 4> v{};
      const int n = static_cast<int>(polygons_.corners[e].size());
      for (int k = 0; k < n; ++k)
        v[k] = fences_.pass(polygons_.at(e, k)) ? on_outline.at({e, k}) : point.at(polygons_.at(e, k));
      if (n == 4)
        patch.quads.push_back(v);
      else
        patch.triangles.push_back({v[0], v[1], v[2]});
    }
  }

  const std::string& source_;
  const Mesh& mesh_;
  const Polygons& polygons_;
  const FixedEdges& fences_;
  std::vector<int> patch_;
  std::vector<std::vector<Side>> twins_;  ///< of each side of each element; none across a fence
};

/// Edges of one element must not meet but in common nodes: a hanging node lies on an edge.
void check_free_edges(const GivenMesh& given, std::span<const HalfEdge> sides) {
  constexpr double kRounding = 1e-16;  // part of the diagonal
  const double least = kRounding * diagonal(given.mesh);
  std::map<std::pair<double, double>, int> place;
  std::vector<Vec2> points;
  std::set<std::pair<int, int>> edges;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 1) return;
    std::array<int, 2> ends{};
    for (int k = 0; k < 2; ++k) {
      const Vec2 p = projected_to_xy(given.mesh.points[k == 0 ? edge[0].lo : edge[0].hi]);
      const auto [at, is_new] = place.try_emplace({p.x, p.y}, static_cast<int>(points.size()));
      if (is_new) points.push_back(p);
      ends[k] = at->second;
    }
    if (norm(points[ends[1]] - points[ends[0]]) <= least)
      throw InputError(given.source + ": " + text_of_edge(given.mesh, edge[0].lo, edge[0].hi) +
                       " has no length: expected different nodes");
    edges.insert(std::minmax(ends[0], ends[1]));
  });
  std::vector<std::array<int, 2>> lines;
  for (const auto& [a, b] : edges) lines.push_back({a, b});
  const Arrangement arrangement = arrange(points, lines);
  if (!arrangement.conflict) return;
  const auto text = [&](int line) {
    const Vec2 a = points[lines[line][0]], b = points[lines[line][1]];
    return fmt::format("from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g})", a.x, a.y, b.x, b.y);
  };
  const auto [i, j] = *arrangement.conflict;
  throw InputError(
      fmt::format("{}: the edges {} and {}, which are in one element each, meet in more than "
                  "common nodes: a hanging node, or elements that overlap [hanging-node]",
                  given.source, text(i), text(j)));
}

/// Whether one loop runs counterclockwise, and all others, around holes, clockwise. Loops stand one after the
/// other.
bool runs_round_one_piece(const PatchBoundary& patch) {
  const auto place = [&](std::size_t i) { return std::pair{patch.points[i].x, patch.points[i].y}; };
  int outlines = 0;
  for (std::size_t first = 0, end = 0; first < patch.edges.size(); first = end) {
    while (patch.edges[end][1] != static_cast<int>(first)) ++end;
    ++end;
    std::size_t least = first;  // there the loop is convex
    for (std::size_t i = first; i < end; ++i)
      if (place(i) < place(least)) least = i;
    const std::size_t before = least == first ? end - 1 : least - 1,
                      after = least + 1 == end ? first : least + 1;
    outlines += orient2d(patch.points[before], patch.points[least], patch.points[after]) > 0;
  }
  return outlines == 1;
}

/// Lines of the mesh that are edges, with their points and the points of other fences; returns the node of
/// each point.
std::vector<int> make_boundary(const GivenMesh& given, std::span<const HalfEdge> sides,
                               const FixedEdges& fences, std::map<std::pair<int, int>, int>& curve_of,
                               GivenDomain& result) {
  const Mesh& mesh = given.mesh;
  Mesh& boundary = result.domain.boundary;
  boundary.curves = mesh.curves;
  boundary.regions = mesh.regions;
  boundary.unit = mesh.unit;
  std::vector<char> used(mesh.points.size(), 0);
  for (const HalfEdge& side : sides) used[side.lo] = used[side.hi] = 1;
  std::vector<int> node_of(mesh.points.size(), -1);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (!used[v] || !fences.pass(static_cast<int>(v))) continue;
    node_of[v] = static_cast<int>(boundary.points.size());
    boundary.points.push_back(mesh.points[v]);
    boundary.points.back().z = boundary.points.front().z;
  }
  int lost = 0;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    if (sides_of_edge(sides, a, b).empty() ||
        !curve_of.try_emplace(std::minmax(a, b), mesh.line_curve[l]).second) {
      ++lost;
      continue;
    }
    boundary.lines.push_back({node_of[a], node_of[b]});
    boundary.line_curve.push_back(mesh.line_curve[l]);
  }
  if (lost > 0)
    result.warnings.push_back(fmt::format(
        "{}: {} lines are left out: they are no edges of elements, or duplicates", given.source, lost));
  for (const NamedPoint& named : mesh.named_points)
    if (node_of[named.point] >= 0) boundary.named_points.push_back({node_of[named.point], named.entity});
  if (const auto unused = std::ranges::count(used, 0); unused > 0)
    result.warnings.push_back(
        fmt::format("{}: {} points are left out: no element uses them", given.source, unused));
  return node_of;
}

}  // namespace

GivenDomain make_given_domain(const GivenMesh& given) {
  refuse_repeated_corners(given);
  const std::vector<HalfEdge> sides = sorted_half_edges(given.mesh);
  check_free_edges(given, sides);
  Polygons polygons(given.mesh);
  turn_over(given, sides, polygons);
  const FixedEdges fences(given.mesh, sides, polygons);
  GivenDomain result;
  std::map<std::pair<int, int>, int> curve_of;
  const std::vector<int> node_of = make_boundary(given, sides, fences, curve_of, result);
  result.domain.has_junctions = true;
  PatchMaker(given, polygons, fences).add_patches(curve_of, node_of, result);
  for (const PatchBoundary& patch : result.domain.patches)
    if (!runs_round_one_piece(patch) || !meshable(patch))
      throw InputError(
          fmt::format("{}: the outline through ({:.10g}, {:.10g}) crosses itself or is turned inside "
                      "out: elements cover each other [overlapping-elements]",
                      given.source, patch.points[0].x, patch.points[0].y));
  return result;
}

std::vector<double> sizes_of_elements(const Mesh& mesh, const std::string& source) {
  constexpr int kRings = 2;
  struct Share {
    double area = 0, quads = 0;
  };
  std::vector<Share> shares(mesh.points.size());
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<Share> wider(mesh.points.size());
    for_each_element(mesh, [&](int, const auto& v) {
      Share share;
      if (ring == 0) {
        Vec3 twice;
        for (std::size_t k = 2; k < v.size(); ++k)
          twice =
              twice + cross(mesh.points[v[k - 1]] - mesh.points[v[0]], mesh.points[v[k]] - mesh.points[v[0]]);
        share = {norm(twice) / 2, static_cast<double>(v.size()) - 2};
      }
      for (const int i : v) share = {share.area + shares[i].area, share.quads + shares[i].quads};
      for (const int i : v) wider[i] = {wider[i].area + share.area, wider[i].quads + share.quads};
    });
    shares = std::move(wider);
  }
  std::vector<double> sizes;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    // A square is two triangles.
    sizes.push_back(shares[i].quads > 0 ? std::sqrt(2 * shares[i].area / shares[i].quads) : 1);
    if (const Vec3& p = mesh.points[i]; !(sizes.back() > 0) || !std::isfinite(sizes.back()))
      throw InputError(
          fmt::format("{}: the elements around ({:.10g}, {:.10g}, {:.10g}) have no area: expected a "
                      "size (a number or an expression)",
                      source, p.x, p.y, p.z));
  }
  return sizes;
}

namespace {

/// The halves of a quad, by the diagonal that leaves the better worst angle; inverted ones where it has none.
std::array<std::array<int, 3>, 2> halves(const std::vector<Vec2>& points, const std::array<int, 4>& v) {
  const auto [a, b, c, d] = v;
  const auto worst = [&](const std::array<std::array<int, 3>, 2>& pair) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& t : pair)
      for (int k = 0; k < 3; ++k) {
        const Vec2 u = points[t[(k + 1) % 3]] - points[t[k]], w = points[t[(k + 2) % 3]] - points[t[k]];
        least = std::min(least, std::atan2(cross(u, w), dot(u, w)));
      }
    return least;
  };
  const std::array<std::array<int, 3>, 2> one{{{a, b, c}, {a, c, d}}}, other{{{a, b, d}, {b, c, d}}};
  return worst(one) >= worst(other) ? one : other;
}

TriPatch as_triangles(const QuadPatch& elements) {
  TriPatch tri{elements.points, elements.triangles, {}, elements.n_boundary};
  for (const auto& quad : elements.quads)
    for (const auto& half : halves(elements.points, quad)) tri.triangles.push_back(half);
  int inverted = 0;
  Vec2 first;
  for (const auto& [a, b, c] : tri.triangles) {
    if (orient2d(tri.points[a], tri.points[b], tri.points[c]) > 0) continue;
    if (inverted++ == 0) first = tri.points[a];
  }
  if (inverted > 0)
    throw InputError(
        fmt::format("{} triangles or halves of quads are inverted or flat, the first at ({:.10g}, {:.10g}). "
                    "A pipeline that begins with C or O repairs meshes of quads alone [inverted-triangles]",
                    inverted, first.x, first.y));
  link_neighbours(tri);
  return tri;
}

}  // namespace

PatchMesh start_from(const QuadPatch& elements, PatchForm form) {
  PatchMesh start;
  start.form = form;
  if (form == PatchForm::kTriangles) start.triangles = as_triangles(elements);
  if (form == PatchForm::kQuads) {
    if (elements.quads.empty())
      throw InputError(
          fmt::format("a region has {} triangles and no quads: a pipeline that begins with B merges them",
                      elements.triangles.size()));
    start.quads = elements;
  }
  return start;
}

}  // namespace delquad
