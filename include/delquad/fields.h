// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// This header has the wanted sizes and directions of quads. Problems hold them, and stages ask them.

namespace delquad {

/// The wanted edge length delta at a point of space: a physical length, finite and above 0.
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// Returns delta at x. `hint` remembers the place of the last point: start with -1 and pass it on between
  /// nearby points. It never changes the value. Throws InputError, naming the point, if delta is not finite
  /// and positive. Several threads may call it.
  virtual double at(const Vec3& x, int& hint) const = 0;
};

/// Limits of quads that stages keep if they can. The defaults are usual for engineers (criteria "batch").
struct QuadLimits {
  double shortest = 0.33, longest = 1.75;  ///< sides over the wanted size
  double aspect = 5;                       ///< longest over shortest side
  double eta = 4.0 / 9;                    ///< corners from 40 to 140 degrees
  /// Walls of sides that vertices keep while they move, so that quads stay within the limits.
  double short_wall() const { return 0.4 / 0.33 * shortest; }
  double long_wall() const { return 1.65 / 1.75 * longest; }
};

/// The wanted edge length delta' in the parameter plane of a patch. Several threads may call it.
class ParametricSize {
 public:
  virtual ~ParametricSize() = default;
  virtual double at(Vec2 u, int& hint) const = 0;
  QuadLimits limits = {};
};

/// delta' of a planar patch; its parameter plane is the plane z = constant.
class PlanarSize final : public ParametricSize {
 public:
  explicit PlanarSize(std::shared_ptr<const SizeField> size, double z = 0) : size_(std::move(size)), z_(z) {}
  double at(Vec2 u, int& hint) const override { return size_->at({u.x, u.y, z_}, hint); }

 private:
  std::shared_ptr<const SizeField> size_;
  double z_;
};

/// Makes a constant size. Throws InputError unless it is finite and positive.
std::unique_ptr<SizeField> make_constant_size(double delta);

/// Makes delta from a function, which several threads may call. Messages call it by `name`. at() throws
/// InputError, with the place, if it is not finite and positive.
std::unique_ptr<SizeField> make_function_size(std::function<double(const Vec3&)> delta, std::string name);

/// Makes delta from a formula in x, y, z with + - * / ^ (power), comparisons, && || ?:, pi and e. Functions
/// are sin, sqrt, exp, abs, min, max, atan2 and others. Throws InputError with the position of a syntax
/// error; at() as for make_function_size().
std::unique_ptr<SizeField> make_expression_size(const std::string& formula);

/// Makes delta from the values at the points of an MSH or VTU file (also .gz), as make_nodal_size(). `field`
/// may be empty for the only one. Throws InputError for unreadable files, for a missing field, and as
/// make_nodal_size().
std::unique_ptr<SizeField> make_file_size(const std::filesystem::path& file, const std::string& field = {});

/// Function that writes delta of each point of a batch. The thread that calls mesh() calls it for thousands
/// of points at once, before anything is meshed. Between these samples delta is interpolated (sample_size()).
using SizeFunction = std::function<void(std::span<const Vec3> points, std::span<double> delta)>;

/// Makes delta that is linear between the points of a mesh of triangles or quads (quads are split). Outside,
/// delta is the value at the nearest point of the mesh. Throws InputError, with the place, unless each point
/// has one finite, positive value.
std::unique_ptr<SizeField> make_nodal_size(const Mesh& mesh, std::vector<double> delta);

/// A point (a == b) or segment as source of sizes [paper, section 8.2]. The size is size_near within
/// radius_near and size_far beyond radius_far, and linear in the distance between. Sizes are above 0, and 0
/// <= radius_near <= radius_far.
struct SizeSource {
  Vec3 a, b;
  double size_near, size_far, radius_near, radius_far;
};

/// Sizes at all curves, points, regions and faces of a name.
struct NamedSize {
  std::string name;
  /// The largest size up to `reach` from them, and everywhere inside regions; 0: only `curvature` counts.
  double size = 0;
  double reach = 0;
  double growth = kNamedGrowth;  ///< growth of sizes from there on, per unit length; above 0
  /// Elements per full turn of faces and curves of this name, at least kLeastPerTurn; 0: SizeSpec::curvature.
  double curvature = 0;
  std::string where = {};  ///< origin of the request, for messages
  static constexpr double kNamedGrowth = 0.3;
};

