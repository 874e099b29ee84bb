#include "report/packed_mesh.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <numeric>

#include "base/box.h"
#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/picture.h"
#include "io/xml.h"
#include "metrics/metrics.h"

namespace delquad {
namespace {

constexpr double kEtaClasses = 128;  // a byte each

std::array<double, 3> coordinates(const Vec3& p) { return {p.x, p.y, p.z}; }

template <size_t N>
Vec3 centre(const Mesh& mesh, const std::array<int, N>& v) {
  Vec3 sum{0, 0, 0};
  for (const int i : v) sum = sum + mesh.points[i];
  return (1.0 / N) * sum;
}

Box<Vec3> box_of(const Mesh& mesh) {
  return mesh.points.empty() ? Box<Vec3>{} : Box<Vec3>::around(std::span(mesh.points));
}

/// Place along the Z-curve through the box.
std::uint64_t place_in(const Box<Vec3>& box, const Vec3& at) {
  constexpr int kBits = 21;
  std::uint64_t place = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double width = coordinates(box.size())[k];
    const double part = width > 0 ? (coordinates(at - box.low)[k]) / width : 0;
    const auto cell = static_cast<std::uint64_t>(std::clamp(part, 0.0, 1.0) * ((1 << kBits) - 1));
    for (int bit = 0; bit < kBits; ++bit) place |= (cell >> bit & 1) << (3 * bit + static_cast<int>(k));
  }
  return place;
}

/// Neighbours follow each other: their numbers and places then differ little.
template <size_t N>
std::vector<std::size_t> spatial_order(const Mesh& mesh, const std::vector<std::array<int, N>>& elements) {
  const Box<Vec3> box = box_of(mesh);
  std::vector<std::uint64_t> place;
  for (const auto& v : elements) place.push_back(place_in(box, centre(mesh, v)));
  std::vector<std::size_t> order(elements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return place[i]; });
  return order;
}

class Numbers {
 public:
  void put(std::uint64_t n) {
    for (; n >= 128; n >>= 7) bytes_.push_back(static_cast<char>(n | 128));
    bytes_.push_back(static_cast<char>(n));
  }
  void put_signed(std::int64_t n) {
    put(n < 0 ? 2 * static_cast<std::uint64_t>(-n) - 1 : 2 * static_cast<std::uint64_t>(n));
  }

  std::string packed() const { return packed_text({bytes_.data(), bytes_.size()}); }

 private:
  std::string bytes_;
};

/// Numbers vertices in the order in which they are first used.
class Numbering {
 public:
  explicit Numbering(std::size_t points) : number_(points, -1) {}
  void put(int vertex, Numbers& out) {
    if (number_[vertex] < 0) {
      number_[vertex] = static_cast<int>(order_.size());
      order_.push_back(vertex);
      return out.put(0);
    }
    out.put(order_.size() - static_cast<std::size_t>(number_[vertex]));
  }
  int number(int vertex) const { return number_[vertex]; }
  const std::vector<int>& order() const { return order_; }

 private:
  std::vector<int> number_, order_;
};

double shortest_edge(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for_each_element(mesh, [&](int, const auto& v) {
    for (std::size_t k = 0; k < v.size(); ++k)
      if (const double d = norm(mesh.points[v[(k + 1) % v.size()]] - mesh.points[v[k]]); d > 0)
        shortest = std::min(shortest, d);
  });
  return std::isfinite(shortest) ? shortest : 0;
}

void put_irregular(const Mesh& mesh, const Numbering& numbering, PackedMesh& packed, Numbers& out) {
  const int regular = mesh.quads.empty() ? 6 : 4;
  std::vector<double> sizes(mesh.triangles.size() + mesh.quads.size(), 1);
  const auto [vertices, pairs] = irregular_vertices(mesh, regular, sizes);
  packed.irregular = vertices.size();
  packed.pairs = pairs.size();
  for (const IrregularVertex& v : vertices) {
    out.put(static_cast<std::uint64_t>(numbering.number(v.vertex)));
    out.put(static_cast<std::uint64_t>(v.valence));
  }
  for (const auto& pair : pairs)
    for (const int v : pair) out.put(static_cast<std::uint64_t>(numbering.number(v)));
}

