// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/joint_layouts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/layout/layout_arcs.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "base/budget.h"
#include "base/matching/edge_counts.h"
#include "base/parallel.h"
#include "base/stopwatch.h"

namespace delquad {

namespace {

// Prices are in irregular vertices.

/// Price of an open sum, for each missing edge, and of a polygon without a star.
constexpr double kOpenSumPrice = 1, kMissingEdgePrice = 0.5, kNoStarPrice = 2;
/// Price of an added or removed edge of a patch without a layout, and number of rows that follow it.
constexpr double kFreeEdgePrice = 0.3, kRowsThatFollow = 2;
/// Price of sizes of quads with too long or short edges, for half of their edges. Part of a piece that a
/// change of its side affects.
constexpr double kSizePrice = 1.5 / 2, kAffectedPart = 0.5;
/// Price of a forbidden choice.
constexpr double kForbiddenPrice = 1e6;
/// Factor of the price of an open sum: groups lose less than predicted.
constexpr double kOpenSumFactor = 2;
/// Limits of agree_counts(): steps, and patches in one of its searches.
constexpr long long kMostSteps = 200'000;
constexpr int kMostLooks = 100;
/// Limit of choices of numbers.
constexpr int kMostRounds = 16;
/// Least eta of quads, unless they were worse before.
constexpr double kLeastEta = 0.3;

/// Numbers of edges on curves, and on the arcs of each patch.
struct Numbers {
  std::vector<int> curves;
  std::vector<std::vector<int>> arcs;
};

/// Problem for agree_counts(): curves first, then arcs that are a part of a curve or inside a patch.
class NumberProblem {
 public:
  /// `price` is the cost of an irregular vertex; `stays` marks patches that take no part.
  NumberProblem(const LayoutNetwork& network, const std::vector<std::optional<LayoutArcs>>& layouts,
                const std::vector<char>& stays, double price)
      : price_(price), n_curves_(network.curves.size()) {
    for (const LayoutCurve& c : network.curves) add(c.edges, std::max(c.edges, 1), c.least, c.is_free);
    for (std::size_t p = 0; p < network.patches.size(); ++p) {
      variables_.emplace_back();
      const LayoutPatch& patch = network.patches[p];
      if (stays[p])
        for (const CurveRun& run : patch.runs) curves_[run.curve].is_free = false;
      else if (layouts[p])
        add_layout(patch, *layouts[p]);
      else
        add_front(patch);
    }
    for (std::size_t c = 0; c < n_curves_; ++c)
      if (curves_[c].patches.empty()) curves_[c].is_free = false;
  }

  Numbers solve(Budget& steps) {
    agree_counts(curves_, n_places_, sums_, steps, counts_, kMostLooks);
    Numbers numbers{{counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(n_curves_)}, {}};
    for (const std::vector<int>& of_arcs : variables_) {
      auto& arcs = numbers.arcs.emplace_back();
      for (const int v : of_arcs) arcs.push_back(counts_[v]);
    }
    return numbers;
  }

 private:
  int add(int edges, double ideal, int least, bool is_free) {
    curves_.push_back({ideal, least, is_free, 0, {}});
    counts_.push_back(edges);
    return static_cast<int>(curves_.size()) - 1;
  }

  void add_front(const LayoutPatch& patch) {
    const int place = n_places_++;
    for (const CurveRun& run : patch.runs) {
      curves_[run.curve].patches.push_back(place);
      curves_[run.curve].weight += kSizePrice * kRowsThatFollow + kFreeEdgePrice * price_;
    }
  }

