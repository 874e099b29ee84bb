// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

using Facet = std::array<std::array<float, 3>, 3>;

const std::vector<Facet> kStlTetrahedron = {{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                                            {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                            {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                            {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

std::string text_file(const std::vector<Facet>& facets, const std::string& name = "part one") {
  std::string text = "solid " + name + "\n";
  for (const Facet& facet : facets) {
    text += " facet normal nan 0 1e0\n  outer loop\n";
    for (const auto& p : facet) {
      text += "   vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) +
              "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

std::string bytes_of(std::uint32_t value) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k) & 255);
  return bytes;
}

std::string binary_file(const std::vector<Facet>& facets, std::string header = "made by a test") {
  header.resize(80);
  std::string bytes = header + bytes_of(static_cast<std::uint32_t>(facets.size()));
  for (const Facet& facet : facets) {
    bytes += std::string(12, '\xff');  // a normal that is not a number
    for (const auto& p : facet) {
      for (const float x : p) bytes += bytes_of(std::bit_cast<std::uint32_t>(x));
    }
    bytes += "\x01\x80";
  }
  return bytes;
}

class Stl : public testing_support::ReaderTest<> {
 protected:
  Stl() : ReaderTest("case.stl") {}
  void check(const Mesh& mesh) override {
    for (const Vec3& p : mesh.points) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  }
};

TEST_F(Stl, TextAndBinaryGiveOneClosedMesh) {
  const std::string solid_header = "solid as some programs write it";
  for (const std::string& content : {text_file(kStlTetrahedron), binary_file(kStlTetrahedron),
                                     binary_file(kStlTetrahedron, solid_header)}) {
    const Mesh mesh = read(content);
    EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}}));
    EXPECT_EQ(check_invariants(mesh), Strings{});
  }
}

TEST_F(Stl, KeywordsInAnyCaseWithoutANameAndWithNegativeZeros) {
  const Mesh mesh = read(
      "SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\n"
      "Facet Normal 0 0 1\nOuter Loop\nVertex 1 0 -0.0\nVertex 1 1 0\nVertex -0 1 "
      "0\nEndLoop\nEndFacet\nEndSolid");
  EXPECT_EQ(mesh.points.size(), 4u);
  ASSERT_EQ(mesh.regions.size(), 1u);
  EXPECT_TRUE(mesh.regions[0].names.empty());
}

TEST_F(Stl, EndsInTwoWordsCommentsAndByteOrderMarks) {
  const std::string text =
      "# by hand\nsolid a # b\n// a facet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0 # first\nvertex 1 0 "
      "0\n"
      "vertex 0 1 0\nend loop\nEnd Facet\nend solid a\nsolid\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\n"
      "vertex 1 1 0\nvertex 0 1 0\nendloop\nend facet\nend solid";
  std::string wide = "\xff\xfe", wide_big = "\xfe\xff";
  for (const char c : text) {
    wide += {c, '\0'};
    wide_big += {'\0', c};
  }
  for (const std::string& content : {text, "\xef\xbb\xbf" + text, wide, wide_big}) {
    const Mesh mesh = read(content);
    EXPECT_EQ(mesh.points.size(), 4u);
    EXPECT_EQ(mesh.triangle_region, (std::vector<int>{0, 1}));
  }
  expect_error("solid a\nend facet\n", {"case.stl:2: ", "'endsolid'", "'endfacet'"});
}

TEST_F(Stl, NamesInOtherEncodingsBecomeUtf8) {
  const auto name = [&](const std::string& bytes) {
    return read(text_file(kStlTetrahedron, bytes)).regions.at(0).names.at(0);
  };
  EXPECT_EQ(name("Stra\xc3\x9f"
                 "e"),
            "Stra\xc3\x9f"
            "e");
  EXPECT_EQ(name("Stra\xdf"
                 "e"),
            "Stra\xc3\x9f"
            "e")
      << "Latin-1";
  EXPECT_EQ(name("\xc0\xaf\xed\xa0\x80"), "\xc3\x80\xc2\xaf\xc3\xad\xc2\xa0\xc2\x80")
      << "no UTF-8: overlong, a surrogate";
}

TEST_F(Stl, PointsThatDwarfTheRestAreRefused) {
  for (const float far : {1e30f, -3e38f, 6e4f}) {
    auto facets = kStlTetrahedron;
    facets.push_back({{{1, 0, 0}, {0, 1, 0}, {0, far, 1}}});
    facets.push_back({{{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    expect_error(text_file(facets), {"case.stl:34: the point (0, ", "times as far out as the others"});
    expect_error(binary_file(facets), {"case.stl: byte 320: ", "times as far out"});
    const Mesh kept = read_mesh(folder_ / "case.stl", nullptr, Strays::kKept);
    EXPECT_EQ(kept.triangles.size(), 6u);
  }
  auto facets = kStlTetrahedron;
  facets.push_back({{{1, 0, 0}, {0, 1, 0}, {0, 5e3f, 1}}});
  facets.push_back({{{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  EXPECT_TRUE(reads(binary_file(facets))) << "a spike";
  for (const char* bad : {"nan", "-inf", "1e999"}) {
    const std::string text =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 " + std::string(bad) +
        " 0\nendloop\nendfacet\nendsolid a\n";
    expect_error(text, {"case.stl:6: ", "finite", bad});
    for (const Vec3& p : read_mesh(folder_ / "case.stl", nullptr, Strays::kKept).points)
      EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  }
}

TEST_F(Stl, EachSolidOfATextIsARegion) {
  const Mesh mesh =
      read(text_file({kStlTetrahedron[0]}, "left wing") + text_file({kStlTetrahedron[3]}, "right"));
  ASSERT_EQ(mesh.regions.size(), 2u);
  EXPECT_EQ(mesh.regions[0].names, (Strings{"left wing"}));
  EXPECT_EQ(mesh.regions[1].tag, 2);
  EXPECT_EQ(mesh.triangle_region, (std::vector<int>{0, 1}));
}

TEST_F(Stl, NamesBecomeUtf8) {
  const auto name_of = [&](const std::string& bytes) {
    return read(text_file(kStlTetrahedron, bytes)).regions[0].names[0];
  };
  EXPECT_EQ(name_of("caf\xC3\xA9"), "caf\u00E9");
  EXPECT_EQ(name_of("caf\xE9"), "caf\u00E9");
}

TEST_F(Stl, NamesTheLineOrByteOfWhatIsWrong) {
  expect_error("", {"case.stl", "0 bytes"});
  expect_error("solid a\nendsolid a\n", {"case.stl", "no triangles"});
  expect_error(binary_file({}), {"case.stl", "no triangles"});
  expect_error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\n",
               {"case.stl:5: ", "coordinate", "'endloop'"});
  expect_error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
               {"case.stl:4: ", "finite", "'nan'"});
  expect_error("solid a\nfoo\n", {"case.stl:2: ", "'endsolid'", "'foo'"});
  std::string four = text_file({kStlTetrahedron[0]});
  four.insert(four.find("  endloop"), "vertex 5 5 5\n");
  expect_error(four, {"case.stl:7: ", "'endloop'", "'vertex'"});

  const std::string binary = binary_file(kStlTetrahedron);
  expect_error(binary.substr(0, 100), {"100 bytes", "4 triangles", "284"});
  expect_error(binary + "x", {"285 bytes", "4 triangles", "284"});
  expect_error("solid " + binary.substr(6, 150), {"156 bytes", "4 triangles"});
  const float nan = std::nanf("");
  expect_error(binary_file({kStlTetrahedron[0], {{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}}}),
               {"byte 174: ", "finite"});
  std::string huge = binary;
  huge.replace(80, 4, "\xff\xff\xff\xff");
  expect_error(huge, {"4294967295 triangles"});
}

TEST_F(Stl, EveryTruncationIsRefused) {
  expect_whole(text_file(kStlTetrahedron, "t"), std::string(" t\n").size() + 1);
  expect_whole(binary_file(kStlTetrahedron));
}

TEST_F(Stl, FlippedBitsAreReadOrRefused) {
  for (const std::string& content : {text_file(kStlTetrahedron), binary_file(kStlTetrahedron)})
    try_flipped_bits(content, 400, 0);
}

}  // namespace
}  // namespace delquad
