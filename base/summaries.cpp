// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <stdexcept>
#include <type_traits>

#include "delquad/extend.h"
#include "delquad/options.h"

namespace delquad {
namespace {

template <class T>
constexpr bool kIsList =
    std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<std::vector<double>>>;

/// Combines a number with another field's.
template <class T>
T merged(T a, double weight_a, T b, double weight_b, Over over) {
  if (over == Over::kSum) return a + b;
  if (over == Over::kMost) return std::max(a, b);
  if (over == Over::kLeast) return std::min(a, b);
  const double weight = weight_a + weight_b;
  return weight > 0 ? static_cast<T>((weight_a * static_cast<double>(a) + weight_b * static_cast<double>(b)) /
                                     weight)
                    : a;
}

void merge(SummaryField& total, const SummaryField& other, const std::string& step) {
  if (total.value.index() != other.value.index())
    throw std::invalid_argument("summary '" + step + "': the values of '" + other.key + "' are of two types");
  std::visit(
      [&](auto& value) {
        using T = std::remove_cvref_t<decltype(value)>;
        const T& more = std::get<T>(other.value);
        if constexpr (std::is_arithmetic_v<T>) {
          value = merged(value, total.weight, more, other.weight, other.over);
        } else if constexpr (kIsList<T>) {
          value.insert(value.end(), more.begin(), more.end());
        } else if constexpr (std::is_same_v<T, std::string>) {
          if (other.weight > total.weight) value = more;
        } else {
          for (const auto& [name, count] : more) value[name] += count;
        }
      },
      total.value);
  if (std::holds_alternative<std::string>(total.value))
    total.weight = std::max(total.weight, other.weight);
  else
    total.weight += other.weight;
}

}  // namespace

const SummaryField* SummaryStep::find(const std::string& key) const {
  const auto at = std::ranges::find(fields, key, &SummaryField::key);
  return at == fields.end() ? nullptr : &*at;
}

void Summaries::add(const std::string& step, const std::vector<SummaryField>& fields) {
  auto at = std::ranges::find(steps_, step, &SummaryStep::name);
  if (at == steps_.end()) at = steps_.insert(at, {step, {}});
  for (const SummaryField& field : fields) {
    const auto total = std::ranges::find(at->fields, field.key, &SummaryField::key);
    if (total == at->fields.end())
      at->fields.push_back(field);
    else
      merge(*total, field, step);
  }
}

void Summaries::add(const Summaries& other) {
  for (const SummaryStep& step : other.steps_) add(step.name, step.fields);
}

const SummaryStep* Summaries::find(const std::string& step) const {
  const auto at = std::ranges::find(steps_, step, &SummaryStep::name);
  return at == steps_.end() ? nullptr : &*at;
}

const SummaryValue& Summaries::at(const std::string& step, const std::string& key) const {
  const SummaryStep* of_step = find(step);
  const SummaryField* field = of_step == nullptr ? nullptr : of_step->find(key);
  if (field == nullptr) throw std::out_of_range("the summaries have no '" + key + "' of step '" + step + "'");
  return field->value;
}

double Summaries::number(const std::string& step, const std::string& key) const {
  const SummaryValue& value = at(step, key);
  if (const auto* whole = std::get_if<long long>(&value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  throw std::out_of_range("'" + key + "' of step '" + step + "' is no number");
}

void StageLog::add_time(const std::string& step, const TimeSpent& time) {
  const auto at = std::ranges::find(times, step, &StepTimes::value_type::first);
  if (at == times.end())
    times.emplace_back(step, time);
  else
    at->second = at->second + time;
}

void StageLog::add(const StageLog& other) {
  for (const auto& [step, time] : other.times) add_time(step, time);
  summaries.add(other.summaries);
}

}  // namespace delquad
