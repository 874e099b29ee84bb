// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/solve/solve.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>

#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/shape.h"
#include "metrics/solve/discretisation.h"

namespace delquad {

namespace {

/// Frame of a domain, equal for all meshes of a planar boundary up to rounding.
struct Frame {
  Vec3 centre;
  double radius = 0;  ///< radius of gyration
};

Frame frame_of(const Discretisation& elements) {
  double area = 0, second = 0;
  Vec3 first;
  elements.for_each_point(3, [&](const auto&, const ElementPoint& p) {
    area += p.weight;
    first = first + p.weight * p.at;
  });
  const Vec3 centre = (1 / area) * first;
  elements.for_each_point(
      3, [&](const auto&, const ElementPoint& p) { second += p.weight * dot(p.at - centre, p.at - centre); });
  return {centre, std::sqrt(second / area)};
}

/// Sine and cosine of pi / 2 times the squared distance p . p, with derivatives by it.
struct Waves {
  double sine, cosine, by_sine, by_cosine;
  explicit Waves(double distance2) {
    constexpr double kRate = std::numbers::pi / 2;
    sine = std::sin(kRate * distance2);
    cosine = std::cos(kRate * distance2);
    by_sine = kRate * cosine;
    by_cosine = -kRate * sine;
  }
};

ScalarSolution planar_wave(const Frame& frame, const Vec3& at) {
  const Vec3 p = (1 / frame.radius) * (at - frame.centre);
  const Waves waves(dot(p, p));
  return {waves.sine, (2 * waves.by_sine / frame.radius) * p};
}

/// The phases keep planes of symmetry from being zeros.
ScalarSolution spatial_wave(const Frame& frame, const Vec3& at) {
  const Vec3 p = (1 / frame.radius) * (at - frame.centre);
  const double x = 2 * p.x + 0.5, y = 2 * p.y + 1, z = 2 * p.z + 1.5;
  const double a = std::sin(x), b = std::sin(y), c = std::sin(z);
  const Vec3 by = {std::cos(x) * b * c, a * std::cos(y) * c, a * b * std::cos(z)};
  return {a * b * c, (2 / frame.radius) * by};
}

/// Returns (sine p + cosine q), q being p turned by 90 degrees, in units of the radius.
VectorSolution swirl(const Frame& frame, const Vec3& at) {
  const Vec3 p = (1 / frame.radius) * (at - frame.centre), q = {-p.y, p.x, 0};
  const Waves waves(dot(p, p));
  const double f = waves.sine, g = waves.cosine;
  const Vec3 slope_x = (2 * (waves.by_sine * p.x + waves.by_cosine * q.x)) * p;
  const Vec3 slope_y = (2 * (waves.by_sine * p.y + waves.by_cosine * q.y)) * p;
  return {{frame.radius * (f * p.x + g * q.x), frame.radius * (f * p.y + g * q.y)},
          {slope_x + Vec3{f, -g, 0}, slope_y + Vec3{g, f, 0}}};
}

template <std::size_t C>
struct Field {
  std::array<double, C> value;
  std::array<Vec3, C> gradient;
};
template <std::size_t C>
using Exact = std::function<Field<C>(const Vec3&)>;
/// The equation: maps the gradients of a field to the fluxes of its components.
template <std::size_t C>
using Flux = std::array<Vec3, C> (*)(const std::array<Vec3, C>&);

std::array<Vec3, 1> heat_flux(const std::array<Vec3, 1>& gradient) { return gradient; }

/// Returns plane stress [hughes2000, section 2.7].
std::array<Vec3, 2> stress(const std::array<Vec3, 2>& gradient) {
  constexpr double kYoung = 1, kPoisson = 0.3, kPlate = kYoung / (1 - kPoisson * kPoisson);
  const double xx = gradient[0].x, yy = gradient[1].y;
  const double shear = kYoung / (2 * (1 + kPoisson)) * (gradient[0].y + gradient[1].x);
  return {{{kPlate * (xx + kPoisson * yy), shear, 0}, {shear, kPlate * (yy + kPoisson * xx), 0}}};
}

/// A discretized problem with C unknowns for each node.
template <std::size_t C>
class Problem {
 public:
  /// Takes n x n Gauss points for the right side, and one more for means and errors.
  Problem(const Discretisation& elements, const Exact<C>& exact, Flux<C> flux, int gauss_points)
      : elements_(elements),
        exact_(exact),
        flux_(flux),
        gauss_points_(gauss_points),
        given_(elements.n_nodes() * C) {
    for (std::size_t i = 0; i < elements.n_nodes(); ++i) {
      if (!elements.is_fixed(i)) continue;
      const Field<C> u = exact(elements.point(i));
      for (std::size_t c = 0; c < C; ++c) given_[C * i + c] = u.value[c];
    }
    assemble();
  }

