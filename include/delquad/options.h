// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// This header has the options of stages and the values that they report. Stages and bindings use it. Valid
// C++17.

namespace delquad {

using OptionValue = std::variant<bool, long long, double, std::string>;

/// An option with its name, range and default.
struct OptionKey {
  std::string name = {};                                    ///< "h_max"
  std::string help = {};                                    ///< half a sentence
  OptionValue value = 0.0;                                  ///< the default; it has the type of all values
  std::optional<double> least = {}, above = {}, most = {};  ///< range of numbers
  std::vector<OptionValue> allowed = {};                    ///< empty: all values in the range
  std::function<std::vector<std::string>()> names = {};     ///< returns allowed texts at the time of use
  /// Meaning of the default, such as "the strategy's own". The default may be out of range, and records have
  /// null for it.
  std::string absent = {};
};

/// Options of a step; a table of that name in TOML files.
struct OptionGroup {
  std::string name = {};  ///< "insertion"
  std::string help = {};  ///< half a sentence
  std::vector<OptionKey> keys = {};
};

/// Returns all groups, in the order of documents and records.
std::vector<OptionGroup> option_groups();
/// Adds a group before anything is read or meshed. Throws std::invalid_argument for a name that is taken, a
/// repeated key, and a default that its key does not allow.
void add_options(OptionGroup group);

/// Returns the allowed values in words, for messages and documents: "a number from 1.1 to 3".
std::string expected_of(const OptionKey& key);
/// Returns the allowed texts and numbers; empty: all values in the range.
std::vector<OptionValue> allowed_values(const OptionKey& key);
/// Returns the value as written in TOML.
std::string text_of(const OptionValue& value);

/// Values of options by name: "insertion.h_max". Others have their default.
class Options {
 public:
  /// Sets a value; numbers accept integers. Throws InputError with the option and its allowed values, or with
  /// the nearest name for an unknown option.
  Options& set(const std::string& name, OptionValue value);
  /// Restores the default. Throws InputError for unknown options.
  Options& reset(const std::string& name);

  /// Returns the value, or the default. The last four throw InputError for another type, all for an unknown
  /// option.
  OptionValue value(const std::string& name) const;
  bool flag(const std::string& name) const;
  long long integer(const std::string& name) const;
  double number(const std::string& name) const;
  std::string text(const std::string& name) const;

  /// Returns the value that was set, or null.
  const OptionValue* find(const std::string& name) const {
    const auto at = values_.find(name);
    return at == values_.end() ? nullptr : &at->second;
  }
  /// Sets the values of `others` that are not set here. Returns this object.
  Options& set_absent(const Options& others);
  /// Returns the values that were set.
  const std::map<std::string, OptionValue>& values() const { return values_; }
  friend bool operator==(const Options& a, const Options& b) { return a.values_ == b.values_; }

 private:
  std::map<std::string, OptionValue> values_;
};

/// Rule that combines values of several patches.
enum class Over { kSum, kMost, kLeast, kMean };

/// Lists have a value (or list) for each repetition, and grow with every patch. Counts by name are added up.
using SummaryValue = std::variant<long long, double, std::string, std::vector<double>,
                                  std::vector<std::vector<double>>, std::map<std::string, long long>>;

/// A value that a step reports.
struct SummaryField {
  std::string key;  ///< key in records
  SummaryValue value;
  Over over = Over::kSum;  ///< for numbers
  /// Weight of a number in a mean. The text with the largest weight counts for all patches.
  double weight = 1;
};

struct SummaryStep {
  std::string name;  ///< "insertion"
  std::vector<SummaryField> fields;
  /// Returns null if the key is unknown.
  const SummaryField* find(const std::string& key) const;
};

/// Reports of all steps, on one patch or on all patches.
class Summaries {
 public:
  /// Adds values to the earlier values of a step, key by key. Throws std::invalid_argument if types differ.
  void add(const std::string& step, const std::vector<SummaryField>& fields);
  /// Adds the report of another patch, step by step.
  void add(const Summaries& other);

  /// Returns the steps in order of first use.
  const std::vector<SummaryStep>& steps() const { return steps_; }
  /// Returns null if the step did not run.
  const SummaryStep* find(const std::string& step) const;
  bool has(const std::string& step) const { return find(step) != nullptr; }
  /// Returns a number or an integer. Throws std::out_of_range, with step and key, if it is missing.
  double number(const std::string& step, const std::string& key) const;
  /// Returns any value. Also throws std::bad_variant_access if it has another type.
  template <class T>
  const T& get(const std::string& step, const std::string& key) const {
    return std::get<T>(at(step, key));
  }

 private:
  const SummaryValue& at(const std::string& step, const std::string& key) const;
  std::vector<SummaryStep> steps_;
};

/// The time of a step, in seconds.
struct TimeSpent {
  double seconds = 0;  ///< wall-clock time; parallel parts are added up
  double cpu = 0;      ///< processor time of all threads of the step
};

inline TimeSpent operator+(const TimeSpent& a, const TimeSpent& b) {
  return {a.seconds + b.seconds, a.cpu + b.cpu};
}
inline TimeSpent operator-(const TimeSpent& a, const TimeSpent& b) {
  return {a.seconds - b.seconds, a.cpu - b.cpu};
}

/// Times by step, in order of first use.
using StepTimes = std::vector<std::pair<std::string, TimeSpent>>;

/// Log of the stages, on one patch or on all patches.
struct StageLog {
  StepTimes times = {};
  Summaries summaries = {};
  void add_time(const std::string& step, const TimeSpent& time);
  /// Adds a time without processor time.
  void add_seconds(const std::string& step, double s) { add_time(step, {s, 0}); }
  /// Adds the log of another patch.
  void add(const StageLog& other);
};

}  // namespace delquad
