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

/// Rims and steps are deeper than so many thicknesses beside them, and not as wide.
constexpr double kDeep = 3;
/// Faces that face each other in a smaller part of their area are not opposite.
constexpr double kFacingPart = 0.1;
/// Thickness over the thickness beside a step, at least.
constexpr double kThicker = 1.001;

}  // namespace

OppositeSides::OppositeSides(const SurfaceModel& model) : BodyRays(model), joined_(join_plates(*this)) {
  if (joined_) return;
  find_narrow();
  find_sides();
}

std::map<int, double> OppositeSides::parts_facing(int face) const {
  std::map<int, double> parts;
  double area = 0;
  for (const Sample& s : samples[face]) {
    area += s.area;
    if (s.opposite >= 0 && s.distance <= kDeep * median_thickness[face]) parts[s.opposite] += s.area;
  }
  for (auto& [other, part] : parts) part /= area;
  return parts;
}

void OppositeSides::find_narrow() {
  for (std::size_t r = 0; r < fine.regions.size(); ++r) {
    double outline = 0, area = 0, most = 0;
    for (const auto& [f, length] : shared[r]) {
      outline += length;
      if (kDeep * median_thickness[f] <= median_thickness[r]) most = std::max(most, median_thickness[f]);
    }
    for (const Sample& s : samples[r]) area += s.area;
    is_narrow_.push_back(area == 0 || (2 * area <= kDeep * most * outline && most > 0));
  }
}

int OppositeSides::side_of_step(int face) const {
  int side = -1;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const auto& [f, length] : shared[face]) {
    if (is_narrow_[f]) continue;
    if (side >= 0 && side != side_[f]) return -1;
    side = side_[f];
    least = std::min(least, median_thickness[f]), most = std::max(most, median_thickness[f]);
  }
  return most > kThicker * least ? side : -1;
}

void OppositeSides::find_sides() {
  const int n = static_cast<int>(fine.regions.size());
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
                    source, what));
  };
  for (int f = 0; f < n; ++f) {
    for (const auto& [g, length] : shared[f]) join(f, g, true);
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
                          source, show(component[i]), show(g)));
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
  for (const Sample& s : samples[face]) {
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
    for (const Sample& sample : samples[f]) area[s] += sample.area;
    if (faced_part(f) < kFacedPart) missing[s].insert(f);
    for (const auto& [r, length] : shared[f])
      if (is_narrow_[r] && side_of_step(r) == s) missing[s].insert(r);
  }
  int s = missing[0].size() != missing[1].size() ? missing[0].size() > missing[1].size() : area[0] > area[1];
  if (faces[s].empty()) s = 1 - s;
  if (!missing[s].empty())
    throw InputError(
        fmt::format("{}: no opposite side for {}{}: a mid-surface needs thin bodies, with steps "
                    "on one side at most. Take the face away, or mesh without a mid-surface [no-midsurface]",
                    source, show(*missing[s].begin()),
                    missing[s].size() == 1 ? "" : fmt::format(" and {} more faces", missing[s].size() - 1)));
  faces_.insert(faces_.end(), faces[s].begin(), faces[s].end());
}

}  // namespace delquad
