// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/surface_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "base/activity.h"
#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/patches/narrow_places.h"
#include "geometry/patches/surface_domain.h"

namespace delquad {

namespace {

/// Edges around a tube, growth of sizes away from the cut, and least size at a tip, over the size.
constexpr double kAroundTube = 4, kGrowth = 0.2, kTipPart = 1.0 / 8;
/// Angle around a tip (radians) below which the surface is a cone, as for sharp_tips().
constexpr double kPointed = 2 * std::numbers::pi - 0.5;
constexpr double kNone = std::numeric_limits<double>::max();

/// Both sides of a line of a cut.
struct Seam {
  const CurveSide *forward = nullptr, *backward = nullptr;
};

class TubePatch {
 public:
  TubePatch(const Mesh& fine, const FlatPatch& map, const SizeField& size)
      : fine_(fine), map_(map), size_(size), limit_(map.flat.points.size(), kNone) {
    if (!map.sides.empty()) stretch_ = stretch_of(map, fine);
  }

  /// Adds the lines of a curve with the patch on both sides.
  void add_cut(const std::vector<Seam>& lines) {
    bool has_tip = false, is_pointed = false;
    double widest = 0, tip_size = kNone;
    std::vector<std::pair<int, double>> found;
    int hint = -1;
    for (const Seam& s : lines) {
      for (const auto& [v, w] :
           {std::pair(s.forward->from, s.backward->to), std::pair(s.forward->to, s.backward->from)}) {
        if (v == w) {
          has_tip = true, tip_size = kTipPart * size_.at(space(v), hint);
          is_pointed = is_pointed || angle_around(v) < kPointed;
        }
        if (!faces(*s.forward, v, w) || !faces(*s.backward, w, v)) continue;
        const double width = norm(flat(w) - flat(v)) / stretch(s) / kAroundTube;
        if (v != w && width < size_.at(space(v), hint) && !is_free(v, w)) continue;
        widest = std::max(widest, width);
        found.emplace_back(v, width);
        found.emplace_back(w, width);
      }
    }
    // If paths around exist only at the tip, the cut closes no tube; a slit makes no cone either.
    if (widest == 0 && !is_pointed) return;
    const double least = widest == 0 ? tip_size : has_tip ? std::min(tip_size, widest) : 0;
    for (const auto& [v, width] : found) limit_[v] = std::min(limit_[v], std::max(width, least));
  }

  /// Returns the sizes, spread from the cuts over the patch; empty if none is below the size.
  std::vector<double> sizes() {
    int hint = -1;
    bool asks = false;
    for (size_t v = 0; v < limit_.size() && !asks; ++v)
      asks = limit_[v] < kNone && limit_[v] < size_.at(space(static_cast<int>(v)), hint);
    if (!asks) return {};
    Mesh surface;
    // With a metric, lengths of the map are mean lengths in the metric.
    for (int v = 0; v < std::ssize(limit_); ++v)
      surface.points.push_back(map_.sides.empty() ? space(v) : Vec3{flat(v).x, flat(v).y, 0});
    surface.triangles = map_.flat.triangles;
    limit_slope(surface, kGrowth, limit_);
    return std::move(limit_);
  }

 private:
  Vec2 flat(int v) const { return map_.flat.points[v]; }
  Vec3 space(int v) const { return fine_.points[map_.fine_node[v]]; }

  /// Returns the angle around v in space (radians).
  double angle_around(int v) const {
    double sum = 0;
    for (const auto& t : map_.flat.triangles)
      for (int k = 0; k < 3; ++k) {
        if (t[k] != v) continue;
        sum += angle_between(space(t[(k + 1) % 3]) - space(v), space(t[(k + 2) % 3]) - space(v));
      }
    return sum;
  }

  /// Returns whether the straight line from v, an end of the side, to w leads into the patch.
  bool faces(const CurveSide& side, int v, int w) const {
    return v == w || dot(perp(flat(side.to) - flat(side.from)), flat(w) - flat(v)) > 0;
  }

