#pragma once

#include <functional>
#include <string>
#include <vector>

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
};

using TomlKeys = std::vector<TomlKey>;

}  // namespace delquad
