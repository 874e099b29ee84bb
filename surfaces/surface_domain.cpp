#include "surfaces/surface_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "mesh/constrained_delaunay.h"
#include "mesh/error.h"
#include "surfaces/curve_nodes.h"

namespace delquad {

namespace {

/// A boundary loop of quads needs four edges to enclose an area.
constexpr int kFewestLoopEdges = 4;
/// A curve is refined at most to this multiple of what the size asks for, to keep boundary polygons from
/// crossing.
constexpr int kRefinements = 6;

/// Where a side of a patch's map lies on a curve.
struct CurveSide {
  int from, to;     ///< vertices of the map
  int chain, line;  ///< line: the chain's k-th
  bool forward;     ///< runs with the curve
};

struct LineOfSide {
  int chain, line;
  int first;  ///< fine point at which the line begins
};

/// Whether the side is the first that a loop meets of its curve.
bool begins(const CurveSide& s, const std::vector<CurveChain>& chains) {
  return s.forward ? s.line == 0 : s.line + 2 == static_cast<int>(chains[s.chain].points.size());
}

using LineIndex = std::unordered_map<long long, LineOfSide>;  // only looked up, never iterated

long long side_key(int a, int b) { return (static_cast<long long>(std::min(a, b)) << 32) | std::max(a, b); }

LineIndex index_lines(const std::vector<CurveChain>& chains) {
  LineIndex index;
  for (size_t c = 0; c < chains.size(); ++c) {
    const auto& points = chains[c].points;
    for (size_t k = 0; k + 1 < points.size(); ++k) {
      index[side_key(points[k], points[k + 1])] = {static_cast<int>(c), static_cast<int>(k), points[k]};
    }
  }
  return index;
}

/// The boundary of a map as loops of sides, each beginning where a curve does.
std::vector<std::vector<CurveSide>> trace_loops(const FlatPatch& map, const LineIndex& lines,
                                                const std::vector<CurveChain>& chains,
                                                const std::string& face) {
  std::vector<std::vector<CurveSide>> loops;
  for (const auto& points : map.loops) {
    auto& loop = loops.emplace_back();
    for (size_t i = 0; i < points.size(); ++i) {
      const int from = points[i], to = points[i + 1 < points.size() ? i + 1 : 0];
      const auto it = lines.find(side_key(map.fine_node[from], map.fine_node[to]));
      if (it == lines.end()) throw std::logic_error(face + ": a side of its map's boundary lies on no curve");
      loop.push_back({from, to, it->second.chain, it->second.line, map.fine_node[from] == it->second.first});
    }
    std::rotate(loop.begin(),
                std::find_if(loop.begin(), loop.end(), [&](const CurveSide& s) { return begins(s, chains); }),
                loop.end());
  }
  return loops;
}

PatchBoundary place_boundary(const FlatPatch& map, const std::vector<std::vector<CurveSide>>& loops,
                             const std::vector<CurveChain>& chains, const SurfaceNodes& nodes) {
  PatchBoundary boundary;
  for (const auto& loop : loops) {
    const int first = static_cast<int>(boundary.points.size());
    for (const CurveSide& side : loop) {
      const auto& on_curve = nodes.on_curve[side.chain];
      const Vec2 a = map.flat.points[side.from], b = map.flat.points[side.to];
      const auto add = [&](const CurveNode& n, double t) {
        boundary.points.push_back(t == 0 ? a : a + t * (b - a));
        boundary.point_node.push_back(n.node);
        boundary.edge_curve.push_back(chains[side.chain].curve);
      };
      // A node at either end of the side belongs to the side that begins there.
      const auto before = [](const CurveNode& n, double s) { return n.s < s; };
      const auto after = [](double s, const CurveNode& n) { return s < n.s; };
      if (side.forward) {
        for (auto n = std::lower_bound(on_curve.begin(), on_curve.end(), double(side.line), before);
             n != on_curve.end() && n->s < side.line + 1; ++n) {
          add(*n, n->s - side.line);
        }
      } else {
        for (auto n = std::upper_bound(on_curve.begin(), on_curve.end(), double(side.line + 1), after);
             n != on_curve.begin() && (n - 1)->s > side.line; --n) {
          add(*(n - 1), side.line + 1 - (n - 1)->s);
        }
      }
    }
    const int n = static_cast<int>(boundary.points.size()) - first;
    for (int i = 0; i < n; ++i) boundary.edges.push_back({first + i, first + (i + 1) % n});
  }
  return boundary;
}

bool meshable(const PatchBoundary& boundary) {
  try {
    constrained_delaunay(boundary);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

SurfaceDomain make_surface_domain(const SurfaceModel& model, Flattening flattening, const SizeField& size,
                                  const MatchingSolver& solver) {
  const Mesh& fine = model.fine;
  auto& maps = flattening.patches;
  std::vector<int> cut_face(fine.curves.size(), -1);
  for (const SurfaceCut& cut : flattening.cuts) cut_face[cut.curve] = cut.face;
  const auto chains = curve_chains(model);
  const LineIndex lines = index_lines(chains);
  int hint = -1;
  const SizeFunction delta = [&](const Vec3& x) { return size.at(x, hint); };
  const auto face_name = [&](const FlatPatch& map) {
    return fmt::format("face {}", fine.regions[map.face].tag);
  };

  std::vector<std::vector<double>> integrals;
  std::vector<CurveDemand> demands;
  SurfaceDomain domain;
  for (size_t c = 0; c < chains.size(); ++c) {
    integrals.push_back(size_integral(fine, chains[c], delta));
    demands.push_back({integrals.back().back(), chains[c].closed() ? 3 : 1, {}});
    if (demands.back().integral < 0.5) {
      domain.warnings.push_back(fmt::format("curve {} is {:.2g} times the size long: it gets {} edge(s)",
                                            fine.curves[chains[c].curve].tag, demands.back().integral,
                                            demands.back().minimum));
    }
  }
  std::vector<std::vector<std::vector<CurveSide>>> loops;
  for (size_t p = 0; p < maps.size(); ++p) {
    loops.push_back(trace_loops(maps[p], lines, chains, face_name(maps[p])));
    for (const auto& loop : loops.back()) {
      for (const CurveSide& side : loop) {
        if (begins(side, chains)) demands[side.chain].patches.push_back(static_cast<int>(p));
      }
    }
  }
  for (size_t c = 0; c < chains.size(); ++c) {
    if (chains[c].closed() && demands[c].patches.size() == 2) demands[c].minimum = kFewestLoopEdges;
  }

  std::vector<PatchBoundary> boundaries(maps.size());
  SurfaceNodes nodes;
  std::vector<int> odd, counts;
  for (int attempt = 0;; ++attempt) {
    counts = even_counts(demands, static_cast<int>(maps.size()), solver, odd);
    nodes = place_nodes(model, chains, cut_face, integrals, counts);
    std::vector<int> refine;
    for (size_t p = 0; p < maps.size(); ++p) {
      boundaries[p] = place_boundary(maps[p], loops[p], chains, nodes);
      bool short_loop = false;
      for (const auto& loop : loops[p]) {
        PatchBoundary alone = place_boundary(maps[p], {loop}, chains, nodes);
        short_loop = short_loop || alone.points.size() < kFewestLoopEdges;
      }
      if (!short_loop && meshable(boundaries[p])) continue;
      if (attempt == kRefinements) {
        throw InputError(
            fmt::format("{}: its boundary crosses itself in the parameter plane however fine its curves are",
                        face_name(maps[p])));
      }
      for (const auto& loop : loops[p]) {
        for (const CurveSide& s : loop) refine.push_back(s.chain);
      }
    }
    if (refine.empty()) break;
    std::sort(refine.begin(), refine.end());
    refine.erase(std::unique(refine.begin(), refine.end()), refine.end());
    for (const int c : refine) demands[c].minimum = 2 * counts[c];
  }
  for (const int p : odd) {
    domain.warnings.push_back(face_name(maps[p]) + " has an odd boundary that no curve can make even");
  }

  domain.boundary.points = nodes.points;
  domain.boundary.curves = fine.curves;
  domain.boundary.regions = fine.regions;
  for (size_t c = 0; c < chains.size(); ++c) {
    for (size_t i = 0; i + 1 < nodes.on_curve[c].size(); ++i) {
      domain.boundary.lines.push_back({nodes.on_curve[c][i].node, nodes.on_curve[c][i + 1].node});
      domain.boundary.line_curve.push_back(chains[c].curve);
    }
  }
  for (size_t p = 0; p < maps.size(); ++p) {
    auto background = std::make_shared<BackgroundMesh>(maps[p].flat);
    domain.patches.push_back({std::move(maps[p]), std::move(boundaries[p]), std::move(background)});
  }
  return domain;
}

SurfacePatchSize::SurfacePatchSize(const SurfacePatch& patch, const Mesh& fine, const SizeField& size)
    : patch_(patch), fine_(fine), size_(size) {
  const TriPatch& flat = patch.map.flat;
  std::vector<double> flat_area(flat.points.size(), 0), area(flat.points.size(), 0);
  for (const auto& v : flat.triangles) {
    const Vec3 a = fine.points[patch.map.fine_node[v[0]]], b = fine.points[patch.map.fine_node[v[1]]],
               c = fine.points[patch.map.fine_node[v[2]]];
    const double in_plane =
        cross(flat.points[v[1]] - flat.points[v[0]], flat.points[v[2]] - flat.points[v[0]]);
    const double in_space = norm(cross(b - a, c - a));
    for (const int i : v) flat_area[i] += in_plane, area[i] += in_space;
  }
  for (size_t i = 0; i < area.size(); ++i)
    stretch_.push_back(area[i] > 0 ? std::sqrt(flat_area[i] / area[i]) : 1);
}

double SurfacePatchSize::at(Vec2 u, int& hint) const {
  const auto [t, b] = patch_.background->locate(u, hint);
  const auto& v = patch_.map.flat.triangles[t];
  Vec3 x;
  double stretch = 0;
  for (int k = 0; k < 3; ++k) {
    x = x + b[k] * fine_.points[patch_.map.fine_node[v[k]]];
    stretch += b[k] * stretch_[v[k]];
  }
  int size_hint = -1;
  return stretch * size_.at(x, size_hint);
}

Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint) {
  const auto [t, b] = patch.background->locate(u, hint);
  const auto& v = patch.map.flat.triangles[t];
  Vec3 x;
  for (int k = 0; k < 3; ++k) x = x + b[k] * model.fine.points[patch.map.fine_node[v[k]]];
  return model.projector ? model.projector->to_face(patch.map.face, x) : x;
}

}  // namespace delquad
