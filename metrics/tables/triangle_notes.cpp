#include "metrics/tables/triangle_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "metrics/tables/samples.h"

namespace delquad {
namespace {

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
          fmt::format("{} made no quads on {} ({}): no pair with it has these", word,
                      without_quads.size() == 1 ? "one case" : fmt::format("{} cases", without_quads.size()),
                      named(without_quads)));
  return notes;
}

}  // namespace delquad
