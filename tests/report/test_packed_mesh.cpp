#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "metrics/metrics.h"
#include "report/packed_mesh.h"
#include "report/write_report.h"
#include "tests/support/curved_grid.h"
#include "tests/support/grid_mesh.h"

namespace delquad {
namespace {

using testing_support::quad_grid;
using testing_support::triangle_grid;

/// What page/packed_mesh.js does.
class Unpacker {
 public:
  explicit Unpacker(const PackedMesh& packed) : packed_(packed) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<unsigned char> bytes;
    std::uint32_t held = 0;
    int bits = 0;
    for (const char c : packed.text) {
      if (c == '=') break;
      held = held << 6 | static_cast<std::uint32_t>(digits.find(c));
      if ((bits += 6) >= 8) bytes.push_back(static_cast<unsigned char>(held >> (bits -= 8) & 255));
    }
    bytes_.resize(10'000'000);
    uLongf size = bytes_.size();
    EXPECT_EQ(uncompress(bytes_.data(), &size, bytes.data(), bytes.size()), Z_OK);
    bytes_.resize(size);
  }

  Mesh run() {
    Mesh mesh;
    mesh.triangles.resize(packed_.triangles);
    polygons.assign(packed_.quads, std::vector<int>(4 * static_cast<std::size_t>(packed_.order)));
    mesh.lines.resize(packed_.lines);
    for (auto& v : mesh.triangles) read_vertices(v);
    for (auto& v : polygons) {
      read_vertices(v);
      if (packed_.order == 1) mesh.quads.push_back({v[0], v[1], v[2], v[3]});
    }
    for (std::size_t q = 0; q < packed_.quads; ++q) eta.push_back(static_cast<int>(next()));
    for (auto& v : mesh.lines) read_vertices(v);
    for (std::size_t i = 0; i < packed_.irregular; ++i) {
      const auto vertex = static_cast<int>(next());
      irregular.emplace_back(vertex, static_cast<int>(next()));
    }
    for (std::size_t i = 0; i < packed_.pairs; ++i) {
      const auto few = static_cast<int>(next());
      pairs.emplace_back(few, static_cast<int>(next()));
    }
    mesh.points.resize(packed_.points);
    double Vec3::*const axes[] = {&Vec3::x, &Vec3::y, &Vec3::z};
    for (int k = 0; k < 3; ++k) {
      std::int64_t at = 0;
      for (Vec3& p : mesh.points) {
        if (k < packed_.dimension) {
          const std::uint64_t n = next();
          at += n & 1 ? -static_cast<std::int64_t>((n + 1) / 2) : static_cast<std::int64_t>(n / 2);
        }
        p.*axes[k] = packed_.origin[k] + static_cast<double>(at) * packed_.unit;
      }
    }
    for (std::size_t i = 0; with_entities && i < packed_.triangles + packed_.quads + packed_.lines; ++i)
      entities.push_back(static_cast<int>(next()));
    EXPECT_EQ(at_, bytes_.size());
    return mesh;
  }

  bool with_entities = false;
  std::vector<int> eta, entities;
  std::vector<std::vector<int>> polygons;  ///< of quads
  std::vector<std::pair<int, int>> irregular, pairs;

 private:
  std::uint64_t next() {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const unsigned char byte = bytes_.at(at_++);
      value |= static_cast<std::uint64_t>(byte & 127) << shift;
      if (byte < 128) return value;
    }
  }
  template <class Vertices>
  void read_vertices(Vertices& v) {
    for (int& vertex : v) {
      const int back = static_cast<int>(next());
      vertex = back == 0 ? used_++ : used_ - back;
    }
  }

  const PackedMesh& packed_;
  std::vector<unsigned char> bytes_;
  std::size_t at_ = 0;
  int used_ = 0;
};

