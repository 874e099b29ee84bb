// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "tests/support/curved_grid.h"
#include "tests/support/head.h"
#include "tests/support/run_program.h"

/// The head of tests of files, tables and experiments.
namespace delquad {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Folder = testing_support::TemporaryFolder;
using Strings = std::vector<std::string>;
using Quads = std::vector<std::array<int, 4>>;
using Triangles = std::vector<std::array<int, 3>>;
using Lines = std::vector<std::array<int, 2>>;

}  // namespace delquad
