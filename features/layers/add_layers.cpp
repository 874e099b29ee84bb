// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/layers/add_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "base/box.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/layers/layer_builder.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/patches/patch_outline.h"
#include "geometry/planar/domain_builder.h"

namespace delquad {
namespace {

using ReplacedLines = std::map<std::pair<int, int>, std::vector<int>>;

void check_thickness(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                     const std::vector<std::vector<double>>& heights) {
  const auto [low, high] = Box<Vec3>::around(domain.boundary.points);
  const Vec3 size = high - low;
  const double width = domain.in_space != nullptr ? norm(size) : std::min(size.x, size.y);
  for (std::size_t s = 0; s < specs.size(); ++s)
    if (heights[s].back() >= width)
      throw InputError(
          fmt::format("{}: the layers on '{}' are {:.6g} thick and the domain is {:.6g} wide: expected "
                      "thinner layers [no-place-for-layers]",
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
                  "(max-elements) [too-many-quads]",
                  specs[0].where, quads, most));
}

void count(const PlanarDomain& domain, const PatchLayers& patch, LayerReport& result) {
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
      result.count.fans += layers.corner(c, k).quads;
      if (layers.scales[c][k] >= result.count.least_scale) continue;
      result.count.least_scale = layers.scales[c][k];
      result.least_at = show_node(domain, layers.foot_node(c, k));
      result.least_on = title(k);
    }
    layers.for_each_pair(c, [&](int a, int b) {
      const auto& columns = layers.columns(c);
      if (columns[a].point == columns[b].point) return;
      ++result.count.columns;
      const int k = columns[a].at, top = layers.layers_between(c, a, b);
      const double last = layers.height(c, k, top) - layers.height(c, k, top - 1);
      const double edge = norm(layers.node(c, {a, top}) - layers.node(c, {b, top})) / layers.stretch(c, k);
      if (layers.scales[c][k] < 1 || edge <= result.largest_jump * last) return;
      result.largest_jump = edge / last;
      result.jump_on = title(k) + " at " + show_node(domain, layers.foot_node(c, k));
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

/// All nodes of a wall in the place of its first line, none in the places of the others.
void add_replaced(const std::vector<std::pair<std::vector<int>, std::vector<int>>>& walls,
                  ReplacedLines& replaced) {
  for (const auto& [old, nodes] : walls)
    for (std::size_t i = 0; i + 1 < old.size(); ++i)
      replaced[{old[i], old[i + 1]}] = i == 0 ? nodes : std::vector<int>();
}

/// Points of patches at layered curves get the places of their nodes, which are off the fine triangles.
void put_on_true_curves(const CurveLayers& layers, PlanarDomain& domain) {
  std::vector<char> is_layered(domain.boundary.points.size(), 0);
  for (std::size_t l = 0; l < domain.boundary.lines.size(); ++l)
    for (const int v : domain.boundary.lines[l])
      if (!layers.of_curve[domain.boundary.line_curve[l]].empty()) is_layered[v] = 1;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    PatchBoundary& patch = domain.patches[p];
    if (std::ranges::none_of(patch.point_node, [&](int v) { return is_layered[v] != 0; })) continue;
    for (std::size_t i = 0; i < patch.points.size(); ++i)
      patch.points[i] = domain.in_space->in_plane(
          static_cast<int>(p), domain.boundary.points[patch.point_node[i]], patch.points[i]);
  }
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
      fit_layers(domain, patches[p].patch, specs, patches[p].columns, round > 0);
    left = walls.lower_shared_scales();
  }
}

}  // namespace

LayerReport add_layers(PlanarDomain& domain, std::span<const LayerSpec> specs, double max_quads) {
  std::vector<std::vector<double>> heights;
  for (const LayerSpec& spec : specs) heights.push_back(layer_heights(spec));
  const CurveLayers of_curves = layers_of_curves(domain, specs);
  check_thickness(domain, specs, heights);
  if (domain.in_space != nullptr) put_on_true_curves(of_curves, domain);
  const BoundaryGraph graph(domain);
  std::vector<PatchLayers> patches = find_patch_layers(domain, specs, of_curves, graph, heights);
  check_number(patches, specs, max_quads);
  LayerWalls walls(domain, patches, specs);
  fit(domain, specs, patches, walls);
  walls.count_edges();
  LayerReport result;
  std::vector<LayeredPatch> layered(domain.patches.size());
  for (const PatchLayers& patch : patches) {
    count(domain, patch, result);
    layered[patch.patch] = build_layers(domain, patch, walls);
  }
  walls.pair_nodes();
  if (domain.in_space != nullptr) result.walls = walls.nodes();
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
  if (domain.in_space == nullptr) {
    replace(domain.boundary, replaced);
    drop_unused_nodes(domain);
  }
  result.count.quads = static_cast<int>(domain.boundary.quads.size());
  return result;
}

namespace {

/// Edges of fronts below this part of the size make it less.
constexpr double kShortFront = 0.8;
/// Most length of edges at the corner of a fan, by the height of its first layer. Quads of 45 degrees have
/// 0.4 of the square of that height.
constexpr double kLongestAtFan = 25;
/// Least length of these, by the thickness of the layers. The last quads of the fan are 0.4 of it long, and
/// quads outside get poor if edges beside them are far shorter.
constexpr double kShortestAtFan = 1.0 / 60;
/// Beyond this, solvers see the jump from the last layer to the quads beside it.
constexpr double kLargeJump = 4;

/// On surfaces of the edges with nodes from `first_new` on.
std::vector<LocalSize> short_boundary_edges(const PlanarDomain& domain, int first_new,
                                            const SizeField& size) {
  std::vector<LocalSize> spots;
  int hint = -1;
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& [i, j] : patch.edges) {
      const int v = patch.point_node[i], w = patch.point_node[j];
      if (domain.in_space != nullptr && std::max(v, w) < first_new) continue;
      const Vec3 &a = domain.boundary.points[v], &b = domain.boundary.points[w];
      const double length = norm(b - a);
      if (length < kShortFront * size.at(0.5 * (a + b), hint)) spots.push_back({a, b, length, length});
    }
  return spots;
}

void warn_of_layers(const std::string& where, const LayerReport& layers, std::vector<Warning>& warnings) {
  if (layers.count.least_scale < 1)
    warnings.emplace_back(
        fmt::format("{}: layers are lower where there is no room for them, down to {:.2g} of their height at "
                    "{} on {} [low-layers]",
                    where, layers.count.least_scale, layers.least_at, layers.least_on));
  if (layers.largest_jump > kLargeJump)
    warnings.emplace_back(
        fmt::format("{}: edges on the last layer are up to {:.3g} times as long as it is high, on {}. Ask "
                    "for more layers, or a smaller size there [long-last-layer]",
                    where, layers.largest_jump, layers.jump_on));
}

/// Regions that got layers are no grids any more. Throws InputError where they were asked to be.
void drop_grids(const std::string& where, const MappedSpec& grids, const LayerReport& layers,
                PlanarDomain& domain) {
  std::erase_if(domain.mapped, [&](const auto& mapped) {
    if (std::ranges::find(layers.patches, mapped.patch) == layers.patches.end()) return false;
    if (mapped.is_requested)
      throw InputError(fmt::format(
          "{}: layers stand in the grid '{}' ({}), or end on its sides: expected the one or the other, or "
          "layers 'into' other regions",
          where, region_label(domain.boundary.regions[domain.patch_region[mapped.patch]]), grids.where));
    return true;
  });
}

/// Returns a background mesh of the parts of patches without layers; null on a surface.
std::shared_ptr<const BackgroundMesh> mesh_rest(std::span<const LayerSpec> layers, const PlanarDomain& domain,
                                                const std::vector<int>& changed) {
  const auto no_place = [&](const std::string& why) {
    std::vector<std::string> on;
    for (const LayerSpec& layer : layers) on.insert(on.end(), layer.on.begin(), layer.on.end());
    return InputError(
        fmt::format("{}: there is no place for the layers on '{}': beside them, {} [no-place-for-layers]",
                    layers[0].where, fmt::join(on, "', '"), why));
  };
  for (const int p : changed)
    if (domain.in_space != nullptr && !meshable(domain.patches[p]))
      throw no_place(fmt::format("the boundary of face {} crosses itself",
                                 domain.boundary.regions[domain.patch_region[p]].tag));
  if (domain.in_space != nullptr) return nullptr;
  try {
    return std::make_shared<BackgroundMesh>(domain.patches);
  } catch (const InputError& error) {
    throw no_place(error.what());
  }
}

}  // namespace

