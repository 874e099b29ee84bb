// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/given/given_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "base/box_tree.h"
#include "base/disjoint_sets.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/patches/surface_curves.h"
#include "geometry/surface/triangle_repair.h"
#include "geometry/surface/triangulated_model.h"
#include "metrics/shape.h"

namespace delquad {
namespace {

/// Rounding of coordinates, in diagonals of the mesh.
constexpr double kGivenRounding = 1e-9;
/// Angles below this, in radians, leave an element no area.
constexpr double kFlatAngle = 1e-9;

std::string text_of_place(const Vec3& p) { return fmt::format("({:.10g}, {:.10g}, {:.10g})", p.x, p.y, p.z); }

[[noreturn]] void refuse_element(const GivenMesh& given, const Vec3& at, const char* why) {
  throw InputError(fmt::format("{}: an element at {} {}", given.source, text_of_place(at), why));
}

/// The least angle of a triangle, less than 0 where it is turned against `up`.
double least_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& up) {
  const std::array<Vec3, 3> p{a, b, c};
  const double sign = dot(cross(b - a, c - a), up) < 0 ? -1 : 1;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3 u = p[(k + 1) % 3] - p[k], w = p[(k + 2) % 3] - p[k];
    least = std::min(least, sign * std::atan2(norm(cross(u, w)), dot(u, w)));
  }
  return least;
}

}  // namespace

std::pair<QuadHalves, double> halves_of(const std::array<Vec3, 4>& p, bool first_is_free,
                                        bool second_is_free) {
  constexpr QuadHalves kFirst{{{0, 1, 2}, {0, 2, 3}}}, kSecond{{{0, 1, 3}, {1, 2, 3}}};
  const Vec3 up = cross(p[2] - p[0], p[3] - p[1]);
  const auto worst = [&](const QuadHalves& halves) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : halves) least = std::min(least, least_angle(p[a], p[b], p[c], up));
    return least;
  };
  const double first = worst(kFirst), second = worst(kSecond);
  const bool takes_first = first_is_free == second_is_free ? first >= second : first_is_free;
  return takes_first ? std::pair{kFirst, first} : std::pair{kSecond, second};
}

namespace {

/// Refuses what no word can begin from, element by element.
void check_given_elements(const GivenMesh& given) {
  const Mesh& mesh = given.mesh;
  std::vector<std::pair<std::array<int, 4>, int>> by_corners;
  for_each_element(mesh, [&](int element, const auto& v) {
    std::array<int, 4> corners{-1, -1, -1, -1};
    std::ranges::copy(v, corners.begin());
    std::ranges::sort(corners);
    const Vec3& at = mesh.points[v[0]];
    for (const int i : v)
      if (const Vec3& p = mesh.points[i]; !std::isfinite(p.x + p.y + p.z))
        refuse_element(given, p, "has a coordinate that is not finite");
    if (std::ranges::adjacent_find(corners.end() - static_cast<std::ptrdiff_t>(v.size()), corners.end()) !=
        corners.end())
      refuse_element(given, at, "has a corner twice");
    by_corners.emplace_back(corners, element);
  });
  std::ranges::sort(by_corners);
  const auto twin = std::ranges::adjacent_find(by_corners, {}, &std::pair<std::array<int, 4>, int>::first);
  if (twin != by_corners.end()) refuse_element(given, mesh.points[twin->first.back()], "is there twice");
}

/// An edge of one element must not have nodes of others between its ends.
void refuse_hanging_nodes(const GivenMesh& given, std::span<const HalfEdge> sides) {
  const Mesh& mesh = given.mesh;
  std::vector<std::array<int, 2>> edges;
  std::set<int> ends;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 1) return;
    edges.push_back({edge[0].lo, edge[0].hi});
    ends.insert({edge[0].lo, edge[0].hi});
  });
  const std::vector<int> nodes(ends.begin(), ends.end());
  std::vector<Box<Vec3>> boxes;
  for (const int v : nodes) boxes.push_back({mesh.points[v], mesh.points[v]});
  const BoxTree<Vec3> tree(boxes);
  const double tolerance = kGivenRounding * diagonal(mesh);
  for (const auto& [a, b] : edges) {
    const Vec3 &p = mesh.points[a], &q = mesh.points[b], along = q - p, middle = 0.5 * (p + q);
    const double length = norm(along), limit = length * length / 4;
    if (!(length > 0))
      throw InputError(fmt::format("{}: the edge at {} has no length: expected different nodes, or --weld",
                                   given.source, text_of_place(p)));
    tree.nearest(middle, limit, [&](int i) {
      const Vec3 from_start = mesh.points[nodes[i]] - p;
      const double s = dot(from_start, along) / length;
      if (s <= tolerance || s >= length - tolerance) return;
      if (norm(from_start - (s / length) * along) > tolerance) return;
      throw InputError(fmt::format(
          "{}: the node {} lies on the edge from {} to {}, which is in one element: a hanging node "
          "[hanging-node]",
          given.source, text_of_place(mesh.points[nodes[i]]), text_of_place(p), text_of_place(q)));
    });
  }
}

