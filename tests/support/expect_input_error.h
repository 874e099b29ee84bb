#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "delquad/error.h"

namespace delquad {

/// The text must hold each of the parts.
inline void expect_text(const std::string& text, std::initializer_list<std::string> parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

/// How many of the warnings hold the part.
inline auto count_told(const std::vector<Warning>& warnings, const std::string& part) {
  return std::ranges::count_if(warnings,
                               [&](const Warning& w) { return w.text.find(part) != std::string::npos; });
}
inline bool is_told(const std::vector<Warning>& warnings, const std::string& part) {
  return count_told(warnings, part) > 0;
}

/// The call must throw InputError with a message that holds each of the parts.
template <typename Call>
void expect_input_error(Call&& call, std::initializer_list<const char*> parts) {
  try {
    call();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* part : parts) expect_text(message, {part});
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return;
  }
  ADD_FAILURE() << "no InputError";
}

/// What it says of wrong input; empty: it throws no InputError.
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
