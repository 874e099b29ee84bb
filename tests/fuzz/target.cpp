// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"

#include <algorithm>
#include <stdexcept>

namespace delquad::fuzz {

namespace {

std::string& message_kept() {
  static std::string message;
  return message;
}

}  // namespace

const std::string& last_message() { return message_kept(); }

void require(bool is_true, std::string_view what) {
  if (!is_true) throw std::logic_error(std::string(what));
}

void check_message(const std::string& message, const std::string& where) {
  message_kept() = message;
  constexpr std::size_t kLongest = 4000;  // bytes
  require(message.starts_with(where), "the message does not say where: " + message);
  require(message.size() > where.size() && message.size() <= kLongest,
          "an empty or endless message: " + message);
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 127; };
  require(std::ranges::none_of(message, is_control), "the message has control characters: " + message);
}

}  // namespace delquad::fuzz
