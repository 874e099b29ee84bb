// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.h"
#include "tests/io/msh_files.h"
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

class MshFuzz : public testing_support::ReaderTest<::testing::TestWithParam<std::string>> {
 protected:
  MshFuzz() : ReaderTest("case.msh") {}
  void check(const Mesh& mesh) override {
    evaluate_metrics(mesh, nullptr);
    check_invariants(mesh);
  }
};

TEST_P(MshFuzz, DamageIsReadOrRefused) {
  expect_whole(GetParam(), 2);
  try_flipped_bits(GetParam(), 500, 0.5);
}

TEST_P(MshFuzz, ChangedDigitsAreReadOrRefused) {
  // Wrong counts, tags, types and dimensions.
  std::mt19937 random(8);
  for (int trial = 0; trial < 500; ++trial) {
    std::string text = GetParam();
    for (int changes = 0; changes < 2;) {
      char& c = text[random() % text.size()];
      if (c < '0' || c > '9') continue;
      c = static_cast<char>('0' + random() % 10);
      ++changes;
    }
    reads(text);
  }
}

INSTANTIATE_TEST_SUITE_P(Versions, MshFuzz, ::testing::Values(msh_files::kSquare22, msh_files::kSquare41),
                         [](const auto& version) { return version.index == 0 ? "v22" : "v41"; });

}  // namespace
}  // namespace delquad
