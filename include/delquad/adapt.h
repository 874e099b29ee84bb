#pragma once

#include <span>
#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/mesher.h"

// From a solution to the next mesh: derivatives, estimates of its error, a metric, and the way of values to
// that mesh. Of planar meshes of triangles and quads; all throw InputError for others, and for values that
// are not finite or not as many as there are points.

namespace delquad {

/// Derivatives at the points of a mesh. Points between regions stand once for each of them: there a solution
/// has kinks.
struct Recovery {
  Mesh mesh;                ///< as it was given, those points more than once; the further ones come last
  std::vector<int> origin;  ///< of each point, in the mesh that was given
  std::vector<double> values;
  std::vector<Vec2> gradient;
  std::vector<Tensor2> hessian;  ///< second derivatives
};

/// The polynomial of degree order + 2 that fits the values best on two rings of elements around each point,
/// or more where these do not determine it, scaled to the principal axes of their points [zhang2005]. No ring
/// crosses from one region to another. Where a region has too few points for a degree, it becomes less, and
/// linear across single rows of elements; points without elements have 0.
Recovery recover(const Mesh& mesh, std::span<const double> values);

struct ErrorEstimate {
  double whole = 0;
  std::vector<double> of_elements;  ///< triangles, then quads; their p-norm is the whole
};

/// The error of linear (triangles) and bilinear (quads) interpolation in the Lp norm, 1 <= p <= infinity, as
/// that of a quadratic function with the mean Hessian of the element's corners.
ErrorEstimate interpolation_error(const Recovery& solution, double p);

/// The L2 norm of the recovered gradient less that of the elements [zienkiewicz1992].
ErrorEstimate gradient_error(const Recovery& solution);

/// Values at the points of a mesh.
struct NodalField {
  std::string name;
  std::vector<double> values;
};

/// What the next mesh is to be.
struct AdaptSpec {
  double quads = 0;  ///< about so many; or else
  double error = 0;  ///< so much of the Lp error of interpolation, of the field that has most
  double norm = 2;   ///< p, from 1 to infinity
  MetricLimits limits = {};
  double gradation = 1.5;           ///< as in MetricSpec
  bool isotropic = false;           ///< squares, by the larger second derivative
  std::vector<double> weight = {};  ///< at least 0 at each point, such as an adjoint solution; none: 1
  std::string quality = kDefaultQuality;
};

/// The next mesh.
struct Adapted {
  MeshResult result;
  /// Of each field: the Lp error of interpolation and the L2 error of the gradient as they are estimated,
  /// and the former on the new mesh by the same Hessians.
  struct Error {
    double now = 0, gradient = 0, after = 0;
  };
  std::vector<Error> errors;
};

/// The metric for solutions at the points of their mesh, at all of which it has a complexity of about
/// spec.quads. Of several the intersection, each having so many quads.
std::vector<Tensor2> adapted_metric(const Mesh& mesh, const std::vector<Recovery>& solutions,
                                    const AdaptSpec& spec);

/// Meshes `problem`, or, where it is null, what the mesh bounds, with its curves, regions and names, for the
/// fields at its points. Curves of a mesh are chains of sides on its outline, between regions and of lines,
/// from corner to corner (see docs/adaptation.md): straight, or smooth through their nodes. Fields that are
/// constant do not count, one must not be. The problem's own size, metric and seed do not count. Throws also
/// what mesh() throws.
Adapted adapt(const Mesh& mesh, const std::vector<NodalField>& fields, const AdaptSpec& spec,
              const MeshProblem* problem = nullptr, const Context& context = {});

/// How values come to another mesh.
enum class Transfer {
  kInterpolated,  ///< as the elements have them; outside as at the nearest point
  kConservative,  ///< their integral stays: the L2 projection over the overlaps of elements [farrell2011]
  kBounded,       ///< so, and within the extremes of the elements that overlap those of a point
};

/// Values at points, to points.
std::vector<double> transfer_points(const Mesh& from, std::span<const double> values, const Mesh& to,
                                    Transfer how = Transfer::kInterpolated);
/// Values of elements (triangles, then quads), to elements.
std::vector<double> transfer_elements(const Mesh& from, std::span<const double> values, const Mesh& to,
                                      Transfer how = Transfer::kInterpolated);

}  // namespace delquad
