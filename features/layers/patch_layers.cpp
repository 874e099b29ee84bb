#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "base/text.h"
#include "delquad/error.h"
#include "features/layers/layer_walls.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// Lets patches know the walls on which layers of others end: those on the other side, and periodic ones.
class WallSharing {
 public:
  WallSharing(const PlanarDomain& domain, std::span<const LayerSpec> specs, const CurveLayers& layers,
              const BoundaryGraph& graph, std::vector<LayerChains>& found)
      : domain_(domain), specs_(specs), layers_(layers), graph_(graph), found_(found) {
    for (const PeriodicNodes& pair : domain.boundary.periodic) {
      auto& [there, back] = images_.emplace_back();
      for (const auto& [node, master] : pair.nodes) {
        there.insert_or_assign(master, node);
        back.insert_or_assign(node, master);
      }
    }
  }

  void share() {
    std::vector<std::pair<std::size_t, int>> queue;  // patches and walls
    for (std::size_t p = 0; p < found_.size(); ++p)
      for (std::size_t w = 0; w < found_[p].walls.size(); ++w) queue.emplace_back(p, static_cast<int>(w));
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const auto [p, w] = queue[i];
      std::vector<int> nodes;
      for (const int point : found_[p].walls[w].points) nodes.push_back(domain_.patches[p].point_node[point]);
      const int curve = found_[p].walls[w].curve;
      add(nodes, queue, true);
      for (std::size_t k = 0; k < images_.size(); ++k) {
        const PeriodicNodes& pair = domain_.boundary.periodic[k];
        if (curve == pair.master) add_image(images_[k][0], nodes, queue);
        if (curve == pair.curve) add_image(images_[k][1], nodes, queue);
      }
    }
  }

 private:
  using Queue = std::vector<std::pair<std::size_t, int>>;

  void add_image(const std::map<int, int>& image, const std::vector<int>& nodes, Queue& queue) {
    std::vector<int> images;
    for (const int v : nodes) {
      const auto found = image.find(v);
      if (found == image.end()) return;
      images.push_back(found->second);
    }
    add(images, queue, false);
  }

  /// The wall on these nodes, in the patches on both sides, or in that on its right alone.
  void add(std::vector<int> nodes, Queue& queue, bool reversed_only) {
    for (int side = 0; side < (reversed_only ? 1 : 2); ++side) {
      std::ranges::reverse(nodes);
      const auto edge = graph_.edge_from(nodes[0], nodes[1]);
      if (!edge || graph_.is_image((*edge)[0])) continue;
      const auto p = static_cast<std::size_t>((*edge)[0]);
      std::vector<int> points;
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const std::array<int, 2> one = *graph_.edge_from(nodes[i], nodes[i + 1]);
        check_free(p, one[1]);
        points.push_back(domain_.patches[p].edges[one[1]][0]);
        if (i + 2 == nodes.size()) points.push_back(domain_.patches[p].edges[one[1]][1]);
      }
      std::vector<LayerWall>& walls = found_[p].walls;
      if (std::ranges::find(walls, points, &LayerWall::points) != walls.end()) continue;
      walls.push_back(make_layer_wall(domain_, p, std::move(points), graph_, specs_[0].where));
      queue.emplace_back(p, static_cast<int>(walls.size()) - 1);
    }
  }

  /// No layers stand on the edge.
  void check_free(std::size_t patch, int edge) const {
    const int curve = domain_.patches[patch].edge_curve[edge];
    const int spec = layers_.at(curve, domain_.patch_region[patch]);
    if (spec < 0) return;
    const Vec2 at = domain_.patches[patch].points[domain_.patches[patch].edges[edge][0]];
    throw InputError(
        fmt::format("{}: other layers end on {} at {}, where it has layers on its other side, or "
                    "at its periodic image: expected layers on both sides",
                    specs_[spec].where, curve_title(domain_.boundary.curves[curve]), show_point(at)));
  }

  const PlanarDomain& domain_;
  std::span<const LayerSpec> specs_;
  const CurveLayers& layers_;
  const BoundaryGraph& graph_;
  std::vector<LayerChains>& found_;
  std::vector<std::array<std::map<int, int>, 2>> images_;  ///< of periodic nodes, there and back
};

}  // namespace

std::vector<PatchLayers> find_patch_layers(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                                           const CurveLayers& layers, const BoundaryGraph& graph,
                                           const std::vector<std::vector<double>>& heights) {
  std::vector<LayerChains> found;
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    found.push_back(graph.is_image(static_cast<int>(p)) ? LayerChains{}
                                                        : find_layer_chains(domain, p, specs, layers, graph));
  WallSharing(domain, specs, layers, graph, found).share();
  std::vector<PatchLayers> result;
  for (std::size_t p = 0; p < found.size(); ++p)
    if (!found[p].chains.empty() || !found[p].walls.empty())
      result.push_back({static_cast<int>(p), LayerColumns(domain.patches[p], found[p], specs, heights)});
  return result;
}

}  // namespace delquad
