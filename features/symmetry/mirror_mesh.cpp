// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/segment.h"
#include "base/sort_unique.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/keep_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace delquad {
namespace {

template <std::size_t N>
std::array<int, N> image_of(std::array<int, N> element, const std::vector<int>& image, bool runs_back) {
  for (int& v : element) v = image[v];
  if (runs_back) std::reverse(element.begin() + 1, element.end());
  return element;
}

class MeshMirror {
 public:
  MeshMirror(const MirroredSurface& mirrored, Mesh part, std::size_t n_first)
      : m_(mirrored), mesh_(std::move(part)), planes_(m_.node_planes), is_first_(mesh_.quads.size(), 0) {
    std::fill_n(is_first_.begin(), n_first, 1);
    planes_.resize(mesh_.points.size(), 0);
    const auto put_in_plane = [&](const auto& elements, const std::vector<int>& regions) {
      for (std::size_t e = 0; e < elements.size(); ++e)
        for (const int v : elements[e]) planes_[v] |= m_.face_planes[regions[e]];
    };
    put_in_plane(mesh_.triangles, mesh_.triangle_region);
    put_in_plane(mesh_.quads, mesh_.quad_region);
  }

  Mesh run() {
    take_curves_of_whole();
    for (std::size_t v = 0; v < planes_.size(); ++v)
      mesh_.points[v] = m_.planes.put_on_all(planes_[v], mesh_.points[v]);
    for (int k = 0; k < m_.planes.count(); ++k) add_image(k);
    if (std::ranges::count(is_first_, 1) > 0) sort_quads();
    name_points();
    orient_outlines();
    return std::move(mesh_);
  }

 private:
  void take_curves_of_whole() {
    keep_lines(mesh_, [&](std::size_t l) {
      int& curve = mesh_.line_curve[l];
      if (m_.whole_curve[curve] < 0) return false;
      line_planes_.push_back(m_.curve_planes[curve]);
      curve = m_.whole_curve[curve];
      return true;
    });
    mesh_.curves = m_.whole.model.fine.curves;
    mesh_.named_points.clear();
  }

  void add_image(int plane) {
    const std::size_t n_points = mesh_.points.size();
    std::vector<int> image(n_points);
    for (std::size_t v = 0; v < n_points; ++v) {
      image[v] = static_cast<int>(v);
      if (planes_[v] >> plane & 1) continue;
      image[v] = static_cast<int>(mesh_.points.size());
      mesh_.points.push_back(m_.planes.reflect(plane, mesh_.points[v]));
      planes_.push_back(int(planes_[v]));
    }
    add_elements(plane, image, mesh_.triangles, mesh_.triangle_region);
    add_elements(plane, image, mesh_.quads, mesh_.quad_region);
    const std::size_t n_lines = mesh_.lines.size();
    for (std::size_t l = 0; l < n_lines; ++l) {
      if (line_planes_[l] >> plane & 1) continue;
      const std::array<int, 2> line{image[mesh_.lines[l][1]], image[mesh_.lines[l][0]]};  // runs on
      mesh_.lines.push_back(line);
      mesh_.line_curve.push_back(image_curve(plane, mesh_.line_curve[l], line));
      line_planes_.push_back(int(line_planes_[l]));
    }
  }

  template <std::size_t N>
  void add_elements(int plane, const std::vector<int>& image, std::vector<std::array<int, N>>& elements,
                    std::vector<int>& regions) {
    const std::size_t n = elements.size();
    for (std::size_t e = 0; e < n; ++e) {
      const int face = regions[e];
      if (m_.face_planes[face] >> plane & 1) continue;
      if constexpr (N == 4) is_first_.push_back(char(is_first_[e]));
      elements.push_back(image_of(std::array(elements[e]), image, !m_.matches[plane].turned[face]));
      regions.push_back(m_.matches[plane].face[face]);
    }
  }

  /// Moves the first quads of the part, and their images, before all others.
  void sort_quads() {
    const auto quads = std::exchange(mesh_.quads, {});
    const std::vector<int> regions = std::exchange(mesh_.quad_region, {});
    for (const int first : {1, 0})
      for (std::size_t q = 0; q < quads.size(); ++q) {
        if (is_first_[q] != first) continue;
        mesh_.quads.push_back(quads[q]);
        mesh_.quad_region.push_back(regions[q]);
      }
  }

