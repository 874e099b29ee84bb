#pragma once

#include <string>

#include "mesh/error.h"

namespace delquad {

/// Runs `f`; an InputError gains `where` in front.
template <class F>
auto located(const std::string& where, F&& f) {
  try {
    return f();
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
}

}  // namespace delquad
