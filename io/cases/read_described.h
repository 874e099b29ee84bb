#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/cases/case_keys.h"
#include "io/cases/check_described.h"
#include "io/cases/toml_reader.h"

// Tables of files by the descriptions of structs: their keys, and reading them.

namespace delquad {

/// JSON Schema of a number within the limits of the rule; `type`: "number", "integer" or a list of types.
std::string limited_type(const std::string& type, const Rule& rule);
/// The same of a list of such values.
std::string list_type(const std::string& item, const Rule& rule);

/// The keys of a table that the struct is read from.
template <Described T>
TomlKeys keys_of();

namespace described {

/// Fills in what the value may be. Types that no file has are left out.
template <class T>
void add_type(const T*, const Rule& rule, TomlKey& key) {
  using namespace toml_types;
  if (rule.form == Form::kOwn)
    key.type = rule.type != nullptr ? rule.type : "";
  else if constexpr (Described<T>)
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
    key.type = points(2, kVector);
  else if constexpr (std::is_same_v<T, std::vector<std::string>>)
    key.type = rule.form == Form::kTexts
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

/// Reads one value. Throws InputError with file and line for other types, and beyond the limits.
template <class T>
requires(std::is_integral_v<T> || std::is_same_v<T, Vec2> || std::is_same_v<T, std::array<Vec3, 2>> ||
         std::is_same_v<T, std::vector<int>>) void read_value(const TomlTable& table, const std::string& key,
                                                              const Rule& rule, T& value) {
  value = table.get<T>(key);
  check_value(value, rule, {table.where(key), key});
}
/// The number of the text among Rule::words.
std::size_t read_word(const TomlTable& table, const std::string& key, const Rule& rule);
template <class T>
requires std::is_enum_v<T>
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, T& value) {
  value = static_cast<T>(read_word(table, key, rule));
}
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, bool& value);
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, double& value);
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, std::string& value);
void read_value(const TomlTable& table, const std::string& key, const Rule& rule, Vec3& value);
void read_value(const TomlTable& table, const std::string& key, const Rule& rule,
                std::vector<std::string>& value);
/// Texts that take the place of some of those before.
void read_value(const TomlTable& table, const std::string& key, const Rule& rule,
                std::map<std::string, std::string>& value);
/// Files count from the folder of the table's file.
void read_value(const TomlTable& table, const std::string& key, const Rule& rule,
                std::filesystem::path& value);
void read_value(const TomlTable& table, const std::string& key, const Rule& rule,
                std::vector<std::filesystem::path>& value);
template <class T>
requires(!std::is_enum_v<T>) void read_value(const TomlTable& table, const std::string& key, const Rule& rule,
                                             std::optional<T>& value) {
  T one = value.value_or(T{});
  if constexpr (Described<T>)
    read_described(table.table(key), one);
  else
    read_value(table, key, rule, one);
  value = std::move(one);
}
template <Described T>
void read_value(const TomlTable& table, const std::string& key, const Rule&, T& value) {
  if (!table.is_of_options()) value = T();
  read_described(table.table(key), value);
}
template <Described T>
void read_value(const TomlTable& table, const std::string& key, const Rule&, std::vector<T>& value) {
  if (!table.is_of_options()) value.clear();
  for (const TomlTable& one : table.tables(key)) read_described(one, value.emplace_back());
}

/// Reads the fields of a struct among other keys of a table.
template <Described T>
void read_fields(const TomlTable& table, T& value) {
  for_each_field(value, [&](const FieldInfo& info, auto& member) {
    if constexpr (requires { read_value(table, info.key, info.rule, member); }) {
      const Form form = info.rule.form;
      if (form == Form::kNone || form == Form::kOwn) return;
      if (table.has(info.key) || info.rule.required) read_value(table, info.key, info.rule, member);
    }
  });
}

template <Described T>
void read_described(const TomlTable& table, T& value) {
  table.require_known(keys_of<T>());
  const bool is_new = !table.is_of_options();
  if constexpr (requires { value.where = table.where(); })
    if (is_new || value.where.empty()) value.where = table.where();
  if constexpr (requires { value.folder = table.file(); })
    if (is_new) value.folder = table.file().parent_path();
  read_fields(table, value);
  finish_reading(table, value);
  check_described(value, table.where());
  table.finish(keys_of<T>());
}

}  // namespace delquad
