// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/files.h"

namespace delquad::testing_support {

/// Reads what a test writes to a file of some name.
template <class Test = ::testing::Test>
class ReaderTest : public Test {
 protected:
  explicit ReaderTest(std::string file) : file_(std::move(file)) {}

  Mesh read(const std::string& content) { return read_mesh(write_text(folder_ / file_, content)); }
  void expect_error(const std::string& content, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read(content); }, parts);
  }
  /// Whether it is read; nothing but an InputError that names the file may come out otherwise.
  bool reads(const std::string& content) {
    try {
      check(read(content));
      return true;
    } catch (const InputError& error) {
      EXPECT_TRUE(holds(error.what(), file_ + ":"));
      return false;
    }
  }
  /// Each beginning is refused, but for those that lack less than `spare` bytes.
  void expect_whole(const std::string& content, std::size_t spare = 1) {
    EXPECT_TRUE(reads(content));
    for (std::size_t n = 0; n + spare <= content.size(); ++n) EXPECT_FALSE(reads(content.substr(0, n))) << n;
  }
  /// With one to three bits flipped it is read or refused: more than this part of the trials is refused. Some
  /// flips only move a point.
  void try_flipped_bits(const std::string& content, int trials, double part) {
    std::mt19937 random(7);
    int refused = 0;
    for (int trial = 0; trial < trials; ++trial) {
      std::string changed = content;
      for (unsigned flips = 1 + random() % 3; flips > 0; --flips)
        changed[random() % changed.size()] ^= static_cast<char>(1u << random() % 8);
      refused += reads(changed) ? 0 : 1;
    }
    EXPECT_GT(refused, part * trials);
    EXPECT_LT(refused, trials);
  }
  /// Every mesh that was read must bear this.
  virtual void check(const Mesh& /*mesh*/) {}

  TemporaryFolder folder_;

 private:
  std::string file_;
};

}  // namespace delquad::testing_support
