#include "sweep/calibration_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sweep/calibration.h"

namespace delquad {
namespace {

/// Part by which it has more quads than it should.
double excess(const CalibrationRecord& c) { return c.quads / c.wanted - 1; }

/// The cells of one peer on one case, all seeds and variants.
struct Calibrations {
  std::string name, pipeline;
  std::vector<const CalibrationRecord*> cells;
};

std::vector<Calibrations> grouped(const std::vector<CellRecord>& records) {
  std::vector<Calibrations> groups;
  for (const CellRecord& record : records) {
    if (!record.calibration) continue;
    auto at = std::ranges::find_if(groups, [&](const Calibrations& g) {
      return g.name == record.name && g.pipeline == record.pipeline;
    });
    if (at == groups.end()) at = groups.insert(at, {record.name, record.pipeline, {}});
    at->cells.push_back(&*record.calibration);
  }
  return groups;
}

std::string factors(const std::vector<const CalibrationRecord*>& cells) {
  const auto [least, most] = std::ranges::minmax(cells, {}, &CalibrationRecord::size_factor);
  const std::string low = fmt::format("{:.3g}", least->size_factor),
                    high = fmt::format("{:.3g}", most->size_factor);
  return low == high ? low : low + " to " + high;
}

std::string note(const Calibrations& group) {
  const std::string head = group.name + " " + group.pipeline;
  const std::string& word = group.cells[0]->to;
  std::vector<const CalibrationRecord*> cells = group.cells;
  std::erase_if(cells, [](const CalibrationRecord* c) { return !(c->wanted > 0); });
  if (cells.empty()) return fmt::format("{}: size as given, for {} has no mesh to compare with", head, word);
  const CalibrationRecord& worst = *std::ranges::max(cells, {}, [](auto* c) { return std::abs(excess(*c)); });
  if (std::abs(excess(worst)) <= kEquallyMany)
    return fmt::format("{}: size times {}, so that it has {}'s number of quads within 1 %", head,
                       factors(cells), word);
  std::string text =
      fmt::format("{}: size times {}, and yet {:.3g} % {} quads than {} after {} runs", head, factors(cells),
                  100 * std::abs(excess(worst)), excess(worst) > 0 ? "more" : "fewer", word, worst.runs);
  return worst.ended_by.empty() ? text : text + ": " + worst.ended_by;
}

}  // namespace

std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records) {
  std::vector<std::string> notes;
  for (const Calibrations& group : grouped(records)) notes.push_back(note(group));
  return notes;
}

}  // namespace delquad
