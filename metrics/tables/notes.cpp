// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "metrics/tables/samples.h"

namespace delquad {
namespace {

/// List of values of T by name, in the order of first use.
template <class T>
using ByName = std::vector<std::pair<std::string, T>>;

template <class T>
T& of(const std::string& name, ByName<T>& all) {
  auto at = std::ranges::find(all, name, &std::pair<std::string, T>::first);
  return at == all.end() ? all.emplace_back(name, T()).second : at->second;
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

using Calibrations = std::vector<CalibrationRecord>;

/// Returns the part by which it has too many quads.
double excess(const CalibrationRecord& c) { return c.quads / c.wanted - 1; }

std::string note(const std::string& name, Calibrations runs) {
  const std::string word = runs[0].to;
  std::erase_if(runs, [](const CalibrationRecord& c) { return !(c.wanted > 0); });
  if (runs.empty()) return fmt::format("{}: size as given, for {} has no mesh to compare with", name, word);
  const auto [least, most] = std::ranges::minmax(runs, {}, &CalibrationRecord::size_factor);
  const CalibrationRecord& worst =
      *std::ranges::max_element(runs, {}, [](const auto& c) { return std::abs(excess(c)); });
  std::string text = fmt::format("{}: size times {:.3g}", name, least.size_factor);
  if (least.size_factor < most.size_factor) text += fmt::format(" to {:.3g}", most.size_factor);
  const auto missed =
      std::ranges::count_if(runs, [](const auto& c) { return std::abs(excess(c)) > kEquallyMany; });
  if (missed == 0) return fmt::format("{}, so that it has {}'s number of quads within 1 %", text, word);
  text += fmt::format(", and yet {} of {} meshes miss {}'s number of quads, by {:+.3g} % at most", missed,
                      runs.size(), word, 100 * excess(worst));
  return worst.ended_by.empty() ? text : text + ": " + worst.ended_by;
}

double quads_of(const CellRecord& record) {
  const double triangles = value_of(record, "n_triangles");
  return value_of(record, "n_quads") + (triangles > 0 ? triangles / 2 : 0);
}

/// Lists other pipelines with the least and largest excess of quads in percent: ", FB +3 to +17 %". Pipelines
/// within the peers' tolerance are left out.
std::string others_text(const std::vector<CellRecord>& records, const std::string& target) {
  std::map<std::string, double> wanted;  // by case and variant
  for (const CellRecord& record : records)
    if (record.pipeline == target && makes_quads(record)) wanted[record.group] = quads_of(record);
  ByName<std::vector<double>> words;
  for (const CellRecord& record : records)
    if (!record.calibration && record.pipeline != target && wanted.contains(record.group) &&
        makes_quads(record))
      of(record.pipeline, words).push_back(100 * (quads_of(record) / wanted[record.group] - 1));
  std::string text;
  for (const auto& [word, percents] : words)
    if (const auto [low, high] = std::ranges::minmax(percents); std::max(-low, high) > 100 * kEquallyMany) {
      const std::string least = fmt::format("{:+.2g}", low), most = fmt::format("{:+.2g}", high);
      text += fmt::format(", {} {}{} %", word, least, least == most ? "" : " to " + most);
    }
  return text;
}

/// Cases on which a pipeline has quads, leaves triangles among them, and has no quads.
struct Cases {
  std::vector<std::string> all, with_triangles, without_quads;
};

ByName<Cases> cases_by_pipeline(const std::vector<CellRecord>& records) {
  ByName<Cases> words;
  for (const CellRecord& record : records) {
    if (!record.reason.empty()) continue;
    Cases& cases = of(record.pipeline, words);
    add_once(record.name, makes_quads(record) ? cases.all : cases.without_quads);
    if (leaves_triangles(record)) add_once(record.name, cases.with_triangles);
  }
  std::erase_if(words, [](const auto& word) { return word.second.all.empty(); });  // pipelines of triangles
  return words;
}

std::string named(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNamed = 5;
  const std::size_t shown = std::min(names.size(), kMostNamed);
  const std::string text = fmt::format("{}", fmt::join(std::span(names).first(shown), ", "));
  return shown == names.size() ? text : fmt::format("{} and {} more", text, names.size() - shown);
}

}  // namespace

std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records) {
  ByName<Calibrations> peers;
  for (const CellRecord& record : records)
    if (record.calibration) of(record.name + " " + record.pipeline, peers).push_back(*record.calibration);
  std::vector<std::string> notes;
  for (const auto& [name, runs] : peers) notes.push_back(note(name, runs));
  return notes;
}

std::vector<std::string> quad_count_notes(const std::vector<CellRecord>& records) {
  ByName<std::vector<std::string>> targets;
  for (const CellRecord& record : records)
    if (record.calibration) add_once(record.pipeline, of(record.calibration->to, targets));
  std::vector<std::string> notes;
  for (const auto& [target, peers] : targets) {
    const std::string others = others_text(records, target);
    notes.push_back(fmt::format("Calibrated, by their sizes, to {}'s number of quads: {}{}", target,
                                fmt::join(peers, ", "),
                                others.empty() ? "" : ". Not calibrated, beside it: " + others.substr(2)));
  }
  return notes;
}

std::vector<std::string> triangle_notes(const std::vector<CellRecord>& records,
                                        const std::string& consequence) {
  std::vector<std::string> notes;
  const ByName<Cases> words = cases_by_pipeline(records);
  for (const auto& [word, cases] : words)
    if (words.size() > 1 && !cases.with_triangles.empty())
      notes.push_back(fmt::format("{} leaves triangles in {} of {} cases ({}): {}", word,
                                  cases.with_triangles.size(), cases.all.size(), named(cases.with_triangles),
                                  consequence));
  return notes;
}

std::vector<std::string> quadless_notes(const std::vector<CellRecord>& records) {
  std::vector<std::string> notes;
  for (const auto& [word, cases] : cases_by_pipeline(records))
    if (const std::size_t n = cases.without_quads.size(); n > 0)
      notes.push_back(fmt::format("{} made no quads on {} ({}): it failed there in pairs", word,
                                  n == 1 ? "one case" : fmt::format("{} cases", n),
                                  named(cases.without_quads)));
  return notes;
}

}  // namespace delquad