  int image_curve(int plane, int curve, const std::array<int, 2>& line) {
    const std::vector<int> among = image_curves(m_, 1 << plane, curve);
    if (among.size() == 1) return among[0];
    // A curve of the whole has several images where ends of others on it have none.
    if (lines_of_.empty()) {
      lines_of_.resize(m_.whole.model.fine.curves.size());
      for (std::size_t l = 0; l < m_.whole.model.fine.lines.size(); ++l)
        lines_of_[m_.whole.model.fine.line_curve[l]].push_back(m_.whole.model.fine.lines[l]);
    }
    const Vec3 middle = 0.5 * (mesh_.points[line[0]] + mesh_.points[line[1]]);
    int nearest = among[0];
    double least = std::numeric_limits<double>::infinity();
    for (const int other : among)
      for (const auto& [a, b] : lines_of_[other]) {
        const double distance =
            distance_to_segment(middle, m_.whole.model.fine.points[a], m_.whole.model.fine.points[b]);
        if (distance < least) least = distance, nearest = other;
      }
    return nearest;
  }

  void name_points() {
    for (const NamedPoint& named : m_.whole.model.fine.named_points) {
      const Vec3 x = m_.whole.model.fine.points[named.point];
      int nearest = -1;
      double least = std::numeric_limits<double>::infinity();
      for (const auto& line : mesh_.lines)
        for (const int v : line)
          if (const double distance = norm(mesh_.points[v] - x); distance < least)
            least = distance, nearest = v;
      if (nearest >= 0) mesh_.named_points.push_back({nearest, named.entity});
    }
  }

  /// Lines with an element on one side have it on their left.
  void orient_outlines() {
    std::map<std::array<int, 2>, std::size_t> lines;
    std::vector<char> on_line(mesh_.points.size(), 0);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      lines.emplace(mesh_.lines[l], l);
      for (const int v : mesh_.lines[l]) on_line[v] = 1;
    }
    std::vector<int> sides(mesh_.lines.size(), 0);  // 1: on the left, 2: on the right
    const auto look = [&](const auto& elements) {
      for (const auto& element : elements)
        for (std::size_t k = 0; k < element.size(); ++k) {
          const int a = element[k], b = element[(k + 1) % element.size()];
          if (!on_line[a] || !on_line[b]) continue;
          if (const auto left = lines.find({a, b}); left != lines.end()) sides[left->second] |= 1;
          if (const auto right = lines.find({b, a}); right != lines.end()) sides[right->second] |= 2;
        }
    };
    look(mesh_.triangles);
    look(mesh_.quads);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      if (sides[l] == 2) std::swap(mesh_.lines[l][0], mesh_.lines[l][1]);
  }

  const MirroredSurface& m_;
  Mesh mesh_;
  std::vector<int> planes_;                                // of each node
  std::vector<int> line_planes_;                           // of each line
  std::vector<char> is_first_;                             // of each quad
  std::vector<std::vector<std::array<int, 2>>> lines_of_;  // of each curve of the whole
};

}  // namespace

int image_face(const MirroredSurface& mirrored, int planes, int face) {
  for (int k = 0; k < mirrored.planes.count(); ++k)
    if (planes >> k & 1) face = mirrored.matches[k].face[face];
  return face;
}

std::vector<int> image_curves(const MirroredSurface& mirrored, int planes, int curve) {
  if (curve >= mirrored.first_cut) return {curve + planes};
  std::vector<int> curves{curve};
  for (int k = 0; k < mirrored.planes.count(); ++k) {
    if (!(planes >> k & 1)) continue;
    std::vector<int> images;
    for (const int c : curves) {
      const std::vector<int>& of = mirrored.matches[k].curves[c];
      images.insert(images.end(), of.begin(), of.end());
      if (of.empty()) images.push_back(c);
    }
    sort_unique(images);
    curves = std::move(images);
  }
  return curves;
}

Vec3 image_node(const MirroredSurface& mirrored, int planes, int node, const Vec3& x) {
  const int on = mirrored.node_planes[node];
  return mirrored.planes.reflect_all(planes & ~on, mirrored.planes.put_on_all(on, x));
}

std::vector<char> with_images(const MirroredSurface& mirrored, std::vector<char> faces) {
  const std::vector<char> before = faces;
  for (std::size_t f = 0; f < before.size(); ++f)
    for (int mask = 1; before[f] && mask < 1 << mirrored.planes.count(); ++mask)
      faces[image_face(mirrored, mask, static_cast<int>(f))] = 1;
  return faces;
}

void add_failures_of_images(const MirroredSurface& mirrored, std::vector<FaceFailure>& failures) {
  const std::vector<FaceFailure> before = failures;
  for (const FaceFailure& failure : before)
    for (int mask = 1; failure.face >= 0 && mask < 1 << mirrored.planes.count(); ++mask) {
      const int face = image_face(mirrored, mask, failure.face);
      if (std::ranges::find(failures, face, &FaceFailure::face) != failures.end()) continue;
      failures.push_back({face, fmt::format("face {} is the mirror image of another: {}",
                                            mirrored.whole.model.fine.regions[face].tag, failure.reason)});
    }
}

Mesh mirror_mesh(const MirroredSurface& mirrored, Mesh part, std::size_t n_first) {
  return MeshMirror(mirrored, std::move(part), n_first).run();
}

}  // namespace delquad
