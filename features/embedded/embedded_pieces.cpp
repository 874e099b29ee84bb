// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/embedded/embedded_pieces.h"

#include <fmt/format.h>

#include <algorithm>

#include "delquad/error.h"
#include "features/embedded/dangling_edges.h"

namespace delquad {

bool is_crack(const PlanarModel& model, const std::vector<int>& curves) {
  return std::ranges::any_of(curves, [&](int c) { return model.curves[c].is_crack; });
}

void add_dangling_edges(const PlanarModel& model, const SizeField& size, const Mesh& lines, ModelChain& chain,
                        std::vector<CurvePiece>& pieces) {
  std::vector<char> has_piece(chain.nodes.size(), 0);
  for (const CurvePiece& p : pieces)
    for (const int v : p.ends) has_piece[v] = 1;
  std::vector<int> nodes, points;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const int v = chain.point_nodes[i];
    if (has_piece[v]) continue;
    has_piece[v] = 1;
    nodes.push_back(v);
    points.push_back(static_cast<int>(i));
  }
  if (nodes.empty()) return;
  const auto ends = dangling_ends(lines, nodes, size, [&](std::size_t i) {
    return message_prefix(model) + point_label(model, points[i]);
  });
  const auto add = [&](int node, Vec2 end) {
    pieces.push_back(
        {{}, {node, static_cast<int>(chain.nodes.size())}, make_segment(chain.nodes[node], end)});
    chain.nodes.push_back(end);
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const Vec3& end : ends[i]) add(nodes[i], {end.x, end.y});
}

void check_embedded(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                    const Mesh& lines, const Arrangement& arrangement, const FaceRegions& regions) {
  const auto loops = loops_of_model_curves(model, chain);
  const auto is_filled = [&](std::size_t side) {
    const int face = arrangement.face_of[side];
    return face >= 0 && regions.region[face] >= 0;
  };
  std::size_t line = 0;
  for (std::size_t i = 0; i < pieces.size(); line += pieces[i++].n) {
    const CurvePiece& piece = pieces[i];
    const Vec3 &a = lines.points[piece.ends[0]], &b = lines.points[piece.ends[1]];
    const bool is_inside = is_filled(2 * line) && is_filled(2 * line + 1);
    if (is_inside) continue;
    if (piece.curve < 0) {
      const auto at = std::ranges::find(chain.point_nodes, piece.ends[0]) - chain.point_nodes.begin();
      throw InputError(
          fmt::format("{}{} at ({:.10g}, {:.10g}) lies outside of every region [embedded-outside]",
                      message_prefix(model), point_label(model, static_cast<int>(at)), a.x, a.y));
    }
    const auto embedded = std::ranges::find_if(piece.curves, [&](int c) { return loops[c].empty(); });
    const auto bounding = std::ranges::find_if(piece.curves, [&](int c) { return !loops[c].empty(); });
    if (embedded != piece.curves.end() && !is_filled(2 * line) && !is_filled(2 * line + 1))
      throw InputError(
          fmt::format("{}{} lies outside of every region from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g}) "
                      "[embedded-outside]",
                      message_prefix(model), curve_label(model, *embedded), a.x, a.y, b.x, b.y));
    if (embedded == piece.curves.end() || bounding == piece.curves.end()) continue;
    if (const ModelCurve& curve = model.curves[*embedded]; !curve.name.empty() && !curve.is_crack) continue;
    throw InputError(fmt::format(
        "{}{} lies on the boundary, {}, between ({:.10g}, {:.10g}) and ({:.10g}, {:.10g}). Give it a name, "
        "which that part of the boundary gets, or move it into a region [embedded-on-a-boundary]",
        message_prefix(model), curve_label(model, *embedded), curve_label(model, *bounding), a.x, a.y, b.x,
        b.y));
  }
}

}  // namespace delquad
