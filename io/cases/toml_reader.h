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

/// A key that a table of a TOML file may have. Tables are checked against lists of keys, which also make the
/// JSON Schema of files.
struct TomlKey {
  std::string name;
  std::string about;                                      ///< for people
  std::string type = {};                                  ///< JSON Schema of its value; empty: only a table
  std::function<std::vector<TomlKey>()> table = nullptr;  ///< keys of the table that the value may be
  bool many = false;                                      ///< the value may also be a list of such tables
  bool required = false;
  const char* option = nullptr;   ///< option of the program that sets it
  const char* keyword = nullptr;  ///< keyword of Python, where that is not the name
};

using TomlKeys = std::vector<TomlKey>;

enum class TomlKind { kNone, kNumber, kText, kFlag, kArray, kTable };

/// Destination of a value.
using TomlTarget =
    std::variant<bool*, int*, long long*, double*, std::string*, Vec2*, Vec3*, std::array<double, 2>*,
                 std::array<double, 3>*, std::array<int, 2>*, std::array<Vec2, 2>*, std::array<Vec3, 2>*,
                 std::vector<int>*, std::vector<std::string>*, std::vector<Vec2>*, std::vector<Vec3>*,
                 std::vector<std::vector<int>>*, std::vector<std::variant<std::string, Vec3>>*>;

/// A checked view of one table of a TOML file. Every getter throws InputError "file:line: ..." with the key
/// and the expected value.
class TomlTable {
 public:
  /// Reads a file. Throws InputError if it cannot be read or is not TOML.
  static TomlTable read(const std::filesystem::path& file);
  /// Returns keys that change a problem one by one; each has the name of an option, for messages, and a line
  /// of TOML. Throws InputError, with the option, for a line that is not TOML.
  static TomlTable of_options(const std::vector<std::pair<std::string, std::string>>& lines);
  /// Returns whether it is made of options. Then absent keys keep their values, also inside of tables, and
  /// lists of tables grow.
  bool is_of_options() const;

  const std::filesystem::path& file() const;
  /// Returns "file:line" of the table.
  std::string where() const;
  /// Returns "file:line" of one of its keys.
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
  /// Returns a value, or `absent` if the table has no such key.
  template <class T>
  T get(const std::string& key, const T& absent) const {
    return has(key) ? get<T>(key) : absent;
  }
  double number(const std::string& key) const { return get<double>(key); }
  std::string text(const std::string& key) const { return get<std::string>(key); }
  std::string text(const std::string& key, const std::string& absent) const { return get(key, absent); }
  std::vector<std::string> texts(const std::string& key) const { return get<std::vector<std::string>>(key); }
  /// Returns a text, or a number as text for a formula.
  std::string expression(const std::string& key) const;
  TomlTable table(const std::string& key) const;
  std::optional<TomlTable> optional_table(const std::string& key) const;
  /// Returns an array of tables, or one table; none when absent.
  std::vector<TomlTable> tables(const std::string& key) const;
  /// Returns an array of texts and tables, if `may_be_texts`.
  std::pair<std::vector<std::string>, std::vector<TomlTable>> texts_and_tables(
      const std::string& key, bool may_be_texts = true) const;

  /// Returns the dotted keys ("insertion.h_max") of all values below that are no tables, in alphabetical
  /// order.
  std::vector<std::string> leaves() const;
  /// Returns the number of elements of the list at a dotted key, at least one.
  std::size_t count(const std::string& leaf) const;
  /// Stands for the whole value instead of an element.
  static constexpr std::size_t kWhole = static_cast<std::size_t>(-1);
  /// Returns element `i` of the list at a dotted key as TOML; texts have no quotes.
  std::string element_text(const std::string& leaf, std::size_t i) const;
  /// Returns this table, in which the value at each dotted key is element `choice[k]` of the list in `lists`.
  /// Later choices come first. Throws InputError if such a key lies below a value that is no table.
  TomlTable with_choice(const TomlTable& lists, const std::vector<std::string>& leaves,
                        const std::vector<std::size_t>& choice) const;

  /// Throws InputError for a present key that is unknown, with the nearest known key. Call it first, before a
  /// misspelled key is reported as missing.
  void require_known(const TomlKeys& keys) const;

  /// Removed keys, each with its replacement.
  using RemovedKeys = std::vector<std::pair<const char*, const char*>>;
  /// Throws InputError for a removed key.
  void refuse_removed(const RemovedKeys& keys) const;

 private:
  void read(const std::string& key, const TomlTarget& target) const;

  struct Data;
  explicit TomlTable(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace delquad
