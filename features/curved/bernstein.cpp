#include "features/curved/bernstein.h"

#include <Eigen/Dense>
#include <cmath>

namespace delquad {

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
  Bernstein<Vec3> d{f.du - 1, f.dv, {}};
  for (int j = 0; j <= f.dv; ++j)
    for (int i = 0; i < f.du; ++i) d.c.push_back(f.du * (f.at(i + 1, j) - f.at(i, j)));
  return d;
}

Bernstein<Vec3> derivative_v(const Bernstein<Vec3>& f) {
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
  // de Casteljau's scheme at 1/2: its outer coefficients are those of the halves.
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
