#include "geometry/planar/layers/add_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/box.h"
#include "delquad/error.h"
#include "geometry/planar/layers/fit_layers.h"
#include "geometry/planar/layers/layer_builder.h"
#include "geometry/planar/layers/layer_heights.h"

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
          fmt::format("{}: the layers are {:.6g} thick and the domain is {:.6g} wide: expected "
                      "thinner layers",
                      specs[s].where, heights[s].back(), width));
}

void check_number(const LayerColumns& layers, std::span<const LayerSpec> specs, double most) {
  double quads = 0;
  for (int c = 0; c < layers.n_chains(); ++c)
    quads += static_cast<double>(layers.chain(c).spec.size()) * layers.n_layers(c);
  if (quads <= most) return;
  throw InputError(
      fmt::format("{}: the layers need about {:.3g} quads, more than the {:.3g} that are allowed "
                  "(max-elements)",
                  specs[0].where, quads, most));
}

void count(const LayerColumns& layers, LayerReport& result) {
  for (int c = 0; c < layers.n_chains(); ++c) {
    const int top = layers.n_layers(c);
    for (int k = 0; k < layers.chain(c).n_points(); ++k) {
      result.count.fans += layers.corner(c, k).quads;
      if (layers.scales[c][k] >= result.count.least_scale) continue;
      result.count.least_scale = layers.scales[c][k];
      result.least_at = layers.foot(c, k);
    }
    layers.for_each_pair(c, [&](int a, int b) {
      const auto& columns = layers.columns(c);
      if (columns[a].point == columns[b].point) return;
      ++result.count.columns;
      const int k = columns[a].at;
      const double last = layers.height(c, k, top) - layers.height(c, k, top - 1);
      const double edge = norm(layers.node(c, {a, top}) - layers.node(c, {b, top}));
      if (layers.scales[c][k] == 1) result.largest_jump = std::max(result.largest_jump, edge / last);
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
  Mesh& mesh = domain.boundary;
  std::vector<int> renamed(mesh.points.size(), -1);
  for (const auto& line : mesh.lines)
    for (const int v : line) renamed[v] = 0;
  for (const auto& quad : mesh.quads)
    for (const int v : quad) renamed[v] = 0;
  for (const PatchBoundary& patch : domain.patches)
    for (const int v : patch.point_node) renamed[v] = 0;
  int n = 0;
  for (std::size_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] < 0) continue;
    mesh.points[n] = mesh.points[v];
    if (!domain.places.empty()) domain.places[n] = domain.places[v];
    renamed[v] = n++;
  }
  mesh.points.resize(n);
  if (!domain.places.empty()) domain.places.resize(n);
  const auto rename = [&](auto& nodes) {
    for (int& v : nodes) v = renamed[v];
  };
  for (auto& line : mesh.lines) rename(line);
  for (auto& quad : mesh.quads) rename(quad);
  for (PatchBoundary& patch : domain.patches) rename(patch.point_node);
  for (PatchBoundary& patch : domain.outlines) rename(patch.point_node);
  rename(domain.on_crack);
  for (NamedPoint& named : mesh.named_points) named.point = renamed[named.point];
  domain.pieces.clear();
}

}  // namespace

LayerReport add_layers(PlanarDomain& domain, std::span<const LayerSpec> specs, double max_quads) {
  std::vector<std::vector<double>> heights;
  for (const LayerSpec& spec : specs) heights.push_back(layer_heights(spec));
  const std::vector<int> of_curve = layers_of_curves(domain, specs);
  check_thickness(domain, specs, heights);
  LayerReport result;
  ReplacedLines replaced;
  std::vector<PatchBoundary> rests;
  for (std::size_t i = 0; i < domain.patches.size(); ++i) {
    const std::vector<int>& curves = domain.patches[i].edge_curve;
    if (std::ranges::none_of(curves, [&](int c) { return c >= 0 && of_curve[c] >= 0; })) {
      domain.outlines.push_back(domain.patches[i]);
      rests.push_back(domain.patches[i]);
      continue;
    }
    LayerColumns layers(domain.patches[i], find_layer_chains(domain, i, specs, of_curve, heights), specs,
                        heights);
    check_number(layers, specs, max_quads);
    fit_layers(domain.patches[i], specs, layers);
    count(layers, result);
    const LayerBuilder builder(domain, i, layers);
    domain.outlines.push_back(builder.outline());
    rests.push_back(builder.rest());
    builder.replace_lines(replaced);
  }
  domain.patches = std::move(rests);
  replace(domain.boundary, replaced);
  drop_unused_nodes(domain);
  result.count.quads = static_cast<int>(domain.boundary.quads.size());
  return result;
}

}  // namespace delquad
