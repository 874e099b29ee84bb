// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/curve_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/segment.h"
#include "delquad/error.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {
namespace {

std::vector<CurvePiece> cut_at_stops(const PlanarModel& model, const ModelChain& chain) {
  std::vector<CurvePiece> pieces;
  for (std::size_t c = 0; c < model.curves.size(); ++c) {
    if (model.curves[c].is_gone) continue;
    std::vector<CurveStop> stops = chain.stops[c];
    stops.push_back({1, chain.curve_ends[c][1]});
    double t = 0;
    int node = chain.curve_ends[c][0];
    for (const auto& [stop, next] : stops) {
      pieces.push_back({{static_cast<int>(c)}, {node, next}, model.curves[c].shape, t, stop});
      t = stop;
      node = next;
    }
  }
  return pieces;
}

/// Returns whether sampled places of one piece lie on another piece with the same ends.
bool are_equal(const CurvePiece& a, const CurvePiece& b, double tolerance) {
  if (a.curves == b.curves) return false;
  const CurveSpan other(*b.shape, b.from, b.to);
  return std::ranges::all_of(std::array{0.21, 0.5, 0.83}, [&](double s) {
    return other.nearest(a.shape->point(a.from + s * (a.to - a.from))).distance <= tolerance;
  });
}

std::vector<CurvePiece> join_equal_pieces(std::vector<CurvePiece> pieces, double tolerance) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> by_ends;
  for (std::size_t i = 0; i < pieces.size(); ++i) by_ends[pieces[i].sorted_ends()].push_back(i);
  std::vector<char> is_copy(pieces.size(), 0);
  for (const auto& [ends, group] : by_ends) {
    for (std::size_t j = 1; j < group.size(); ++j) {
      for (std::size_t i = 0; i < j && !is_copy[group[j]]; ++i) {
        if (is_copy[group[i]] || !are_equal(pieces[group[i]], pieces[group[j]], tolerance)) continue;
        is_copy[group[j]] = 1;
        pieces[group[i]].curves.push_back(pieces[group[j]].curves[0]);
      }
    }
  }
  std::vector<CurvePiece> kept;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (!is_copy[i]) kept.push_back(std::move(pieces[i]));
  return kept;
}

/// An end of a piece, and the direction from there.
struct PieceEnd {
  int node;
  double angle;
  const CurvePiece* piece;
};

std::vector<PieceEnd> ends_by_angle(const std::vector<CurvePiece>& pieces) {
  std::vector<PieceEnd> ends;
  for (const CurvePiece& p : pieces) {
    const double step = 1e-6 * (p.to - p.from);
    for (const int k : {0, 1}) {
      const double t = k == 0 ? p.from : p.to;
      const Vec2 d = p.shape->point(k == 0 ? t + step : t - step) - p.shape->point(t);
      ends.push_back({p.ends[k], std::atan2(d.y, d.x), &p});
    }
  }
  std::ranges::sort(ends, {}, [](const PieceEnd& e) { return std::pair(e.node, e.angle); });
  return ends;
}

/// Throws InputError for curves of different loops that meet without an angle, as they would enclose only
/// slivers.
void check_angles(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces) {
  constexpr double kLeast = 1e-4;  // radians
  const std::vector<PieceEnd> ends = ends_by_angle(pieces);
  const auto loops = loops_of_model_curves(model, chain);
  const auto apart = [&](const CurvePiece& p, const CurvePiece& q) {
    return p.curves != q.curves && (loops[p.curves[0]].empty() || loops[p.curves[0]] != loops[q.curves[0]]);
  };
  for (auto first = ends.begin(); first != ends.end();) {
    const auto last =
        std::find_if(first, ends.end(), [&](const PieceEnd& e) { return e.node != first->node; });
    for (auto e = first; e != last; ++e) {
      const auto next = e + 1 == last ? first : e + 1;
      const double turn = next->angle - e->angle + (next == first ? 2 * std::numbers::pi : 0);
      if (next == e || turn >= kLeast || !apart(*e->piece, *next->piece)) continue;
      const Vec2 at = chain.nodes[e->node];
      throw InputError(fmt::format(
          "{}{} and {} touch at ({:.4g}, {:.4g}), without an angle between them. Move them apart, or join "
          "polylines that are nearer than PART of the diagonal by --weld PART [touching-curves]",
          message_prefix(model), curve_label(model, e->piece->curves[0]),
          curve_label(model, next->piece->curves[0]), at.x, at.y));
    }
    first = last;
  }
}

}  // namespace

