// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "delquad/error.h"

namespace delquad {

/// Whether a text has all of these parts.
template <class... Parts>
testing::AssertionResult holds(const std::string& text, const Parts&... parts) {
  for (const std::string& part : std::vector<std::string>{parts...})
    if (text.find(part) == std::string::npos)
      return testing::AssertionFailure() << "'" << part << "' is not in: " << text;
  return testing::AssertionSuccess() << text;
}

/// How many of the warnings hold the part.
inline auto count_told(const std::vector<Warning>& warnings, const std::string& part) {
  return std::ranges::count_if(warnings, [&](const Warning& w) { return bool(holds(w.text, part)); });
}
inline bool is_reported(const std::vector<Warning>& warnings, const std::string& part) {
  return count_told(warnings, part) > 0;
}

/// The call must throw InputError with a message that holds each of the parts.
template <typename Call>
void expect_input_error(Call&& call, std::initializer_list<const char*> parts) {
  try {
    call();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* part : parts) EXPECT_TRUE(holds(message, part));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return;
  }
  ADD_FAILURE() << "no InputError";
}

/// Returns the message about wrong input; empty: it throws no InputError.
template <typename Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace delquad