  /// Returns whether the boundary does not cross the straight line.
  bool is_free(int v, int w) const {
    const Vec2 a = flat(v), b = flat(w);
    for (const auto& loop : map_.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int p = loop[i], q = loop[(i + 1) % loop.size()];
        if (p == v || p == w || q == v || q == w) continue;
        const Vec2 c = flat(p), d = flat(q);
        if (cross(b - a, c - a) * cross(b - a, d - a) < 0 && cross(d - c, a - c) * cross(d - c, b - c) < 0)
          return false;
      }
    return true;
  }

  /// Returns parameter length over length in space.
  double stretch(const Seam& s) const {
    const auto in_plane = [&](const CurveSide& side) { return norm(flat(side.to) - flat(side.from)); };
    if (!map_.sides.empty()) return (stretch_[s.forward->from] + stretch_[s.forward->to]) / 2;
    const double in_space = norm(space(s.forward->to) - space(s.forward->from));
    return in_space > 0 ? (in_plane(*s.forward) + in_plane(*s.backward)) / 2 / in_space : 1;
  }

  const Mesh& fine_;
  const FlatPatch& map_;
  const SizeField& size_;
  std::vector<double> stretch_;  ///< stretch at vertices; empty: see stretch()
  std::vector<double> limit_;
};

/// Returns the largest size at each vertex of each map at which no quad meets itself around a tube. It is a
/// fourth of the path from one side of a cut to the other. Empty for patches without a cut or a limit.
/// Towards the tip of a cone the path shrinks to 0, but the size stays above kTipPart of `size`: see
/// cap_tips().
std::vector<std::vector<double>> tube_sizes(const Mesh& fine, const std::vector<CurveChain>& chains,
                                            const std::vector<FlatPatch>& maps,
                                            const std::vector<PatchOutline>& outlines,
                                            const SizeField& size) {
  std::vector<std::vector<double>> sizes(maps.size());
  for (size_t p = 0; p < maps.size(); ++p) {
    std::map<int, std::vector<Seam>> sides_of;  // sides of cuts by curve
    for (const auto& loop : outlines[p])
      for (const CurveSide& side : loop) {
        auto& lines = sides_of[side.chain];
        lines.resize(chains[side.chain].points.size() - 1);
        (side.forward ? lines[side.line].forward : lines[side.line].backward) = &side;
      }
    TubePatch patch(fine, maps[p], size);
    for (auto& [chain, lines] : sides_of) {
      // A cut that ends at this one may leave another patch beside some of its lines.
      std::erase_if(lines, [](const Seam& s) { return s.forward == nullptr || s.backward == nullptr; });
      if (!lines.empty()) patch.add_cut(lines);
    }
    sizes[p] = patch.sizes();
  }
  return sizes;
}

/// Least edges of a cut to the tip of a cone, which has a node besides its ends.
constexpr int kFewestTipEdges = 2;
/// Length of a curve, over the size, below which a warning names it.
constexpr double kShort = 0.5;

/// Returns the largest size by tubes at each point of each curve; empty for curves without limit.
std::vector<std::vector<double>> limits_on_curves(const SurfaceCurves& curves) {
  std::vector<std::vector<double>> limits(curves.chains.size());
  for (size_t p = 0; p < curves.maps.size(); ++p) {
    if (curves.tube_sizes[p].empty()) continue;
    for (const auto& loop : curves.outlines[p])
      for (const CurveSide& side : loop) {
        auto& of_chain = limits[side.chain];
        of_chain.resize(curves.chains[side.chain].points.size(), std::numeric_limits<double>::max());
        const auto [first, second] =
            std::pair(side.forward ? side.from : side.to, side.forward ? side.to : side.from);
        of_chain[side.line] = std::min(of_chain[side.line], curves.tube_sizes[p][first]);
        of_chain[side.line + 1] = std::min(of_chain[side.line + 1], curves.tube_sizes[p][second]);
      }
  }
  return limits;
}

/// Converts limits by a metric to limits of lengths in space.
void limits_in_space(const Mesh& fine, const CurveChain& chain, const SurfaceSize& size,
                     std::vector<double>& limits) {
  int hint = -1;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::size_t line = std::min(i, chain.points.size() - 2);
    if (limits[i] < kNone)
      limits[i] *=
          size.along_line(chain.points[line], chain.points[line + 1], 0, fine.points[chain.points[i]], hint);
  }
}

/// Returns the turn (radians) of a chain at each point; ends have half of the turn of the next point.
std::vector<double> turns_along(const Mesh& fine, const CurveChain& chain) {
  const std::size_t last = chain.points.size() - 1;
  std::vector<double> turns(last + 1, 0);
  const auto at = [&](std::size_t i) { return fine.points[chain.points[i]]; };
  for (std::size_t i = 1; i < last; ++i) turns[i] = angle_between(at(i) - at(i - 1), at(i + 1) - at(i));
  turns[0] = turns[1] / 2, turns[last] = turns[last - 1] / 2;
  return turns;
}

/// Raises the demand of a chain by its turn over `edge_turn` (radians), with smaller sizes where it turns
/// most. Kinks, larger turns between two fine lines, do not count.
void demand_turns(const Mesh& fine, const CurveChain& chain, double edge_turn, std::vector<double>& limits,
                  CurveDemand& demand) {
  if (!(edge_turn > 0) || chain.points.size() < 3) return;
  std::vector<double> turns = turns_along(fine, chain);
  for (double& turn : turns)
    if (turn > edge_turn) turn = 0;
  const double all = std::accumulate(turns.begin(), turns.end(), 0.0);
  demand.minimum = std::max(demand.minimum, static_cast<int>(std::lround(all / edge_turn)));
  if (all < edge_turn) return;
  limits.resize(turns.size(), std::numeric_limits<double>::max());
  const auto length = [&](std::size_t i) {
    return norm(fine.points[chain.points[i + 1]] - fine.points[chain.points[i]]);
  };
  for (std::size_t i = 1; i + 1 < turns.size(); ++i)
    if (turns[i] > 0) limits[i] = std::min(limits[i], edge_turn / turns[i] * (length(i - 1) + length(i)) / 2);
}

/// Demands further edges beside the edges of sharp corners, whose quad has its fourth vertex inside.
void demand_edges_at_corners(const SurfaceCurves& curves, std::vector<CurveDemand>& demands) {
  std::vector<std::map<int, int>> sharp_ends(curves.chains.size());  // of each curve, by patch
  for (const FaceCorner& corner : curves.corners)
    if (corner.is_tip() && curves.is_embedded[curves.chains[corner.after].curve])
      continue;
    else if (corner.is_tip())
      demands[corner.after].minimum = std::max(demands[corner.after].minimum, kFewestTipEdges);
    else if (corner.angle < kOneQuadAngle)
      ++sharp_ends[corner.before][corner.patch], ++sharp_ends[corner.after][corner.patch];
  for (size_t c = 0; c < curves.chains.size(); ++c)
    for (const auto& [patch, ends] : sharp_ends[c])
      demands[c].minimum = std::max(demands[c].minimum, 1 + ends);
}

/// Demands edges so that at most one curve between two ends is a single edge, and closed curves have a loop
/// of quads.
void demand_edges_of_loops(const std::vector<CurveChain>& chains, const std::vector<SizeIntegral>& integrals,
                           std::vector<CurveDemand>& demands) {
  std::map<std::pair<int, int>, size_t> single;
  for (size_t c = 0; c < chains.size(); ++c) {
    if (chains[c].closed()) {
      if (demands[c].patches.size() == 2) demands[c].minimum = std::max(demands[c].minimum, kFewestLoopEdges);
      continue;
    }
    const auto ends = std::minmax(chains[c].points.front(), chains[c].points.back());
    const auto [it, first] = single.try_emplace(ends, c);
    if (first) continue;
    size_t longer = c;
    if (integrals[it->second].total() > integrals[c].total()) std::swap(longer, it->second);
    demands[longer].minimum = std::max(demands[longer].minimum, 2);
  }
}

/// Throws FaceError if all points of a curve lie at one place: edges there would have no length.
void refuse_without_length(const Mesh& fine, const SurfaceCurves& curves) {
  constexpr double kRounding = 1e-14;  // part of the diagonal
  const double least = kRounding * diagonal(fine);
  for (std::size_t p = 0; p < curves.maps.size(); ++p)
    for (const auto& loop : curves.outlines[p])
      for (const CurveSide& side : loop) {
        const CurveChain& chain = curves.chains[side.chain];
        const Vec3& at = fine.points[chain.points[0]];
        const auto is_there = [&](int v) { return norm(fine.points[v] - at) <= least; };
        if (!side.begins(chain) || !std::ranges::all_of(chain.points, is_there)) continue;
        throw FaceError(
            curves.maps[p].face,
            fmt::format(
                "{}: its curve {} has no length: all of it lies at {}. The face touches itself there, or "
                "the model is damaged: change the model, or leave the face out (--keep-going) "
                "[curve-without-length]",
                face_name(fine, curves.maps[p]), fine.curves[chain.curve].tag, show_point(at)));
      }
}

}  // namespace

