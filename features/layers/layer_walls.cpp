// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/layers/layer_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "delquad/error.h"
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
      if (!edge) continue;
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
    const PatchBoundary& boundary = domain_.patches[patch];
    const int at = boundary.point_node[boundary.edges[edge][0]];
    throw InputError(
        fmt::format("{}: other layers end on {} at {}, where it has layers on its other side, or "
                    "at its periodic image: expected layers on both sides",
                    specs_[spec].where, curve_title(domain_.boundary.curves[curve]), show_node(domain_, at)));
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
    found.push_back(find_layer_chains(domain, p, specs, layers, graph));
  WallSharing(domain, specs, layers, graph, found).share();
  std::vector<PatchLayers> result;
  for (std::size_t p = 0; p < found.size(); ++p)
    if (!found[p].chains.empty() || !found[p].walls.empty())
      result.push_back(
          {static_cast<int>(p), LayerColumns(domain, static_cast<int>(p), found[p], specs, heights)});
  return result;
}

namespace {

/// Scales that differ by this part of them are the same.
constexpr double kSameScale = 1e-9;

}  // namespace

LayerWalls::LayerWalls(PlanarDomain& domain, std::vector<PatchLayers>& patches,
                       std::span<const LayerSpec> specs)
    : domain_(domain), patches_(patches), specs_(specs) {
  list_walls();
  pair_walls();
  group_ends();
  for (const std::vector<ChainEnd>& group : groups_)
    if (group.size() > 1) join(group);
  mark_taken();
}

void LayerWalls::list_walls() {
  std::map<std::pair<int, int>, int> known;  // by the first two nodes
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    LayerColumns& columns = patches_[p].columns;
    const PatchBoundary& patch = domain_.patches[patches_[p].patch];
    for (int w = 0; w < static_cast<int>(columns.found().walls.size()); ++w) {
      LayerWall& wall = columns.wall(w);
      const auto node = [&](std::size_t i) { return patch.point_node[wall.points[i]]; };
      const std::size_t n = wall.points.size();
      const auto other = known.find({node(n - 1), node(n - 2)});
      wall.is_reversed = other != known.end();
      wall.id = wall.is_reversed ? other->second : static_cast<int>(walls_.size());
      if (!wall.is_reversed) {
        known[{node(0), node(1)}] = wall.id;
        walls_.push_back({p, w, {}});
      }
      walls_[wall.id].seen_by.emplace_back(p, w);
      for (const int local : {0, 1})
        if (const int c = wall.chain[local]; c >= 0)
          walls_[wall.id].ends[wall.is_reversed ? 1 - local : local].push_back({p, c, 1 - local});
    }
  }
}

void LayerWalls::pair_walls() {
  const std::vector<PeriodicNodes>& periodic = domain_.boundary.periodic;
  for (std::size_t k = 0; k < periodic.size(); ++k) {
    std::map<int, int> master_of;
    for (const auto& [node, master] : periodic[k].nodes) master_of.insert_or_assign(node, master);
    for (int id = 0; id < static_cast<int>(walls_.size()); ++id)
      if (walls_[id].master < 0 && shape_of(walls_[id]).curve == periodic[k].curve)
        pair_wall(id, static_cast<int>(k), master_of);
  }
}

void LayerWalls::pair_wall(int image, int pairing, const std::map<int, int>& master_of) {
  const auto nodes_of = [&](const Wall& wall) {
    std::vector<int> nodes;
    for (const int p : shape_of(wall).points)
      nodes.push_back(domain_.patches[patches_[wall.patch].patch].point_node[p]);
    return nodes;
  };
  std::vector<int> masters;
  for (const int v : nodes_of(walls_[image])) {
    const auto found = master_of.find(v);
    if (found == master_of.end()) return;
    masters.push_back(found->second);
  }
  for (int id = 0; id < static_cast<int>(walls_.size()); ++id) {
    std::vector<int> nodes = nodes_of(walls_[id]);
    const bool forward = nodes == masters;
    if (!forward) std::ranges::reverse(nodes);
    if (!forward && nodes != masters) continue;
    Wall& wall = walls_[image];
    wall.master = id;
    wall.pairing = pairing;
    wall.runs_as_master = forward;
    wall.is_paired = walls_[id].is_paired = true;
  }
}

