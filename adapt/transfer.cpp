#include <fmt/format.h>

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "adapt/elements.h"
#include "base/box_tree.h"
#include "base/located.h"
#include "base/parallel_each.h"
#include "delquad/adapt.h"
#include "geometry/mesh/check_mesh.h"

namespace delquad {
namespace {

Vec2 seen_from_above(const Vec3& p) { return {p.x, p.y}; }

using Polygon = std::vector<Vec2>;

/// The part of a polygon that lies to the left of a line [sutherland1974].
void clip(Polygon& polygon, Vec2 a, Vec2 b, Polygon& spare) {
  spare.clear();
  const auto side = [&](Vec2 x) { return cross(b - a, x - a); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double at_p = side(p), at_q = side(q);
    if (at_p >= 0) spare.push_back(p);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0))
      spare.push_back(p + (at_p / (at_p - at_q)) * (q - p));
  }
  std::swap(polygon, spare);
}

/// A triangle of an element, counterclockwise.
struct Half {
  int element;
  std::array<Vec2, 3> corners;
};

/// Quads are parted by a diagonal that lies inside.
std::vector<Half> halves(const Mesh& mesh) {
  std::vector<Half> made;
  const auto add = [&](int element, int a, int b, int c) {
    std::array<Vec2, 3> x{seen_from_above(mesh.points[a]), seen_from_above(mesh.points[b]),
                          seen_from_above(mesh.points[c])};
    const double area = cross(x[1] - x[0], x[2] - x[0]);
    if (area < 0) std::swap(x[1], x[2]);
    if (area != 0) made.push_back({element, x});
  };
  int element = 0;
  for (const auto& [a, b, c] : mesh.triangles) add(element++, a, b, c);
  for (const auto& [a, b, c, d] : mesh.quads) {
    const Vec2 ac = seen_from_above(mesh.points[c] - mesh.points[a]);
    const bool is_inside = cross(ac, seen_from_above(mesh.points[b] - mesh.points[a])) *
                               cross(ac, seen_from_above(mesh.points[d] - mesh.points[a])) <=
                           0;
    add(element, a, b, is_inside ? c : d);
    add(element++, is_inside ? a : b, c, d);
  }
  return made;
}

double double_area(const std::array<Vec2, 3>& x) { return cross(x[1] - x[0], x[2] - x[0]); }

/// The overlaps of the elements of two meshes.
class Overlaps {
 public:
  Overlaps(const Mesh& from, const Mesh& to) : from_(halves(from)), to_(halves(to)) {
    std::vector<Box<Vec2>> boxes;
    for (const Half& half : from_) boxes.push_back(Box<Vec2>::around(half.corners));
    tree_ = BoxTree<Vec2>(boxes);
    first_.assign(to.triangles.size() + to.quads.size() + 1, 0);
    for (const Half& half : to_) ++first_[half.element + 1];
    for (std::size_t e = 1; e < first_.size(); ++e) first_[e] += first_[e - 1];
  }

  /// Calls visit(element of `from`, triangle) for triangles that make up what both meshes have of an element.
  template <class Visit>
  void visit(int element, Visit visit) const {
    std::vector<int> near;
    Polygon polygon, spare;
    for (int h = first_[element]; h < first_[element + 1]; ++h) {
      const auto& x = to_[h].corners;
      near.clear();
      tree_.overlapping(Box<Vec2>::around(x), [&](int other) { near.push_back(other); });
      std::ranges::sort(near);
      for (const int other : near) {
        const auto& y = from_[other].corners;
        polygon.assign(y.begin(), y.end());
        for (int k = 0; k < 3; ++k) clip(polygon, x[k], x[(k + 1) % 3], spare);
        for (std::size_t k = 2; k < polygon.size(); ++k)
          if (const std::array part{polygon[0], polygon[k - 1], polygon[k]}; double_area(part) > 0)
            visit(from_[other].element, part);
      }
    }
  }
  /// Of an element of `to`.
  double area(int element) const {
    double sum = 0;
    for (int h = first_[element]; h < first_[element + 1]; ++h) sum += double_area(to_[h].corners) / 2;
    return sum;
  }

 private:
  std::vector<Half> from_, to_;
  std::vector<int> first_;  ///< of the halves of each element of `to`
  BoxTree<Vec2> tree_;
};

