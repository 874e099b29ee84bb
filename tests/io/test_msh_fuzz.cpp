#include <gtest/gtest.h>

#include <random>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "tests/io/msh_files.h"
#include "tests/io/reader_test.h"
#include "tests/support/temporary_folder.h"

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

TEST_P(MshFuzz, EveryTruncationIsRefused) {
  const std::string& text = GetParam();
  ASSERT_TRUE(reads(text));
  for (size_t length = 0; length + 1 < text.size(); ++length) {
    EXPECT_FALSE(reads(text.substr(0, length))) << "the first " << length << " bytes";
  }
}

TEST_P(MshFuzz, FlippedBitsAreReadOrRefused) {
  std::mt19937 random(7);
  int refused = 0;
  constexpr int kTrials = 500;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::string text = GetParam();
    for (unsigned flips = 1 + random() % 3; flips > 0; --flips) {
      text[random() % text.size()] ^= static_cast<char>(1u << random() % 8);
    }
    refused += reads(text) ? 0 : 1;
  }
  EXPECT_GT(refused, kTrials / 2);
  EXPECT_LT(refused, kTrials) << "some flips only move a point";
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
