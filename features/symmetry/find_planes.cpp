// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/mirror_match.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/cancel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {
namespace {

/// So many normals are tried at most.
constexpr std::size_t kMostNormals = 256;
/// Normals whose cosine is nearer to 1 than this are the same.
constexpr double kSame = 1e-9;
/// Images that differ by less, in parts of the diagonal, fit as well.
constexpr double kExact = 1e-7;
/// Moments that differ by less, of the largest, leave their axes open.
constexpr double kSameMoment = 1e-2;

/// Area, centroid and second moments about it.
struct Moments {
  double area = 0;
  Vec3 centroid;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Moments moments_of(const Mesh& mesh) {
  Moments m;
  const auto each = [&](const auto& add) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c];
      add(p, q, r, norm(cross(q - p, r - p)) / 2);
    }
  };
  each([&](const Vec3& p, const Vec3& q, const Vec3& r, double area) {
    m.area += area;
    m.centroid = m.centroid + (area / 3) * (p + q + r);
  });
  m.centroid = (1 / m.area) * m.centroid;
  each([&](const Vec3& p, const Vec3& q, const Vec3& r, double area) {
    // Exact for quadratics: the middles of the sides.
    for (const Vec3& x : {0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)}) {
      const Vec3 d = x - m.centroid;
      const Eigen::Vector3d e(d.x, d.y, d.z);
      m.second += area / 3 * e * e.transpose();
    }
  });
  return m;
}

/// Unit vectors, each once up to its sign.
class Normals {
 public:
  void add(const Vec3& n) {
    if (!(norm(n) > 0) || all.size() >= kMostNormals) return;
    Vec3 unit = (1 / norm(n)) * n;
    const double largest = std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)});
    for (double* x : {&unit.x, &unit.y, &unit.z})
      if (std::abs(*x) < 1e-14 * largest) *x = 0;
    if (std::ranges::none_of(all, [&](const Vec3& o) { return std::abs(dot(o, unit)) > 1 - kSame; }))
      all.push_back(unit);
  }
  std::vector<Vec3> all;
};

/// Places that a plane may go through: the centroids of faces, the ends and middles of curves.
std::vector<Vec3> marks_of(const SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  std::vector<Vec3> sum(mesh.regions.size());
  std::vector<double> area(mesh.regions.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c];
    const double own = norm(cross(q - p, r - p)) / 2;
    sum[mesh.triangle_region[t]] = sum[mesh.triangle_region[t]] + (own / 3) * (p + q + r);
    area[mesh.triangle_region[t]] += own;
  }
  std::vector<Vec3> marks;
  for (std::size_t f = 0; f < sum.size(); ++f)
    if (area[f] > 0) marks.push_back((1 / area[f]) * sum[f]);
  for (const int p : model.corners) marks.push_back(mesh.points[p]);
  for (std::size_t begin = 0; begin < mesh.lines.size();) {
    std::size_t end = begin;
    while (end < mesh.lines.size() && mesh.line_curve[end] == mesh.line_curve[begin]) ++end;
    marks.push_back(mesh.points[mesh.lines[begin + (end - begin) / 2][0]]);
    begin = end;
  }
  return marks;
}

/// Normals perpendicular to the planes found so far, likely ones first.
std::vector<Vec3> candidate_normals(const SurfaceModel& model, const Moments& moments,
                                    const std::vector<SymmetryPlane>& found) {
  constexpr double kRight = 1e-6;
  Normals normals;
  if (found.size() == 2) {
    normals.add(cross(found[0].normal, found[1].normal));
    return normals.all;
  }
  const auto add = [&](Vec3 n) {
    if (!found.empty()) {
      const double along = dot(n, found[0].normal);
      if (norm(n - along * found[0].normal) < kRight * norm(n)) return;
      n = n - along * found[0].normal;
    }
    normals.add(n);
  };
  const std::vector<Vec3> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3& n : axes) add(n);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.second);
  const Eigen::Matrix3d vectors = solver.eigenvectors();
  const Eigen::Vector3d values = solver.eigenvalues();
  const auto axis = [&](int k) { return Vec3{vectors(0, k), vectors(1, k), vectors(2, k)}; };
  const auto same = [&](int i, int j) { return std::abs(values[i] - values[j]) < kSameMoment * values[2]; };
  for (int k = 0; k < 3; ++k) add(axis(k));
  if (!same(0, 1) && !same(1, 2)) return normals.all;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j)
      for (const double sign : {1.0, -1.0}) add(axes[i] + sign * axes[j]);
  // About the axis of a body that turns, or all ways.
  const bool turns = same(0, 1) != same(1, 2);
  const Vec3 about = same(0, 1) ? axis(2) : axis(0);
  for (const Vec3& mark : marks_of(model)) {
    Vec3 to = mark - moments.centroid;
    if (turns) to = to - dot(to, about) * about;
    if (norm(to) < kRight * diagonal(model.fine)) continue;
    if (turns) add(cross(to, about));
    add(to);
  }
  return normals.all;
}

