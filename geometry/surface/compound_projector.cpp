// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound_projector.h"

#include <optional>

#include "geometry/mesh/nearest_triangle.h"

namespace delquad {

namespace {

/// Projects to the member face whose fine triangles are nearest, since surfaces continue beyond the edges of
/// faces.
class CompoundProjector final : public SurfaceProjector {
 public:
  CompoundProjector(std::shared_ptr<const SurfaceProjector> base, const Mesh& fine, const EntityGroups& faces,
                    EntityGroups curves)
      : base_(std::move(base)), members_(faces.size()), curves_(std::move(curves)) {
    std::vector<int> face_of(fine.regions.size());
    for (size_t face = 0; face < faces.size(); ++face) {
      for (const int member : faces[face]) face_of[member] = static_cast<int>(face);
      members_[face].only = faces[face].size() == 1 ? faces[face][0] : -1;
    }
    std::vector<std::vector<std::array<int, 3>>> triangles(faces.size());
    for (size_t t = 0; t < fine.triangles.size(); ++t) {
      Members& members = members_[face_of[fine.triangle_region[t]]];
      if (members.only >= 0) continue;
      triangles[face_of[fine.triangle_region[t]]].push_back(fine.triangles[t]);
      members.of_triangle.push_back(fine.triangle_region[t]);
    }
    for (size_t face = 0; face < faces.size(); ++face) {
      if (members_[face].only < 0) members_[face].triangles.emplace(fine.points, std::move(triangles[face]));
    }
  }

  Vec3 to_face(int face, const Vec3& x) const override { return base_->to_face(member_at(face, x), x); }
  PrincipalCurvatures curvatures(int face, const Vec3& x) const override {
    return base_->curvatures(member_at(face, x), x);
  }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    const std::vector<int>& members = curves_[curve];
    Vec3 best = base_->to_curve(members[0], x);
    for (size_t i = 1; i < members.size(); ++i) {
      const Vec3 other = base_->to_curve(members[i], x);
      if (norm(other - x) < norm(best - x)) best = other;
    }
    return best;
  }

 private:
  struct Members {
    int only = -1;  ///< the only face; -1: several
    std::optional<NearestTriangle> triangles;
    std::vector<int> of_triangle;  ///< face of each triangle
  };

  int member_at(int face, const Vec3& x) const {
    const Members& members = members_[face];
    return members.only >= 0 ? members.only : members.of_triangle[members.triangles->find(x).triangle];
  }

  std::shared_ptr<const SurfaceProjector> base_;
  std::vector<Members> members_;  // members of each face
  EntityGroups curves_;           // members of each curve
};

class CurvesOnFaces final : public SurfaceProjector {
 public:
  CurvesOnFaces(std::shared_ptr<const SurfaceProjector> base, int first_curve, std::vector<int> faces)
      : base_(std::move(base)), first_curve_(first_curve), faces_(std::move(faces)) {}
  Vec3 to_face(int face, const Vec3& x) const override { return base_->to_face(face, x); }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    return curve < first_curve_ ? base_->to_curve(curve, x) : to_face(faces_[curve - first_curve_], x);
  }
  PrincipalCurvatures curvatures(int face, const Vec3& x) const override {
    return base_->curvatures(face, x);
  }

 private:
  std::shared_ptr<const SurfaceProjector> base_;
  int first_curve_;
  std::vector<int> faces_;
};

}  // namespace

EntityGroups singleton_groups(std::size_t n) {
  EntityGroups groups;
  for (std::size_t i = 0; i < n; ++i) groups.push_back({static_cast<int>(i)});
  return groups;
}

std::shared_ptr<const SurfaceProjector> with_curves_on_faces(std::shared_ptr<const SurfaceProjector> base,
                                                             int first_curve, std::vector<int> faces) {
  return std::make_shared<CurvesOnFaces>(std::move(base), first_curve, std::move(faces));
}

void regroup(SurfaceModel& model, const Mesh& former, const EntityGroups& faces, EntityGroups curves) {
  const auto numbers = [](const EntityGroups& groups, std::size_t n) {
    std::vector<int> number(n, -1);
    for (std::size_t i = 0; i < groups.size(); ++i)
      for (const int member : groups[i]) number[member] = static_cast<int>(i);
    return number;
  };
  const std::vector<int> face_of = numbers(faces, former.regions.size()),
                         curve_of = numbers(curves, former.curves.size());
  for (EmbeddedCurve& e : model.embedded) e.face = face_of[e.face], e.curve = curve_of[e.curve];
  std::erase_if(model.embedded, [](const EmbeddedCurve& e) { return e.face < 0 || e.curve < 0; });
  if (model.projector)
    model.projector =
        std::make_shared<CompoundProjector>(std::move(model.projector), former, faces, std::move(curves));
}

}  // namespace delquad
