// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extrusion/layers.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/box.h"
#include "base/cancel.h"
#include "base/nearest_name.h"
#include "base/parallel.h"
#include "base/parallel_each.h"
#include "base/predicates.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/entity_names.h"

namespace delquad {

namespace {

/// Part of the section's diagonal, and of its distance from the axis' point, below which a point lies on the
/// axis: some thousand steps of a double.
constexpr double kOnAxis = 1e-12;

/// How the corners of a quad go round the origin: 0 where it lies outside.
int winding(const std::array<Vec2, 4>& corners) {
  int turns = 0;
  for (int k = 0; k < 4; ++k) {
    const Vec2 a = corners[k], b = corners[(k + 1) % 4];
    const bool a_above = a.y > 0, b_above = b.y > 0;
    if (a_above == b_above) continue;
    const int side = orient2d(a, b, {0, 0});
    if (b_above && side > 0) ++turns;
    if (a_above && side < 0) --turns;
  }
  return turns;
}

/// Throws InputError with the place where a quad touches or crosses the line through a point.
void require_beside_axis(const Section& section, const Vec3& point, const Vec3& axis) {
  const Vec3 along = (1 / norm(axis)) * axis;
  const Vec3 u = unit_across(along), v = cross(along, u);
  const std::vector<Vec3>& points = section.mesh.points;
  std::vector<Vec2> seen;  // along the axis
  double reach = diagonal(section.mesh);
  for (const Vec3& p : points) {
    seen.push_back({dot(p - point, u), dot(p - point, v)});
    reach = std::max(reach, norm(p - point));
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (norm(seen[i]) <= kOnAxis * reach)
      throw InputError(
          fmt::format("the node at {} lies on the axis, where hexahedra would have no sides: leave a hole "
                      "around the axis [sweep-at-the-axis]",
                      show_point(points[i])));
  for (const auto& quad : section.mesh.quads) {
    std::array<Vec2, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = seen[quad[k]];
    for (int k = 0; k < 4; ++k)
      if (distance_to_segment(Vec2{}, corners[k], corners[(k + 1) % 4]) <= kOnAxis * reach)
        throw InputError(fmt::format("the section crosses its axis between {} and {} [sweep-at-the-axis]",
                                     show_point(points[quad[k]]), show_point(points[quad[(k + 1) % 4]])));
    if (winding(corners) != 0)
      throw InputError(
          fmt::format("the axis goes through the quad at {}: expected an axis beside the section",
                      show_point(points[quad[0]])));
  }
}

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require_layers(const Section& section, const SweepLayers& layers, long long number) {
  if (number < 1) throw InputError(fmt::format("{} layers: expected at least 1", number));
  const auto n_quads = static_cast<long long>(section.mesh.quads.size());
  const auto n_points = static_cast<long long>(section.mesh.points.size());
  if (number > layers.max_elements / n_quads)
    throw InputError(fmt::format(
        "{} layers of {} quads are more than {} hexahedra: expected fewer layers, or a larger --max-elements",
        number, n_quads, layers.max_elements));
  if ((number + 1) * n_points > std::numeric_limits<int>::max())
    throw InputError(
        fmt::format("{} layers of {} points are more points than can be numbered: expected fewer layers",
                    number, n_points));
}

/// Fills in the points of `result`. `place_of`: a point's place in a layer of nodes.
template <class PlaceOf>
LayeredPoints make_points(const Section& section, LayeredPoints result, const PlaceOf& place_of) {
  const std::vector<Vec3>& from = section.mesh.points;
  const std::size_t n = from.size();
  const std::size_t n_levels = static_cast<std::size_t>(result.n_layers) + (result.is_closed ? 0 : 1);
  result.points.resize(n * n_levels);
  parallel_for(n_levels, [&](std::size_t level) {
    check_cancelled();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 p = place_of(i, level);
      if (!is_finite(p))
        throw InputError(fmt::format("the point at {} would go beyond all numbers", show_point(from[i])));
      result.points[level * n + i] = p;
    }
  });
  return result;
}

/// Returns the height of each region, which is `length` if none is given.
std::vector<double> heights_of_regions(const std::vector<Entity>& regions, const SweepLayers& layers,
                                       double length) {
  const std::vector<std::string> usual = group_names(regions, 2);
  std::vector<double> heights(regions.size(), length);
  for (const auto& [name, height] : layers.heights) {
    if (!(height > 0) || !std::isfinite(height))
      throw InputError(fmt::format("a height of {} for '{}': expected a finite length > 0", height, name));
    bool is_known = false;
    for (std::size_t r = 0; r < regions.size(); ++r)
      if (usual[r] == name || std::ranges::find(regions[r].names, name) != regions[r].names.end())
        heights[r] = height, is_known = true;
    if (!is_known)
      throw InputError(
          fmt::format("no region has the name '{}' of a height{}", name, suggestion_or_all(name, usual)));
  }
  return heights;
}

/// Heights above the section by layer of nodes, and the number of layers of each region.
struct LayerPlan {
  std::vector<double> ends;
  std::vector<int> layers_of;  ///< empty: all
};

/// For each height the nearest layer ends there; layers between two heights keep their proportions.
LayerPlan plan_layers(const Section& section, const SweepLayers& layers, double length) {
  std::vector<double> ends = layer_ends(layers.number, layers.growth);
  if (layers.heights.empty()) {
    for (double& end : ends) end *= length;
    return {std::move(ends), {}};
  }
  const std::vector<double> of_region = heights_of_regions(section.mesh.regions, layers, length);
  std::vector<double> heights;
  for (const int region : section.mesh.quad_region) heights.push_back(of_region[region]);
  sort_unique(heights);
  const std::size_t n = heights.size(), number = ends.size() - 1;
  if (number < n)
    throw InputError(fmt::format("{} layers are too few for {} heights: expected at least {}", number, n, n));
  LayerPlan plan{{0}, std::vector<int>(of_region.size(), 0)};
  std::size_t first = 0;  // layer of nodes at the previous height
  for (std::size_t h = 0; h < n; ++h) {
    std::size_t last = first + 1;
    const auto error = [&](std::size_t k) { return std::abs(ends[k] * heights.back() - heights[h]); };
    while (last < number - (n - 1 - h) && error(last + 1) <= error(last)) ++last;
    if (h + 1 == n) last = number;
    const double from = plan.ends[first], part = (heights[h] - from) / (ends[last] - ends[first]);
    for (std::size_t k = first + 1; k < last; ++k) plan.ends.push_back(from + (ends[k] - ends[first]) * part);
    plan.ends.push_back(heights[h]);
    for (std::size_t r = 0; r < of_region.size(); ++r)
      if (of_region[r] == heights[h]) plan.layers_of[r] = static_cast<int>(last);
    first = last;
  }
  return plan;
}

void require_no_heights(const SweepLayers& layers) {
  if (!layers.heights.empty())
    throw InputError("heights go along a vector, or along normals to one side: expected none here");
}

LayeredPoints along(const Section& section, const AlongVector& path, const SweepLayers& layers) {
  if (!is_finite(path.shift) || !(norm(path.shift) > 0))
    throw InputError(
        fmt::format("the vector {}: expected finite numbers that are not all 0", show_point(path.shift)));
  require_layers(section, layers, layers.number);
  const double length = layers.heights.empty() ? 1 : norm(path.shift);
  const LayerPlan plan = plan_layers(section, layers, length);
  return make_points(section, {{}, layers.number, false, true, plan.layers_of},
                     [&](std::size_t i, std::size_t level) {
                       return section.mesh.points[i] + plan.ends[level] / length * path.shift;
                     });
}

LayeredPoints along(const Section& section, const AroundAxis& path, const SweepLayers& layers) {
  constexpr double kFull = 360, kFewest = 3;
  const double angle = std::abs(path.degrees);
  if (!(angle > 0) || angle > kFull)
    throw InputError(fmt::format("an angle of {} degrees: expected at most 360, and not 0", path.degrees));
  if (!is_finite(path.point) || !is_finite(path.axis) || !(norm(path.axis) > 0))
    throw InputError(
        fmt::format("the axis through {} along {}: expected finite numbers, and a direction that is not 0",
                    show_point(path.point), show_point(path.axis)));
  require_layers(section, layers, layers.number);
  require_no_heights(layers);
  const bool is_closed = angle == kFull;
  if (is_closed && layers.number < kFewest)
    throw InputError(fmt::format("{} layers around an axis: expected at least {}", layers.number, kFewest));
  require_beside_axis(section, path.point, path.axis);
  const std::vector<double> ends = layer_ends(layers.number, layers.growth);
  for (std::size_t k = 1; k < ends.size(); ++k)
    if (constexpr double kHalf = 180; (ends[k] - ends[k - 1]) * angle >= kHalf)
      throw InputError(fmt::format("layer {} would turn by {:.6g} degrees: expected less than 180", k,
                                   (ends[k] - ends[k - 1]) * angle));
  std::vector<Motion> turns;
  for (const double end : ends)
    turns.push_back({{}, end * path.degrees * std::numbers::pi / 180, path.point, path.axis});
  return make_points(section, {{}, layers.number, is_closed, false}, [&](std::size_t i, std::size_t level) {
    return level == 0 ? section.mesh.points[i] : turns[level](section.mesh.points[i]);
  });
}

LayeredPoints along(const Section& section, const AlongCurve& path, const SweepLayers& layers) {
  require_no_heights(layers);
  std::vector<Vec3> line = path.points;
  for (const Vec3& p : line)
    if (!is_finite(p))
      throw InputError("the curve has a point that is not finite: expected finite coordinates");
  if (layers.number == 0 && layers.growth != 1)
    throw InputError(
        "growth along a curve needs a number of layers: without one they end at the curve's points");
  check_open_line(line);
  if (layers.number != 0) {
    require_layers(section, layers, layers.number);
    line = points_at_lengths(line, layer_ends(layers.number, layers.growth));
  }
  require_layers(section, layers, static_cast<long long>(line.size()) - 1);
  const int n_layers = static_cast<int>(line.size()) - 1;
  const MovingSection moving(std::move(line));
  return make_points(section, {{}, n_layers, false, false}, [&](std::size_t i, std::size_t level) {
    const Vec3& p = section.mesh.points[i];
    return level == 0 ? p : moving.place(p, level);
  });
}

LayeredPoints along(const Section& section, const AlongNormals& path, const SweepLayers& layers) {
  if (!std::isfinite(path.thickness) || path.thickness == 0)
    throw InputError(
        fmt::format("a thickness of {}: expected a finite number that is not 0", path.thickness));
  require_layers(section, layers, layers.number);
  if (path.both_sides) require_no_heights(layers);
  // At joints parts run in different directions.
  const bool is_signed = layers.heights.empty() && section.joints.empty();
  const double length = is_signed ? path.thickness : std::abs(path.thickness);
  LayerPlan plan = plan_layers(section, layers, length);
  const double sign = layers.heights.empty() ? 1 : std::copysign(1, path.thickness);
  const std::vector<Vec3> directions = offset_directions(section);
  const double start = path.both_sides ? -0.5 * length : 0;
  LayeredPoints result{{}, layers.number, false, true, std::move(plan.layers_of)};
  if (path.both_sides) result.thickness = length, result.shares = layer_ends(layers.number, layers.growth);
  return make_points(section, std::move(result), [&](std::size_t i, std::size_t level) {
    return section.mesh.points[i] + sign * (start + plan.ends[level]) * directions[i];
  });
}

}  // namespace

std::vector<double> layer_ends(int number, double growth) {
  if (!(growth > 0) || !std::isfinite(growth))
    throw InputError(fmt::format("a growth of {}: expected a finite number > 0", growth));
  std::vector<double> ends(static_cast<std::size_t>(number) + 1, 0);
  // From the thinner end, where sums lose nothing.
  const bool shrinks = growth < 1;
  const double factor = shrinks ? 1 / growth : growth;
  double height = 1;
  for (int k = 1; k <= number; ++k, height *= factor) ends[k] = ends[k - 1] + height;
  const double total = ends[number];
  for (double& end : ends) end /= total;
  if (shrinks) {
    std::reverse(ends.begin(), ends.end());
    for (double& end : ends) end = 1 - end;
  }
  ends[0] = 0;
  ends[number] = 1;
  for (int k = 1; k <= number; ++k)
    if (!(ends[k] > ends[k - 1]))
      throw InputError(
          fmt::format("a growth of {} makes some of {} layers thinner than numbers can tell: expected a "
                      "growth nearer to 1",
                      growth, number));
  return ends;
}

LayeredPoints place_layers(const Section& section, const SweepPath& path, const SweepLayers& layers) {
  return std::visit([&](const auto& kind) { return along(section, kind, layers); }, path);
}

namespace {

/// Normals of which the products differ from 1 by less are one: what rounding makes of flat surfaces.
constexpr double kSameNormal = 1e-12;
/// Two planes fold back where the cosine between their normals is nearer to -1. These are dihedral angles
/// below two degrees, whose corners would move by more than 57 times the thickness.
constexpr double kFoldsBack = 6e-4;
/// Part of the largest eigenvalue of sum n n^T. Smaller eigenvalues are noise of a smooth surface, whose
/// normals differ by less than about ten degrees.
constexpr double kLeastEigenvalue = 0.01;

struct CornerNormal {
  Vec3 normal;
  double angle;  ///< radians, of the corner
};

/// Returns the normal of a quad at its corner k, or the normal of the quad if the corner is flat.
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
        throw InputError(fmt::format(
            "the surface folds back on itself at {} and has no normal there: expected a smooth surface",
            show_point(at)));
  if (different.size() > 2) return by_least_squares(different);
  const Vec3 sum = different[0].normal + different[1].normal;
  return (2 / dot(sum, sum)) * sum;
}

/// Whether the quads at a point make one fan. `ends`: the neighbors of the point in each of them.
bool is_one_fan(std::vector<std::array<int, 2>> ends) {
  std::size_t joined = 1;  // quads that are known to hang together stand first
  for (std::size_t i = 0; i < joined; ++i)
    for (std::size_t j = joined; j < ends.size(); ++j)
      if (ends[i][0] == ends[j][1] || ends[i][1] == ends[j][0]) std::swap(ends[joined++], ends[j]);
  return joined == ends.size();
}

}  // namespace

