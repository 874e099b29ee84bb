#pragma once

#include <string>

#include "delquad/error.h"

namespace delquad {

/// Runs `f`; an InputError gains `where` in front, unless it stands there already.
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