  /// Returns values by node and component.
  std::vector<double> values() const {
    const Eigen::VectorXd free = solve_directly(system_);
    std::vector<double> values = given_;
    for (std::size_t i = 0; i < elements_.n_nodes(); ++i)
      for (std::size_t c = 0; c < C; ++c)
        if (const int row = row_of(i, c); row >= 0) values[C * i + c] = free[row];
    shift_floating(values);
    return values;
  }

  SolverErrors solve() const {
    SolverErrors result = errors(values());
    result.condition = condition_number(system_);
    result.cg_iterations = cg_iterations(system_);
    return result;
  }

 private:
  using Triplets = std::vector<Eigen::Triplet<double>>;

  /// Returns -1 if the value is given.
  int row_of(std::size_t node, std::size_t component) const {
    const int row = elements_.row(node);
    return row < 0 ? -1 : static_cast<int>(C) * row + static_cast<int>(component);
  }

  void assemble() {
    const auto n = static_cast<Eigen::Index>(C * elements_.n_free());
    system_.matrix.resize(n, n);
    system_.right = Eigen::VectorXd::Zero(n);
    Triplets entries;
    const auto for_rows = [&](const std::array<int, 4>& nodes, const auto& visit) {
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t a = 0; a < C; ++a)
          if (const int row = row_of(static_cast<std::size_t>(nodes[i]), a); row >= 0) visit(i, a, row);
    };
    elements_.for_each_point(2, [&](const std::array<int, 4>& nodes, const ElementPoint& p) {
      for_rows(nodes, [&](std::size_t i, std::size_t a, int row) { add_row(nodes, p, i, a, row, entries); });
    });
    elements_.for_each_point(gauss_points_, [&](const std::array<int, 4>& nodes, const ElementPoint& p) {
      const std::array<Vec3, C> load = flux_(exact_(p.at).gradient);
      for_rows(nodes, [&](std::size_t i, std::size_t a, int row) {
        system_.right[row] += p.weight * dot(load[a], p.gradient[i]);
      });
    });
    system_.matrix.setFromTriplets(entries.begin(), entries.end());
    set_scale();
    if constexpr (C == 1)  // planar domains, on which the others are solved, have a boundary
      system_.floating = elements_.floating();
  }

  /// Sets Jacobi's scaling, equal for all components of a node, so it does not depend on the axes.
  void set_scale() {
    const Eigen::VectorXd diagonal = system_.matrix.diagonal();
    system_.scale.resize(diagonal.size());
    constexpr auto kWidth = static_cast<Eigen::Index>(C);
    for (Eigen::Index i = 0; i < diagonal.size(); i += kWidth)
      system_.scale.segment(i, kWidth).setConstant(diagonal.segment(i, kWidth).mean());
  }

