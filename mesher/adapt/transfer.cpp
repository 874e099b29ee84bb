// SPDX-License-Identifier: GPL-3.0-or-later

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box_tree.h"
#include "base/located.h"
#include "base/parallel_each.h"
#include "delquad/adapt.h"
#include "geometry/mesh/check_mesh.h"
#include "mesher/adapt/elements.h"

namespace delquad {
namespace {

double area_of(const std::array<Vec2, 3>& x) { return cross(x[1] - x[0], x[2] - x[0]) / 2; }

using Polygon = std::vector<Vec2>;

/// Clips a polygon to the left side of a line [sutherland1974].
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

/// Returns the triangles of elements; quads are split by a diagonal inside.
std::vector<Half> halves(const Mesh& mesh) {
  std::vector<Half> made;
  const auto at = [&](int node) { return Vec2{mesh.points[node].x, mesh.points[node].y}; };
  const auto add = [&](int element, int a, int b, int c) {
    std::array x{at(a), at(b), at(c)};
    if (area_of(x) < 0) std::swap(x[1], x[2]);
    if (area_of(x) > 0) made.push_back({element, x});
  };
  int element = 0;
  for (const auto& [a, b, c] : mesh.triangles) add(element++, a, b, c);
  for (const auto& [a, b, c, d] : mesh.quads) {
    const bool is_inside = area_of({at(a), at(b), at(c)}) * area_of({at(a), at(c), at(d)}) >= 0;
    add(element, a, b, is_inside ? c : d);
    add(element++, is_inside ? a : b, c, d);
  }
  return made;
}

/// A missing area below this part of an element is rounding.
constexpr double kCovered = 1e-10;

/// Overlaps of the elements of two meshes.
class Overlaps {
 public:
  Overlaps(const Mesh& from, const Mesh& to)
      : from_(halves(from)), to_(halves(to)), finder_(from), new_(to), z_(from.points[0].z) {
    std::vector<Box<Vec2>> boxes;
    for (const Half& half : from_) boxes.push_back(Box<Vec2>::around(half.corners));
    tree_ = BoxTree<Vec2>(boxes);
    first_.assign(static_cast<std::size_t>(new_.size()) + 1, 0);
    for (const Half& half : to_) ++first_[half.element + 1];
    for (std::size_t e = 1; e < first_.size(); ++e) first_[e] += first_[e - 1];
  }

  /// Calls visit(weight, point, place) for places in elements of `from` whose weights sum up to the area of
  /// an element of `to`. Each triangle of an overlap has three, exact for degree 2. Beyond the old outline
  /// the nearest place counts.
  template <class Visit>
  void visit(int element, Visit visit) const {
    std::vector<int> near;
    Polygon polygon, spare;
    double area = 0, covered = 0;
    for (int h = first_[element]; h < first_[element + 1]; ++h) {
      const auto& x = to_[h].corners;
      area += area_of(x);
      near.clear();
      tree_.overlapping(Box<Vec2>::around(x), [&](int other) { near.push_back(other); });
      std::ranges::sort(near);
      for (const int other : near) {
        const auto& y = from_[other].corners;
        polygon.assign(y.begin(), y.end());
        for (int k = 0; k < 3; ++k) clip(polygon, x[k], x[(k + 1) % 3], spare);
        for (std::size_t k = 2; k < polygon.size(); ++k) {
          const std::array part{polygon[0], polygon[k - 1], polygon[k]};
          if (!(area_of(part) > 0)) continue;
          covered += area_of(part);
          for (const Vec2 corner : part) {
            const Vec2 p = (1.0 / 6) * (part[0] + part[1] + part[2] + 3 * corner);
            visit(area_of(part) / 3, Vec3{p.x, p.y, z_},
                  ElementFinder::Found{from_[other].element, 0.5, 0.5});
          }
        }
      }
    }
    if (!(area - covered > kCovered * area)) return;
    int hint = -1;
    for (const Quadrature& q : new_.quadrature(element)) {
      Shape at = new_.shape(element, q.s, q.t);
      const Vec3 x = new_.point(element, at);
      visit((1 - covered / area) * q.weight * new_.to_plane(element, at), x, finder_.at(x, hint));
    }
  }

