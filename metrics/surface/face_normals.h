#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {

/// Which way the faces of a model look.
class FaceNormals {
 public:
  explicit FaceNormals(const Mesh& fine) : fine_(fine) {
    const auto& p = fine.points;
    for (const auto& [a, b, c] : fine.triangles) boxes_.push_back(Box<Vec3>::around({p[a], p[b], p[c]}));
    tree_ = BoxTree<Vec3>(boxes_);
  }

  /// Whether `normal` points away from the sides of all triangles of the place's face within `reach`, and
  /// there is one: on a bend sharper than that, some look the same way.
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
      limit2 = -1;  // enough
    });
    return some && !same_way;
  }

 private:
  const Mesh& fine_;
  std::vector<Box<Vec3>> boxes_;
  BoxTree<Vec3> tree_;
};

}  // namespace delquad
