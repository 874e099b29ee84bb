// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/cancel.h"
#include "base/located.h"
#include "base/text.h"
#include "delquad/hexahedra.h"
#include "delquad/model.h"
#include "features/volume/fill_steps.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

/// Turns the quad so that its first corner has the diagonal whose triangles have the larger least sine.
Quad by_better_diagonal(const Mesh& mesh, Quad q) {
  const auto sine = [&](int i, int j, int k) {
    const Vec3 u = mesh.points[q[j]] - mesh.points[q[i]], v = mesh.points[q[k]] - mesh.points[q[j]];
    const double lu = norm(u), lv = norm(v), lw = norm(u + v);
    return norm(cross(u, v)) / std::max({lu * lv, lv * lw, lw * lu, std::numeric_limits<double>::min()});
  };
  if (std::min(sine(1, 2, 3), sine(1, 3, 0)) > std::min(sine(0, 1, 2), sine(0, 2, 3)))
    std::rotate(q.begin(), q.begin() + 1, q.end());
  return q;
}

void check_skin(const Mesh& skin, long long max_elements) {
  require_straight(skin, "skin");
  if (!skin.triangles.empty())
    refuse("the skin has {} triangles, one at {}: expected quads alone; a model of triangles gets new quads",
           skin.triangles.size(), show_point(skin.points[skin.triangles[0][0]]));
  if (skin.quads.empty()) throw InputError("the skin has no quads: expected a closed skin of quads");
  if (static_cast<long long>(skin.quads.size()) > max_elements)
    refuse("the skin has {} quads, and --max-elements allows {} cells", skin.quads.size(), max_elements);
}

std::vector<char> regions_with(const LayerSpec& layers, const Mesh& skin) {
  std::vector<char> has_layers(skin.regions.size(), layers.on.empty());
  for (const std::string& name : layers.on)
    for (const int r : find_entities(skin.regions, "region", name, layers.where)) has_layers[r] = 1;
  return has_layers;
}

/// Fills bodies one by one and collects their cells.
class SkinFiller {
 public:
  SkinFiller(const Mesh& skin, const VolumeOptions& options, ReadNotes* notes)
      : options_(options), result_(skin), bodies_(find_bodies(skin, notes)) {
    for (const Quad& q : skin.quads) split_.push_back(by_better_diagonal(skin, q));
    Vec3 where;
    if (const std::vector<int> faces = untangle(skin.points, split_, {}, &where); !faces.empty())
      refuse(
          "the skin crosses itself at {} in {} quads: --glue joins bodies that touch, and smaller sizes keep "
          "thin parts open [unsound-skin]",
          show_point(where), faces.size());
    find_layers();
  }

  Mesh fill(ReadNotes* notes) {
    constexpr int kAttempts = 4;
    const Mesh skin = result_;
    for (int attempt = 1; !fill_bodies(attempt == kAttempts); ++attempt) result_ = skin;
    name_volumes();
    orient_faces();
    if (notes != nullptr) tell_layers(*notes);
    return std::move(result_);
  }

 private:
  bool tets_alone() const { return options_.cells == VolumeCells::kTets; }

