// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/edge_counts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "base/cancel.h"
#include "base/sort_unique.h"

namespace delquad {
namespace {

/// Weight of the square of deviations, so that large ones cost more than many small ones.
constexpr double kUneven = 8;
/// Cost of an edge beyond the most that a curve should have.
constexpr double kPriceBeyond = 20;
/// Least decrease of cost that counts.
constexpr double kLeastDecrease = 1e-9;
/// Limit of passes over all sums and curves.
constexpr int kMostAgreements = 50;
/// Limit of curves of a chain.
constexpr int kMostCurves = 24;
/// Cost that a chain may have beyond the largest gain of its end.
constexpr double kAdvance = 2;
/// Price of a sum that must become zero.
constexpr double kForcedPrice = 1000;

constexpr double kNever = std::numeric_limits<double>::infinity();

class Agreement {
 public:
  Agreement(const std::vector<AgreeingCurve>& curves, int n_patches, const std::vector<ClosureSum>& sums,
            Budget& steps, std::vector<int>& counts, int most_looks)
      : curves_(curves),
        sums_(sums),
        steps_(steps),
        most_looks_(most_looks),
        counts_(counts),
        outside_(n_patches),
        in_sums_(curves.size()),
        at_patch_(n_patches + 1),
        closes_(n_patches + 1, 0),
        costs_(curves.size()),
        changed_(n_patches + 1, 1),
        seen_(n_patches + 1, 0),
        in_vain_(sums.size() + curves.size()) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
      note_costs(static_cast<int>(c));
      if (!curves[c].is_free || curves[c].patches.empty()) continue;
      std::vector<int> patches = curves[c].patches;
      if (patches.size() == 1) patches.push_back(outside_);
      if (patches[0] == patches.back()) patches.pop_back();
      for (const int p : patches) at_patch_[p].push_back(static_cast<int>(c));
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
      closes_[sums[s].patch] = 1;
      int value = 0;
      for (const auto& [curve, times] : sums[s].terms) {
        in_sums_[curve].emplace_back(static_cast<int>(s), times);
        value += times * counts[curve];
      }
      values_.push_back(value);
    }
  }

  void run() {
    for (int pass = 0; pass < kMostAgreements; ++pass) {
      bool better = false;
      for (std::size_t s = 0; s < sums_.size(); ++s) {
        check_cancelled();
        if (steps_.is_spent()) return;
        if (off(static_cast<int>(s)) == 0) continue;
        better |= unless_in_vain(s, [&] {
          const bool closed = sums_[s].price_of_pair > 0 && close(static_cast<int>(s));
          return make(approach(static_cast<int>(s)).changes) || closed;
        });
      }
      for (std::size_t c = 0; c < curves_.size(); ++c)
        if (curves_[c].is_free && !curves_[c].patches.empty())
          better |= unless_in_vain(sums_.size() + c, [&] { return restore(static_cast<int>(c)); });
      if (!better) return;
    }
  }

 private:
  struct Change {
    int curve = -1, by = 0;
  };
  using Changes = std::vector<Change>;
  /// A curve of a chain; `patch` beyond it is the next one to correct.
  struct Step {
    double cost;
    int patch;
    Change change;
    int before, length;
  };
  struct Best {
    double gain = kLeastDecrease;
    Changes changes = {};
  };

  /// A search that changed nothing: its time, and the patches that it looked at.
  struct InVain {
    int at = 0;
    std::vector<int> patches = {};
  };

  /// Returns search(), or false if it was in vain before and nothing changed since where it looked.
  template <class Search>
  bool unless_in_vain(std::size_t task, const Search& search) {
    InVain& last = in_vain_[task];
    if (last.at > 0 && std::ranges::all_of(last.patches, [&](int p) { return changed_[p] <= last.at; }))
      return false;
    looked_at_.clear();
    ++searches_;
    const bool found = search();
    last = found ? InVain{} : InVain{now_, looked_at_};
    return found;
  }
  void look_at(int patch) {
    if (std::exchange(seen_[patch], searches_) != searches_) looked_at_.push_back(patch);
  }

  /// Brings a sum to zero, or changes nothing.
  bool close(int sum) {
    std::map<int, int> by;  // change of each curve
    const std::vector<int> changed = changed_;
    forced_ = sum;
    while (off(sum) != 0) {
      const Best best = approach(sum);
      if (!make(best.changes)) break;
      for (const Change& c : best.changes) by[c.curve] += c.by;
    }
    forced_ = -1;
    const bool is_closed = off(sum) == 0;
    Changes all, back;
    for (const auto& [curve, change] : by)
      if (change != 0) all.push_back({curve, change}), back.push_back({curve, -change});
    make(back);
    changed_ = changed;
    return is_closed && gain_of(all) > kLeastDecrease && make(all);
  }

