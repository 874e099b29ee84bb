// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "delquad/options.h"

// This header declares and reads options. All stages use it.

namespace delquad {

/// Table of an option group: each line relates a key to a member of a struct. It gives the declaration, with
/// the struct's defaults, and the reader.
template <class Struct>
class OptionTable {
 public:
  OptionTable(std::string name, std::string help) : group_{std::move(name), std::move(help), {}} {}

  /// Adds a key. `at` returns a reference to the member: a pointer to it, or a function of the struct. The
  /// default comes from the member, and an int limits the key to its range.
  template <class At>
  OptionTable& add(OptionKey key, At at) {
    Struct defaults;
    using Member = std::remove_reference_t<std::invoke_result_t<At, Struct&>>;
    if constexpr (std::is_same_v<Member, int>)
      if (!key.most) key.most = std::numeric_limits<int>::max();
    using Kind = std::conditional_t<std::is_same_v<Member, int>, long long, Member>;
    key.value = static_cast<Kind>(std::invoke(at, defaults));
    return push(std::move(key), [at](Struct& target, const OptionValue& value) {
      std::invoke(at, target) = static_cast<Member>(std::get<Kind>(value));
    });
  }

  /// Adds a key for a member with several values, each with its name in files; the default is among them.
  template <class At, class Member>
  OptionTable& choice(OptionKey key, At at, const std::vector<std::pair<std::string, Member>>& choices) {
    Struct defaults;
    for (const auto& [name, value] : choices) {
      key.allowed.push_back(name);
      if (std::invoke(at, defaults) == value) key.value = name;
    }
    return push(std::move(key), [at, choices](Struct& target, const OptionValue& value) {
      for (const auto& [name, member] : choices)
        if (std::get<std::string>(value) == name) std::invoke(at, target) = member;
    });
  }

  const OptionGroup& group() const { return group_; }

  /// Returns the struct with the options of this group, which are checked against group() before; others keep
  /// their defaults.
  Struct read(const Options& options) const {
    Struct result;
    for (std::size_t i = 0; i < readers_.size(); ++i)
      if (const OptionValue* value = options.find(group_.name + "." + group_.keys[i].name))
        readers_[i](result, *value);
    return result;
  }

 private:
  using Reader = std::function<void(Struct&, const OptionValue&)>;
  OptionTable& push(OptionKey key, Reader reader) {
    group_.keys.push_back(std::move(key));
    readers_.push_back(std::move(reader));
    return *this;
  }

  OptionGroup group_;
  std::vector<Reader> readers_;
};

}  // namespace delquad
