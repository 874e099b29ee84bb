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

// The wanted sizes and directions of the quads.

namespace delquad {

/// The wanted edge length delta at a point of space (physical length, finite, > 0).
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// `hint` remembers where the last point was found: start with -1 and carry it along between nearby points.
  /// It never changes the value. Throws InputError, naming the point, where delta is not finite and positive.
  /// Safe to call from several threads.
  virtual double at(const Vec3& x, int& hint) const = 0;
};

/// The wanted edge length delta' in the parameter plane of a patch. Safe to call from several threads.
class ParametricSize {
 public:
  virtual ~ParametricSize() = default;
  virtual double at(Vec2 u, int& hint) const = 0;
};

/// delta' of a planar patch, whose parameter plane is the plane z = constant itself.
class PlanarSize final : public ParametricSize {
 public:
  explicit PlanarSize(std::shared_ptr<const SizeField> size, double z = 0) : size_(std::move(size)), z_(z) {}
  double at(Vec2 u, int& hint) const override { return size_->at({u.x, u.y, z_}, hint); }

 private:
  std::shared_ptr<const SizeField> size_;
  double z_;
};

/// The same everywhere. Throws InputError unless it is finite and positive.
std::unique_ptr<SizeField> make_constant_size(double delta);

/// delta as a function, which may be called from several threads. Messages call it by `name`.
std::unique_ptr<SizeField> make_function_size(std::function<double(const Vec3&)> delta, std::string name);

/// delta = a formula in x, y, z: + - * / ^ (power), comparisons, && || ?:, sin, sqrt, exp, abs, min, max,
/// atan2 and the like, pi and e. Throws InputError with the position where it does not parse.
std::unique_ptr<SizeField> make_expression_size(const std::string& formula);

/// What an MSH or VTU file (also packed: .gz) has at the points of its mesh, as make_nodal_size(). `field`:
/// empty for the only one. Throws InputError for what cannot be read.
std::unique_ptr<SizeField> make_file_size(const std::filesystem::path& file, const std::string& field = {});

/// A function of a batch of points: writes delta of each. It is called from the thread that calls mesh(), for
/// thousands of points at a time, before anything is meshed; between its samples delta is interpolated, see
/// sample_size().
using SizeFunction = std::function<void(std::span<const Vec3> points, std::span<double> delta)>;

/// delta at the points of a mesh of triangles or quads, linear between them (quads are split); elsewhere that
/// of the nearest point of the mesh. Throws InputError unless there is one finite, positive value for each
/// point.
std::unique_ptr<SizeField> make_nodal_size(const Mesh& mesh, std::vector<double> delta);

/// A point (a == b) or segment source [paper, section 8.2]: size_near within radius_near of it, size_far
/// beyond radius_far, linear in the distance between.
struct SizeSource {
  Vec3 a, b;
  double size_near, size_far, radius_near, radius_far;
};

/// What a name asks for: all curves, points, regions and faces that have it.
struct NamedSize {
  std::string name;
  /// Up to `reach` from them (inside of regions: everywhere) sizes are at most this; 0: `curvature` is all
  /// that is asked.
  double size = 0;
  double reach = 0;
  double growth = kNamedGrowth;  ///< of sizes from there on, per unit length
  /// Elements per full turn of faces and curves of that name, in place of SizeSpec::curvature; 0: as that.
  double curvature = 0;
  std::string where = {};  ///< who asked for it, for messages
  static constexpr double kNamedGrowth = 0.3;
};

/// A cross: four directions theta + k pi/2, stored as exp(4 i theta), not necessarily of unit length.
/// [Section 3]
struct Cross {
  double c = 1;  ///< cos 4 theta
  double s = 0;  ///< sin 4 theta
  static Cross from_angle(double theta) { return {std::cos(4 * theta), std::sin(4 * theta)}; }
  /// One of the four directions along d, which is not zero; free of rounding when d lies along an axis or
  /// diagonal.
  static Cross along(Vec2 d) {
    const double n = std::hypot(d.x, d.y);
    const Vec2 e = {d.x / n, d.y / n};
    const Vec2 squared = {e.x * e.x - e.y * e.y, 2 * e.x * e.y};
    return {squared.x * squared.x - squared.y * squared.y, 2 * squared.x * squared.y};
  }
  /// theta in (-pi/4, pi/4], radians.
  double angle() const { return std::atan2(s, c) / 4; }
};

inline Cross operator+(Cross a, Cross b) { return {a.c + b.c, a.s + b.s}; }

/// The wanted directions of the quads' edges in the parameter plane of a patch.
class CrossField {
 public:
  virtual ~CrossField() = default;
  /// `hint`: as in SizeField::at.
  virtual Cross at(Vec2 u, int& hint) const = 0;
};

