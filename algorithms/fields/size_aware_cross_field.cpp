// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/size_aware_cross_field.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numeric>

#include "algorithms/fields/cross_diffusion.h"
#include "algorithms/fields/laplace.h"
#include "algorithms/fields/sample_triangle.h"
#include "algorithms/fields/singularities.h"
#include "base/cancel.h"
#include "delquad/mesh.h"

namespace delquad {

namespace {

/// Turning of crosses along a grid with edges of length delta.
///
/// A frame follows a grid of squares of side delta exactly when it is parallel in the metric
/// |du|^2/delta^2: grad theta = J grad log delta, J turning by a quarter counterclockwise. Here log delta is
/// linear on each triangle of a background mesh.
class SizeConnection {
 public:
  SizeConnection(const TriPatch& tri, const ParametricSize& size);

  double log_size(int vertex) const { return log_size_[vertex]; }
  /// Returns grad log delta in a triangle.
  Vec2 gradient(int t) const { return gradient_[t]; }
  /// Returns the turn of theta (radians) of a parallel cross along d, inside triangle t.
  double turn(int t, Vec2 d) const { return cross(gradient_[t], d); }
  /// Returns the turn of 4 theta (radians) from each centroid to the middles of the sides, opposite to each
  /// vertex.
  const std::vector<std::array<double, 3>>& phase_turns() const { return phase_turns_; }

 private:
  std::vector<double> log_size_;
  std::vector<Vec2> gradient_;
  std::vector<std::array<double, 3>> phase_turns_;
};

SizeConnection::SizeConnection(const TriPatch& tri, const ParametricSize& size) {
  int hint = -1;
  for (const Vec2 u : tri.points) log_size_.push_back(std::log(size.at(u, hint)));
  gradient_.reserve(tri.triangles.size());
  phase_turns_.reserve(tri.triangles.size());
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    const Corners x = corners_of(tri, v), middle = middles(x);
    gradient_.push_back(slope(x, {log_size_[v[0]], log_size_[v[1]], log_size_[v[2]]}));
    const Vec2 centroid = (1.0 / 3) * (x[0] + x[1] + x[2]);
    auto& turns = phase_turns_.emplace_back();
    for (int k = 0; k < 3; ++k) turns[k] = 4 * turn(static_cast<int>(t), middle[k] - centroid);
  }
}

/// Times of diffusion, in elements (pairs of triangles) of the background mesh, from the first step to the
/// last: the singularities find their places first within their neighborhood, then to an element.
constexpr double kLongest = 1600, kShortest = 2;
constexpr int kSteps = 10;
/// Relative residual of each step. Its result is brought back to unit length, and only the last step's result
/// stays. On patches that hang together it holds for all but the last step: these hardly differ by it but
/// take twice the time.
constexpr double kTolerance = 1e-4, kRoughTolerance = 1e-2;

using Complex = std::complex<double>;

Complex to_complex(Cross z) { return {z.c, z.s}; }
Complex unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
Complex normalised(Complex z, Complex instead) {
  const double length = std::abs(z);
  return length > 0 ? z / length : instead;
}

double twice_area(const TriPatch& tri, const std::array<int, 3>& v) {
  return cross(tri.points[v[1]] - tri.points[v[0]], tri.points[v[2]] - tri.points[v[0]]);
}

/// Returns the start field in the middles of all sides, of unit length; tangents on the boundary.
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

/// Returns the mean of 1/delta over a triangle.
double mean_per_length(const SizeConnection& connection, const std::array<int, 3>& v) {
  double sum = 0;
  for (const int i : v) sum += std::exp(-connection.log_size(i)) / 3;
  return sum;
}

/// Returns the number of rows of quads that must end because delta varies, if crosses do not turn.
double dislocations_of_size(const TriPatch& tri, const SizeConnection& connection) {
  double sum = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    sum += twice_area(tri, v) / 2 * norm(connection.gradient(static_cast<int>(t))) *
           mean_per_length(connection, v);
  }
  return sum;
}