void LayerWalls::group_ends() {
  for (Wall& wall : walls_)
    for (const int end : {0, 1}) {
      if (wall.master >= 0) continue;
      wall.group[end] = static_cast<int>(groups_.size());
      groups_.push_back(wall.ends[end]);
    }
  for (Wall& wall : walls_) {
    if (wall.master < 0) continue;
    const Wall& master = walls_[wall.master];
    for (const int end : {0, 1}) {
      const int there = wall.runs_as_master ? end : 1 - end;
      wall.group[end] = master.group[there];
      if (wall.ends[end].empty() != master.ends[there].empty()) {
        const ChainEnd& one = wall.ends[end].empty() ? master.ends[there][0] : wall.ends[end][0];
        const int at = columns(one).foot_node(one.chain, point_of(one));
        const auto title = [&](const Wall& w) {
          return curve_title(domain_.boundary.curves[shape_of(w).curve]);
        };
        throw InputError(
            fmt::format("{}: layers end on {} at {}, and none at its periodic image on {}: "
                        "expected layers at "
                        "both, or at none",
                        specs_[spec_of(one)].where, title(wall.ends[end].empty() ? master : wall),
                        show_node(domain_, at), title(wall.ends[end].empty() ? wall : master)));
      }
      std::vector<ChainEnd>& group = groups_[master.group[there]];
      group.insert(group.end(), wall.ends[end].begin(), wall.ends[end].end());
    }
  }
}

/// Ends lie at the same places of their walls.
void LayerWalls::join(const std::vector<ChainEnd>& group) {
  const auto number = [&](const ChainEnd& e) { return columns(e).layers_at(e.chain, point_of(e)); };
  double slant = 1;
  for (const ChainEnd& e : group) {
    if (number(e) != number(group[0])) {
      const int at = columns(e).foot_node(e.chain, point_of(e));
      throw InputError(
          fmt::format("{}: {} layers meet {} of {} on one curve, or on periodic ones, at {}: "
                      "expected the same number [numbers-of-layers]",
                      specs_[spec_of(group[0])].where, number(group[0]), number(e), specs_[spec_of(e)].where,
                      show_node(domain_, at)));
    }
    slant = std::max(slant, columns(e).slant(e.chain, e.end));
  }
  for (std::size_t i = 0; i < group.size(); ++i) {
    std::vector<int> others;
    for (std::size_t j = 0; j < group.size(); ++j)
      if (j != i) others.push_back(spec_of(group[j]));
    patches_[group[i].patch].columns.join_end(group[i].chain, group[i].end, std::move(others), slant);
  }
}

void LayerWalls::mark_taken() {
  for (PatchLayers& patch : patches_)
    for (int w = 0; w < static_cast<int>(patch.columns.found().walls.size()); ++w) {
      LayerWall& wall = patch.columns.wall(w);
      for (const int local : {0, 1})
        wall.is_taken[local] = !walls_[wall.id].ends[wall.is_reversed ? 1 - local : local].empty();
    }
}

std::vector<std::size_t> LayerWalls::lower_shared_scales() {
  std::vector<char> changed(patches_.size(), 0);
  for (const std::vector<ChainEnd>& group : groups_) {
    if (group.size() < 2) continue;
    const auto scale = [&](const ChainEnd& e) -> double& {
      return patches_[e.patch].columns.scales[e.chain][point_of(e)];
    };
    double least = scale(group[0]);
    for (const ChainEnd& e : group) least = std::min(least, scale(e));
    for (const ChainEnd& e : group) {
      if (scale(e) > least * (1 + kSameScale)) changed[e.patch] = 1;
      scale(e) = least;
    }
  }
  std::vector<std::size_t> indices;
  for (std::size_t p = 0; p < changed.size(); ++p)
    if (changed[p]) indices.push_back(p);
  return indices;
}