/// Corners of each element, from its least one on, rounded to `unit`; sorted.
template <size_t N>
std::vector<std::vector<std::array<long long, 3>>> shapes(const Mesh& mesh,
                                                          const std::vector<std::array<int, N>>& elements,
                                                          double unit) {
  std::vector<std::vector<std::array<long long, 3>>> result;
  for (const auto& v : elements) {
    auto& shape = result.emplace_back();
    for (const int i : v) {
      const Vec3& p = mesh.points[i];
      shape.push_back({std::llround(p.x / unit), std::llround(p.y / unit), std::llround(p.z / unit)});
    }
    std::rotate(shape.begin(), std::min_element(shape.begin(), shape.end()), shape.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

void expect_same(const Mesh& a, const Mesh& b, double unit) {
  EXPECT_EQ(a.points.size(), b.points.size());
  EXPECT_EQ(shapes(a, a.triangles, unit), shapes(b, b.triangles, unit));
  EXPECT_EQ(shapes(a, a.quads, unit), shapes(b, b.quads, unit));
  EXPECT_EQ(shapes(a, a.lines, unit), shapes(b, b.lines, unit));
}

TEST(PackedMesh, ReadsBackPlanarQuads) {
  const Mesh mesh = quad_grid(7, 5, 7, 5);
  const PackedMesh packed = pack_mesh(mesh);
  EXPECT_EQ(packed.dimension, 2);
  EXPECT_EQ(packed.unit, 1.0 / 64);
  Unpacker unpacker(packed);
  expect_same(unpacker.run(), mesh, 0.5);
  EXPECT_EQ(unpacker.eta, std::vector<int>(35, 127));
  EXPECT_TRUE(unpacker.irregular.empty());
  const PackedMesh with_failing = pack_mesh(mesh, {3, 20});
  Unpacker other(with_failing);
  other.run();
  EXPECT_EQ(std::ranges::count(other.eta, 128), 2);
}

TEST(PackedMesh, ElementsKeepTheirEntities) {
  Mesh mesh = quad_grid(7, 5, 7, 5);
  mesh.regions.push_back({2, {}});
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) mesh.quad_region[q] = q % 7 < 3 ? 1 : 0;
  for (const int step : {1, 5}) {
    const Mesh shown = step > 1 ? thinned(mesh, step) : mesh;
    const PackedMesh packed = pack_mesh(shown, {}, true);
    Unpacker unpacker(packed);
    unpacker.with_entities = true;
    const Mesh read = unpacker.run();
    ASSERT_EQ(unpacker.entities.size(), shown.quads.size() + mesh.lines.size());
    for (std::size_t q = 0; q < read.quads.size(); ++q) {
      double x = 0;
      for (const int v : read.quads[q]) x += read.points[v].x / 4;
      EXPECT_EQ(unpacker.entities[q], x < 3 ? 1 : 0);
    }
    EXPECT_EQ(std::vector<int>(unpacker.entities.end() - 24, unpacker.entities.end()), mesh.line_curve);
  }
}

TEST(PackedMesh, ReadsBackTrianglesInSpaceWithAllTheyHave) {
  Mesh mesh = triangle_grid(4, 4, 4, 4);
  for (Vec3& p : mesh.points) p = {p.x - 3, p.y + 1e6, p.x * p.y};
  std::swap(mesh.triangles[0], mesh.triangles[20]);
  const PackedMesh packed = pack_mesh(mesh);
  EXPECT_EQ(packed.dimension, 3);
  Unpacker unpacker(packed);
  expect_same(unpacker.run(), mesh, 0.25);
}

TEST(PackedMesh, JoinsTheNodesOfCurvedElements) {
  const Mesh mesh = testing_support::curved_grid(3, 2, 3, true);
  const PackedMesh packed = pack_mesh(mesh);
  EXPECT_EQ(packed.order, 3);
  EXPECT_EQ(packed.lines, 3 * mesh.lines.size());
  EXPECT_EQ(packed.points, mesh.points.size() - 4 * mesh.quads.size()) << "all but those inside";
  Unpacker unpacker(packed);
  const Mesh unpacked = unpacker.run();
  ASSERT_EQ(unpacker.polygons.size(), mesh.quads.size());
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto is_same = [&](const std::vector<int>& polygon) {
      const std::vector<int> nodes = nodes_around(mesh, q);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        if (norm(unpacked.points[polygon[k]] - mesh.points[nodes[k]]) > packed.unit) return false;
      return true;
    };
    EXPECT_EQ(std::ranges::count_if(unpacker.polygons, is_same), 1) << q;
  }
}

TEST(PackedMesh, NamesPairsOfIrregularVertices) {
  Mesh mesh = quad_grid(6, 5, 6, 5);
  // The edge from (3, 2) to (3, 3) is turned.
  mesh.quads[14] = {16, 17, 18, 23};
  mesh.quads[15] = {18, 25, 24, 23};
  const PackedMesh packed = pack_mesh(mesh);
  EXPECT_EQ(packed.irregular, 4u);
  Unpacker unpacker(packed);
  const Mesh read = unpacker.run();
  ASSERT_EQ(unpacker.pairs.size(), 2u);
  for (const auto& [few, many] : unpacker.pairs) {
    EXPECT_NEAR(read.points[few].x, 3, packed.unit);
    EXPECT_NEAR(norm(read.points[few] - read.points[many]), 1, 2 * packed.unit);
  }
}

TEST(PackedMesh, NamesIrregularVerticesAndEta) {
  // Three quads around a vertex of a triangle.
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {2, 1, 0}, {0, 4, 0}, {-2, 1, 0}, {-4, -2, 0}, {0, -2, 0}, {4, -2, 0}};
  mesh.quads = {{0, 1, 2, 3}, {0, 3, 4, 5}, {0, 5, 6, 1}};
  mesh.quad_region = {0, 0, 0};
  mesh.regions = {{1, {}}};
  const PackedMesh packed = pack_mesh(mesh);
  Unpacker unpacker(packed);
  const Mesh read = unpacker.run();
  ASSERT_EQ(unpacker.irregular.size(), 1u);
  EXPECT_EQ(unpacker.irregular[0].second, 3);
  EXPECT_LT(norm(read.points[unpacker.irregular[0].first]), packed.unit);
  std::vector<int> expected;
  for (const double eta : quad_etas(mesh)) expected.push_back(static_cast<int>(128 * eta));
  std::sort(expected.begin(), expected.end());
  std::sort(unpacker.eta.begin(), unpacker.eta.end());
  EXPECT_EQ(unpacker.eta, expected);
}

