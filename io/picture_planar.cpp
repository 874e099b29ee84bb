#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/picture.h"
#include "io/svg.h"
#include "metrics/metrics.h"
#include "metrics/regularity.h"

namespace delquad {

IrregularVertices irregular_vertices(const Mesh& mesh, int regular, const std::vector<double>& element_size) {
  std::vector<int> valence(mesh.points.size(), 0);
  std::vector<double> size(mesh.points.size(), 0);
  for_each_element(mesh, [&](int element, const auto& v) {
    for (const int i : v) {
      ++valence[i];
      size[i] += element_size[element];
    }
  });
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<int> shown = valence;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) shown[edge[0].lo] = shown[edge[0].hi] = regular;
  });
  IrregularVertices irregular;
  if (mesh.triangles.empty())
    for (const IrregularPair& pair : pair_irregular(mesh, sides).pairs) {
      irregular.pairs.push_back({pair.few, pair.many});
      if (shown[pair.few] == regular) shown[pair.few] = regular - 1;
      if (shown[pair.many] == regular) shown[pair.many] = regular + 1;
    }
  for (int i = 0; i < static_cast<int>(valence.size()); ++i)
    if (shown[i] != regular && valence[i] != 0)
      irregular.vertices.push_back({i, shown[i], size[i] / valence[i]});
  return irregular;
}

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
    const int step = step_of_width(pixel_size(mesh_, v, picture_.scale()));
    std::vector<svg::Spot> corners;
    for (const Vec3& x : outline) corners.push_back(picture_.spot(x));
    paths_[{-step, colour_class}].polygon(corners);
  }

  void draw(Picture& picture, bool with_edges) const {
    for (const auto& [key, path] : paths_)
      add_elements(picture, path, key.second < 0 ? "#dcdcdc" : svg::colour((key.second + 0.5) / kMeshColours),
                   -key.first, with_edges);
  }

 private:
  const Mesh& mesh_;
  const Picture& picture_;
  std::map<std::pair<int, int>, Path> paths_;  // large elements first
};

constexpr double kOutlineWidth = 1.2;  // pixels

/// A corner of a piece of a triangle and the field's place on the colour bar there.
struct Corner {
  Vec2 at;
  double t;
};

/// The part of the convex polygon where sign * (t - level) >= 0.
std::vector<Corner> clipped(const std::vector<Corner>& polygon, double level, double sign) {
  std::vector<Corner> kept;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Corner &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = sign * (a.t - level), db = sign * (b.t - level);
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0))
      kept.push_back({a.at + (da / (da - db)) * (b.at - a.at), level});
  }
  return kept;
}

/// Bands of equal colour, cut from the linear interpolation over each triangle.
void add_bands(Picture& picture, const Mesh& mesh, const std::vector<double>& t) {
  constexpr int kBands = 40;
  constexpr double kSeamWidth = 0.4;  // pixels; hides the seams between neighbours
  std::vector<Path> bands(kBands);
  for (const auto& v : mesh.triangles) {
    std::vector<Corner> triangle;
    for (const int i : v) triangle.push_back({{mesh.points[i].x, mesh.points[i].y}, t[i]});
    const auto [low, high] = std::minmax({t[v[0]], t[v[1]], t[v[2]]});
    const int last = std::clamp(static_cast<int>(high * kBands), 0, kBands - 1);
    for (int band = std::clamp(static_cast<int>(low * kBands), 0, kBands - 1); band <= last; ++band) {
      std::vector<Corner> piece = triangle;
      if (band > 0) piece = clipped(piece, double(band) / kBands, 1);
      if (band < kBands - 1) piece = clipped(piece, double(band + 1) / kBands, -1);
      if (piece.size() < 3) continue;
      std::vector<svg::Spot> corners;
      for (const Corner& c : piece) corners.push_back(picture.spot(c.at));
      bands[band].polygon(corners);
    }
  }
  for (int band = 0; band < kBands; ++band) {
    const std::string fill = svg::colour((band + 0.5) / kBands);
    picture.add(bands[band], fill, fill, kSeamWidth);
  }
}

/// Where a value stands on a colour bar from low to high: by its logarithm, or linearly when low is not
/// positive.
struct ColourScale {
  double low, high;
  bool is_log() const { return low > 0; }
  double place(double value) const {
    if (!(high > low)) return 0.5;
    return is_log() ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
  double value(double place) const {
    return is_log() ? low * std::exp(place * std::log(high / low)) : low + place * (high - low);
  }
};

/// 1, 2 and 5 times powers of ten where the range holds three or more of them; otherwise five equal steps.
std::vector<std::pair<double, std::string>> labels(const ColourScale& scale) {
  if (!(scale.high > scale.low)) return {{0.5, fmt::format("{:.4g}", scale.low)}};
  std::vector<std::pair<double, std::string>> result;
  const double decades = scale.is_log() ? std::log10(scale.high / scale.low) : 0;
  constexpr double kRounding = 1e-9;
  if (scale.is_log()) {
    const int first = static_cast<int>(std::floor(std::log10(scale.low)));
    const int last = static_cast<int>(std::ceil(std::log10(scale.high)));
    const int step = std::max(1, static_cast<int>(decades / 6));
    for (int power = first; power <= last; power += step) {
      for (const int digit : decades > 4 ? std::vector<int>{1} : std::vector<int>{1, 2, 5}) {
        const double value = digit * std::pow(10, power), place = scale.place(value);
        if (place >= -kRounding && place <= 1 + kRounding)
          result.emplace_back(place, fmt::format("{:.4g}", value));
      }
    }
  }
  if (result.size() >= 3) return result;
  result.clear();
  for (const double place : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    result.emplace_back(place, fmt::format("{:.3g}", scale.value(place)));
  }
  return result;
}

}  // namespace