/// Unknowns of several patches, joined at seams.
class Unknowns {
 public:
  Unknowns(const std::vector<FieldPatch>& patches, const std::vector<SizeConnection>& connections) {
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const BackgroundMesh& background = *patches[p].background;
      const TriPatch& tri = background.triangles();
      const Sides sides = number_sides(tri);
      const std::vector<Complex> own = sample_sides(background, sides, *patches[p].start);
      std::vector<int> unknown(sides.count);
      std::iota(unknown.begin(), unknown.end(), static_cast<int>(z.size()));
      z.insert(z.end(), own.begin(), own.end());
      alignment.resize(z.size(), 0);
      for (std::size_t t = 0; t < tri.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
          if (tri.neighbours[t][k] < 0) alignment[unknown[sides.of_triangle[t][k]]] = CrossDiffusion::kGiven;
      of_patch.push_back(
          {&tri, sides, unknown, std::vector<double>(sides.count, 0), &connections[p].phase_turns()});
      if (patches[p].pull) pull(patches[p].pull, connections[p], of_patch.back());
    }
  }

  /// Gives both sides the unknown of the first; the second one's own is no longer used.
  void join(const FieldSeam& seam) {
    int shared = -1;
    for (const FieldSeam::Side& side : seam.sides) {
      PatchUnknowns& own = of_patch[side.patch];
      const auto& v = own.tri->triangles[side.triangle];
      const Vec2 along =
          own.tri->points[v[(side.opposite + 2) % 3]] - own.tri->points[v[(side.opposite + 1) % 3]];
      const int number = own.sides.of_triangle[side.triangle][side.opposite];
      if (shared < 0) shared = own.unknown[number];
      own.unknown[number] = shared;
      own.direction[number] = 4 * std::atan2(along.y, along.x);
    }
    z[shared] = 1;
    alignment[shared] = seam.alignment;
  }

  /// Counts unknowns of inner sides from the direction that draws them.
  void pull(const CrossPullAt& pull_at, const SizeConnection& connection, PatchUnknowns& own) {
    const TriPatch& tri = *own.tri;
    int hint = -1;
    std::vector<char> is_turned(own.direction.size(), 0);
    for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
      const auto& v = tri.triangles[t];
      const Corners middle = middles(corners_of(tri, v));
      const double per_length = mean_per_length(connection, v);
      for (int k = 0; k < 3; ++k) {
        if (tri.neighbours[t][k] < 0) continue;
        const int side = own.sides.of_triangle[t][k];
        const CrossPull pull = pull_at(middle[k], hint);
        alignment[own.unknown[side]] += pull.strength * twice_area(tri, v) / 6 * per_length * per_length;
        if (std::exchange(is_turned[side], 1) != 0) continue;
        own.direction[side] = std::arg(to_complex(pull.cross));
        z[own.unknown[side]] *= unit(-own.direction[side]);
      }
    }
  }

  /// Returns the crosses of a patch in its parameter plane, by side.
  std::vector<Cross> crosses(std::size_t patch) const {
    const PatchUnknowns& own = of_patch[patch];
    std::vector<Cross> crosses;
    crosses.reserve(own.unknown.size());
    for (std::size_t i = 0; i < own.unknown.size(); ++i) {
      Complex value = z[own.unknown[i]];
      if (own.direction[i] != 0) value *= unit(own.direction[i]);
      crosses.push_back({value.real(), value.imag()});
    }
    return crosses;
  }

  std::vector<PatchUnknowns> of_patch;
  std::vector<double> alignment;
  std::vector<Complex> z;
};

/// Returns the joined vertices at the ends of seams, each once.
std::vector<JoinedVertices> joined_vertices(const std::vector<FieldPatch>& patches,
                                            const std::vector<FieldSeam>& seams) {
  using Vertex = std::array<int, 2>;
  std::map<Vertex, Vertex> parent;
  const auto root = [&](Vertex v) {
    while (parent.try_emplace(v, v).first->second != v) v = parent[v];
    return v;
  };
  const auto ends = [&](const FieldSeam::Side& side) {
    const auto& v = patches[side.patch].background->triangles().triangles[side.triangle];
    return std::array{Vertex{side.patch, v[(side.opposite + 1) % 3]},
                      Vertex{side.patch, v[(side.opposite + 2) % 3]}};
  };
  for (const FieldSeam& seam : seams) {
    const auto one = ends(seam.sides[0]), other = ends(seam.sides[1]);
    for (int i = 0; i < 2; ++i) {
      const auto [low, high] = std::minmax({root(one[i]), root(other[1 - i])});
      parent[high] = low;
    }
  }
  std::map<Vertex, JoinedVertices> joined;
  for (const auto& [v, _] : parent) joined[root(v)].vertices.push_back(v);
  for (const FieldSeam& seam : seams)
    for (const Vertex& v : ends(seam.sides[0])) ++joined[root(v)].n_shared;
  std::vector<JoinedVertices> all;
  for (auto& [_, j] : joined) all.push_back(std::move(j));
  return all;
}

