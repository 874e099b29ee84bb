// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/check_mesh.h"

namespace delquad {

namespace {

/// Limit of halvings, in three directions in turn, of a hexahedron whose sign is open.
constexpr int kMostHalvings = 12;

double triple(const Vec3& a, const Vec3& b, const Vec3& c) { return dot(cross(a, b), c); }

/// A corner, and its neighbors in an order that makes the edges right-handed.
using CornerEdges = std::array<int, 4>;
constexpr CornerEdges kHexCornerEdges[] = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7},
                                           {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}},
                      kPrismCornerEdges[] = {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5},
                                             {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}},
                      kPyramidCornerEdges[] = {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}},
                      kTetCornerEdges[] = {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 1, 0, 2}};

struct CornerTable {
  std::span<const CornerEdges> corners;
  double factor;  ///< of the scaled Jacobian
};
CornerTable table_of(std::size_t n_corners) {
  using std::numbers::sqrt2, std::numbers::inv_sqrt3;
  switch (n_corners) {
    case 8:
      return {kHexCornerEdges, 1};
    case 6:
      return {kPrismCornerEdges, 2 * inv_sqrt3};
    case 5:
      return {kPyramidCornerEdges, sqrt2};
    default:
      return {kTetCornerEdges, sqrt2};
  }
}

double determinant(std::span<const Vec3> at, const CornerEdges& c) {
  return triple(at[c[1]] - at[c[0]], at[c[2]] - at[c[0]], at[c[3]] - at[c[0]]);
}

/// Determinants of the Jacobian of a hexahedron at 0, 1/2 and 1 of each parameter, the first one fastest.
/// They define a polynomial of degree 2 in each.
using Values27 = std::array<double, 27>;
Values27 jacobian_values(std::span<const Vec3> p) {
  // Edges along each parameter, by the other two (lower one first): (0, 0), (1, 0), (0, 1), (1, 1).
  const std::array<std::array<Vec3, 4>, 3> edges = {{{p[1] - p[0], p[2] - p[3], p[5] - p[4], p[6] - p[7]},
                                                     {p[3] - p[0], p[2] - p[1], p[7] - p[4], p[6] - p[5]},
                                                     {p[4] - p[0], p[5] - p[1], p[7] - p[3], p[6] - p[2]}}};
  const auto along = [&](int axis, double s, double t) {
    const auto& e = edges[axis];
    return (1 - t) * ((1 - s) * e[0] + s * e[1]) + t * ((1 - s) * e[2] + s * e[3]);
  };
  Values27 values;
  for (int k = 0; k < 27; ++k) {
    const double u = k % 3 / 2.0, v = k / 3 % 3 / 2.0, w = k / 9 / 2.0;
    values[k] = triple(along(0, v, w), along(1, u, w), along(2, u, v));
  }
  return values;
}

constexpr std::array<int, 3> kStrides = {1, 3, 9};

/// Calls f(a, b, c) for the triples along an axis.
template <class F>
void for_each_row(Values27& values, int axis, const F& f) {
  const int stride = kStrides[axis];
  for (int k = 0; k < 27; ++k)
    if (k / stride % 3 == 0) f(values[k], values[k + stride], values[k + 2 * stride]);
}

Values27 bernstein(Values27 values) {
  for (int axis = 0; axis < 3; ++axis)
    for_each_row(values, axis, [](double a, double& b, double c) { b = 2 * b - (a + c) / 2; });
  return values;
}

/// Returns whether a polynomial is above `least` everywhere, by its coefficients.
bool is_above(const Values27& b, double least, int halvings) {
  if (*std::min_element(b.begin(), b.end()) > least) return true;
  for (const int corner : {0, 2, 6, 8, 18, 20, 24, 26})
    if (!(b[corner] > least)) return false;
  if (halvings == kMostHalvings) return false;
  Values27 low = b, high = b;
  for_each_row(low, halvings % 3, [](double a, double& m, double& c) {
    c = (a + 2 * m + c) / 4;
    m = (a + m) / 2;
  });
  for_each_row(high, halvings % 3, [](double& a, double& m, double c) {
    a = (a + 2 * m + c) / 4;
    m = (m + c) / 2;
  });
  return is_above(low, least, halvings + 1) && is_above(high, least, halvings + 1);
}

/// Bernstein coefficients of the Jacobian of a prism, quadratic along each of its three edges between the
/// triangles; it is linear across them.
std::array<std::array<double, 3>, 3> prism_coefficients(std::span<const Vec3> p) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0], c = p[4] - p[3], d = p[5] - p[3];
  const std::array<Vec3, 3> normals = {cross(a, b), 0.5 * (cross(a, d) + cross(c, b)), cross(c, d)};
  std::array<std::array<double, 3>, 3> f{};
  for (int edge = 0; edge < 3; ++edge)
    for (int k = 0; k < 3; ++k) f[edge][k] = dot(normals[k], p[edge + 3] - p[edge]);
  return f;
}

