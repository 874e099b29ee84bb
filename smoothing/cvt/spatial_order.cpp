#include "smoothing/cvt/spatial_order.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace delquad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::vector<std::size_t> hilbert_order(const std::vector<Vec2>& points) {
  using Map = CGAL::Pointer_property_map<Kernel::Point_2>::const_type;
  std::vector<Kernel::Point_2> at;
  at.reserve(points.size());
  for (const Vec2 x : points) at.emplace_back(x.x, x.y);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const CGAL::Spatial_sort_traits_adapter_2<Kernel, Map> traits(CGAL::make_property_map(std::as_const(at)));
  CGAL::hilbert_sort(order.begin(), order.end(), traits);
  return order;
}

}  // namespace

std::vector<int> spatial_order(const TriPatch& patch) {
  std::vector<int> order;
  for (const std::size_t i : hilbert_order(patch.points))
    if (static_cast<int>(i) >= patch.n_boundary) order.push_back(static_cast<int>(i));
  return order;
}

TriPatch reordered(const TriPatch& patch, const std::vector<int>& order) {
  TriPatch result;
  result.n_boundary = patch.n_boundary;
  result.points = patch.points;
  std::vector<int> place(patch.points.size());
  std::iota(place.begin(), place.end(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = patch.n_boundary + static_cast<int>(k);
    result.points[patch.n_boundary + k] = patch.points[order[k]];
  }
  // The last corner is an inner point wherever there is one.
  const auto key = [&](int t) {
    const auto& v = patch.triangles[t];
    return std::max({place[v[0]], place[v[1]], place[v[2]]});
  };
  std::vector<int> triangles(patch.triangles.size()), triangle_place(patch.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0);
  std::ranges::stable_sort(triangles, {}, key);
  for (std::size_t k = 0; k < triangles.size(); ++k) triangle_place[triangles[k]] = static_cast<int>(k);
  for (const int t : triangles) {
    auto& v = result.triangles.emplace_back(patch.triangles[t]);
    auto& n = result.neighbours.emplace_back(patch.neighbours[t]);
    for (int k = 0; k < 3; ++k) {
      v[k] = place[v[k]];
      if (n[k] >= 0) n[k] = triangle_place[n[k]];
    }
  }
  return result;
}

}  // namespace delquad
