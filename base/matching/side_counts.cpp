// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/edge_counts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include "base/cancel.h"
#include "base/sort_unique.h"

namespace delquad {
namespace {

/// Limit of rounds over all conditions, since a chain may break what another one repaired.
constexpr int kMostRounds = 20;
/// Limit of passes over all curves that lower the sum of costs, and the least decrease that counts.
constexpr int kMostPasses = 100;
/// Limit of chains that compensate one change.
constexpr int kMostChains = 12;
constexpr double kLower = 1e-9;

/// Condition on a signed sum of numbers of edges. It is zero across a mapped face of four sides. It is even
/// around a face of three sides or a free one, and negative for a side of three against both others.
enum class Requirement { kZero, kEven, kNegative };

struct Condition {
  int face;
  Requirement demand;
  std::vector<std::pair<int, int>> terms;  ///< curve and signed factor; only odd factors for even sums
};

class Balance {
 public:
  Balance(std::vector<CountedCurve>& curves, const std::vector<CountedFace>& faces)
      : curves_(curves), of_curve_(curves.size()) {
    for (std::size_t f = 0; f < faces.size(); ++f) add_face(static_cast<int>(f), faces[f]);
    steps_.resize(2 * conditions_.size());
  }

  std::vector<UnbalancedFace> run() {
    std::vector<char> is_hopeless(conditions_.size(), 0);
    for (int round = 0; round < kMostRounds; ++round) {
      bool repaired = false;
      for (const Requirement demand : {Requirement::kZero, Requirement::kNegative, Requirement::kEven})
        for (std::size_t c = 0; c < conditions_.size(); ++c)
          while (conditions_[c].demand == demand && !is_hopeless[c] && !holds(static_cast<int>(c))) {
            if (!repair(static_cast<int>(c))) is_hopeless[c] = 1;
            repaired = true;
          }
      if (!repaired) break;
    }
    std::vector<UnbalancedFace> bad;
    for (std::size_t c = 0; c < conditions_.size(); ++c)
      if (!holds(static_cast<int>(c)) && (bad.empty() || bad.back().face != conditions_[c].face))
        bad.push_back({conditions_[c].face, fixed_curves(static_cast<int>(c))});
    if (bad.empty()) improve();
    return bad;
  }

 private:
  void add_face(int f, const CountedFace& face) {
    const auto& s = face.sides;
    if (face.n_sides == 4) {
      for (const int axis : {0, 1}) add(f, Requirement::kZero, s[axis], s[axis + 2]);
      return;
    }
    std::vector<int> all;
    for (const auto& side : s) all.insert(all.end(), side.begin(), side.end());
    add(f, Requirement::kEven, all, {});
    for (int k = 0; k < face.n_sides; ++k) {
      std::vector<int> others = s[(k + 1) % 3];
      others.insert(others.end(), s[(k + 2) % 3].begin(), s[(k + 2) % 3].end());
      add(f, Requirement::kNegative, s[k], others);
    }
  }

  void add(int face, Requirement demand, const std::vector<int>& plus, const std::vector<int>& minus) {
    std::vector<int> all = plus;
    all.insert(all.end(), minus.begin(), minus.end());
    sort_unique(all);
    Condition condition{face, demand, {}};
    for (const int curve : all) {
      int times = static_cast<int>(std::ranges::count(plus, curve) - std::ranges::count(minus, curve));
      if (demand == Requirement::kEven) times %= 2;
      if (times == 0) continue;
      condition.terms.emplace_back(curve, times);
      of_curve_[curve].push_back({static_cast<int>(conditions_.size()), times});
    }
    conditions_.push_back(std::move(condition));
  }

  int sum(int condition) const {
    int sum = 0;
    for (const auto& [curve, times] : conditions_[condition].terms) sum += times * curves_[curve].n;
    return sum;
  }
  static bool meets(Requirement demand, int sum) {
    return demand == Requirement::kZero ? sum == 0 : demand == Requirement::kEven ? sum % 2 == 0 : sum < 0;
  }
  bool holds(int condition) const { return meets(conditions_[condition].demand, sum(condition)); }

  /// Returns the state of a condition that must change by one, up or down; parities have no direction.
  static int state_of(int condition, bool up) { return 2 * condition + up; }

  struct Step {
    double cost = std::numeric_limits<double>::infinity();
    int before = -1;  ///< previous state
    int curve = -1, change = 0;
  };

  double cost_of(int curve, int change) const {
    return std::abs(std::log((curves_[curve].n + change) / curves_[curve].ideal));
  }

  /// Returns whether a change of a curve leaves a condition no worse.
  bool tolerates(int condition, int change) const {
    const Requirement demand = conditions_[condition].demand;
    const int now = sum(condition);
    return meets(demand, now + change) || (demand == Requirement::kZero && now * change < 0) ||
           (demand == Requirement::kNegative && now >= 0 && change < 0);
  }

  /// Returns where a change of the curve leads from a condition: the state of another condition to correct,
  /// or -1 for none. Returns -2 if the change is not allowed or breaks several.
  int next_state(int start, int from, int curve, int change) const {
    int state = -1, others = 0;
    for (const auto& [condition, times] : of_curve_[curve]) {
      if (condition == from) continue;
      if (condition == start && conditions_[start].demand != Requirement::kNegative)
        return -2;  // it would change twice
      if (tolerates(condition, times * change)) continue;
      if (++others > 1 || std::abs(times) > 1) return -2;
      const bool is_even = conditions_[condition].demand == Requirement::kEven;
      state = state_of(condition, is_even || times * change < 0);
    }
    return state;
  }