class PlaneFinder {
 public:
  /// `known`: planes to which others are perpendicular.
  PlaneFinder(const SurfaceModel& model, const MirrorMatcher& matcher, std::vector<SymmetryPlane> known)
      : model_(model), matcher_(matcher), moments_(moments_of(model.fine)), found_(std::move(known)) {}

  std::vector<SymmetryPlane> run() {
    constexpr std::size_t kMost = 3;
    const std::size_t n_known = found_.size();
    while (found_.size() < kMost) {
      const std::size_t before = found_.size();
      near_miss_.clear();
      for (const Vec3& normal : candidate_normals(model_, moments_, found_))
        if (const auto plane = try_normal(normal)) {
          found_.push_back(*plane);
          break;
        }
      if (found_.size() == before) break;
    }
    return {found_.begin() + static_cast<std::ptrdiff_t>(n_known), found_.end()};
  }

  /// A plane that would be one more, and the embedded item without an image; or empty.
  const std::string& near_miss() const { return near_miss_; }

 private:
  std::optional<SymmetryPlane> try_normal(const Vec3& normal) {
    double low = dot(model_.fine.points[0], normal), high = low;
    for (const Vec3& p : model_.fine.points) {
      low = std::min(low, dot(p, normal));
      high = std::max(high, dot(p, normal));
    }
    // Round numbers come first, and are kept where they fit as well.
    const double centre = dot(moments_.centroid, normal), middle = (low + high) / 2;
    const auto at = [&](double offset) {
      return SymmetryPlane{moments_.centroid + (offset - centre) * normal, normal};
    };
    SymmetryPlane better = at(centre);
    if (!matcher_.can_match(SymmetryPlanes({better}), 0)) better = at(middle);
    if (!matcher_.can_match(SymmetryPlanes({better}), 0)) return std::nullopt;
    check_cancelled();
    better = matcher_.adjusted(better);
    for (const SymmetryPlane& other : found_)
      better.normal = better.normal - dot(better.normal, other.normal) * other.normal;
    std::vector<SymmetryPlane> tried;
    constexpr double kNearOrigin = 1e-2;
    if (std::min(std::abs(centre), std::abs(middle)) <= kNearOrigin * (high - low)) tried.push_back(at(0));
    tried.insert(tried.end(), {at(middle), at(centre), at(dot(better.point, normal)), better});
    std::vector<double> misfits;
    for (const SymmetryPlane& plane : tried) misfits.push_back(matcher_.misfit(plane));
    constexpr double kAsWell = 1.01;
    const double most = kAsWell * std::ranges::min(misfits) + kExact * diagonal(model_.fine);
    for (std::size_t i = 0; i < tried.size(); ++i)
      if (misfits[i] <= most && is_good(tried[i])) return tried[i];
    return std::nullopt;
  }

  bool is_good(const SymmetryPlane& plane) {
    const MirrorMatch match = matcher_.match(SymmetryPlanes({plane}), 0);
    if (match.by_embedded && near_miss_.empty())
      near_miss_ = fmt::format("the plane through {} with the normal {} would be one, but {}",
                               show_point(plane.point), show_point(plane.normal), match.failure);
    return match.failure.empty();
  }

  const SurfaceModel& model_;
  const MirrorMatcher& matcher_;
  Moments moments_;
  std::vector<SymmetryPlane> found_;
  std::string near_miss_;
};

}  // namespace

FoundPlanes find_symmetry_planes(const SymmetrySpec& spec, const SurfaceModel& model, bool is_flat,
                                 std::vector<Warning>& warnings) {
  const MirrorMatcher matcher(model, is_flat ? kTouch : kSymmetric);
  FoundPlanes found{spec.planes, {}};
  if (spec.automatic) {
    PlaneFinder finder(model, matcher,
                       is_flat ? std::vector<SymmetryPlane>{{{}, {0, 0, 1}}} : std::vector<SymmetryPlane>{});
    found.planes = finder.run();
    std::string said =
        found.planes.empty() ? "no plane of symmetry was found: all of the model is meshed" : "";
    if (!finder.near_miss().empty()) said += (said.empty() ? "" : "; ") + finder.near_miss();
    if (!said.empty()) warnings.emplace_back(spec.where + ": " + said);
  }
  const SymmetryPlanes planes = given_planes(found.planes, spec.where);
  for (int k = 0; k < planes.count(); ++k) {
    found.matches.push_back(matcher.match(planes, k));
    if (const std::string& failure = found.matches.back().failure; !failure.empty())
      throw InputError(fmt::format(
          "{}: the model is not symmetric at the plane through {} with the normal {}: {} [not-symmetric]",
          spec.where, show_point(found.planes[k].point), show_point(found.planes[k].normal), failure));
  }
  return found;
}

}  // namespace delquad
