#pragma once

#include <gtest/gtest.h>

#include <string>

#include "delquad/error.h"
#include "delquad/mesh.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

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
      EXPECT_NE(std::string(error.what()).find(file_ + ":"), std::string::npos) << error.what();
      return false;
    }
  }
  /// What has been read must bear this.
  virtual void check(const Mesh& /*mesh*/) {}

  TemporaryFolder folder_;

 private:
  std::string file_;
};

}  // namespace delquad::testing_support
