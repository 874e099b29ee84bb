// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "base/parallel_each.h"
#include "features/midsurface/opposite_sides.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// Least eigenvalue of the directions to the other side, in parts of the largest. Faces whose directions
/// differ by less than 11 degrees count as one.
constexpr double kOtherDirection = 0.01;
/// At sharper folds nodes move by the mean of the distances.
constexpr double kFarthest = 3;

/// Distances to the other side from a node, along the directions of its faces.
struct Ways {
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  Eigen::Vector3d lengths = Eigen::Vector3d::Zero();
  Vec3 sum = {};
  double longest = 0;
  int number = 0;

  void add(const Vec3& way) {
    const double length = norm(way);
    if (!(length > 0)) return;
    const Eigen::Vector3d n(way.x / length, way.y / length, way.z / length);
    directions += n * n.transpose();
    lengths += length * n;
    sum = sum + way;
    longest = std::max(longest, length);
    ++number;
  }
  /// Returns the shift that has each of the lengths along its direction, as nearly as can be.
  Vec3 shift() const {
    if (number == 0) return {};
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(directions);
    Eigen::Vector3d all = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      if (const double value = axes.eigenvalues()[k]; value > kOtherDirection * axes.eigenvalues()[2])
        all += axes.eigenvectors().col(k).dot(lengths) / value * axes.eigenvectors().col(k);
    return all.norm() <= kFarthest * longest ? Vec3{all[0], all[1], all[2]} : (1.0 / number) * sum;
  }
};

/// Adds names that are no colors, and that `others` do not have.
void add_names(const std::vector<std::string>& from, const std::vector<std::string>& others,
               std::vector<std::string>& to) {
  for (const std::string& name : from)
    if (!name.starts_with(kColourName) && std::ranges::find(to, name) == to.end() &&
        std::ranges::find(others, name) == others.end())
      to.push_back(name);
}

}  // namespace

Vec3 OppositeSides::nearest(int face, const Vec3& x) const {
  return projector_ ? projector_->to_face(face, x) : regions_.place(face, x);
}

void OppositeSides::add_to(SurfaceModel& model) const {
  Mesh& mesh = model.fine;
  const auto is_meshed = [&](int f) { return std::ranges::binary_search(faces_, f); };
  for (std::size_t g = 0; g < is_narrow_.size(); ++g)
    if (!is_narrow_[g] && !is_meshed(static_cast<int>(g)))
      for (const auto& [f, part] : parts_facing(static_cast<int>(g)))
        if (part >= kFacedPart && is_meshed(f)) add_names(fine_.regions[g].names, {}, mesh.regions[f].names);
  const std::vector<HalfEdge> sides = sorted_half_edges(fine_);
  std::map<int, int> thinner;  // by curve of a step, the face beside it
  for (std::size_t l = 0; l < fine_.lines.size(); ++l) {
    const auto edge = sides_of_edge(sides, fine_.lines[l][0], fine_.lines[l][1]);
    if (edge.size() != 2) continue;
    for (const int k : {0, 1}) {
      const int f = region_of(fine_, edge[k].element), r = region_of(fine_, edge[1 - k].element);
      if (is_narrow_[f] || !is_narrow_[r]) continue;
      if (is_meshed(f))
        add_names(fine_.regions[r].names, fine_.regions[f].names, mesh.curves[fine_.line_curve[l]].names);
      const auto is_thinner = [&](const auto& g) {
        return !is_narrow_[g.first] && thickness_[g.first] < thickness_[f];
      };
      if (side_of_step(r) >= 0 && std::ranges::none_of(shared_[r], is_thinner))
        thinner.emplace(fine_.line_curve[l], f);
    }
  }
  const std::vector<std::vector<int>> points = points_of_curves(fine_);
  for (const auto& [curve, face] : thinner) {
    const auto parts = parts_facing(face);
    if (parts.empty()) continue;
    const int opposite = std::ranges::max_element(parts, {}, [](const auto& p) { return p.second; })->first;
    LooseLine line{{}, {}, source_ + ": a step of the thickness"};
    for (const int v : points[curve]) line.points.push_back(nearest(opposite, fine_.points[v]));
    model.loose.push_back(std::move(line));
  }
}

int OppositeSides::opposite_near(const Vec3& x) const {
  double least = std::numeric_limits<double>::max();
  int opposite = faces_[0];
  for (const int f : faces_)
    for (const Sample& s : samples_[f])
      if (const double d = norm(s.at - x); d < least && is_faced(f, s)) least = d, opposite = s.opposite;
  return opposite;
}

void OppositeSides::move_half_way(Mesh& mesh) const {
  const std::size_t n = mesh.triangles.size() + mesh.quads.size();
  std::vector<std::vector<int>> corners;
  for_each_element(mesh, [&](int, const auto& v) { corners.emplace_back(v.begin(), v.end()); });
  std::vector<int> opposite(n, -1);
  std::vector<std::vector<Vec3>> ways(n);
  parallel_each(n, [&](std::size_t e) {
    const std::vector<int>& v = corners[e];
    Vec3 middle, normal;
    for (std::size_t k = 0; k < v.size(); ++k) {
      middle = middle + (1.0 / static_cast<double>(v.size())) * mesh.points[v[k]];
      normal = normal + cross(mesh.points[v[k]], mesh.points[v[(k + 1) % v.size()]]);
    }
    if (norm(normal) > 0) {
      const Sample seen = look(middle, (inwards_ / norm(normal)) * normal, 0);
      if (seen.opposite >= 0 && side_[seen.opposite] >= 0 &&
          !std::ranges::binary_search(faces_, seen.opposite))
        opposite[e] = seen.opposite;
    }
    if (opposite[e] < 0) opposite[e] = opposite_near(middle);
    for (const int i : v) ways[e].push_back(nearest(opposite[e], mesh.points[i]) - mesh.points[i]);
  });
  std::vector<Ways> at(mesh.points.size());
  mesh.thickness.assign(n, 0);
  for (std::size_t e = 0; e < n; ++e)
    for (std::size_t k = 0; k < corners[e].size(); ++k) {
      at[corners[e][k]].add(ways[e][k]);
      mesh.thickness[e] += norm(ways[e][k]) / static_cast<double>(corners[e].size());
    }
  for (std::size_t i = 0; i < at.size(); ++i) mesh.points[i] = mesh.points[i] + 0.5 * at[i].shift();
}

}  // namespace delquad
