// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/located.h"
#include "base/sort_unique.h"
#include "delquad/hexahedra.h"
#include "features/volume/hexahedra_steps.h"

namespace delquad {

namespace {

/// State between the stages of a strategy.
struct Placement {
  const Mesh& body;
  Skin skin{body};
  Lattice lattice = {};
  Mesh placed = {};  ///< the quads and the hexahedra between points of the lattice

  void add_points(Packing packing) {
    lattice = fill_with_points(skin, packing);
    placed.points = lattice.points, placed.quads = body.quads;
  }
  std::vector<Hexahedron> between(const std::vector<std::vector<int>>& beside) const {
    return find_hexahedra(placed.points, beside, skin);
  }
};

/// Chooses hexahedra anew, where they leave room also between neighbors that are not the best.
void clean_up(Placement& in) {
  std::vector<char> is_enclosed(in.placed.points.size(), 0);  // by hexahedra that leave no room
  for (const Hexahedron& hex : in.placed.hexahedra)
    for (const int v : hex) is_enclosed[v] = 1;
  for (const Quad& quad : open_faces(in.placed).quads)
    for (const int v : quad) is_enclosed[v] = 0;
  auto beside = in.lattice.beside;
  for (std::size_t v = 0; v < beside.size(); ++v)
    if (is_enclosed[v])
      beside[v].clear();
    else
      std::erase_if(beside[v], [&](int w) { return is_enclosed[w]; });
  std::vector<Hexahedron> candidates = in.between(beside);
  candidates.insert(candidates.end(), in.placed.hexahedra.begin(), in.placed.hexahedra.end());
  sort_unique(candidates);
  select_hexahedra(in.placed, candidates);
}

struct VolumeStage {
  char letter;
  const char* name;
  int step;  ///< the letters of a strategy have rising steps
  void (*run)(Placement&);
};
constexpr int kPointsStep = 0, kHexahedraStep = 1;
constexpr VolumeStage kStages[] = {
    {'F', "points of equilateral tetrahedra", kPointsStep,
     [](Placement& in) { in.add_points(Packing::kTetrahedra); }},
    {'D', "points of cubes", kPointsStep, [](Placement& in) { in.add_points(Packing::kCubes); }},
    {'B', "recombination", kHexahedraStep,
     [](Placement& in) { select_hexahedra(in.placed, in.between(in.lattice.best)); }},
    {'C', "clean-up", 2, clean_up},
    {'O', "optimization of the cells around hexahedra", 3, [](Placement&) {}}};

}  // namespace

void check_strategy(const std::string& strategy) {
  std::string known;
  int step = -1;
  bool is_known = true, has_hexahedra = false;
  for (const VolumeStage& stage : kStages)
    known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", stage.letter, stage.name);
  for (const char letter : strategy) {
    const auto* stage = std::ranges::find(kStages, letter, &VolumeStage::letter);
    is_known &= stage != std::end(kStages) && stage->step > step && (step >= 0 || stage->step == kPointsStep);
    if (!is_known) break;
    step = stage->step;
    has_hexahedra |= step == kHexahedraStep;
  }
  if (!is_known || !has_hexahedra)
    refuse("strategy '{}': expected F or D, then B, then C and O if wanted, as in DBCO: {}", strategy, known);
}

void place_hexahedra(Mesh& volume, const std::string& strategy) {
  Placement placement{volume};
  for (const char letter : strategy) std::ranges::find(kStages, letter, &VolumeStage::letter)->run(placement);
  separate_sides(placement.placed);
  volume.points = placement.placed.points, volume.hexahedra = placement.placed.hexahedra;
  drop_cells(volume, {});
}

}  // namespace delquad
