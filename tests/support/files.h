#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <ranges>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "tests/support/curved_grid.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/grid_mesh.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

/// The head of tests of files, tables and experiments: GoogleTest, the standard library, and helpers that
/// many of them use.
namespace delquad {
using namespace testing_support;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Folder = testing_support::TemporaryFolder;
using Strings = std::vector<std::string>;
using Quads = std::vector<std::array<int, 4>>;
using Triangles = std::vector<std::array<int, 3>>;
using Lines = std::vector<std::array<int, 2>>;

/// Whether a text has all of these parts.
template <class... Parts>
testing::AssertionResult holds(const std::string& text, const Parts&... parts) {
  for (const std::string& part : Strings{parts...})
    if (text.find(part) == std::string::npos)
      return testing::AssertionFailure() << "'" << part << "' is not in: " << text;
  return testing::AssertionSuccess() << text;
}

}  // namespace delquad