SizeOnLine size_on_lines(const SurfaceSize& size) {
  return [&size](int a, int b, double t, const Vec3& x, int& hint) {
    return size.on_fine(std::array{a, b}, std::array{1 - t, t}, x, hint);
  };
}

std::string face_name(const Mesh& fine, const FlatPatch& map) {
  return fmt::format("face {}", fine.regions[map.face].tag);
}

void for_each_patch(const Mesh& fine, const std::vector<FlatPatch>& maps,
                    const std::function<void(std::size_t)>& work) {
  parallel_for(
      maps.size(),
      [&](std::size_t p) {
        const FaceScope face(fine.regions[maps[p].face].tag);
        work(p);
      },
      [&](std::size_t p) { return static_cast<double>(maps[p].flat.points.size()); });
}

SurfaceCurves find_curves(const SurfaceModel& model, Flattening flattening, const SizeField& size) {
  const Mesh& fine = model.fine;
  SurfaceCurves curves;
  curves.maps = std::move(flattening.patches);
  curves.cut_face.assign(fine.curves.size(), -1);
  for (const SurfaceCut& cut : flattening.cuts) curves.cut_face[cut.curve] = cut.face;
  curves.is_embedded.assign(fine.curves.size(), 0);
  for (const EmbeddedCurve& embedded : model.embedded) curves.is_embedded[embedded.curve] = 1;
  curves.chains = curve_chains(model);
  const LineIndex lines(curves.chains);
  for (const FlatPatch& map : curves.maps)
    curves.outlines.push_back(lines.outline(map, curves.chains, face_name(fine, map)));
  refuse_without_length(fine, curves);
  curves.corners = face_corners(fine, curves.chains, curves.maps, curves.outlines);
  curves.tube_sizes = tube_sizes(fine, curves.chains, curves.maps, curves.outlines, size);
  return curves;
}

