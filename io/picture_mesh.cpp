#include <algorithm>
#include <cmath>

#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/irregular_vertices.h"
#include "io/picture.h"
#include "io/svg.h"
#include "metrics/metrics.h"

namespace delquad {

namespace {

using svg::Path;
using svg::Picture;

constexpr int kMeshColours = 64;
/// Beyond this many elements edges would only blacken the picture.
constexpr size_t kMostElementsWithEdges = 50'000;

Vec2 flat(const Vec3& p) { return {p.x, p.y}; }

/// Square root of the area, in pixels.
template <size_t N>
double pixel_size(const Mesh& mesh, const std::array<int, N>& v, double scale) {
  double twice_area = 0;
  for (size_t k = 1; k + 1 < N; ++k) {
    const Vec2 a = flat(mesh.points[v[0]]);
    twice_area += cross(flat(mesh.points[v[k]]) - a, flat(mesh.points[v[k + 1]]) - a);
  }
  return std::sqrt(std::abs(twice_area) / 2) * scale;
}

/// Element paths that share a stroke width and a fill.
class ElementPaths {
 public:
  ElementPaths(const Mesh& mesh, const Picture& picture) : mesh_(mesh), picture_(picture) {}

  /// `colour_class` from 0 to kMeshColours - 1, -1: no colour.
  template <size_t N>
  void add(const std::array<int, N>& v, int colour_class, const std::vector<Vec3>& outline) {
    constexpr int kLeast = -8, kMost = 8;  // steps of sqrt 2 of the pixel size that get a width of their own
    const double size = pixel_size(mesh_, v, picture_.scale());
    const int step =
        size > 0 ? std::clamp(static_cast<int>(std::lround(2 * std::log2(size))), kLeast, kMost) : kLeast;
    std::vector<svg::Spot> corners;
    for (const Vec3& x : outline) corners.push_back(picture_.spot(x));
    paths_[{-step, colour_class}].polygon(corners);
  }

  void draw(Picture& picture, bool with_edges) const {
    constexpr double kEdgeWidth = 0.06;  // of the element's size
    constexpr double kSeamWidth = 0.3;   // pixels; hides the seams between neighbours drawn without edges
    for (const auto& [key, path] : paths_) {
      const std::string fill = key.second < 0 ? "#dcdcdc" : svg::colour((key.second + 0.5) / kMeshColours);
      if (with_edges) {
        picture.add(path, fill, "#222", kEdgeWidth * std::exp2(-0.5 * key.first));
      } else {
        picture.add(path, fill, fill, kSeamWidth);
      }
    }
  }

 private:
  const Mesh& mesh_;
  const Picture& picture_;
  std::map<std::pair<int, int>, Path> paths_;  // large elements first
};

/// Dots on irregular vertices, and lines that join pairs of them.
std::vector<svg::Mark> add_irregular(const Mesh& mesh, int regular, Picture& picture) {
  const double scale = picture.scale();
  std::vector<double> size;
  for_each_element(mesh, [&](int, const auto& v) { size.push_back(pixel_size(mesh, v, scale)); });
  constexpr double kRadius = 0.2, kLeast = 0.5, kMost = 5;  // of the mean size of the elements around; pixels
  std::vector<svg::Mark> marks;
  const IrregularVertices irregular = irregular_vertices(mesh, regular, size);
  for (const auto& [vertex, valence, mean_size] : irregular.vertices) {
    const int index = std::abs(regular - valence) == 1 ? regular - valence : 0;
    marks.push_back({flat(mesh.points[vertex]), index, std::clamp(kRadius * mean_size, kLeast, kMost)});
  }
  std::vector<std::array<Vec2, 2>> pairs;
  for (const auto& [few, many] : irregular.pairs)
    pairs.push_back({flat(mesh.points[few]), flat(mesh.points[many])});
  picture.add_marks(marks, pairs);
  return marks;
}

}  // namespace

void draw_mesh(const std::filesystem::path& path, const Mesh& mesh, const std::string& title) {
  Picture picture(mesh.points, title);
  ElementPaths elements(mesh, picture);
  const std::vector<double> eta = quad_etas(mesh);
  for (const auto& v : mesh.triangles)
    elements.add(v, -1, {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]});
  for (size_t q = 0; q < mesh.quads.size(); ++q) {
    elements.add(mesh.quads[q], std::min(static_cast<int>(eta[q] * kMeshColours), kMeshColours - 1),
                 outline_of_quad(mesh, q));
  }
  elements.draw(picture, mesh.quads.size() + mesh.triangles.size() <= kMostElementsWithEdges);
  constexpr double kOutlineWidth = 1.1;
  picture.add_outline(mesh, kOutlineWidth);

  const int regular = mesh.quads.empty() ? 6 : 4;
  const std::vector<svg::Mark> marks = add_irregular(mesh, regular, picture);
  if (!mesh.quads.empty()) {
    picture.add_colour_bar("eta",
                           {{0, "0"}, {0.2, "0.2"}, {0.4, "0.4"}, {0.6, "0.6"}, {0.8, "0.8"}, {1, "1"}});
  }
  if (!marks.empty()) {
    picture.add_mark_legend({{1, "valence " + std::to_string(regular - 1)},
                             {-1, "valence " + std::to_string(regular + 1)},
                             {0, "other valence"}});
  }
  picture.write(path);
}

}  // namespace delquad
