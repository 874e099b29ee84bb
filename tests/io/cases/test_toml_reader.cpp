// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/toml_reader.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

class TomlReader : public testing::Test {
 protected:
  TomlTable read(const std::string& text) { return TomlTable::read(write_text(folder_ / "in.toml", text)); }
  Folder folder_;
};

TEST_F(TomlReader, GivesTypedValues) {
  const TomlTable table = read(
      "n = 3\nx = 2.5\nt = 'text'\nf = true\np = [1, 2.5]\nps = [[0, 1], [2, 3]]\nl = ['a', 'b']\n"
      "[sub]\ny = 1\n[[many]]\nk = 1\n[[many]]\nk = 2\n");
  EXPECT_EQ(table.get<long long>("n"), 3);
  EXPECT_EQ(table.number("n"), 3);
  EXPECT_EQ(table.number("x"), 2.5);
  EXPECT_EQ(table.get("absent", 7.0), 7);
  EXPECT_EQ(table.text("t"), "text");
  EXPECT_TRUE(table.get("f", false));
  EXPECT_EQ(table.get<Vec2>("p"), (Vec2{1, 2.5}));
  EXPECT_EQ(table.get<std::vector<Vec2>>("ps"), (std::vector<Vec2>{{0, 1}, {2, 3}}));
  EXPECT_EQ(table.texts("l"), (Strings{"a", "b"}));
  EXPECT_EQ(table.table("sub").number("y"), 1);
  EXPECT_FALSE(table.optional_table("absent"));
  ASSERT_EQ(table.tables("many").size(), 2u);
  EXPECT_EQ(table.tables("many")[1].get<int>("k"), 2);
  EXPECT_EQ(table.tables("sub").size(), 1u);
  EXPECT_EQ(table.expression("x"), "2.5");
  EXPECT_EQ(table.expression("t"), "text");
  EXPECT_TRUE(table.where("x").ends_with("in.toml:2"));
}

TEST_F(TomlReader, MistakesNameFileLineKeyAndWhatWasExpected) {
  const TomlTable table = read("n = 3.5\nt = 4\np = [1]\nps = [[0, 1], 2]\nx = inf\nl = [1]\n[s]\ny = -1\n");
  expect_input_error([&] { table.get<long long>("n"); }, {"in.toml:1", "'n'", "integer"});
  expect_input_error([&] { table.text("t"); }, {"in.toml:2", "'t'", "text"});
  expect_input_error([&] { table.get<Vec2>("p"); }, {"in.toml:3", "'p'", "[x, y]"});
  expect_input_error([&] { table.get<std::vector<Vec2>>("ps"); }, {"in.toml:4", "'ps'", "[[x, y], ...]"});
  expect_input_error([&] { table.number("x"); }, {"in.toml:5", "'x'", "finite"});
  expect_input_error([&] { table.texts("l"); }, {"in.toml:6", "'l'", "texts"});
  expect_input_error([&] { table.table("n"); }, {"in.toml:1", "table"});
  expect_input_error([&] { table.tables("l"); }, {"in.toml:6", "list of tables"});
  expect_input_error([&] { table.table("s").number("z"); }, {"in.toml:7", "'s.z'", "missing"});
  expect_input_error([&] { read("a = 1\na = 2\n"); }, {"in.toml:2", "not TOML"});
  expect_input_error([&] { TomlTable::read(folder_ / "none.toml"); }, {"none.toml", "No such file"});
  expect_input_error([&] { TomlTable::read(folder_.path()); }, {"folder"});
}

TEST_F(TomlReader, UnknownKeysGetTheNearestKnownOne) {
  const TomlTable table = read("[s]\nrejektion = 1\n");
  table.require_known({{"s", ""}, {"t", ""}});
  expect_input_error(
      [&] {
        table.table("s").require_known({{"rejection", ""}, {"h_max", ""}});
      },
      {"in.toml:2", "'s.rejektion'", "did you mean 'rejection'?"});
  const TomlTable far = read("completely_different = 1\n");
  expect_input_error(
      [&] {
        far.require_known({{"size", ""}});
      },
      {"'completely_different'", "known here: size"});
}

TEST(NearestName, CountsSwapsAsOne) {
  EXPECT_EQ(nearest_name("szie", {"cross", "size"}), "size");
  EXPECT_EQ(nearest_name("boundry", {"region", "boundary"}), "boundary");
  EXPECT_EQ(nearest_name("qqqqqqqq", {"region", "boundary"}), std::nullopt);
  EXPECT_EQ(nearest_name("x", {}), std::nullopt);
  EXPECT_EQ(suggestion("szie", {"cross", "size"}), "; did you mean 'size'?");
  const Strings entities{"curve_1", "curve_10", "region_10"};
  EXPECT_EQ(suggestion("face_10", entities), "; did you mean 'region_10'?");
  EXPECT_EQ(suggestion("edge_10", entities), "; did you mean 'curve_10'?");
  EXPECT_EQ(suggestion("1", entities), "; did you mean 'curve_1'?");
  EXPECT_EQ(suggestion("qqqqqqqq", {"size"}), "");
  EXPECT_EQ(suggestion_or_all("szie", {"size"}), "; did you mean 'size'?");
  EXPECT_EQ(suggestion_or_all("qqqqqqqq", {"wall", "b", "wall", ""}), "; there are 'b', 'wall'");
  EXPECT_EQ(suggestion_or_all("qqqqqqqq", {}), "");
}

}  // namespace
}  // namespace delquad
