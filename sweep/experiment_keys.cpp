#include "sweep/experiment_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "delquad/error.h"
#include "sweep/tables.h"

namespace delquad {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::vector<int> read_counts(const TomlTable& table, const std::string& key, double least, double most) {
  std::vector<int> counts;
  for (const double n : table.numbers(key)) {
    if (n != std::floor(n) || n < least || n > most)
      throw InputError(table.where(key) + ": '" + key + "' must hold integers from " +
                       std::to_string(static_cast<int>(least)) + " to " +
                       std::to_string(static_cast<int>(most)));
    counts.push_back(static_cast<int>(n));
  }
  if (counts.empty()) throw InputError(table.where(key) + ": '" + key + "' is empty");
  return counts;
}

std::vector<std::string> read_command(const TomlTable& table, const char* key) {
  std::vector<std::string> command = table.texts(key);
  if (!command.empty() && !command[0].empty()) return command;
  throw InputError(
      fmt::format("{}: '{}' is empty: expected a program and its arguments", table.where(key), key));
}

bool has_placeholder(const std::vector<std::string>& command, const char* placeholder) {
  return std::ranges::any_of(command, [&](const std::string& w) { return w.find(placeholder) != w.npos; });
}

void check_folder_name(const TomlTable& table, const std::string& name,
                       const std::vector<std::string>& others) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() || name.front() == '.' || name.size() > 100 ||
      !std::all_of(name.begin(), name.end(), plain))
    throw InputError(table.where("name") + ": '" + name +
                     "' names a folder: expected letters, digits, '_', '-' and '.', not at the front");
  for (const std::string& other : others)
    if (lower_case(other) == lower_case(name))
      throw InputError(table.where("name") + ": a second case '" + name + "'" +
                       (other == name ? "" : ": beside '" + other + "' it would share its folder"));
  for (const std::string& file : result_files())
    if (lower_case(name) == file)
      throw InputError(table.where("name") + ": '" + name +
                       "' names a folder, but that of a file of results");
}

}  // namespace delquad
