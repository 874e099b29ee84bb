// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/located.h"
#include "io/cases/case_keys.h"
#include "io/cases/check_described.h"
#include "io/cases/outline_files.h"
#include "io/cases/toml_reader.h"

// This header reads tables of files by the descriptions of structs. The bench, readers and writers and the
// Python module use it.

namespace delquad {

/// Returns the JSON Schema of a number within the limits of the rule. `type` is "number", "integer" or a list
/// of types.
std::string limited_type(const std::string& type, const Rule& rule);
/// Returns the same for a list of such values.
std::string list_type(const std::string& item, const Rule& rule);

/// Returns the keys of a table that the struct is read from.
template <Described T>
TomlKeys keys_of();

namespace described {

/// Fills in the type of the value; types that no file has are left out.
template <class T>
void add_type(const T*, const Rule& rule, TomlKey& key) {
  using namespace toml_types;
  if (rule.form == Form::kOwn) {
    key.type = rule.type != nullptr ? rule.type : "";
    if constexpr (std::is_same_v<T, std::vector<PartRule>>) key.table = keys_of<PartRule>, key.many = true;
  } else if constexpr (Described<T>)
    key.table = keys_of<T>;
  else if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>)
    key.type = rule.words != nullptr ? one_of(words_of(rule.words)) : kFlag;
  else if constexpr (std::is_integral_v<T>)
    key.type = limited_type(R"("integer")", rule);
  else if constexpr (std::is_floating_point_v<T>)
    key.type = rule.form == Form::kLeast ? kRange : limited_type(R"("number")", rule);
  else if constexpr (std::is_same_v<T, std::string>)
    key.type = rule.words != nullptr         ? one_of(words_of(rule.words))
               : rule.form == Form::kFormula ? limited_type(R"(["number", "string"])", rule)
               : rule.type != nullptr        ? rule.type
                                             : kText;
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    key.type = kText;
  else if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>)
    key.type = kTexts;
  else if constexpr (std::is_same_v<T, std::map<std::string, std::string>>)
    key.type = kWords;
  else if constexpr (std::is_same_v<T, Vec2>)
    key.type = kRange;
  else if constexpr (std::is_same_v<T, Vec3>)
    key.type = rule.form == Form::kVector ? kVector : kSpacePoint;
  else if constexpr (std::is_same_v<T, std::array<Vec3, 2>>)
    key.type = points(kVector, 2);
  else if constexpr (std::is_same_v<T, std::array<Vec2, 2>>)
    key.type = points(kRange, 2, 2);
  else if constexpr (std::is_same_v<T, std::array<int, 2>>)
    key.type = points(R"({"type": "integer"})", 2, 2);
  else if constexpr (std::is_same_v<T, std::vector<Vec2>>)
    key.type = points(kRange, *rule.least);
  else if constexpr (std::is_same_v<T, std::vector<Vec3>>)
    key.type = fmt::format(R"({{"anyOf": [{}, {}]}})", points(kSpacePoint, *rule.least), kText);
  else if constexpr (std::is_same_v<T, std::vector<std::string>>)
    key.type = rule.form == Form::kTexts || rule.form == Form::kGroup
                   ? kTextOrTexts
                   : list_type(rule.words != nullptr ? one_of(words_of(rule.words)) : kText,
                               {.required = rule.required || rule.least, .unique = rule.unique});
  else if constexpr (std::is_same_v<T, std::vector<int>>)
    key.type = list_type(limited_type(R"("integer")", rule), rule);
  else if constexpr (kIsOptional<T>)
    add_type(static_cast<const typename T::value_type*>(nullptr), rule, key);
  else if constexpr (kIsList<T>) {
    add_type(static_cast<const typename T::value_type*>(nullptr), rule, key);
    key.many = true;
  }
}

}  // namespace described

template <Described T>
TomlKeys keys_of() {
  TomlKeys keys;
  T none{};
  for_each_field(none, [&](const FieldInfo& info, const auto& member) {
    const Form form = info.rule.form;
    if (form == Form::kNone || form == Form::kMost) return;
    TomlKey& key = keys.emplace_back(TomlKey{.name = info.key,
                                             .about = info.help,
                                             .required = info.rule.required,
                                             .option = info.rule.option,
                                             .keyword = info.rule.keyword});
    described::add_type(&member, info.rule, key);
  });
  return keys;
}

/// Completes a struct that was read from a table. Throws InputError with file and line.
template <class T>
void finish_reading(const TomlTable&, T&) {}
void finish_reading(const TomlTable& table, SizeSource& source);
void finish_reading(const TomlTable& table, MetricSpec& metric);
void finish_reading(const TomlTable& table, PeriodicPair& pair);
void finish_reading(const TomlTable& table, GridCorners& grid);
void finish_reading(const TomlTable& table, SurfaceSpec& surface);

