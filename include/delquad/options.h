#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// What the stages can be told, and what they tell. Valid C++17.

namespace delquad {

using OptionValue = std::variant<bool, long long, double, std::string>;

/// An option: what it is called, what it may be, and what it is when nobody says.
struct OptionKey {
  std::string name = {};                                    ///< "h_max"
  std::string help = {};                                    ///< half a sentence
  OptionValue value = 0.0;                                  ///< the default, whose type is that of all values
  std::optional<double> least = {}, above = {}, most = {};  ///< limits of numbers
  std::vector<OptionValue> allowed = {};                    ///< empty: all within the limits
  std::function<std::vector<std::string>()> names = {};     ///< texts that are allowed when they are given
  /// What the default stands for, such as "the strategy's own". It need not lie within the limits, and
  /// records have null for it.
  std::string absent = {};
};

/// The options of a step: in TOML files a table of that name.
struct OptionGroup {
  std::string name = {};  ///< "insertion"
  std::string help = {};  ///< half a sentence
  std::vector<OptionKey> keys = {};
};

/// Every group, in the order of documents and records.
std::vector<OptionGroup> option_groups();
/// Adds one from outside, before anything is read or meshed. Throws std::invalid_argument for a name that is
/// taken, for a key that stands twice, and for a default that the key itself does not allow.
void add_options(OptionGroup group);

/// What a key may be, for messages and documents: "a number from 1.1 to 3".
std::string expected_of(const OptionKey& key);
/// The texts and numbers that are allowed and no others; empty: all within the limits.
std::vector<OptionValue> allowed_values(const OptionKey& key);
/// As it is written in TOML.
std::string text_of(const OptionValue& value);

/// Values of options by name: "insertion.h_max". What was not set is the default.
class Options {
 public:
  /// A whole number will do for an option that is a number. Throws InputError that names the option, what it
  /// was expected to be and, where there is no such option, the one of the nearest name.
  Options& set(const std::string& name, OptionValue value);
  /// Makes it the default again. Throws InputError for unknown options.
  Options& reset(const std::string& name);

  /// The value, or the default. Throws InputError for an unknown option, and one of another type.
  OptionValue value(const std::string& name) const;
  bool flag(const std::string& name) const;
  long long integer(const std::string& name) const;
  double number(const std::string& name) const;
  std::string text(const std::string& name) const;

  /// Null: it was not set.
  const OptionValue* find(const std::string& name) const {
    const auto at = values_.find(name);
    return at == values_.end() ? nullptr : &at->second;
  }
  /// Sets what `others` have set and these have not.
  Options& set_absent(const Options& others);
  /// Those that were set.
  const std::map<std::string, OptionValue>& values() const { return values_; }
  friend bool operator==(const Options& a, const Options& b) { return a.values_ == b.values_; }

 private:
  std::map<std::string, OptionValue> values_;
};

/// How the values of several patches become one.
enum class Over { kSum, kMost, kLeast, kMean };

/// A list of one value for each time that something was done, or of such lists, is longer with every patch.
/// Counts by name are added up.
using SummaryValue = std::variant<long long, double, std::string, std::vector<double>,
                                  std::vector<std::vector<double>>, std::map<std::string, long long>>;

/// One of the things that a step tells of what it did.
struct SummaryField {
  std::string key;  ///< in records
  SummaryValue value;
  Over over = Over::kSum;  ///< for numbers
  /// Of a number in a mean. Of a text: that with the largest weight counts for all patches.
  double weight = 1;
};

struct SummaryStep {
  std::string name;  ///< "insertion"
  std::vector<SummaryField> fields;
  /// Null: there is none of that key.
  const SummaryField* find(const std::string& key) const;
};

/// What the steps did, on one patch or on all of them.
class Summaries {
 public:
  /// Adds to what the step did before, or on other patches, key by key. Throws std::invalid_argument where
  /// the types of the values differ.
  void add(const std::string& step, const std::vector<SummaryField>& fields);
  void add(const Summaries& other);

  /// In order of first use.
  const std::vector<SummaryStep>& steps() const { return steps_; }
  /// Null: the step was not made.
  const SummaryStep* find(const std::string& step) const;
  bool has(const std::string& step) const { return find(step) != nullptr; }
  /// A number or a whole number. Throws std::out_of_range, naming step and key, where there is none.
  double number(const std::string& step, const std::string& key) const;
  /// Any value. Throws the same, and std::bad_variant_access where it has another type.
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
  double seconds = 0;  ///< on the clock; of parts that are done side by side, added up
  double cpu = 0;      ///< processor time of all threads that worked for it
};

inline TimeSpent operator+(const TimeSpent& a, const TimeSpent& b) {
  return {a.seconds + b.seconds, a.cpu + b.cpu};
}
inline TimeSpent operator-(const TimeSpent& a, const TimeSpent& b) {
  return {a.seconds - b.seconds, a.cpu - b.cpu};
}

/// By step, in order of first use.
using StepTimes = std::vector<std::pair<std::string, TimeSpent>>;

/// What the stages did: on one patch, or on all of them.
struct StageLog {
  StepTimes times = {};
  Summaries summaries = {};
  void add_time(const std::string& step, const TimeSpent& time);
  /// Where only the clock was read.
  void add_seconds(const std::string& step, double s) { add_time(step, {s, 0}); }
  /// Adds what was done on another patch.
  void add(const StageLog& other);
};

}  // namespace delquad
