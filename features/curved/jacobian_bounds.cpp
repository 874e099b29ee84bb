#include "features/curved/jacobian_bounds.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <vector>

#include "features/curved/bernstein.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// Bounds that are so close, as a part of the greater or absolutely, are not made closer.
constexpr double kClosePart = 0.05, kClose = 0.002;
constexpr int kMostBoxes = 400;
/// Rounding of coefficients, as a part of the largest.
constexpr double kRounding = 1e-13;

/// A part of the square.
struct ParameterBox {
  Bernstein<double> jacobian, uu, vv;  ///< numerator, |x_u|^2, |x_v|^2
  int depth = 0;
  double low = -1;  ///< of the scaled Jacobian
};

double least(const Bernstein<double>& f) { return *std::ranges::min_element(f.c); }
double greatest(const Bernstein<double>& f) { return *std::ranges::max_element(f.c); }

double low_of(const ParameterBox& box, double rounding) {
  const double j = least(box.jacobian) - rounding;
  const double above = std::sqrt(std::max(greatest(box.uu), 0.0) * std::max(greatest(box.vv), 0.0));
  if (j > 0) return above > 0 ? std::min(1.0, j / above) : -1;
  const double below = std::sqrt(std::max(least(box.uu), 0.0) * std::max(least(box.vv), 0.0));
  return below > 0 ? std::max(-1.0, j / below) : -1;
}

/// The least at the box's corners.
double found_in(const ParameterBox& box) {
  double found = 1;
  for (const int u : {0, 1})
    for (const int v : {0, 1}) {
      const auto corner = [&](const Bernstein<double>& f) { return f.at(u * f.du, v * f.dv); };
      const double scale = std::sqrt(std::max(corner(box.uu) * corner(box.vv), 0.0));
      found = std::min(found, scale > 0 ? corner(box.jacobian) / scale : 0.0);
    }
  return std::clamp(found, -1.0, 1.0);
}

}  // namespace

Vec3 mean_normal(std::span<const Vec3> nodes, int order) {
  const Bernstein<Vec3> x = bernstein_of(nodes, order);
  Vec3 sum;
  for (const Vec3& c : cross_product(derivative_u(x), derivative_v(x)).c) sum = sum + c;
  const double length = norm(sum);
  return length > 0 ? (1 / length) * sum : Vec3{};
}

JacobianBounds jacobian_bounds(std::span<const Vec3> nodes, int order, double enough) {
  const Bernstein<Vec3> x = bernstein_of(nodes, order);
  const Bernstein<Vec3> xu = derivative_u(x), xv = derivative_v(x);
  const Bernstein<Vec3> normal = cross_product(xu, xv);
  Vec3 sum;
  for (const Vec3& c : normal.c) sum = sum + c;
  const double length = norm(sum);
  if (!(length > 0)) return {-1, -1};
  ParameterBox whole{dot_product(normal, (1 / length) * sum), dot_product(xu, xu), dot_product(xv, xv)};
  double largest = 0;
  for (const Vec3& c : normal.c) largest = std::max(largest, norm(c));
  const double rounding = kRounding * largest;
  whole.low = low_of(whole, rounding);
  JacobianBounds bounds{whole.low, found_in(whole)};
  const auto later = [](const ParameterBox& a, const ParameterBox& b) { return a.low > b.low; };
  std::priority_queue<ParameterBox, std::vector<ParameterBox>, decltype(later)> boxes(later);
  boxes.push(std::move(whole));
  for (int made = 1; made < kMostBoxes; made += 2) {
    bounds.proven = std::min(boxes.top().low, bounds.found);
    const double gap = bounds.found - bounds.proven;
    if (bounds.proven >= enough || gap <= kClose || (bounds.proven > 0 && gap <= kClosePart * bounds.found) ||
        bounds.found <= 0)
      break;
    const ParameterBox box = boxes.top();
    boxes.pop();
    const bool along_u = box.depth % 2 == 0;
    const auto jacobian = halves(box.jacobian, along_u), uu = halves(box.uu, along_u),
               vv = halves(box.vv, along_u);
    for (const int side : {0, 1}) {
      ParameterBox half{jacobian[side], uu[side], vv[side], box.depth + 1};
      half.low = std::max(low_of(half, rounding), box.low);
      bounds.found = std::min(bounds.found, found_in(half));
      boxes.push(std::move(half));
    }
  }
  bounds.proven = std::min(boxes.top().low, bounds.found);
  return bounds;
}

ProvenJacobians proven_jacobians(std::span<const JacobianBounds> bounds) {
  ProvenJacobians all;
  double sum = 0;
  for (const JacobianBounds& b : bounds) {
    all.unproven += !b.positive();
    all.least = std::min(all.least, b.proven);
    sum += b.proven;
  }
  if (!bounds.empty()) all.mean = sum / static_cast<double>(bounds.size());
  return all;
}

JacobianBounds element_bounds(std::span<const Vec3> nodes, int order, double enough) {
  const JacobianBounds all = jacobian_bounds(nodes, order, enough);
  if (order != 2) return all;
  // The eight-node quad is the nine-node one whose middle is there.
  std::vector<Vec3> eight(nodes.begin(), nodes.end());
  eight[4] =
      middle_of_eight({nodes[0], nodes[2], nodes[6], nodes[8]}, {nodes[1], nodes[3], nodes[5], nodes[7]});
  const JacobianBounds without_middle = jacobian_bounds(eight, order, enough);
  return {std::min(all.proven, without_middle.proven), std::min(all.found, without_middle.found)};
}

}  // namespace delquad