/// The integrals of shape functions.
std::vector<double> masses(const Mesh& mesh) {
  const Elements elements(mesh);
  std::vector<double> mass(mesh.points.size(), 0);
  for (int e = 0; e < elements.size(); ++e)
    for (const Quadrature& q : elements.quadrature(e)) {
      Shape at = elements.shape(e, q.s, q.t);
      const double area = q.weight * elements.to_plane(e, at);
      const auto v = elements.nodes(e);
      for (std::size_t k = 0; k < v.size(); ++k) mass[v[k]] += area * at.value[k];
    }
  return mass;
}

double integral(const std::vector<double>& mass, std::span<const double> values) {
  double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] != 0) sum += mass[i] * values[i];
  return sum;
}

/// Makes the integral what it was: all values change by as much, or, within bounds, by as much of what they
/// may.
struct Bounds {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double x) { low = std::min(low, x), high = std::max(high, x); }
};
void keep_integral(double wanted, const std::vector<double>& mass, const std::vector<Bounds>& bounds,
                   std::vector<double>& values) {
  if (bounds.empty()) {
    double whole = 0;
    for (const double m : mass) whole += m;
    const double shift = (wanted - integral(mass, values)) / whole;
    for (double& value : values) value += shift;
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (mass[i] != 0) values[i] = std::clamp(values[i], bounds[i].low, bounds[i].high);
  const double lacking = wanted - integral(mass, values);
  std::vector<double> room(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (mass[i] != 0) room[i] = (lacking > 0 ? bounds[i].high : bounds[i].low) - values[i];
  const double all = integral(mass, room);
  if (all == 0) return;
  const double part = std::min(1.0, lacking / all);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += part * room[i];
}

/// Of one element of the new mesh.
struct Projection {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  Bounds bounds;
};

/// Below this part of an element's area nothing is missing but rounding.
constexpr double kCovered = 1e-10;

class Projector {
 public:
  Projector(const Mesh& from, std::span<const double> values, const Mesh& to)
      : values_(values), old_(from), new_(to), finder_(from), overlaps_(from, to) {}

  /// The same quadrature on both sides of the equation: linear fields stay as they are.
  Projection of(int element) const {
    const auto n = static_cast<Eigen::Index>(new_.nodes(element).size());
    Projection made{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), {}};
    const auto add = [&](const Shape& at, double weight, double value) {
      const Eigen::Map<const Eigen::VectorXd> shape(at.value.data(), n);
      made.matrix += weight * shape * shape.transpose();
      made.right += weight * value * shape;
    };
    int hint = -1;
    const double area = overlaps_.area(element);
    double covered = 0;
    overlaps_.visit(element, [&](int other, const std::array<Vec2, 3>& part) {
      const double size = double_area(part) / 2;
      covered += size;
      for (const int v : old_.nodes(other)) made.bounds.take(values_[v]);
      for (int k = 0; k < 3; ++k) {  // exact for degree 2
        const Vec2 p = (1.0 / 6) * (part[0] + part[1] + part[2] + 3 * part[k]);
        const Vec3 x{p.x, p.y, old_.points()[old_.nodes(other)[0]].z};
        add(inside(new_, element, x), size / 3, old_.value(other, inside(old_, other, x), values_));
      }
    });
    // Beyond the old outline it is as at the nearest point there.
    if (area - covered > kCovered * area)
      for (const Quadrature& q : new_.quadrature(element)) {
        Shape at = new_.shape(element, q.s, q.t);
        const Vec3 x = new_.point(element, at);
        const auto found = finder_.at(x, hint);
        const double value =
            old_.value(found.element, old_.shape_at(found.element, x, found.s, found.t), values_);
        made.bounds.take(value);
        const double weight = (1 - covered / area) * q.weight * new_.to_plane(element, at);
        add(at, weight, value);
      }
    return made;
  }

  std::vector<double> solve(std::vector<Bounds>* bounds) const {
    std::vector<Projection> each(static_cast<std::size_t>(new_.size()));
    parallel_each(each.size(), [&](std::size_t e) { each[e] = of(static_cast<int>(e)); });
    const auto n = static_cast<Eigen::Index>(new_.points().size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    std::vector<char> is_used(static_cast<std::size_t>(n), 0);
    if (bounds != nullptr) bounds->resize(static_cast<std::size_t>(n));
    for (int e = 0; e < new_.size(); ++e) {
      const auto v = new_.nodes(e);
      const auto m = static_cast<Eigen::Index>(v.size());
      for (Eigen::Index i = 0; i < m; ++i) {
        is_used[v[i]] = 1;
        right[v[i]] += each[e].right[i];
        for (Eigen::Index k = 0; k < m; ++k) entries.emplace_back(v[i], v[k], each[e].matrix(i, k));
        if (bounds == nullptr) continue;
        (*bounds)[v[i]].take(each[e].bounds.low);
        (*bounds)[v[i]].take(each[e].bounds.high);
      }
    }
    for (int i = 0; i < n; ++i)
      if (!is_used[i]) entries.emplace_back(i, i, 1);
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) refuse("the mesh to be filled has elements without area");
    const Eigen::VectorXd solution = solver.solve(right);
    return {solution.begin(), solution.end()};
  }

 private:
  /// Triangles' own places of a point need no search.
  static Shape inside(const Elements& elements, int element, const Vec3& x) {
    if (!elements.is_triangle(element)) return elements.shape_at(element, x, 0.5, 0.5);
    const auto v = elements.nodes(element);
    const auto w =
        nearest_weights(elements.points()[v[0]], elements.points()[v[1]], elements.points()[v[2]], x);
    return elements.shape(element, w[1], w[2]);
  }

  std::span<const double> values_;
  Elements old_, new_;
  ElementFinder finder_;
  Overlaps overlaps_;
};

void require_pair(const Mesh& from, const Mesh& to, Transfer how) {
  for (const Mesh* mesh : {&from, &to}) {
    const std::string what = mesh == &from ? "the mesh of the field" : "the mesh to be filled";
    if (how == Transfer::kInterpolated) {
      require_readable(*mesh, what);
      if (mesh->triangles.empty() && mesh->quads.empty()) refuse("{} has neither triangles nor quads", what);
    } else {
      require_planar(*mesh, what);
      require_straight(*mesh, what);
    }
  }
}

}  // namespace