/// Lines that are edges, once each, and points of elements. Tells of what goes.
void drop_what_no_element_has(const GivenMesh& given, std::span<const HalfEdge> sides, Mesh& mesh,
                              std::vector<Warning>& warnings) {
  mesh.order = 1, mesh.line_nodes.clear(), mesh.quad_nodes.clear();
  std::set<std::pair<int, int>> seen;
  const std::size_t gone = keep_lines(mesh, [&](std::size_t l) {
    const auto [a, b] = mesh.lines[l];
    return !sides_of_edge(sides, a, b).empty() && seen.insert(std::minmax({a, b})).second;
  });
  if (gone > 0)
    warnings.push_back(fmt::format("{}: {} lines are left out: they are no edges of elements, or duplicates",
                                   given.source, gone));
  mesh.periodic.clear();
  if (const auto unused = std::ranges::count(drop_unused_points(mesh), -1); unused > 0)
    warnings.push_back(fmt::format("{}: {} points are left out: no element uses them", given.source, unused));
}

bool is_sound(const Mesh& mesh, int q) {
  const auto corners = corners_of(mesh, mesh.quads[q]);
  const Vec3 side = area_vector(corners);
  return is_sound_quad(corners, side, element_shape(corners, side));
}

/// Below 0 the more a quad is inverted or folded, else its scaled Jacobian.
double soundness_of(const Mesh& mesh, int q) {
  const auto corners = corners_of(mesh, mesh.quads[q]);
  return std::min(element_shape(corners, area_vector(corners)).scaled_jacobian, kFold - quad_warp(corners));
}

/// Moves nodes of quads that are inverted, folded or without area towards the middle of their neighbors,
/// over the other elements. Nodes on lines, at named points, between regions, and on edges sharper than the
/// feature angle stay.
class BadQuadOpening {
 public:
  BadQuadOpening(double feature_angle, Mesh& mesh)
      : mesh_(mesh), stays_(mesh.points.size(), 0), around_(stays_.size()), quads_at_(stays_.size()) {
    for (std::size_t q = 0; q < mesh.quads.size(); ++q)
      if (const int i = static_cast<int>(q); !is_sound(mesh, i)) bad_.push_back(i);
    if (bad_.empty()) return;
    find_neighbours();
    find_facets(feature_angle * std::numbers::pi / 180);
  }

  void run(const std::string& source, std::vector<Warning>& warnings) {
    if (bad_.empty()) return;
    constexpr int kSweeps = 20;
    const Vec3 first = mesh_.points[mesh_.quads[bad_[0]][0]];
    bool moves = facets_.has_value();
    for (int sweep = 0; sweep < kSweeps && moves; ++sweep) {
      moves = false;
      for (const int q : bad_)
        for (const int v : mesh_.quads[q]) moves = (!stays_[v] && improve(v)) || moves;
    }
    const auto left = std::ranges::count_if(bad_, [&](int q) { return !is_sound(mesh_, q); });
    warnings.push_back(
        fmt::format("{}: {} quads are inverted, folded or without area, the first at {}. Moving their nodes "
                    "repairs {} of them",
                    source, bad_.size(), text_of_place(first), static_cast<long>(bad_.size()) - left));
  }

