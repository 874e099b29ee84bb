// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/patch_outline.h"

#include <algorithm>
#include <stdexcept>

#include "delquad/error.h"
#include "geometry/mesh/constrained_delaunay.h"

namespace delquad {

namespace {

long long side_key(int a, int b) { return (static_cast<long long>(std::min(a, b)) << 32) | std::max(a, b); }

}  // namespace

LineIndex::LineIndex(const std::vector<CurveChain>& chains) {
  for (size_t c = 0; c < chains.size(); ++c) {
    const auto& points = chains[c].points;
    for (size_t k = 0; k + 1 < points.size(); ++k)
      lines_[side_key(points[k], points[k + 1])] = {static_cast<int>(c), static_cast<int>(k), points[k]};
  }
}

PatchOutline LineIndex::outline(const FlatPatch& map, const std::vector<CurveChain>& chains,
                                const std::string& face) const {
  PatchOutline loops;
  for (const auto& points : map.loops) {
    auto& loop = loops.emplace_back();
    for (size_t i = 0; i < points.size(); ++i) {
      const int from = points[i], to = points[i + 1 < points.size() ? i + 1 : 0];
      const auto it = lines_.find(side_key(map.fine_node[from], map.fine_node[to]));
      if (it == lines_.end())
        throw std::logic_error(face + ": a side of its map's boundary lies on no curve");
      const Line& line = it->second;
      loop.push_back({from, to, line.chain, line.line, map.fine_node[from] == line.first});
    }
    std::rotate(
        loop.begin(),
        std::find_if(loop.begin(), loop.end(), [&](const CurveSide& s) { return s.begins(chains[s.chain]); }),
        loop.end());
  }
  return loops;
}

PatchBoundary place_boundary(const FlatPatch& map, const PatchOutline& outline,
                             const std::vector<CurveChain>& chains, const SurfaceNodes& nodes,
                             std::vector<int>* edge_chain) {
  PatchBoundary boundary;
  for (const auto& loop : outline) {
    const int first = static_cast<int>(boundary.points.size());
    for (const CurveSide& side : loop) {
      const auto& on_curve = nodes.on_curve[side.chain];
      const Vec2 a = map.flat.points[side.from], b = map.flat.points[side.to];
      const auto add = [&](const CurveNode& n, double t) {
        boundary.points.push_back(t == 0 ? a : a + t * (b - a));
        boundary.point_node.push_back(n.node);
        boundary.edge_curve.push_back(chains[side.chain].curve);
        if (edge_chain != nullptr) edge_chain->push_back(side.chain);
      };
      // A node at an end of sides belongs to the side that begins there.
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

}  // namespace delquad