std::vector<LocalSize> fan_spots(const PlanarDomain& domain, std::span<const LayerSpec> specs) {
  std::vector<LocalSize> spots;
  if (specs.empty()) return spots;
  std::vector<std::vector<double>> heights;
  for (const LayerSpec& spec : specs) heights.push_back(layer_heights(spec));
  const CurveLayers of_curves = layers_of_curves(domain, specs);
  const BoundaryGraph graph(domain);
  for (const PatchLayers& patch : find_patch_layers(domain, specs, of_curves, graph, heights))
    for (int c = 0; c < patch.columns.n_chains(); ++c)
      for (int k = 0; k < patch.columns.chain(c).n_points(); ++k) {
        const double first = patch.columns.height(c, k, 1);
        const double most = std::max(kLongestAtFan * first, kShortestAtFan * patch.columns.thickness(c, k));
        if (patch.columns.corner(c, k).quads == 0 || std::ranges::max(patch.columns.edges_at(c, k)) <= most)
          continue;
        const Vec3& corner = domain.boundary.points[patch.columns.foot_node(c, k)];
        spots.push_back({corner, corner, most, 0});
      }
  return spots;
}

std::vector<LocalSize> put_layers(std::span<const LayerSpec> layers, const MappedSpec& grids,
                                  PlanarDomain& domain, MeshingSetup& p) {
  const int first_new = static_cast<int>(domain.boundary.points.size());
  LayerReport report = add_layers(domain, layers, static_cast<double>(p.settings.max_elements));
  drop_grids(layers[0].where, grids, report, domain);
  p.plane.background = mesh_rest(layers, domain, report.patches);
  warn_of_layers(layers[0].where, report, p.warnings);
  std::vector<LocalSize> fine = short_boundary_edges(domain, first_new, *p.size.field);
  p.layers = std::make_shared<LayerReport>(std::move(report));
  if (!fine.empty()) p.size.adapted_to.push_back("layers");
  return fine;
}

