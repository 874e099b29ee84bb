// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"

// This header searches distances to meshes and normals of faces. Comparison of surfaces and repairs use it.

namespace delquad {

/// Distance search among the elements of a mesh; each quad is four triangles around its center.
class NearestElement {
 public:
  explicit NearestElement(const Mesh& mesh) : mesh_(mesh) {
    for_each_element(mesh, [&](int, const auto& v) {
      auto& box = boxes_.emplace_back(Box<Vec3>::around({mesh.points[v[0]]}));
      for (const int i : v) box.add(mesh.points[i]);
    });
    tree_ = BoxTree<Vec3>(boxes_);
  }

  /// Returns the distance to the nearest element; infinite if none is within `reach`. Both are lengths.
  double distance(const Vec3& x, double reach) const {
    double best2 = reach * reach;
    bool found = false;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const auto w = nearest_weights(a, b, c, x);
      const Vec3 d = w[0] * a + w[1] * b + w[2] * c - x;
      if (dot(d, d) > best2) return;
      best2 = dot(d, d);
      found = true;
    };
    const int n_triangles = static_cast<int>(mesh_.triangles.size());
    tree_.nearest(x, best2, [&](int element) {
      if (boxes_[element].distance2(x) > best2) return;
      const auto& p = mesh_.points;
      if (element < n_triangles) {
        const auto& [a, b, c] = mesh_.triangles[element];
        return add(p[a], p[b], p[c]);
      }
      const auto& v = mesh_.quads[element - n_triangles];
      const Vec3 centre = 0.25 * (p[v[0]] + p[v[1]] + p[v[2]] + p[v[3]]);
      for (int k = 0; k < 4; ++k) add(p[v[k]], p[v[(k + 1) % 4]], centre);
    });
    return found ? std::sqrt(best2) : std::numeric_limits<double>::infinity();
  }

 private:
  const Mesh& mesh_;
  std::vector<Box<Vec3>> boxes_;
  BoxTree<Vec3> tree_;
};

/// Normals of the faces of a model.
class FaceNormals {
 public:
  explicit FaceNormals(const Mesh& fine) : fine_(fine) {
    const auto& p = fine.points;
    for (const auto& [a, b, c] : fine.triangles) boxes_.push_back(Box<Vec3>::around({p[a], p[b], p[c]}));
    tree_ = BoxTree<Vec3>(boxes_);
  }

  /// Returns whether the place's face has triangles within `reach`, and `normal` points away from the sides
  /// of all. On a sharper bend, some look the same way.
  bool all_point_away(const Place& place, const Vec3& normal, double reach) const {
    double limit2 = reach * reach;
    bool some = false, same_way = false;
    tree_.nearest(place.at, limit2, [&](int t) {
      if (fine_.triangle_region[t] != place.face || boxes_[t].distance2(place.at) > limit2) return;
      const auto& [a, b, c] = fine_.triangles[t];
      const Vec3 &p = fine_.points[a], &q = fine_.points[b], &r = fine_.points[c];
      const auto w = nearest_weights(p, q, r, place.at);
      const Vec3 d = w[0] * p + w[1] * q + w[2] * r - place.at;
      if (dot(d, d) > limit2) return;
      some = true;
      if (!(dot(cross(q - p, r - p), normal) > 0)) return;
      same_way = true;
      limit2 = -1;  // one is enough
    });
    return some && !same_way;
  }

 private:
  const Mesh& fine_;
  std::vector<Box<Vec3>> boxes_;
  BoxTree<Vec3> tree_;
};

}  // namespace delquad
