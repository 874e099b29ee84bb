#include "fields/size_aware_cross_field.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "base/cancel.h"
#include "fields/laplace.h"
#include "fields/sample_triangle.h"
#include "fields/sides.h"
#include "fields/singularities.h"
#include "fields/size_connection.h"

namespace delquad {

namespace {

/// Times of diffusion, in elements (pairs of triangles) of the background mesh, from the first step to the
/// last: the singularities find their places first within their neighbourhood, then to an element.
constexpr double kLongest = 1600, kShortest = 2;
constexpr int kSteps = 10;
/// What each triangle gives to each of its sides: a sixth of an element.
constexpr double kMass = 0.5 / 3;
/// Relative residual of each step: its result is brought back to unit length, and only the last step's stays.
constexpr double kTolerance = 1e-4;
/// Of conjugate gradients: ordinary patches take 10 to 150, and as many as this cost about as much as a
/// direct solution.
constexpr int kMostIterations = 500;

using Complex = std::complex<double>;
/// Of real and imaginary parts in turn: products of complex numbers would be checked for overflow one by one.
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

Complex to_complex(Cross z) { return {z.c, z.s}; }
Complex unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
Complex normalised(Complex z, Complex instead) {
  const double length = std::abs(z);
  return length > 0 ? z / length : instead;
}

double twice_area(const TriPatch& tri, const std::array<int, 3>& v) {
  return cross(tri.points[v[1]] - tri.points[v[0]], tri.points[v[2]] - tri.points[v[0]]);
}

/// The start field in the middles of all sides, of unit length; tangents on the boundary.
std::vector<Complex> sample_sides(const BackgroundMesh& background, const Sides& sides,
                                  const CrossField& field) {
  const TriPatch& tri = background.triangles();
  std::vector<Complex> z(sides.count, 0);
  int hint = -1;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    const Corners middle = middles(corners_of(tri, v));
    for (int k = 0; k < 3; ++k) {
      Complex& value = z[sides.of_triangle[t][k]];
      if (tri.neighbours[t][k] < 0) {
        value = to_complex(Cross::along(background.boundary_points()[v[(k + 1) % 3]].tangent));
      } else if (value == 0.0) {
        value = normalised(to_complex(field.at(middle[k], hint)), 1);
      }
    }
  }
  return z;
}

/// The diffusion (mass/tau + stiffness) of crosses that turn as grids of size delta do, their values on the
/// boundary being given; time is counted in elements wherever they are. The stiffness of each triangle is
/// taken between values carried to its centroid, so that it is positive semi-definite whatever its angles.
class CrossDiffusion {
 public:
  CrossDiffusion(const BackgroundMesh& background, const Sides& sides, const SizeConnection& connection,
                 std::vector<Complex>& z)
      : z_(z), row_(sides.count, 0) {
    const TriPatch& tri = background.triangles();
    for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        if (tri.neighbours[t][k] < 0) row_[sides.of_triangle[t][k]] = -1;
      }
    }
    int n = 0;
    for (int& row : row_) row = row < 0 ? -1 : n++;
    mass_.setZero(2 * n);
    fixed_.setZero(2 * n);
    stiffness_.resize(2 * n, 2 * n);
    assemble(tri, sides, connection);
  }

  /// One step of diffusion over `tau` elements, then back to unit length.
  void step(double tau) {
    if (mass_.size() == 0) return;
    const Vector weight = mass_ / tau;
    RowMatrix matrix = stiffness_;
    matrix.diagonal() += weight;
    Vector now(mass_.size());
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (row_[i] < 0) continue;
      now[2 * row_[i]] = z_[i].real();
      now[2 * row_[i] + 1] = z_[i].imag();
    }
    const Vector next = solve(matrix, weight.cwiseProduct(now) + fixed_, now);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (row_[i] >= 0) z_[i] = normalised({next[2 * row_[i]], next[2 * row_[i] + 1]}, z_[i]);
    }
  }

 private:
  /// By conjugate gradients from `start`, or directly where these do not converge: triangles with angles near
  /// 180 degrees, as badly made triangulations have them, can take them as many steps as there are unknowns.
  static Vector solve(const RowMatrix& matrix, const Vector& right, const Vector& start) {
    Eigen::ConjugateGradient<RowMatrix, Eigen::Lower | Eigen::Upper> iterative(matrix);
    iterative.setTolerance(kTolerance);
    iterative.setMaxIterations(kMostIterations);
    const Vector x = iterative.solveWithGuess(right, start);
    if (iterative.info() == Eigen::Success) return x;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> direct(matrix);
    return direct.info() == Eigen::Success ? Vector(direct.solve(right)) : x;
  }

  void assemble(const TriPatch& tri, const Sides& sides, const SizeConnection& connection) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(36 * tri.triangles.size());
    for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
      const LocalStiffness local = local_stiffness(tri, static_cast<int>(t));
      const auto& turns = connection.phase_turns()[t];
      const auto& side = sides.of_triangle[t];
      for (int i = 0; i < 3; ++i) {
        const int r = row_[side[i]];
        if (r < 0) continue;
        mass_[2 * r] += kMass;
        mass_[2 * r + 1] += kMass;
        for (int j = 0; j < 3; ++j) {
          const Complex value = 2 * local[i][j] * unit(turns[i] - turns[j]);
          if (const int c = row_[side[j]]; c >= 0) {
            add_entry(entries, r, c, value);
          } else {
            const Complex given = value * z_[side[j]];
            fixed_[2 * r] -= given.real();
            fixed_[2 * r + 1] -= given.imag();
          }
        }
      }
    }
    stiffness_.setFromTriplets(entries.begin(), entries.end());
  }

  static void add_entry(std::vector<Eigen::Triplet<double>>& entries, int row, int column, Complex value) {
    entries.emplace_back(2 * row, 2 * column, value.real());
    entries.emplace_back(2 * row, 2 * column + 1, -value.imag());
    entries.emplace_back(2 * row + 1, 2 * column, value.imag());
    entries.emplace_back(2 * row + 1, 2 * column + 1, value.real());
  }

  std::vector<Complex>& z_;
  std::vector<int> row_;  ///< of each side; -1: on the boundary
  Vector mass_;
  Vector fixed_;  ///< what the boundary's values contribute
  RowMatrix stiffness_;
};