void LayerWalls::count(Wall& wall) {
  const WallTrack& track = shape_of(wall).track;
  for (const int end : {0, 1}) {
    const std::vector<ChainEnd>& group = groups_[wall.group[end]];
    if (group.empty()) continue;
    // Where layers stand free beside a wall, that has nodes as far apart, as many as fit.
    const auto leans = [&](const ChainEnd& e) { return corner(e).kind != ChainCorner::kOpenEnd; };
    const auto on_wall = std::ranges::find_if(group, leans);
    const ChainEnd& e = on_wall == group.end() ? group[0] : *on_wall;
    const double slant = columns(e).slant(e.chain, e.end);
    for (int i = 1; i <= columns(e).layers_at(e.chain, point_of(e)); ++i) {
      const double along = slant * columns(e).height(e.chain, point_of(e), i);
      if (on_wall == group.end() && along > shape_of(wall).room()) break;
      wall.along[end].push_back(along);
    }
  }
  const auto last = [&](int end) { return wall.along[end].empty() ? 0 : wall.along[end].back(); };
  wall.from = track.place(last(0));
  wall.to = last(1) > 0 ? track.place(track.length() - last(1)) : track.n_edges();
  wall.n = std::max(1, static_cast<int>(std::lround(wall.to - wall.from)));
}

void LayerWalls::count_edges() {
  for (Wall& wall : walls_) count(wall);
  for (Wall& wall : walls_)
    if (wall.master >= 0) wall.n = walls_[wall.master].n;
  if (make_even() || (domain_.places.empty() && domain_.in_space == nullptr)) return;
  const PatchLayers& patch = patches_[odd_patches()[0]];
  const int at = domain_.patches[patch.patch].point_node[0];
  throw InputError(
      fmt::format("{}: layers leave an odd number of edges around the region at {}: expected an even number "
                  "of layers, or ends on the boundary",
                  specs_[0].where, show_node(domain_, at)));
}

/// Patches whose number of edges around what is left is odd.
std::vector<std::size_t> LayerWalls::odd_patches() const {
  std::vector<std::size_t> odd;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const LayerColumns& columns = patches_[p].columns;
    std::size_t edges = domain_.patches[patches_[p].patch].edges.size();
    for (int c = 0; c < columns.n_chains(); ++c) {
      const LayerChain& chain = columns.chain(c);
      edges -= chain.spec.size();
      int last = 0;  // layers of the pair before
      columns.for_each_pair(c, [&](int a, int b) {
        const int n = columns.layers_between(c, a, b);
        // Steps from one number to another; steps of a closed chain add up to an even number.
        edges += 1 + static_cast<std::size_t>(a == 0 || chain.is_closed ? 0 : std::abs(n - last));
        last = n;
      });
      if (chain.is_closed) continue;
      for (const int end : {0, 1}) {
        const int k = end == 0 ? 0 : chain.n_points() - 1;
        if (columns.corner(c, k).kind == ChainCorner::kOpenEnd)
          edges += static_cast<std::size_t>(columns.layers_at(c, k));
      }
    }
    for (const LayerWall& wall : columns.found().walls) {
      const Wall& one = walls_[wall.id];
      edges += static_cast<std::size_t>(one.n) - (wall.points.size() - 1);
      for (const int local : {0, 1}) {
        const int c = wall.chain[local];
        const bool is_front =
            c >= 0 &&
            columns.corner(c, local == 0 ? columns.chain(c).n_points() - 1 : 0).kind != ChainCorner::kOpenEnd;
        if (!is_front) edges += one.along[wall.is_reversed ? 1 - local : local].size();
      }
    }
    if (edges % 2 != 0) odd.push_back(p);
  }
  return odd;
}

