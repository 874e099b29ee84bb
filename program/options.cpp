// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/options.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <system_error>

#include "base/located.h"
#include "base/text.h"
#include "experiments/sweep/folders.h"
#include "io/mesh_io.h"
#include "metrics/judgement/criteria.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error))
    return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
  // Files that are still to be made.
  const auto full = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(behind_links(path), error), error);
  };
  return full(a) == full(b);
}

}  // namespace

void check_output(const fs::path& path) {
  const fs::path target = behind_links(path);
  std::error_code error;
  if (fs::is_directory(target, error)) refuse("{}: is a folder: expected a file to write", path.string());
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    return;  // a device: no folder to check
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (!fs::is_directory(folder, error))
    refuse("{}: there is no folder '{}': make it first", path.string(), folder.string());
  prepare_folder(folder);
}

void check_distinct(const std::vector<std::pair<std::string, fs::path>>& files) {
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto& [role, path] = files[i];
      const auto& [other_role, other] = files[j];
      if (path.empty() || other.empty() || !is_same(path, other)) continue;
      refuse("{} {}: is the same file as {} {}: expected another file", role, path.string(), other_role,
             other.string());
    }
}

const CLI::Validator kCount(
    [](std::string& text) -> std::string {
      constexpr double kMost = 1e15;  // far from overflow
      const auto count = as_number(text);
      if (!count || *count != std::floor(*count) || *count < 1 || *count > kMost)
        return "'" + text.substr(0, 40) +
               "': expected a whole number from 1 to 1e15, such as 50000000 or 1e6";
      text = std::to_string(static_cast<long long>(*count));
      return "";
    },
    "");

const CLI::Validator kLength(
    [](std::string& text) -> std::string {
      const auto value = as_number(text);
      const bool good = value && *value > 0 && std::isfinite(*value);
      return good ? "" : "'" + text.substr(0, 40) + "': expected a finite number > 0";
    },
    "");

/// Keeps an empty text apart from none.
CLI::Option* add_size(CLI::App& command, std::optional<std::string>& size, const char* help) {
  return command.add_option_function<std::string>(
      "--size", [&size](const std::string& text) { size = text; }, help);
}

void add_data(CLI::App& command, std::filesystem::path& data) {
  command.add_option("--data", data, "folder of the models that cases call data")->capture_default_str();
}

void add_criteria(CLI::App& command, std::string& criteria, bool& strict) {
  std::string names;
  for (const Criteria& preset : criteria_presets()) names += preset.name + ", ";
  command.add_option("--criteria", criteria, "judge elements by " + names + "or a file of limits (.toml)")
      ->check([](const std::string& text) {
        return text.empty() ? "it is empty: expected a name or a file" : std::string();
      });
  command.add_flag("--strict", strict, "elements beyond the criteria are an error (exit code 5)");
}

std::vector<double> read_list(const std::string& option, const std::string& text, std::size_t count,
                              const char* example) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto value = as_number(part);
    numbers.push_back(value && std::isfinite(*value) ? *value : std::nan(""));
  }
  if (numbers.size() != count || std::ranges::any_of(numbers, [](double x) { return std::isnan(x); }))
    refuse("{} '{}': expected {} finite numbers, such as {}", option, text, count, example);
  return numbers;
}

void add_threads(CLI::App& command, int& threads) {
  command
      .add_option("--threads", threads,
                  "threads, whatever their number the result is the same; default: all cores")
      ->check(CLI::Range(1, kMostThreads));
}

void add_max_elements(CLI::App& command, long long& most, const char* help) {
  command.add_option("--max-elements", most, help)->capture_default_str()->transform(kCount);
}

}  // namespace delquad