  /// Adds a quadrature point's share of a test function.
  void add_row(const std::array<int, 4>& nodes, const ElementPoint& p, std::size_t i, std::size_t a, int row,
               Triplets& entries) {
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t b = 0; b < C; ++b) {
        std::array<Vec3, C> gradient = {};
        gradient[b] = p.gradient[j];
        const double entry = p.weight * dot(flux_(gradient)[a], p.gradient[i]);
        const auto node = static_cast<std::size_t>(nodes[j]);
        if (const int column = row_of(node, b); column >= 0)
          entries.emplace_back(row, column, entry);
        else
          system_.right[row] -= entry * given_[C * node + b];
      }
  }

  /// Returns u_h and its gradient at a quadrature point.
  Field<C> field_at(const std::vector<double>& values, const std::array<int, 4>& nodes,
                    const ElementPoint& p) const {
    Field<C> field = {};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t c = 0; c < C; ++c) {
        const double v = values[C * static_cast<std::size_t>(nodes[i]) + c];
        field.value[c] += v * p.value[i];
        field.gradient[c] = field.gradient[c] + v * p.gradient[i];
      }
    return field;
  }

  /// Gives u_h the mean of u on every part that is known up to a constant.
  void shift_floating(std::vector<double>& values) const {
    const std::size_t n = elements_.floating().size();
    std::vector<double> area(n), excess(n);
    elements_.for_each_point(gauss_points_ + 1, [&](const std::array<int, 4>& nodes, const ElementPoint& p) {
      const int part = elements_.floating_part(static_cast<std::size_t>(nodes[0]));
      if (part < 0) return;
      area[static_cast<std::size_t>(part)] += p.weight;
      excess[static_cast<std::size_t>(part)] +=
          p.weight * (field_at(values, nodes, p).value[0] - exact_(p.at).value[0]);
    });
    for (std::size_t i = 0; i < elements_.n_nodes(); ++i)
      if (const int part = elements_.floating_part(i); part >= 0)
        values[C * i] -= excess[static_cast<std::size_t>(part)] / area[static_cast<std::size_t>(part)];
  }

  SolverErrors errors(const std::vector<double>& values) const {
    double off = 0, whole = 0, steep_off = 0, steep = 0;
    elements_.for_each_point(gauss_points_ + 1, [&](const std::array<int, 4>& nodes, const ElementPoint& p) {
      const Field<C> ours = field_at(values, nodes, p), u = exact_(p.at);
      for (std::size_t c = 0; c < C; ++c) {
        const double d = u.value[c] - ours.value[c];
        const Vec3 tangent = u.gradient[c] - dot(u.gradient[c], p.normal) * p.normal;
        const Vec3 g = tangent - ours.gradient[c];
        off += p.weight * d * d;
        whole += p.weight * u.value[c] * u.value[c];
        steep_off += p.weight * dot(g, g);
        steep += p.weight * dot(tangent, tangent);
      }
    });
    if (!(whole > 0 && steep > 0)) throw InputError("the solution or its gradient is zero on the mesh");
    return {std::sqrt(off / whole), std::sqrt(steep_off / steep)};
  }

  const Discretisation& elements_;
  const Exact<C>& exact_;
  Flux<C> flux_;
  int gauss_points_;
  std::vector<double> given_;  ///< by node and component
  LinearSystem system_;
};

constexpr int kGaussPoints = 2;

Exact<1> as_field(const Solution& u) {
  return [&u](const Vec3& at) {
    const ScalarSolution s = u(at);
    return Field<1>{{s.value}, {s.gradient}};
  };
}

SolverErrors poisson_on(const Discretisation& elements, const Solution& u, int gauss_points = kGaussPoints) {
  const Exact<1> exact = as_field(u);
  return Problem<1>(elements, exact, heat_flux, gauss_points).solve();
}

SolverErrors elasticity_on(const Discretisation& elements,
                           const std::function<VectorSolution(const Vec3&)>& u) {
  if (!elements.is_planar())
    throw InputError("elasticity needs a planar mesh: expected the same z at all points");
  const Exact<2> exact = [&](const Vec3& at) {
    const VectorSolution s = u(at);
    return Field<2>{s.value, s.gradient};
  };
  return Problem<2>(elements, exact, stress, kGaussPoints).solve();
}

}  // namespace

