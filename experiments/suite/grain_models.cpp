#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/suite/model_text.h"
#include "experiments/suite/planar_models.h"
#include "experiments/suite/random.h"

namespace delquad {
namespace {

struct Disc {
  Vec2 centre;
  double radius;
};

struct Packing {
  Vec2 high;  ///< corner of the rectangle from the origin
  int count;
  double smallest, largest, gap;  ///< radii, and what is left between two at least
};

/// Discs that are thrown in one after the other, the largest first, each where there is room. Every second
/// one slides towards its nearest neighbour until only the gap is left.
std::vector<Disc> throw_in(const Packing& packing, std::uint64_t seed) {
  constexpr int kTrials = 4000;
  Random random(seed);
  std::vector<Disc> discs;
  for (int n = 0; n < packing.count; ++n) {
    const double part = static_cast<double>(n) / packing.count;
    const double radius = packing.largest + part * (packing.smallest - packing.largest);
    const auto free = [&](Vec2 p) {
      const double edge = std::min({p.x, p.y, packing.high.x - p.x, packing.high.y - p.y}) - radius;
      return edge >= packing.gap && std::ranges::all_of(discs, [&](const Disc& d) {
               return norm(d.centre - p) >= d.radius + radius + packing.gap * (1 - 1e-9);
             });
    };
    for (int trial = 0; trial < kTrials; ++trial) {
      Vec2 p = {random.between(0, packing.high.x), random.between(0, packing.high.y)};
      if (!free(p)) continue;
      if (n % 2 == 1) {
        const Disc& d = *std::ranges::min_element(
            discs, {}, [&](const Disc& other) { return norm(other.centre - p) - other.radius; });
        const Vec2 moved = d.centre + (d.radius + radius + packing.gap) / norm(p - d.centre) * (p - d.centre);
        if (free(moved)) p = moved;
      }
      discs.push_back({p, radius});
      break;
    }
  }
  return discs;
}

std::string pore_space(const Packing& packing, std::uint64_t seed) {
  ModelText model;
  model.rectangle({0, 0}, packing.high, {"outer", "fluid"});
  for (const Disc& d : throw_in(packing, seed)) model.circle(d.centre, d.radius, {"grain", ""});
  return model.text();
}

/// A convex polygon with its corners on a circle, at least half as far apart as on average.
std::vector<Vec2> random_polygon(const Disc& d, int corners, Random& random) {
  std::vector<Vec2> polygon;
  const double turn = random.between(0, 2 * std::numbers::pi);
  for (int k = 0; k < corners; ++k) {
    const double angle = turn + 2 * std::numbers::pi * (k + random.between(-0.25, 0.25)) / corners;
    polygon.push_back(d.centre + d.radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return polygon;
}

}  // namespace

std::string make_porous() { return pore_space({{2, 1}, 60, 0.04, 0.13, 0.01}, 3); }

std::string make_porous_fine() { return pore_space({{2, 1}, 220, 0.012, 0.06, 0.004}, 4); }

/// Inclusions in inclusions: rings of up to three materials, some with a hole, some off their middle.
std::string make_circles() {
  Random random(5);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "matrix"});
  for (const Disc& d : throw_in({{2, 1}, 16, 0.06, 0.24, 0.015}, 6)) {
    model.circle(d.centre, d.radius, {"interface", "shell"});
    const double inner = random.between(0.5, 0.8) * d.radius, angle = random.between(0, 2 * std::numbers::pi);
    const double shift = random.between(0, 0.8) * (d.radius - inner);
    const Vec2 centre = d.centre + shift * Vec2{std::cos(angle), std::sin(angle)};
    model.circle(centre, inner, {"interface", random.between(0, 1) < 0.6 ? "core" : ""});
  }
  return model.text();
}

/// Stones of three to seven corners: holes and inclusions.
std::string make_polygons() {
  Random random(7);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "mortar"});
  for (const Disc& d : throw_in({{2, 1}, 40, 0.05, 0.18, 0.01}, 8)) {
    const int corners = 3 + static_cast<int>(random.between(0, 5));
    const std::vector<Vec2> polygon = random_polygon(d, corners, random);
    model.polygon(polygon, {"stone", random.between(0, 1) < 0.5 ? "stone" : ""});
  }
  return model.text();
}

}  // namespace delquad
