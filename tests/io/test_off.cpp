// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

const std::string kSquare = "OFF\n4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

class Off : public testing_support::ReaderTest<> {
 protected:
  Off() : ReaderTest("case.off") {}
};

TEST_F(Off, ReadsPlainFiles) {
  const Mesh mesh = read(kSquare);
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(check_invariants(mesh), Strings{});
}

TEST_F(Off, IgnoresCommentsColoursNormalsAndUnusedPoints) {
  const Mesh mesh = read(
      "# made by hand\nCNOFF # colours and normals\n\n5 2 0 # counts\n# points\n0 0 0 0 0 1 255 0 0 255\n"
      "9 9 9 0 0 1 1 1 1 1\n1 0 0 0 0 1 .5 .5 .5 1 # a point\n\n1 1 0 0 0 1 1 1 1 1\n0 1 0 0 0 1 1 1 1 1\n"
      "4 0 2 3 4 255 0 0\n# a triangle\n3 0 2 3 0.5 0.5 0.5 # red\n# the end");
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.quads, (Quads{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
}

TEST_F(Off, CountsMayFollowTheKeyword) { EXPECT_TRUE(reads("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2")); }

TEST_F(Off, NamesTheLineOfWhatIsWrong) {
  const std::string points = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  expect_error("", {"case.off:1: ", "'OFF'"});
  expect_error("ply\n", {"case.off:1: ", "holds a PLY file", "expected OFF"});
  expect_error("4OFF\n", {"case.off:1: ", "three coordinates", "'4OFF'"});
  expect_error("OFF BOTH\n", {"case.off:1: ", "'BINARY'"});
  expect_error("OFF\n3 x 0\n", {"case.off:2: ", "number of faces", "'x'"});
  expect_error("OFF\n-3 1 0\n", {"case.off:2: ", "'-3'"});
  expect_error("OFF\n2000000000 1 0\n0 0 0\n", {"case.off:2: ", "2000000000 vertices", "bytes"});
  expect_error("OFF\n3 2000000000 0\n0 0 0\n", {"case.off:2: ", "2000000000 faces", "bytes"});
  expect_error("OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"case.off:3: ", "three coordinates"});
  expect_error("OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", {"case.off:3: ", "finite", "'nan'"});
  expect_error(points + "3 0 1 3\n", {"case.off:6: ", "from 0 to 2", "'3'"});
  expect_error(points + "3 0 -1 2\n", {"case.off:6: ", "'-1'"});
  expect_error(points + "5 0 1 2 0 1\n", {"case.off:6: ", "face of 5 vertices", "triangle"});
  expect_error(points + "2 0 1    \n", {"case.off:6: ", "face of 2 vertices"});
  expect_error(points + "3 0 1 2\n3 0 1 2\n",
               {"case.off:7: ", "end of the file after 3 vertices and 1 faces"});
  expect_error("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n# end\n",
               {"3 vertices and 2 faces", "but 1 faces"});
  expect_error("OFF\n2 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"case.off:5: ", "number of vertices", "(2)"});
  expect_error("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"case.off:2: ", "4 vertices and 1 faces"});
  expect_error("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", {"case.off:", "no faces"});
}

/// Words of four bytes, the highest first.
std::string words(std::initializer_list<std::uint32_t> values) {
  std::string bytes;
  for (const std::uint32_t value : values)
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}
constexpr std::uint32_t kOne = 0x3f800000, kNaN = 0x7fc00000;  // as float

TEST_F(Off, ReadsBytes) {
  const std::string points = words({4, 2, 5, 0, 0, 0, kOne, 0, 0, kOne, kOne, 0, 0, kOne, 0});
  const std::string faces = words({3, 0, 1, 2, 0, 3, 0, 2, 3, 3, kOne, 0, 0});  // the second in red
  const Mesh plain = read(kSquare), mesh = read("OFF BINARY\n" + points + faces);
  EXPECT_EQ(mesh.points, plain.points);
  EXPECT_EQ(mesh.triangles, plain.triangles);
  const std::string with_normals =
      words({3, 1, 3, 0, 0, 0, 0, 0, kOne, kOne, 0, 0, 0, 0, kOne, 0, kOne, 0, 0, 0, kOne, 3, 0, 1, 2, 0});
  EXPECT_EQ(read("NOFF BINARY\n" + with_normals).points,
            (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  const std::string whole = "OFF BINARY\n" + points + faces;
  expect_whole(whole);
}

TEST_F(Off, ReadsLittleEndianBytesWithoutColors) {
  std::string bytes =
      words({4, 2, 5, 0, 0, 0, kOne, 0, 0, kOne, kOne, 0, 0, kOne, 0, 3, 0, 1, 2, 3, 0, 2, 3});
  for (size_t i = 0; i < bytes.size(); i += 4) std::reverse(bytes.begin() + i, bytes.begin() + i + 4);
  const Mesh plain = read(kSquare), mesh = read("OFF BINARY\n" + bytes);
  EXPECT_EQ(mesh.points, plain.points);
  EXPECT_EQ(mesh.triangles, plain.triangles);
}

TEST_F(Off, NamesTheByteOfWhatIsWrong) {
  const std::string head = "OFF BINARY\n";
  expect_error(head + words({2000000000, 1, 0}), {"case.off: byte 15: ", "2000000000", "8 bytes"});
  expect_error(head + words({1, 0, 0, kNaN, 0, 0}), {"case.off: byte 27: ", "nan", "finite"});
  expect_error(head + words({1, 1, 0, 0, 0, 0, 3, 0, 1, 2, 0}),
               {"case.off: byte 47: ", "below 1", "found 1"});
  expect_error(head + words({1, 1, 0, 0, 0, 0, 4000000000, 0, 0}), {"byte 39: ", "4000000000"});
}

TEST_F(Off, DamageIsReadOrRefused) {
  expect_whole(kSquare, 2);
  try_flipped_bits(kSquare, 500, 0.5);
}

TEST_F(Off, IsNamedAmongTheKnownFormats) {
  expect_input_error([&] { read_mesh(folder_ / "case.xyz"); }, {".msh", ".obj", ".off", ".stl", "'.xyz'"});
}

}  // namespace
}  // namespace delquad