  /// Returns the best change that brings a sum nearer to zero.
  Best approach(int sum) {
    const double most = price(sum, values_[sum]) + kAdvance;
    Best best;
    look_at(sums_[sum].patch);
    for (const auto& [curve, times] : sums_[sum].terms)
      if (curves_[curve].is_free) try_change(curve, off(sum) * times > 0 ? -1 : 1, most, best);
    return best;
  }

  /// Makes the best change that brings a curve nearer to its wanted number.
  bool restore(int curve) {
    Best best;
    try_change(curve, counts_[curve] > curves_[curve].ideal ? -1 : 1,
               misfit(curve, counts_[curve]) + kAdvance, best);
    return make(best.changes);
  }

  /// Tries changes by one and by two. `most` limits the cost of the rest of a chain.
  void try_change(int curve, int by, double most, Best& best) {
    const auto& patches = curves_[curve].patches;
    const auto compare = [&](Changes changes) {
      const double gain = gain_of(changes);
      if (gain > best.gain) best = {gain, std::move(changes)};
    };
    if (patches.size() <= 2) {
      const Change one{curve, by};
      const int to = beyond(curve, patches[0]);
      compare(to == patches[0] ? Changes{one} : chain(patches[0], one, to, most));
    }
    const Change two{curve, 2 * by};
    Changes changes{two};
    for (const int p : patches)
      for (const Change& c : chain(p, two, kAnywhere, most))
        if (std::ranges::find(changes, c.curve, &Change::curve) == changes.end()) changes.push_back(c);
    compare(std::move(changes));
  }

  /// Returns the cheapest changes after the first one at `from` that reach `to`; empty: none.
  Changes chain(int from, Change first, int to, double most) {
    std::vector<Step> steps{{0, from, first, -1, 0}};
    best_.resize(4 * curves_.size() + at_patch_.size(), kNever);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.push({0, 0});
    double least = kNever;
    int last = -1;
    if (to == kAnywhere) least = cost_at(from, first, {}), last = 0;
    for (int done = 0; !queue.empty() && done < most_looks_ && !steps_.is_spent(); ++done) {
      const auto [cost, s] = queue.top();
      queue.pop();
      const Step at = steps[s];
      if (cost > best_[label(at)] || at.length >= kMostCurves) continue;
      steps_.spend(static_cast<long long>(at_patch_[at.patch].size()));
      look_at(at.patch);
      for (const int b : at_patch_[at.patch])
        for (const int by : {-std::abs(first.by), std::abs(first.by)}) {
          if (b == first.curve || curves_[b].patches.size() > 2) continue;
          const Change next{b, by};
          const Step step{at.cost + cost_of(next) + cost_at(at.patch, at.change, next), beyond(b, at.patch),
                          next, s, at.length + 1};
          if (!(step.cost < most)) continue;
          look_at(step.patch);
          const bool arrives = step.patch == to;
          const double total = arrives           ? step.cost + cost_at(to, next, first)
                               : to == kAnywhere ? step.cost + cost_at(step.patch, next, {})
                                                 : kNever;
          const bool ends = total < least - kLeastDecrease;
          const bool goes_on = !arrives && step.cost < best_[label(step)] - kLeastDecrease;
          if ((!ends && !goes_on) || is_used(steps, s, b)) continue;
          steps.push_back(step);
          const int added = static_cast<int>(steps.size()) - 1;
          if (ends) least = total, last = added;
          if (!goes_on) continue;
          best_[label(step)] = step.cost;
          queue.push({step.cost, added});
        }
    }
    for (const Step& step : steps) best_[label(step)] = kNever;
    Changes changes;
    for (int s = last; s >= 0; s = steps[s].before) changes.push_back(steps[s].change);
    return changes;
  }

  /// Returns the label of a step: at a patch with sums, the change that reached it matters.
  std::size_t label(const Step& step) const {
    if (!closes_[step.patch]) return 4 * curves_.size() + step.patch;
    const bool second = curves_[step.change.curve].patches.front() != step.patch;
    return 4 * step.change.curve + (second ? 2 : 0) + (step.change.by > 0 ? 1 : 0);
  }
  static bool is_used(const std::vector<Step>& steps, int s, int curve) {
    for (; s >= 0; s = steps[s].before)
      if (steps[s].change.curve == curve) return true;
    return false;
  }
  int beyond(int curve, int patch) const {
    const auto& patches = curves_[curve].patches;
    if (patches.size() == 1) return patch == outside_ ? patches[0] : outside_;
    return patches[0] == patch ? patches[1] : patches[0];
  }