  void add_layout(const LayoutPatch& patch, const LayoutArcs& layout) {
    std::vector<int>& variable = variables_.back();
    variable.assign(layout.arcs().size(), -1);
    for (std::size_t r = 0; r < patch.runs.size(); ++r) {
      const std::vector<int>& arcs = layout.of_runs()[r];
      const auto& [curve, edges] = patch.runs[r];
      if (arcs.size() == 1) {
        variable[arcs[0]] = curve;
        continue;
      }
      // Together the arcs have as many edges as the curve.
      const int place = n_places_++;
      curves_[curve].patches.push_back(place);
      ClosureSum whole{place, {{curve, -1}}, 0, kForbiddenPrice};
      double length = 0;
      for (const int a : arcs) length += layout.arcs()[a].length;
      for (const int a : arcs) {
        const LayoutArcs::Arc& arc = layout.arcs()[a];
        variable[a] = add(arc.edges(), arc.length * edges / length, 1, true);
        curves_.back().patches = {place};
        whole.terms.emplace_back(variable[a], 1);
      }
      sums_.push_back(std::move(whole));
    }
    for (std::size_t a = 0; a < variable.size(); ++a)
      if (variable[a] < 0) variable[a] = add(layout.arcs()[a].edges(), layout.arcs()[a].length, 1, true);
    for (const auto& piece : layout.pieces()) add_piece(piece, variable);
  }

  void add_piece(std::span<const LayoutArcs::Step> piece, const std::vector<int>& variable) {
    const int place = n_places_++;
    const auto corner = std::ranges::find_if(piece, [](const auto& step) { return step.quads != 2; });
    const auto first = static_cast<std::size_t>(corner - piece.begin());
    std::vector<std::vector<int>> sides;
    std::vector<double> lengths;
    int corners = 0;
    bool is_convex = true;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const auto& [arc, forward, quads] = piece[(first + i) % piece.size()];
      corners += 2 - quads, is_convex &= quads <= 2;
      if (quads != 2 || sides.empty()) sides.emplace_back(), lengths.push_back(0);
      const int v = variable[arc];
      sides.back().push_back(v);
      lengths.back() += curves_[v].ideal;
      curves_[v].patches.push_back(place);
    }
    const bool is_box = is_convex && corners == 4;
    const double around = std::reduce(lengths.begin(), lengths.end());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const double depth = is_box ? (lengths[(i + 1) % 4] + lengths[(i + 3) % 4]) / 2 : around / 5;
      for (const int v : sides[i]) curves_[v].weight += kSizePrice * kAffectedPart * depth;
    }
    if (is_box)
      for (int i = 0; i < 2; ++i) {
        // A pair ends two rows for each edge but one of the available space.
        const double room = std::max((lengths[i + 1] + lengths[(i + 3) % 4]) / 2 - 1, 0.05);
        add_sum({place, {}, kOpenSumPrice, std::max(kMissingEdgePrice, 0.5 / room)},
                {{&sides[i], 1}, {&sides[i + 2], -1}});
      }
    if (is_convex && (corners == 3 || corners == 5))
      for (int i = 0; i < corners; ++i) {
        // The sum is twice the distance from the start of side i to the foot of an arm, see star_feet().
        Sides terms;
        for (int k = 0, at = i; k < corners; ++k, at = (at + 2) % corners)
          terms.emplace_back(&sides[at], k % 2 == 0 ? 1 : -1);
        add_sum({place, {}, kNoStarPrice, kMissingEdgePrice, 2}, terms);
      }
  }

  using Sides = std::vector<std::pair<const std::vector<int>*, int>>;
  void add_sum(ClosureSum sum, const Sides& sides) {
    std::map<int, int> terms;
    for (const auto& [side, sign] : sides)
      for (const int v : *side) terms[v] += sign;
    for (const auto& [v, times] : terms)
      if (times != 0) sum.terms.emplace_back(v, times);
    sum.price_of_pair *= 2 * price_;
    sum.price *= 2 * price_;
    sums_.push_back(std::move(sum));
  }

  double price_;
  std::size_t n_curves_;
  int n_places_ = 0;  ///< pieces, patches without pieces, and curves with several arcs
  std::vector<AgreeingCurve> curves_;
  std::vector<int> counts_;
  std::vector<ClosureSum> sums_;
  std::vector<std::vector<int>> variables_;  ///< variables of the arcs of each patch
};