/// Returns for each wall that is no image the patches that get an odd number of edges if the wall gets one
/// more.
std::vector<std::vector<std::size_t>> LayerWalls::patches_changed_by() const {
  std::vector<std::vector<std::size_t>> changed(walls_.size());
  for (std::size_t id = 0; id < walls_.size(); ++id)
    for (const auto& [p, w] : walls_[id].seen_by) {
      std::vector<std::size_t>& here = changed[walls_[id].master < 0 ? id : walls_[id].master];
      if (const auto found = std::ranges::find(here, p); found != here.end())
        here.erase(found);
      else
        here.push_back(p);
    }
  return changed;
}

/// From each odd patch across walls to the boundary of the domain, or to the next odd one. A longer wall
/// notices an edge more the least.
bool LayerWalls::make_even() {
  const std::vector<std::vector<std::size_t>> changed = patches_changed_by();
  std::vector<char> is_odd(patches_.size(), 0);
  for (const std::size_t p : odd_patches()) is_odd[p] = 1;
  for (std::size_t first = 0; first < patches_.size(); ++first) {
    if (!is_odd[first]) continue;
    std::vector<int> through(patches_.size(), -1);  // the wall by which it was reached
    std::vector<std::size_t> reached = {first};
    const auto widest = [&](std::size_t p, std::size_t sides) {
      int best = -1;
      for (int id = 0; id < static_cast<int>(walls_.size()); ++id) {
        const std::vector<std::size_t>& of = changed[id];
        if (of.size() != sides || std::ranges::find(of, p) == of.end()) continue;
        if (best < 0 || walls_[id].n > walls_[best].n) best = id;
      }
      return best;
    };
    int last = -1;  // the wall to the outside
    std::size_t at = first;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      at = reached[i];
      last = widest(at, 1);
      if (last >= 0 || (i > 0 && is_odd[at])) break;
      for (int id = 0; id < static_cast<int>(walls_.size()); ++id) {
        const std::vector<std::size_t>& of = changed[id];
        if (of.size() != 2 || std::ranges::find(of, at) == of.end()) continue;
        const std::size_t other = of[0] == at ? of[1] : of[0];
        if (other == first || through[other] >= 0) continue;
        through[other] = id;
        reached.push_back(other);
      }
      at = patches_.size();
    }
    if (at == patches_.size()) return false;
    if (last >= 0) ++walls_[last].n;
    is_odd[at] = last < 0 ? 0 : is_odd[at];
    is_odd[first] = 0;
    while (at != first) {
      const int id = through[at];
      ++walls_[id].n;
      at = changed[id][0] == at ? changed[id][1] : changed[id][0];
    }
  }
  for (Wall& wall : walls_)
    if (wall.master >= 0) wall.n = walls_[wall.master].n;
  return true;
}

int add_node(PlanarDomain& domain, Vec2 at) {
  return add_node(domain, Vec3{at.x, at.y, domain.boundary.points[0].z});
}

int add_node(PlanarDomain& domain, const Vec3& at) {
  std::vector<Vec3>& points = domain.boundary.points;
  points.push_back(at);
  if (!domain.places.empty()) domain.places.emplace_back();
  return static_cast<int>(points.size()) - 1;
}

int LayerWalls::add(Wall& wall, double place) {
  const WallTrack& track = shape_of(wall).track;
  const int node = domain_.in_space != nullptr ? add_node(domain_, track.spot(place))
                                               : add_node(domain_, track.point(place));
  wall.places[node] = place;
  return node;
}

int LayerWalls::add_image(Wall& wall, int master) {
  const Vec3 x = domain_.boundary.periodic[wall.pairing].motion(domain_.boundary.points[master]);
  const double place = walls_[wall.master].places.at(master);
  const int node = domain_.in_space != nullptr ? add_node(domain_, x) : add_node(domain_, Vec2{x.x, x.y});
  wall.places[node] = wall.runs_as_master ? place : shape_of(wall).track.n_edges() - place;
  return node;
}