std::vector<double> transfer_points(const Mesh& from, std::span<const double> values, const Mesh& to,
                                    Transfer how) {
  require_pair(from, to, how);
  require_values(from, values, "that is to be transferred");
  if (how == Transfer::kInterpolated) {
    const Elements elements(from);
    const ElementFinder finder(from);
    std::vector<double> made(to.points.size());
    parallel_ranges(made.size(), [&](std::size_t begin, std::size_t end) {
      int hint = -1;
      for (std::size_t i = begin; i < end; ++i) {
        const auto found = finder.at(to.points[i], hint);
        made[i] = elements.value(found.element,
                                 elements.shape_at(found.element, to.points[i], found.s, found.t), values);
      }
    });
    return made;
  }
  std::vector<Bounds> bounds;
  std::vector<double> made = Projector(from, values, to).solve(how == Transfer::kBounded ? &bounds : nullptr);
  keep_integral(integral(masses(from), values), masses(to), bounds, made);
  return made;
}

std::vector<double> transfer_elements(const Mesh& from, std::span<const double> values, const Mesh& to,
                                      Transfer how) {
  require_pair(from, to, how);
  const Elements old(from), fresh(to);
  if (std::ssize(values) != old.size())
    refuse("there are {} values for the {} triangles and quads of the mesh of the field", values.size(),
           old.size());
  if (const auto bad = std::ranges::find_if(values, [](double x) { return !std::isfinite(x); });
      bad != values.end())
    refuse("the value {} of elements is {}: expected finite ones", bad - values.begin(), *bad);
  const ElementFinder finder(from);
  std::vector<double> made(static_cast<std::size_t>(fresh.size())), mass(made.size());
  std::vector<Bounds> bounds(made.size());
  std::optional<Overlaps> overlaps;
  if (how != Transfer::kInterpolated) overlaps.emplace(from, to);
  parallel_ranges(made.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const int e = static_cast<int>(i);
      const double middle = fresh.is_triangle(e) ? 1.0 / 3 : 0.5;
      const double near = values[finder.at(fresh.point(e, fresh.shape(e, middle, middle)), hint).element];
      made[i] = near;
      if (!overlaps) continue;
      double sum = 0, covered = 0;
      overlaps->visit(e, [&](int other, const std::array<Vec2, 3>& part) {
        covered += double_area(part) / 2;
        sum += double_area(part) / 2 * values[other];
        bounds[i].take(values[other]);
      });
      mass[i] = overlaps->area(e);
      bounds[i].take(near);
      if (mass[i] - covered > kCovered * mass[i]) sum += (mass[i] - covered) * near, covered = mass[i];
      if (covered > 0) made[i] = sum / covered;
    }
  });
  if (!overlaps) return made;
  double wanted = 0;
  for (const Half& half : halves(from)) wanted += double_area(half.corners) / 2 * values[half.element];
  if (how == Transfer::kConservative) bounds.clear();
  keep_integral(wanted, mass, bounds, made);
  return made;
}

}  // namespace delquad