SolverErrors solve_poisson(const Mesh& mesh, const Solution& exact, int gauss_points) {
  return poisson_on(Discretisation(mesh), exact, gauss_points);
}

std::vector<double> poisson_solution(const Mesh& mesh, const Solution& u, int gauss_points) {
  const Discretisation elements(mesh);
  const Exact<1> exact = as_field(u);
  return Problem<1>(elements, exact, heat_flux, gauss_points).values();
}

SolverErrors solve_poisson(const Mesh& mesh) {
  const Discretisation elements(mesh);
  const Frame frame = frame_of(elements);
  const auto wave = elements.is_planar() ? planar_wave : spatial_wave;
  return poisson_on(elements, [&](const Vec3& at) { return wave(frame, at); });
}

SolverErrors solve_elasticity(const Mesh& mesh, const std::function<VectorSolution(const Vec3&)>& exact) {
  return elasticity_on(Discretisation(mesh), exact);
}

SolverErrors solve_elasticity(const Mesh& mesh) {
  const Discretisation elements(mesh);
  const Frame frame = frame_of(elements);
  return elasticity_on(elements, [&](const Vec3& at) { return swirl(frame, at); });
}

namespace {

using StepVector = Eigen::VectorXd;

/// Stiffness of an element between its nodes; triangles repeat the third one.
struct StiffElement {
  std::array<int, 4> nodes;
  std::array<std::array<double, 4>, 4> stiffness{};
};

/// Returns the corners projected to the plane through their middle, parallel to both diagonals.
std::array<Vec3, 4> flattened(std::array<Vec3, 4> p) {
  const Vec3 normal = area_vector(p), middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  const double n2 = dot(normal, normal);
  if (n2 > 0)
    for (Vec3& x : p) x = x - (dot(x - middle, normal) / n2) * normal;
  return p;
}

/// Adds an element's stiffness, and its mass to its nodes. Returns false if it is inverted at a point.
bool add_element(const std::array<Vec3, 4>& corners, const std::vector<GaussPoint>& rule,
                 StiffElement& element, StepVector& mass) {
  const std::array<Vec3, 4> flat = flattened(corners);
  const Vec3 normal = area_vector(flat);
  for (const ElementPoint& p : element_points(flat, rule)) {
    if (!(p.weight > 0) || !(dot(p.normal, normal) > 0)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      mass[element.nodes[i]] += p.weight * p.value[i];
      for (std::size_t j = 0; j < 4; ++j)
        element.stiffness[i][j] += p.weight * dot(p.gradient[i], p.gradient[j]);
    }
  }
  return true;
}

}  // namespace

double critical_step(const Mesh& mesh) {
  const auto n = static_cast<Eigen::Index>(mesh.points.size());
  StepVector mass = StepVector::Zero(n);
  std::vector<StiffElement> elements;
  bool is_sound = true;
  const std::vector<GaussPoint> rule = gauss_rule(2);
  for_each_element(mesh, [&](int, const auto& v) {
    const std::array<int, 4> nodes = {v[0], v[1], v[2], v.back()};
    elements.push_back({nodes});
    is_sound &= add_element(corners_of(mesh, nodes), rule, elements.back(), mass);
  });
  if (!is_sound) return 0;
  const StepVector scale =
      mass.unaryExpr([](double m) { return m > 0 ? 1 / std::sqrt(m) : 0.0; });  // 0: without element
  const auto apply = [&](const StepVector& x) -> StepVector {
    const StepVector scaled = scale.cwiseProduct(x);
    StepVector y = StepVector::Zero(n);
    for (const auto& [v, stiffness] : elements)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) y[v[i]] += stiffness[i][j] * scaled[v[j]];
    return scale.cwiseProduct(y);
  };
  try {
    return 2 / std::sqrt(largest_eigenvalue(n, apply));
  } catch (const InputError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace delquad
