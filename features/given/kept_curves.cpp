#include "features/given/given_surface.h"

#include <utility>

#include "patches/surface_curves.h"

namespace delquad {
namespace {

/// All points of the curves as nodes.
SurfaceNodes nodes_at_points(const Mesh& fine, const std::vector<CurveChain>& chains) {
  std::vector<int> node(fine.points.size(), -1);
  for (const CurveChain& chain : chains)
    for (const int v : chain.points) node[v] = 0;
  SurfaceNodes nodes;
  for (std::size_t v = 0; v < node.size(); ++v) {
    if (node[v] < 0) continue;
    node[v] = static_cast<int>(nodes.points.size());
    nodes.points.push_back(fine.points[v]);
  }
  for (const CurveChain& chain : chains) {
    auto& on_curve = nodes.on_curve.emplace_back();
    for (std::size_t i = 0; i < chain.points.size(); ++i)
      on_curve.push_back({static_cast<double>(i), node[chain.points[i]]});
  }
  return nodes;
}

}  // namespace

SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size) {
  SurfaceCurves curves = find_curves(model, std::move(flattening), size);
  SurfaceDomain domain;
  domain.nodes = nodes_at_points(model.fine, curves.chains);
  domain.sharp_corners =
      find_sharp_corners(curves.corners, curves.chains, curves.maps, domain.nodes, kBadEta);
  domain.patches.resize(curves.maps.size());
  for_each_patch(model.fine, curves.maps, [&](std::size_t p) {
    SurfacePatch& patch = domain.patches[p];
    patch.background = std::make_shared<BackgroundMesh>(curves.maps[p].flat);
    patch.boundary = place_boundary(curves.maps[p], curves.outlines[p], curves.chains, domain.nodes);
    patch.map = std::move(curves.maps[p]);
    patch.outline = std::move(curves.outlines[p]);
  });
  for (const SurfacePatch& patch : domain.patches)
    if (patch.boundary.edges.size() % 2 != 0)
      domain.warnings.push_back({"faces with an odd boundary", 0,
                                 face_name(model.fine, patch.map) + " has an odd number of boundary edges"});
  domain.boundary = boundary_mesh(model.fine, curves.chains, domain.nodes);
  for (const CurveChain& chain : curves.chains)
    domain.chain_stays.push_back(curves.cut_face[chain.curve] < 0 ? 1 : 0);
  domain.chains = std::move(curves.chains);
  domain.cut_face = std::move(curves.cut_face);
  return domain;
}

}  // namespace delquad