/// Returns whether a quadratic polynomial is above `least` in [0, 1], by its Bernstein coefficients.
bool is_above(const std::array<double, 3>& f, double least) {
  const double a = f[0] - least, b = f[1] - least, c = f[2] - least;
  return a > 0 && c > 0 && (b >= 0 || b * b < a * c);
}

/// Kinds of defects, with the number and the place of the first one.
class Defects {
 public:
  void add(const std::string& kind, const Vec3& place) {
    const auto known = std::ranges::find(all_, kind, &Defect::kind);
    if (known == all_.end())
      all_.push_back({kind, 1, place});
    else
      ++known->count;
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const auto& [kind, count, place] : all_)
      lines.push_back(fmt::format("{}: {}, the first at {}", kind, count, show_point(place)));
    return lines;
  }

 private:
  struct Defect {
    std::string kind;
    int count;
    Vec3 place;
  };
  std::vector<Defect> all_;
};

Vec3 middle(const Mesh& mesh, std::span<const int> nodes) {
  Vec3 sum;
  for (const int v : nodes) sum = sum + mesh.points[v];
  return 1.0 / static_cast<double>(nodes.size()) * sum;
}

/// The nodes of a side without the -1 of triangles.
std::span<const int> nodes_in(const std::array<int, 4>& side) { return {side.data(), side[3] < 0 ? 3u : 4u}; }

/// A side of a cell, or a face of the mesh.
struct Side {
  std::array<int, 4> key, nodes;
  bool is_face;
};

/// Returns all sides by their nodes, with sides of cells first.
std::vector<Side> sides_and_faces(const Mesh& mesh) {
  std::vector<Side> all;
  for (std::size_t i = 0; i < n_solids(mesh); ++i) {
    const Solid cell = solid_at(mesh, i);
    for (int s = 0; s < static_cast<int>(cell.shape->sides.size()); ++s)
      all.push_back({side_key(cell.side(s)), cell.side(s), false});
  }
  for (const auto& v : mesh.triangles) all.push_back({side_key(v), {v[0], v[1], v[2], -1}, true});
  for (const auto& v : mesh.quads) all.push_back({side_key(v), v, true});
  std::ranges::stable_sort(all, {}, &Side::key);
  return all;
}

/// Finds defects of the topology. Returns the faces of the mesh that are sides of one cell.
std::vector<std::array<int, 4>> check_sides(const Mesh& mesh, Defects& defects) {
  const std::vector<Side> all = sides_and_faces(mesh);
  std::vector<std::array<int, 4>> skin;
  for (auto side = all.begin(), end = side; side != all.end(); side = end) {
    end = std::find_if(side, all.end(), [&](const Side& other) { return other.key != side->key; });
    const auto face = std::find_if(side, end, [](const Side& other) { return other.is_face; });
    const auto report = [&](const char* kind) { defects.add(kind, middle(mesh, nodes_in(side->nodes))); };
    if (face - side == 0) report("faces of the mesh that are no sides of cells");
    if (face - side > 2) report("sides of three cells or more");
    if (end - face > 1) report("faces of the mesh that are there twice");
    if (face - side == 2) {
      std::array<int, 4> other = side[1].nodes;
      std::reverse(other.begin(), other.begin() + (other[3] < 0 ? 3 : 4));
      if (!same_turn(side->nodes, other))
        report("sides of two cells that have other orders of corners there");
    }
    if (face - side == 1 && face == end) report("sides of one cell that are no faces of the mesh");
    if (face - side == 1 && face != end) {
      skin.push_back(face->nodes);
      if (!same_turn(side->nodes, face->nodes)) report("faces of the mesh that do not look outwards");
    }
  }
  return skin;
}

/// Three corners of a quad that are a triangle's, too.
void check_hanging(const Mesh& mesh, const std::vector<std::array<int, 4>>& skin, Defects& defects) {
  std::vector<std::array<int, 4>> parts;
  for (const auto& side : skin)
    for (int left_out = 0; left_out < 4 && side[3] >= 0; ++left_out) {
      std::array<int, 4> part = side;
      part[left_out] = -1;
      parts.push_back(side_key(part));
    }
  std::ranges::sort(parts);
  for (const auto& side : skin)
    if (side[3] < 0 && std::ranges::binary_search(parts, side_key(side)))
      defects.add("triangles that meet a quad", middle(mesh, nodes_in(side)));
}

struct CellMeasure {
  double jacobian, volume;
  bool is_proven;
};

std::vector<CellMeasure> measure_all(const Mesh& mesh) {
  std::vector<CellMeasure> all;
  for_each_shape(mesh, [&](const SolidShape&, const auto& cells, const auto&) {
    const std::size_t first = all.size();
    all.resize(first + cells.size());
    parallel_ranges(cells.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto at = corners_of(mesh.points, cells[i]);
        all[first + i] = {scaled_jacobian(at), signed_volume(at), is_positive(at)};
      }
    });
  });
  return all;
}

