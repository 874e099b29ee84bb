// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "base/box.h"
#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/cell_view.h"
#include "io/item_buffer.h"
#include "io/picture.h"
#include "io/svg.h"
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

/// Beyond this many elements edges would only blacken the picture.
constexpr size_t kMostOutlined = 30'000;

Vec3 unit(const Vec3& v) { return (1 / norm(v)) * v; }

/// A parallel projection: x right, y up, z towards the viewer.
struct View {
  Vec3 right, up, towards;
  Vec3 operator()(const Vec3& p) const { return {dot(right, p), dot(up, p), dot(towards, p)}; }
};

/// From the direction `towards`, the z axis upright.
View view_from(const Vec3& towards) {
  View view;
  view.towards = unit(towards);
  view.right = unit(cross({0, 0, 1}, view.towards));
  view.up = cross(view.towards, view.right);
  return view;
}

std::vector<Vec3> seen(const View& view, const std::vector<Vec3>& points) {
  std::vector<Vec3> result;
  result.reserve(points.size());
  for (const Vec3& p : points) result.push_back(view(p));
  return result;
}

template <size_t N>
Vec3 area_vector(const std::vector<Vec3>& points, const std::array<int, N>& v) {
  if constexpr (N == 3) return 0.5 * cross(points[v[1]] - points[v[0]], points[v[2]] - points[v[0]]);
  return 0.5 * cross(points[v[2]] - points[v[0]], points[v[N - 1]] - points[v[1]]);
}

/// Square root of the projected area, in pixels.
template <size_t N>
double pixel_size(const Mesh& mesh, const std::array<int, N>& v, const Picture& picture) {
  return std::sqrt(std::abs(area_vector(mesh.points, v).z)) * picture.scale();
}

/// Elements of a projected mesh on a raster that just holds it.
class Raster {
 public:
  Raster(const Mesh& mesh, double samples_a_unit) : mesh_(mesh), scale_(samples_a_unit), buffer_(0, 0) {
    const auto box = Box<Vec3>::around(std::span(mesh.points));
    low_ = box.low;
    const Vec3 size = scale_ * box.size();
    buffer_ = ItemBuffer(static_cast<int>(size.x) + 2, static_cast<int>(size.y) + 2);
    for_each_element(mesh, [&](int element, const auto& v) {
      for_each_part(v, [&](const std::array<Vec3, 3>& part) { buffer_.add(element, part); });
    });
  }

  const ItemBuffer& buffer() const { return buffer_; }

  enum class Visibility { kHidden, kPartly, kWholly };
  template <size_t N>
  Visibility of(const std::array<int, N>& v) const {
    constexpr double kRounding = 1e-7;  // samples
    int samples = 0, nearest = 0;
    Vec3 centre;
    for_each_part(v, [&](const std::array<Vec3, 3>& part) {
      centre = (1.0 / 3) * (part[0] + part[1] + part[2]);
      buffer_.for_each_sample(part, [&](size_t at, double depth) {
        ++samples;
        nearest += depth >= buffer_.depth(at) - kRounding;
      });
    });
    if (samples == 0) return sees(centre) ? Visibility::kPartly : Visibility::kHidden;
    return nearest == 0 ? Visibility::kHidden : nearest < samples ? Visibility::kPartly : Visibility::kWholly;
  }

  bool sees_point(const Vec3& p) const { return sees(to_samples(p)); }

 private:
  Vec3 to_samples(const Vec3& p) const { return scale_ * (p - low_); }

  bool sees(const Vec3& p) const {
    constexpr double kSlack = 1.5;  // samples: a surface may come as much nearer from one to the next
    return p.z > buffer_.depth_around(p.x, p.y) - kSlack;
  }

  template <size_t N, class Visit>
  void for_each_part(const std::array<int, N>& v, Visit visit) const {
    const auto at = [&](size_t k) { return to_samples(mesh_.points[v[k]]); };
    for (size_t k = 1; k + 1 < N; ++k) visit({at(0), at(k), at(k + 1)});
  }

  const Mesh& mesh_;
  double scale_;
  Vec3 low_;
  ItemBuffer buffer_;
};