  /// Fills all bodies. Returns false after a change of diagonals that may help; throws InputError if this is
  /// the last attempt, or if nothing can be changed.
  bool fill_bodies(bool is_last) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      check_cancelled();
      std::vector<int> lost;
      fill_body(static_cast<int>(b), lost);
      if (!lost.empty() && (is_last || !tets_alone())) refuse_body(bodies_[b], lost);
      for (const int i : lost) {
        Quad& q = split_[bodies_[b][i].quad];
        std::rotate(q.begin(), q.begin() + 1, q.end());
      }
      if (!lost.empty()) return false;
    }
    return true;
  }

  /// Finds the regions with layers, and the heights of these.
  void find_layers() {
    if (!options_.layers) return;
    if (tets_alone())
      refuse("layers have hexahedra: expected '--cells hex-dominant' or '--cells pyramids-and-tets'");
    const LayerSpec& layers = *options_.layers;
    if (!(layers.first > 0))
      refuse("{}: a first height of {}: expected a length above 0", layers.where, layers.first);
    if (!(layers.growth >= 1)) refuse("{}: a growth of {}: expected at least 1", layers.where, layers.growth);
    heights_ = layer_heights(layers);
    if (const double room = diagonal(result_); heights_.back() > room)
      refuse("{}: layers have a height of {:.3g}, and the model a diagonal of {:.3g}: expected lower layers",
             layers.where, heights_.back(), room);
    has_layers_ = regions_with(layers, result_);
  }

  void tell_layers(ReadNotes& notes) const {
    for (const GrownLayers& grown : grown_) {
      if (grown.least < 1)
        notes.push_back(
            fmt::format("layers are lower where there is no room: {:.2g} of their height at {} [low-layers]",
                        grown.least, show_point(grown.least_at)));
      if (grown.n_bare > 0)
        notes.push_back(fmt::format(
            "{} get no layers, one at {}: expected lower layers, or other sizes there [low-layers]",
            counted(grown.n_bare, "quad"), show_point(grown.bare_at)));
    }
  }

  /// Adds the cells of a body, or fills `lost` with the sides that fail.
  void fill_body(int body, std::vector<int>& lost) {
    Mesh part;
    part.points = result_.points;
    std::vector<char> has_layers;
    for (const BodySide& side : bodies_[body]) {
      Quad& quad = part.quads.emplace_back(split_[side.quad]);
      if (side.is_reversed) std::swap(quad[1], quad[3]);
      if (!heights_.empty()) has_layers.push_back(has_layers_[result_.quad_region[side.quad]]);
    }
    const std::vector<int> of_skin = keep_used_points(part);
    if (tets_alone()) part.triangles = halves_of(std::exchange(part.quads, {}));
    const bool has_hexahedra = options_.cells == VolumeCells::kHexDominant;
    const bool optimizes = !has_hexahedra || options_.strategy.ends_with('O');
    const auto place_cells = [&](Mesh& rest) {
      if (has_hexahedra) place_hexahedra(rest, options_.strategy), place_prisms(rest);
    };
    if (!heights_.empty())
      lost = fill_with_layers(part, has_layers, heights_, place_cells, optimizes, grown_.emplace_back());
    else
      lost = has_hexahedra ? fill_with_hexahedra(part, options_.strategy, optimizes)
                           : fill_around(part, optimizes);
    for (int& face : lost) face /= tets_alone() ? 2 : 1;
    lost.erase(std::unique(lost.begin(), lost.end()), lost.end());
    if (!lost.empty()) return;
    add_cells(result_, part, of_skin, body);
    if (static_cast<long long>(n_solids(result_)) > options_.max_elements)
      refuse("{} cells are needed, and --max-elements allows {}: a larger size needs fewer",
             n_solids(result_), options_.max_elements);
  }

  [[noreturn]] void refuse_body(const Body& body, const std::vector<int>& lost) const {
    refuse(
        "the body cannot be filled at {}: {} of its {} quads allow no cells; expected {}smaller sizes there "
        "[unsound-skin]",
        show_point(middle_of(result_.points, result_.quads[body[lost[0]].quad])), lost.size(), body.size(),
        tets_alone() ? "" : "'--cells tets', which splits quads, or ");
  }

  /// Names a volume by what all its faces have in common. A name that all faces of one body have, and no
  /// other face has, is its own. So an inclusion does not get the name of the body around it.
  void name_volumes() {
    std::map<std::string, std::size_t> n_faces;
    for (const int region : result_.quad_region)
      for (const std::string& name : result_.regions[region].names) ++n_faces[name];
    std::map<std::string, std::size_t> owner;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      std::vector<std::string> names = result_.regions[result_.quad_region[bodies_[b][0].quad]].names;
      for (const BodySide& side : bodies_[b]) {
        const auto& of_face = result_.regions[result_.quad_region[side.quad]].names;
        std::erase_if(names, [&](const std::string& name) {
          return std::ranges::find(of_face, name) == of_face.end();
        });
      }
      for (const std::string& name : names)
        if (n_faces[name] == bodies_[b].size()) owner[name] = b;
      result_.volumes.push_back({static_cast<int>(b) + 1, names});
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      std::erase_if(result_.volumes[b].names, [&](const std::string& name) {
        const auto own = owner.find(name);
        return own != owner.end() && own->second != b;
      });
  }

  /// Lets quads of single bodies look outwards; splits them for tetrahedra.
  void orient_faces() {
    std::vector<int> turns(split_.size(), 0);
    for (const Body& body : bodies_)
      for (const BodySide& side : body) turns[side.quad] += side.is_reversed ? -1 : 1;
    for (std::size_t i = 0; i < turns.size(); ++i)
      for (Quad* q : {&split_[i], &result_.quads[i]})
        if (turns[i] < 0) std::swap((*q)[1], (*q)[3]);
    if (!tets_alone()) return;
    result_.triangles = halves_of(split_);
    for (const int region : result_.quad_region)
      result_.triangle_region.insert(result_.triangle_region.end(), 2, region);
    result_.quads.clear(), result_.quad_region.clear();
    result_.periodic_faces.clear();
  }

  VolumeOptions options_;
  Mesh result_;
  std::vector<Body> bodies_;
  std::vector<double> heights_;   ///< of the ends of layers; empty: none
  std::vector<char> has_layers_;  ///< by region
  std::vector<GrownLayers> grown_;
  std::vector<Quad> split_;  ///< quads whose first diagonals split them into triangles
};

}  // namespace

