// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/split_polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/predicates.h"

namespace delquad {

namespace {

/// Returns the polygon without the coordinate of its largest normal component, counterclockwise. Coordinates
/// stay exact.
std::vector<Vec2> flattened(const std::vector<Vec3>& corners) {
  Vec3 normal{0, 0, 0};
  for (size_t k = 0; k < corners.size(); ++k) {
    const Vec3 a = corners[k] - corners[0], b = corners[(k + 1) % corners.size()] - corners[0];
    normal = normal + cross(a, b);
  }
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  std::vector<Vec2> flat;
  for (const Vec3& p : corners) {
    if (z >= x && z >= y)
      flat.push_back(normal.z > 0 ? Vec2{p.x, p.y} : Vec2{p.y, p.x});
    else if (y >= x)
      flat.push_back(normal.y > 0 ? Vec2{p.z, p.x} : Vec2{p.x, p.z});
    else
      flat.push_back(normal.x > 0 ? Vec2{p.y, p.z} : Vec2{p.z, p.y});
  }
  return flat;
}

/// Cuts ears off a polygon. It ends, since every step removes a corner or fails.
class EarCutter {
 public:
  explicit EarCutter(std::vector<Vec2> corners) : at_(std::move(corners)) {
    const int n = static_cast<int>(at_.size());
    for (int k = 0; k < n; ++k) ring_.push_back(k);
    quality_.assign(at_.size(), kUnknown);
  }

  std::optional<std::vector<std::array<int, 3>>> cut() {
    std::vector<std::array<int, 3>> triangles;
    while (ring_.size() > 2) {
      const int k = best_ear();
      if (k < 0) return std::nullopt;
      const int n = static_cast<int>(ring_.size()), before = (k + n - 1) % n, after = (k + 1) % n;
      triangles.push_back({ring_[before], ring_[k], ring_[after]});
      quality_[ring_[before]] = quality_[ring_[after]] = kUnknown;
      ring_.erase(ring_.begin() + k);
    }
    return triangles;
  }

 private:
  static constexpr double kUnknown = -1, kNoEar = 0;

  /// Returns the place of the best ear in the ring; -1: none. Ears that other corners hid are tested again
  /// only if no ear is left.
  int best_ear() {
    int best = best_known();
    if (best >= 0) return best;
    for (const int corner : ring_) quality_[corner] = kUnknown;
    return best_known();
  }

  int best_known() {
    const size_t n = ring_.size();
    for (size_t k = 0; k < n; ++k)
      if (double& known = quality_[ring_[k]]; known == kUnknown) known = ear_quality(static_cast<int>(k));
    // An ear of four corners leaves the opposite one.
    const auto quality = [&](size_t k) {
      return n == 4 ? std::min(quality_[ring_[k]], quality_[ring_[(k + 2) % n]]) : quality_[ring_[k]];
    };
    int best = -1;
    for (size_t k = 0; k < n; ++k)
      if (quality(k) > kNoEar && (best < 0 || quality(k) > quality(static_cast<size_t>(best))))
        best = static_cast<int>(k);
    return best;
  }

  /// Returns area over squared sides, > 0, of the triangle at a corner; otherwise it is no ear.
  double ear_quality(int k) const {
    const int n = static_cast<int>(ring_.size());
    const Vec2 a = at_[ring_[(k + n - 1) % n]], b = at_[ring_[k]], c = at_[ring_[(k + 1) % n]];
    if (orient2d(a, b, c) <= 0) return kNoEar;
    for (const int other : ring_) {
      const Vec2 p = at_[other];
      if (p == a || p == b || p == c) continue;
      if (orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0) return kNoEar;
    }
    const double area = cross(b - a, c - a);
    const double sides = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
    return std::max(area / sides, std::numeric_limits<double>::min());
  }

  std::vector<Vec2> at_;
  std::vector<int> ring_;
  std::vector<double> quality_;  ///< quality of each corner as an ear
};

}  // namespace

std::optional<std::vector<std::array<int, 3>>> split_polygon(const std::vector<Vec3>& corners) {
  return EarCutter(flattened(corners)).cut();
}

void split_quads(Mesh& mesh, ReadNotes& notes) {
  if (mesh.quads.empty()) return;
  std::size_t odd = 0;
  std::vector<double> of_parts;
  for (size_t i = 0; i < mesh.quads.size(); ++i) {
    const auto& q = mesh.quads[i];
    const auto corner = [&](int k) { return mesh.points[q[k]]; };
    auto parts = split_polygon({corner(0), corner(1), corner(2), corner(3)});
    if (!parts) {
      ++odd;
      if (norm(corner(2) - corner(0)) <= norm(corner(3) - corner(1)))
        parts = {{0, 1, 2}, {0, 2, 3}};
      else
        parts = {{0, 1, 3}, {1, 2, 3}};
    }
    for (const auto& t : *parts) mesh.triangles.push_back({q[t[0]], q[t[1]], q[t[2]]});
    mesh.triangle_region.insert(mesh.triangle_region.end(), parts->size(), mesh.quad_region[i]);
    if (!mesh.thickness.empty())
      of_parts.insert(of_parts.end(), parts->size(),
                      mesh.thickness[mesh.thickness.size() - mesh.quads.size() + i]);
  }
  notes.push_back(mesh.quads.size() == 1
                      ? "1 quad was split into triangles"
                      : fmt::format("{} quads were split into triangles", mesh.quads.size()));
  if (odd > 0)
    notes.back() +=
        fmt::format("; along the shorter diagonal where they cross themselves or have no area ({})", odd);
  if (!mesh.thickness.empty()) mesh.thickness.resize(mesh.thickness.size() - mesh.quads.size());
  mesh.thickness.insert(mesh.thickness.end(), of_parts.begin(), of_parts.end());
  mesh.quads.clear();
  mesh.quad_region.clear();
}

}  // namespace delquad
