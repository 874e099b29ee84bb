// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/merge_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/added_parts.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
namespace {

constexpr const char* kEta = "eta";
constexpr double kMost = 3;
constexpr std::size_t kBatch = 4096;

using Maker = std::function<MergeCost(const Options&)>;

AddedParts<Maker>& costs() {
  static AddedParts<Maker> all("matching cost", {kEta});
  return all;
}

MergedQuad quad_across(const TriPatch& tri, int t, int u, const StageInput& in) {
  const auto& across = tri.neighbours[t];
  const int side = static_cast<int>(std::ranges::find(across, u) - across.begin());
  MergedQuad quad{};
  Vec2 sum{};
  const auto corners = merged_quad(tri, t, side, u);
  for (std::size_t k = 0; k < corners.size(); ++k) sum += quad.corners[k] = tri.points[corners[k]];
  int cross_hint = -1, size_hint = -1;
  quad.cross = in.cross.at(0.25 * sum, cross_hint);
  quad.delta = in.size.at(0.25 * sum, size_hint);
  return quad;
}

}  // namespace

void add_merge_cost(const std::string& name, Maker make) { costs().add(name, std::move(make)); }
std::vector<std::string> merge_cost_names() {
  std::vector<std::string> names = costs().names();
  names.insert(names.begin(), kEta);
  return names;
}

AddedCost added_cost(const std::string& name, const StageInput& in) {
  if (name == kEta) return nullptr;
  const MergeCost cost = (*costs().find(name))(in.options);
  if (!cost) throw Error("matching cost '" + name + "': its factory returned none");
  return [name, cost, &in](const TriPatch& tri, DualGraph& dual) {
    std::vector<MergedQuad> quads;
    std::vector<double> values;
    const auto n = static_cast<std::size_t>(dual.first_extra);
    for (std::size_t begin = 0; begin < n; begin += kBatch) {
      const std::size_t end = std::min(n, begin + kBatch);
      quads.clear();
      for (std::size_t i = begin; i < end; ++i) {
        const MatchingGraph::Edge& edge = dual.graph.edges[i];
        quads.push_back(quad_across(tri, dual.triangle[edge.a], dual.triangle[edge.b], in));
      }
      values.assign(quads.size(), std::nan(""));
      cost(quads, values);
      for (std::size_t i = begin; i < end; ++i) {
        const double value = values[i - begin];
        if (!(value >= 0 && value <= kMost))
          throw Error(
              fmt::format("matching cost '{}': {} of the quad around {}: expected a number from 0 to {}",
                          name, value, show_point(quads[i - begin].corners[0]), kMost));
        dual.graph.edges[i].cost = std::llround(kCostUnit * value);
      }
    }
  };
}

}  // namespace delquad