/// A cross: four directions theta + k pi/2, stored as exp(4 i theta), not always of unit length [paper,
/// section 3].
struct Cross {
  double c = 1;  ///< cos 4 theta
  double s = 0;  ///< sin 4 theta
  static Cross from_angle(double theta) { return {std::cos(4 * theta), std::sin(4 * theta)}; }
  /// Returns the cross along d, which must not be zero. An axis or diagonal gives no rounding error.
  static Cross along(Vec2 d) {
    const double n = std::hypot(d.x, d.y);
    const Vec2 e = {d.x / n, d.y / n};
    const Vec2 squared = {e.x * e.x - e.y * e.y, 2 * e.x * e.y};
    return {squared.x * squared.x - squared.y * squared.y, 2 * squared.x * squared.y};
  }
  /// Returns theta in (-pi/4, pi/4], radians.
  double angle() const { return std::atan2(s, c) / 4; }
};

inline Cross operator+(Cross a, Cross b) { return {a.c + b.c, a.s + b.s}; }

/// The wanted directions of edges in the parameter plane of a patch.
class CrossField {
 public:
  virtual ~CrossField() = default;
  /// `hint` is as in SizeField::at.
  virtual Cross at(Vec2 u, int& hint) const = 0;
};

/// Makes crosses from a function for theta (radians), which several threads may call. Messages call it by
/// `name`. at() throws InputError, with the place, for an angle that is not finite.
std::unique_ptr<CrossField> make_function_cross(std::function<double(Vec2)> theta, std::string name);

/// Makes crosses from a formula in x, y, z (z = 0) for theta (radians), as make_expression_size().
std::unique_ptr<CrossField> make_expression_cross(const std::string& formula);

/// Function for theta (radians) of a batch of points of the plane, called like SizeFunction.
using CrossFunction = std::function<void(std::span<const Vec2> points, std::span<double> theta)>;

/// Makes crosses from theta (radians) at the points of a planar mesh, as make_nodal_size(). exp(4 i theta) is
/// linear between them. Throws InputError for points of different z, and unless each has one finite angle.
std::unique_ptr<CrossField> make_nodal_cross(const Mesh& mesh, std::vector<double> theta);

/// Singularity of the directions of a problem.
struct PlacedSingularity {
  Vec3 at;
  int index;  ///< in quarters of a turn
};

/// The wanted size of a problem. At most one of `field`, `function` and `from_boundary` is set.
struct SizeSpec {
  /// Text of the user: a number, a formula (make_expression_size()), "boundary", or FILE or FILE:FIELD in
  /// `folder` (make_file_size()). It counts if none of the three below is set.
  std::string text = {};
  std::filesystem::path folder = {};
  std::shared_ptr<const SizeField> field = nullptr;
  SizeFunction function = nullptr;
  /// Sizes are the lengths of the lines of a LineModel, extended smoothly. This is also the default there.
  bool from_boundary = false;
  std::vector<SizeSource> sources = {};  ///< the smallest counts
  std::vector<NamedSize> named = {};     ///< the smallest counts, too
  double gradation = 0;  ///< upper limit of |grad delta|; 0: none, or kCurvatureGradation with `curvature`
  double curvature = 0;  ///< elements per full turn, at least kLeastPerTurn; 0: sizes do not follow curvature
  double min = 0;  ///< least size that curvature may ask for; 0: a twentieth of the size without curvature
  double max = 0;  ///< largest size; 0: none
  std::string where = "size";  ///< origin of the request, for messages
};

/// Default limit of |grad delta| if sizes follow curvature. Sizes would jump between a fillet and its plane.
inline constexpr double kCurvatureGradation = 0.3;
/// Least number of elements per full turn that shows a curve.
inline constexpr double kLeastPerTurn = 3;

