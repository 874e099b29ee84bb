// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "delquad/error.h"

// This header throws errors with their place. All modules use it.

namespace delquad {

/// Throws `E`, InputError by default, with a message as by fmt::format().
template <class E = InputError, class... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> text, Args&&... args) {
  throw E(fmt::format(text, std::forward<Args>(args)...));
}

/// Returns f(). Puts `where` before the message of an InputError, unless it begins with it already.
template <class F>
auto located(const std::string& where, F&& f) {
  try {
    return f();
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.starts_with(where)) throw;
    throw InputError(where + ": " + message);
  }
}

}  // namespace delquad
