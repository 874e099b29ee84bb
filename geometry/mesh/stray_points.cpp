// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/stray_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/check_invariants.h"

namespace delquad {

std::vector<StrayPoint> stray_points(const Mesh& mesh) {
  assert(has_finite_points(mesh));
  std::vector<int> used;
  const auto add = [&](const auto& elements) {
    for (const auto& v : elements) used.insert(used.end(), v.begin(), v.end());
  };
  add(mesh.lines), add(mesh.triangles), add(mesh.quads);
  sort_unique(used);
  if (used.empty()) return {};
  std::vector<double> out(used.size(), 0), sorted;
  for (double Vec3::*x : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    sorted.clear();
    for (const int i : used) sorted.push_back(mesh.points[i].*x);
    const auto middle = sorted.begin() + static_cast<long>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    for (std::size_t k = 0; k < used.size(); ++k)
      out[k] = std::max(out[k], std::abs(mesh.points[used[k]].*x - *middle));
  }
  sorted = out;
  const auto most = sorted.begin() + static_cast<long>(3 * sorted.size() / 4);
  std::nth_element(sorted.begin(), most, sorted.end());
  if (!(*std::max_element(most, sorted.end()) > kStray * *most)) return {};
  std::sort(most, sorted.end());
  const auto reach = std::adjacent_find(
      most, sorted.end(), [](double near, double far) { return near > 0 && far > kStray * near; });
  std::vector<StrayPoint> strays;
  for (std::size_t k = 0; reach != sorted.end() && k < used.size(); ++k)
    if (out[k] > *reach) strays.push_back({used[k], out[k] / *reach});
  return strays;
}

std::string describe(const StrayPoint& stray, const Mesh& mesh) {
  const Vec3& p = mesh.points[stray.point];
  return fmt::format("the point {} is {:.3g} times as far out as the others: is a number damaged?",
                     show_point(p), stray.times);
}

}  // namespace delquad