/// Sources of the directions of quads.
enum class CrossKind {
  kBoundary,   ///< harmonic, aligned with the boundary [paper, section 3]
  kSizeAware,  ///< as kBoundary, but turned to fit the size with few irregular vertices
  kMetric,     ///< as kBoundary, and along the axes of a metric as far as its lengths differ
  kGradient,   ///< along grad delta; planar domains only
  kField,      ///< `field` or `function`; planar domains only
  kMade,       ///< `maker`
};

class Options;

/// Makes the cross field of a patch from its boundary and size. Called for several patches at once.
using CrossFieldMaker = std::function<std::shared_ptr<const CrossField>(
    const PatchBoundary& boundary, const ParametricSize& size, const Options& options)>;

/// The wanted directions of a problem.
struct CrossSpec {
  /// Text of the user: "boundary", "size-aware", "gradient" or an angle (make_expression_cross()). It counts
  /// if no kind is set.
  std::string text = {};
  std::optional<CrossKind> kind = {};  ///< absent, without text: the kind of the quality; for pipelines
                                       ///< kBoundary
  std::shared_ptr<const CrossField> field = nullptr;
  CrossFunction function = nullptr;
  CrossFieldMaker maker = nullptr;
  std::string where = "cross";  ///< origin of the request, for messages
};

// --- sizes that depend on the direction, in the plane

/// Symmetric, positive definite tensor M. A vector d has the length sqrt(d M d), and quads should be unit
/// squares in it.
struct Tensor2 {
  double xx = 1, xy = 0, yy = 1;
  friend bool operator==(const Tensor2&, const Tensor2&) = default;
};

/// Wanted lengths along two perpendicular directions.
struct MetricAxes {
  double h1 = 1, h2 = 1;
  double theta = 0;  ///< angle of the first direction, radians
};
/// Returns the tensor of axes; h1 and h2 must be above 0.
Tensor2 tensor_of(const MetricAxes& axes);
/// Returns axes with h1 <= h2 and theta in (-pi/2, pi/2].
MetricAxes axes_of(const Tensor2& m);
/// Returns whether m is finite and positive definite, and its lengths differ by a factor below kMostAspect.
bool is_metric(const Tensor2& m);
inline constexpr double kMostAspect = 1e6;

/// Returns the logarithm of the largest factor by which lengths in two metrics differ; 0: they are equal.
double difference(const Tensor2& a, const Tensor2& b);
/// Returns the length of d if the metric changes along it from `a` to `b` as the exponential of a linear
/// function [alauzet2010]. With the lengths la and lb in both metrics it is (la - lb) / log(la / lb).
double metric_length(Vec2 d, const Tensor2& a, const Tensor2& b);
/// Returns the largest tensor whose unit circle lies in both unit circles, by simultaneous reduction
/// [alauzet2010].
Tensor2 intersection(const Tensor2& a, const Tensor2& b);
/// Returns exp(sum of weight log(tensor)) [arsigny2006]. Each tensor has a weight.
Tensor2 log_mean(std::span<const Tensor2> tensors, std::span<const double> weights);
/// Returns the metric that m allows at a distance `length`, measured in m. Sizes grow by a factor of
/// `gradation` (above 1) per unit length [alauzet2010].
Tensor2 grown(const Tensor2& m, double length, double gradation);

/// Bounds of the lengths of a metric, in the unit of the model; 0: none. `min` wins over the other bounds.
struct MetricLimits {
  double min = 0, max = 0;
  double aspect = 0;  ///< upper limit of h2 / h1, at least 1; the larger length becomes less
};
/// Returns m with its lengths brought within the limits; the axes stay.
Tensor2 limited(const Tensor2& m, const MetricLimits& limits);

/// Function that writes the metric at each point of a batch. The thread that calls mesh() calls it before
/// anything is meshed.
using MetricFunction = std::function<void(std::span<const Vec2> points, std::span<Tensor2> metric)>;

