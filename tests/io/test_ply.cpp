// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

const std::string kPlySquare =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

class Ply : public testing_support::ReaderTest<> {
 protected:
  Ply() : ReaderTest("case.ply") {}
};

/// Numbers as bytes of either order.
class Bytes {
 public:
  explicit Bytes(bool big) : big_(big) {}
  template <class T>
  Bytes& operator<<(T value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_ != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
    text.append(raw.data(), raw.size());
    return *this;
  }
  std::string text;

 private:
  bool big_;
};

/// Two quads over six points, with what scanners put beside: confidence before x, doubles, colors, edges.
std::string binary(bool big) {
  Bytes bytes(big);
  for (int i = 0; i < 6; ++i)
    bytes << 0.5f << static_cast<double>(i % 3) << static_cast<double>(i / 3) << 0.0 << std::uint8_t{7};
  for (const auto& quad : {std::array{0, 1, 4, 3}, {1, 2, 5, 4}}) {
    bytes << std::uint8_t{2} << 1.5f << 2.5f << std::uint8_t{4};
    for (const int v : quad) bytes << static_cast<std::int16_t>(v);
    for (const int c : {255, quad[0], 16}) bytes << static_cast<std::uint8_t>(c);
  }
  bytes << 0 << 1;
  return std::string("ply\nformat binary_") + (big ? "big" : "little") +
         "_endian 1.0\nelement vertex 6\nproperty float confidence\nproperty double x\nproperty double y\n"
         "property double z\nproperty uchar red\nelement face 2\nproperty list uint8 float32 texcoord\n"
         "property list uint8 int16 vertex_index\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n" +
         bytes.text;
}

TEST_F(Ply, ReadsText) {
  const Mesh mesh = read(kPlySquare);
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.regions.size(), 1u);
  EXPECT_TRUE(mesh.regions[0].names.empty());
  EXPECT_EQ(check_invariants(mesh), Strings{});
}

TEST_F(Ply, ReadsBytesOfBothOrders) {
  for (const bool big : {false, true}) {
    const Mesh mesh = read(binary(big));
    EXPECT_EQ(mesh.points,
              (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}));
    EXPECT_EQ(mesh.quads, (Quads{{0, 1, 4, 3}, {1, 2, 5, 4}}));
    ASSERT_EQ(mesh.regions.size(), 2u) << "by colour";
    EXPECT_EQ(mesh.regions[0].names, Strings{"colour #ff0010"});
    EXPECT_EQ(mesh.regions[1].names, Strings{"colour #ff0110"});
    EXPECT_EQ(mesh.quad_region, (std::vector<int>{0, 1}));
  }
}

TEST_F(Ply, ColoursThatPaintAPictureAreNoRegions) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 100\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  for (int i = 0; i < 100; ++i) text += "3 0 1 2 0 0 " + std::to_string(i) + '\n';
  ReadNotes notes;
  const Mesh mesh = read_mesh(write_text(folder_ / "case.ply", text), &notes);
  EXPECT_EQ(mesh.regions.size(), 1u);
  EXPECT_EQ(mesh.triangle_region, std::vector<int>(100, 0));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(holds(notes[0], "100 colors"));
}

TEST_F(Ply, NamesThePlaceOfWhatIsWrong) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kPlySquare;
    return text.replace(text.find(from), from.size(), to);
  };
  expect_error("", {"case.ply:1: ", "PLY"});
  expect_error(with("ascii", "asci"), {"case.ply:2: ", "binary_little_endian", "'asci'"});
  expect_error(with("format ascii 1.0\n", ""), {"case.ply:", "no line 'format'"});
  expect_error(with("float x", "flaot x"), {"case.ply:5: ", "'flaot'"});
  expect_error(with("float x", "float a"), {"no property 'x'"});
  expect_error(with("element vertex 4", "element vertx 4"), {"no element 'vertex'"});
  expect_error(with("element vertex 4", "element vertex 2000000000"), {"2000000000", "do not fit"});
  expect_error(with("list uchar", "list float"), {"case.ply:9: ", "integer type"});
  expect_error(with("1 1 0", "1 nan 0"), {"case.ply:13: ", "finite", "'nan'"});
  expect_error(with("3 0 2 3", "3 0 2 4"), {"case.ply:16: ", "from 0 to 3", "found 4"});
  expect_error(with("3 0 2 3", "9000 0 2 3"), {"case.ply:16: ", "9000"});
  expect_error(with("element face 2", "element face 0"), {"'face': 0", "16 bytes follow"});
  expect_error(with("element face 2", "element face 1"), {"case.ply:16: ", "'face': 1", "8 bytes follow"});
  expect_error(with("element face 2", "element face 3"), {"case.ply:17: ", "3 elements 'face'", "2 follow"});
  expect_error(with("element vertex 4", "element vertex 3"),
               {"case.ply:14: ", "element 1 of 2 'face'", "'vertex': 3"});
  expect_error(with("element vertex 4", "element vertex 5"),
               {"case.ply:15: ", "element 5 of 5 'vertex'", "'vertex': 5"});
  expect_error(binary(false) + std::string("\3\0", 2), {"'face': 2", "2 bytes follow"});
  EXPECT_TRUE(reads(binary(true) + std::string("\n\0\0", 3)));
  EXPECT_TRUE(reads(with("1 0 0\n", "# a corner\n1 0 0 # here\n") + "# the end\n"));
  expect_error(with("vertex_indices", "corners"), {"case.ply:15: ", "face of 0 vertices"});
}

TEST_F(Ply, EveryTruncationIsRefused) {
  expect_whole(kPlySquare, 2);
  for (const bool big : {false, true}) expect_whole(binary(big));
}

TEST_F(Ply, FlippedBitsAreReadOrRefused) {
  for (const std::string& whole : {kPlySquare, binary(false), binary(true)})
    try_flipped_bits(whole, 500, 0.25);
}

}  // namespace
}  // namespace delquad