double largest_extent(const std::vector<Vec3>& points) {
  double extent = 0;
  for (const Vec3& p : points) {
    const Vec3 d = p - points[0];
    extent = std::max({extent, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  return extent;
}

/// Area of the surface that is seen, except at grazing angles.
double seen_area(const Mesh& projected) {
  constexpr double kSamples = 200, kGrazing = 0.2;  // across; cosine
  const double extent = largest_extent(projected.points);
  if (!(extent > 0)) return 0;
  std::vector<double> cosine;
  for_each_element(projected, [&](int, const auto& v) {
    const Vec3 area = area_vector(projected.points, v);
    cosine.push_back(std::abs(area.z) / norm(area));
  });
  double area = 0;
  const Raster raster(projected, kSamples / extent);
  for (const int item : raster.buffer().items()) {
    if (item >= 0 && cosine[item] > kGrazing) area += 1 / cosine[item];
  }
  return area * extent * extent;
}

/// The mesh seen from that corner of a cube around it from which most of it is seen, rather from above.
Mesh best_view(const Mesh& mesh) {
  constexpr double kClearly = 1.02;  // times as much area as the views before
  Mesh best, projected = mesh;
  double most = -1;
  for (const double z : {1.0, -1.0}) {
    for (const auto& [x, y] : {std::pair{1.0, -1.0}, {-1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
      projected.points = seen(view_from({x, y, z}), mesh.points);
      const double area = seen_area(projected);
      if (area <= kClearly * most) continue;
      most = area;
      best = projected;
    }
  }
  return best;
}

/// Color `rgb` (#rrggbb) in light of strength t.
std::string shaded(const std::string& rgb, double t) {
  std::string result = "#";
  for (size_t k = 1; k < 7; k += 2) {
    const double channel = static_cast<double>(std::strtol(rgb.substr(k, 2).c_str(), nullptr, 16));
    result += fmt::format("{:02x}", static_cast<int>(std::lround(channel * t)));
  }
  return result;
}

/// From 0 to 1, in few steps so that many elements share a color.
double brightness(const Vec3& area) {
  constexpr double kSteps = 16, kAmbient = 0.6;
  const Vec3 light = unit({-0.4, 0.6, 1});
  const double n = norm(area);
  const double facing = n > 0 ? dot(area.z < 0 ? -1 * area : area, light) / n : 0;
  return kAmbient + (1 - kAmbient) * std::round(kSteps * std::max(facing, 0.0)) / kSteps;
}

std::string face_colour(int region) {
  static constexpr std::array<const char*, 12> kPale = {"#e3e3e3", "#a6cee3", "#b2df8a", "#fdbf6f",
                                                        "#cab2d6", "#fb9a99", "#ffff99", "#8dd3c7",
                                                        "#d9b48f", "#bebada", "#ccebc5", "#fccde5"};
  return kPale[static_cast<size_t>(region) % kPale.size()];
}

/// Fill of each element: eta of quads, a color a region for triangles; in space with light on it.
std::vector<std::string> fills(const Mesh& projected, bool is_lit) {
  constexpr int kShades = 32;
  const std::vector<double> eta = quad_etas(projected);
  const size_t n_triangles = projected.triangles.size();
  std::vector<std::string> fill;
  for_each_element(projected, [&](int element, const auto& v) {
    const size_t e = static_cast<size_t>(element);
    std::string base;
    if (e < n_triangles) {
      base = face_colour(projected.quads.empty() ? projected.triangle_region[e] : 0);
    } else {
      const int step = std::min(static_cast<int>(eta[e - n_triangles] * kShades), kShades - 1);
      base = svg::colour((step + 0.5) / kShades);
    }
    fill.push_back(is_lit ? shaded(base, brightness(area_vector(projected.points, v))) : base);
  });
  return fill;
}

std::vector<Vec3> outline_of(const Mesh& mesh, int element) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  if (element >= n_triangles) return outline_of_quad(mesh, static_cast<size_t>(element - n_triangles));
  const auto& [a, b, c] = mesh.triangles[static_cast<size_t>(element)];
  return {mesh.points[a], mesh.points[b], mesh.points[c]};
}

/// Elements of about one size have one width of their edges: its step, by the element's size in pixels.
int step_of_width(double pixels) {
  constexpr int kLeast = -8, kMost = 8;  // steps of sqrt 2 of the pixel size that get a width of their own
  return pixels > 0 ? std::clamp(static_cast<int>(std::lround(2 * std::log2(pixels))), kLeast, kMost)
                    : kLeast;
}

void add_elements(Picture& picture, const Path& elements, const std::string& fill, int step,
                  bool with_edges) {
  constexpr double kEdgeWidth = 0.06;  // of the element's size
  constexpr double kSeamWidth = 0.3;   // pixels; hides the seams between elements drawn without edges
  picture.add(elements, fill, with_edges ? "#222" : fill,
              with_edges ? kEdgeWidth * std::exp2(0.5 * step) : kSeamWidth);
}

/// Elements that are seen: first those that others cover in part, far ones first; the rest cover each other
/// nowhere and need no order.
class ElementLayers {
 public:
  /// `raster`: null in a plane, where all is seen.
  ElementLayers(const Mesh& mesh, const Raster* raster, const Picture& picture)
      : fill_(fills(mesh, raster != nullptr)) {
    for_each_element(mesh, [&](int element, const auto& v) {
      const auto visibility = raster != nullptr ? raster->of(v) : Raster::Visibility::kWholly;
      if (visibility == Raster::Visibility::kHidden) return;
      const int step = step_of_width(pixel_size(mesh, v, picture));
      std::vector<svg::PixelPoint> corners;
      double depth = 0;
      for (const int i : v) depth += mesh.points[i].z / static_cast<double>(v.size());
      for (const Vec3& p : outline_of(mesh, element)) corners.push_back(picture.spot(p));
      if (visibility == Raster::Visibility::kWholly) {
        front_[{-step, fill_[element]}].polygon(corners);
      } else {
        behind_.push_back({depth, element, step, std::move(corners)});
      }
    });
    std::sort(behind_.begin(), behind_.end(), [](const SortedElement& a, const SortedElement& b) {
      return a.depth != b.depth ? a.depth < b.depth : a.element < b.element;
    });
  }

  void draw(Picture& picture, bool with_edges) const {
    for (const SortedElement& one : behind_) {
      Path path;
      path.polygon(one.corners);
      add_elements(picture, path, fill_[one.element], one.step, with_edges);
    }
    for (const auto& [key, path] : front_) add_elements(picture, path, key.second, -key.first, with_edges);
  }

 private:
  struct SortedElement {
    double depth;
    int element, step;
    std::vector<svg::PixelPoint> corners;
  };
  std::vector<std::string> fill_;
  std::vector<SortedElement> behind_;
  std::map<std::pair<int, std::string>, Path> front_;  // large elements first
};

/// The side of an element on an edge, both ends included.
std::vector<Vec3> side_of(const Mesh& mesh, const HalfEdge& edge) {
  std::vector<Vec3> outline = outline_of(mesh, edge.element);
  const int corner = cell_side(mesh, edge).side;
  const int pieces = drawn_pieces(mesh);
  std::ranges::rotate(outline, outline.begin() + corner * pieces);
  outline.push_back(outline[0]);
  outline.resize(static_cast<size_t>(pieces) + 1);
  return outline;
}

/// Curves of the model and free edges, where they are seen.
Path seen_lines(const Mesh& mesh, const Raster* raster, const Picture& picture) {
  Path path;
  const auto add = [&](std::span<const Vec3> line) {
    const size_t pieces = line.size() - 1;
    // Elements are hidden by the chords of others.
    if (raster != nullptr && !raster->sees_point(0.5 * (line[0] + line[pieces]))) return;
    for (size_t k = 0; k < pieces; ++k) path.segment(picture.spot(line[k]), picture.spot(line[k + 1]));
  };
  for (size_t l = 0; l < mesh.lines.size(); ++l) add(outline_of_line(mesh, l));
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) add(side_of(mesh, edge[0]));
  });
  return path;
}

/// Adds dots on irregular vertices that are seen, and lines that join pairs of them, with their legend.
/// pixels: the size of each element.
void add_irregular(Picture& picture, const Mesh& mesh, int regular, const std::vector<double>& pixels,
                   const std::function<bool(const Vec3&)>& is_seen) {
  constexpr double kRadius = 0.2, kLeast = 0.5, kMost = 5;  // of the mean size of the elements around; pixels
  std::vector<svg::Mark> marks;
  const IrregularVertices irregular = irregular_vertices(mesh, regular, pixels);
  for (const auto& [vertex, valence, mean_size] : irregular.vertices) {
    if (!is_seen(mesh.points[vertex])) continue;
    const int index = std::abs(regular - valence) == 1 ? regular - valence : 0;
    marks.push_back({{mesh.points[vertex].x, mesh.points[vertex].y},
                     index,
                     std::clamp(kRadius * mean_size, kLeast, kMost)});
  }
  std::vector<std::array<Vec2, 2>> pairs;
  for (const auto& [few, many] : irregular.pairs)
    if (is_seen(mesh.points[few]) && is_seen(mesh.points[many]))
      pairs.push_back(
          {Vec2{mesh.points[few].x, mesh.points[few].y}, Vec2{mesh.points[many].x, mesh.points[many].y}});
  picture.add_marks(marks, pairs);
  if (!mesh.quads.empty())
    picture.add_colour_bar("eta",
                           {{0, "0"}, {0.2, "0.2"}, {0.4, "0.4"}, {0.6, "0.6"}, {0.8, "0.8"}, {1, "1"}});
  if (!marks.empty())
    picture.add_mark_legend({{1, "valence " + std::to_string(regular - 1)},
                             {-1, "valence " + std::to_string(regular + 1)},
                             {0, "other valence"}});
}

}  // namespace

