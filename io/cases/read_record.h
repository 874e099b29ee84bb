// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/cases/problem_record.h"

// This header reads problems from records. The bench, readers and writers and measures use it.

namespace delquad {

/// Reads structs from records. Fields that determine no result stay, because Recorder leaves them out. Throws
/// InputError for values that were in memory, and exceptions of nlohmann::json for unexpected values.
class RecordReader {
 public:
  /// Returns the file with this digest. `name` comes from the record; empty: the file of the model.
  using FindFile =
      std::function<std::filesystem::path(const std::filesystem::path& name, const std::string& digest)>;
  explicit RecordReader(FindFile find = {}, bool whole = false) : find_(std::move(find)), whole_(whole) {}

  template <Described T>
  void object(const RecordJson& json, T& value) const {
    for_each_field(value, [&](const FieldInfo& info, auto& member) {
      if (!whole_ && info.rule.no_result != nullptr) return;
      const RecordJson& one = json.at(info.key);
      const Form form = info.rule.form;
      read(form == Form::kLeast ? one.at(0) : form == Form::kMost ? one.at(1) : one, info.rule, member);
    });
    if constexpr (requires { file_of(value); })
      if (const auto file = file_of(value))
        value.folder = find_(file->file.path, json.at("content").at("digest")).parent_path();
  }

 private:
  template <class T>
  void read(const RecordJson& json, const Rule& rule, T& value) const {
    if constexpr (Described<T>)
      object(json, value);
    else if constexpr (std::is_enum_v<T>)
      value = static_cast<T>(word_in(json, rule));
    else if constexpr (std::is_same_v<T, bool>)
      value = rule.words != nullptr ? word_in(json, rule) != 0 : json.get<bool>();
    else if constexpr (std::is_floating_point_v<T>)
      value = number(json);
    else if constexpr (std::is_arithmetic_v<T>)
      value = json.get<T>();
    else
      read_other(json, rule, value);
  }
  template <class T>
  void read_other(const RecordJson& json, const Rule& rule, std::vector<T>& values) const {
    values.clear();
    for (const RecordJson& one : json) read(one, rule, values.emplace_back());
  }
  template <class T, std::size_t N>
  void read_other(const RecordJson& json, const Rule& rule, std::array<T, N>& values) const {
    for (std::size_t i = 0; i < N; ++i) read(json.at(i), rule, values[i]);
  }
  template <class T>
  void read_other(const RecordJson& json, const Rule& rule, std::map<std::string, T>& values) const {
    values.clear();
    for (const auto& [key, one] : json.items()) read(one, rule, values[key]);
  }
  template <class A, class B>
  void read_other(const RecordJson& json, const Rule& rule, std::pair<A, B>& pair) const {
    read(json.at(0), rule, pair.first);
    read(json.at(1), rule, pair.second);
  }
  template <class T>
  void read_other(const RecordJson& json, const Rule& rule, std::optional<T>& value) const {
    value.reset();
    if (!json.is_null()) read(json, rule, value.emplace());
  }
  template <class... T>
  void read_other(const RecordJson& json, const Rule& rule, std::variant<T...>& value) const {
    const std::size_t kind = word_in(json.at("kind"), rule);
    std::size_t i = 0;
    ((i++ == kind ? object(json, value.template emplace<T>()) : void()), ...);
  }
  void read_other(const RecordJson& json, const Rule&, std::shared_ptr<const Curve>& curve) const;
  void read_other(const RecordJson& json, const Rule& rule, std::string& text) const;
  void read_other(const RecordJson& json, const Rule&, std::filesystem::path& file) const;
  void read_other(const RecordJson& json, const Rule&, Vec2& p) const {
    p = {number(json.at(0)), number(json.at(1))};
  }
  void read_other(const RecordJson& json, const Rule&, Vec3& p) const {
    p = {number(json.at(0)), number(json.at(1)), number(json.at(2))};
  }
  void read_other(const RecordJson& json, const Rule&, Options& options) const;
  /// Functions, fields and meshes, which no record holds.
  template <class T>
  void read_other(const RecordJson& json, const Rule&, T& value) const {
    require_absent(json);
    value = {};
  }

  static void require_absent(const RecordJson& json);
  static double number(const RecordJson& json);
  /// Returns the index of the text in Rule::words.
  static std::size_t word_in(const RecordJson& json, const Rule& rule);

  FindFile find_;
  bool whole_;
};

}  // namespace delquad
