#include "experiments/sweep/experiment_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// What looks like placeholders, such as "{input}"; not "${input}", which is the shell's.
std::vector<std::string> names_in_braces(const std::string& word) {
  std::vector<std::string> names;
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  for (std::size_t at = 0; (at = word.find('{', at)) != std::string::npos; ++at) {
    const auto end = word.find('}', at);
    if (end == std::string::npos || end == at + 1 || (at > 0 && word[at - 1] == '$')) continue;
    const std::string name = word.substr(at, end + 1 - at);
    if (std::all_of(name.begin() + 1, name.end() - 1, is_letter)) names.push_back(name);
  }
  return names;
}

bool is_program_text(const std::string& word) {
  return word.find_first_of(" \t\n\"'$;(") != std::string::npos;
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

int read_count(const TomlTable& table, const char* key, int least, int most, int absent) {
  const long long count = table.integer(key, absent);
  if (!table.has(key) || (count >= least && count <= most)) return static_cast<int>(count);
  throw InputError(
      fmt::format("{}: '{}' is {}: expected {} to {}", table.where(key), key, count, least, most));
}

void check_placeholders(const TomlTable& table, const std::vector<std::string>& command,
                        const std::vector<std::string>& known,
                        const std::vector<std::vector<std::string>>& needed) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(table.where("command") + ": 'command' " + what);
  };
  std::vector<std::string> strange;
  for (const std::string& word : command)
    for (const std::string& name : names_in_braces(word)) {
      if (std::ranges::find(known, name) != known.end()) continue;
      if (is_program_text(word))
        strange.push_back(name);
      else
        refuse(fmt::format("has the unknown {}; known: {}{}", name, fmt::join(known, ", "),
                           suggestion(name, known)));
    }
  for (const std::vector<std::string>& group : needed) {
    if (std::ranges::any_of(group, [&](const std::string& name) { return has_placeholder(command, name); }))
      continue;
    for (const std::string& name : strange)
      if (const std::string near = suggestion(name, group); !near.empty())
        refuse("has the unknown " + name + near);
    refuse(fmt::format("lacks {}", fmt::join(group, ", and in its place ")));
  }
}

bool has_placeholder(const std::vector<std::string>& command, const std::string& placeholder) {
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