class JointLayout {
 public:
  JointLayout(LayoutNetwork& network, double price)
      : network_(network),
        price_(price),
        n_(network.patches.size()),
        layouts_(n_),
        score_(n_),
        candidates_(n_),
        takes_no_part_(n_) {}

  JointLayoutSummary run() {
    std::vector<int> curves;
    for (const LayoutCurve& c : network_.curves) curves.push_back(c.edges);
    for_each_patch([&](std::size_t p) { begin(p); });
    stays_ = takes_no_part_;
    for (int round = 0; round < kMostRounds; ++round) {
      Budget steps(kMostSteps);
      const Numbers numbers = NumberProblem(network_, layouts_, stays_, kOpenSumFactor * price_).solve(steps);
      ++summary_.chosen;
      for_each_patch([&](std::size_t p) {
        if (!stays_[p]) make_candidate(p, numbers);
      });
      if (choose(numbers)) break;
    }
    for (const LayoutPatch& patch : network_.patches) summary_.patches += patch.changed;
    for (const auto& candidate : candidates_) summary_.filled += candidate.filled;
    for (std::size_t c = 0; c < curves.size(); ++c) summary_.curves += curves[c] != network_.curves[c].edges;
    return summary_;
  }

 private:
  /// A possible mesh of a patch.
  struct Candidate {
    std::vector<int> numbers = {};  ///< edges on its arcs and curves
    bool moved = false;             ///< its curves have other numbers now
    double cost = kForbiddenPrice;  ///< its loss minus the worth of removed irregular vertices
    std::optional<QuadPatch> mesh = {};
    PatchBoundary boundary = {};
    PatchScore score = {};
    int filled = 0;  ///< number of meshes made so far
  };

  template <class F>
  void for_each_patch(const F& work) {
    parallel_for(n_, work,
                 [&](std::size_t p) { return static_cast<double>(network_.patches[p].mesh.points.size()); });
  }

  void begin(std::size_t p) {
    const LayoutPatch& patch = network_.patches[p];
    takes_no_part_[p] = patch.cross == nullptr;
    if (takes_no_part_[p]) return;
    score_[p] = PatchScore::of(patch.mesh, *patch.size);
    if (auto layout = find_layout(patch.boundary, *patch.cross, *patch.size, LayoutEdges::kFree))
      set_layout(p, *std::move(layout));
  }

  void set_layout(std::size_t p, PatchLayout layout) {
    const LayoutPatch& patch = network_.patches[p];
    std::vector<int> runs;
    for (const CurveRun& run : patch.runs) runs.push_back(run.edges);
    layouts_[p].emplace(std::move(layout), patch.boundary, runs, *patch.size);
  }

  void make_candidate(std::size_t p, const Numbers& numbers) {
    const LayoutPatch& patch = network_.patches[p];
    Candidate best{.numbers = numbers.arcs[p]};
    for (const auto& [curve, edges] : patch.runs) {
      best.numbers.push_back(numbers.curves[curve]);
      best.moved |= numbers.curves[curve] != edges;
    }
    Candidate& now = candidates_[p];
    if (best.numbers == now.numbers) return;
    best.filled = now.filled;
    const auto boundary =
        best.moved ? network_.boundary(static_cast<int>(p), numbers.curves) : std::optional(patch.boundary);
    const auto consider = [&](QuadPatch mesh) {
      ++best.filled;
      const PatchScore score = PatchScore::of(mesh, *patch.size);
      if (!mesh.triangles.empty() || !score_[p].keeps_worst(score, kLeastEta) ||
          !network_.is_allowed(mesh, *boundary))
        return;
      const double cost = score_[p].loss(score) - price_ * (score_[p].irregular - score.irregular);
      if (best.mesh && cost >= best.cost) return;
      best.cost = cost, best.mesh = std::move(mesh), best.score = score;
    };
    if (boundary && layouts_[p]) {
      const PatchLayout layout = layouts_[p]->with(numbers.arcs[p], *boundary, *patch.size);
      if (const auto mesh = fill_layout(layout, *boundary, *patch.cross, *patch.size))
        consider(by_cavities(*mesh, patch));
    }
    if (boundary && best.moved && best.cost > 0) consider(by_front(patch, *boundary));
    if (boundary) best.boundary = *boundary;
    now = std::move(best);
  }

