// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/planar_symmetry.h"

#include <algorithm>
#include <utility>

#include "geometry/mesh/keep_elements.h"

namespace delquad {
namespace {

void drop_unused_nodes(ModelChain& chain, std::vector<CurvePiece>& pieces) {
  std::vector<int> renamed(chain.nodes.size(), -1);
  for (const CurvePiece& piece : pieces)
    for (const int v : piece.ends) renamed[v] = 0;
  for (const int v : chain.point_nodes) renamed[v] = 0;
  std::vector<Vec2> nodes;
  for (std::size_t v = 0; v < renamed.size(); ++v)
    if (renamed[v] == 0) {
      renamed[v] = static_cast<int>(nodes.size());
      nodes.push_back(chain.nodes[v]);
    }
  chain.nodes = std::move(nodes);
  for (CurvePiece& piece : pieces)
    for (int& v : piece.ends) v = renamed[v];
  for (int& v : chain.point_nodes) v = renamed[v];
}

}  // namespace

void drop_axes_outside(const Mesh& lines, int first_axis, ModelChain& chain,
                       std::vector<CurvePiece>& pieces) {
  std::vector<Vec2> points;
  for (const Vec3& x : lines.points) points.push_back({x.x, x.y});
  const Arrangement arrangement = arrange(points, lines.lines);
  if (arrangement.conflict) return;
  std::vector<CurvePiece> kept;
  std::size_t side = 0;
  for (CurvePiece& piece : pieces) {
    const bool is_outside = arrangement.face_of[side] < 0 && arrangement.face_of[side + 1] < 0;
    side += 2 * static_cast<std::size_t>(piece.n);
    if (!is_outside || std::ranges::any_of(piece.curves, [&](int c) { return c < first_axis; }))
      kept.push_back(std::move(piece));
  }
  pieces = std::move(kept);
  drop_unused_nodes(chain, pieces);
}

void drop_axes(int first_axis, PlanarDomain& domain) {
  std::vector<char> dropped(domain.boundary.curves.size(), 0);
  for (std::size_t c = 0; c < domain.model_curves.size(); ++c) {
    auto& curves = domain.model_curves[c];
    const bool had = !curves.empty();
    std::erase_if(curves, [&](int m) { return m >= first_axis; });
    dropped[c] = had && curves.empty();
  }
  Mesh& mesh = domain.boundary;
  keep_lines(mesh, [&](std::size_t l) { return !dropped[mesh.line_curve[l]]; });
  for (PatchBoundary& patch : domain.patches)
    for (int& curve : patch.edge_curve)
      if (curve >= 0 && dropped[curve]) curve = -1;
}

namespace {

/// Points inside follow the boundary's, in the master's order.
std::vector<Vec2> image_points(const std::vector<Vec2>& of, int n_boundary, const PatchBoundary& boundary,
                               const PatchImage& image) {
  std::vector<Vec2> points = boundary.points;
  for (auto p = of.begin() + n_boundary; p != of.end(); ++p) points.push_back(image.motion(*p));
  return points;
}

}  // namespace

PatchMesh image_of(const PatchMesh& master, const PatchBoundary& boundary, const PatchImage& image) {
  PatchMesh mesh = master;
  const int n = static_cast<int>(boundary.points.size());
  const auto turn = [&](auto& elements) {
    for (auto& element : elements) {
      for (int& v : element)
        if (v < n) v = image.point[v];
      if (image.is_mirrored) std::reverse(element.begin() + 1, element.end());
    }
  };
  if (mesh.form == PatchForm::kTriangles) {
    mesh.triangles.points = image_points(master.triangles.points, n, boundary, image);
    turn(mesh.triangles.triangles);
    if (image.is_mirrored)
      for (auto& across : mesh.triangles.neighbours) std::swap(across[1], across[2]);
  } else if (mesh.form == PatchForm::kQuads) {
    mesh.quads.points = image_points(master.quads.points, n, boundary, image);
    turn(mesh.quads.quads);
    turn(mesh.quads.triangles);
  }
  mesh.inside.clear();
  return mesh;
}

void move_image_nodes(const MeshingSetup& prepared, const PatchImage& image, std::vector<Vec3>& points) {
  const auto &from = prepared.patches[image.master].boundary.point_node,
             &to = prepared.patches[image.patch].boundary.point_node;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec3 &now = points[from[k]], &before = prepared.boundary.points[from[k]];
    if (now.x == before.x && now.y == before.y) continue;
    const Vec2 place = image.motion({now.x, now.y});
    points[to[image.point[k]]] = {place.x, place.y, now.z};
  }
}

}  // namespace delquad