/// Returns |H| det(|H|)^(-1/6) of a symmetric H. A metric proportional to it minimizes the L2 error of linear
/// interpolation for a number of elements [loseille2011]. Curvatures below a millionth of the larger one are
/// raised to it, in the determinant to a thousandth. The result needs limits and a complexity to become a
/// metric.
Tensor2 l2_metric(const Tensor2& hessian);

/// Makes a metric from formulas in x and y for m11, m12 and m22. Throws InputError, like the next two makers,
/// with the position of a syntax error.
MetricFunction make_expression_metric(const std::array<std::string, 3>& tensor);
/// Makes a metric from formulas for the length h1 along theta (radians) and h2 across it. The function throws
/// InputError, with the place, for lengths that are not finite and positive.
MetricFunction make_sizes_metric(const std::string& h1, const std::string& h2, const std::string& theta);
/// Makes l2_metric() from the Hessian of a formula, by central differences over the length `step`, above 0.
MetricFunction make_solution_metric(const std::string& solution, double step);
/// Makes a metric from tensors at the points of a mesh of triangles or quads, exp(linear) between them.
/// Throws InputError, with the place, unless is_metric() holds for one tensor at each point.
MetricFunction make_nodal_metric(const Mesh& mesh, std::vector<Tensor2> metric);
/// Makes a metric from tensors at the points of a mesh in a file: an MSH view or a VTU array. `field` may be
/// empty for the only one. Throws InputError for unreadable files, and as make_nodal_metric().
MetricFunction make_file_metric(const std::filesystem::path& file, const std::string& field = {});

/// A metric in space, for surfaces. A vector d in the tangent plane has the length sqrt(d M d).
struct Tensor3 {
  double xx = 1, xy = 0, xz = 0, yy = 1, yz = 0, zz = 1;
  friend bool operator==(const Tensor3&, const Tensor3&) = default;
};
using SpaceMetricFunction = std::function<void(std::span<const Vec3> points, std::span<Tensor3> metric)>;
/// Makes a metric from formulas in x, y and z for m11, m12, m13, m22, m23 and m33. Throws InputError with the
/// position of a syntax error.
SpaceMetricFunction make_expression_space_metric(const std::array<std::string, 6>& tensor);
/// Makes a metric from tensors at the points of a mesh; a place gets the metric of the nearest point on the
/// mesh. Throws InputError, with the place, unless each point has one finite, positive definite tensor.
SpaceMetricFunction make_nodal_space_metric(const Mesh& mesh, std::vector<Tensor3> metric);
/// Does the same with a file, as make_file_metric().
SpaceMetricFunction make_file_space_metric(const std::filesystem::path& file, const std::string& field = {});

struct MetricPlane;

/// The metric of a problem, in place of a size. One source is set. Planar domains take `function`, `tensor`,
/// `sizes`, `solution` or `file`; surfaces take `in_space`, `tensor`, `file` or `chord`.
struct MetricSpec {
  MetricFunction function = nullptr;
  SpaceMetricFunction in_space = nullptr;
  /// The largest distance between sides and arcs along the principal directions of a surface; 0: curvature
  /// does not count.
  double chord = 0;
  std::vector<std::string> tensor = {};  ///< see make_expression_metric(), make_expression_space_metric()
  std::vector<std::string> sizes = {};   ///< h1, h2 and theta, which may be left out if it is 0
  std::string solution = {};             ///< see make_solution_metric()
  std::string file = {};                 ///< FILE or FILE:FIELD in `folder`
  std::filesystem::path folder = {};
  MetricLimits limits = {};
  double gradation = 0;          ///< upper limit of the growth of sizes per unit length, above 1; 0: none
  double complexity = 0;         ///< integral of sqrt(det M), about the number of quads; 0: not scaled
  double scale = 1;              ///< last of all, multiplies all lengths on surfaces; above 0
  std::string where = "metric";  ///< origin of the request, for messages
  /// prepare() sets it for itself.
  std::shared_ptr<const MetricPlane> plane = nullptr;

  bool asks() const {
    return function || in_space || chord > 0 || !tensor.empty() || !sizes.empty() || !solution.empty() ||
           !file.empty();
  }
};

}  // namespace delquad
