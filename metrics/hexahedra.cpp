// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/hexahedra.h"

#include <algorithm>

#include "base/parallel.h"

namespace delquad {

namespace {

/// Limit of halvings, in three directions in turn, of a hexahedron whose sign is open.
constexpr int kMostHalvings = 12;

double triple(const Vec3& a, const Vec3& b, const Vec3& c) { return dot(cross(a, b), c); }

/// Neighbors of each corner, in an order that makes the edges right-handed.
constexpr int kNeighbours[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                   {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

/// Determinants of the Jacobian at 0, 1/2 and 1 of each parameter, the first one fastest. They define a
/// polynomial of degree 2 in each.
using Values27 = std::array<double, 27>;
Values27 jacobian_values(const HexCorners& p) {
  // Edges along each parameter, by the other two (lower one first): (0, 0), (1, 0), (0, 1), (1, 1).
  const std::array<std::array<Vec3, 4>, 3> edges = {{{p[1] - p[0], p[2] - p[3], p[5] - p[4], p[6] - p[7]},
                                                     {p[3] - p[0], p[2] - p[1], p[7] - p[4], p[6] - p[5]},
                                                     {p[4] - p[0], p[5] - p[1], p[7] - p[3], p[6] - p[2]}}};
  const auto along = [&](int axis, double s, double t) {
    const auto& e = edges[axis];
    return (1 - t) * ((1 - s) * e[0] + s * e[1]) + t * ((1 - s) * e[2] + s * e[3]);
  };
  Values27 values;
  for (int k = 0; k < 27; ++k) {
    const double u = k % 3 / 2.0, v = k / 3 % 3 / 2.0, w = k / 9 / 2.0;
    values[k] = triple(along(0, v, w), along(1, u, w), along(2, u, v));
  }
  return values;
}

constexpr std::array<int, 3> kStrides = {1, 3, 9};

/// Calls f(a, b, c) for the triples along an axis.
template <class F>
void for_each_row(Values27& values, int axis, const F& f) {
  const int stride = kStrides[axis];
  for (int k = 0; k < 27; ++k)
    if (k / stride % 3 == 0) f(values[k], values[k + stride], values[k + 2 * stride]);
}

Values27 bernstein(Values27 values) {
  for (int axis = 0; axis < 3; ++axis)
    for_each_row(values, axis, [](double a, double& b, double c) { b = 2 * b - (a + c) / 2; });
  return values;
}

/// Returns whether a polynomial is above `least` everywhere, by its coefficients.
bool is_above(const Values27& b, double least, int halvings) {
  if (*std::min_element(b.begin(), b.end()) > least) return true;
  for (const int corner : {0, 2, 6, 8, 18, 20, 24, 26})
    if (!(b[corner] > least)) return false;
  if (halvings == kMostHalvings) return false;
  Values27 low = b, high = b;
  for_each_row(low, halvings % 3, [](double a, double& m, double& c) {
    c = (a + 2 * m + c) / 4;
    m = (a + m) / 2;
  });
  for_each_row(high, halvings % 3, [](double& a, double& m, double c) {
    a = (a + 2 * m + c) / 4;
    m = (m + c) / 2;
  });
  return is_above(low, least, halvings + 1) && is_above(high, least, halvings + 1);
}

}  // namespace

double scaled_jacobian(const HexCorners& at) {
  double least = 1;
  for (int k = 0; k < 8; ++k) {
    std::array<Vec3, 3> edge;
    for (int j = 0; j < 3; ++j) {
      edge[j] = at[kNeighbours[k][j]] - at[k];
      const double length = norm(edge[j]);
      if (length > 0) edge[j] = (1 / length) * edge[j];
    }
    least = std::min(least, triple(edge[0], edge[1], edge[2]));
  }
  return least;
}

double signed_volume(const HexCorners& at) {
  constexpr std::array kWeights = {1.0 / 6, 4.0 / 6, 1.0 / 6};  // Simpson's, exact up to degree 3
  const Values27 values = jacobian_values(at);
  double sum = 0;
  for (int k = 0; k < 27; ++k) sum += kWeights[k % 3] * kWeights[k / 3 % 3] * kWeights[k / 9] * values[k];
  return sum;
}

bool is_positive(const HexCorners& at) {
  double scale = 0;
  for (int k = 0; k < 8; ++k) {
    double product = 1;
    for (const int j : kNeighbours[k]) product *= norm(at[j] - at[k]);
    scale = std::max(scale, product);
  }
  return scaled_jacobian(at) > kLeastHexJacobian &&
         is_above(bernstein(jacobian_values(at)), kLeastHexJacobian * scale, 0);
}

HexMeasures measure(const Mesh& mesh) {
  HexMeasures measures;
  const std::size_t n = mesh.hexahedra.size();
  measures.jacobian.resize(n);
  std::vector<double> volumes(n);
  std::vector<char> is_proven(n);
  parallel_ranges(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HexCorners at = corners_of(mesh.points, mesh.hexahedra[i]);
      measures.jacobian[i] = scaled_jacobian(at);
      volumes[i] = signed_volume(at);
      is_proven[i] = is_positive(at);
    }
  });
  if (n == 0) return measures;
  measures.unproven = static_cast<int>(std::ranges::count(is_proven, 0));
  measures.least_jacobian = *std::min_element(measures.jacobian.begin(), measures.jacobian.end());
  for (std::size_t i = 0; i < n; ++i) {
    measures.mean_jacobian += measures.jacobian[i] / static_cast<double>(n);
    measures.volume += volumes[i];
  }
  return measures;
}

}  // namespace delquad