std::vector<int> leaders(const SurfaceCurves& curves) {
  std::vector<int> leader(curves.chains.size());
  std::iota(leader.begin(), leader.end(), 0);
  for (const ChainPair& pair : curves.images) leader[pair.chain] = leader[pair.master];
  return leader;
}

CurveDemands measure_curves(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across,
                            const SurfaceSize& size, const SizeField& asked) {
  const std::vector<CurveChain>& chains = curves.chains;
  std::vector<std::vector<double>> limits = limits_on_curves(curves);
  CurveDemands wanted;
  const SizeOnLine delta = size_on_lines(size);
  const SizeOnLine delta_along = [&](int a, int b, double t, const Vec3& x, int& hint) {
    return size.along_line(a, b, t, x, hint);
  };
  const SizeOnLine delta_asked = [&](int, int, double, const Vec3& x, int& hint) {
    return asked.at(x, hint);
  };
  for (std::size_t c = 0; c < chains.size(); ++c) {
    CurveDemand demand{0, chains[c].closed() ? 3 : 1, {}};
    demand_turns(fine, chains[c], size.edge_turn(), limits[c], demand);
    if (size.has_metric()) limits_in_space(fine, chains[c], size, limits[c]);
    wanted.integrals.push_back(size_integral(fine, chains[c], delta_along, limits[c]));
    const double total = demand.integral = wanted.integrals.back().total();
    const bool same = limits[c].empty() && &asked == static_cast<const SizeField*>(&size);
    wanted.lengths.push_back(same ? total : size_integral(fine, chains[c], delta_asked).total());
    wanted.demands.push_back(std::move(demand));
  }
  for (std::size_t p = 0; p < curves.maps.size(); ++p)
    for (const auto& loop : curves.outlines[p])
      for (const CurveSide& side : loop)
        if (side.begins(chains[side.chain]))
          wanted.demands[side.chain].patches.push_back(static_cast<int>(p));
  int hint = -1;
  for (const FlatPatch& map : curves.maps) {
    wanted.quads.push_back(0);
    for (const int t : map.fine_triangle) wanted.quads.back() += size.quads_in(fine, t, hint);
  }
  // The curves of a strip want the mean of their own numbers.
  wanted.group = group_facing_curves(fine, chains, across, delta);
  std::vector<double> sum(chains.size(), 0), members(chains.size(), 0);
  for (std::size_t c = 0; c < chains.size(); ++c)
    sum[wanted.group[c]] += std::log(wanted.demands[c].integral), ++members[wanted.group[c]];
  for (std::size_t c = 0; c < chains.size(); ++c)
    wanted.demands[c].integral = std::exp(sum[wanted.group[c]] / members[wanted.group[c]]);
  demand_edges_at_corners(curves, wanted.demands);
  demand_edges_of_loops(chains, wanted.integrals, wanted.demands);
  return wanted;
}

