// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <map>
#include <memory>
#include <span>

#include "base/located.h"
#include "base/text.h"
#include "experiments/sweep/peer.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {
namespace {

/// Triangles in space, or lines as flat triangles, with places on them.
struct Shape {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles = {};
  std::vector<Vec3> places = {};
};

void add_line(Shape& shape, int a, int b) {
  shape.triangles.push_back({a, b, b});
  shape.places.push_back(shape.points[a]);
  shape.places.push_back(0.5 * (shape.points[a] + shape.points[b]));
}

/// The lines of the model's boundary that bound so many regions.
Shape curves_of(const Prepared& prepared, int n_regions) {
  const auto edge = [](int a, int b) { return std::array{std::min(a, b), std::max(a, b)}; };
  std::map<std::array<int, 2>, int> regions;
  for (std::size_t p = 0; p < prepared.n_patches(); ++p)
    for (const auto& [i, j] : prepared.patch(p).edges)
      ++regions[edge(prepared.patch(p).point_node[i], prepared.patch(p).point_node[j])];
  const Mesh boundary = boundary_of(prepared);
  Shape shape{boundary.points};
  for (const auto& [a, b] : boundary.lines)
    if (regions[edge(a, b)] == n_regions) add_line(shape, a, b);
  return shape;
}

/// All edges of a mesh, or those that bound it.
Shape edges_of(const Mesh& mesh, bool outside_alone) {
  Shape shape{mesh.points};
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    if (!outside_alone || edge.size() == 1) add_line(shape, edge[0].lo, edge[0].hi);
  });
  return shape;
}

Shape surface_of(const Mesh& mesh) {
  Shape shape{mesh.points};
  for_each_element(mesh, [&](int, const auto& v) {
    Vec3 sum;
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (k >= 2) shape.triangles.push_back({v[0], v[k - 1], v[k]});
      sum = sum + mesh.points[v[k]];
      shape.places.push_back(mesh.points[v[k]]);
    }
    shape.places.push_back(1.0 / static_cast<double>(v.size()) * sum);
  });
  return shape;
}

/// Calls visit(place, distance in sizes) for each place of a shape. The distance is the one from the other.
template <class Visit>
void for_each_distance(const Shape& from, const Shape& to, const SizeField& size, Visit visit) {
  const NearestTriangle nearest(to.points, to.triangles);
  int guess = -1, hint = -1;
  for (const Vec3& p : from.places) {
    const auto found = nearest.find_from(guess, p);
    guess = found.triangle;
    visit(p, found.distance / size.at(p, hint));
  }
}

void check_near(const Shape& from, const Shape& to, const SizeField& size, const char* what) {
  constexpr double kFurthest = 1.25;  // sizes, as for our own meshes
  for_each_distance(from, to, size, [&](const Vec3& p, double sizes) {
    if (!(sizes <= kFurthest))
      refuse<PeerError>("it is no mesh of this model: {} at {}, {:.3g} sizes", what, show_point(p), sizes);
  });
}

/// In a grid that ignores the curves between regions, places on them are a sixth of a size off on average.
void check_interfaces(const Prepared& prepared, const SizeField& size, const Mesh& mesh) {
  constexpr double kMean = 0.08;  // sizes
  const Shape interfaces = curves_of(prepared, 2);
  double sum = 0;
  if (!interfaces.places.empty())
    for_each_distance(interfaces, edges_of(mesh, false), size, [&](const Vec3&, double d) { sum += d; });
  if (const double n = static_cast<double>(interfaces.places.size()); sum > n * kMean)
    refuse<PeerError>(
        "its edges do not follow the curves between regions, which are {:.2g} sizes off on average", sum / n);
}

/// The size that the case asks for; of a metric the longest length at each place.
std::shared_ptr<const SizeField> size_of(const Prepared& prepared) {
  const auto metric = followed_metric(prepared);
  if (!metric) return prepared->size.field;
  std::vector<double> longest;
  for (const Tensor2& m : metric->at) longest.push_back(axes_of(m).h2);
  return make_nodal_size(metric->mesh, std::move(longest));
}

}  // namespace

void check_place(const Prepared& prepared, const Mesh& mesh) {
  const bool planar = !prepared.is_surface();
  const Shape model = planar ? curves_of(prepared, 1) : surface_of(prepared.fine());
  const Shape made = planar ? edges_of(mesh, true) : surface_of(mesh);
  const auto size = size_of(prepared);
  check_near(made, model, *size, "it lies off the model");
  check_near(model, made, *size, "the model is not covered");
  if (planar) check_interfaces(prepared, *size, mesh);
}

}  // namespace delquad
