// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <ostream>

#include "tests/fuzz/target.h"
#include "tests/support/temporary_folder.h"

namespace delquad::fuzz {
namespace {

std::vector<Target> all_targets() {
  std::vector<Target> all;
  for (const auto& targets : {reader_targets(), case_targets(), result_targets(), mesher_targets()})
    all.insert(all.end(), targets.begin(), targets.end());
#if DELQUAD_HAS_CAD
  for (const Target& target : cad_targets()) all.push_back(target);
#endif
  return all;
}

}  // namespace

/// In names of tests.
void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

/// The targets of fuzzing, in every build.
class FuzzTarget : public ::testing::TestWithParam<Target> {};

TEST_P(FuzzTarget, SeedsComeToAResult) {
  int number = 0;
  for (const std::string& seed : GetParam().seeds()) {
    ++number;
    EXPECT_TRUE(GetParam().try_input(seed)) << "seed " << number << ": " << last_message();
    EXPECT_LE(static_cast<int>(seed.size()), GetParam().longest);
  }
}

using FuzzTargetLong = FuzzTarget;

TEST_P(FuzzTargetLong, CutSeedsAreNoFinding) {
  for (const std::string& seed : GetParam().seeds())
    for (const std::size_t part : {0, 1, 2, 3, 5, 7})
      EXPECT_NO_THROW(GetParam().try_input(seed.substr(0, seed.size() * part / 8)));
}

const auto name_of_target = [](const auto& target) { return target.param.name; };
INSTANTIATE_TEST_SUITE_P(All, FuzzTarget, ::testing::ValuesIn(all_targets()), name_of_target);
INSTANTIATE_TEST_SUITE_P(All, FuzzTargetLong, ::testing::ValuesIn(all_targets()), name_of_target);

/// corpus/TARGET/: inputs that have found something.
TEST(FuzzCorpus, IsNoFinding) {
  std::map<std::string, Target> named;
  for (const Target& target : all_targets()) named[target.name] = target;
  for (const auto& folder : std::filesystem::directory_iterator(DELQUAD_FUZZ_CORPUS)) {
    const auto target = named.find(folder.path().filename().string());
    ASSERT_TRUE(target != named.end()) << folder.path() << ": expected the name of a target";
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
      SCOPED_TRACE(file.path().string());
      EXPECT_NO_THROW(target->second.try_input(testing_support::read_text(file.path())));
    }
  }
}

}  // namespace
}  // namespace delquad::fuzz