/// Returns the volume inside of bilinear quads and triangles that look outwards.
double volume_inside(const Mesh& mesh, const std::vector<std::array<int, 4>>& skin, const Vec3& from) {
  double sum = 0;
  for (const auto& [a, b, c, d] : skin) {
    const auto& p = mesh.points;
    sum += d < 0 ? signed_volume(std::array{p[a], p[c], p[b], from})
                 : signed_volume(std::array{p[a], p[d], p[c], p[b], from});
  }
  return sum;
}

}  // namespace

double scaled_jacobian(std::span<const Vec3> at) {
  const auto [corners, factor] = table_of(at.size());
  double least = 1;
  for (const CornerEdges& c : corners) {
    std::array<Vec3, 3> edge;
    for (int j = 0; j < 3; ++j) {
      edge[j] = at[c[j + 1]] - at[c[0]];
      const double length = norm(edge[j]);
      if (length > 0) edge[j] = (1 / length) * edge[j];
    }
    least = std::min(least, factor * triple(edge[0], edge[1], edge[2]));
  }
  return least;
}

double signed_volume(std::span<const Vec3> at) {
  double sum = 0;
  if (at.size() == 8) {
    constexpr std::array kWeights = {1.0 / 6, 4.0 / 6, 1.0 / 6};  // Simpson's, exact up to degree 3
    const Values27 values = jacobian_values(at);
    for (int k = 0; k < 27; ++k) sum += kWeights[k % 3] * kWeights[k / 3 % 3] * kWeights[k / 9] * values[k];
    return sum;
  }
  if (at.size() == 6) {
    for (const auto& f : prism_coefficients(at)) sum += (f[0] + f[1] + f[2]) / 18;
    return sum;
  }
  if (at.size() == 4) return determinant(at, kTetCornerEdges[0]) / 6;
  for (const CornerEdges& c : kPyramidCornerEdges) sum += determinant(at, c) / 12;
  return sum;
}

bool is_positive(std::span<const Vec3> at) {
  if (!(scaled_jacobian(at) > kLeastCellJacobian)) return false;
  if (at.size() < 6) return true;  // the corners have the least values
  double scale = 0;
  for (const CornerEdges& c : table_of(at.size()).corners) {
    double product = 1;
    for (int j = 1; j < 4; ++j) product *= norm(at[c[j]] - at[c[0]]);
    scale = std::max(scale, product);
  }
  const double least = kLeastCellJacobian * scale;
  if (at.size() == 8) return is_above(bernstein(jacobian_values(at)), least, 0);
  return std::ranges::all_of(prism_coefficients(at), [&](const auto& f) { return is_above(f, least); });
}

CellMeasures measure(const Mesh& mesh) {
  const std::vector<CellMeasure> all = measure_all(mesh);
  CellMeasures measures;
  measures.name = "cells";
  const auto add = [](ShapeMeasures& to, const CellMeasure& cell) {
    to.least_jacobian = to.count++ == 0 ? cell.jacobian : std::min(to.least_jacobian, cell.jacobian);
    to.mean_jacobian += cell.jacobian;
    to.volume += cell.volume;
    to.unproven += cell.is_proven ? 0 : 1;
  };
  std::size_t i = 0;
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& cells, const auto&) {
    if (cells.empty()) return;
    ShapeMeasures& of_shape = measures.shapes.emplace_back();
    of_shape.name = shape.plural;
    for (const std::size_t end = i + cells.size(); i < end; ++i) {
      add(of_shape, all[i]);
      add(measures, all[i]);
      measures.jacobian.push_back(all[i].jacobian);
    }
    of_shape.mean_jacobian /= static_cast<double>(of_shape.count);
  });
  if (measures.count > 0) measures.mean_jacobian /= static_cast<double>(measures.count);
  return measures;
}

std::vector<std::string> defects_of_cells(const Mesh& mesh) {
  try {
    require_readable(mesh, "the mesh");
  } catch (const InputError& error) {
    return {error.what()};
  }
  if (!is_solid(mesh)) return {"the mesh has no cells"};
  constexpr double kRounding = 1e-9;  // of the volume
  Defects defects;
  const std::vector<CellMeasure> all = measure_all(mesh);
  double volume = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Solid cell = solid_at(mesh, i);
    volume += all[i].volume;
    std::vector<int> nodes(cell.nodes.begin(), cell.nodes.end());
    std::ranges::sort(nodes);
    if (std::ranges::adjacent_find(nodes) != nodes.end())
      defects.add(fmt::format("{} with a corner twice", cell.shape->plural), middle(mesh, cell.nodes));
    else if (!all[i].is_proven)
      defects.add(fmt::format("{} that are not proven to be positive", cell.shape->plural),
                  middle(mesh, cell.nodes));
  }
  const std::vector<std::array<int, 4>> skin = check_sides(mesh, defects);
  check_hanging(mesh, skin, defects);
  std::vector<std::string> lines = defects.lines();
  const double inside = volume_inside(mesh, skin, mesh.points[mesh.quads.empty() ? 0 : mesh.quads[0][0]]);
  if (!(std::abs(volume - inside) <= kRounding * std::abs(inside)))
    lines.push_back(
        fmt::format("volume: cells have {:.12g}, but {:.12g} lie inside of the skin", volume, inside));
  return lines;
}

}  // namespace delquad