void draw_mesh(const std::filesystem::path& path, const Mesh& mesh, const std::string& title) {
  const bool is_flat =
      std::ranges::all_of(mesh.points, [&](const Vec3& p) { return p.z == mesh.points[0].z; });
  const Mesh projected = is_flat ? mesh : best_view(mesh);
  Picture picture(projected.points, title);
  constexpr double kSamplesAPixel = 2;
  std::optional<Raster> raster;
  if (!is_flat) raster.emplace(projected, kSamplesAPixel * picture.scale());
  const Raster* seen = raster ? &*raster : nullptr;
  ElementLayers(projected, seen, picture)
      .draw(picture, mesh.quads.size() + mesh.triangles.size() <= kMostOutlined);
  constexpr double kLineWidth = 1.1;
  picture.add(seen_lines(projected, seen, picture), "none", "#000", kLineWidth);
  if (is_flat || !mesh.quads.empty()) {
    std::vector<double> pixels;
    for_each_element(projected,
                     [&](int, const auto& v) { pixels.push_back(pixel_size(projected, v, picture)); });
    add_irregular(picture, projected, mesh.quads.empty() ? 6 : 4, pixels,
                  [&](const Vec3& p) { return seen == nullptr || seen->sees_point(p); });
  }
  picture.write(path);
}

}  // namespace delquad