double LayerWalls::place(const LayerWall& wall, int node) const {
  const double place = walls_[wall.id].places.at(node);
  return wall.is_reversed ? wall.track.n_edges() - place : place;
}

std::vector<WallNodes> LayerWalls::nodes() const {
  std::vector<WallNodes> all;
  for (const Wall& wall : walls_) {
    auto& [old, places] = all.emplace_back();
    for (const int p : shape_of(wall).points)
      old.push_back(domain_.patches[patches_[wall.patch].patch].point_node[p]);
    places = wall.places;
  }
  return all;
}

const std::vector<int>& LayerWalls::make_side(int id, int end) {
  Wall& wall = walls_[id];
  std::vector<int>& nodes = wall.sides[end];
  if (!nodes.empty()) return nodes;
  const LayerWall& shape = shape_of(wall);
  const PatchBoundary& patch = domain_.patches[patches_[wall.patch].patch];
  nodes.push_back(patch.point_node[end == 0 ? shape.points.front() : shape.points.back()]);
  wall.places[nodes[0]] = end == 0 ? 0 : shape.track.n_edges();
  if (wall.master >= 0) {
    const std::vector<int>& masters = make_side(wall.master, wall.runs_as_master ? end : 1 - end);
    for (std::size_t i = 1; i < masters.size(); ++i) nodes.push_back(add_image(wall, masters[i]));
    return nodes;
  }
  for (const double along : wall.along[end])
    nodes.push_back(add(wall, shape.track.place(end == 0 ? along : shape.track.length() - along)));
  return nodes;
}

void LayerWalls::make_between(int id) {
  Wall& wall = walls_[id];
  if (std::exchange(wall.has_nodes, true)) return;
  if (wall.master >= 0) {
    make_between(wall.master);
    for (const int v : walls_[wall.master].nodes) wall.nodes.push_back(add_image(wall, v));
    if (!wall.runs_as_master) std::ranges::reverse(wall.nodes);
    return;
  }
  const LayerWall& shape = shape_of(wall);
  for (int k = 1; k < wall.n; ++k) {
    const double place = wall.from + (wall.to - wall.from) * k / wall.n;
    wall.nodes.push_back(add(wall, place));
    if (domain_.places.empty() || wall.is_paired) continue;  // nodes of periodic curves stay
    const auto [low, high] = std::minmax({shape.track.param(wall.from), shape.track.param(wall.to)});
    domain_.places.back() = {shape.track.curve(), shape.track.param(place), low, high};
  }
}

std::vector<int> LayerWalls::side(const LayerWall& wall, int end) {
  return make_side(wall.id, wall.is_reversed ? 1 - end : end);
}

std::vector<int> LayerWalls::between(const LayerWall& wall) {
  make_between(wall.id);
  std::vector<int> nodes = walls_[wall.id].nodes;
  if (wall.is_reversed) std::ranges::reverse(nodes);
  return nodes;
}

void LayerWalls::pair_nodes() {
  for (const Wall& wall : walls_) {
    if (wall.master < 0) continue;
    const Wall& master = walls_[wall.master];
    auto& pairs = domain_.boundary.periodic[wall.pairing].nodes;
    const auto pair = [&](const std::vector<int>& own, const std::vector<int>& of, bool forward) {
      for (std::size_t i = 0; i < own.size(); ++i)
        if (const std::array<int, 2> nodes{own[i], of[forward ? i : own.size() - 1 - i]};
            std::ranges::find(pairs, nodes) == pairs.end())
          pairs.push_back(nodes);
    };
    for (const int end : {0, 1})
      pair(wall.sides[end], master.sides[wall.runs_as_master ? end : 1 - end], true);
    pair(wall.nodes, master.nodes, wall.runs_as_master);
  }
}

}  // namespace delquad