TEST(PackedMesh, OfNothingAndOfOnePlace) {
  EXPECT_EQ(pack_mesh({}).points, 0u);
  Mesh mesh = quad_grid(1, 1);
  for (Vec3& p : mesh.points) p = {5, 5, 0};
  const PackedMesh packed = pack_mesh(mesh);
  Unpacker unpacker(packed);
  for (const Vec3& p : unpacker.run().points) EXPECT_EQ(p, (Vec3{5, 5, 0}));
}

/// Tiny elements beside large ones stay apart.
TEST(PackedMesh, KeepsTheSmallestEdge) {
  Mesh mesh = quad_grid(2, 1, 2, 1);
  for (Vec3& p : mesh.points)
    if (p.x == 1) p.x = 1e-5;
  const PackedMesh packed = pack_mesh(mesh);
  Unpacker unpacker(packed);
  const Mesh read = unpacker.run();
  std::vector<double> xs;
  for (const Vec3& p : read.points) xs.push_back(p.x);
  std::sort(xs.begin(), xs.end());
  EXPECT_NEAR(xs[2], 1e-5, 1e-6);
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& v : mesh.quads)
    sum += norm(cross(mesh.points[v[2]] - mesh.points[v[0]], mesh.points[v[3]] - mesh.points[v[1]])) / 2;
  return sum;
}

TEST(Thinned, CoversAsMuchWithFewer) {
  const Mesh mesh = quad_grid(60, 60);
  const Mesh thin = thinned(mesh, 9);
  EXPECT_EQ(thin.quads.size(), 400u);
  EXPECT_EQ(thin.lines.size(), mesh.lines.size());
  EXPECT_NEAR(area(thin), area(mesh), 1e-9);
  // Spread evenly: no quarter has less than a fifth of them.
  int counts[2][2] = {};
  for (const auto& v : thin.quads) {
    const Vec3 c = 0.5 * (thin.points[v[0]] + thin.points[v[2]]);
    ++counts[c.x > 0.5][c.y > 0.5];
  }
  for (const auto& row : counts)
    for (const int count : row) EXPECT_GE(count, 80);
}

TEST(FairShare, GivesWhatFitsAndSharesTheRest) {
  EXPECT_EQ(fair_share({1, 2, 3}, 10), std::numeric_limits<double>::infinity());
  EXPECT_EQ(fair_share({}, 10), std::numeric_limits<double>::infinity());
  EXPECT_EQ(fair_share({100, 1, 100, 2}, 23), 10);
  EXPECT_EQ(fair_share({8, 8, 8, 8}, 16), 4);
}

}  // namespace
}  // namespace delquad
