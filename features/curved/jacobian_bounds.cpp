// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/jacobian_bounds.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <queue>

#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// Bounds that are so close, as a part of the greater or absolutely, are not made closer.
constexpr double kClosePart = 0.05, kClose = 0.002;
constexpr int kMostBoxes = 400;
/// Rounding of coefficients, as a part of the largest.
constexpr double kRounding = 1e-13;

/// A part of the square.
struct ParameterBox {
  Bernstein<double> jacobian, uu, vv;  ///< numerator, |x_u|^2, |x_v|^2
  int depth = 0;
  double low = -1;  ///< of the scaled Jacobian
};

double least(const Bernstein<double>& f) { return *std::ranges::min_element(f.c); }
double greatest(const Bernstein<double>& f) { return *std::ranges::max_element(f.c); }

double low_of(const ParameterBox& box, double rounding) {
  const double j = least(box.jacobian) - rounding;
  const double above = std::sqrt(std::max(greatest(box.uu), 0.0) * std::max(greatest(box.vv), 0.0));
  if (j > 0) return above > 0 ? std::min(1.0, j / above) : -1;
  const double below = std::sqrt(std::max(least(box.uu), 0.0) * std::max(least(box.vv), 0.0));
  return below > 0 ? std::max(-1.0, j / below) : -1;
}

/// The least at the box's corners.
double found_in(const ParameterBox& box) {
  double found = 1;
  for (const int u : {0, 1})
    for (const int v : {0, 1}) {
      const auto corner = [&](const Bernstein<double>& f) { return f.at(u * f.du, v * f.dv); };
      const double scale = std::sqrt(std::max(corner(box.uu) * corner(box.vv), 0.0));
      found = std::min(found, scale > 0 ? corner(box.jacobian) / scale : 0.0);
    }
  return std::clamp(found, -1.0, 1.0);
}

}  // namespace

Vec3 mean_normal(std::span<const Vec3> nodes, int order) {
  const Bernstein<Vec3> x = bernstein_of(nodes, order);
  Vec3 sum;
  for (const Vec3& c : cross_product(derivative_u(x), derivative_v(x)).c) sum = sum + c;
  const double length = norm(sum);
  return length > 0 ? (1 / length) * sum : Vec3{};
}

JacobianBounds jacobian_bounds(std::span<const Vec3> nodes, int order, double enough) {
  const Bernstein<Vec3> x = bernstein_of(nodes, order);
  const Bernstein<Vec3> xu = derivative_u(x), xv = derivative_v(x);
  const Bernstein<Vec3> normal = cross_product(xu, xv);
  Vec3 sum;
  for (const Vec3& c : normal.c) sum = sum + c;
  const double length = norm(sum);
  if (!(length > 0)) return {-1, -1};
  ParameterBox whole{dot_product(normal, (1 / length) * sum), dot_product(xu, xu), dot_product(xv, xv)};
  double largest = 0;
  for (const Vec3& c : normal.c) largest = std::max(largest, norm(c));
  const double rounding = kRounding * largest;
  whole.low = low_of(whole, rounding);
  JacobianBounds bounds{whole.low, found_in(whole)};
  const auto later = [](const ParameterBox& a, const ParameterBox& b) { return a.low > b.low; };
  std::priority_queue<ParameterBox, std::vector<ParameterBox>, decltype(later)> boxes(later);
  boxes.push(std::move(whole));
  for (int made = 1; made < kMostBoxes; made += 2) {
    bounds.proven = std::min(boxes.top().low, bounds.found);
    const double gap = bounds.found - bounds.proven;
    if (bounds.proven >= enough || gap <= kClose || (bounds.proven > 0 && gap <= kClosePart * bounds.found) ||
        bounds.found <= 0)
      break;
    const ParameterBox box = boxes.top();
    boxes.pop();
    const bool along_u = box.depth % 2 == 0;
    const auto jacobian = halves(box.jacobian, along_u), uu = halves(box.uu, along_u),
               vv = halves(box.vv, along_u);
    for (const int side : {0, 1}) {
      ParameterBox half{jacobian[side], uu[side], vv[side], box.depth + 1};
      half.low = std::max(low_of(half, rounding), box.low);
      bounds.found = std::min(bounds.found, found_in(half));
      boxes.push(std::move(half));
    }
  }
  bounds.proven = std::min(boxes.top().low, bounds.found);
  return bounds;
}

ProvenJacobians proven_jacobians(std::span<const JacobianBounds> bounds) {
  ProvenJacobians all;
  double sum = 0;
  for (const JacobianBounds& b : bounds) {
    all.unproven += !b.positive();
    all.least = std::min(all.least, b.proven);
    sum += b.proven;
  }
  if (!bounds.empty()) all.mean = sum / static_cast<double>(bounds.size());
  return all;
}

JacobianBounds element_bounds(std::span<const Vec3> nodes, int order, double enough) {
  const JacobianBounds all = jacobian_bounds(nodes, order, enough);
  if (order != 2) return all;
  // The eight-node quad is the nine-node one whose middle is there.
  std::vector<Vec3> eight(nodes.begin(), nodes.end());
  eight[4] =
      middle_of_eight({nodes[0], nodes[2], nodes[6], nodes[8]}, {nodes[1], nodes[3], nodes[5], nodes[7]});
  const JacobianBounds without_middle = jacobian_bounds(eight, order, enough);
  return {std::min(all.proven, without_middle.proven), std::min(all.found, without_middle.found)};
}

