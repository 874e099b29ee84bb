// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/midsurface/opposite_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/parallel_each.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {
namespace {

/// Least cosine between the ray and the normal where it leaves the body, for an opposite face.
constexpr double kLeastFacing = 0.5;
/// Rims and steps are deeper than so many thicknesses beside them, and not as wide.
constexpr double kDeep = 3;
/// Faces that face each other in a smaller part of their area are not opposite.
constexpr double kFacingPart = 0.1;
/// Thickness over the thickness beside a step, at least.
constexpr double kThicker = 1.001;
/// Samples of a large triangle along a side, and of the whole model along a side of its mean extent.
constexpr int kMostAlong = 8;
constexpr double kAlongModel = 60;
/// Distances in diagonals below which a ray has not begun yet.
constexpr double kBegin = 1e-9;

/// Returns the distance along a ray to a box; the largest number if it does not meet.
double distance_along(const Vec3& from, const Vec3& along, const Box<Vec3>& box) {
  double first = 0, last = std::numeric_limits<double>::max();
  for (int k = 0; k < 3; ++k) {
    const double x = coordinate(from, k), d = coordinate(along, k);
    const double low = coordinate(box.low, k) - x, high = coordinate(box.high, k) - x;
    if (d == 0) {
      if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
      continue;
    }
    first = std::max(first, std::min(low / d, high / d));
    last = std::min(last, std::max(low / d, high / d));
  }
  return first <= last ? first : std::numeric_limits<double>::infinity();
}

}  // namespace

OppositeSides::OppositeSides(const SurfaceModel& model)
    : source_(model.source), fine_(model.fine), projector_(model.projector), regions_(model.fine) {
  std::vector<Box<Vec3>> boxes;
  begin_ = kBegin * diagonal(fine_);
  double volume = 0;
  for (const auto& [a, b, c] : fine_.triangles) {
    const Vec3 &x = fine_.points[a], &y = fine_.points[b], &z = fine_.points[c];
    boxes.push_back(Box<Vec3>::around({x, y, z}).grown(begin_));
    volume += dot(x - fine_.points[fine_.triangles[0][0]], cross(y - x, z - x));
  }
  tree_ = BoxTree<Vec3>(boxes);
  if (volume < 0) inwards_ = 1;
  measure_curves();
  sample();
  find_narrow();
  find_sides();
}

Vec3 OppositeSides::normal(int triangle) const {
  const auto& [a, b, c] = fine_.triangles[triangle];
  const Vec3 n = cross(fine_.points[b] - fine_.points[a], fine_.points[c] - fine_.points[a]);
  return norm(n) > 0 ? (1 / norm(n)) * n : n;
}

OppositeSides::Hit OppositeSides::leave(const Vec3& from, const Vec3& along) const {
  constexpr double kRounding = 1e-9;  // of weights
  double limit = std::numeric_limits<double>::max();
  Hit hit;
  tree_.search(
      limit, [&](const BoxTree<Vec3>::Node& node) { return distance_along(from, along, node.box); },
      [&](int t) {
        const auto& [a, b, c] = fine_.triangles[t];
        const Vec3 u = fine_.points[b] - fine_.points[a], v = fine_.points[c] - fine_.points[a];
        const Vec3 n = cross(u, v);
        const double towards = dot(n, along);
        if (!(-inwards_ * towards > 0)) return;
        const Vec3 x = from - fine_.points[a];
        const double distance = -dot(n, x) / towards;
        if (!(distance > begin_ && distance < limit)) return;
        const Vec3 at = x + distance * along;
        const double wu = dot(n, cross(at, v)) / dot(n, n), wv = dot(n, cross(u, at)) / dot(n, n);
        if (wu < -kRounding || wv < -kRounding || wu + wv > 1 + kRounding) return;
        limit = distance;
        hit = {t, distance};
      });
  return hit;
}

OppositeSides::Sample OppositeSides::look(const Vec3& from, const Vec3& inwards, double area) const {
  const Hit hit = leave(from, inwards);
  if (hit.triangle < 0) return {from, area, -1, std::numeric_limits<double>::infinity()};
  const bool is_opposite = -inwards_ * dot(normal(hit.triangle), inwards) >= kLeastFacing;
  return {from, area, is_opposite ? fine_.triangle_region[hit.triangle] : -1, hit.distance};
}

