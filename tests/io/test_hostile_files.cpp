// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/reader_seeds.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

// Small files that ask for much, and numbers that no type holds. Each was found by fuzzing.

std::string vtu(const std::string& types, const std::string& names = "") {
  return R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece><Points><DataArray type="Float32">)"
         R"(0 0 0 1 0 0 0 1 0</DataArray></Points><Cells><DataArray Name="connectivity">0 1 2 0</DataArray>)"
         R"(<DataArray Name="offsets">3 4</DataArray><DataArray Name="types">)" +
         types + "</DataArray></Cells></Piece>" + names + "</UnstructuredGrid></VTKFile>";
}

TEST(HostileVtu, ElementsInElementsAreNotFollowed) {
  const Folder folder;
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) deep += "<a>";
  expect_input_error([&] { read_mesh(write_text(folder / "a.vtu", deep)); }, {"a.vtu", "levels"});
}

TEST(HostileVtu, NumbersThatAreNoIntAreNoTypesAndTags) {
  const Folder folder;
  EXPECT_EQ(read_mesh(write_text(folder / "a.vtu", vtu("5 1"))).triangles.size(), 1u);
  for (const char* type : {"nan", "1e300", "-1e300", "inf"})
    expect_input_error([&] { read_mesh(write_text(folder / "a.vtu", vtu(std::string(type) + " 1"))); },
                       {"a.vtu", "cell"});
  const Mesh mesh = read_mesh(
      write_text(folder / "a.vtu",
                 vtu("5 1", R"(<FieldData><DataArray Name="region n">1e300 nan 1</DataArray></FieldData>)")));
  EXPECT_EQ(mesh.regions[0].names, Strings{"n"});
}

/// Each line doubles the set: fifty would be more numbers than any memory holds.
TEST(HostileInp, SetsThatHoldThemselvesDoNotGrow) {
  const Folder folder;
  std::string text =
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=S3, ELSET=a\n1, 1, 2, 3\n*ELSET, ELSET=a\n";
  for (int i = 0; i < 50; ++i) text += "a, a\n";
  const Mesh mesh = read_mesh(write_text(folder / "a.inp", text));
  EXPECT_EQ(mesh.regions[0].names, Strings{"a"});
}

TEST(HostileInp, StepsEndWithTheLastElement) {
  const Folder folder;
  const std::string text =
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=S3\n7, 1, 2, 3\n*ELSET, ELSET=a, GENERATE\n";
  const auto read = [&](const std::string& range) {
    return read_mesh(write_text(folder / "a.inp", text + range + "\n"));
  };
  EXPECT_EQ(read("7, 9223372036854775807, 9223372036854775807").regions[0].names, Strings{"a"});
  EXPECT_EQ(read("7, 7").regions[0].names, Strings{"a"});
  EXPECT_TRUE(read("7, 6").regions[0].names.empty());
}

TEST(HostilePly, ColoursThatAreNoNumbersAreNone) {
  const Folder folder;
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 1\nproperty list uchar uchar vertex_indices\nproperty float red\nproperty float "
      "green\nproperty float blue\nend_header\n";
  const auto put = [&](float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int k = 0; k < 32; k += 8) text += static_cast<char>(bits >> k & 255);
  };
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) put(x);
  text += std::string("\3\0\1\2", 4);
  for (const float part : {NAN, 1.f, 1.f}) put(part);
  EXPECT_TRUE(read_mesh(write_text(folder / "a.ply", text)).regions[0].names.empty());
}

TEST(HostilePly, NamesAreShownInPrint) {
  const Folder folder;
  try {
    read_mesh(write_text(
        folder / "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float \x01\x02\nelement face 0\nend_header\n0 0 0"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(std::ranges::none_of(std::string(error.what()), [](char c) { return c < ' '; }))
        << error.what();
  }
}

std::string three_mf(const std::string& resources, const std::string& build) {
  return fuzz::archive_of("<model><resources>" + resources + "</resources><build>" + build +
                          "</build></model>");
}

TEST(HostileThreeMf, PlacesAreFinite) {
  const Folder folder;
  const std::string object =
      R"(<object id="1"><mesh><vertices><vertex x="1e300" y="0" z="0"/><vertex x="1" y="0" z="0"/>)"
      R"(<vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>)";
  const auto read = [&](const std::string& transform) {
    return read_mesh(write_text(folder / "a.3mf",
                                three_mf(object, "<item objectid=\"1\" transform=\"" + transform + "\"/>")));
  };
  EXPECT_EQ(read("1 0 0 0 1 0 0 0 1 0 0 0").triangles.size(), 1u);
  expect_input_error([&] { read("1e300 0 0 0 1 0 0 0 1 0 0 0"); }, {"a.3mf", "finite"});
}

/// Points count, too, where objects hold one another.
TEST(HostileThreeMf, PointsThatMultiplyAreRefused) {
  const Folder folder;
  std::string resources = R"(<object id="0"><mesh><vertices>)";
  for (int i = 0; i < 1000; ++i) resources += R"(<vertex x="0" y="0" z="0"/>)";
  resources += R"(</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>)";
  for (int i = 1; i <= 16; ++i) {
    const std::string part = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    resources +=
        "<object id=\"" + std::to_string(i) + "\"><components>" + part + part + "</components></object>";
  }
  expect_input_error(
      [&] { read_mesh(write_text(folder / "a.3mf", three_mf(resources, "<item objectid=\"16\"/>"))); },
      {"a.3mf", "more than"});
}

}  // namespace
}  // namespace delquad