std::vector<char> layered_curves(const Mesh& fine, std::span<const LayerSpec> specs) {
  std::vector<char> is_layered(fine.curves.size(), 0);
  for (const LayerSpec& spec : specs)
    for (const std::string& name : spec.on) {
      if (entities_named(fine.curves, "curve", name).empty() &&
          !entities_named(fine.regions, "region", name).empty())
        throw InputError(
            fmt::format("{}: '{}' names faces, and layers stand on curves: name curves by surface.name with "
                        "of = \"curves\" [unknown-name]",
                        spec.where, name));
      for (const int c : find_entities(fine.curves, "curve", name, spec.where)) is_layered[c] = 1;
    }
  return is_layered;
}

std::vector<char> quads_in_layers(const MeshingSetup& prepared, const Mesh& mesh) {
  std::vector<int> left(prepared.boundary.regions.size(), 0);
  const MirroredSurface* mirrored = prepared.surface ? prepared.surface->mirrored.get() : nullptr;
  const int images = mirrored != nullptr ? 1 << mirrored->planes.count() : 1;
  const auto add = [&](int region) {
    ++left[region];
    for (int planes = 1; planes < images; ++planes)
      if ((planes & mirrored->face_planes[region]) == 0) ++left[image_face(*mirrored, planes, region)];
  };
  if (prepared.layers) std::ranges::for_each(prepared.boundary.quad_region, add);
  std::vector<char> in_layers;
  for (const int region : mesh.quad_region)
    in_layers.push_back(region < static_cast<int>(left.size()) && left[region]-- > 0);
  return in_layers;
}

}  // namespace delquad
