// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/model_curvature.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/box.h"
#include "base/parallel.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {

namespace {

/// Rounds of averaging normals with normals of the neighbors.
constexpr int kSmoothing = 2;
/// Sine of an angle below which a triangle is too thin to have a normal or a curvature.
constexpr double kThinRing = 1e-3;
/// Distance from a plane, over the extent of a face, within which it counts as plane.
constexpr double kFlatRing = 1e-9;

Vec3 unit(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3{};
}

/// A face with own points.
struct FacePiece {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
};

std::vector<FacePiece> pieces_of(const Mesh& fine) {
  std::vector<FacePiece> pieces(fine.regions.size());
  std::vector<std::map<int, int>> index(fine.regions.size());
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    FacePiece& piece = pieces[fine.triangle_region[t]];
    std::array<int, 3> own;
    for (int k = 0; k < 3; ++k) {
      const int v = fine.triangles[t][k];
      const auto [at, fresh] =
          index[fine.triangle_region[t]].try_emplace(v, static_cast<int>(piece.points.size()));
      if (fresh) piece.points.push_back(fine.points[v]);
      own[k] = at->second;
    }
    piece.triangles.push_back(own);
  }
  return pieces;
}

/// Second fundamental forms of a piece's triangles and points, as tensors of space.
class FormEstimate {
 public:
  explicit FormEstimate(const FacePiece& piece) : piece_(piece), is_inner_(piece.points.size(), 0) {
    find_normals();
    for (int round = 0; round < kSmoothing; ++round) smooth_normals();
  }

  /// Returns at each point the mean of the forms around, weighted by angles.
  std::vector<Eigen::Matrix3d> forms() const {
    std::vector<Eigen::Matrix3d> sum(piece_.points.size(), Eigen::Matrix3d::Zero());
    std::vector<double> weight(piece_.points.size(), 0);
    for (const auto& v : piece_.triangles) {
      const auto form = form_of(v);
      if (!form) continue;
      for (int k = 0; k < 3; ++k) {
        const double angle = corner_angle(v, k);
        sum[v[k]] += angle * *form;
        weight[v[k]] += angle;
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (weight[i] > 0) sum[i] /= weight[i];
    return sum;
  }

 private:
  const Vec3& point(int v) const { return piece_.points[v]; }

  double corner_angle(const std::array<int, 3>& v, int k) const {
    return angle_between(point(v[(k + 1) % 3]) - point(v[k]), point(v[(k + 2) % 3]) - point(v[k]));
  }

  void find_normals() {
    normals_.assign(piece_.points.size(), {});
    std::map<std::pair<int, int>, int> sides;
    for (const auto& v : piece_.triangles) {
      const Vec3 n = unit(area_vector(piece_.points, v));
      for (int k = 0; k < 3; ++k) {
        normals_[v[k]] = normals_[v[k]] + corner_angle(v, k) * n;
        ++sides[std::minmax(v[k], v[(k + 1) % 3])];
      }
    }
    for (Vec3& n : normals_) n = unit(n);
    is_inner_.assign(piece_.points.size(), 1);
    for (const auto& [side, count] : sides)
      if (count != 2) is_inner_[side.first] = is_inner_[side.second] = 0;
  }

  /// Smooths normals by the inverse square of distances to neighbors. At the outline, with neighbors on one
  /// side only, normals stay.
  void smooth_normals() {
    std::vector<Vec3> sum(normals_.size());
    std::vector<double> weight(normals_.size(), 0);
    for (const auto& v : piece_.triangles) {
      for (int k = 0; k < 3; ++k) {
        const int a = v[k], b = v[(k + 1) % 3];
        const Vec3 d = point(b) - point(a);
        if (!(dot(d, d) > 0)) continue;
        const double w = 1 / dot(d, d);
        sum[a] = sum[a] + w * normals_[b];
        sum[b] = sum[b] + w * normals_[a];
        weight[a] += w;
        weight[b] += w;
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (is_inner_[i] && weight[i] > 0) normals_[i] = unit(normals_[i] + (1 / weight[i]) * sum[i]);
  }

  /// Returns the symmetric form that fits the change of the normal along the sides best.
  std::optional<Eigen::Matrix3d> form_of(const std::array<int, 3>& v) const {
    const Vec3 x = unit(point(v[1]) - point(v[0]));
    const Vec3 area = area_vector(piece_.points, v);
    const Vec3 y = unit(cross(area, x));
    Eigen::Matrix<double, 6, 3> rows = Eigen::Matrix<double, 6, 3>::Zero();
    Eigen::Matrix<double, 6, 1> change;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3];
      const Vec3 d = point(b) - point(a), dn = normals_[b] - normals_[a];
      longest = std::max(longest, norm(d));
      const double dx = dot(d, x), dy = dot(d, y);
      rows(2 * k, 0) = dx, rows(2 * k, 1) = dy;
      rows(2 * k + 1, 1) = dx, rows(2 * k + 1, 2) = dy;
      change(2 * k) = dot(dn, x), change(2 * k + 1) = dot(dn, y);
    }
    if (!(norm(area) > kThinRing * longest * longest)) return std::nullopt;
    const Eigen::Vector3d form = rows.colPivHouseholderQr().solve(change);
    const Eigen::Vector3d ex(x.x, x.y, x.z), ey(y.x, y.y, y.z);
    return form(0) * ex * ex.transpose() + form(1) * (ex * ey.transpose() + ey * ex.transpose()) +
           form(2) * ey * ey.transpose();
  }

  const FacePiece& piece_;
  std::vector<Vec3> normals_;
  std::vector<char> is_inner_;
};

bool is_plane(const FacePiece& piece) {
  Vec3 sum;
  for (const auto& v : piece.triangles) sum = sum + area_vector(piece.points, v);
  const Vec3 normal = unit(sum);
  const double tolerance = kFlatRing * diagonal(piece.points);
  return dot(normal, normal) > 0 && std::ranges::all_of(piece.points, [&](const Vec3& p) {
           return std::abs(dot(p - piece.points[0], normal)) <= tolerance;
         });
}

/// Returns 1 / radius of the circle through three points.
double circle_curvature(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double product = norm(b - a) * norm(c - b) * norm(a - c);
  return product > 0 ? 2 * norm(cross(b - a, c - a)) / product : 0;
}

/// Returns the curvature at each point of a chain; ends of an open chain take it from their neighbors.
std::vector<double> chain_curvatures(const std::vector<Vec3>& points, bool closed) {
  const int n = static_cast<int>(points.size());
  std::vector<double> values(points.size(), 0);
  for (int i = 1; i + 1 < n; ++i) values[i] = circle_curvature(points[i - 1], points[i], points[i + 1]);
  if (n < 3) return values;
  if (closed) {
    values[0] = values[n - 1] = circle_curvature(points[n - 2], points[0], points[1]);
  } else {
    values[0] = values[1];
    values[n - 1] = values[n - 2];
  }
  return values;
}

}  // namespace

ModelCurvature::ModelCurvature(const SurfaceModel& model) : projector_(model.projector) {
  if (!projector_) estimate_faces(model.fine);
  measure_curves(model.fine);
}

void ModelCurvature::estimate_faces(const Mesh& fine) {
  std::vector<FacePiece> pieces = pieces_of(fine);
  faces_.resize(pieces.size());
  parallel_for(
      pieces.size(),
      [&](std::size_t f) {
        if (pieces[f].triangles.empty() || is_plane(pieces[f])) return;
        std::vector<double> values;
        std::vector<Tensor3> forms;
        for (const Eigen::Matrix3d& m : FormEstimate(pieces[f]).forms()) {
          const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m, Eigen::EigenvaluesOnly);
          values.push_back(solver.eigenvalues().cwiseAbs().maxCoeff());
          forms.push_back({m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)});
        }
        faces_[f] = Sampled{NearestTriangle(std::move(pieces[f].points), std::move(pieces[f].triangles)),
                            std::move(values), std::move(forms)};
      },
      [&](std::size_t f) { return static_cast<double>(pieces[f].triangles.size()); });
}

