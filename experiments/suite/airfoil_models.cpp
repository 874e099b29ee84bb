#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiments/suite/model_text.h"
#include "experiments/suite/planar_models.h"

namespace delquad {
namespace {

/// An airfoil of the four-digit NACA series, without camber or with a parabola's.
struct Airfoil {
  double thickness, camber, chord;
  double angle;  ///< nose up, in degrees
  Vec2 nose;
  bool sharp;  ///< the series' own tail is blunt
};

/// The formula of half the thickness at x = t^2, which is smooth at the nose.
std::string half_thickness(const Airfoil& a) {
  return fmt::format("{}*5*(0.2969*t-0.126*t^2-0.3516*t^4+0.2843*t^6-{}*t^8)", a.thickness,
                     a.sharp ? "0.1036" : "0.1015");
}

void add_side(ModelText& model, const Airfoil& a, const std::string& name, const char* sign) {
  const double turn = -a.angle * std::numbers::pi / 180;
  const std::string c = nine_digits(a.chord * std::cos(turn)), s = nine_digits(a.chord * std::sin(turn));
  const std::string y = fmt::format("({}*4*t^2*(1-t^2){}{})", a.camber, sign, half_thickness(a));
  model.curve(name, fmt::format("{}+{}*t^2-({})*{}", nine_digits(a.nose.x), c, s, y),
              fmt::format("{}+({})*t^2+{}*{}", nine_digits(a.nose.y), s, c, y), 0, 1);
}

/// The point of the tail on a side (1 or -1).
Vec2 tail(const Airfoil& a, double side) {
  const double turn = -a.angle * std::numbers::pi / 180;
  const double y = side * a.thickness * 5 * (0.2969 - 0.126 - 0.3516 + 0.2843 - 0.1015);
  const double c = a.chord * std::cos(turn), s = a.chord * std::sin(turn);
  return {a.nose.x + c - s * y, a.nose.y + s + c * y};
}

void add_airfoil(ModelText& model, const Airfoil& a, const std::string& name) {
  std::vector<std::string> curves = {name + "_upper", name + "_lower"};
  add_side(model, a, curves[0], "+");
  add_side(model, a, curves[1], "-");
  if (!a.sharp) {
    curves.push_back(name + "_tail");
    model.segment(curves[2], tail(a, 1), tail(a, -1));
  }
  model.hole(curves);
}

}  // namespace

std::string make_naca_sharp() {
  ModelText model;
  model.rectangle({-1.5, -1.5}, {3.5, 1.5}, {"far", "air"});
  add_airfoil(model, {0.12, 0, 1, 4, {0, 0}, true}, "wing");
  return model.text();
}

std::string make_naca_blunt() {
  ModelText model;
  model.rectangle({-1.5, -1.5}, {3.5, 1.5}, {"far", "air"});
  add_airfoil(model, {0.21, 0.04, 1, 8, {0, 0}, false}, "wing");
  return model.text();
}

/// Slat, wing and flap with narrow gaps; the wing's tail is blunt, the others' are sharp.
std::string make_high_lift() {
  ModelText model;
  model.rectangle({-1.5, -1.5}, {3.5, 1.5}, {"far", "air"});
  add_airfoil(model, {0.12, 0.06, 0.17, -24, {-0.165, -0.11}, true}, "slat");
  add_airfoil(model, {0.14, 0.03, 0.8, 2, {0, 0}, false}, "wing");
  add_airfoil(model, {0.13, 0.05, 0.32, 32, {0.79, -0.055}, true}, "flap");
  return model.text();
}

}  // namespace delquad
