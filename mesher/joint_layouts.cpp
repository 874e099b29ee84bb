// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/joint_layouts.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "algorithms/regularity/regularity.h"
#include "base/stopwatch.h"
#include "geometry/patches/surface_curves.h"
#include "mesher/runner.h"

namespace delquad {
namespace {

std::size_t points_on_boundary(const PatchMesh& patch) {
  return patch.form == PatchForm::kQuads ? static_cast<std::size_t>(patch.quads.n_boundary) : 0;
}

/// Returns the patches whose quads and boundary may change. Images, grids and quads that stay are excluded.
/// The patches have no caps, and their boundary has just the nodes of its curves.
std::vector<char> patches_that_may_change(const MeshingSetup& prepared, const PipelineState& state) {
  std::vector<char> may(prepared.patches.size(), 1);
  for (std::size_t i = 0; i < may.size(); ++i) {
    const PatchSetup& patch = prepared.patches[i];
    if (!state.reasons[i].empty() || patch.given_stays || (patch.grid && patch.grid_stays)) may[i] = 0;
  }
  const SurfaceDomain& domain = prepared.surface->domain;
  for (const PatchCap& cap : domain.caps) may[cap.patch] = 0;
  for (std::size_t i = 0; i < may.size(); ++i) {
    if (!may[i]) continue;
    const SurfacePatch& patch = domain.patches[i];
    const auto nodes = place_boundary(patch.map, patch.outline, domain.chains, state.nodes).point_node;
    if (nodes != prepared.patches[i].boundary.point_node ||
        nodes.size() != points_on_boundary(state.patches[i]))
      may[i] = 0;
  }
  return may;
}

/// Parameters of the nodes of each curve, ascending.
using CurvePlaces = std::vector<std::vector<double>>;

/// Returns the nodes of curves at other places. Removed nodes make room: `number` gets the new number of each
/// node.
SurfaceNodes other_nodes(const SurfaceSetup& surface, const CurvePlaces& places, const SurfaceNodes& old,
                         std::vector<int>& number) {
  const SurfaceDomain& domain = surface.domain;
  SurfaceNodes nodes;
  std::vector<char> stays(old.points.size(), 1);
  std::vector<std::map<double, int>> kept(old.on_curve.size());
  for (std::size_t c = 0; c < old.on_curve.size(); ++c)
    for (const CurveNode& node : old.on_curve[c]) {
      if (std::ranges::binary_search(places[c], node.s))
        kept[c].emplace(node.s, node.node);
      else
        stays[node.node] = 0;
    }
  number.assign(old.points.size(), -1);
  for (std::size_t v = 0; v < old.points.size(); ++v)
    if (stays[v]) {
      number[v] = static_cast<int>(nodes.points.size());
      nodes.points.push_back(old.points[v]);
    }
  for (std::size_t c = 0; c < places.size(); ++c) {
    auto& on_curve = nodes.on_curve.emplace_back();
    for (const double s : places[c]) {
      if (const auto at = kept[c].find(s); at != kept[c].end()) {
        on_curve.push_back({s, number[at->second]});
        continue;
      }
      on_curve.push_back({s, static_cast<int>(nodes.points.size())});
      nodes.points.push_back(place_on_curve(surface.model, domain.chains[c], domain.cut_face, s));
    }
  }
  return nodes;
}

/// Returns the problem with these nodes on curves.
std::shared_ptr<const MeshingSetup> with_nodes(const MeshingSetup& prepared, const SurfaceNodes& nodes,
                                               const std::vector<int>& number, const LayoutNetwork& network) {
  auto surface = std::make_shared<SurfaceSetup>(*prepared.surface);
  auto other = std::make_shared<MeshingSetup>(prepared);
  SurfaceDomain& domain = surface->domain;
  const auto renumber = [&](int& node) { node = number[node]; };
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    SurfacePatch& patch = domain.patches[p];
    PatchBoundary& boundary = patch.boundary;
    if (network.patches[p].changed) {
      boundary = place_boundary(patch.map, patch.outline, domain.chains, nodes);
      other->patches[p].grid.reset();
    } else {
      std::ranges::for_each(boundary.point_node, renumber);
    }
    other->patches[p].boundary = boundary;
  }
  for (auto& [patch, cap] : domain.caps) {
    renumber(cap.tip);
    for (auto& quad : cap.quads) std::ranges::for_each(quad, renumber);
    std::ranges::for_each(cap.within, renumber);
    std::erase_if(cap.dropped, [&](int node) { return number[node] < 0; });
    std::ranges::for_each(cap.dropped, renumber);
  }
  for (SharpCorner& corner : domain.sharp_corners) renumber(corner.node);
  domain.nodes = nodes;
  domain.boundary = boundary_mesh(surface->model.fine, domain.chains, nodes);
  domain.boundary.unit = prepared.boundary.unit;
  domain.boundary.quads = prepared.boundary.quads;
  domain.boundary.quad_region = prepared.boundary.quad_region;
  for (auto& quad : domain.boundary.quads) std::ranges::for_each(quad, renumber);
  other->boundary = domain.boundary;
  other->surface = std::move(surface);
  return other;
}

/// Whether curves keep their nodes, as in images, given meshes and elements of higher order.
bool keeps_curves(const MeshingSetup& prepared) {
  const SurfaceSetup& surface = *prepared.surface;
  return surface.mirrored || surface.full_model || surface.metric || surface.given ||
         prepared.settings.order > 1 || !prepared.boundary.periodic.empty() ||
         !prepared.boundary.periodic_faces.empty();
}

/// The network's meshes that changed, and its nodes on curves, become the state's.
void take_over(const MeshingSetup& prepared, const CurvePlaces& places, LayoutNetwork& network,
               PipelineState& state) {
  std::vector<int> number;
  SurfaceNodes nodes = other_nodes(*prepared.surface, places, state.nodes, number);
  state.other = with_nodes(prepared, nodes, number, network);
  state.nodes = std::move(nodes);
  for (std::size_t p = 0; p < network.patches.size(); ++p) {
    if (!network.patches[p].changed) continue;
    QuadPatch& mesh = state.patches[p].quads;
    mesh = std::move(network.patches[p].mesh);
    const auto& points = state.other->patches[p].boundary.points;
    if (points.size() != static_cast<std::size_t>(mesh.n_boundary))
      throw std::logic_error("layouts: a patch has other nodes than its curves");
    std::ranges::copy(points, mesh.points.begin());
    state.patches[p].inside.clear();
  }
}

/// Returns the number of edges of a curve; a cap may have removed all its nodes, or some.
int edges_of(const std::vector<CurveNode>& nodes) { return static_cast<int>(nodes.size()) - 1; }

/// Returns the places of the nodes of a curve, or of so many edges spaced like them.
std::vector<double> spaced(const std::vector<CurveNode>& nodes, int edges) {
  std::vector<double> places;
  if (edges == edges_of(nodes)) {
    for (const CurveNode& node : nodes) places.push_back(node.s);
    return places;
  }
  const std::size_t n = nodes.size() - 1;
  for (int k = 0; k < edges; ++k) {
    const double at = static_cast<double>(k) * static_cast<double>(n) / edges;
    const auto i = static_cast<std::size_t>(at);
    places.push_back(nodes[i].s + (at - static_cast<double>(i)) * (nodes[i + 1].s - nodes[i].s));
  }
  places.push_back(nodes[n].s);
  return places;
}

}  // namespace

