// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <vector>

#include "delquad/options.h"

// This header turns summaries of steps into fields of records. All stages use it.

namespace delquad {

/// A member of a step's summary: its key in records, and its sum over patches.
template <class Summary, class Value>
struct CounterField {
  const char* key;
  Value Summary::*member;
  Over over;
};

/// Returns the field of a member; `over` tells how records combine the values of patches.
template <class Summary, class Value>
constexpr CounterField<Summary, Value> counter(const char* key, Value Summary::*member,
                                               Over over = Over::kSum) {
  return {key, member, over};
}

/// Specialized for each summary: `step`, its name in records, and `all`, its members in the order of records.
/// Summaries with means also have `weight(summary)`.
template <class Summary>
struct Counters;

/// Appends a member as fields. Other types have their own overloads.
template <class Value>
requires std::is_arithmetic_v<Value>
void append_counter(std::vector<SummaryField>& fields, const char* key, Value value, Over over,
                    double weight) {
  if constexpr (std::is_floating_point_v<Value>)
    fields.push_back({key, value, over, weight});
  else
    fields.push_back({key, static_cast<long long>(value), over, weight});
}

/// Appends fields of other sources unchanged.
inline void append_counter(std::vector<SummaryField>& fields, const char*,
                           const std::vector<SummaryField>& others, Over, double) {
  fields.insert(fields.end(), others.begin(), others.end());
}

namespace counters_detail {
struct AnyMember {
  template <class T>
  operator T() const;  // NOLINT: converts to the type of any member
};
/// Returns the number of members of an aggregate.
template <class T, class... Members>
consteval std::size_t n_members() {
  if constexpr (requires { T{Members{}..., AnyMember{}}; })
    return n_members<T, Members..., AnyMember>();
  else
    return sizeof...(Members);
}
}  // namespace counters_detail

/// Calls visit(field) for every member of a summary. A member missing from the list does not compile.
template <class Summary, class Visit>
void for_each_counter(Visit&& visit) {
  static_assert(std::tuple_size_v<decltype(Counters<Summary>::all)> == counters_detail::n_members<Summary>(),
                "a member of the summary is not in its list of counters");
  std::apply([&](const auto&... field) { (visit(field), ...); }, Counters<Summary>::all);
}

/// Adds another call's counters to a summary, which must have no means.
template <class Summary>
void add_counters(Summary& total, const Summary& more) {
  for_each_counter<Summary>([&](const auto& field) {
    auto& value = total.*field.member;
    const auto other = more.*field.member;
    if (field.over == Over::kSum)
      value += other;
    else
      value = field.over == Over::kMost ? std::max(value, other) : std::min(value, other);
  });
}

/// Returns the fields of a summary for Summaries::add(Counters<Summary>::step, ...); means have its weight,
/// or 1.
template <class Summary>
std::vector<SummaryField> fields_of(const Summary& summary) {
  double weight = 1;
  if constexpr (requires { Counters<Summary>::weight(summary); }) weight = Counters<Summary>::weight(summary);
  std::vector<SummaryField> fields;
  for_each_counter<Summary>([&](const auto& field) {
    append_counter(fields, field.key, summary.*field.member, field.over, weight);
  });
  return fields;
}

}  // namespace delquad
