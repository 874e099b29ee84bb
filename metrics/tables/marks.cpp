#include "metrics/tables/marks.h"

#include <algorithm>

namespace delquad {
namespace {

bool competes(const Samples& row, const std::string& key) {
  const auto is_rival = [&](const CellRecord* record) {
    return record->unsound.empty() && makes_quads(*record) &&
           !(is_of_quads(key) && leaves_triangles(*record));
  };
  return !row.done.empty() && std::ranges::all_of(row.done, is_rival);
}

}  // namespace

Marking::Marking(const std::vector<Samples>& samples, const std::vector<TestedMeasure>& measures,
                 ClaimFamily& family)
    : samples_(samples) {
  for (std::size_t first = 0, last; first < samples.size(); first = last) {
    last = first;
    while (last < samples.size() && samples[last].group == samples[first].group) ++last;
    for (const TestedMeasure& measure : measures)
      if (measure.metric.better != Better::kNeither) add_group(first, last, measure, family);
  }
}

void Marking::add_group(std::size_t first, std::size_t last, const TestedMeasure& measure,
                        ClaimFamily& family) {
  const std::string& key = measure.metric.key;
  Contest contest{key, measure.metric.better == Better::kHigher ? 1.0 : -1.0, {}, {}, {}};
  for (std::size_t i = first; i < last; ++i) {
    const bool is_time = measure.kind == ValueKind::kRepeatedTime;
    const std::vector<double> values = is_time ? samples_[i].times(key) : samples_[i].of(key);
    if (values.empty() || !competes(samples_[i], key)) continue;
    contest.rivals.push_back(i);
    contest.values.push_back(is_time ? median(values) : mean(values));
  }
  if (contest.rivals.size() < 2) return;
  for (const std::size_t b : contest.rivals)
    for (const std::size_t a : contest.rivals)
      if (a < b) contest.duels.push_back({a, b, family.add(test(measure, a, b))});
  contests_.push_back(std::move(contest));
}

RankTest Marking::test(const TestedMeasure& measure, std::size_t first, std::size_t second) const {
  const std::string& key = measure.metric.key;
  if (measure.kind == ValueKind::kRepeatedTime)
    return mann_whitney(samples_[first].times(key), samples_[second].times(key));
  return wilcoxon(pair_by_run(samples_[first].done, samples_[second].done, key));
}

bool Marking::can_prove(const ClaimFamily& family, const Contest& contest) {
  return std::ranges::any_of(contest.duels,
                             [&](const Duel& d) { return family.finding(d.test) != Finding::kTooFew; });
}

bool Marking::can_prove(const ClaimFamily& family) const {
  return std::ranges::any_of(contests_, [&](const Contest& c) { return can_prove(family, c); });
}

void Marking::mark(const ClaimFamily& family, std::span<TableRow> rows) const {
  for (const Contest& contest : contests_) {
    if (!can_prove(family, contest)) continue;
    const auto [low, high] = std::ranges::minmax_element(contest.values);
    if (*low == *high) continue;
    std::size_t best = 0;
    for (std::size_t k = 1; k < contest.values.size(); ++k)
      if (contest.sign * (contest.values[k] - contest.values[best]) > 0) best = k;
    const std::size_t winner = contest.rivals[best];
    std::vector<std::size_t> as_good;
    for (const Duel& duel : contest.duels) {
      if (duel.first != winner && duel.second != winner) continue;
      const double lean = contest.sign * family.test(duel.test).lean * (duel.first == winner ? 1 : -1);
      if (family.finding(duel.test) != Finding::kProven || lean <= 0)
        as_good.push_back(duel.first == winner ? duel.second : duel.first);
    }
    rows[winner].marks[contest.key] = as_good.empty() ? Mark::kBest : Mark::kAsGoodAsBest;
    for (const std::size_t row : as_good) rows[row].marks[contest.key] = Mark::kAsGoodAsBest;
  }
}

std::vector<std::string> Marking::notes(const ClaimFamily& family, std::span<const TableRow> rows) const {
  if (contests_.empty()) return {};
  bool best = false, as_good = false, single = true;
  for (const TableRow& row : rows)
    for (const auto& [key, mark] : row.marks) (mark == Mark::kBest ? best : as_good) = true;
  const bool too_few =
      std::ranges::any_of(contests_, [&](const Contest& c) { return !can_prove(family, c); });
  for (const Samples& row : samples_) single = single && row.done.size() < 2;
  std::vector<std::string> notes;
  if (best) notes.push_back("Bold: proven to be the best of its group, at 5 %.");
  if (as_good) notes.push_back("~: the best of its group, or not proven to be worse than it.");
  if (single && !best && !as_good)
    notes.push_back(
        "Single runs: a value that is better here need not be better on the same domain, turned a "
        "little. Nothing is marked as the best; that takes several seeds.");
  else if (too_few)
    notes.push_back("Where nothing is marked, all are alike or there are too few seeds to tell.");
  return notes;
}

}  // namespace delquad