  /// Improves a condition by one.
  bool repair(int condition) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const int state : reached_) steps_[state] = {};
    const bool is_even = conditions_[condition].demand == Requirement::kEven;
    const int start = state_of(condition, is_even || sum(condition) < 0);
    steps_[start].cost = 0;
    reached_ = {start};
    queue.push({0, start});
    Step last;
    while (!queue.empty() && queue.top().first < last.cost) {
      check_cancelled();
      const auto [cost, state] = queue.top();
      queue.pop();
      if (cost > steps_[state].cost) continue;
      const Condition& at = conditions_[state / 2];
      const bool at_even = at.demand == Requirement::kEven;
      for (const auto& [curve, times] : at.terms)
        for (const int change : {1, -1}) {
          const bool wanted = at_even || (times * change > 0) == (state % 2 == 1);
          if (!wanted || !may_change(curve, change)) continue;
          if (!at_even && std::abs(times) > 1) continue;
          const double next_cost = cost + cost_of(curve, change);
          const int next = next_state(condition, state / 2, curve, change);
          if (next == -2) continue;
          Step& step = next == -1 ? last : steps_[next];
          if (next_cost < step.cost) {
            step = {next_cost, state, curve, change};
            if (next >= 0) {
              reached_.push_back(next);
              queue.push({next_cost, next});
            }
          }
        }
    }
    if (last.curve < 0) return false;
    for (Step step = last;; step = steps_[step.before]) {
      change(step.curve, step.change);
      if (step.before == start) return true;
    }
  }

  bool may_change(int curve, int change) const {
    return curves_[curve].is_free && curve != held_ && curves_[curve].n + change >= curves_[curve].least;
  }

  void change(int curve, int by) {
    curves_[curve].n += by;
    changes_.emplace_back(curve, by);
  }

  double misfit(int curve) const {
    const double log = std::log(curves_[curve].n / curves_[curve].ideal);
    return log * log;
  }

  /// Lowers the sum of misfits.
  void improve() {
    std::vector<int> tried;
    for (std::size_t c = 0; c < curves_.size(); ++c)
      if (std::ranges::any_of(of_curve_[c], [&](const auto& in) {
            return conditions_[in.first].demand != Requirement::kEven;
          }))
        tried.push_back(static_cast<int>(c));
    for (int pass = 0; pass < kMostPasses; ++pass) {
      bool better = false;
      for (const int c : tried)
        for (const int by : {1, -1})
          while (may_change(c, by) && try_change(c, by)) better = true;
      if (!better) break;
    }
  }

  /// Changes a curve and compensates the change, if the sum of misfits falls.
  bool try_change(int curve, int by) {
    changes_.clear();
    change(curve, by);
    held_ = curve;
    bool can_be = true;
    int chains = 0;
    std::vector<int> touched{curve};
    for (std::size_t done = 0; can_be && done < touched.size(); ++done)
      for (const auto& [condition, times] : of_curve_[touched[done]])
        while (can_be && !holds(condition)) {
          can_be = chains++ < kMostChains && repair(condition);
          for (const auto& [other, change] : changes_)
            if (std::ranges::find(touched, other) == touched.end()) touched.push_back(other);
        }
    held_ = -1;
    // Each changed curve once.
    double gain = 0;
    for (const int c : touched) gain -= misfit(c);
    undo();
    for (const int c : touched) gain += misfit(c);
    if (!can_be || !(gain > kLower)) return false;
    for (const auto& [c, change] : changes_) curves_[c].n += change;
    return true;
  }

  void undo() {
    for (const auto& [curve, by] : changes_) curves_[curve].n -= by;
  }

  /// Returns the fixed curves connected to a condition.
  std::vector<int> fixed_curves(int condition) const {
    std::vector<int> fixed, queue{condition};
    std::vector<char> met(conditions_.size(), 0);
    met[condition] = 1;
    for (std::size_t done = 0; done < queue.size(); ++done)
      for (const auto& [curve, times] : conditions_[queue[done]].terms) {
        if (!curves_[curve].is_free) {
          if (std::ranges::find(fixed, curve) == fixed.end()) fixed.push_back(curve);
          continue;
        }
        for (const auto& [next, t] : of_curve_[curve])
          if (!met[next] && conditions_[next].demand != Requirement::kEven) {
            met[next] = 1;
            queue.push_back(next);
          }
      }
    return fixed;
  }

  std::vector<CountedCurve>& curves_;
  std::vector<Condition> conditions_;
  std::vector<std::vector<std::pair<int, int>>> of_curve_;  ///< conditions with this curve, and its factor
  std::vector<Step> steps_;                                 ///< by state
  std::vector<int> reached_;                                ///< states whose steps are set
  std::vector<std::pair<int, int>> changes_;                ///< curves and changes since try_change()
  int held_ = -1;                                           ///< curve that must not change
};

}  // namespace

std::vector<UnbalancedFace> balance_counts(std::vector<CountedCurve>& curves,
                                           const std::vector<CountedFace>& faces) {
  assert(std::ranges::all_of(curves, [](const CountedCurve& c) { return c.ideal > 0 && c.least >= 1; }));
  assert(std::ranges::all_of(
      faces, [](const CountedFace& f) { return f.n_sides == 0 || f.n_sides == 3 || f.n_sides == 4; }));
  return Balance(curves, faces).run();
}

}  // namespace delquad
