// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/nearest_name.h"
#include "delquad/mesh.h"

// This header reads TOML files with messages about places and keys. The bench and readers and writers use
// it.

namespace delquad {

/// A key that a table of a TOML file may have. Lists of them are what tables are read against, and what the
/// JSON Schema of files is made from.
struct TomlKey {
  std::string name;
  std::string about;                                      ///< for people
  std::string type = {};                                  ///< JSON Schema of its value; empty: only a table
  std::function<std::vector<TomlKey>()> table = nullptr;  ///< the keys of the table that the value may be
  bool many = false;                                      ///< such a table, or a list of them
  bool required = false;
  const char* option = nullptr;   ///< option of the program that sets it
  const char* keyword = nullptr;  ///< keyword of Python, where that is not the name
};

using TomlKeys = std::vector<TomlKey>;

enum class TomlKind { kNone, kNumber, kText, kFlag, kArray, kTable };

/// The place that a value is read into.
using TomlTarget =
    std::variant<bool*, int*, long long*, double*, std::string*, Vec2*, Vec3*, std::array<double, 2>*,
                 std::array<double, 3>*, std::array<int, 2>*, std::array<Vec2, 2>*, std::array<Vec3, 2>*,
                 std::vector<int>*, std::vector<std::string>*, std::vector<Vec2>*, std::vector<Vec3>*,
                 std::vector<std::vector<int>>*, std::vector<std::variant<std::string, Vec3>>*>;

/// A checked view of one table of a TOML file. Every getter throws InputError "file:line: ..." which names
/// the key and says what was expected.
class TomlTable {
 public:
  /// Throws InputError when the file cannot be read or is not TOML.
  static TomlTable read(const std::filesystem::path& file);
  /// Keys that change a problem one by one, each as the name of an option, for messages, and a line of TOML.
  static TomlTable of_options(const std::vector<std::pair<std::string, std::string>>& lines);
  /// Returns whether it is made of options: what it lacks stays as it is, inside of tables, too, and lists of
  /// tables become longer.
  bool is_of_options() const;

  const std::filesystem::path& file() const;
  /// Returns "file:line" of the table.
  std::string where() const;
  /// Returns "file:line" of a key of it.
  std::string where(const std::string& key) const;

  /// Returns the kind of a key; kNone: absent.
  TomlKind kind(const std::string& key) const;
  bool has(const std::string& key) const { return kind(key) != TomlKind::kNone; }
  /// Returns the keys present, in alphabetical order.
  std::vector<std::string> keys() const;

  /// Returns a value of one of the types of TomlTarget. Numbers are finite, and integers are numbers, too.
  /// Vec2 is [x, y]; Vec3 is [x, y, z], or [x, y] with z = 0.
  template <class T>
  T get(const std::string& key) const {
    T value{};
    read(key, &value);
    return value;
  }
  /// Returns a value; `absent`: where the table has no such key.
  template <class T>
  T get(const std::string& key, const T& absent) const {
    return has(key) ? get<T>(key) : absent;
  }
  double number(const std::string& key) const { return get<double>(key); }
  std::string text(const std::string& key) const { return get<std::string>(key); }
  std::string text(const std::string& key, const std::string& absent) const { return get(key, absent); }
  std::vector<std::string> texts(const std::string& key) const { return get<std::vector<std::string>>(key); }
  /// Returns a text, or a number as it would be written in an expression.
  std::string expression(const std::string& key) const;
  TomlTable table(const std::string& key) const;
  std::optional<TomlTable> optional_table(const std::string& key) const;
  /// Returns an array of tables, or one table; none when absent.
  std::vector<TomlTable> tables(const std::string& key) const;
  /// Returns the same where texts may stand among the tables.
  std::pair<std::vector<std::string>, std::vector<TomlTable>> texts_and_tables(
      const std::string& key, bool may_be_texts = true) const;

  /// Returns the dotted keys ("insertion.h_max") of everything below that is no table, in alphabetical order.
  std::vector<std::string> leaves() const;
  /// Returns how many elements the list at a dotted key has, at least one.
  std::size_t count(const std::string& leaf) const;
  /// In place of an element: the value as it is.
  static constexpr std::size_t kWhole = static_cast<std::size_t>(-1);
  /// Returns element `i` of the list at a dotted key, as TOML text; texts without their quotes.
  std::string element_text(const std::string& leaf, std::size_t i) const;
  /// Returns this table, where the value at each of the dotted keys is element `choice[k]` of the list that
  /// `lists` has there. One more time, these count before. Throws InputError where such a key lies below one
  /// that is no table.
  TomlTable with_choice(const TomlTable& lists, const std::vector<std::string>& leaves,
                        const std::vector<std::size_t>& choice) const;

  /// Throws InputError for a key that is present and none of these, suggesting the nearest of them. It is to
  /// be called first, before the key that was meant is missed.
  void require_known(const TomlKeys& keys) const;

  /// Keys that went, each with the way to do the same now.
  using RemovedKeys = std::vector<std::pair<const char*, const char*>>;
  /// Throws InputError for a key that went.
  void refuse_removed(const RemovedKeys& keys) const;

 private:
  void read(const std::string& key, const TomlTarget& target) const;

  struct Data;
  explicit TomlTable(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace delquad