void run_joint_layouts(const MeshingSetup& prepared, PipelineState& state) {
  if (keeps_curves(prepared)) return;
  const Stopwatch watch;
  const SurfaceDomain& domain = prepared.surface->domain;
  const std::vector<char> may_change = patches_that_may_change(prepared, state);
  LayoutNetwork layouts;
  for (std::size_t c = 0; c < domain.chains.size(); ++c) {
    const int edges = edges_of(state.nodes.on_curve[c]);  // New ones are at most twice as long.
    layouts.curves.push_back({edges,
                              std::max(domain.chains[c].closed() ? kFewestLoopEdges : 1, (edges + 1) / 2),
                              !domain.chain_stays[c]});
  }
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    LayoutPatch& patch = layouts.patches.emplace_back();
    for (const auto& loop : domain.patches[p].outline)
      for (const CurveSide& side : loop)
        if (side.begins(domain.chains[side.chain]))
          patch.runs.push_back({side.chain, layouts.curves[side.chain].edges});
    if (!may_change[p] || std::ranges::any_of(patch.runs, [](const CurveRun& run) { return run.edges < 1; }))
      continue;
    patch.mesh = state.patches[p].quads;
    patch.boundary = prepared.patches[p].boundary;
    patch.cross = prepared.patches[p].cross.get();
    patch.size = prepared.patches[p].size.get();
  }
  layouts.boundary = [&](int p, const std::vector<int>& edges) -> std::optional<PatchBoundary> {
    SurfaceNodes nodes;
    nodes.on_curve.resize(edges.size());
    int n = static_cast<int>(state.nodes.points.size());
    for (const auto& [chain, now] : layouts.patches[p].runs) {
      const auto& old = state.nodes.on_curve[chain];
      auto& on_curve = nodes.on_curve[chain];
      if (!on_curve.empty()) continue;
      for (const double s : spaced(old, edges[chain])) on_curve.push_back({s, n++});
      on_curve.front().node = old.front().node, on_curve.back().node = old.back().node;  // shared
    }
    PatchBoundary boundary =
        place_boundary(domain.patches[p].map, domain.patches[p].outline, domain.chains, nodes);
    return meshable(boundary) ? std::optional(std::move(boundary)) : std::nullopt;
  };
  layouts.is_allowed = [](const QuadPatch& mesh, const PatchBoundary& boundary) {
    return !has_duplicate_quads(mesh, boundary.point_node);
  };
  const double price = regularity_options(prepared.settings.options).tolerance;
  const JointLayoutSummary summary = lay_out_jointly(layouts, price);
  add_summary(state.log, summary);
  state.log.add_time("layout", watch.time());
  if (summary.accepted == 0) return;
  CurvePlaces places;
  for (std::size_t c = 0; c < layouts.curves.size(); ++c)
    places.push_back(spaced(state.nodes.on_curve[c], layouts.curves[c].edges));
  take_over(prepared, places, layouts, state);
}

}  // namespace delquad
