// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/mesher.h"

// This header leads from a solution to the next mesh: derivatives, errors, a metric, and transfer of values.
// Solvers use it for planar meshes of triangles and quads. All functions throw InputError, with the place,
// for other meshes, and for values that are not finite or not one per point.

namespace delquad {

/// Derivatives at the points of a mesh. A point between regions stands once for each of them, as a solution
/// has kinks there.
struct Recovery {
  Mesh mesh;                ///< the given mesh with these points repeated; the repetitions come last
  std::vector<int> origin;  ///< index in the given mesh of each point
  std::vector<double> values;
  std::vector<Vec2> gradient;
  std::vector<Tensor2> hessian;  ///< second derivatives
};

/// Returns the derivatives of a polynomial of degree order + 2 that fits the values best around each point
/// [zhang2005]. It fits two rings of elements, or more if needed, scaled to the principal axes of their
/// points. No ring crosses from one region to another. A region with too few points gets a lower degree, and
/// linear fits across single rows. Points without elements get 0.
Recovery recover(const Mesh& mesh, std::span<const double> values);

struct ErrorEstimate {
  double whole = 0;
  std::vector<double> of_elements;  ///< triangles, then quads; their p-norm is the whole
};

/// Estimates the error of linear (triangles) and bilinear (quads) interpolation in the Lp norm, in the unit
/// of the field. Each element counts as a quadratic with the mean Hessian of its nodes. Throws InputError
/// unless 1 <= p <= infinity.
ErrorEstimate interpolation_error(const Recovery& solution, double p);

/// Estimates the error of the gradient: the L2 norm of recovered gradient minus element gradient
/// [zienkiewicz1992].
ErrorEstimate gradient_error(const Recovery& solution);

/// Values at the points of a mesh.
struct NodalField {
  std::string name;
  std::vector<double> values;
};

/// Goals of the next mesh. Weights are for example an adjoint solution.
struct AdaptSpec {
  double quads = 0;  ///< wanted number of quads, above 0, or else
  double error = 0;  ///< wanted Lp error of interpolation of the worst field, above 0
  double norm = 2;   ///< p, from 1 to infinity
  MetricLimits limits = {};
  double gradation = 1.5;           ///< as in MetricSpec
  bool isotropic = false;           ///< square quads, by the larger second derivative
  std::vector<double> weight = {};  ///< at least 0, one above 0, at each point; empty: 1
  std::string quality = kDefaultQuality;
};

/// The next mesh and its errors.
struct Adapted {
  MeshResult result;
  /// The estimated errors of a field: interpolation (Lp) and gradient (L2) now, and interpolation on the new
  /// mesh by the same Hessians.
  struct Error {
    double now = 0, gradient = 0, after = 0;
  };
  std::vector<Error> errors;
};

/// Returns the metric at the points of the mesh [loseille2011]; its complexity is about spec.quads. Several
/// solutions get the intersection of their metrics, each with this complexity. Also throws InputError for a
/// spec out of range, without solutions, and if no field bends.
std::vector<Tensor2> adapted_metric(const Mesh& mesh, const std::vector<Recovery>& solutions,
                                    const AdaptSpec& spec);

/// Meshes `problem` for the fields at the points of the mesh. A null problem stands for the domain of the
/// mesh, with its curves, regions and names. Its curves are chains of sides on the outline, between regions
/// and of lines, from corner to corner (docs/adaptation.md). Constant fields do not count, and one must vary.
/// The size, metric and seed of the problem do not count. Also throws as adapted_metric() and mesh().
Adapted adapt(const Mesh& mesh, const std::vector<NodalField>& fields, const AdaptSpec& spec,
              const MeshProblem* problem = nullptr, const Context& context = {});

/// Ways to transfer values to another mesh.
enum class Transfer {
  kInterpolated,  ///< the interpolant of the elements; outside the value at the nearest point
  kConservative,  ///< keeps the integral: L2 projection over the overlaps of elements [farrell2011]
  kBounded,  ///< conservative, and within the extremes of the elements that overlap the elements of a point
};

/// Returns the values at points of `to` from the values at points of `from`.
std::vector<double> transfer_points(const Mesh& from, std::span<const double> values, const Mesh& to,
                                    Transfer how = Transfer::kInterpolated);
/// Returns the values of elements of `to` from the values of elements of `from`; triangles come first, then
/// quads.
std::vector<double> transfer_elements(const Mesh& from, std::span<const double> values, const Mesh& to,
                                      Transfer how = Transfer::kInterpolated);

}  // namespace delquad