/// 1/delta, the mean over a triangle.
double mean_per_length(const SizeConnection& connection, const std::array<int, 3>& v) {
  double sum = 0;
  for (const int i : v) sum += std::exp(-connection.log_size(i)) / 3;
  return sum;
}

/// Rows of quads that have to end because delta varies, where the crosses do not turn.
double dislocations_of_size(const TriPatch& tri, const SizeConnection& connection) {
  double sum = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    sum += twice_area(tri, v) / 2 * norm(connection.gradient(static_cast<int>(t))) *
           mean_per_length(connection, v);
  }
  return sum;
}

}  // namespace

struct SizeAwareCrossField::Data {
  std::shared_ptr<const BackgroundMesh> background;
  std::shared_ptr<const CrossField> start;  ///< null where the field is the iteration's
  std::vector<Vec2> gradient;               ///< of log delta in each triangle
  /// Of each triangle, carried from the middle of the side opposite to each vertex to the centroid.
  std::vector<std::array<Complex, 3>> crosses;
};

SizeAwareCrossField::SizeAwareCrossField(std::shared_ptr<const BackgroundMesh> background,
                                         const ParametricSize& size, std::shared_ptr<const CrossField> start)
    : data_(std::make_unique<Data>()) {
  const TriPatch& tri = background->triangles();
  const Sides sides = number_sides(tri);
  const SizeConnection connection(tri, size);
  std::vector<Complex> z = sample_sides(*background, sides, *start);
  if (dislocations_of_size(tri, connection) < 1) {
    data_->start = std::move(start);
  } else {
    CrossDiffusion diffusion(*background, sides, connection, z);
    for (int i = 0; i < kSteps; ++i) {
      check_cancelled();
      diffusion.step(kLongest * std::pow(kShortest / kLongest, i / (kSteps - 1.0)));
    }
  }
  std::vector<Cross> crosses;
  crosses.reserve(z.size());
  for (const Complex value : z) crosses.push_back({value.real(), value.imag()});
  topology_ = find_singularities(*background, sides, crosses, connection.phase_turns());
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    data_->gradient.push_back(connection.gradient(static_cast<int>(t)));
    auto& local = data_->crosses.emplace_back();
    for (int k = 0; k < 3; ++k) local[k] = z[sides.of_triangle[t][k]] * unit(-connection.phase_turns()[t][k]);
  }
  data_->background = std::move(background);
}

SizeAwareCrossField::~SizeAwareCrossField() = default;

Cross SizeAwareCrossField::at(Vec2 u, int& hint) const {
  if (data_->start) return data_->start->at(u, hint);
  const auto [t, b] = data_->background->locate(u, hint);
  const Corners x = corners_of(data_->background->triangles(), data_->background->triangles().triangles[t]);
  Complex sum = 0;
  for (int k = 0; k < 3; ++k) sum += (1 - 2 * b[k]) * data_->crosses[t][k];
  const Vec2 inside = b[0] * x[0] + b[1] * x[1] + b[2] * x[2];
  sum *= unit(4 * cross(data_->gradient[t], inside - (1.0 / 3) * (x[0] + x[1] + x[2])));
  return {sum.real(), sum.imag()};
}

namespace {

/// Slope of the angle by which a field turns more than a parallel one in triangle t, in the frame of the
/// field there (radians per length).
Vec2 excess_turn(const Corners& middle, const std::array<double, 3>& turns, const CrossField& field,
                 int& hint) {
  std::array<double, 3> angle;
  Complex first, mean = 0;
  for (int k = 0; k < 3; ++k) {
    const Complex z = normalised(to_complex(field.at(middle[k], hint)), 1) * unit(-turns[k]);
    if (k == 0) first = z;
    angle[k] = std::arg(z * std::conj(first)) / 4;
    mean += z;
  }
  const Vec2 excess = slope(middle, angle);
  const Complex axis = unit(std::arg(mean) / 4);
  const Vec2 along = {axis.real(), axis.imag()};
  return {dot(excess, along), cross(along, excess)};
}

}  // namespace

double expected_dislocations(const BackgroundMesh& background, const CrossField& field,
                             const ParametricSize& size) {
  const TriPatch& tri = background.triangles();
  const SizeConnection connection(tri, size);
  double sum = 0;
  int hint = -1;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    const Corners middle = middles(corners_of(tri, v));
    const Vec2 excess = excess_turn(middle, connection.phase_turns()[t], field, hint);
    sum +=
        twice_area(tri, v) / 2 * (std::abs(excess.x) + std::abs(excess.y)) * mean_per_length(connection, v);
  }
  return sum;
}

}  // namespace delquad
