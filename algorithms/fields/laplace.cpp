// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/laplace.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cassert>
#include <optional>

#include "delquad/error.h"

namespace delquad {
namespace {

// Twice the least area of a triangle, over its longest side squared. Slivers below it have no reliable area
// in floating point. The matrix stays positive definite whatever the areas.
constexpr double kLeastArea = 1e-12;
// Parts of an equilateral triangle that are mixed into each triangle, one after the other, if coinciding
// points make the matrix singular.
constexpr std::array<double, 5> kEquilateralParts = {0, 1e-12, 1e-9, 1e-6, 1e-3};

LocalStiffness stiffness(const TriPatch& tri, int t, double equilateral_part) {
  const auto& v = tri.triangles[t];
  Vec2 side[3];
  double longest2 = 0;
  for (int k = 0; k < 3; ++k) {
    side[k] = tri.points[v[(k + 2) % 3]] - tri.points[v[(k + 1) % 3]];
    longest2 = std::max(longest2, dot(side[k], side[k]));
  }
  const double area = std::max(cross(side[0], side[1]), kLeastArea * longest2);
  LocalStiffness matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix[i][j] = dot(side[i], side[j]) / area;
  }
  if (equilateral_part == 0) return matrix;
  double most = 1;
  for (int i = 0; i < 3; ++i) most = std::max(most, matrix[i][i]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!(longest2 > 0)) matrix[i][j] = 0;
      matrix[i][j] += equilateral_part * most * (i == j ? 1 : -0.5);
    }
  }
  return matrix;
}

/// Factors of the matrix between free unknowns; `right` is the right side from fixed values.
class Factors {
 public:
  Factors(const TriPatch& tri, const std::vector<std::array<int, 3>>& dofs, const std::vector<int>& row,
          int n, std::span<const std::vector<double>> columns, double equilateral_part)
      : right_(Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(columns.size()))) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(6 * tri.triangles.size());
    for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
      const LocalStiffness local = stiffness(tri, static_cast<int>(t), equilateral_part);
      for (int i = 0; i < 3; ++i) {
        const int r = row[dofs[t][i]];
        if (r < 0) continue;
        for (int j = 0; j < 3; ++j) {
          const int c = row[dofs[t][j]];
          if (c >= 0 && c <= r) entries.emplace_back(r, c, local[i][j]);
          for (std::size_t k = 0; c < 0 && k < columns.size(); ++k)
            right_(r, static_cast<Eigen::Index>(k)) -= local[i][j] * columns[k][dofs[t][j]];
        }
      }
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factors_.compute(matrix);
  }

  /// Returns the solution; nothing if rounding made the matrix singular.
  std::optional<Eigen::MatrixXd> solution() const {
    if (factors_.info() != Eigen::Success) return std::nullopt;
    Eigen::MatrixXd x = factors_.solve(right_);
    if (!x.allFinite()) return std::nullopt;
    return x;
  }

 private:
  Eigen::MatrixXd right_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace

LocalStiffness local_stiffness(const TriPatch& tri, int t) { return stiffness(tri, t, 0); }

void solve_laplace(const TriPatch& tri, const std::vector<std::array<int, 3>>& dofs,
                   const std::vector<char>& fixed, std::span<std::vector<double>> columns) {
  assert(dofs.size() == tri.triangles.size());
  assert(std::ranges::all_of(columns, [&](const auto& column) { return column.size() == fixed.size(); }));
  std::vector<int> row(fixed.size(), -1);
  int n = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i]) row[i] = n++;
  }
  if (n == 0) return;

  std::optional<Eigen::MatrixXd> solution;
  for (const double part : kEquilateralParts) {
    solution = Factors(tri, dofs, row, n, columns, part).solution();
    if (solution) break;
  }
  if (!solution) throw Error("the background mesh's Laplace matrix is singular");
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (row[i] < 0) continue;
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns[k][i] = (*solution)(row[i], static_cast<Eigen::Index>(k));
  }
}

Sides number_sides(const TriPatch& tri) {
  Sides sides{std::vector<std::array<int, 3>>(tri.triangles.size()), 0};
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int other = tri.neighbours[t][k];
      if (other < 0 || other > t) {
        sides.of_triangle[t][k] = sides.count++;
        continue;
      }
      const auto& back = tri.neighbours[other];
      const int j = back[0] == t ? 0 : back[1] == t ? 1 : 2;
      sides.of_triangle[t][k] = sides.of_triangle[other][j];
    }
  }
  return sides;
}

}  // namespace delquad
