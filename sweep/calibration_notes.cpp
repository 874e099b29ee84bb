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
  std::vector<const CellRecord*> cells;
};

const CalibrationRecord& calibration_of(const CellRecord* cell) { return *cell->calibration; }
double miss(const CellRecord* cell) { return std::abs(excess(calibration_of(cell))); }

std::vector<Calibrations> grouped(const std::vector<CellRecord>& records) {
  std::vector<Calibrations> groups;
  for (const CellRecord& record : records) {
    if (!record.calibration) continue;
    auto at = std::ranges::find_if(groups, [&](const Calibrations& g) {
      return g.name == record.name && g.pipeline == record.pipeline;
    });
    if (at == groups.end()) at = groups.insert(at, {record.name, record.pipeline, {}});
    at->cells.push_back(&record);
  }
  return groups;
}

std::string factors(const std::vector<const CellRecord*>& cells) {
  const auto factor = [](const CellRecord* cell) { return calibration_of(cell).size_factor; };
  const auto [least, most] = std::ranges::minmax(cells, {}, factor);
  const std::string low = fmt::format("{:.3g}", factor(least)), high = fmt::format("{:.3g}", factor(most));
  return low == high ? low : low + " to " + high;
}

std::string note(const Calibrations& group) {
  const std::string head = group.name + " " + group.pipeline;
  const std::string& word = calibration_of(group.cells[0]).to;
  std::vector<const CellRecord*> cells = group.cells;
  std::erase_if(cells, [](const CellRecord* cell) { return !(calibration_of(cell).wanted > 0); });
  if (cells.empty()) return fmt::format("{}: size as given, for {} has no mesh to compare with", head, word);
  const auto missed = std::ranges::count_if(cells, [](auto* cell) { return miss(cell) > kEquallyMany; });
  const std::string times = fmt::format("{}: size times {}", head, factors(cells));
  if (missed == 0) return fmt::format("{}, so that it has {}'s number of quads within 1 %", times, word);
  const CellRecord& worst = *std::ranges::max(cells, {}, miss);
  const CalibrationRecord& c = *worst.calibration;
  const std::string by = fmt::format("{:.3g} % {} quads than {} after {} runs", 100 * miss(&worst),
                                     excess(c) > 0 ? "more" : "fewer", word, c.runs),
                    why = c.ended_by.empty() ? "" : ": " + c.ended_by;
  if (cells.size() == 1) return times + ", and yet " + by + why;
  const std::string where = worst.group.substr(std::min(worst.name.size() + 1, worst.group.size()));
  return fmt::format("{}; 1 % missed in {} of {} cells, at worst {} ({}){}", times, missed, cells.size(), by,
                     where.empty() ? worst.name : where, why);
}

}  // namespace

std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records) {
  std::vector<std::string> notes;
  for (const Calibrations& group : grouped(records)) notes.push_back(note(group));
  return notes;
}

}  // namespace delquad
