// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "features/grids/grids.h"

namespace delquad {

std::vector<MappedPatch> mapped_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                        const std::vector<CurvePiece>& pieces, const Arrangement& arrangement,
                                        const FaceRegions& regions) {
  std::vector<int> first_line{0};
  for (const CurvePiece& piece : pieces) first_line.push_back(first_line.back() + piece.n);
  std::vector<MappedPatch> patches;
  for (const MappedFace& face : mapped) {
    std::vector<CurveSide> begins;
    for (const CurveSide& side : curves.outlines[face.face][0])
      if (side.begins(curves.chains[side.chain])) begins.push_back(side);
    const CurveSide& first = begins[face.begins.empty() ? 0 : face.begins[0]];
    const int side = first.forward ? 2 * first_line[first.chain] : 2 * (first_line[first.chain + 1] - 1) + 1;
    const int of = arrangement.face_of[side];
    const auto n_before =
        std::count_if(regions.region.begin(), regions.region.begin() + of, [](int r) { return r >= 0; });
    MappedPatch& patch =
        patches.emplace_back(MappedPatch{static_cast<int>(n_before), {}, face.is_requested, face.rows});
    if (face.begins.empty()) continue;
    const Arrangement::Cycle& outline = arrangement.faces[of].cycles[0];
    const int n = static_cast<int>(outline.size());
    auto at = static_cast<int>(std::ranges::find(outline, side) - outline.begin());
    for (const auto& parts : face.sides) {
      patch.corners.push_back(at % n);
      for (const int piece : parts) at += pieces[piece].n;
    }
  }
  return patches;
}

}  // namespace delquad
