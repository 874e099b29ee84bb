// SPDX-License-Identifier: GPL-3.0-or-later
#include <zlib.h>

#include "experiments/report/packed_mesh.h"
#include "metrics/metrics.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kExact = 1e-6;  // coordinates are of single precision

/// The same as page/packed_mesh.js does.
class Unpacker {
 public:
  explicit Unpacker(const PackedMesh& packed) : info_(packed.info) {
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
    mesh.triangles.resize(count("triangles"));
    polygons.assign(count("quads"), std::vector<int>(4 * count("order")));
    mesh.lines.resize(count("lines"));
    mesh.points.resize(count("points"));
    double Vec3::*const axes[] = {&Vec3::x, &Vec3::y, &Vec3::z};
    for (std::size_t k = 0; k < 3; ++k)
      for (Vec3& p : mesh.points) p.*axes[k] = info_.at("origin").at(k).get<double>() + next<float>();
    for (auto& v : mesh.triangles) read_all(v);
    for (auto& v : polygons) {
      read_all(v);
      if (count("order") == 1) mesh.quads.push_back({v[0], v[1], v[2], v[3]});
    }
    eta.resize(count("quads"));
    read_all(eta);
    for (auto& v : mesh.lines) read_all(v);
    irregular.resize(count("irregular"));
    for (auto& v : irregular) read_all(v);
    pairs.resize(count("pairs"));
    for (auto& v : pairs) read_all(v);
    if (info_.at("entities")) entities.resize(count("triangles") + count("quads") + count("lines"));
    read_all(entities);
    EXPECT_EQ(at_, bytes_.size());
    return mesh;
  }

  std::vector<int> eta, entities;
  std::vector<std::vector<int>> polygons;  ///< of quads
  std::vector<std::array<int, 2>> irregular, pairs;

 private:
  std::size_t count(const char* key) const { return info_.at(key).get<std::size_t>(); }
  template <class Number>
  Number next() {
    Number number;
    std::memcpy(&number, bytes_.data() + at_, sizeof number);
    at_ += sizeof number;
    return number;
  }
  template <class Numbers>
  void read_all(Numbers& numbers) {
    for (int& number : numbers) number = next<int>();
  }

  const Json info_;
  std::vector<unsigned char> bytes_;
  std::size_t at_ = 0;
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
  EXPECT_EQ(packed.info["dimension"], 2);
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
  Unpacker unpacker(pack_mesh(mesh, {}, true));
  const Mesh read = unpacker.run();
  ASSERT_EQ(unpacker.entities.size(), mesh.quads.size() + mesh.lines.size());
  for (std::size_t q = 0; q < read.quads.size(); ++q) {
    double x = 0;
    for (const int v : read.quads[q]) x += read.points[v].x / 4;
    EXPECT_EQ(unpacker.entities[q], x < 3 ? 1 : 0);
  }
  EXPECT_EQ(std::vector<int>(unpacker.entities.end() - 24, unpacker.entities.end()), mesh.line_curve);
}

TEST(PackedMesh, ReadsBackTrianglesInSpaceWithAllTheyHave) {
  Mesh mesh = triangle_grid(4, 4, 4, 4);
  for (Vec3& p : mesh.points) p = {p.x - 3, p.y + 1e6, p.x * p.y};
  std::swap(mesh.triangles[0], mesh.triangles[20]);
  const PackedMesh packed = pack_mesh(mesh);
  EXPECT_EQ(packed.info["dimension"], 3);
  Unpacker unpacker(packed);
  expect_same(unpacker.run(), mesh, 0.25);
}

TEST(PackedMesh, JoinsTheNodesOfCurvedElements) {
  const Mesh mesh = curved_grid(3, 2, 3, true);
  const PackedMesh packed = pack_mesh(mesh);
  EXPECT_EQ(packed.info["order"], 3);
  EXPECT_EQ(packed.info["lines"], 3 * mesh.lines.size());
  Unpacker unpacker(packed);
  const Mesh unpacked = unpacker.run();
  ASSERT_EQ(unpacker.polygons.size(), mesh.quads.size());
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto is_same = [&](const std::vector<int>& polygon) {
      const std::vector<int> nodes = nodes_around(mesh, q);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        if (norm(unpacked.points[polygon[k]] - mesh.points[nodes[k]]) > kExact) return false;
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
  EXPECT_EQ(packed.info["irregular"], 4u);
  Unpacker unpacker(packed);
  const Mesh read = unpacker.run();
  ASSERT_EQ(unpacker.pairs.size(), 2u);
  for (const auto& [few, many] : unpacker.pairs) {
    EXPECT_NEAR(read.points[few].x, 3, kExact);
    EXPECT_NEAR(norm(read.points[few] - read.points[many]), 1, 2 * kExact);
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
  EXPECT_EQ(unpacker.irregular[0][1], 3);
  EXPECT_LT(norm(read.points[unpacker.irregular[0][0]]), kExact);
  std::vector<int> expected;
  for (const double eta : quad_etas(mesh)) expected.push_back(static_cast<int>(128 * eta));
  std::sort(expected.begin(), expected.end());
  std::sort(unpacker.eta.begin(), unpacker.eta.end());
  EXPECT_EQ(unpacker.eta, expected);
}

TEST(PackedMesh, OfNothingAndOfOnePlace) {
  EXPECT_EQ(pack_mesh({}).info["points"], 0u);
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

}  // namespace
}  // namespace delquad
