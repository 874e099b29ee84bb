#include "io/face_colours.h"

#include <fmt/format.h>

#include <set>

namespace delquad {

std::string colour_text(const std::array<int, 3>& rgb) {
  return fmt::format("{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

void FaceColours::finish(Mesh& mesh, ReadNotes* notes) const {
  std::set<std::string> colours;
  for (const auto& [key, at] : index_) colours.insert(key.second);
  if (colours.size() <= kMost) {
    mesh.regions = regions_;
    return;
  }
  FaceColours plain;
  std::vector<int> part(regions_.size());
  for (const auto& [key, at] : index_) part[at] = plain.region(key.first, "");
  for (auto* regions : {&mesh.triangle_region, &mesh.quad_region})
    for (int& region : *regions) region = part[region];
  mesh.regions = plain.regions_;
  if (notes)
    notes->push_back(fmt::format("the faces' {} colours are left out: up to {} would become regions",
                                 colours.size(), kMost));
}

}  // namespace delquad
