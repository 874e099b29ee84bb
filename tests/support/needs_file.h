// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

/// Skips the test where the system has no such file or device: some containers have a part of /proc and /dev.
#define NEEDS_FILE(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "this machine has no " << path
