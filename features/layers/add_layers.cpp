#include "features/layers/add_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/box.h"
#include "delquad/error.h"
#include "delquad/model.h"
#include "features/layers/fit_layers.h"
#include "features/layers/layer_builder.h"
#include "features/layers/mirror_layers.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/planar/domain_builder.h"

namespace delquad {
namespace {

using ReplacedLines = std::map<std::pair<int, int>, std::vector<int>>;

void check_thickness(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                     const std::vector<std::vector<double>>& heights) {
  const auto [low, high] = Box<Vec3>::around(domain.boundary.points);
  const double width = std::min(high.x - low.x, high.y - low.y);
  for (std::size_t s = 0; s < specs.size(); ++s)
    if (heights[s].back() >= width)
      throw InputError(
          fmt::format("{}: the layers on '{}' are {:.6g} thick and the domain is {:.6g} wide: expected "
                      "thinner layers",
                      specs[s].where, fmt::join(specs[s].on, "', '"), heights[s].back(), width));
}

void check_number(const std::vector<PatchLayers>& patches, std::span<const LayerSpec> specs, double most) {
  double quads = 0;
  for (const PatchLayers& patch : patches)
    for (int c = 0; c < patch.columns.n_chains(); ++c)
      for (std::size_t k = 0; k < patch.columns.chain(c).spec.size(); ++k)
        quads += patch.columns.layers_on(c, static_cast<int>(k));
  if (quads <= most) return;
  throw InputError(
      fmt::format("{}: the layers need about {:.3g} quads, more than the {:.3g} that are allowed "
                  "(max-elements)",
                  specs[0].where, quads, most));
}

/// `images`: how many mirror images the patch has.
void count(const PlanarDomain& domain, const PatchLayers& patch, int images, LayerReport& result) {
  const LayerColumns& layers = patch.columns;
  const PatchBoundary& boundary = domain.patches[patch.patch];
  std::vector<int> curve(boundary.points.size());
  for (std::size_t e = 0; e < boundary.edges.size(); ++e)
    curve[boundary.edges[e][0]] = boundary.edge_curve[e];
  for (int c = 0; c < layers.n_chains(); ++c) {
    const LayerChain& chain = layers.chain(c);
    const auto title = [&](int k) {
      const int on = std::min(k, static_cast<int>(chain.spec.size()) - 1);
      return curve_title(domain.boundary.curves[curve[chain.points[on]]]);
    };
    for (int k = 0; k < chain.n_points(); ++k) {
      result.count.fans += (1 + images) * layers.corner(c, k).quads;
      if (layers.scales[c][k] >= result.count.least_scale) continue;
      result.count.least_scale = layers.scales[c][k];
      result.least_at = layers.foot(c, k);
      result.least_on = title(k);
    }
    layers.for_each_pair(c, [&](int a, int b) {
      const auto& columns = layers.columns(c);
      if (columns[a].point == columns[b].point) return;
      result.count.columns += 1 + images;
      const int k = columns[a].at, top = layers.layers_between(c, a, b);
      const double last = layers.height(c, k, top) - layers.height(c, k, top - 1);
      const double edge = norm(layers.node(c, {a, top}) - layers.node(c, {b, top}));
      if (layers.scales[c][k] < 1 || edge <= result.largest_jump * last) return;
      result.largest_jump = edge / last;
      result.jump_on = title(k);
    });
  }
}

void replace(Mesh& mesh, ReplacedLines& replaced) {
  std::vector<std::array<int, 2>> lines;
  std::vector<int> curves;
  const auto add = [&](int a, int b, int curve) {
    lines.push_back({a, b});
    curves.push_back(curve);
  };
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    const auto found = replaced.find({a, b});
    if (found == replaced.end()) {
      add(a, b, mesh.line_curve[l]);
      continue;
    }
    const std::vector<int>& nodes = found->second;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) add(nodes[i], nodes[i + 1], mesh.line_curve[l]);
  }
  mesh.lines = std::move(lines);
  mesh.line_curve = std::move(curves);
}

/// Nodes that walls had before.
void drop_unused_nodes(PlanarDomain& domain) {
  const Mesh& mesh = domain.boundary;
  std::vector<char> used(mesh.points.size(), 0);
  for (const auto& line : mesh.lines)
    for (const int v : line) used[v] = 1;
  for (const auto& quad : mesh.quads)
    for (const int v : quad) used[v] = 1;
  for (const PatchBoundary& patch : domain.patches)
    for (const int v : patch.point_node) used[v] = 1;
  domain.pieces.clear();
  keep_nodes(domain, used);
}

/// All nodes of a wall in the place of its first line, none in that of the others.
void add_replaced(const std::vector<std::pair<std::vector<int>, std::vector<int>>>& walls,
                  ReplacedLines& replaced) {
  for (const auto& [old, nodes] : walls)
    for (std::size_t i = 0; i + 1 < old.size(); ++i)
      replaced[{old[i], old[i + 1]}] = i == 0 ? nodes : std::vector<int>();
}

/// Layers that end at one place have the same height there.
void fit(const PlanarDomain& domain, std::span<const LayerSpec> specs, std::vector<PatchLayers>& patches,
         LayerWalls& walls) {
  constexpr int kMostRounds = 100;
  std::vector<std::size_t> left(patches.size());
  std::iota(left.begin(), left.end(), 0);
  for (int round = 0; !left.empty(); ++round) {
    if (round == kMostRounds)
      throw InputError(specs[0].where + ": layers that end at one place find no common height there");
    for (const std::size_t p : left)
      fit_layers(domain.patches[patches[p].patch], specs, patches[p].columns, round > 0);
    left = walls.lower_alike();
  }
}

}  // namespace

LayerReport add_layers(PlanarDomain& domain, std::span<const LayerSpec> specs, double max_quads) {
  std::vector<std::vector<double>> heights;
  for (const LayerSpec& spec : specs) heights.push_back(layer_heights(spec));
  const CurveLayers of_curves = layers_of_curves(domain, specs);
  check_thickness(domain, specs, heights);
  check_layers_symmetric(domain, specs, of_curves);
  const BoundaryGraph graph(domain);
  std::vector<PatchLayers> patches = find_patch_layers(domain, specs, of_curves, graph, heights);
  check_number(patches, specs, max_quads);
  LayerWalls walls(domain, patches, specs);
  fit(domain, specs, patches, walls);
  walls.count_edges();
  std::vector<int> images(domain.patches.size(), 0);
  for (const PatchImage& image : domain.images) ++images[image.master];
  LayerReport result;
  std::vector<LayeredPatch> layered(domain.patches.size());
  for (const PatchLayers& patch : patches) {
    count(domain, patch, images[patch.patch], result);
    const LayerBuilder builder(domain, patch, walls);
    layered[patch.patch] = {builder.outline(), builder.rest(), builder.replaced_walls(), builder.quads()};
  }
  walls.pair_nodes();
  mirror_layers(domain, layered);
  ReplacedLines replaced;
  for (std::size_t p = 0; p < layered.size(); ++p) {
    LayeredPatch& patch = layered[p];
    const bool is_same = patch.rest.points.empty();
    domain.outlines.push_back(is_same ? domain.patches[p] : std::move(patch.outline));
    if (is_same) continue;
    domain.patches[p] = std::move(patch.rest);
    result.patches.push_back(static_cast<int>(p));
    add_replaced(patch.walls, replaced);
  }
  replace(domain.boundary, replaced);
  drop_unused_nodes(domain);
  result.count.quads = static_cast<int>(domain.boundary.quads.size());
  return result;
}

}  // namespace delquad