 private:
  std::vector<Half> from_, to_;
  std::vector<int> first_;  ///< first half of each element of `to`
  ElementFinder finder_;
  ElementMaps new_;
  double z_;
  BoxTree<Vec2> tree_;
};

/// Returns the integrals of shape functions.
std::vector<double> masses(const Mesh& mesh) {
  const ElementMaps elements(mesh);
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

struct Bounds {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double x) { low = std::min(low, x), high = std::max(high, x); }
};

/// Restores the integral: all values change equally or, if bounded, in proportion to their range.
void keep_integral(double wanted, const std::vector<double>& mass, const std::vector<Bounds>& bounds,
                   Transfer how, std::vector<double>& values) {
  std::vector<double> room(values.size(), 1);
  if (how == Transfer::kBounded)
    for (std::size_t i = 0; i < values.size(); ++i)
      if (mass[i] != 0) values[i] = std::clamp(values[i], bounds[i].low, bounds[i].high);
  const double lacking = wanted - integral(mass, values);
  if (how == Transfer::kBounded)
    for (std::size_t i = 0; i < values.size(); ++i)
      room[i] = mass[i] == 0 ? 0 : (lacking > 0 ? bounds[i].high : bounds[i].low) - values[i];
  const double all = integral(mass, room);
  if (all == 0) return;
  const double part = how == Transfer::kBounded ? std::min(1.0, lacking / all) : lacking / all;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += part * room[i];
}

/// Returns the L2 projection. Both sides of the equation have the same places, so linear fields do not
/// change.
std::vector<double> project(const Mesh& from, std::span<const double> values, const Mesh& to,
                            std::vector<Bounds>& bounds) {
  struct Local {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    Bounds bounds = {};
  };
  const ElementMaps old(from), fresh(to);
  const Overlaps overlaps(from, to);
  std::vector<Local> each(static_cast<std::size_t>(fresh.size()));
  parallel_each(each.size(), [&](std::size_t i) {
    Local& local = each[i];
    overlaps.visit(static_cast<int>(i), [&](double weight, const Vec3& x, const ElementFinder::Found& place) {
      const Shape there = old.shape_at(place.element, x, place.s, place.t);
      const Shape here = fresh.shape_at(static_cast<int>(i), x, 0.5, 0.5);
      const Eigen::Map<const Eigen::Vector4d> shape(here.value.data());
      local.matrix += weight * shape * shape.transpose();
      local.right += weight * old.value(place.element, there, values) * shape;
      for (const int v : old.nodes(place.element)) local.bounds.take(values[v]);
    });
  });
  const auto n = static_cast<Eigen::Index>(to.points.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n), is_free = Eigen::VectorXd::Ones(n);
  for (int e = 0; e < fresh.size(); ++e) {
    const auto v = fresh.nodes(e);
    for (std::size_t i = 0; i < v.size(); ++i) {
      is_free[v[i]] = 0;
      right[v[i]] += each[e].right[i];
      for (std::size_t k = 0; k < v.size(); ++k) entries.emplace_back(v[i], v[k], each[e].matrix(i, k));
      bounds[v[i]].take(each[e].bounds.low);
      bounds[v[i]].take(each[e].bounds.high);
    }
  }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, is_free[i]);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success)
    refuse("the mesh to be filled has elements without area: expected a sound mesh");
  const Eigen::VectorXd solution = solver.solve(right);
  return {solution.begin(), solution.end()};
}

void require_pair(const Mesh& from, const Mesh& to, Transfer how) {
  for (const Mesh* mesh : {&from, &to}) {
    const std::string what = mesh == &from ? "the mesh of the field" : "the mesh to be filled";
    require_elements(*mesh, what);
    if (how == Transfer::kInterpolated) continue;
    require_planar(*mesh, what);
    require_straight(*mesh, what);
  }
}

}  // namespace

std::vector<double> transfer_points(const Mesh& from, std::span<const double> values, const Mesh& to,
                                    Transfer how) {
  require_pair(from, to, how);
  require_values(from, values, "that is to be transferred");
  std::vector<double> made(to.points.size());
  if (how != Transfer::kInterpolated) {
    std::vector<Bounds> bounds(made.size());
    made = project(from, values, to, bounds);
    keep_integral(integral(masses(from), values), masses(to), bounds, how, made);
    return made;
  }
  const ElementMaps elements(from);
  const ElementFinder finder(from);
  parallel_ranges(made.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const auto [element, s, t] = finder.at(to.points[i], hint);
      made[i] = elements.value(element, elements.shape_at(element, to.points[i], s, t), values);
    }
  });
  return made;
}

std::vector<double> transfer_elements(const Mesh& from, std::span<const double> values, const Mesh& to,
                                      Transfer how) {
  require_pair(from, to, how);
  const ElementMaps old(from), fresh(to);
  if (std::ssize(values) != old.size())
    refuse("there are {} values for the {} triangles and quads of the mesh of the field", values.size(),
           old.size());
  for (std::size_t e = 0; e < values.size(); ++e)
    if (!std::isfinite(values[e]))
      refuse("the value of element {} is {}: expected finite values", e, values[e]);
  std::vector<double> made(static_cast<std::size_t>(fresh.size()), 0), mass(made.size(), 0);
  if (how == Transfer::kInterpolated) {
    const ElementFinder finder(from);
    int hint = -1;
    for (int e = 0; e < fresh.size(); ++e) {
      const double middle = fresh.is_triangle(e) ? 1.0 / 3 : 0.5;
      made[e] = values[finder.at(fresh.point(e, fresh.shape(e, middle, middle)), hint).element];
    }
    return made;
  }
  std::vector<Bounds> bounds(made.size());
  const Overlaps overlaps(from, to);
  parallel_each(made.size(), [&](std::size_t e) {
    overlaps.visit(static_cast<int>(e), [&](double weight, const Vec3&, const ElementFinder::Found& place) {
      mass[e] += weight;
      made[e] += weight * values[place.element];
      bounds[e].take(values[place.element]);
    });
    if (mass[e] > 0) made[e] /= mass[e];
  });
  double wanted = 0;
  for (const Half& half : halves(from)) wanted += area_of(half.corners) * values[half.element];
  keep_integral(wanted, mass, bounds, how, made);
  return made;
}

}  // namespace delquad
