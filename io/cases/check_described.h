// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "io/cases/problem_fields.h"

// This header checks values against the limits of their descriptions. The pipeline and readers and writers
// use it.

namespace delquad {

/// A value in messages.
struct ValueName {
  std::string where, key, owner = {};
  std::string text() const;  ///< "file:line: 'key' of 'owner'"
};

/// These throw InputError, beginning with the name, for values beyond the limits. `none` is the value that
/// stands for none.
void check_number(double value, const Rule& rule, const ValueName& name, std::optional<double> none);
void check_text(const std::string& text, const Rule& rule, const ValueName& name);
void check_vector(const Vec3& vector, const Rule& rule, const ValueName& name);
void check_unique(const std::vector<std::string>& texts, const ValueName& name);
[[noreturn]] void refuse_empty(const ValueName& name);
/// `least` is the least number of values.
void check_length(std::size_t length, double least, const ValueName& name);

/// These throw InputError for fields that contradict each other.
template <class T>
void check_together(const T&, const std::string&) {}
void check_together(const SizeSource& source, const std::string& where);
void check_together(const NamedSize& named, const std::string& where);
void check_together(const SizeSpec& size, const std::string& where);
void check_together(const MetricSpec& metric, const std::string& where);
void check_together(const LayerSpec& layer, const std::string& where);
void check_together(const SurfaceSpec& surface, const std::string& where);
void check_together(const WasherSpec& washer, const std::string& where);
void check_together(const FilletRows& rows, const std::string& where);

template <class T, class... Others>
concept OneOf = (std::is_same_v<T, Others> || ...);
template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsListOfDescribed = false;
template <Described T>
inline constexpr bool kIsListOfDescribed<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

template <Described T>
void check_described(const T& value, std::string where, std::string path = {});

/// Throws InputError for a value beyond the limits. If `absent` is not null, its value stands for none and is
/// allowed.
template <class T>
void check_value(const T& value, const Rule& rule, const ValueName& name, const T* absent = nullptr) {
  if constexpr (Described<T>) {
    check_described(value, name.where, name.key);
  } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
    const bool may_be_none = absent != nullptr && !rule.required;
    if (may_be_none && value == *absent) return;
    check_number(static_cast<double>(value), rule, name, may_be_none ? std::optional(*absent) : std::nullopt);
  } else if constexpr (std::is_same_v<T, std::string>) {
    check_text(value, rule, name);
  } else if constexpr (std::is_same_v<T, Vec3>) {
    check_vector(value, rule, name);
  } else if constexpr (kIsOptional<T>) {
    if (value) check_value(*value, rule, name);
  } else if constexpr (kIsList<T>) {
    if (rule.required && rule.form != Form::kOwn && value.empty()) refuse_empty(name);
    for (const auto& one : value) check_value(one, rule, name);
    if constexpr (std::is_same_v<T, std::vector<std::string>>)
      if (rule.unique) check_unique(value, name);
  }
}

/// Throws InputError for values of the struct, and of structs in it, beyond the limits of their descriptions,
/// and for fields that contradict each other. `where` and `path` name structs that know no place.
template <Described T>
void check_described(const T& value, std::string where, std::string path) {
  std::string owner;
  if constexpr (requires { value.where.empty(); })
    if (!value.where.empty()) where = value.where, path.clear();
  if constexpr (requires { owner = value.name; } && !std::is_base_of_v<MeshProblem, T>) owner = value.name;
  static const T absent{};
  visit_fields(
      [&](const FieldInfo& info, const auto& member, const auto& none) {
        const std::string key = path + (path.empty() ? "" : ".") + info.key;
        check_value(member, info.rule, {where, key, owner}, &none);
      },
      value, absent);
  check_together(value, where);
}

}  // namespace delquad
