// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "delquad/error.h"

// This header writes values as bytes. The library and the worker that reads CAD exchange them.

namespace delquad::cad {

/// Appends a value as bytes: one that is trivially copyable, a string, or a vector of such.
template <class T>
void put(std::string& bytes, const T& value) {
  if constexpr (std::is_trivially_copyable_v<T>) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  } else {
    put(bytes, value.size());
    if constexpr (std::is_same_v<T, std::string>)
      bytes += value;
    else
      for (const auto& each : value) put(bytes, each);
  }
}

/// Takes such a value from the front of the bytes. Throws InputError if there are too few.
template <class T>
void get(std::string_view& bytes, T& value) {
  std::size_t n = sizeof value;
  if constexpr (!std::is_trivially_copyable_v<T>) get(bytes, n);
  if constexpr (requires { value.emplace_back(); }) {
    for (; n > 0; --n) get(bytes, value.emplace_back());
  } else {
    if (bytes.size() < n)
      throw InputError(
          "the program that reads CAD files sent an incomplete answer: install it and this library from one "
          "build");
    if constexpr (std::is_same_v<T, std::string>)
      value = bytes.substr(0, n);
    else
      std::memcpy(&value, bytes.data(), n);
    bytes.remove_prefix(n);
  }
}

}  // namespace delquad::cad