int step_of_width(double pixels) {
  constexpr int kLeast = -8, kMost = 8;  // steps of sqrt 2 of the pixel size that get a width of their own
  return pixels > 0 ? std::clamp(static_cast<int>(std::lround(2 * std::log2(pixels))), kLeast, kMost)
                    : kLeast;
}

void add_elements(Picture& picture, const Path& elements, const std::string& fill, int step,
                  bool with_edges) {
  constexpr double kEdgeWidth = 0.06;  // of the element's size
  constexpr double kSeamWidth = 0.3;   // pixels; hides the seams between neighbours drawn without edges
  picture.add(elements, fill, with_edges ? "#222" : fill,
              with_edges ? kEdgeWidth * std::exp2(0.5 * step) : kSeamWidth);
}

void add_irregular(Picture& picture, const Mesh& mesh, int regular, const std::vector<double>& pixels,
                   const std::function<bool(const Vec3&)>& is_seen) {
  constexpr double kRadius = 0.2, kLeast = 0.5, kMost = 5;  // of the mean size of the elements around; pixels
  std::vector<svg::Mark> marks;
  const IrregularVertices irregular = irregular_vertices(mesh, regular, pixels);
  for (const auto& [vertex, valence, mean_size] : irregular.vertices) {
    if (!is_seen(mesh.points[vertex])) continue;
    const int index = std::abs(regular - valence) == 1 ? regular - valence : 0;
    marks.push_back({flat(mesh.points[vertex]), index, std::clamp(kRadius * mean_size, kLeast, kMost)});
  }
  std::vector<std::array<Vec2, 2>> pairs;
  for (const auto& [few, many] : irregular.pairs)
    if (is_seen(mesh.points[few]) && is_seen(mesh.points[many]))
      pairs.push_back({flat(mesh.points[few]), flat(mesh.points[many])});
  picture.add_marks(marks, pairs);
  if (!mesh.quads.empty())
    picture.add_colour_bar("eta",
                           {{0, "0"}, {0.2, "0.2"}, {0.4, "0.4"}, {0.6, "0.6"}, {0.8, "0.8"}, {1, "1"}});
  if (!marks.empty())
    picture.add_mark_legend({{1, "valence " + std::to_string(regular - 1)},
                             {-1, "valence " + std::to_string(regular + 1)},
                             {0, "other valence"}});
}

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
  constexpr double kWidth = 1.1;
  picture.add_outline(mesh, kWidth);

  std::vector<double> pixels;
  for_each_element(mesh, [&](int, const auto& v) { pixels.push_back(pixel_size(mesh, v, picture.scale())); });
  add_irregular(picture, mesh, mesh.quads.empty() ? 6 : 4, pixels, [](const Vec3&) { return true; });
  picture.write(path);
}

void draw_crosses(const std::filesystem::path& path, const Mesh& outline,
                  const std::vector<CrossGlyph>& crosses, const std::vector<SingularityMark>& singularities,
                  const std::string& title) {
  Picture picture(outline.points, title);
  std::map<int, Path> glyphs;  // by octave of their size in pixels
  for (const CrossGlyph& glyph : crosses) {
    const Vec2 arm = glyph.length / 2 * Vec2{std::cos(glyph.theta), std::sin(glyph.theta)};
    const double pixels = glyph.length * picture.scale();
    Path& lines = glyphs[std::clamp(pixels > 0 ? std::ilogb(pixels) : 0, 0, 5)];
    for (const Vec2 half : {arm, perp(arm)}) {
      lines.segment(picture.spot(glyph.at - half), picture.spot(glyph.at + half));
    }
  }
  for (const auto& [octave, lines] : glyphs) picture.add(lines, "none", "#2a6f97", 0.08 * std::exp2(octave));
  picture.add_outline(outline, kOutlineWidth);

  // Many marks must not hide the field: together they cover no more than this many of full size.
  constexpr double kLargest = 4.5, kSmallest = 1;  // pixels
  constexpr double kManyMarks = 60;
  const double n_marks = std::max(1.0, static_cast<double>(singularities.size()));
  const double radius = std::clamp(kLargest * std::sqrt(kManyMarks / n_marks), kSmallest, kLargest);
  std::vector<svg::Mark> marks;
  for (const SingularityMark& s : singularities)
    marks.push_back({s.at, std::abs(s.index) == 1 ? s.index : 0, radius});
  picture.add_marks(marks);
  if (!marks.empty()) picture.add_mark_legend({{1, "index +1/4"}, {-1, "index -1/4"}, {0, "other index"}});
  picture.write(path);
}

void draw_scalar(const std::filesystem::path& path, const Mesh& triangles, const std::vector<double>& values,
                 const std::string& title) {
  const bool all_finite = std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
  if (values.size() != triangles.points.size() || !all_finite) {
    throw std::invalid_argument("draw_scalar: one finite value a point is needed");
  }
  Picture picture(triangles.points, title);
  if (!values.empty()) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const ColourScale scale{*low, *high};
    std::vector<double> places;
    for (const double value : values) places.push_back(scale.place(value));
    add_bands(picture, triangles, places);
    picture.add_colour_bar("", labels(scale));
  }
  picture.add_outline(triangles, kOutlineWidth);
  picture.write(path);
}

}  // namespace delquad