namespace {

/// The highest degree of products: four factors of an element's degree.
constexpr int kMostDegree = 4 * kMostOrder;

constexpr auto make_binomials() {
  std::array<std::array<double, kMostDegree + 1>, kMostDegree + 1> rows{};
  for (int n = 0; n <= kMostDegree; ++n)
    for (int k = 0; k <= n; ++k) rows[n][k] = k == 0 || k == n ? 1 : rows[n - 1][k - 1] + rows[n - 1][k];
  return rows;
}
constexpr auto kBinomials = make_binomials();

double binomial(int n, int k) { return kBinomials[n][k]; }

/// Takes values at equal distances to Bernstein coefficients, exact to rounding: at most degree 4.
Eigen::MatrixXd coefficients_of_values(int degree) {
  Eigen::MatrixXd values(degree + 1, degree + 1);
  for (int k = 0; k <= degree; ++k)
    for (int i = 0; i <= degree; ++i) {
      const double t = static_cast<double>(k) / degree;
      values(k, i) = binomial(degree, i) * std::pow(t, i) * std::pow(1 - t, degree - i);
    }
  return values.inverse();
}

/// The product's coefficients are means of products of coefficients.
template <class T, class F, class G, class Times>
Bernstein<T> product(const Bernstein<F>& f, const Bernstein<G>& g, const Times& times) {
  const int du = f.du + g.du, dv = f.dv + g.dv;
  assert(du <= kMostDegree && dv <= kMostDegree);
  Bernstein<T> result{du, dv, std::vector<T>(static_cast<std::size_t>(du + 1) * (dv + 1))};
  const auto part = [](int m, int i, int n, int k) {
    return binomial(m, i) * binomial(n, k) / binomial(m + n, i + k);
  };
  for (int j = 0; j <= f.dv; ++j)
    for (int l = 0; l <= g.dv; ++l) {
      const double across = part(f.dv, j, g.dv, l);
      for (int i = 0; i <= f.du; ++i)
        for (int k = 0; k <= g.du; ++k) {
          const double weight = part(f.du, i, g.du, k) * across;
          T& sum = result.c[static_cast<std::size_t>(j + l) * (du + 1) + i + k];
          sum = sum + weight * times(f.at(i, j), g.at(k, l));
        }
    }
  return result;
}

}  // namespace

Bernstein<Vec3> bernstein_of(std::span<const Vec3> nodes, int order) {
  assert(order >= 1 && order <= kMostOrder);
  assert(nodes.size() == static_cast<std::size_t>((order + 1) * (order + 1)));
  static const std::array matrices{coefficients_of_values(1), coefficients_of_values(2),
                                   coefficients_of_values(3), coefficients_of_values(4)};
  const Eigen::MatrixXd& m = matrices[order - 1];
  const int row = order + 1;
  std::vector<Vec3> rows(nodes.size());
  for (int j = 0; j < row; ++j)
    for (int i = 0; i < row; ++i)
      for (int k = 0; k < row; ++k) rows[j * row + i] = rows[j * row + i] + m(i, k) * nodes[j * row + k];
  Bernstein<Vec3> result{order, order, std::vector<Vec3>(nodes.size())};
  for (int j = 0; j < row; ++j)
    for (int i = 0; i < row; ++i)
      for (int k = 0; k < row; ++k)
        result.c[j * row + i] = result.c[j * row + i] + m(j, k) * rows[k * row + i];
  return result;
}

Vec3 value_at(const Bernstein<Vec3>& f, double u, double v) {
  Vec3 sum;
  const auto weight = [](int n, int i, double t) {
    return binomial(n, i) * std::pow(t, i) * std::pow(1 - t, n - i);
  };
  for (int j = 0; j <= f.dv; ++j)
    for (int i = 0; i <= f.du; ++i) sum = sum + weight(f.du, i, u) * weight(f.dv, j, v) * f.at(i, j);
  return sum;
}

Bernstein<Vec3> derivative_u(const Bernstein<Vec3>& f) {
  assert(f.du > 0);
  Bernstein<Vec3> d{f.du - 1, f.dv, {}};
  for (int j = 0; j <= f.dv; ++j)
    for (int i = 0; i < f.du; ++i) d.c.push_back(f.du * (f.at(i + 1, j) - f.at(i, j)));
  return d;
}

Bernstein<Vec3> derivative_v(const Bernstein<Vec3>& f) {
  assert(f.dv > 0);
  Bernstein<Vec3> d{f.du, f.dv - 1, {}};
  for (int j = 0; j < f.dv; ++j)
    for (int i = 0; i <= f.du; ++i) d.c.push_back(f.dv * (f.at(i, j + 1) - f.at(i, j)));
  return d;
}

Bernstein<Vec3> cross_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g) {
  return product<Vec3>(f, g, [](const Vec3& a, const Vec3& b) { return cross(a, b); });
}

Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g) {
  return product<double>(f, g, [](const Vec3& a, const Vec3& b) { return dot(a, b); });
}

Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Vec3& n) {
  Bernstein<double> result{f.du, f.dv, {}};
  for (const Vec3& c : f.c) result.c.push_back(dot(c, n));
  return result;
}

std::array<Bernstein<double>, 2> halves(const Bernstein<double>& f, bool along_u) {
  std::array<Bernstein<double>, 2> both{f, f};
  const int degree = along_u ? f.du : f.dv, others = along_u ? f.dv : f.du;
  const auto index = [&](int i, int other) {
    return static_cast<std::size_t>(along_u ? other * (f.du + 1) + i : i * (f.du + 1) + other);
  };
  // de Casteljau's scheme at 1/2: its outer coefficients are the coefficients of the halves.
  for (int other = 0; other <= others; ++other)
    for (int step = 1; step <= degree; ++step) {
      for (int i = degree; i >= step; --i) {
        double& c = both[0].c[index(i, other)];
        c = (both[0].c[index(i - 1, other)] + c) / 2;
      }
      both[1].c[index(degree - step, other)] = both[0].c[index(degree, other)];
    }
  return both;
}

}  // namespace delquad