  QuadPatch by_cavities(const QuadPatch& mesh, const LayoutPatch& patch) const {
    return make_regular(mesh, *patch.size, {.tolerance = price_, .rounds = 1});
  }
  QuadPatch by_front(const LayoutPatch& patch, const PatchBoundary& boundary) const {
    const TriPatch triangles = mesh_delquad(boundary, *make_linf_delquad(), *patch.cross, *patch.size);
    const QuadPatch merged = recombine(triangles, *make_primal_dual_solver());
    return by_cavities(make_regular(treat_paper(merged, *patch.size), *patch.size, without_price({})), patch);
  }

  /// Takes worthwhile groups. Returns false if a patch of each other group keeps its curves from now on.
  bool choose(const Numbers& numbers) {
    std::vector<int> group(n_);
    std::iota(group.begin(), group.end(), 0);
    const auto root = [&](int p) {
      while (group[p] != p) p = group[p] = group[group[p]];
      return p;
    };
    std::vector<int> beside(network_.curves.size(), -1);
    for (int p = 0; p < static_cast<int>(n_); ++p)
      for (const auto& [curve, edges] : network_.patches[p].runs) {
        if (numbers.curves[curve] == edges) continue;
        if (beside[curve] < 0) beside[curve] = p;
        group[root(p)] = root(beside[curve]);
      }
    std::map<int, std::vector<int>> groups;
    for (int p = 0; p < static_cast<int>(n_); ++p)
      if (!stays_[p]) groups[root(p)].push_back(p);
    bool is_done = true;
    for (const auto& [first, patches] : groups) {
      double cost = 0;
      int fewer = 0;
      for (const int p : patches)
        cost += candidates_[p].cost, fewer += score_[p].irregular - candidates_[p].score.irregular;
      const int worst = *std::ranges::max_element(patches, {}, [&](int p) { return candidates_[p].cost; });
      if (cost < 0 && fewer > 0) {
        ++summary_.accepted;
        for (const int p : patches) take(p, numbers);
      } else if (candidates_[worst].moved) {
        is_done = false;
        for (const int p : patches) stays_[p] = candidates_[p].cost >= candidates_[worst].cost / 2;
      }
    }
    return is_done;
  }

  void take(int p, const Numbers& numbers) {
    Candidate& candidate = candidates_[p];
    LayoutPatch& patch = network_.patches[p];
    summary_.gained += score_[p].irregular - candidate.score.irregular;
    patch.mesh = *std::move(candidate.mesh);
    patch.boundary = std::move(candidate.boundary);
    patch.changed = true;
    score_[p] = candidate.score;
    for (auto& [curve, edges] : patch.runs) network_.curves[curve].edges = edges = numbers.curves[curve];
    if (layouts_[p]) set_layout(p, layouts_[p]->with(numbers.arcs[p], patch.boundary, *patch.size));
    candidate = {.filled = candidate.filled};
  }

  LayoutNetwork& network_;
  double price_;
  std::size_t n_;
  std::vector<std::optional<LayoutArcs>> layouts_;  ///< layout of each patch, if it has one
  std::vector<PatchScore> score_;                   ///< worth of its mesh
  std::vector<Candidate> candidates_;
  std::vector<char> takes_no_part_, stays_;  ///< whether it takes no part, always or now
  JointLayoutSummary summary_;
};

}  // namespace

JointLayoutSummary lay_out_jointly(LayoutNetwork& network, double price) {
  const Stopwatch watch;
  JointLayoutSummary summary = JointLayout(network, price).run();
  summary.seconds = watch.seconds();
  return summary;
}

}  // namespace delquad