 private:
  void find_neighbours() {
    for_each_edge(sorted_half_edges(mesh_), [&](std::span<const HalfEdge> edge) {
      const int a = edge[0].lo, b = edge[0].hi;
      around_[a].push_back(b);
      around_[b].push_back(a);
      if (edge.size() != 2 || region_of(mesh_, edge[0].element) != region_of(mesh_, edge[1].element))
        stays_[a] = stays_[b] = 1;
    });
    for (const auto& line : mesh_.lines)
      for (const int v : line) stays_[v] = 1;
    for (const NamedPoint& named : mesh_.named_points) stays_[named.point] = 1;
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
      for (const int v : mesh_.quads[q]) quads_at_[v].push_back(static_cast<int>(q));
  }
  void find_facets(double feature_angle) {
    std::vector<std::array<int, 3>> facets = mesh_.triangles;
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
      if (const auto [a, b, c, d] = mesh_.quads[q]; !std::ranges::binary_search(bad_, static_cast<int>(q)))
        facets.insert(facets.end(), {{a, b, c}, {a, c, d}});
    std::vector<std::vector<Vec3>> normals(mesh_.points.size());
    for (const auto& facet : facets)
      for (const int v : facet) normals[v].push_back(area_vector(corners_of(mesh_, facet)));
    for (std::size_t v = 0; v < normals.size(); ++v)
      for (const Vec3& n : normals[v])
        // Elements may run either way round.
        if (std::atan2(norm(cross(n, normals[v][0])), std::abs(dot(n, normals[v][0]))) > feature_angle)
          stays_[v] = 1;
    if (!facets.empty()) facets_.emplace(mesh_.points, std::move(facets));
  }
  double worst_around(int v) const {
    double worst = 1;
    for (const int q : quads_at_[v]) worst = std::min(worst, soundness_of(mesh_, q));
    return worst;
  }
  /// Tries places on the way to the middle of the neighbors.
  bool improve(int v) {
    Vec3 middle;
    for (const int w : around_[v])
      middle = middle + (1.0 / static_cast<double>(around_[v].size())) * mesh_.points[w];
    const Vec3 start = mesh_.points[v];
    Vec3 best = start;
    double worst = worst_around(v);
    for (const double part : {1.0, 0.5, 0.25}) {
      const auto found = facets_->find(start + part * (middle - start));
      const auto& [a, b, c] = facets_->triangle(found.triangle);
      mesh_.points[v] =
          found.weights[0] * at_first_[a] + found.weights[1] * at_first_[b] + found.weights[2] * at_first_[c];
      if (const double now = worst_around(v); now > worst) worst = now, best = mesh_.points[v];
    }
    mesh_.points[v] = best;
    return norm(best - start) > 0;
  }

  Mesh& mesh_;
  const std::vector<Vec3> at_first_ = mesh_.points;
  std::vector<char> stays_;
  std::vector<std::vector<int>> around_, quads_at_;
  std::vector<int> bad_;  ///< quads, ascending
  std::optional<NearestTriangle> facets_;
};

/// The elements of a mesh as triangles, on the same points.
struct Triangulation {
  Mesh mesh;
  std::vector<int> element;                 ///< as in GivenSurface
  std::vector<std::array<int, 4>> corners;  ///< as in GivenSurface
};

/// In a plane elements need no area.
Triangulation triangulate(const GivenMesh& given, const Mesh& elements, bool in_plane) {
  Triangulation fine{lines_of(elements), {}, {}};
  Mesh& mesh = fine.mesh;
  const auto add = [&](const std::array<int, 3>& triangle, int element) {
    mesh.triangles.push_back(triangle);
    mesh.triangle_region.push_back(region_of(elements, element));
    fine.element.push_back(element);
  };
  const std::vector<HalfEdge> sides = sorted_half_edges(elements);
  std::set<std::pair<int, int>> diagonals;
  for_each_element(elements, [&](int element, const auto& v) {
    const auto at = corners_of(elements, v);
    double angle = 0;
    fine.corners.push_back({-1, -1, -1, -1});
    std::ranges::copy(v, fine.corners.back().begin());
    if constexpr (at.size() == 3) {
      angle = least_angle(at[0], at[1], at[2], area_vector(at));
      add(v, element);
    } else {
      const auto is_free = [&](int k) {
        return sides_of_edge(sides, v[k], v[k + 2]).empty() &&
               !diagonals.contains(std::minmax({v[k], v[k + 2]}));
      };
      const auto [halves, worst] = halves_of(at, is_free(0), is_free(1));
      angle = std::abs(worst);
      diagonals.insert(std::minmax({v[halves[1][0]], v[halves[0][2]]}));
      for (const auto& [a, b, c] : halves) add({v[a], v[b], v[c]}, element);
    }
    if (!in_plane && !(angle > kFlatAngle)) refuse_element(given, at[0], "has no area");
  });
  return fine;
}

