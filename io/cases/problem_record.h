// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/cases/problem_fields.h"
#include "io/cases/read_problem.h"

// This header writes problems into records. The pipeline, the bench and readers and writers use it.

namespace delquad {

using RecordJson = nlohmann::ordered_json;

/// The file that a size or metric is read from, and the key whose text names it.
struct NamedFile {
  const char* key;
  SizeFile file;
};
/// Returns the file of a size or metric, if its text names one.
std::optional<NamedFile> file_of(const SizeSpec& size);
std::optional<NamedFile> file_of(const MetricSpec& metric);

/// Writes structs by their descriptions, without fields that determine no result. Files count by content.
class Recorder {
 public:
  /// Keys of functions, fields and meshes in memory, which no record can hold.
  std::vector<std::string> in_memory;

  /// `whole` includes fields that determine no result, and keeps the spelling of texts.
  explicit Recorder(bool whole = false) : whole_(whole) {}

  template <Described T>
  RecordJson object(const T& value) {
    RecordJson json = RecordJson::object();
    for_each_field(value, [&](const FieldInfo& info, const auto& member) {
      if (info.rule.no_result != nullptr && !whole_) return;
      const std::size_t outer = path_.size();
      path_ += (path_.empty() ? "" : ".") + std::string(info.key);
      RecordJson one = write(member, info.rule);
      if (info.rule.form == Form::kMost)
        json[info.key].push_back(std::move(one));
      else
        json[info.key] =
            info.rule.form == Form::kLeast ? RecordJson::array({std::move(one)}) : std::move(one);
      path_.resize(outer);
    });
    if constexpr (requires { file_of(value); })
      if (const auto named = file_of(value)) {
        const auto& [path, part] = named->file;
        json[named->key] = path.filename().string() + (part.empty() ? "" : ":" + part);
        json["content"] = content(path);
      }
    return json;
  }

 private:
  template <class T>
  RecordJson write(const T& value, const Rule& rule) {
    if constexpr (Described<T>)
      return object(value);
    else if constexpr (std::is_enum_v<T>)
      return words_of(rule.words).at(static_cast<std::size_t>(value));
    else if constexpr (std::is_same_v<T, bool>)
      return rule.words != nullptr ? RecordJson(words_of(rule.words).at(value ? 1 : 0)) : RecordJson(value);
    else if constexpr (std::is_floating_point_v<T>)
      return number(value);
    else if constexpr (std::is_arithmetic_v<T>)
      return value;
    else
      return write_other(value, rule);
  }
  /// A vector or array.
  template <class List>
  requires requires(const List& list) { list.begin(); }
  RecordJson write_other(const List& values, const Rule& rule) {
    RecordJson json = RecordJson::array();
    for (const auto& value : values) json.push_back(write(value, rule));
    return json;
  }
  template <class T>
  RecordJson write_other(const std::map<std::string, T>& values, const Rule& rule) {
    RecordJson json = RecordJson::object();
    for (const auto& [key, value] : values) json[key] = write(value, rule);
    return json;
  }
  template <class A, class B>
  RecordJson write_other(const std::pair<A, B>& pair, const Rule& rule) {
    return RecordJson::array({write(pair.first, rule), write(pair.second, rule)});
  }
  template <class T>
  RecordJson write_other(const std::optional<T>& value, const Rule& rule) {
    return value ? write(*value, rule) : RecordJson();
  }
  template <class... T>
  RecordJson write_other(const std::variant<T...>& value, const Rule& rule) {
    RecordJson json = {{"kind", words_of(rule.words).at(value.index())}};
    json.update(std::visit([&](const auto& one) { return object(one); }, value));
    return json;
  }
  template <class T>
  RecordJson write_other(const std::function<T>& function, const Rule&) {
    return write_in_memory(function != nullptr);
  }
  template <class T>
  RecordJson write_other(const std::shared_ptr<const T>& pointer, const Rule&) {
    return write_in_memory(pointer != nullptr);
  }
  RecordJson write_other(const std::shared_ptr<const Curve>& curve, const Rule&);
  RecordJson write_other(const Mesh& mesh, const Rule&) { return write_in_memory(!mesh.points.empty()); }
  RecordJson write_other(const DeclaredSurfaces& all, const Rule&) {
    return write_in_memory(!all.surfaces.empty());
  }
  RecordJson write_other(const std::string& text, const Rule& rule);
  RecordJson write_other(const std::filesystem::path& file, const Rule&) { return content(file); }
  RecordJson write_other(const Vec2& p, const Rule&) { return {number(p.x), number(p.y)}; }
  RecordJson write_other(const Vec3& p, const Rule&) { return {number(p.x), number(p.y), number(p.z)}; }
  RecordJson write_other(const Options& options, const Rule&);

  static RecordJson number(double value);
  /// Returns the kind and digest of a file, and the part that its name asks for ("FILE:LAYER@CRS"); null:
  /// there is no file.
  static RecordJson content(const std::filesystem::path& file);
  /// Notes a value that no record can hold, if there is one.
  RecordJson write_in_memory(bool is_there);

  std::string path_;
  bool whole_;
};

/// Returns the record of a struct.
template <Described T>
RecordJson record_of(const T& value) {
  return Recorder().object(value);
}

/// Returns whether two structs determine the same result.
template <Described T>
bool are_same(const T& a, const T& b) {
  return record_of(a) == record_of(b);
}

/// Returns the keys of fields that differ from T().
template <Described T>
std::vector<std::string> given_keys(const T& value) {
  const RecordJson given = record_of(value), absent = record_of(T());
  std::vector<std::string> keys;
  for (const auto& [key, one] : given.items())
    if (!absent.contains(key) || absent[key] != one) keys.push_back(key);
  return keys;
}

/// A problem as it was understood.
struct ProblemRecord {
  RecordJson json;
  std::vector<std::string> in_memory;  ///< see Recorder

  /// Returns the digest of everything that determines a result.
  std::string digest() const;
};
ProblemRecord record_of(const Case& c);

}  // namespace delquad
