#include "features/layers/mirror_layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// The curve of the edge from each node to the next.
std::map<std::pair<int, int>, int> curves_of_edges(const PatchBoundary& patch) {
  std::map<std::pair<int, int>, int> curves;
  for (std::size_t e = 0; e < patch.edges.size(); ++e)
    curves[{patch.point_node[patch.edges[e][0]], patch.point_node[patch.edges[e][1]]}] = patch.edge_curve[e];
  return curves;
}

class LayerMirror {
 public:
  LayerMirror(PlanarDomain& domain, std::vector<LayeredPatch>& layered) : domain_(domain), layered_(layered) {
    for (const LayeredPatch& patch : layered)
      for (const auto& [old, nodes] : patch.walls) add_wall(old, nodes);
  }

  void mirror(PatchImage& image) {
    const LayeredPatch& master = layered_[image.master];
    const PatchBoundary &old = domain_.patches[image.master], &own = domain_.patches[image.patch];
    image_of_.clear();
    curves_.clear();
    const std::map<std::pair<int, int>, int> own_curves = curves_of_edges(own);
    const auto own_curve = [&](int a, int b) {
      return own_curves.at(image.is_mirrored ? std::pair(b, a) : std::pair(a, b));
    };
    for (std::size_t i = 0; i < image.point.size(); ++i)
      image_of_[old.point_node[i]] = own.point_node[image.point[i]];
    for (std::size_t e = 0; e < old.edges.size(); ++e) {
      const int a = old.point_node[old.edges[e][0]], b = old.point_node[old.edges[e][1]];
      curves_[{a, b}] = own_curve(image_of_.at(a), image_of_.at(b));
    }
    LayeredPatch& result = layered_[image.patch];
    for (const auto& [from, nodes] : master.walls) {
      std::vector<int> to;
      for (const int v : from) to.push_back(image_of_.at(v));
      const auto known = walls_.find({to[0], to[1]});
      for (std::size_t i = 1; i + 1 < nodes.size(); ++i)
        image_of_[nodes[i]] = known == walls_.end() ? add_node(nodes[i], image) : known->second[i];
      std::vector<int> images;
      for (const int v : nodes) images.push_back(image_of_.at(v));
      if (known == walls_.end()) add_wall(to, images);
      const int curve = curves_.at({from[0], from[1]});
      for (std::size_t i = 1; i < nodes.size(); ++i) curves_[{nodes[i - 1], nodes[i]}] = curve;
      if (image.is_mirrored) {
        std::ranges::reverse(to);
        std::ranges::reverse(images);
      }
      result.walls.emplace_back(std::move(to), std::move(images));
    }
    add_quads(master, image, result);
    result.outline = boundary(master.outline, image, nullptr);
    std::vector<int> point;
    result.rest = boundary(master.rest, image, &point);
    image.point = std::move(point);
  }

 private:
  void add_wall(const std::vector<int>& old, const std::vector<int>& nodes) {
    walls_[{old[0], old[1]}] = nodes;
    const std::size_t n = old.size();
    walls_[{old[n - 1], old[n - 2]}] = {nodes.rbegin(), nodes.rend()};
  }

  int add_node(int node, const PatchImage& image) {
    std::vector<Vec3>& points = domain_.boundary.points;
    const Vec2 x = image.motion({points[node].x, points[node].y});
    const double z = points[0].z;
    points.push_back({x.x, x.y, z});
    if (!domain_.places.empty()) domain_.places.emplace_back();
    return static_cast<int>(points.size()) - 1;
  }

  int image_node(int node, const PatchImage& image) {
    const auto known = image_of_.find(node);
    if (known != image_of_.end()) return known->second;
    return image_of_[node] = add_node(node, image);
  }

  void add_quads(const LayeredPatch& master, const PatchImage& image, LayeredPatch& result) {
    Mesh& mesh = domain_.boundary;
    result.quads.first = mesh.quads.size();
    for (std::size_t q = master.quads.first; q < master.quads.second; ++q) {
      std::array<int, 4> quad = mesh.quads[q];
      for (int& v : quad) v = image_node(v, image);
      if (image.is_mirrored) std::reverse(quad.begin() + 1, quad.end());
      mesh.quads.push_back(quad);
      mesh.quad_region.push_back(domain_.patch_region[image.patch]);
    }
    result.quads.second = mesh.quads.size();
  }

  /// With the points in the master's order; those of a mirror image run the other way.
  PatchBoundary boundary(const PatchBoundary& master, const PatchImage& image, std::vector<int>* point) {
    PatchBoundary result = master;
    for (std::size_t i = 0; i < master.points.size(); ++i) {
      const int node = master.point_node[i];
      result.point_node[i] = image_node(node, image);
      result.points[i] = image.motion(master.points[i]);
      if (point != nullptr) point->push_back(static_cast<int>(i));
    }
    for (std::size_t e = 0; e < master.edges.size(); ++e) {
      const auto [a, b] = master.edges[e];
      const auto curve = curves_.find({master.point_node[a], master.point_node[b]});
      result.edge_curve[e] = curve == curves_.end() ? -1 : curve->second;
      if (image.is_mirrored) result.edges[e] = {b, a};
    }
    for (Vec2& seed : result.seeds) seed = image.motion(seed);
    return result;
  }

  PlanarDomain& domain_;
  std::vector<LayeredPatch>& layered_;
  std::map<std::pair<int, int>, std::vector<int>> walls_;  ///< new nodes, by the first two of the old ones
  std::map<int, int> image_of_;                            ///< of nodes, in the image at hand
  std::map<std::pair<int, int>, int> curves_;              ///< there, by an edge of the master
};

}  // namespace

void check_layers_symmetric(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                            const CurveLayers& layers) {
  for (const PatchImage& image : domain.images) {
    const PatchBoundary &master = domain.patches[image.master], &own = domain.patches[image.patch];
    std::vector<std::size_t> edge_at(own.points.size());
    for (std::size_t e = 0; e < own.edges.size(); ++e) edge_at[own.edges[e][0]] = e;
    for (std::size_t e = 0; e < master.edges.size(); ++e) {
      const auto& [a, b] = master.edges[e];
      const int curve = master.edge_curve[e];
      const int other = own.edge_curve[edge_at[image.point[image.is_mirrored ? b : a]]];
      const int one = layers.at(curve, domain.patch_region[image.master]);
      const int two = layers.at(other, domain.patch_region[image.patch]);
      if (one == two) continue;
      const auto title = [&](int c) { return curve_title(domain.boundary.curves[c]); };
      throw InputError(fmt::format(
          "{}: {} and {} are mirror images at {} and have not the same layer: "
          "expected it on both",
          specs[std::max(one, two)].where, title(curve), title(other), show_point(master.points[a])));
    }
  }
}

void mirror_layers(PlanarDomain& domain, std::vector<LayeredPatch>& layered) {
  LayerMirror mirror(domain, layered);
  for (PatchImage& image : domain.images)
    if (!layered[image.master].rest.points.empty()) mirror.mirror(image);
}

}  // namespace delquad