Vec3 offset_direction(const Mesh& mesh, std::span<const SidedCorner> corners, const Vec3& at) {
  std::vector<CornerNormal> normals;
  for (const auto& [quad, corner, sign] : corners) {
    normals.push_back(corner_normal(mesh, mesh.quads[quad], corner));
    normals.back().normal = sign * normals.back().normal;
  }
  return offset_direction(normals, at);
}

std::vector<Vec3> offset_directions(const Section& section) {
  const Mesh& mesh = section.mesh;
  std::vector<std::vector<std::array<int, 2>>> corners(mesh.points.size());  // quad, corner
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (int k = 0; k < 4; ++k) corners[mesh.quads[q][k]].push_back({static_cast<int>(q), k});
  std::vector<Vec3> directions(mesh.points.size());
  parallel_each(mesh.points.size(), [&](std::size_t i) {
    std::vector<CornerNormal> normals;
    std::vector<std::array<int, 2>> ends;
    for (const auto& [q, k] : corners[i]) {
      const std::array<int, 4>& quad = mesh.quads[q];
      normals.push_back(corner_normal(mesh, quad, k));
      ends.push_back({quad[(k + 1) % 4], quad[(k + 3) % 4]});
    }
    if (!is_one_fan(ends))
      throw InputError(
          fmt::format("quads touch at {} in a point only, where the normal is not unique: expected quads "
                      "that share edges",
                      show_point(mesh.points[i])));
    directions[i] = offset_direction(normals, mesh.points[i]);
  });
  return directions;
}

}  // namespace delquad
