#include <cmath>
#include <numbers>

#include "experiments/suite/model_text.h"
#include "experiments/suite/planar_models.h"
#include "experiments/suite/random.h"

namespace delquad {
namespace {

Vec2 polar(double radius, double angle) { return radius * Vec2{std::cos(angle), std::sin(angle)}; }

/// The outline of a gear: teeth with straight flanks between two radii.
std::vector<Vec2> toothed(int teeth, double root, double tip) {
  // Where a tooth's corners are, as parts of the pitch.
  constexpr double kRoot = 0.28, kTip = 0.13;
  std::vector<Vec2> outline;
  const double pitch = 2 * std::numbers::pi / teeth;
  for (int k = 0; k < teeth; ++k)
    for (const auto& [radius, part] : {std::pair(root, -kRoot), {tip, -kTip}, {tip, kTip}, {root, kRoot}})
      outline.push_back(polar(radius, pitch * (k + part)));
  return outline;
}

}  // namespace

/// 24 teeth, a bore with a keyway and six holes.
std::string make_gear() {
  ModelText model;
  model.polygon(toothed(24, 0.86, 1), {"teeth", "steel"});
  constexpr double kBore = 0.22, kKey = 0.06, kDepth = 0.29;
  std::vector<Vec2> bore;
  const double begin = std::asin(kKey / kBore);
  constexpr int kSides = 48;
  for (int k = 0; k <= kSides; ++k)
    bore.push_back(polar(kBore, begin + (2 * std::numbers::pi - 2 * begin) * k / kSides));
  bore.push_back({kDepth, -kKey});
  bore.push_back({kDepth, kKey});
  model.polygon(bore, {"bore", ""});
  for (int k = 0; k < 6; ++k)
    model.circle(polar(0.56, std::numbers::pi / 6 + k * std::numbers::pi / 3), 0.13, {"holes", ""});
  return model.text();
}

/// Teeth inside around a wheel, and grease between: the teeth come within 0.02.
std::string make_ring_gear() {
  ModelText model;
  model.circle({0, 0}, 1, {"rim", "ring"});
  model.polygon(toothed(40, 0.82, 0.9), {"ring teeth", "grease"});
  model.polygon(toothed(16, 0.66, 0.8), {"wheel teeth", "wheel"});
  model.circle({0, 0}, 0.2, {"shaft", ""});
  return model.text();
}

/// Rectangular slits in all directions, 100 times as long as wide.
std::string make_slits() {
  constexpr double kWidth = 0.004;
  Random random(9);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "plate"});
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) {
      const Vec2 middle = {0.25 + 0.5 * i, 0.25 + 0.5 * j};
      const Vec2 along = polar(0.2, random.between(0, std::numbers::pi)), up = kWidth / 0.4 * perp(along);
      model.polygon({middle - along - up, middle + along - up, middle + along + up, middle - along + up},
                    {"slit", ""});
    }
  return model.text();
}

/// A channel that turns 14 times between thin walls.
std::string make_serpentine() {
  constexpr int kWalls = 14;
  constexpr double kThickness = 0.01;
  std::vector<Vec2> outline = {{0, 0}};
  const double step = 2.0 / (kWalls + 1);
  const auto wall = [&](double x, double foot, double tip, double side) {
    for (const Vec2 p : {Vec2{x - side, foot}, {x - side, tip}, {x + side, tip}, {x + side, foot}})
      outline.push_back(p);
  };
  for (int k = 1; k <= kWalls; k += 2) wall(step * k, 0, 0.88, kThickness / 2);
  outline.push_back({2, 0});
  outline.push_back({2, 1});
  for (int k = kWalls; k > 0; k -= 2) wall(step * k, 1, 0.12, -kThickness / 2);
  outline.push_back({0, 1});
  ModelText model;
  model.polygon(outline, {"wall", "channel"});
  return model.text();
}

/// A corner that points inwards, and a hole: the size, which the list has, varies by a factor of 100.
std::string make_graded() {
  ModelText model;
  model.polygon({{-1, -1}, {1, -1}, {1, 1}, {0, 1}, {0, 0}, {-1, 0}}, {"outer", "domain"});
  model.circle({0.5, -0.5}, 0.2, {"hole", ""});
  return model.text();
}

}  // namespace delquad
