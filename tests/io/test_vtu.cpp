// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/formats/vtu.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// The bytes of the DataArray of that name, decoded, after its length.
std::string array_bytes(const std::string& xml, const std::string& name) {
  const size_t tag = xml.find("Name=\"" + name + "\""), first = xml.find('>', tag) + 1,
               last = xml.find('<', first);
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t held = 0;
  int bits = 0;
  EXPECT_EQ((last - first) % 4, 0u);
  for (size_t i = first; i < last && xml[i] != '='; ++i) {
    held = held << 6 | static_cast<std::uint32_t>(digits.find(xml[i]));
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 255);
  }
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof length);
  EXPECT_EQ(length, bytes.size() - sizeof length) << name;
  return bytes.substr(sizeof length);
}

template <class T>
std::vector<T> array(const std::string& xml, const std::string& name) {
  const std::string bytes = array_bytes(xml, name);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(Vtu, HoldsCellsAndTheirData) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1, 0.1, 3);
  mesh.triangles = {{0, 1, 3}};
  mesh.triangle_region = {0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  write_vtu(folder / "a.vtu", mesh, {{"a < b", {1, 2, 3, 4, nan, 0.1}}});
  const std::string xml = read_text(folder / "a.vtu");
  EXPECT_TRUE(holds(xml, "NumberOfPoints=\"4\" NumberOfCells=\"6\""));
  EXPECT_EQ(array<double>(xml, "Points"), (std::vector<double>{0, 0, 0, 0.1, 0, 0, 0, 3, 0, 0.1, 3, 0}));
  EXPECT_EQ(array<std::int64_t>(xml, "connectivity"),
            (std::vector<std::int64_t>{0, 1, 1, 3, 3, 2, 2, 0, 0, 1, 3, 0, 1, 3, 2}));
  EXPECT_EQ(array<std::int64_t>(xml, "offsets"), (std::vector<std::int64_t>{2, 4, 6, 8, 11, 15}));
  EXPECT_EQ(array<std::uint8_t>(xml, "types"), (std::vector<std::uint8_t>{3, 3, 3, 3, 5, 9}));
  EXPECT_EQ(array<std::int32_t>(xml, "curve"), (std::vector<std::int32_t>{1, 2, 3, 4, 0, 0}));
  EXPECT_EQ(array<std::int32_t>(xml, "region"), (std::vector<std::int32_t>{0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(array<std::int32_t>(xml, "curve east"), (std::vector<std::int32_t>{2}));
  EXPECT_EQ(array<std::int32_t>(xml, "region inside"), (std::vector<std::int32_t>{1}));
  const auto data = array<double>(xml, "a &lt; b");
  ASSERT_EQ(data.size(), 6u);
  EXPECT_TRUE(std::isnan(data[4]));
  EXPECT_EQ(data[5], 0.1);
}

TEST(Vtu, NeedsOneValueForEachCell) {
  const Folder folder;
  EXPECT_THROW(write_vtu(folder / "a.vtu", quad_grid(1, 1), {{"short", {1}}}), std::invalid_argument);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Vtu, KeepsNamesOfPoints) {
  const Folder folder;
  Mesh mesh = quad_grid(2, 1);
  mesh.named_points = {{4, {7, {"sensor", "tip < 1"}}}, {1, {8, {}}}, {0, {9, {"sensor"}}}};
  write_vtu(folder / "a.vtu", mesh);
  const std::string xml = read_text(folder / "a.vtu");
  EXPECT_EQ(array<std::int32_t>(xml, "point sensor"), (std::vector<std::int32_t>{4, 0}));
  EXPECT_EQ(array<std::int32_t>(xml, "point tip &lt; 1"), (std::vector<std::int32_t>{4}));
  const Mesh read = read_mesh(folder / "a.vtu");
  ASSERT_EQ(read.named_points.size(), 2u);
  EXPECT_EQ(read.named_points[0].point, 4);
  EXPECT_EQ(read.named_points[0].entity.names, (Strings{"sensor", "tip < 1"}));
  EXPECT_EQ(read.named_points[1].point, 0);
  EXPECT_EQ(read.named_points[1].entity.names, (Strings{"sensor"}));
}

TEST(Vtu, NamesOfPointsThatAreNotThereAreAnError) {
  const Folder folder;
  Mesh mesh = quad_grid(2, 1);
  mesh.named_points = {{6, {1, {"far"}}}};
  write_vtu(folder / "a.vtu", mesh);
  expect_input_error([&] { read_mesh(folder / "a.vtu"); }, {"a.vtu", "far", "point 6", "there are 6"});
}

}  // namespace
}  // namespace delquad
