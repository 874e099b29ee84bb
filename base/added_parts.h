// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cctype>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// This header registers parts from outside by name. Solvers, costs, fields and measures use it.

namespace delquad {

/// Throws std::invalid_argument unless the name is a letter, then letters, digits, - and _. Names appear in
/// files, tables and schemas.
inline void check_part_name(const std::string& kind, const std::string& name) {
  const auto is_fit = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
  };
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name[0])) == 0 ||
      !std::ranges::all_of(name, is_fit))
    throw std::invalid_argument(kind + " '" + name + "': expected a letter, then letters, digits, - and _");
}

/// Parts of one kind, chosen by name, in the order of addition.
template <class Part>
class AddedParts {
 public:
  /// `kind` is for messages, such as "matching solver". `words` are reserved names.
  explicit AddedParts(std::string kind, std::vector<std::string> words = {})
      : kind_(std::move(kind)), words_(std::move(words)) {}

  /// Throws std::invalid_argument for a taken or invalid name (check_part_name()), and for an empty part.
  void add(const std::string& name, Part part) {
    check_part_name(kind_, name);
    if (!part) throw std::invalid_argument(kind_ + " '" + name + "': there is nothing to call");
    if (find(name) != nullptr || std::ranges::find(words_, name) != words_.end())
      throw std::invalid_argument("there is a " + kind_ + " '" + name + "' already");
    parts_.emplace_back(name, std::move(part));
  }

  /// Returns null for an unknown name.
  const Part* find(const std::string& name) const {
    for (const auto& [known, part] : parts_)
      if (known == name) return &part;
    return nullptr;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& part : parts_) all.push_back(part.first);
    return all;
  }

 private:
  std::string kind_;
  std::vector<std::string> words_;
  std::deque<std::pair<std::string, Part>> parts_;
};

}  // namespace delquad