/// Reads the keys that the table has; what it lacks stays as it is. Throws InputError with file and line.
template <Described T>
void read_described(const TomlTable& table, T& value);

namespace described {

/// Returns the index of the text in Rule::words. Throws InputError, with file and line, for another text.
std::size_t read_word(const TomlTable& table, const std::string& key, const Rule& rule);

template <class T>
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, T& value) {
  const bool is_text = table.kind(key) == TomlKind::kText;
  const auto in_folder = [&](const std::string& name) { return table.file().parent_path() / name; };
  if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(read_word(table, key, rule));
  } else if constexpr (std::is_same_v<T, bool>) {
    value = rule.words == nullptr ? table.get<bool>(key) : read_word(table, key, rule) != 0;
  } else if constexpr (std::is_same_v<T, double>) {
    const bool is_pair = rule.form == Form::kLeast || rule.form == Form::kMost;
    value = is_pair ? table.get<std::array<double, 2>>(key)[rule.form == Form::kMost] : table.number(key);
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = rule.form == Form::kFormula ? table.expression(key) : table.text(key);
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    value = in_folder(table.text(key));
  } else if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>) {
    for (const std::string& text : table.texts(key)) value.push_back(in_folder(text));
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    const bool may_be_one = rule.form == Form::kTexts || rule.form == Form::kGroup;
    value = may_be_one && is_text ? T{table.text(key)} : table.texts(key);
  } else if constexpr (std::is_same_v<T, std::map<std::string, std::string>>) {
    // They take the place of some of those before.
    const TomlTable texts = table.table(key);
    for (const std::string& word : texts.keys()) value[word] = texts.text(word);
  } else if constexpr (std::is_same_v<T, Vec3>) {
    if (rule.form != Form::kVector) return void(value = table.get<Vec3>(key));
    const auto [x, y, z] = table.get<std::array<double, 3>>(key);
    value = {x, y, z};
  } else if constexpr (std::is_same_v<T, std::vector<Vec3>>) {
    if (!is_text) return void(value = table.get<T>(key));
    for (const Vec2 p : located(table.where(key), [&] { return read_points(in_folder(table.text(key))); }))
      value.push_back({p.x, p.y, 0});
  } else if constexpr (std::is_constructible_v<TomlTarget, T*>) {
    value = table.get<T>(key);
  } else {
    throw std::logic_error("'" + key + "' has no form in files");
  }
}

}  // namespace described

/// Reads one value. Throws InputError with file and line for other types, and beyond the limits.
template <class T>
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, T& value) {
  const bool is_new = !table.is_of_options();
  if constexpr (kIsOptional<T>) {
    auto one = value.value_or(typename T::value_type());
    if constexpr (Described<typename T::value_type>)
      read_described(table.table(key), one);
    else
      read_value(table, key, rule, one);
    value = std::move(one);
  } else if constexpr (Described<T>) {
    if (is_new) value = T();
    read_described(table.table(key), value);
  } else if constexpr (kIsListOfDescribed<T>) {
    if (is_new) value.clear();
    for (const TomlTable& one : table.tables(key)) read_described(one, value.emplace_back());
  } else {
    described::read_value(table, key, rule, value);
    const ValueName name = {table.where(key), key};
    if constexpr (OneOf<T, std::vector<std::string>, std::vector<Vec2>, std::vector<Vec3>>)
      if (rule.least) check_length(value.size(), *rule.least, name);
    check_value(value, rule, name);
    if constexpr (std::is_same_v<T, double>)
      if (rule.form == Form::kDegrees) value *= std::numbers::pi / 180;
  }
}

/// Reads the fields of a struct among other keys of a table.
template <Described T>
void read_fields(const TomlTable& table, T& value) {
  for_each_field(value, [&](const FieldInfo& info, auto& member) {
    const Form form = info.rule.form;
    if (form == Form::kNone || form == Form::kOwn) return;
    if (table.has(info.key) || info.rule.required) read_value(table, info.key, info.rule, member);
  });
}

template <Described T>
void read_described(const TomlTable& table, T& value) {
  static const TomlKeys keys = keys_of<T>();
  table.require_known(keys);
  const bool is_new = !table.is_of_options();
  if constexpr (requires { value.where = table.where(); })
    if (is_new || value.where.empty()) value.where = table.where();
  if constexpr (requires { value.folder = table.file(); })
    if (is_new) value.folder = table.file().parent_path();
  read_fields(table, value);
  finish_reading(table, value);
  check_described(value, table.where());
}

}  // namespace delquad
