#include "features/extrusion/vertex_normals.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// Normals of which the products differ from 1 by less are one: what rounding makes of flat surfaces.
constexpr double kSameNormal = 1e-12;
/// Two planes fold back where the cosine between their normals is nearer to -1: dihedral angles below two
/// degrees, whose corners would move by more than 57 times the thickness.
constexpr double kFoldsBack = 6e-4;
/// Of the largest eigenvalue of sum n n^T: less is the noise of a smooth surface, whose normals differ by
/// less than about ten degrees.
constexpr double kLeastEigenvalue = 0.01;

struct CornerNormal {
  Vec3 normal;
  double angle;  ///< radians, of the corner
};

/// Of a quad at its corner k; of the quad where the corner is flat.
CornerNormal corner_normal(const Mesh& mesh, const std::array<int, 4>& quad, int k) {
  const Vec3& at = mesh.points[quad[k]];
  const Vec3 out = mesh.points[quad[(k + 1) % 4]] - at, in = mesh.points[quad[(k + 3) % 4]] - at;
  Vec3 normal = cross(out, in);
  const double angle = std::atan2(norm(normal), dot(out, in));
  constexpr double kFlat = 1e-9;  // of the product of the sides
  if (norm(normal) <= kFlat * norm(out) * norm(in))
    normal = cross(mesh.points[quad[2]] - mesh.points[quad[0]], mesh.points[quad[3]] - mesh.points[quad[1]]);
  const double length = norm(normal);
  if (!(length > 0)) throw InputError("a quad has no area: see its corner at " + show_point(at));
  return {(1 / length) * normal, angle};
}

Vec3 by_least_squares(const std::vector<CornerNormal>& normals) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& [n, weight] : normals) {
    const Eigen::Vector3d v(n.x, n.y, n.z);
    matrix += weight * v * v.transpose();
    right += weight * v;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (solver.eigenvalues()[k] > kLeastEigenvalue * solver.eigenvalues()[2])
      sum += solver.eigenvectors().col(k).dot(right) / solver.eigenvalues()[k] * solver.eigenvectors().col(k);
  return {sum[0], sum[1], sum[2]};
}

Vec3 offset_direction(const std::vector<CornerNormal>& all, const Vec3& at) {
  std::vector<CornerNormal> different;
  for (const CornerNormal& corner : all) {
    const auto same = std::find_if(different.begin(), different.end(), [&](const CornerNormal& other) {
      return norm(corner.normal - other.normal) < std::sqrt(2 * kSameNormal);
    });
    if (same == different.end())
      different.push_back(corner);
    else
      same->angle += corner.angle;
  }
  if (different.size() == 1) return different[0].normal;
  for (const CornerNormal& a : different)
    for (const CornerNormal& b : different)
      if (1 + dot(a.normal, b.normal) < kFoldsBack)
        throw InputError(
            fmt::format("the surface folds back on itself at {}, where it has no normal", show_point(at)));
  if (different.size() > 2) return by_least_squares(different);
  const Vec3 sum = different[0].normal + different[1].normal;
  return (2 / dot(sum, sum)) * sum;
}

/// Whether the quads at a point make one fan. `ends`: the neighbours of the point in each of them.
bool is_one_fan(std::vector<std::array<int, 2>> ends) {
  std::size_t joined = 1;  // quads that are known to hang together stand first
  for (std::size_t i = 0; i < joined; ++i)
    for (std::size_t j = joined; j < ends.size(); ++j)
      if (ends[i][0] == ends[j][1] || ends[i][1] == ends[j][0]) std::swap(ends[joined++], ends[j]);
  return joined == ends.size();
}

}  // namespace

std::vector<Vec3> offset_directions(const Section& section) {
  const Mesh& mesh = section.mesh;
  std::vector<std::vector<std::array<int, 2>>> corners(mesh.points.size());  // quad, corner
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (int k = 0; k < 4; ++k) corners[mesh.quads[q][k]].push_back({static_cast<int>(q), k});
  std::vector<Vec3> directions(mesh.points.size());
  parallel_ranges(mesh.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<CornerNormal> normals;
      std::vector<std::array<int, 2>> ends;
      for (const auto& [q, k] : corners[i]) {
        const std::array<int, 4>& quad = mesh.quads[q];
        normals.push_back(corner_normal(mesh, quad, k));
        ends.push_back({quad[(k + 1) % 4], quad[(k + 3) % 4]});
      }
      if (!is_one_fan(ends))
        throw InputError(fmt::format("quads touch at {} in a point only, which has no one normal",
                                     show_point(mesh.points[i])));
      directions[i] = offset_direction(normals, mesh.points[i]);
    }
  });
  return directions;
}

}  // namespace delquad
