// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "base/nearest_name.h"
#include "delquad/error.h"
#include "features/sizes/curve_options.h"
#include "mesher/finish_steps.h"
#include "metrics/judgement/poor_quads.h"
#include "smoothing/cvt/smooth_points.h"
#include "smoothing/optimisation/track_optimisation.h"

namespace delquad {
namespace {

std::deque<OptionGroup>& groups() {
  static std::deque<OptionGroup> all = {curve_group(),         insertion_group(),  smoothing_group(),
                                        recombination_group(), regularity_group(), optimisation_group(),
                                        repair_group(),        limit_group()};
  return all;
}

const OptionKey* find_key(const std::string& name) {
  for (const OptionGroup& group : groups())
    if (name.starts_with(group.name + "."))
      for (const OptionKey& key : group.keys)
        if (name.size() == group.name.size() + 1 + key.name.size() && name.ends_with(key.name)) return &key;
  return nullptr;
}

const OptionKey& require_key(const std::string& name) {
  if (const OptionKey* key = find_key(name)) return *key;
  std::vector<std::string> known;
  for (const OptionGroup& group : groups())
    for (const OptionKey& key : group.keys) known.push_back(group.name + "." + key.name);
  throw InputError("unknown option '" + name + "'" + suggestion(name, known));
}

std::optional<double> number_in(const OptionValue& value) {
  if (const auto* whole = std::get_if<long long>(&value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

bool is_allowed(const OptionKey& key, const OptionValue& value) {
  if (const std::vector<OptionValue> allowed = allowed_values(key); !allowed.empty())
    return std::ranges::find(allowed, value) != allowed.end();
  const std::optional<double> number = number_in(value);
  if (!number) return true;
  return std::isfinite(*number) && (!key.least || *number >= *key.least) &&
         (!key.above || *number > *key.above) && (!key.most || *number <= *key.most);
}

std::string type_of(const OptionValue& value) {
  const char* types[] = {"true or false", "a whole number", "a number", "a text"};
  return types[value.index()];
}

template <class T>
T get_as(const std::string& name, const OptionValue& value) {
  if (const T* held = std::get_if<T>(&value)) return *held;
  throw InputError(fmt::format("option '{}' is {}, not {}", name, type_of(value), type_of(T{})));
}

void check_group(const OptionGroup& group) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(fmt::format("options '{}': {}", group.name, what));
  };
  const auto is_bad_name = [](const std::string& name) {
    return name.empty() || name.find_first_of(". \t\n\"'") != std::string::npos;
  };
  if (is_bad_name(group.name)) refuse("the name has to be one plain word");
  for (const OptionGroup& other : groups())
    if (other.name == group.name) refuse("there are options of that name already");
  for (const OptionKey& key : group.keys) {
    if (is_bad_name(key.name)) refuse("the name of key '" + key.name + "' has to be one plain word");
    if (std::ranges::count(group.keys, key.name, &OptionKey::name) > 1)
      refuse("key '" + key.name + "' stands twice");
    if (key.absent.empty() && !is_allowed(key, key.value))
      refuse(fmt::format("the default of '{}' is {}: expected {}", key.name, text_of(key.value),
                         expected_of(key)));
  }
}

std::string listed(const std::vector<OptionValue>& values) {
  std::string list;
  for (std::size_t i = 0; i < values.size(); ++i)
    list += (i == 0 ? "" : i + 1 < values.size() ? ", " : " or ") + text_of(values[i]);
  return list;
}

}  // namespace

std::vector<OptionGroup> option_groups() { return {groups().begin(), groups().end()}; }

void add_options(OptionGroup group) {
  check_group(group);
  groups().push_back(std::move(group));
}

std::vector<OptionValue> allowed_values(const OptionKey& key) {
  std::vector<OptionValue> allowed = key.allowed;
  if (key.names)
    for (std::string& name : key.names()) allowed.emplace_back(std::move(name));
  return allowed;
}

std::string text_of(const OptionValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return "\"" + *text + "\"";
  return std::visit(
      [](const auto& v) {
        if constexpr (requires { v.size(); })
          return v;
        else
          return fmt::format("{}", v);
      },
      value);
}

std::string expected_of(const OptionKey& key) {
  if (const std::vector<OptionValue> allowed = allowed_values(key); !allowed.empty()) return listed(allowed);
  std::string text = type_of(key.value);
  if (!number_in(key.value)) return text;
  // The largest int is no limit that helps a reader.
  const bool bounded = key.most && *key.most < std::numeric_limits<int>::max();
  if (key.least && bounded) return fmt::format("{} from {} to {}", text, *key.least, *key.most);
  if (key.least) text += fmt::format(", at least {}", *key.least);
  if (key.above) text += fmt::format(" above {}", *key.above);
  if (bounded) text += fmt::format("{} at most {}", key.above ? " and" : ",", *key.most);
  return text;
}

Options& Options::set(const std::string& name, OptionValue value) {
  const OptionKey& key = require_key(name);
  if (std::holds_alternative<double>(key.value) && std::holds_alternative<long long>(value))
    value = static_cast<double>(std::get<long long>(value));
  if (value.index() != key.value.index() || !is_allowed(key, value))
    throw InputError(fmt::format("'{}' is {}: expected {}", name, text_of(value), expected_of(key)));
  values_[name] = std::move(value);
  return *this;
}

Options& Options::reset(const std::string& name) {
  require_key(name);
  values_.erase(name);
  return *this;
}

Options& Options::set_absent(const Options& others) {
  values_.insert(others.values_.begin(), others.values_.end());
  return *this;
}

OptionValue Options::value(const std::string& name) const {
  const OptionKey& key = require_key(name);
  const OptionValue* given = find(name);
  return given == nullptr ? key.value : *given;
}

bool Options::flag(const std::string& name) const { return get_as<bool>(name, value(name)); }
long long Options::integer(const std::string& name) const { return get_as<long long>(name, value(name)); }
double Options::number(const std::string& name) const { return get_as<double>(name, value(name)); }
std::string Options::text(const std::string& name) const { return get_as<std::string>(name, value(name)); }

}  // namespace delquad
