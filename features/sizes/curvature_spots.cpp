// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/sizes/curvature_spots.h"

#include <algorithm>
#include <cmath>

#include "algorithms/fields/fields.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/planar/curve_pieces.h"

namespace delquad {
namespace {

/// Parts of a curve turn by no more (radians), and there are so many of it at least.
constexpr double kMostTurn = 0.1;
constexpr int kLeastParts = 512;
/// Parts are halved no more often: what turns within less is a corner.
constexpr int kMostHalvings = 16;

class CurveTurns {
 public:
  CurveTurns(const Curve& shape, double per_turn, const SizeSpec& spec, const SizeField& base,
             std::vector<LocalSize>& spots)
      : shape_(shape), per_turn_(per_turn), spec_(spec), base_(base), spots_(spots) {
    double from = 0;
    std::vector<double> stops = shape.fixed_parameters();
    stops.push_back(1);
    for (const double to : stops) {
      for (int k = 0; k < kLeastParts; ++k) {
        const double t0 = from + (to - from) * k / kLeastParts,
                     t1 = from + (to - from) * (k + 1) / kLeastParts;
        add(t0, shape.point(t0), t1, shape.point(t1), kMostHalvings);
      }
      from = to;
    }
  }

 private:
  void add(double t0, Vec2 a, double t1, Vec2 b, int halvings) {
    const double t = 0.5 * (t0 + t1);
    const Vec2 m = shape_.point(t), in = m - a, out = b - m;
    // Two chords of an arc turn by half of what it does.
    const double turn = 2 * std::abs(std::atan2(cross(in, out), dot(in, out)));
    if (turn > kMostTurn && halvings > 0) {
      add(t0, a, t, m, halvings - 1);
      add(t, m, t1, b, halvings - 1);
      return;
    }
    const double length = norm(in) + norm(out), wanted = base_.at({m.x, m.y, 0}, hint_);
    if (!(length > 0) || turn > kMostTurn) return;
    const double size = size_by_curvature(wanted, turn / length, per_turn_, spec_.min);
    const double growth = spec_.gradation > 0 ? spec_.gradation : kCurvatureGradation;
    if (size < wanted) spots_.push_back({{a.x, a.y, 0}, {b.x, b.y, 0}, size, 0, growth});
  }

  const Curve& shape_;
  const double per_turn_;
  const SizeSpec& spec_;
  const SizeField& base_;
  std::vector<LocalSize>& spots_;
  int hint_ = -1;
};

}  // namespace

std::vector<double> requested_turns(const PlanarModel& model, const PlanarDomain& domain,
                                    const SizeSpec& spec) {
  const std::vector<Entity> curves = curve_entities(model);
  std::vector<double> own(curves.size(), 0);
  for (const NamedSize& wanted : spec.named) {
    if (!(wanted.curvature > 0)) continue;
    std::vector<int> named = entities_named(curves, "curve", wanted.name);
    for (std::size_t p = 0; p < domain.patches.size(); ++p)
      if (has_name(domain.boundary.regions[domain.patch_region[p]], wanted.name))
        for (const int c : domain.patches[p].edge_curve)
          if (c >= 0) named.insert(named.end(), domain.model_curves[c].begin(), domain.model_curves[c].end());
    if (named.empty()) find_entities(curves, "curve", wanted.name, wanted.where);
    for (const int c : named) own[c] = std::max(own[c], wanted.curvature);
  }
  for (double& per_turn : own)
    if (per_turn == 0) per_turn = spec.curvature;
  return own;
}

std::vector<LocalSize> curvature_spots(const PlanarModel& model, const PlanarDomain& domain,
                                       const SizeSpec& spec, const SizeField& base) {
  const std::vector<double> asked = requested_turns(model, domain, spec);
  std::vector<LocalSize> spots;
  for (std::size_t c = 0; c < asked.size(); ++c)
    if (asked[c] > 0) CurveTurns(*model.curves[c].shape, asked[c], spec, base, spots);
  return spots;
}

}  // namespace delquad