/// theta (radians) as a function, which may be called from several threads. Messages call it by `name`.
std::unique_ptr<CrossField> make_function_cross(std::function<double(Vec2)> theta, std::string name);

/// theta (radians) = a formula in x, y, z, as make_expression_size().
std::unique_ptr<CrossField> make_expression_cross(const std::string& formula);

/// theta (radians) of a batch of points of the plane, called as SizeFunction is.
using CrossFunction = std::function<void(std::span<const Vec2> points, std::span<double> theta)>;

/// theta (radians) at the points of a planar mesh, as make_nodal_size(): exp(4 i theta) is linear between
/// them.
std::unique_ptr<CrossField> make_nodal_cross(const Mesh& mesh, std::vector<double> theta);

/// A singularity of the directions of a problem.
struct PlacedSingularity {
  Vec3 at;
  int index;  ///< in quarters of a turn
};

/// The wanted size of a problem. Of `field`, `function` and `from_boundary` one at most.
struct SizeSpec {
  /// As people write it: a number, a formula (see make_expression_size()), "boundary", or a file that counts
  /// from `folder`, FILE or FILE:FIELD (see make_file_size()). It is read where none of the three is given.
  std::string text = {};
  std::filesystem::path folder = {};
  std::shared_ptr<const SizeField> field = nullptr;
  SizeFunction function = nullptr;
  /// The lengths of the lines that a LineModel gives, extended smoothly; so, too, where nothing is said.
  bool from_boundary = false;
  std::vector<SizeSource> sources = {};  ///< the smallest counts
  std::vector<NamedSize> named = {};     ///< so, too
  double gradation = 0;  ///< the most |grad delta|; 0: no limit, or kCurvatureGradation with `curvature`
  double curvature = 0;  ///< elements per full turn; 0: sizes do not follow curvature
  double min = 0;        ///< least size that curvature asks for; 0: a twentieth of what it would be without
  double max = 0;        ///< largest size; 0: none
  std::string where = "size";  ///< who asked for it, for messages
};

/// The most |grad delta| where sizes follow curvature and nothing else is said: between a fillet and the
/// plane beside it they would jump.
inline constexpr double kCurvatureGradation = 0.3;
/// Fewer elements per full turn would not show a curve at all.
inline constexpr double kLeastPerTurn = 3;

/// Where the directions of the quads come from.
enum class CrossKind {
  kBoundary,   ///< harmonic, aligned with the boundary [paper, section 3]
  kSizeAware,  ///< the same, turned so that the size asks for as few irregular vertices as it can
  kMetric,     ///< the same, and along the axes of a metric as far as its lengths differ
  kGradient,   ///< along grad delta; planar domains only
  kField,      ///< `field` or `function`; planar domains only
  kMade,       ///< `maker`
};

class Options;

/// The cross field of a patch, from its boundary and size. Called for several patches at once.
using CrossFieldMaker = std::function<std::shared_ptr<const CrossField>(
    const PatchBoundary& boundary, const ParametricSize& size, const Options& options)>;

/// The wanted directions of a problem.
struct CrossSpec {
  /// As people write it: "boundary", "size-aware", "gradient" or an angle, see make_expression_cross(). It is
  /// read where no kind is given.
  std::string text = {};
  std::optional<CrossKind> kind = {};  ///< absent, and no text: that of the quality, of a word kBoundary
  std::shared_ptr<const CrossField> field = nullptr;
  CrossFunction function = nullptr;
  CrossFieldMaker maker = nullptr;
  std::string where = "cross";  ///< who asked for it, for messages
};

// --- sizes that depend on the direction, in the plane

/// A symmetric, positive definite tensor M: a vector d has the length sqrt(d M d), and quads are wanted that
/// are unit squares by it.
struct Tensor2 {
  double xx = 1, xy = 0, yy = 1;
  friend bool operator==(const Tensor2&, const Tensor2&) = default;
};

/// Wanted lengths along two perpendicular directions.
struct MetricAxes {
  double h1 = 1, h2 = 1;
  double theta = 0;  ///< of the first direction, radians
};
Tensor2 tensor_of(const MetricAxes& axes);
/// With h1 <= h2 and theta in (-pi/2, pi/2].
MetricAxes axes_of(const Tensor2& m);
/// Whether it is finite and positive definite, and its lengths differ by less than kMostAspect.
bool is_metric(const Tensor2& m);
inline constexpr double kMostAspect = 1e6;