Mesh boundary_mesh(const Mesh& fine, const std::vector<CurveChain>& chains, const SurfaceNodes& nodes) {
  Mesh boundary;
  boundary.curves = fine.curves;
  boundary.regions = fine.regions;
  for (size_t c = 0; c < chains.size(); ++c)
    for (size_t i = 0; i + 1 < nodes.on_curve[c].size(); ++i) {
      boundary.lines.push_back({nodes.on_curve[c][i].node, nodes.on_curve[c][i + 1].node});
      boundary.line_curve.push_back(chains[c].curve);
    }
  boundary.points = nodes.points;
  for (const NamedPoint& named : fine.named_points) {
    const auto ends = [&](const CurveChain& c) {
      return c.points.front() == named.point || c.points.back() == named.point;
    };
    const auto chain = std::ranges::find_if(chains, ends);
    if (chain == chains.end()) throw std::logic_error("a named point is the end of no curve");
    const auto& on_curve = nodes.on_curve[chain - chains.begin()];
    boundary.named_points.push_back(
        {chain->points.front() == named.point ? on_curve.front().node : on_curve.back().node, named.entity});
  }
  return boundary;
}

std::vector<Warning> warn_of_short_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                          const CurveDemands& wanted) {
  std::vector<Warning> warnings;
  for (std::size_t c = 0; c < chains.size(); ++c)
    if (const double length = wanted.lengths[c]; length < kShort)
      warnings.push_back({fmt::format("curves shorter than {:g} times the size", kShort), 1 / length,
                          fmt::format("curve {} is {:.2g} times the size long: it gets {} edge(s)",
                                      fine.curves[chains[c].curve].tag, length, wanted.demands[c].minimum)});
  return warnings;
}

}  // namespace delquad