std::string message_prefix(const PlanarModel& model) {
  return model.source.empty() ? "" : model.source + ": ";
}

std::vector<Entity> curve_entities(const PlanarModel& model) {
  std::vector<Entity> curves;
  for (const ModelCurve& curve : model.curves) {
    Entity& entity = curves.emplace_back(Entity{static_cast<int>(curves.size()) + 1, {}});
    if (!curve.name.empty()) entity.names.push_back(curve.name);
  }
  return curves;
}

std::vector<std::vector<int>> loops_of_model_curves(const PlanarModel& model, const ModelChain& chain) {
  std::vector<std::vector<int>> loops(model.curves.size());
  for (std::size_t l = 0; l < chain.loops.size(); ++l)
    for (const int c : chain.loops[l].curves) loops[c].push_back(static_cast<int>(l));
  return loops;
}

std::vector<CurvePiece> cut_curves(const PlanarModel& model, const ModelChain& chain) {
  const double tolerance = kTouch * norm(Box<Vec2>::around(std::span(chain.nodes)).size());
  std::vector<CurvePiece> pieces = join_equal_pieces(cut_at_stops(model, chain), tolerance);
  check_angles(model, chain, pieces);
  return pieces;
}

void divide_by_chords(const SizeField& size, double fineness, CurvePiece& piece) {
  constexpr double kStray = 1.0 / 50, kStrayOfSize = 1.0 / 100, kLongest = 0.25;
  constexpr double kRounding = 1e-9;  // of the chord: straight pieces
  constexpr int kMostHalvings = 14, kChordsOfCurved = 2;
  int hint = -1;
  const std::function<void(double, Vec2, double, Vec2, int)> add = [&](double s, Vec2 a, double t, Vec2 b,
                                                                       int halvings) {
    double stray = 0;
    for (const double part : {0.21, 0.37, 0.5, 0.63, 0.79}) {
      const Vec2 x = piece.shape->point(s + part * (t - s));
      stray = std::max(stray, norm(x - (a + nearest_part(x, a, b) * (b - a))));
    }
    const double chord = norm(b - a);
    const Vec2 middle = 0.5 * (a + b);
    const double wanted = size.at({middle.x, middle.y, 0}, hint);
    const double most = fineness * std::min(kStray * chord, kStrayOfSize * wanted);
    const bool is_straight = stray <= kRounding * chord;
    const bool is_fine = stray <= most && chord <= kLongest * wanted;
    if (halvings == kMostHalvings || (is_fine && (is_straight || halvings >= kChordsOfCurved))) return;
    const double half = (s + t) / 2;
    const Vec2 at = piece.shape->point(half);
    add(s, a, half, at, halvings + 1);
    piece.interior.push_back(half);
    add(half, at, t, b, halvings + 1);
  };
  add(piece.from, piece.shape->point(piece.from), piece.to, piece.shape->point(piece.to), 0);
  piece.n = static_cast<int>(piece.interior.size()) + 1;
  if (piece.n >= piece.least) return;
  piece.interior.clear();
  for (int k = 1; k < piece.least; ++k)
    piece.interior.push_back(piece.from + k * (piece.to - piece.from) / piece.least);
  piece.n = piece.least;
}

std::vector<int> pieces_at_nodes(const std::vector<CurvePiece>& pieces, std::size_t n_nodes) {
  std::vector<int> valence(n_nodes, 0);
  for (const CurvePiece& p : pieces)
    for (const int v : p.ends) ++valence[v];
  return valence;
}

}  // namespace delquad
