#include "experiments/sweep/geometry_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace delquad {
namespace {

using Complex = std::complex<double>;

/// A short piece of a curve.
struct Piece {
  Complex at;
  double length;
};

std::vector<Piece> pieces_of(const PlanarModel& model) {
  constexpr int kAll = 20'000, kFewest = 16, kMost = 2000;  // of a circle: lengths to 1e-6
  const int of_curve = std::clamp(kAll / std::max(1, static_cast<int>(model.curves.size())), kFewest, kMost);
  std::vector<Piece> pieces;
  for (const ModelCurve& curve : model.curves) {
    std::vector<double> at = curve.shape->fixed_parameters();
    for (int k = 0; k <= of_curve; ++k) at.push_back(static_cast<double>(k) / of_curve);
    std::ranges::sort(at);
    Vec2 before = curve.shape->point(at[0]);
    for (const double t : at) {
      const Vec2 here = curve.shape->point(t), middle = 0.5 * (before + here);
      pieces.push_back({{middle.x, middle.y}, norm(here - before)});
      before = here;
    }
  }
  return pieces;
}

}  // namespace

std::vector<double> geometry_moments(const PlanarModel& model) {
  constexpr std::array<std::array<int, 2>, 7> kOrders = {
      {{2, 0}, {3, 0}, {2, 1}, {4, 0}, {3, 1}, {2, 2}, {5, 1}}};
  const std::vector<Piece> pieces = pieces_of(model);
  Complex centre = 0;
  double length = 0, square = 0;
  for (const Piece& p : pieces) length += p.length, centre += p.length * p.at;
  if (!(length > 0)) return {};
  centre /= length;
  for (const Piece& p : pieces) square += p.length * std::norm(p.at - centre);
  const double radius = std::sqrt(square / length);
  std::vector<double> moments = {static_cast<double>(model.loops.size()), length / radius};
  for (const auto& [a, b] : kOrders) {
    Complex sum = 0;
    for (const Piece& p : pieces) {
      const Complex z = (p.at - centre) / radius;
      Complex product = p.length / length;
      for (int k = 0; k < a; ++k) product *= z;
      for (int k = 0; k < b; ++k) product *= std::conj(z);
      sum += product;
    }
    moments.push_back(std::abs(sum));
  }
  return moments;
}

}  // namespace delquad
