// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimisation/planar_tracks.h"

#include <algorithm>
#include <cmath>

namespace delquad {

namespace {

/// Step of the difference for a curve's derivative, as a part of a node's range.
constexpr double kStep = 1e-6;

}  // namespace

PlanarTracks::PlanarTracks(std::vector<Vec2> nodes, const std::vector<CurvePlace>& places,
                           std::vector<Patch> patches, const ParametricSize& size)
    : places_(places),
      patches_(std::move(patches)),
      size_(size),
      points_(std::move(nodes)),
      stays_(points_.size(), 0) {
  places_.resize(points_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const QuadPatch& mesh = *patches_[p].mesh;
    std::vector<int> vertex = patches_[p].point_node;
    for (auto v = static_cast<std::size_t>(mesh.n_boundary); v < mesh.points.size(); ++v) {
      vertex.push_back(static_cast<int>(points_.size()));
      points_.push_back(mesh.points[v]);
    }
    for (std::array<int, 4> quad : mesh.quads) {
      for (int& v : quad) v = vertex[v];
      quads_.push_back(quad);
      quad_patch_.push_back(static_cast<int>(p));
    }
    stays_.resize(points_.size(), 0);
    for (const auto& triangle : mesh.triangles)
      for (const int v : triangle) stays_[vertex[v]] = 1;
  }
}

Vec2 PlanarTracks::put(int v, Vec2 position) {
  if (!slides(v)) return points_[v] = position;
  CurvePlace& place = places_[v];
  place.t = std::clamp(position.x, place.from, place.to);
  return points_[v] = place.curve->point(place.t);
}

std::array<Vec2, 2> PlanarTracks::axes(int v) const {
  if (stays_[v]) return {};
  if (!slides(v)) return {Vec2{1, 0}, Vec2{0, 1}};
  const CurvePlace& place = places_[v];
  if (!place.curve) return {};
  const double step = kStep * (place.to - place.from);
  const double a = std::max(place.t - step, place.from), b = std::min(place.t + step, place.to);
  return {1 / (b - a) * (place.curve->point(b) - place.curve->point(a)), Vec2{}};
}

Vec2 PlanarTracks::arm(int quad, int side, TrackHint& hint) const {
  const Vec2 a = points_[quads_[quad][side]], b = points_[quads_[quad][(side + 1) % 4]];
  const int patch = quad_patch_[quad];
  const Cross c = patches_[patch].cross->at(0.5 * (a + b), hint.cross_of(patch));
  const double angle = c.angle();
  return c.c == 0 && c.s == 0 ? Vec2{} : Vec2{std::cos(angle), std::sin(angle)};
}

void PlanarTracks::store(const std::vector<Vec2>& points) {
  std::size_t v = places_.size();
  for (const Patch& patch : patches_) {
    QuadPatch& mesh = *patch.mesh;
    for (int i = 0; i < mesh.n_boundary; ++i) mesh.points[i] = points[patch.point_node[i]];
    for (std::size_t i = mesh.n_boundary; i < mesh.points.size(); ++i) mesh.points[i] = points[v++];
  }
}

}  // namespace delquad
