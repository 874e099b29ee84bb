// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sort_unique.h"
#include "features/periodic/paired_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "delquad/error.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {
namespace {

/// Chords of a surface that bends by an angle from triangle to triangle are off by this part of angle times
/// side, at most. It is a sixth by the circle around an equilateral triangle, over the distance of two
/// middles.
constexpr double kChordPart = 0.3;

/// How far something is, and how far it may be.
struct FaceGap {
  double distance, allowed;
};

/// The triangles of a face.
class PairedFace {
 public:
  PairedFace(const SurfaceModel& model, int face) : model_(model), face_(face) {
    const Mesh& fine = model.fine;
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      if (fine.triangle_region[t] == face) triangles_.push_back(fine.triangles[t]);
    if (triangles_.empty()) return;
    nearest_.emplace(fine.points, triangles_);
    for (const auto& t : triangles_) points_.insert(points_.end(), t.begin(), t.end());
    sort_unique(points_);
    measure_bends();
  }

  int face() const { return face_; }
  const std::vector<int>& points() const { return points_; }
  bool is_empty() const { return triangles_.empty(); }

  Vec3 normal(int triangle) const {
    const auto& [a, b, c] = triangles_[triangle];
    const auto& p = model_.fine.points;
    return cross(p[b] - p[a], p[c] - p[a]);
  }
  int largest() const {
    int best = 0;
    for (int t = 1; t < static_cast<int>(triangles_.size()); ++t)
      if (norm(normal(t)) > norm(normal(best))) best = t;
    return best;
  }
  Vec3 middle(int triangle) const {
    Vec3 sum;
    for (const int v : triangles_[triangle]) sum = sum + (1.0 / 3) * model_.fine.points[v];
    return sum;
  }
  NearestTriangle::Found find(const Vec3& x) const { return nearest_->find(x); }
  /// On triangulations chords explain some distance.
  FaceGap gap(const Vec3& x, double tolerance) const {
    if (model_.projector) return {norm(model_.projector->to_face(face_, x) - x), tolerance};
    const NearestTriangle::Found found = nearest_->find(x);
    double chord = 0;
    for (const int v : triangles_[found.triangle]) chord = std::max(chord, bend_.at(v));
    return {found.distance, tolerance + chord};
  }

 private:
  /// At each point the most that chords there may be off the surface that they stand for.
  void measure_bends() {
    for (const int v : points_) bend_[v] = 0;
    std::map<std::array<int, 2>, int> beside;
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
        const auto [at, is_new] = beside.try_emplace({a, b}, t);
        if (is_new) continue;
        const Vec3 n = normal(t), m = normal(at->second);
        const double angle = std::atan2(norm(cross(n, m)), dot(n, m));
        for (const int u : {t, at->second})
          for (const int v : triangles_[u])
            for (const int w : triangles_[u])
              bend_[v] = std::max(bend_[v],
                                  kChordPart * angle * norm(model_.fine.points[v] - model_.fine.points[w]));
      }
  }

  const SurfaceModel& model_;
  int face_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> points_;
  std::optional<NearestTriangle> nearest_;
  std::map<int, double> bend_;
};

std::vector<PairedFace> paired_faces(const SurfaceModel& model, const std::vector<int>& faces,
                                     const PeriodicPair& pair) {
  std::vector<PairedFace> all;
  for (const int f : faces) {
    all.emplace_back(model, f);
    if (all.back().is_empty())
      throw InputError(
          fmt::format("{}: periodic face {} has no triangles: expected a face that can be meshed", pair.where,
                      model.fine.regions[f].tag));
  }
  return all;
}

/// Throws where points of a face, once moved, are off the other.
void check_apart(const Mesh& fine, const PairedFace& a, const Motion& motion, const PairedFace& b,
                 const PeriodicPair& pair) {
  const double tolerance = kPeriodicTolerance * diagonal(fine);
  FaceGap worst{0, 0};
  Vec3 at;
  for (const int v : a.points()) {
    const FaceGap gap = b.gap(motion(fine.points[v]), tolerance);
    if (gap.distance - gap.allowed > worst.distance - worst.allowed) worst = gap, at = fine.points[v];
  }
  if (!(worst.distance > worst.allowed)) return;
  throw InputError(
      fmt::format("{}: the faces do not match: the image of face {} at ({:.10g}, {:.10g}, {:.10g}) is {:.3g} "
                  "away from face {}, and {:.3g} is the most there may be [periodic-mismatch]",
                  pair.where, fine.regions[a.face()].tag, at.x, at.y, at.z, worst.distance,
                  fine.regions[b.face()].tag, worst.allowed));
}

}  // namespace

std::vector<FacePair> pair_faces(const SurfaceModel& model, const std::vector<int>& from,
                                 const std::vector<int>& to, const PeriodicPair& pair) {
  const Mesh& fine = model.fine;
  const std::vector<PairedFace> masters = paired_faces(model, from, pair),
                                images = paired_faces(model, to, pair);
  const Motion back = pair.motion.inverse();
  std::vector<FacePair> pairs;
  for (const PairedFace& master : masters) {
    const Vec3 x = pair.motion(master.middle(master.largest()));
    const PairedFace* image = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const PairedFace& candidate : images)
      if (const double d = candidate.find(x).distance; d < least) least = d, image = &candidate;
    check_apart(fine, master, pair.motion, *image, pair);
    check_apart(fine, *image, back, master, pair);
    for (const FacePair& known : pairs)
      if (known.face == image->face())
        throw InputError(fmt::format(
            "{}: face {} would be the image of face {} and of face {}: expected one of them", pair.where,
            fine.regions[known.face].tag, fine.regions[known.master].tag, fine.regions[master.face()].tag));
    const Vec3 origin = pair.motion({});
    const Vec3 normal = pair.motion(master.normal(master.largest())) - origin;
    const bool is_reversed = dot(normal, image->normal(image->find(x).triangle)) < 0;
    pairs.push_back({image->face(), master.face(), is_reversed, pair});
  }
  if (from.size() != to.size())
    throw InputError(fmt::format("{}: '{}' is not the image of '{}': it has {} faces, and the image has {}",
                                 pair.where, pair.to, pair.from, to.size(), from.size()));
  return pairs;
}

}  // namespace delquad
