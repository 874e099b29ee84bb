#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/text.h"
#include "experiments/suite/submission.h"
#include "experiments/sweep/peer.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {
namespace {

/// As for our own meshes, see docs/experiments.md.
constexpr double kFurthest = 1.25;  // sizes

/// What is compared: triangles in space, or of planar meshes the lines of the boundary, as flat triangles;
/// with places on them.
struct Shape {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vec3> places;
};

void add_line(Shape& shape, int a, int b) {
  shape.triangles.push_back({a, b, b});
  shape.places.push_back(shape.points[a]);
  shape.places.push_back(0.5 * (shape.points[a] + shape.points[b]));
}

Shape lines_of(const Mesh& lines) {
  Shape shape{lines.points, {}, {}};
  for (const auto& [a, b] : lines.lines) add_line(shape, a, b);
  return shape;
}

Shape outline_of(const Mesh& mesh) {
  Shape shape{mesh.points, {}, {}};
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) add_line(shape, edge[0].lo, edge[0].hi);
  });
  return shape;
}

Shape surface_of(const Mesh& mesh) {
  Shape shape{mesh.points, {}, {}};
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

/// Throws PeerError where a place of one shape is too far from the other.
void check_near(const Shape& from, const Shape& to, const SizeField& size, const char* what) {
  const NearestTriangle nearest(to.points, to.triangles);
  int guess = -1, hint = -1;
  for (const Vec3& p : from.places) {
    const auto found = nearest.find_from(guess, p);
    guess = found.triangle;
    const double sizes = found.distance / size.at(p, hint);
    if (!(sizes <= kFurthest))
      throw PeerError(
          fmt::format("it is no mesh of this model: {} at {}, {:.3g} sizes", what, show_point(p), sizes));
  }
}

/// The boundary's lines that bound one region (outer) or two (interfaces).
Mesh lines_at(const Prepared& prepared, int n_regions) {
  const auto edge = [](int a, int b) { return std::array{std::min(a, b), std::max(a, b)}; };
  std::map<std::array<int, 2>, int> regions;
  for (std::size_t p = 0; p < prepared.n_patches(); ++p)
    for (const auto& [i, j] : prepared.patch(p).edges)
      ++regions[edge(prepared.patch(p).point_node[i], prepared.patch(p).point_node[j])];
  Mesh lines = prepared->boundary;
  std::erase_if(lines.lines, [&](const auto& line) { return regions[edge(line[0], line[1])] != n_regions; });
  return lines;
}

Shape edges_of(const Mesh& mesh) {
  Shape shape{mesh.points, {}, {}};
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides),
                [&](std::span<const HalfEdge> edge) { add_line(shape, edge[0].lo, edge[0].hi); });
  return shape;
}

/// Edges follow the curves between regions: places there are much nearer to edges, on average, than the sixth
/// of a size that they are in a grid which does not know of them.
void check_interfaces(const Prepared& prepared, const Mesh& mesh) {
  constexpr double kMean = 0.08;  // sizes
  const Shape interfaces = lines_of(lines_at(prepared, 2)), edges = edges_of(mesh);
  if (interfaces.places.empty()) return;
  const NearestTriangle nearest(edges.points, edges.triangles);
  double sum = 0;
  int guess = -1, hint = -1;
  for (const Vec3& p : interfaces.places) {
    const auto found = nearest.find_from(guess, p);
    guess = found.triangle;
    sum += found.distance / prepared->size.field->at(p, hint);
  }
  const double mean = sum / static_cast<double>(interfaces.places.size());
  if (mean > kMean)
    throw PeerError(
        fmt::format("its edges do not follow the curves between regions, which are {:.2g} sizes off "
                    "on average",
                    mean));
}

}  // namespace

void check_is_of_model(const Prepared& prepared, Mesh& mesh) {
  Peer peer;
  peer.keeps_boundary = false;
  check_peer_mesh(peer, prepared, mesh);
  const bool planar = !prepared.is_surface();
  const Shape model = planar ? lines_of(lines_at(prepared, 1)) : surface_of(prepared.fine());
  const Shape made = planar ? outline_of(mesh) : surface_of(mesh);
  check_near(made, model, *prepared->size.field, "it lies off the model");
  check_near(model, made, *prepared->size.field, "the model is not covered");
  if (planar) check_interfaces(prepared, mesh);
}

}  // namespace delquad
