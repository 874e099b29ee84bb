#include "matching/side_counts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "base/cancel.h"

namespace delquad {
namespace {

/// A sum of numbers of edges with signs: zero across a mapped face, even around another one.
struct Condition {
  int face;
  bool is_parity;
  std::vector<std::pair<int, int>> terms;  ///< curve and how often, with its sign; a parity has odd ones only
};

class Balance {
 public:
  Balance(std::vector<CountedCurve>& curves, const std::vector<CountedFace>& faces)
      : curves_(curves), of_curve_(curves.size()) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const CountedFace& face = faces[f];
      if (!face.is_mapped) {
        add(static_cast<int>(f), true, face.sides[0], {});
        continue;
      }
      for (const int axis : {0, 1}) add(static_cast<int>(f), false, face.sides[axis], face.sides[axis + 2]);
    }
  }

  std::optional<int> run() {
    for (const bool parity : {false, true})
      for (std::size_t c = 0; c < conditions_.size(); ++c)
        while (conditions_[c].is_parity == parity && !holds(static_cast<int>(c)))
          if (!mend(static_cast<int>(c))) return conditions_[c].face;
    return std::nullopt;
  }

 private:
  void add(int face, bool is_parity, const std::vector<int>& plus, const std::vector<int>& minus) {
    std::vector<int> all = plus;
    all.insert(all.end(), minus.begin(), minus.end());
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    Condition condition{face, is_parity, {}};
    for (const int curve : all) {
      int times = static_cast<int>(std::ranges::count(plus, curve) - std::ranges::count(minus, curve));
      if (is_parity) times %= 2;
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
  bool holds(int condition) const {
    return conditions_[condition].is_parity ? sum(condition) % 2 == 0 : sum(condition) == 0;
  }

  /// A condition that has to be changed by one, up or down; parities know no difference.
  static int state_of(int condition, bool up) { return 2 * condition + up; }

  struct Step {
    double cost = std::numeric_limits<double>::infinity();
    int before = -1;  ///< state
    int curve = -1, change = 0;
  };

  double cost_of(int curve, int change) const {
    return std::abs(std::log((curves_[curve].n + change) / curves_[curve].want));
  }

  /// Where a change of the curve leads, seen from a condition: to another that then has to be changed back
  /// (its state), to none (-1), or nowhere allowed (-2): to several.
  int led_to(int start, int from, int curve, int change) const {
    int state = -1, others = 0;
    for (const auto& [condition, times] : of_curve_[curve]) {
      if (condition == from) continue;
      if (condition == start) return -2;  // it would be changed twice
      const Condition& other = conditions_[condition];
      const bool helps = other.is_parity ? !holds(condition) : sum(condition) * times * change < 0;
      if (helps) continue;
      if (++others > 1 || std::abs(times) > 1) return -2;
      state = other.is_parity ? state_of(condition, true) : state_of(condition, times * change < 0);
    }
    return state;
  }

  bool mend(int condition) {
    std::vector<Step> steps(2 * conditions_.size());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const int start = state_of(condition, conditions_[condition].is_parity || sum(condition) < 0);
    steps[start].cost = 0;
    queue.push({0, start});
    Step last;
    while (!queue.empty() && queue.top().first < last.cost) {
      check_cancelled();
      const auto [cost, state] = queue.top();
      queue.pop();
      if (cost > steps[state].cost) continue;
      const Condition& at = conditions_[state / 2];
      for (const auto& [curve, times] : at.terms)
        for (const int change : {1, -1}) {
          const bool wanted = at.is_parity || (times * change > 0) == (state % 2 == 1);
          if (!wanted || !curves_[curve].is_free || curves_[curve].n + change < curves_[curve].least)
            continue;
          if (!at.is_parity && std::abs(times) > 1) continue;
          const double next_cost = cost + cost_of(curve, change);
          const int next = led_to(condition, state / 2, curve, change);
          if (next == -2) continue;
          Step& step = next == -1 ? last : steps[next];
          if (next_cost < step.cost) {
            step = {next_cost, state, curve, change};
            if (next >= 0) queue.push({next_cost, next});
          }
        }
    }
    if (last.curve < 0) return false;
    for (Step step = last;; step = steps[step.before]) {
      curves_[step.curve].n += step.change;
      if (step.before == start) return true;
    }
  }

  std::vector<CountedCurve>& curves_;
  std::vector<Condition> conditions_;
  std::vector<std::vector<std::pair<int, int>>> of_curve_;  ///< conditions that it is in, how often
};

}  // namespace

std::optional<int> balance_counts(std::vector<CountedCurve>& curves, const std::vector<CountedFace>& faces) {
  return Balance(curves, faces).run();
}

}  // namespace delquad