void put_places(const Mesh& mesh, const std::vector<int>& order, PackedMesh& packed, Numbers& out) {
  constexpr double kPerEdge = 64, kPerBox = 1 << 26;
  const Box<Vec3> box = box_of(mesh);
  packed.origin = coordinates(box.low);
  packed.unit = std::max(shortest_edge(mesh) / kPerEdge, diagonal(mesh) / kPerBox);
  for (int k = 0; k < packed.dimension; ++k) {
    std::int64_t before = 0;
    for (const int vertex : order) {
      const double place = coordinates(mesh.points[vertex] - box.low)[k];
      const std::int64_t at = packed.unit > 0 ? std::llround(place / packed.unit) : 0;
      out.put_signed(at - before);
      before = at;
    }
  }
}

}  // namespace

PackedMesh pack_mesh(const Mesh& mesh, const std::vector<std::size_t>& failing, bool with_entities) {
  PackedMesh packed;
  packed.triangles = mesh.triangles.size();
  packed.quads = mesh.quads.size();
  packed.lines = mesh.lines.size() * static_cast<std::size_t>(mesh.order);
  packed.order = mesh.order;
  const Box<Vec3> box = box_of(mesh);
  packed.dimension = box.low.z == box.high.z ? 2 : 3;
  Numbers out;
  Numbering numbering(mesh.points.size());
  const std::vector<std::size_t> triangles = spatial_order(mesh, mesh.triangles);
  for (const std::size_t t : triangles)
    for (const int v : mesh.triangles[t]) numbering.put(v, out);
  const std::vector<std::size_t> quads = spatial_order(mesh, mesh.quads);
  for (const std::size_t q : quads)
    for (const int v : nodes_around(mesh, q)) numbering.put(v, out);
  std::vector<std::uint64_t> classes;
  for (const double eta : quad_etas(mesh))
    classes.push_back(static_cast<std::uint64_t>(std::min(eta * kEtaClasses, kEtaClasses - 1)));
  for (const std::size_t q : failing) classes[q] = static_cast<std::uint64_t>(kEtaClasses);
  for (const std::size_t q : quads) out.put(classes[q]);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const std::vector<int> nodes = nodes_of_line(mesh, l);
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
      for (const int v : {nodes[k], nodes[k + 1]}) numbering.put(v, out);
  }
  put_irregular(mesh, numbering, packed, out);
  put_places(mesh, numbering.order(), packed, out);
  if (with_entities) {
    for (const std::size_t t : triangles) out.put(static_cast<std::uint64_t>(mesh.triangle_region[t]));
    for (const std::size_t q : quads) out.put(static_cast<std::uint64_t>(mesh.quad_region[q]));
    for (const int curve : mesh.line_curve)
      for (int k = 0; k < mesh.order; ++k) out.put(static_cast<std::uint64_t>(curve));
  }
  packed.points = numbering.order().size();
  packed.text = out.packed();
  return packed;
}

Mesh thinned(const Mesh& mesh, int step) {
  Mesh result;
  result.points = mesh.points;
  result.lines = mesh.lines;
  result.line_curve = mesh.line_curve;
  const double factor = std::sqrt(step);
  const auto thin = [&](const auto& elements, const std::vector<int>& region, auto& kept, auto& kept_region) {
    const std::vector<std::size_t> order = spatial_order(mesh, elements);
    for (std::size_t i = 0; i < order.size(); i += static_cast<std::size_t>(step)) {
      auto v = elements[order[i]];
      const Vec3 c = centre(mesh, v);
      for (int& corner : v) {
        const Vec3 p = c + factor * (mesh.points[corner] - c);
        corner = static_cast<int>(result.points.size());
        result.points.push_back(p);
      }
      kept.push_back(v);
      kept_region.push_back(region[order[i]]);
    }
  };
  thin(mesh.triangles, mesh.triangle_region, result.triangles, result.triangle_region);
  thin(mesh.quads, mesh.quad_region, result.quads, result.quad_region);
  return result;
}

double packed_bytes(double triangles, double quads) {
  constexpr double kTriangle = 6, kQuad = 10;  // measured on meshes of 5000 to 400 000 elements
  return kTriangle * triangles + kQuad * quads;
}

std::string packed_text(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  auto* const to = reinterpret_cast<Bytef*>(packed.data());
  const auto* const from = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress2(to, &size, from, bytes.size(), Z_BEST_COMPRESSION) != Z_OK)
    throw std::bad_alloc();  // its only reason, given room enough
  packed.resize(size);
  return base64(packed);
}

}  // namespace delquad