void ModelCurvature::measure_curves(const Mesh& fine) {
  for (const std::vector<int>& chain : points_of_curves(fine)) {
    curves_.emplace_back();
    if (chain.size() < 3) continue;  // straight
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> lines;
    for (const int v : chain) points.push_back(fine.points[v]);
    for (int i = 0; i + 1 < static_cast<int>(chain.size()); ++i) lines.push_back({i, i + 1, i + 1});
    std::vector<double> values = chain_curvatures(points, chain.front() == chain.back());
    curves_.back() = Sampled{NearestTriangle(std::move(points), std::move(lines)), std::move(values)};
  }
}

double ModelCurvature::Sampled::at(const Vec3& x) const {
  const NearestTriangle::Found found = triangles.find(x);
  double value = 0;
  for (int k = 0; k < 3; ++k) value += found.weights[k] * values[triangles.triangle(found.triangle)[k]];
  return value;
}

double ModelCurvature::of_face(int face, const Vec3& x) const {
  if (!projector_) return faces_[face] ? faces_[face]->at(x) : 0;
  const double curvature = projector_->face_curvature(face, x);
  return std::isnan(curvature) ? 0 : curvature;  // unknown at singular points, where the surroundings count
}

PrincipalCurvatures ModelCurvature::principal(int face, const Vec3& x) const {
  constexpr PrincipalCurvatures kPlane{0, 0, {}};
  if (projector_) {
    const PrincipalCurvatures found = projector_->curvatures(face, x);
    return std::isfinite(found.most) ? found : kPlane;
  }
  if (!faces_[face]) return kPlane;
  const auto& [triangles, values, forms] = *faces_[face];
  const NearestTriangle::Found found = triangles.find(x);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Tensor3& m = forms[triangles.triangle(found.triangle)[k]];
    Eigen::Matrix3d form;
    form << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
    sum += found.weights[k] * form;
  }
  // The eigenvalue with the least absolute value belongs to the normal.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  const Eigen::Vector3d& value = solver.eigenvalues();
  const int most = std::abs(value[0]) > std::abs(value[2]) ? 0 : 2;
  const double least = std::abs(value[1]) > std::abs(value[2 - most]) ? value[1] : value[2 - most];
  const Eigen::Vector3d along = solver.eigenvectors().col(most);
  return {value[most], least, {along[0], along[1], along[2]}};
}

double ModelCurvature::of_curve(int curve, const Vec3& x) const {
  const bool known = curve < static_cast<int>(curves_.size()) && curves_[curve];
  return known ? curves_[curve]->at(x) : 0;
}

}  // namespace delquad
