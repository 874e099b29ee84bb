// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/arc_measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/cancel.h"
#include "delquad/error.h"

namespace delquad {

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
/// Number of first panels, and a smaller number for pieces shorter than so many edges, of which outlines may
/// have thousands.
constexpr int kFirstPanels = 32, kFewPanels = 8;
constexpr double kShortPiece = 0.5;
/// Largest integral of a panel, in edges; with four samples in a panel, each edge has more than one.
constexpr double kEdgesPerPanel = 2;
/// Narrowest panel, over the parameter range; a jump of the size within it does not matter.
constexpr double kNarrowest = 0x1p-44;
/// Limit of panels beyond the number that edges need; a size that needs more is noise.
constexpr double kMaxPanels = 1 << 18;

}  // namespace

ArcMeasure::ArcMeasure(const Curve& curve, double t0, double t1, const SizeField& size,
                       const std::string& label, double most)
    : curve_(curve), t0_(t0), t1_(t1), size_(size), label_(label) {
  std::vector<Panel> panels;
  const Sample middle = sample(0.5 * (t0 + t1));
  double edges = trapezium(sample(t0), middle) + trapezium(middle, sample(t1));
  if (edges < kShortPiece) {
    panels = first_panels(kFewPanels);
    edges = 0;
    for (const Panel& p : panels) edges += p.value;
  }
  if (!(edges < kShortPiece)) panels = first_panels(kFirstPanels);
  refine(panels, most);
  finish(panels);
}

double ArcMeasure::trapezium(const Sample& a, const Sample& b) {
  return norm(b.p - a.p) * 0.5 * (a.density + b.density);
}

// Richardson's extrapolation of the trapezium rule on chords, whose error is even in the step.
double ArcMeasure::simpson(const Sample& a, const Sample& m, const Sample& b) {
  const double fine = trapezium(a, m) + trapezium(m, b);
  return fine + (fine - trapezium(a, b)) / 3;
}

ArcMeasure::Sample ArcMeasure::sample(double t) const {
  const Vec2 p = curve_.point(t);
  if (!std::isfinite(p.x) || !std::isfinite(p.y))
    throw InputError(
        fmt::format("{} is ({}, {}) at {} of its way: expected finite coordinates", label_, p.x, p.y, t));
  const double delta = size_.at({p.x, p.y, 0}, hint_);
  if (!(delta > 0) || !std::isfinite(delta))
    throw InputError(fmt::format("the size is {} at ({}, {}) on {}: expected a finite number above 0", delta,
                                 p.x, p.y, label_));
  return {t, p, 1 / delta};
}

ArcMeasure::Panel ArcMeasure::make_panel(const Sample& a, const Sample& m, const Sample& b) const {
  check_cancelled();
  const Sample q1 = sample(0.5 * (a.t + m.t)), q3 = sample(0.5 * (m.t + b.t));
  Panel panel{{a, q1, m, q3, b}, 0, 0, b.t - a.t <= kNarrowest * (t1_ - t0_)};
  panel.value = simpson(a, q1, m) + simpson(m, q3, b);
  panel.error = std::abs(panel.value - simpson(a, m, b));
  return panel;
}

std::vector<ArcMeasure::Panel> ArcMeasure::first_panels(int count) const {
  const auto at = [&](int k) {
    const int n = 2 * count;
    return sample(k == n ? t1_ : t0_ + (t1_ - t0_) * k / n);
  };
  std::vector<Panel> panels;
  Sample a = at(0);
  for (int k = 0; k < count; ++k) {
    const Sample m = at(2 * k + 1), b = at(2 * k + 2);
    panels.push_back(make_panel(a, m, b));
    a = b;
  }
  return panels;
}

// Splits panels, in rounds, whose error is above their share of the allowed error. So the sum of the errors
// is in bounds if no panel is split. Too narrow panels do not count.
void ArcMeasure::refine(std::vector<Panel>& panels, double most) const {
  bool every_edge = false;
  for (;;) {
    double total = 0;
    for (const Panel& p : panels) total += p.value;
    const double share = kIntegralTolerance * total / static_cast<double>(panels.size());
    std::vector<Panel> next;
    for (const Panel& p : panels) {
      if (p.minimal || (p.error <= share && !(every_edge && p.value > kEdgesPerPanel))) {
        next.push_back(p);
      } else {
        next.push_back(make_panel(p.s[0], p.s[1], p.s[2]));
        next.push_back(make_panel(p.s[2], p.s[3], p.s[4]));
      }
    }
    const bool done = next.size() == panels.size();
    panels = std::move(next);
    if (static_cast<double>(panels.size()) > kMaxPanels + 2 * std::clamp(most, 0.0, total))
      throw InputError(fmt::format("the size varies too fast along {} to be integrated", label_));
    if (!done) continue;
    if (every_edge || total > most) break;
    every_edge = true;
  }
  if (!every_edge) return;
  for (const Panel& p : panels) {
    if (p.value > kEdgesPerPanel)
      throw InputError(fmt::format("{} jumps from ({}, {}) to ({}, {}), or the size falls to nothing there",
                                   label_, p.s[0].p.x, p.s[0].p.y, p.s[4].p.x, p.s[4].p.y));
  }
}

void ArcMeasure::finish(const std::vector<Panel>& panels) {
  double sum = 0;
  cells_.reserve(2 * panels.size());
  for (const Panel& p : panels) {
    for (std::size_t half : {0u, 2u}) {
      sum += simpson(p.s[half], p.s[half + 1], p.s[half + 2]);
      cells_.push_back({p.s[half], p.s[half + 2], sum});
    }
  }
}

// Finds a node by false position (Illinois) on the integral from the cell's start; the bracket always has the
// target.
double ArcMeasure::find(const Cell& cell, double begin, double target) const {
  const double tolerance = 4 * kEps * integral();
  double low = cell.first.t, f_low = begin - target;
  double high = cell.last.t, f_high = cell.end - target;
  double t = low;
  for (int i = 0, side = 0; i < 80; ++i) {
    // False position may crawl beside a jump of the size: halve from time to time.
    t = f_high > f_low && i % 8 != 7 ? low - f_low * ((high - low) / (f_high - f_low)) : 0.5 * (low + high);
    t = std::clamp(t, low, high);
    if (high - low <= 2 * kEps * std::max(std::abs(low), std::abs(high))) break;
    const Sample last = sample(t);
    const double f = begin + simpson(cell.first, sample(0.5 * (cell.first.t + t)), last) - target;
    if (std::abs(f) <= tolerance) break;
    if (f < 0) {
      low = t, f_low = f;
      if (side < 0) f_high *= 0.5;
      side = -1;
    } else {
      high = t, f_high = f;
      if (side > 0) f_low *= 0.5;
      side = 1;
    }
  }
  return t;
}

std::vector<double> ArcMeasure::interior_nodes(int n) const {
  assert(n >= 1);
  std::vector<double> targets;
  for (int k = 1; k < n; ++k) targets.push_back(integral() * k / n);
  return nodes_at(targets);
}

std::vector<double> ArcMeasure::nodes_at(const std::vector<double>& targets) const {
  assert(std::ranges::is_sorted(targets));
  std::vector<double> nodes;
  nodes.reserve(targets.size());
  std::size_t c = 0;
  for (const double target : targets) {
    while (c + 1 < cells_.size() && cells_[c].end < target) ++c;
    nodes.push_back(find(cells_[c], c == 0 ? 0 : cells_[c - 1].end, target));
  }
  return nodes;
}

}  // namespace delquad
