// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/option_table.h"
#include "io/cases/case_keys.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

enum class Colour { kRed, kBlue };
struct Inner {
  double depth = 0.5;
};
struct Everything {
  bool flag = true;
  int count = 3;
  long long seed = 4;
  std::string name = "x";
  Colour colour = Colour::kBlue;
  Inner inner;
};

/// A group that is not among the registered ones is read all the same: only setting goes by these.
TEST(OptionTables, DeclareAndReadEveryKindOfMember) {
  const auto table =
      OptionTable<Everything>("everything", "of a test")
          .add({.name = "flag"}, &Everything::flag)
          .add({.name = "count"}, &Everything::count)
          .add({.name = "seed"}, &Everything::seed)
          .add({.name = "name"}, &Everything::name)
          .choice({.name = "colour"}, &Everything::colour,
                  std::vector<std::pair<std::string, Colour>>{{"red", Colour::kRed}, {"blue", Colour::kBlue}})
          .add(
              {.name = "depth"}, [](auto& e) -> auto& { return e.inner.depth; });
  const OptionGroup group = table.group();
  const std::vector<OptionValue> defaults = {true, 3, 4, "x", "blue", 0.5};
  ASSERT_EQ(group.keys.size(), defaults.size());
  for (std::size_t i = 0; i < defaults.size(); ++i) EXPECT_EQ(group.keys[i].value, defaults[i]) << i;
  EXPECT_EQ(group.keys[1].most, std::numeric_limits<int>::max());
  EXPECT_FALSE(group.keys[2].most);
  EXPECT_EQ(table.read({}).inner.depth, 0.5);
  add_options(group);
  Options options;
  options.set("everything.flag", false).set("everything.count", 7).set("everything.seed", 1LL << 40);
  options.set("everything.name", "y").set("everything.colour", "red").set("everything.depth", 2);
  const Everything read = table.read(options);
  EXPECT_FALSE(read.flag);
  EXPECT_EQ(read.count, 7);
  EXPECT_EQ(read.seed, 1LL << 40);
  EXPECT_EQ(read.name, "y");
  EXPECT_EQ(read.colour, Colour::kRed);
  EXPECT_EQ(read.inner.depth, 2);
}

/// In a process of its own, since what is added stays.
TEST(OptionTables, NamesOfOtherKeysAreRefused) {
  const auto try_it = [] {
    add_options({.name = "size", .help = "clashes"});
    try {
      case_keys();
    } catch (const std::logic_error&) {
      std::exit(0);
    }
    std::exit(1);
  };
  EXPECT_EXIT(try_it(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace delquad
