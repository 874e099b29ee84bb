#include "metrics/solve/element_points.h"

#include <cmath>

namespace delquad {
namespace {

struct GaussPoint {
  double at, weight;
};

const std::vector<GaussPoint>& gauss_rule(int n) {
  static const std::vector<GaussPoint> two = {{-1 / std::sqrt(3.0), 1}, {1 / std::sqrt(3.0), 1}};
  static const std::vector<GaussPoint> three = {
      {-std::sqrt(0.6), 5.0 / 9}, {0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}};
  return n == 2 ? two : three;
}

ElementPoint point_of(const std::array<Vec3, 4>& corners, const GaussPoint& r, const GaussPoint& s) {
  constexpr std::array<std::array<int, 2>, 4> kSigns = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  ElementPoint p{0, {}, {}, {}, {}};
  std::array<double, 4> by_r, by_s;
  Vec3 along_r, along_s;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [i, j] = kSigns[k];
    p.value[k] = (1 + i * r.at) * (1 + j * s.at) / 4;
    by_r[k] = i * (1 + j * s.at) / 4;
    by_s[k] = j * (1 + i * r.at) / 4;
    p.at = p.at + p.value[k] * corners[k];
    along_r = along_r + by_r[k] * corners[k];
    along_s = along_s + by_s[k] * corners[k];
  }
  const Vec3 area = cross(along_r, along_s);
  const double density = norm(area);
  p.weight = r.weight * s.weight * density;
  p.normal = (1 / density) * area;
  // The dual basis of the tangents.
  const Vec3 dual_r = (1 / density) * cross(along_s, p.normal),
             dual_s = (1 / density) * cross(p.normal, along_r);
  for (std::size_t k = 0; k < 4; ++k) p.gradient[k] = by_r[k] * dual_r + by_s[k] * dual_s;
  return p;
}

}  // namespace

std::vector<ElementPoint> element_points(const std::array<Vec3, 4>& corners, int n) {
  std::vector<ElementPoint> points;
  for (const GaussPoint& s : gauss_rule(n))
    for (const GaussPoint& r : gauss_rule(n)) points.push_back(point_of(corners, r, s));
  return points;
}

}  // namespace delquad