VolumeCells volume_cells(const std::string& name) {
  if (name == "hex-dominant") return VolumeCells::kHexDominant;
  if (name == "pyramids-and-tets") return VolumeCells::kPyramidsAndTets;
  if (name == "tets") return VolumeCells::kTets;
  refuse("cells '{}': expected hex-dominant, pyramids-and-tets or tets", name);
}

LayerSpec layers_beside(const LayerSpec& layers, const Mesh& skin) {
  constexpr double kMostFan = 120;  // degrees
  const std::vector<char> has_layers = regions_with(layers, skin);
  const std::vector<HalfEdge> sides = sorted_half_edges(skin);
  std::set<std::string> on, into;
  for (std::size_t l = 0; l < skin.lines.size(); ++l) {
    std::set<int> with, without;
    for (const HalfEdge& side : sides_of_edge(sides, skin.lines[l][0], skin.lines[l][1])) {
      const int region = region_of(skin, side.element);
      (has_layers[region] != 0 ? with : without).insert(region);
    }
    if (with.empty() || without.empty()) continue;
    on.insert(fmt::format("curve_{}", skin.curves[skin.line_curve[l]].tag));
    for (const int region : without) into.insert(fmt::format("region_{}", skin.regions[region].tag));
  }
  LayerSpec beside = layers;
  beside.on.assign(on.begin(), on.end());
  beside.into.assign(into.begin(), into.end());
  beside.fan = kMostFan;
  return beside;
}

Mesh fill_skin(const Mesh& skin, const VolumeOptions& options, ReadNotes* notes) {
  check_strategy(options.strategy);
  require_readable(skin, "skin");
  if (skin.order == 2 && options.cells == VolumeCells::kTets) {
    Mesh corners = skin;
    corners.order = 1;
    corners.line_nodes.clear(), corners.quad_nodes.clear();
    const std::vector<int> number = drop_unused_points(corners);
    Mesh cells = fill_skin(corners, options, notes);
    place_middle_nodes(cells, skin, number, notes);
    return cells;
  }
  check_skin(skin, options.max_elements);
  const Mesh mesh = SkinFiller(skin, options, notes).fill(notes);
  if (const std::vector<std::string> defects = defects_of_cells(mesh); !defects.empty())
    refuse("the cells are not sound: {}", fmt::join(defects, "; "));
  return mesh;
}

}  // namespace delquad
