#include "features/periodic/periodic.h"

#include <algorithm>
#include <array>
#include <utility>

namespace delquad {
namespace {

class FaceCopy {
 public:
  FaceCopy(PeriodicFaces& pair, Mesh& mesh) : pair_(pair), mesh_(mesh), image_(mesh.points.size(), -1) {
    for (const auto& [node, of] : pair.nodes) image_[of] = node;
  }

  template <std::size_t N>
  void add(std::vector<std::array<int, N>>& elements, std::vector<int>& regions) {
    const std::size_t n = elements.size();
    for (std::size_t e = 0; e < n; ++e) {
      if (regions[e] != pair_.master) continue;
      std::array<int, N> element = elements[e];
      for (int& v : element) v = image(v);
      if (pair_.is_reversed) std::reverse(element.begin() + 1, element.end());
      elements.push_back(element);
      regions.push_back(pair_.face);
    }
  }

 private:
  int image(int v) {
    if (image_[v] < 0) {
      image_[v] = static_cast<int>(mesh_.points.size());
      mesh_.points.push_back(pair_.motion(mesh_.points[v]));
      pair_.nodes.push_back({image_[v], v});
    }
    return image_[v];
  }

  PeriodicFaces& pair_;
  Mesh& mesh_;
  std::vector<int> image_;
};

}  // namespace

void add_face_images(const std::vector<char>& left_out, Mesh& mesh) {
  std::erase_if(mesh.periodic_faces, [&](const PeriodicFaces& pair) { return left_out[pair.face] != 0; });
  for (PeriodicFaces& pair : mesh.periodic_faces) {
    FaceCopy copy(pair, mesh);
    copy.add(mesh.triangles, mesh.triangle_region);
    copy.add(mesh.quads, mesh.quad_region);
  }
}

}  // namespace delquad
