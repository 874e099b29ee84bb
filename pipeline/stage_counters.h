#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <tuple>

#include "pipeline/stages.h"

namespace delquad {

/// What the summaries of the steps hold, field by field, in the one place that adding them up over patches,
/// writing them to records and checking the documentation go by.

/// How the values of several patches become one.
enum class Over { kSum, kMost, kLeast };

template <class Summary, class Value>
struct CounterField {
  const char* key;  ///< in records
  Value Summary::*member;
  Over over;
};

template <class Summary, class Value>
constexpr CounterField<Summary, Value> counter(const char* key, Value Summary::*member,
                                               Over over = Over::kSum) {
  return {key, member, over};
}

/// `all`: every field of a summary, in the order of records.
template <class Summary>
struct Counters;

template <>
struct Counters<FrontalSummary> {
  using S = FrontalSummary;
  static constexpr auto all = std::tuple{counter("termination", &S::termination, Over::kMost),
                                         counter("inserted", &S::inserted),
                                         counter("packed", &S::packed),
                                         counter("rejected", &S::rejected),
                                         counter("unresolved", &S::unresolved),
                                         counter("layers", &S::layers, Over::kMost),
                                         counter("seconds", &S::seconds)};
};

template <>
struct Counters<AdaptationSummary> {
  using S = AdaptationSummary;
  static constexpr auto all = std::tuple{counter("sweeps", &S::sweeps, Over::kMost),
                                         counter("splits", &S::splits),
                                         counter("collapses", &S::collapses),
                                         counter("swaps", &S::swaps),
                                         counter("moves", &S::moves),
                                         counter("seconds", &S::seconds)};
};

template <>
struct Counters<RecombineSummary> {
  using S = RecombineSummary;
  static constexpr auto all = std::tuple{counter("triangles", &S::triangles),
                                         counter("split_chords", &S::split_chords),
                                         counter("extra_edges", &S::extra_edges),
                                         counter("matched_extra", &S::matched_extra),
                                         counter("pentagon_swaps", &S::pentagon_swaps),
                                         counter("duplications", &S::duplications),
                                         counter("leftover_triangles", &S::leftover_triangles),
                                         counter("cost", &S::cost),
                                         counter("graph_seconds", &S::graph_seconds),
                                         counter("matching_seconds", &S::matching_seconds),
                                         counter("merge_seconds", &S::merge_seconds)};
};

template <>
struct Counters<TreatmentSummary> {
  using S = TreatmentSummary;
  static constexpr auto all = std::tuple{counter("rounds", &S::rounds, Over::kMost),
                                         counter("doublets", &S::doublets),
                                         counter("diamonds", &S::diamonds),
                                         counter("swaps", &S::swaps),
                                         counter("openings", &S::openings),
                                         counter("boundary_repairs", &S::boundary_repairs),
                                         counter("ring_quads", &S::ring_quads),
                                         counter("relocated", &S::relocated),
                                         counter("looks", &S::looks),
                                         counter("seconds", &S::seconds)};
};

template <>
struct Counters<CleanupSummary> {
  using S = CleanupSummary;
  static constexpr auto all = std::tuple{counter("irregular_before", &S::irregular_before),
                                         counter("irregular_after", &S::irregular_after),
                                         counter("rotations", &S::rotations),
                                         counter("diamonds", &S::diamonds),
                                         counter("doublets", &S::doublets),
                                         counter("splits", &S::splits),
                                         counter("openings", &S::openings),
                                         counter("tried", &S::tried),
                                         counter("annealed", &S::annealed),
                                         counter("relocated", &S::relocated),
                                         counter("looks", &S::looks),
                                         counter("seconds", &S::seconds)};
};

template <>
struct Counters<OptimisationSummary> {
  using S = OptimisationSummary;
  static constexpr auto all = std::tuple{counter("untangled", &S::untangled),
                                         counter("held", &S::held),
                                         counter("iterations", &S::iterations),
                                         counter("evaluations", &S::evaluations),
                                         counter("energy_before", &S::energy_before),
                                         counter("energy_after", &S::energy_after),
                                         counter("worst_before", &S::worst_before, Over::kLeast),
                                         counter("worst_after", &S::worst_after, Over::kLeast),
                                         counter("seconds", &S::seconds)};
};

template <>
struct Counters<DiscardSummary> {
  using S = DiscardSummary;
  static constexpr auto all =
      std::tuple{counter("treatments", &S::treatments), counter("cleanups", &S::cleanups)};
};

template <>
struct Counters<PartingSummary> {
  using S = PartingSummary;
  static constexpr auto all = std::tuple{counter("chords", &S::chords),
                                         counter("left", &S::left),
                                         counter("rings", &S::rings),
                                         counter("corners", &S::corners),
                                         counter("corners_left", &S::corners_left),
                                         counter("seconds", &S::seconds)};
};

template <>
struct Counters<LiftingSummary> {
  using S = LiftingSummary;
  static constexpr auto all =
      std::tuple{counter("moved", &S::moved), counter("rings", &S::rings), counter("seconds", &S::seconds)};
};

namespace counters_detail {
struct Anything {
  template <class T>
  operator T() const;  // NOLINT: converts to the type of any member
};
/// How many members an aggregate has.
template <class T, class... Members>
consteval std::size_t n_members() {
  if constexpr (requires { T{Members{}..., Anything{}}; })
    return n_members<T, Members..., Anything>();
  else
    return sizeof...(Members);
}
}  // namespace counters_detail

/// Calls visit(field) for every field of a summary. A member that is missing from the list does not compile.
template <class Summary, class Visit>
void for_each_counter(Visit&& visit) {
  static_assert(std::tuple_size_v<decltype(Counters<Summary>::all)> == counters_detail::n_members<Summary>(),
                "a member of the summary is not in its list of counters");
  std::apply([&](const auto&... field) { (visit(field), ...); }, Counters<Summary>::all);
}

/// Calls visit(key in records, member of StageLog) for every summary, in the order of records.
template <class Visit>
void for_each_summary(Visit&& visit) {
  visit("insertion", &StageLog::insertion);
  visit("adaptation", &StageLog::adaptation);
  visit("recombination", &StageLog::recombination);
  visit("treatment", &StageLog::treatment);
  visit("cleanup", &StageLog::cleanup);
  visit("optimisation", &StageLog::optimisation);
  visit("discarded", &StageLog::discarded);
  visit("part_twins", &StageLog::part_twins);
  visit("lift_bad_quads", &StageLog::lift_bad_quads);
}

template <class Summary>
void add_counters(std::optional<Summary>& sum, const Summary& other) {
  if (!sum) {
    sum = other;
    return;
  }
  for_each_counter<Summary>([&](const auto& field) {
    auto& total = (*sum).*field.member;
    const auto& value = other.*field.member;
    if (field.over == Over::kMost) total = std::max(total, value);
    if (field.over == Over::kLeast) total = std::min(total, value);
    if constexpr (requires { total += value; })
      if (field.over == Over::kSum) total += value;
  });
}

}  // namespace delquad
