#include "sweep/fairness_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sweep/calibration.h"
#include "sweep/samples.h"
#include "sweep/statistics.h"

namespace delquad {
namespace {

using ByPipeline = std::map<std::string, std::vector<const CellRecord*>>;

/// "3 cases (a, b, c)"
std::string listed(const std::set<std::string>& names) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<std::string> some(names.begin(), names.end());
  if (some.size() > kMostNamed) {
    some.resize(kMostNamed);
    some.emplace_back("...");
  }
  return fmt::format("{} case{} ({})", names.size(), names.size() == 1 ? "" : "s", fmt::join(some, ", "));
}

void note_triangles(const ByPipeline& meshes, std::vector<std::string>& notes) {
  if (meshes.size() < 2) return;
  for (const auto& [pipeline, records] : meshes) {
    std::set<std::string> cases;
    for (const CellRecord* record : records)
      if (leaves_triangles(*record)) cases.insert(record->name);
    if (!cases.empty())
      notes.push_back(
          fmt::format("{} leaves triangles in {}: it is not compared with others in measures of quads "
                      "(eta, d4 and the like)",
                      pipeline, listed(cases)));
  }
}

/// Part by which the second has more quads than the first, in the mean of the runs of each case.
std::vector<double> excesses(const std::vector<const CellRecord*>& of,
                             const std::vector<const CellRecord*>& than) {
  std::map<std::string, std::vector<double>> ratios;  // by case
  for (const CellRecord* b : than)
    for (const CellRecord* a : of)
      if (a->group == b->group && value_of(*b, "n_quads") > 0)
        ratios[a->name].push_back(value_of(*a, "n_quads") / value_of(*b, "n_quads") - 1);
  std::vector<double> means;
  for (const auto& [name, values] : ratios) means.push_back(mean(values));
  return means;
}

std::string in_percent(double excess) {
  return fmt::format("{:.2g} % {}", 100 * std::abs(excess), excess < 0 ? "fewer" : "more");
}

void note_numbers(const ByPipeline& meshes, const std::set<std::string>& references,
                  std::vector<std::string>& notes) {
  for (const std::string& reference : references) {
    const auto than = meshes.find(reference);
    if (than == meshes.end()) continue;
    for (const auto& [pipeline, records] : meshes) {
      if (pipeline == reference || records[0]->calibration) continue;
      const std::vector<double> all = excesses(records, than->second);
      if (all.empty()) continue;
      const auto [least, most] = std::ranges::minmax(all);
      if (std::max(std::abs(least), std::abs(most)) <= kEquallyMany) continue;
      const std::string low = in_percent(least), high = in_percent(most);
      notes.push_back(fmt::format("{} has {} quads than {}, to whose number the other meshers were brought",
                                  pipeline, low == high ? low : low + " to " + high, reference));
    }
  }
}

}  // namespace

std::vector<std::string> fairness_notes(const std::vector<CellRecord>& records) {
  ByPipeline meshes;
  std::set<std::string> references;
  for (const CellRecord& record : records) {
    if (!record.reason.empty() || !makes_quads(record)) continue;
    meshes[record.pipeline].push_back(&record);
    if (record.calibration) references.insert(record.calibration->to);
  }
  std::vector<std::string> notes;
  note_triangles(meshes, notes);
  note_numbers(meshes, references, notes);
  return notes;
}

}  // namespace delquad
