// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/given/given_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/predicates.h"
#include "base/segment.h"
#include "features/given/given_surface.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/tri_topology.h"
#include "geometry/planar/arrangement.h"
#include "geometry/planar/domain_builder.h"
#include "geometry/surface/chart.h"

namespace delquad {
namespace {

/// Throws InputError unless outlines meet in common places alone, and each patch is a face of their lines.
void check_outlines(const PlanarDomain& domain, const std::string& source) {
  constexpr int kNone = -1;
  constexpr double kRounding = 1e-16;  // part of the diagonal
  const double least = kRounding * diagonal(domain.boundary);
  std::map<std::pair<double, double>, int> point_at;
  std::vector<Vec2> points;
  std::map<std::pair<int, int>, int> line_at;
  std::vector<std::array<int, 2>> lines;
  std::vector<int> patch_at;  // on the left of each side, see Arrangement
  const auto text = [&](int p) { return fmt::format("({:.10g}, {:.10g})", points[p].x, points[p].y); };
  const auto refuse_overlap = [&](int p) {
    throw InputError(
        fmt::format("{}: elements around {} cover each other, or their outline is turned inside "
                    "out [overlapping-elements]",
                    source, text(p)));
  };
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    for (const auto& edge : domain.patches[p].edges) {
      std::array<int, 2> ends{};
      for (const int k : {0, 1}) {
        const Vec3& x = domain.boundary.points[domain.patches[p].point_node[edge[k]]];
        const auto [at, is_new] = point_at.try_emplace({x.x, x.y}, static_cast<int>(points.size()));
        if (is_new) points.push_back({x.x, x.y});
        ends[k] = at->second;
      }
      if (norm(points[ends[1]] - points[ends[0]]) <= least)
        throw InputError(fmt::format("{}: the edge from {} to {} has no length: expected different nodes",
                                     source, text(ends[0]), text(ends[1])));
      const auto [line, is_new] =
          line_at.try_emplace(std::minmax(ends[0], ends[1]), static_cast<int>(lines.size()));
      if (is_new) lines.push_back(ends), patch_at.insert(patch_at.end(), 2, kNone);
      int& here = patch_at[2 * line->second + (lines[line->second] == ends ? 0 : 1)];
      if (here != kNone) refuse_overlap(ends[0]);
      here = static_cast<int>(p);
    }
  const Arrangement arrangement = arrange(points, lines);
  if (arrangement.conflict) {
    const auto [i, j] = *arrangement.conflict;
    throw InputError(
        fmt::format("{}: the edges from {} to {} and from {} to {}, which bound regions, meet in more than "
                    "common nodes: a hanging node, or elements that overlap [hanging-node]",
                    source, text(lines[i][0]), text(lines[i][1]), text(lines[j][0]), text(lines[j][1])));
  }
  std::map<int, int> patch_in{{-1, kNone}}, face_of;
  for (std::size_t s = 0; s < patch_at.size(); ++s) {
    const int face = arrangement.face_of[s], patch = patch_at[s];
    if (patch_in.try_emplace(face, patch).first->second != patch ||
        (patch != kNone && face_of.try_emplace(patch, face).first->second != face))
      refuse_overlap(start_of(lines, static_cast<int>(s)));
  }
}

/// Returns the nodes on the outlines of patches, in a plane, with the given lines. `node` gets the node of
/// each fine point.
Mesh make_boundary(const Mesh& mesh, const GivenSurface& surface, std::vector<int>& node) {
  Mesh boundary = lines_of(mesh);
  boundary.lines.clear();
  for (const auto& [a, b] : surface.model.fine.lines)
    boundary.lines.push_back({surface.given_point[a], surface.given_point[b]});
  const std::vector<int> node_of = drop_unused_points(boundary);
  boundary.lines.clear();
  for (const auto& [a, b] : mesh.lines) boundary.lines.push_back({node_of[a], node_of[b]});
  for (Vec3& p : boundary.points) p.z = boundary.points[0].z;
  for (const int v : surface.given_point) node.push_back(node_of[v]);
  return boundary;
}

/// Returns the outline of a chart, as in make_domain(). `point` gets the outline's point of each vertex; -1:
/// it is inside.
PatchBoundary outline_of(const Chart& chart, const std::vector<int>& node,
                         const std::map<std::pair<int, int>, int>& curve_of, std::vector<int>& point) {
  const auto at = [&](int v) { return Vec2{chart.points[v].x, chart.points[v].y}; };
  const auto place = [&](int v) { return std::pair{at(v).x, at(v).y}; };
  std::map<std::pair<double, double>, int> visits;
  for (int v = 0; v < chart.n_boundary; ++v) ++visits[place(v)];
  std::vector<std::vector<int>> loops = chart.loops;
  for (auto& loop : loops) std::ranges::rotate(loop, std::ranges::min_element(loop, {}, place));
  std::ranges::stable_sort(loops, {}, [&](const auto& loop) { return place(loop[0]); });
  PatchBoundary patch;
  for (const auto& loop : loops) {
    const int n = static_cast<int>(loop.size()), base = static_cast<int>(patch.points.size());
    for (int i = 0; i < n; ++i) {
      const int v = loop[i], ahead = loop[(i + 1) % n];
      point[v] = base + i;
      patch.points.push_back(at(v));
      if (visits.at(place(v)) > 1)
        patch.points.back() += into_corner(at(loop[(i + n - 1) % n]), at(v), at(ahead), kOpening);
      patch.point_node.push_back(node[chart.fine_node[v]]);
      patch.edges.push_back({base + i, base + (i + 1) % n});
      const auto curve = curve_of.find(std::minmax(node[chart.fine_node[v]], node[chart.fine_node[ahead]]));
      patch.edge_curve.push_back(curve == curve_of.end() ? -1 : curve->second);
    }
  }
  return patch;
}

}  // namespace

GivenDomain make_given_domain(const GivenMesh& given) {
  GivenMesh kept = given;
  const GivenSurface surface = make_flat_surface(kept);
  const Mesh& fine = surface.model.fine;
  GivenDomain result;
  result.warnings = surface.model.warnings;
  PlanarDomain& domain = result.domain;
  domain.has_junctions = true;
  std::vector<int> node;  // of each fine point
  domain.boundary = make_boundary(kept.mesh, surface, node);
  std::map<std::pair<int, int>, int> curve_of;
  for (std::size_t l = 0; l < domain.boundary.lines.size(); ++l)
    curve_of[std::minmax(domain.boundary.lines[l][0], domain.boundary.lines[l][1])] =
        domain.boundary.line_curve[l];
  for (const Chart& chart : extract_charts(fine, std::vector<char>(fine.triangles.size(), 1))) {
    std::vector<int> point(chart.points.size(), -1), inside;  // of each vertex the point; vertices inside
    domain.patches.push_back(outline_of(chart, node, curve_of, point));
    domain.patch_region.push_back(surface.given_region[chart.face]);
    QuadPatch& patch = result.elements.emplace_back();
    patch.points = domain.patches.back().points;
    patch.n_boundary = static_cast<int>(patch.points.size());
    for (int v = chart.n_boundary; v < std::ssize(point); ++v) inside.push_back(v);
    std::ranges::sort(inside, {}, [&](int v) { return chart.fine_node[v]; });
    for (const int v : inside) {
      point[v] = static_cast<int>(patch.points.size());
      patch.points.push_back({chart.points[v].x, chart.points[v].y});
    }
    add_elements(surface, chart.fine_triangle, chart.triangles, point, patch);
  }
  check_outlines(domain, given.source);
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

TriPatch as_triangles(const QuadPatch& elements) {
  TriPatch tri{elements.points, elements.triangles, {}, elements.n_boundary};
  for (const auto& v : elements.quads) {
    std::array<Vec3, 4> at;
    for (int k = 0; k < 4; ++k) at[k] = {tri.points[v[k]].x, tri.points[v[k]].y, 0};
    for (const auto& [a, b, c] : halves_of(at).first) tri.triangles.push_back({v[a], v[b], v[c]});
  }
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
