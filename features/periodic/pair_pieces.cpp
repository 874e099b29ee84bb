// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "delquad/error.h"
#include "features/periodic/paired_lines.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {
namespace {

std::vector<int> pieces_of(const PlanarModel& model, const std::vector<CurvePiece>& pieces,
                           const PeriodicPair& pair, const std::string& name) {
  const bool is_region = name.starts_with("region_") ||
                         std::ranges::find(model.loops, name, &ModelLoop::region) != model.loops.end();
  const std::vector<Entity> curves = curve_entities(model);
  if (is_region && entities_named(curves, "curve", name).empty())
    throw InputError(
        fmt::format("{}: '{}' is a region of a planar model, whose sides are curves: expected a curve's name",
                    pair.where, name));
  const std::vector<int> meant = find_entities(curves, "curve", name, pair.where);
  std::vector<int> found;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (std::ranges::find_first_of(pieces[i].curves, meant) != pieces[i].curves.end())
      found.push_back(static_cast<int>(i));
  return found;
}

Vec2 moved(const Motion& motion, Vec2 p) {
  const Vec3 x = motion({p.x, p.y, 0});
  return {x.x, x.y};
}

}  // namespace

std::vector<ChainPair> pair_pieces(const PlanarModel& model, const std::vector<PeriodicPair>& periodic,
                                   const Mesh& lines, const std::vector<CurveChain>& chains, ModelChain& ends,
                                   std::vector<CurvePiece>& pieces) {
  std::vector<PairedChains> sides;
  for (const PeriodicPair& pair : periodic)
    sides.push_back(
        {pieces_of(model, pieces, pair, pair.from), pieces_of(model, pieces, pair, pair.to), pair});
  const ChainPairs found = pair_chains(lines, chains, sides);
  for (std::size_t i = 0; i < periodic.size(); ++i)
    for (const ChainPair& pair : found.of_sides[i])
      if (pieces[pair.chain].is_divided)
        throw InputError(fmt::format(
            "{}: {} gets its nodes twice: expected one division, or one curve of which it is the image",
            periodic[i].where, curve_label(model, pieces[pair.chain].curves.front())));
  for (const ChainPair& pair : found.pairs) pieces[pair.chain].master = pair.master;
  // Corners may be images of corners that are images by a later pair.
  for (int round = 0; round < kRoundsOfChains; ++round)
    for (const ChainPair& pair : found.pairs)
      for (const int k : {0, 1})
        ends.nodes[pieces[pair.chain].ends[pair.forward ? k : 1 - k]] =
            moved(pair.motion, ends.nodes[pieces[pair.master].ends[k]]);
  return found.pairs;
}

void follow_masters(const PlanarModel& model, const std::vector<ChainPair>& images,
                    std::vector<CurvePiece>& pieces) {
  for (const ChainPair& pair : images) {
    CurvePiece& piece = pieces[pair.chain];
    const CurvePiece& master = pieces[pair.master];
    piece.n = master.n;
    piece.interior = master.interior;
    piece.images.clear();
    const CurveSpan span(*piece.shape, piece.from, piece.to);
    const double tolerance = kTouch * norm(span.box().size());
    for (std::size_t k = 0; k < master.interior.size(); ++k) {
      piece.images.push_back(moved(pair.motion, master.node(k)));
      const CurveSpan::Place place = span.nearest(piece.images.back());
      piece.interior[k] = place.t;
      if (place.distance > tolerance)
        throw InputError(
            fmt::format("{}the sides do not match: the image of {} is {:.3g} away from {} at ({:.10g}, "
                        "{:.10g}) [periodic-mismatch]",
                        message_prefix(model), curve_label(model, master.curves.front()), place.distance,
                        curve_label(model, piece.curves.front()), place.at.x, place.at.y));
    }
    if (pair.forward) continue;
    std::ranges::reverse(piece.images);
    std::ranges::reverse(piece.interior);
  }
}

}  // namespace delquad
