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

/// Part by which it has more quads than it should.
double excess(const CellRecord* r) { return r->calibration->quads / r->calibration->wanted - 1; }

bool misses(const CellRecord* r) { return std::abs(excess(r)) > kEquallyMany; }

using Cells = std::vector<const CellRecord*>;

/// The cells of each peer on each case, all seeds and variants.
std::vector<Cells> grouped(const std::vector<CellRecord>& records) {
  std::vector<Cells> groups;
  for (const CellRecord& record : records) {
    if (!record.calibration) continue;
    auto at = std::ranges::find_if(groups, [&](const Cells& g) {
      return g[0]->name == record.name && g[0]->pipeline == record.pipeline;
    });
    if (at == groups.end()) at = groups.insert(at, Cells());
    at->push_back(&record);
  }
  return groups;
}

std::string factors(const Cells& cells) {
  const auto factor = [](const CellRecord* r) { return r->calibration->size_factor; };
  const auto [least, most] = std::ranges::minmax(cells, {}, factor);
  const std::string low = fmt::format("{:.3g}", factor(least)), high = fmt::format("{:.3g}", factor(most));
  return low == high ? low : low + " to " + high;
}

/// "seed 2"; "size=0.1, seed=2" where more than the seed varies.
std::string variant_text(const CellRecord& record) {
  if (record.variant.size() == 1) return record.variant[0].first + " " + record.variant[0].second;
  std::vector<std::string> parts;
  for (const auto& [title, value] : record.variant) parts.push_back(title + "=" + value);
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string note_of_missed(const std::string& head, const Cells& cells) {
  const CellRecord& worst = *std::ranges::max(cells, {}, [](auto* r) { return std::abs(excess(r)); });
  const CalibrationRecord& c = *worst.calibration;
  const double percent = 100 * std::abs(excess(&worst));
  const char* side = excess(&worst) > 0 ? "more" : "fewer";
  std::string text;
  if (cells.size() == 1)
    text =
        fmt::format("{}, and yet {:.3g} % {} quads than {} after {} runs", head, percent, side, c.to, c.runs);
  else
    text = fmt::format(
        "{} for {}'s number of quads; 1 % missed in {} of {} {}, by {:.3g} % at most ({}{} quads)", head,
        c.to, std::ranges::count_if(cells, misses), cells.size(),
        worst.variant.size() == 1 && worst.variant[0].first == "seed" ? "seeds" : "runs", percent,
        worst.variant.empty() ? "" : variant_text(worst) + ", ", side);
  return c.ended_by.empty() ? text : text + ": " + c.ended_by;
}

std::string note(Cells cells) {
  const std::string name = cells[0]->name + " " + cells[0]->pipeline, word = cells[0]->calibration->to;
  std::erase_if(cells, [](const CellRecord* r) { return !(r->calibration->wanted > 0); });
  if (cells.empty()) return fmt::format("{}: size as given, for {} has no mesh to compare with", name, word);
  const std::string head = fmt::format("{}: size times {}", name, factors(cells));
  if (std::ranges::any_of(cells, misses)) return note_of_missed(head, cells);
  return fmt::format("{}, so that it has {}'s number of quads within 1 %", head, word);
}

/// The peers that were brought to a word's number.
struct Target {
  std::string word;
  std::vector<std::string> peers;
};

std::vector<Target> targets_of(const std::vector<CellRecord>& records) {
  std::vector<Target> targets;
  for (const CellRecord& record : records) {
    if (!record.calibration) continue;
    auto at = std::ranges::find(targets, record.calibration->to, &Target::word);
    if (at == targets.end()) at = targets.insert(at, {record.calibration->to, {}});
    if (std::ranges::find(at->peers, record.pipeline) == at->peers.end())
      at->peers.push_back(record.pipeline);
  }
  return targets;
}

double quads_of(const CellRecord& record) {
  const double triangles = value_of(record, "n_triangles");
  return value_of(record, "n_quads") + (triangles > 0 ? triangles / 2 : 0);
}

/// In percent, how many more quads words that were not calibrated have than this one: by word, of each cell
/// that both have.
std::vector<std::pair<std::string, std::vector<double>>> excesses(const std::vector<CellRecord>& records,
                                                                  const std::string& target) {
  std::map<std::string, double> wanted;  // by case and variant
  for (const CellRecord& record : records)
    if (record.pipeline == target && makes_quads(record)) wanted[record.group] = quads_of(record);
  std::vector<std::pair<std::string, std::vector<double>>> words;
  for (const CellRecord& record : records) {
    const auto quads = wanted.find(record.group);
    if (record.calibration || record.pipeline == target || quads == wanted.end() || !makes_quads(record))
      continue;
    auto at = std::ranges::find_if(words, [&](const auto& word) { return word.first == record.pipeline; });
    if (at == words.end()) at = words.insert(at, {record.pipeline, {}});
    at->second.push_back(100 * (quads_of(record) / quads->second - 1));
  }
  return words;
}

/// "3 % to 17 % more"; empty: as many, as calibrated peers have.
std::string excess_text(const std::vector<double>& percents) {
  auto [low, high] = std::ranges::minmax(percents);
  if (std::max(-low, high) <= 100 * kEquallyMany) return "";
  const auto text = [](double percent) {
    const double size = std::abs(percent);
    return size < 100 ? fmt::format("{:.2g} %", size) : fmt::format("{:.0f} %", size);
  };
  if (low < 0 && high > 0) return fmt::format("from {} fewer to {} more", text(low), text(high));
  const char* side = low < 0 ? "fewer" : "more";
  if (low < 0) std::swap(low, high);
  const std::string first = text(low), last = text(high);
  return first == last ? fmt::format("{} {}", first, side) : fmt::format("{} to {} {}", first, last, side);
}

constexpr std::size_t kMostNamed = 5;

/// The cases on which a word has quads, those of them on which it leaves triangles, and those without quads.
struct Cases {
  std::string word;
  std::vector<std::string> all, with_triangles, without_quads;
};

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

std::vector<Cases> cases_by_word(const std::vector<CellRecord>& records) {
  std::vector<Cases> words;
  for (const CellRecord& record : records) {
    if (!record.reason.empty()) continue;
    auto at = std::ranges::find(words, record.pipeline, &Cases::word);
    if (at == words.end()) at = words.insert(at, {record.pipeline, {}, {}, {}});
    add_once(record.name, makes_quads(record) ? at->all : at->without_quads);
    if (leaves_triangles(record)) add_once(record.name, at->with_triangles);
  }
  std::erase_if(words, [](const Cases& cases) { return cases.all.empty(); });  // words of triangles
  return words;
}

std::string named(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kMostNamed);
  const std::string text = fmt::format("{}", fmt::join(std::span(names).first(shown), ", "));
  return shown == names.size() ? text : fmt::format("{} and {} more", text, names.size() - shown);
}

}  // namespace