void OppositeSides::measure_curves() {
  shared_.resize(fine_.regions.size());
  for_each_edge(sorted_half_edges(fine_), [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2)
      throw InputError(fmt::format(
          "{}: the surface is {} at {}: a mid-surface needs closed bodies of one solid each [no-midsurface]",
          source_, edge.size() == 1 ? "open" : "branching", show_point(fine_.points[edge[0].lo])));
    const int f = region_of(fine_, edge[0].element), g = region_of(fine_, edge[1].element);
    if (f == g) return;
    const double length = norm(fine_.points[edge[0].hi] - fine_.points[edge[0].lo]);
    shared_[f][g] += length;
    shared_[g][f] += length;
  });
}

void OppositeSides::sample() {
  const std::size_t n = fine_.triangles.size();
  std::vector<std::vector<Sample>> by_triangle(n);
  const auto corner = [&](std::size_t t, int k) { return fine_.points[fine_.triangles[t][k]]; };
  const auto area = [&](std::size_t t) {
    return norm(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0))) / 2;
  };
  double total = 0;
  for (std::size_t t = 0; t < n; ++t) total += area(t);
  const double spacing = std::sqrt(total) / kAlongModel;
  parallel_each(n, [&](std::size_t t) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, norm(corner(t, (k + 1) % 3) - corner(t, k)));
    const int along = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMostAlong);
    const Vec3 inwards = inwards_ * normal(static_cast<int>(t));
    for (int i = 0; i < along; ++i)
      for (int j = 0; i + j < along; ++j)
        for (const double shift : {1.0 / 3, 2.0 / 3}) {  // triangles that stand up, and down
          const double u = (i + shift) / along, v = (j + shift) / along;
          if (u + v >= 1) continue;
          const Vec3 x = corner(t, 0) + u * (corner(t, 1) - corner(t, 0)) + v * (corner(t, 2) - corner(t, 0));
          by_triangle[t].push_back(look(x, inwards, area(t) / (along * along)));
        }
  });
  samples_.resize(fine_.regions.size());
  for (std::size_t t = 0; t < n; ++t) {
    std::vector<Sample>& of_face = samples_[fine_.triangle_region[t]];
    of_face.insert(of_face.end(), by_triangle[t].begin(), by_triangle[t].end());
  }
  for (std::vector<Sample> of_face : samples_) {
    std::ranges::sort(of_face, {}, &Sample::distance);
    double half = 0;
    for (const Sample& s : of_face) half += s.area / 2;
    thickness_.push_back(std::numeric_limits<double>::infinity());
    for (const Sample& s : of_face)
      if ((half -= s.area) <= 0) {
        thickness_.back() = s.distance;
        break;
      }
  }
}

std::map<int, double> OppositeSides::parts_facing(int face) const {
  std::map<int, double> parts;
  double area = 0;
  for (const Sample& s : samples_[face]) {
    area += s.area;
    if (s.opposite >= 0 && s.distance <= kDeep * thickness_[face]) parts[s.opposite] += s.area;
  }
  for (auto& [other, part] : parts) part /= area;
  return parts;
}

void OppositeSides::find_narrow() {
  const std::size_t n = fine_.regions.size();
  is_narrow_.assign(n, 0);
  for (std::size_t r = 0; r < n; ++r) {
    double outline = 0, area = 0, most = 0;
    for (const auto& [f, length] : shared_[r]) {
      outline += length;
      if (kDeep * thickness_[f] <= thickness_[r]) most = std::max(most, thickness_[f]);
    }
    for (const Sample& s : samples_[r]) area += s.area;
    is_narrow_[r] = 2 * area <= kDeep * most * outline && most > 0;
  }
}