/// By which factor lengths differ, at most, as a logarithm.
double difference(const Tensor2& a, const Tensor2& b);
/// The length of d where the metric goes from `a` to `b` along it as the exponential of a linear function:
/// (la - lb) / log(la / lb) with the lengths by both.
double metric_length(Vec2 d, const Tensor2& a, const Tensor2& b);
/// The largest tensor whose unit circle lies in those of both: by their simultaneous reduction [alauzet2010].
Tensor2 intersection(const Tensor2& a, const Tensor2& b);
/// exp(sum of weight log) [arsigny2006].
Tensor2 log_mean(std::span<const Tensor2> tensors, std::span<const double> weights);
/// What a metric allows at a distance, which is measured by it, where sizes grow by a factor of `gradation`
/// (above 1) per unit length [alauzet2010].
Tensor2 grown(const Tensor2& m, double length, double gradation);

/// Bounds of a metric's lengths; 0: none. Where they contradict each other the least length counts first.
struct MetricLimits {
  double min = 0, max = 0;
  double aspect = 0;  ///< the most that h2 is of h1: the larger becomes less
};
Tensor2 limited(const Tensor2& m, const MetricLimits& limits);

/// Writes the metric at each point of a batch. Called from the thread that calls mesh(), before anything is
/// meshed.
using MetricFunction = std::function<void(std::span<const Vec2> points, std::span<Tensor2> metric)>;

/// |H| det(|H|)^(-1/6) of a symmetric H: in proportion to it the L2 error of linear interpolation of what has
/// that Hessian is least for a number of elements [loseille2011]. Curvatures below a millionth of the larger
/// one count as that, and in the determinant below a thousandth. It is a metric once it has limits
/// and a complexity.
Tensor2 l2_metric(const Tensor2& hessian);

/// m11, m12 and m22 as formulas in x and y.
MetricFunction make_expression_metric(const std::array<std::string, 3>& tensor);
/// The length h1 along theta (radians) and h2 across it, as formulas.
MetricFunction make_sizes_metric(const std::string& h1, const std::string& h2, const std::string& theta);
/// l2_metric() of a formula's Hessian, taken by differences over `step`.
MetricFunction make_solution_metric(const std::string& solution, double step);
/// At the points of a mesh of triangles or quads, exp(linear) between them. Throws InputError unless there is
/// one metric for each point.
MetricFunction make_nodal_metric(const Mesh& mesh, std::vector<Tensor2> metric);
/// That of a file at the points of its mesh: the tensors of an MSH view or a VTU array. `field`: empty for
/// the only one.
MetricFunction make_file_metric(const std::filesystem::path& file, const std::string& field = {});

/// The same in space, for surfaces: of a vector in the tangent plane d M d is the square of its length.
struct Tensor3 {
  double xx = 1, xy = 0, xz = 0, yy = 1, yz = 0, zz = 1;
  friend bool operator==(const Tensor3&, const Tensor3&) = default;
};
using SpaceMetricFunction = std::function<void(std::span<const Vec3> points, std::span<Tensor3> metric)>;
/// m11, m12, m13, m22, m23 and m33 as formulas in x, y and z.
SpaceMetricFunction make_expression_space_metric(const std::array<std::string, 6>& tensor);
/// As that of the plane; of the point of the mesh that is nearest.
SpaceMetricFunction make_nodal_space_metric(const Mesh& mesh, std::vector<Tensor3> metric);
SpaceMetricFunction make_file_space_metric(const std::filesystem::path& file, const std::string& field = {});

struct MetricPlane;

/// The metric that a problem is meshed by, in place of a size. One of the first is given: of planar domains
/// `function`, `tensor`, `sizes`, `solution` or `file`, of surfaces `in_space`, `tensor`, `file` or `chord`.
struct MetricSpec {
  MetricFunction function = nullptr;
  SpaceMetricFunction in_space = nullptr;
  /// By the curvature of surfaces: along each principal direction sides stray from an arc by no more than
  /// this length; 0: that is not asked.
  double chord = 0;
  std::vector<std::string> tensor = {};  ///< see make_expression_metric(), make_expression_space_metric()
  std::vector<std::string> sizes = {};   ///< h1, h2 and, if it is not 0, theta
  std::string solution = {};             ///< see make_solution_metric()
  std::string file = {};                 ///< FILE or FILE:FIELD, which counts from `folder`
  std::filesystem::path folder = {};
  MetricLimits limits = {};
  double gradation = 0;          ///< the most that sizes grow by per unit length, above 1; 0: no limit
  double complexity = 0;         ///< the integral of sqrt(det M), about the number of quads; 0: as it is
  double scale = 1;              ///< all lengths on surfaces are times this, at last
  std::string where = "metric";  ///< who asked for it, for messages
  /// Made by prepare() for itself.
  std::shared_ptr<const MetricPlane> plane = nullptr;

  bool asks() const {
    return function || in_space || chord > 0 || !tensor.empty() || !sizes.empty() || !solution.empty() ||
           !file.empty();
  }
};

}  // namespace delquad