/// Returns the topology of each patch, with the sums over all patches.
std::vector<FieldTopology> find_topologies(const std::vector<FieldPatch>& patches,
                                           const std::vector<FieldSeam>& seams,
                                           const std::vector<SizeConnection>& connections,
                                           const Unknowns& unknowns) {
  std::vector<FieldWinding> windings;
  for (std::size_t p = 0; p < patches.size(); ++p)
    windings.push_back(find_winding(*patches[p].background, unknowns.of_patch[p].sides, unknowns.crosses(p),
                                    connections[p].phase_turns()));
  const std::vector<JoinedVertices> joined = joined_vertices(patches, seams);
  join_windings(joined, windings);
  std::vector<FieldTopology> topologies;
  int index_sum = 0, euler_characteristic = static_cast<int>(seams.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    topologies.push_back(find_singularities(*patches[p].background, unknowns.of_patch[p].sides,
                                            unknowns.crosses(p), windings[p]));
    index_sum += topologies[p].index_sum;
    euler_characteristic += topologies[p].euler_characteristic;
  }
  for (const JoinedVertices& j : joined) euler_characteristic -= static_cast<int>(j.vertices.size()) - 1;
  for (FieldTopology& topology : topologies) {
    topology.index_sum = index_sum;
    topology.euler_characteristic = euler_characteristic;
  }
  return topologies;
}

}  // namespace

struct SizeAwareCrossField::Data {
  std::shared_ptr<const BackgroundMesh> background;
  std::shared_ptr<const CrossField> start;  ///< null if the field is the result of the iteration
  std::vector<Vec2> gradient;               ///< gradient of log delta in each triangle
  /// The crosses of each triangle, carried from the middle of the side opposite to each vertex to the
  /// centroid.
  std::vector<std::array<Complex, 3>> crosses;
};

std::vector<std::shared_ptr<const SizeAwareCrossField>> make_size_aware_fields(
    const std::vector<FieldPatch>& patches, const std::vector<FieldSeam>& seams) {
  std::vector<SizeConnection> connections;
  connections.reserve(patches.size());
  double size_dislocations = 0;
  for (const FieldPatch& patch : patches) {
    connections.emplace_back(patch.background->triangles(), *patch.size);
    size_dislocations += dislocations_of_size(patch.background->triangles(), connections.back());
  }
  Unknowns unknowns(patches, connections);
  for (const FieldSeam& seam : seams) unknowns.join(seam);
  const bool has_pull = std::ranges::any_of(patches, [](const FieldPatch& p) { return bool(p.pull); });
  const bool stays_start = seams.empty() && size_dislocations < 1 && !has_pull;
  if (!stays_start) {
    CrossDiffusion diffusion(unknowns.of_patch, unknowns.alignment, unknowns.z);
    for (int i = 0; i < kSteps; ++i) {
      check_cancelled();
      const bool is_rough = !seams.empty() && i + 1 < kSteps;
      diffusion.step(kLongest * std::pow(kShortest / kLongest, i / (kSteps - 1.0)),
                     is_rough ? kRoughTolerance : kTolerance);
    }
  }

  const std::vector<FieldTopology> topologies = find_topologies(patches, seams, connections, unknowns);
  std::vector<std::shared_ptr<SizeAwareCrossField>> fields;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const PatchUnknowns& own = unknowns.of_patch[p];
    auto data = std::make_shared<SizeAwareCrossField::Data>();
    data->background = patches[p].background;
    if (stays_start) data->start = patches[p].start;
    for (int t = 0; t < static_cast<int>(own.tri->triangles.size()); ++t) {
      data->gradient.push_back(connections[p].gradient(t));
      auto& local = data->crosses.emplace_back();
      for (int k = 0; k < 3; ++k)
        local[k] = unknowns.z[own.unknown[own.sides.of_triangle[t][k]]] * unit(-own.phase(t, k));
    }
    fields.push_back(std::shared_ptr<SizeAwareCrossField>(new SizeAwareCrossField(std::move(data))));
    fields[p]->topology_ = topologies[p];
  }
  return {fields.begin(), fields.end()};
}

SizeAwareCrossField::SizeAwareCrossField(std::shared_ptr<const BackgroundMesh> background,
                                         const ParametricSize& size, std::shared_ptr<const CrossField> start)
    : SizeAwareCrossField(
          *make_size_aware_fields({{std::move(background), &size, std::move(start)}}, {}).front()) {}

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

/// Returns by how much a field turns more than a parallel one in a triangle (radians per length), as a vector
/// in the field's frame.
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