/// Turns the pieces of a mesh in a plane so that their areas are positive.
void face_upwards(Mesh& mesh) {
  DisjointSets pieces(mesh.triangles.size());
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2) pieces.join(edge[0].element, edge[1].element);
  });
  const std::vector<int> piece = pieces.roots();
  std::vector<double> area(piece.size(), 0);
  for (std::size_t t = 0; t < piece.size(); ++t) area[piece[t]] += area_vector(mesh, t).z;
  for (std::size_t t = 0; t < piece.size(); ++t)
    if (area[piece[t]] < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

/// Neighbors agree afterwards; elements may run either way round.
void turn(Triangulation& fine, const std::string& source, bool in_plane) {
  const std::vector<std::array<int, 3>> before = fine.mesh.triangles;
  std::vector<Warning> turned;
  orient_triangles(fine.mesh, source, turned);
  if (in_plane) face_upwards(fine.mesh);
  for (std::size_t t = 0; t < before.size(); ++t) {
    if (fine.mesh.triangles[t] == before[t] || (t > 0 && fine.element[t] == fine.element[t - 1])) continue;
    auto& v = fine.corners[fine.element[t]];
    std::reverse(v.begin(), v.end() - (v[3] < 0 ? 1 : 0));
  }
}

/// Returns the surface of elements that were checked.
GivenSurface surface_of(const GivenMesh& given, const Mesh& elements, double feature_angle, bool in_plane) {
  Triangulation made = triangulate(given, elements, in_plane);
  turn(made, given.source, in_plane);
  TriangulatedOptions options;
  options.source = given.source;
  options.feature_angle = feature_angle;
  KeptModel kept = make_kept_model(made.mesh, made.element, options);
  GivenSurface surface{std::move(kept.model),       std::move(made.element),      std::move(made.corners),
                       std::move(kept.given_curve), std::move(kept.given_region), {}};
  const Mesh& fine = surface.model.fine;
  surface.given_point.resize(fine.points.size());
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int point = made.mesh.triangles[t][k], copy = fine.triangles[t][k];
      surface.given_point[copy] = point;
      std::ranges::replace(surface.corners[surface.element[t]], point, copy);
    }
  return surface;
}

}  // namespace

GivenSurface make_given_surface(const GivenMesh& given, double feature_angle) {
  check_given_elements(given);
  Mesh mesh = given.mesh;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  refuse_hanging_nodes(given, sides);
  std::vector<Warning> warnings;
  drop_what_no_element_has(given, sides, mesh, warnings);
  BadQuadOpening(feature_angle, mesh).run(given.source, warnings);
  GivenSurface surface = surface_of(given, mesh, feature_angle, false);
  surface.model.warnings.insert(surface.model.warnings.begin(), warnings.begin(), warnings.end());
  return surface;
}

GivenSurface make_flat_surface(GivenMesh& given) {
  constexpr double kNoFeatures = 180;
  check_given_elements(given);
  std::vector<Warning> warnings;
  const std::vector<HalfEdge> sides = sorted_half_edges(given.mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() > 2)
      throw InputError(fmt::format("{}: the edge from {} to {} is in {} elements: expected at most two",
                                   given.source, text_of_place(given.mesh.points[edge[0].lo]),
                                   text_of_place(given.mesh.points[edge[0].hi]), edge.size()));
  });
  drop_what_no_element_has(given, sides, given.mesh, warnings);
  GivenSurface surface = surface_of(given, given.mesh, kNoFeatures, true);
  surface.model.warnings = std::move(warnings);
  return surface;
}

Mesh lines_of(const Mesh& mesh) {
  Mesh lines;
  lines.points = mesh.points;
  lines.lines = mesh.lines;
  lines.line_curve = mesh.line_curve;
  lines.curves = mesh.curves;
  lines.regions = mesh.regions;
  lines.named_points = mesh.named_points;
  lines.unit = mesh.unit;
  return lines;
}