  double misfit(int curve, int n) const {
    if (n < curves_[curve].least) return kNever;
    const double log = std::abs(std::log(n / curves_[curve].ideal));
    const double beyond = n > curves_[curve].most ? kPriceBeyond * (n - curves_[curve].most) : 0;
    return n * log * (curves_[curve].weight + kUneven * log) + beyond;
  }
  double cost_of(Change change) const {
    if (std::abs(change.by) <= kNoted) return costs_[change.curve][change.by + kNoted];
    return new_cost_of(change);
  }
  double new_cost_of(Change change) const {
    const int n = counts_[change.curve];
    return misfit(change.curve, n + change.by) - misfit(change.curve, n);
  }
  void note_costs(int curve) {
    for (int by = -kNoted; by <= kNoted; ++by) costs_[curve][by + kNoted] = new_cost_of({curve, by});
  }
  /// Returns the excess of a sum of this value; negative: it is too small.
  int off(int sum, int value) const {
    const int least = sums_[sum].at_least;
    return least > 0 ? std::min(0, value - least) : value;
  }
  int off(int sum) const { return off(sum, values_[sum]); }
  double price(int sum, int value) const {
    const int by = off(sum, value);
    return by == 0 ? 0 : sums_[sum].price_of_pair + sums_[sum].price * std::abs(by);
  }
  int multiplicity(int sum, int curve) const {
    int times = 0;
    if (curve >= 0)
      for (const auto& [s, t] : in_sums_[curve])
        if (s == sum) times += t;
    return times;
  }
  /// Returns the cost of two changes at a patch by its sums; the second change is new.
  double cost_at(int patch, Change first, Change second) const {
    double cost = 0;
    const auto add = [&](int curve) {
      for (const auto& [s, times] : in_sums_[curve]) {
        if (sums_[s].patch != patch || (curve == second.curve && multiplicity(s, first.curve) != 0)) continue;
        const int by = multiplicity(s, second.curve) * second.by;
        if (s == forced_) {
          cost += by != 0 ? kForcedPrice : 0;
          continue;
        }
        const int value = values_[s];
        cost += price(s, value + by + multiplicity(s, first.curve) * first.by) - price(s, value);
      }
    };
    add(first.curve);
    if (second.curve >= 0) add(second.curve);
    return cost;
  }

  /// Returns the decrease of cost by the changes; the forced sum costs kForcedPrice.
  double gain_of(const Changes& changes) {
    if (changes.empty()) return 0;
    double gain = 0;
    std::vector<int> touched;
    for (const Change& c : changes) {
      gain -= cost_of(c);
      for (const auto& in : in_sums_[c.curve]) touched.push_back(in.first);
    }
    sort_unique(touched);
    for (const int s : touched) {
      look_at(sums_[s].patch);
      int value = values_[s];
      for (const Change& c : changes) value += multiplicity(s, c.curve) * c.by;
      gain += s == forced_ ? kForcedPrice * (std::abs(off(s)) - std::abs(off(s, value)))
                           : price(s, values_[s]) - price(s, value);
    }
    return gain;
  }

  bool make(const Changes& changes) {
    ++now_;
    for (const Change& c : changes) {
      for (const int p : curves_[c.curve].patches) changed_[p] = now_;
      if (curves_[c.curve].patches.size() == 1) changed_[outside_] = now_;
      counts_[c.curve] += c.by;
      note_costs(c.curve);
      for (const auto& [s, times] : in_sums_[c.curve]) {
        values_[s] += times * c.by;
        changed_[sums_[s].patch] = now_;
      }
    }
    return !changes.empty();
  }

  static constexpr int kAnywhere = -1;
  static constexpr int kNoted = 2;  // searches change numbers by at most this

  const std::vector<AgreeingCurve>& curves_;
  const std::vector<ClosureSum>& sums_;
  Budget& steps_;
  int most_looks_;
  std::vector<int>& counts_;
  int outside_;
  std::vector<std::vector<std::pair<int, int>>> in_sums_;  ///< by curve: sums, and its factor in each
  std::vector<std::vector<int>> at_patch_;                 ///< free curves by patch, outside included
  std::vector<char> closes_;                               ///< whether a patch has sums
  std::vector<int> values_;                                ///< of sums
  int forced_ = -1;                                        ///< sum that must become zero
  std::vector<double> best_;                               ///< by label()
  std::vector<std::array<double, 2 * kNoted + 1>> costs_;  ///< cost_of() of each curve by its change
  int now_ = 1, searches_ = 0;
  std::vector<int> changed_, seen_;  ///< by patch: when it changed, and the last search that looked at it
  std::vector<int> looked_at_;       ///< by this search
  std::vector<InVain> in_vain_;      ///< of sums, then curves
};

}  // namespace

void agree_counts(const std::vector<AgreeingCurve>& curves, int n_patches,
                  const std::vector<ClosureSum>& sums, Budget& steps, std::vector<int>& counts,
                  int most_looks) {
  assert(counts.size() == curves.size());
  [[maybe_unused]] const auto is_patch = [&](int p) { return p >= 0 && p < n_patches; };
  assert(std::ranges::all_of(curves, [&](const AgreeingCurve& curve) {
    return curve.ideal > 0 && curve.least >= 1 && curve.weight >= 0 &&
           std::ranges::all_of(curve.patches, is_patch);
  }));
  assert(std::ranges::all_of(sums, is_patch, &ClosureSum::patch));
  Agreement(curves, n_patches, sums, steps, counts, most_looks).run();
}

}  // namespace delquad
