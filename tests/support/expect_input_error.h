#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "delquad/error.h"

namespace delquad {

/// The call must throw InputError with a message that holds each of the parts.
template <typename Call>
void expect_input_error(Call&& call, std::initializer_list<const char*> parts) {
  try {
    call();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
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