int OppositeSides::side_of_step(int face) const {
  int side = -1;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const auto& [f, length] : shared_[face]) {
    if (is_narrow_[f]) continue;
    if (side >= 0 && side != side_[f]) return -1;
    side = side_[f];
    least = std::min(least, thickness_[f]), most = std::max(most, thickness_[f]);
  }
  return most > kThicker * least ? side : -1;
}

std::string OppositeSides::show(int face) const {
  return fmt::format(
      "face {} at {}", fine_.regions[face].tag,
      show_point(samples_[face].empty() ? Vec3{} : samples_[face][samples_[face].size() / 2].at));
}

void OppositeSides::find_sides() {
  const int n = static_cast<int>(fine_.regions.size());
  std::vector<std::map<int, bool>> others(n);  // whether they are on the same side
  const auto join = [&](int f, int g, bool is_same) {
    if (is_narrow_[f] || is_narrow_[g]) return;
    const auto [at, is_new] = others[f].try_emplace(g, is_same);
    others[g].try_emplace(f, is_same);
    if (f != g && (is_new || at->second == is_same)) return;
    const std::string what = f == g ? show(f) + " faces itself"
                                    : show(f) + " and " + show(g) + " are beside each other and opposite";
    throw InputError(
        fmt::format("{}: {}: the body is thick there, or plates join there. Mesh its faces without a "
                    "mid-surface, or part the body [no-midsurface]",
                    source_, what));
  };
  for (int f = 0; f < n; ++f) {
    for (const auto& [g, length] : shared_[f]) join(f, g, true);
    for (const auto& [g, part] : parts_facing(f))
      if (part >= kFacingPart) join(f, g, false);
  }
  side_.assign(n, -1);
  for (int first = 0; first < n; ++first) {
    if (is_narrow_[first] || side_[first] >= 0) continue;
    std::vector<int> component = {first};
    side_[first] = 0;
    for (std::size_t i = 0; i < component.size(); ++i)
      for (const auto& [g, is_same] : others[component[i]]) {
        const int side = is_same ? side_[component[i]] : 1 - side_[component[i]];
        if (side_[g] < 0) {
          side_[g] = side;
          component.push_back(g);
        } else if (side_[g] != side) {
          throw InputError(
              fmt::format("{}: {} and {} are on both sides of the body: plates join there, or the body is "
                          "thick. Mesh its faces without a mid-surface, or part the body [no-midsurface]",
                          source_, show(component[i]), show(g)));
        }
      }
    choose(component);
  }
  std::ranges::sort(faces_);
}

bool OppositeSides::is_faced(int face, const Sample& sample) const {
  return sample.opposite >= 0 && side_[sample.opposite] == 1 - side_[face] && side_[face] >= 0;
}

double OppositeSides::faced_part(int face) const {
  double area = 0, faced = 0;
  for (const Sample& s : samples_[face]) {
    area += s.area;
    if (is_faced(face, s)) faced += s.area;
  }
  return area > 0 ? faced / area : 1;
}

void OppositeSides::choose(const std::vector<int>& component) {
  std::vector<int> faces[2];
  std::set<int> missing[2];  // without an opposite side, or steps
  double area[2] = {0, 0};
  for (const int f : component) {
    const int s = side_[f];
    faces[s].push_back(f);
    for (const Sample& sample : samples_[f]) area[s] += sample.area;
    if (faced_part(f) < kFacedPart) missing[s].insert(f);
    for (const auto& [r, length] : shared_[f])
      if (is_narrow_[r] && side_of_step(r) == s) missing[s].insert(r);
  }
  int s = missing[0].size() != missing[1].size() ? missing[0].size() > missing[1].size() : area[0] > area[1];
  if (faces[s].empty()) s = 1 - s;
  if (!missing[s].empty())
    throw InputError(fmt::format(
        "{}: no opposite side for {}{}: a mid-surface needs thin bodies, without rounded rims and with steps "
        "on one side at most. Take the face away, or mesh without a mid-surface [no-midsurface]",
        source_, show(*missing[s].begin()),
        missing[s].size() == 1 ? "" : fmt::format(" and {} more faces", missing[s].size() - 1)));
  faces_.insert(faces_.end(), faces[s].begin(), faces[s].end());
}

}  // namespace delquad