std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records) {
  std::vector<std::string> notes;
  for (Cells& group : grouped(records)) notes.push_back(note(std::move(group)));
  return notes;
}

std::vector<std::string> quad_count_notes(const std::vector<CellRecord>& records) {
  std::vector<std::string> notes;
  for (const auto& [target, peers] : targets_of(records)) {
    notes.push_back(fmt::format("Calibrated, by their sizes, to {}'s number of quads: {}", target,
                                fmt::join(peers, ", ")));
    for (const auto& [word, percents] : excesses(records, target))
      if (const std::string text = excess_text(percents); !text.empty())
        notes.push_back(
            fmt::format("{} has {} quads than {}, to which the others were brought", word, text, target));
  }
  return notes;
}

std::vector<std::string> triangle_notes(const std::vector<CellRecord>& records,
                                        const std::string& consequence) {
  std::vector<std::string> notes;
  const std::vector<Cases> words = cases_by_word(records);
  if (words.size() < 2) return notes;
  for (const auto& [word, all, with_triangles, without_quads] : words)
    if (!with_triangles.empty())
      notes.push_back(fmt::format("{} leaves triangles in {} of {} cases ({}): {}", word,
                                  with_triangles.size(), all.size(), named(with_triangles), consequence));
  return notes;
}

std::vector<std::string> quadless_notes(const std::vector<CellRecord>& records) {
  std::vector<std::string> notes;
  for (const auto& [word, all, with_triangles, without_quads] : cases_by_word(records))
    if (!without_quads.empty())
      notes.push_back(
          fmt::format("{} made no quads on {} ({}): it failed there in pairs", word,
                      without_quads.size() == 1 ? "one case" : fmt::format("{} cases", without_quads.size()),
                      named(without_quads)));
  return notes;
}

}  // namespace delquad