void add_elements(const GivenSurface& surface, std::span<const int> fine_triangles,
                  std::span<const std::array<int, 3>> triangles, std::span<const int> point,
                  QuadPatch& patch) {
  // Both halves of a quad are here.
  std::map<int, std::array<int, 4>> elements;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int element = surface.element[fine_triangles[t]];
    auto& v = elements.try_emplace(element, std::array{-1, -1, -1, -1}).first->second;
    for (int k = 0; k < 3; ++k) {
      const auto& corners = surface.corners[element];
      const int corner = surface.model.fine.triangles[fine_triangles[t]][k];
      v[std::ranges::find(corners, corner) - corners.begin()] = point[triangles[t][k]];
    }
  }
  for (const auto& [element, v] : elements)
    if (v[3] < 0)
      patch.triangles.push_back({v[0], v[1], v[2]});
    else
      patch.quads.push_back(v);
}

QuadPatch elements_within(const GivenSurface& surface, const SurfacePatch& patch, std::vector<Vec3>& inside) {
  const TriPatch& flat = patch.map.flat;
  QuadPatch result;
  result.points = patch.boundary.points;
  result.n_boundary = static_cast<int>(result.points.size());
  std::vector<int> point(flat.points.size(), -1);
  int next = 0;
  for (const auto& loop : patch.outline)
    for (const CurveSide& side : loop) point[side.from] = next++;
  for (std::size_t i = 0; i < flat.points.size(); ++i) {
    if (point[i] >= 0) continue;
    point[i] = static_cast<int>(result.points.size());
    result.points.push_back(flat.points[i]);
    inside.push_back(surface.model.fine.points[patch.map.fine_node[i]]);
  }
  add_elements(surface, patch.map.fine_triangle, flat.triangles, point, result);
  return result;
}

namespace {

/// All points of the curves as nodes.
SurfaceNodes nodes_at_points(const Mesh& fine, const std::vector<CurveChain>& chains) {
  std::vector<int> node(fine.points.size(), -1);
  for (const CurveChain& chain : chains)
    for (const int v : chain.points) node[v] = 0;
  SurfaceNodes nodes;
  for (std::size_t v = 0; v < node.size(); ++v) {
    if (node[v] < 0) continue;
    node[v] = static_cast<int>(nodes.points.size());
    nodes.points.push_back(fine.points[v]);
  }
  for (const CurveChain& chain : chains) {
    auto& on_curve = nodes.on_curve.emplace_back();
    for (std::size_t i = 0; i < chain.points.size(); ++i)
      on_curve.push_back({static_cast<double>(i), node[chain.points[i]]});
  }
  return nodes;
}

}  // namespace

SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size) {
  SurfaceCurves curves = find_curves(model, std::move(flattening), size);
  SurfaceDomain domain;
  domain.nodes = nodes_at_points(model.fine, curves.chains);
  domain.sharp_corners =
      find_sharp_corners(curves.corners, curves.chains, curves.maps, domain.nodes, kBadEta);
  domain.patches.resize(curves.maps.size());
  for_each_patch(model.fine, curves.maps, [&](std::size_t p) {
    SurfacePatch& patch = domain.patches[p];
    patch.background = std::make_shared<BackgroundMesh>(curves.maps[p].flat);
    patch.boundary = place_boundary(curves.maps[p], curves.outlines[p], curves.chains, domain.nodes);
    patch.map = std::move(curves.maps[p]);
    patch.outline = std::move(curves.outlines[p]);
  });
  for (const SurfacePatch& patch : domain.patches)
    if (patch.boundary.edges.size() % 2 != 0)
      domain.warnings.push_back({"faces with an odd boundary", 0,
                                 face_name(model.fine, patch.map) + " has an odd number of boundary edges"});
  domain.boundary = boundary_mesh(model.fine, curves.chains, domain.nodes);
  for (const CurveChain& chain : curves.chains)
    domain.chain_stays.push_back(curves.cut_face[chain.curve] < 0 ? 1 : 0);
  domain.chains = std::move(curves.chains);
  domain.cut_face = std::move(curves.cut_face);
  return domain;
}

}  // namespace delquad
