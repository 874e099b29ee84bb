// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/case_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "io/cases/read_problem.h"
#include "io/digest.h"
#include "metrics/shape.h"

namespace delquad {
namespace {

/// Points of a curve or a surface, with the length or area that each stands for. Polynomials of the fifth
/// degree have the same integral over both.
class Samples3D {
 public:
  void add_segment(const Vec3& a, const Vec3& b) {
    const double length = norm(b - a), off = std::sqrt(0.15);
    for (const auto& [t, weight] : {std::pair(0.5 - off, 5.0), {0.5, 8.0}, {0.5 + off, 5.0}})
      points_.push_back({a + t * (b - a), weight / 18 * length});
  }

  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = norm(cross(b - a, c - a)) / 2, root = std::sqrt(15.0);
    points_.push_back({1.0 / 3 * (a + b + c), 0.225 * area});
    for (const double sign : {-1.0, 1.0}) {
      const double s = (6 + sign * root) / 21, weight = (155 + sign * root) / 1200 * area;
      for (const auto& [p, q, r] : {std::array{a, b, c}, {b, c, a}, {c, a, b}})
        points_.push_back({s * p + s * q + (1 - 2 * s) * r, weight});
    }
    dimension_ = 2;
  }

  /// A segment that may be a chord of a curve.
  void add_chord(const Vec3& a, const Vec3& b) {
    if (a == b) return;
    for (const auto& [from, to] : {std::pair(a, b), {b, a}}) ends_[{from.x, from.y, from.z}].push_back(to);
  }

  /// Two elements of this mean size meet at an angle. If the angle is small, they are taken for chords of a
  /// curve or surface, which is longer or larger than they are.
  void add_turn(double size, double angle) {
    constexpr double kSmooth = 0.55;  // circles of twelve chords turn by 0.52
    if (angle < kSmooth) missing_ += size * angle * angle / 24;
  }

  /// The part of the size that is missing if the elements are chords.
  double chord_error() {
    for (const auto& [point, others] : ends_) {
      if (others.size() != 2) continue;
      const Vec3 at{point[0], point[1], point[2]}, in = at - others[0], out = others[1] - at;
      add_turn((norm(in) + norm(out)) / 2, std::atan2(norm(cross(in, out)), dot(in, out)));
    }
    double total = 0;
    for (const auto& [at, weight] : points_) total += weight;
    return total > 0 ? missing_ / total : 0;
  }

  /// Its dimension and size, and invariants of its moments up to the fifth, in radii of gyration.
  std::vector<double> invariants() const {
    Vec3 centre{0, 0, 0};
    double total = 0, square = 0;
    for (const auto& [at, weight] : points_) total += weight, centre = centre + weight * at;
    if (!(total > 0)) return {};
    centre = (1 / total) * centre;
    for (const auto& [at, weight] : points_) square += weight * dot(at - centre, at - centre);
    const double radius = std::sqrt(square / total);
    std::array<double, 3> v{}, w{};
    std::array<double, 9> s{}, q{};
    std::array<double, 27> t{};
    double fourth = 0;
    for (const auto& [at, weight] : points_) {
      const Vec3 p = (1 / radius) * (at - centre);
      const double x[] = {p.x, p.y, p.z}, r = dot(p, p), part = weight / total;
      fourth += part * r * r;
      for (std::size_t i = 0; i < 3; ++i) {
        v[i] += part * r * x[i];
        w[i] += part * r * r * x[i];
        for (std::size_t j = 0; j < 3; ++j) {
          s[3 * i + j] += part * x[i] * x[j];
          q[3 * i + j] += part * r * x[i] * x[j];
          for (std::size_t k = 0; k < 3; ++k) t[9 * i + 3 * j + k] += part * x[i] * x[j] * x[k];
        }
      }
    }
    const auto length = [](const auto& tensor) {
      double sum = 0;
      for (const double value : tensor) sum += value * value;
      return std::sqrt(sum);
    };
    double vw = 0, vsv = 0, sq = 0, sss = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      vw += v[i] * w[i];
      for (std::size_t j = 0; j < 3; ++j) {
        vsv += v[i] * s[3 * i + j] * v[j];
        sq += s[3 * i + j] * q[3 * i + j];
        for (std::size_t k = 0; k < 3; ++k) sss += s[3 * i + j] * s[3 * j + k] * s[3 * k + i];
      }
    }
    return {double(dimension_),
            total / std::pow(radius, dimension_),
            length(s),
            sss,
            length(v),
            length(t),
            fourth,
            length(q),
            sq,
            length(w),
            std::cbrt(vw),
            std::cbrt(vsv)};
  }

 private:
  struct Point {
    Vec3 at;
    double weight;
  };
  std::vector<Point> points_;
  std::map<std::array<double, 3>, std::vector<Vec3>> ends_;  ///< of chords, by point the others
  double missing_ = 0;
  int dimension_ = 1;
};

void add(const PlanarModel& model, Samples3D& samples) {
  constexpr int kAll = 20'000, kFewest = 16, kMost = 2000;  // of a circle: lengths to 1e-6
  const int of_curve = std::clamp(kAll / std::max(1, static_cast<int>(model.curves.size())), kFewest, kMost);
  for (const ModelCurve& curve : model.curves) {
    const auto point = [&](double t) {
      const Vec2 p = curve.shape->point(t);
      return Vec3{p.x, p.y, 0};
    };
    std::vector<double> at = curve.shape->fixed_parameters();
    at.insert(at.begin(), 0);
    at.push_back(1);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      const Vec3 a = point(at[k]), b = point(at[k + 1]), middle = point((at[k] + at[k + 1]) / 2);
      constexpr double kStraight = 1e-9;
      if (norm(middle - 0.5 * (a + b)) <= kStraight * norm(b - a)) samples.add_chord(a, b);
    }
    for (int k = 0; k <= of_curve; ++k) at.push_back(static_cast<double>(k) / of_curve);
    std::ranges::sort(at);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) samples.add_segment(point(at[k]), point(at[k + 1]));
  }
}

/// Elements, or of flat ones the outline.
void add(const Mesh& mesh, Samples3D& samples) {
  const auto& p = mesh.points;
  const bool is_flat = std::ranges::all_of(p, [&](const Vec3& x) { return x.z == p[0].z; });
  const auto add_line = [&](int a, int b) {
    samples.add_segment(p[a], p[b]);
    samples.add_chord(p[a], p[b]);
  };
  if (mesh.triangles.empty() && mesh.quads.empty())
    for (const auto& line : mesh.lines) add_line(line[0], line[1]);
  else if (is_flat)
    for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
      if (edge.size() == 1) add_line(edge[0].lo, edge[0].hi);
    });
  else {
    std::vector<Vec3> areas;
    for_each_element(mesh, [&](int, const auto& v) {
      for (std::size_t k = 2; k < v.size(); ++k) samples.add_triangle(p[v[0]], p[v[k - 1]], p[v[k]]);
      areas.push_back(0.5 * area_vector(corners_of(mesh, v)));
    });
    for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2) return;
      const Vec3& a = areas[edge[0].element];
      const Vec3 b = (edge[0].forward == edge[1].forward ? -1.0 : 1.0) * areas[edge[1].element];
      samples.add_turn((norm(a) + norm(b)) / 2, std::atan2(norm(cross(a, b)), dot(a, b)));
    });
  }
}

/// Leaves out the header of STEP, which has names and dates.
std::string digest_of_cad(const std::filesystem::path& file) {
  const std::string bytes = file_bytes(file);
  const auto data = bytes.find("DATA;");
  const bool is_step = bytes.starts_with("ISO-10303-21") && data != std::string::npos;
  return digest(is_step ? std::string_view(bytes).substr(data) : bytes);
}

}  // namespace

CaseGeometry geometry_of(const Case& c) {
  CaseGeometry geometry{c.domain, "", {}};
  if (const std::string example = example_of(c); !example.empty())
    geometry.digest = digest("example " + example);
  else
    try {
      MeshProblem problem;
      problem.model = c.model;
      problem.keep_going = true;
      problem = read_files(std::move(problem));
      Samples3D samples;
      if (const auto* planar = std::get_if<PlanarModel>(&problem.model)) add(*planar, samples);
      if (const auto* lines = std::get_if<LineModel>(&problem.model)) add(lines->mesh, samples);
      if (const auto* triangles = std::get_if<TriangleModel>(&problem.model)) add(triangles->mesh, samples);
      if (const auto* given = std::get_if<GivenMesh>(&problem.model)) add(given->mesh, samples);
      if (const auto* cad = std::get_if<CadModel>(&problem.model)) geometry.digest = digest_of_cad(cad->file);
      geometry.shape = samples.invariants();
      geometry.chord_error = samples.chord_error();
    } catch (const InputError&) {  // as its cells will say
    }
  return geometry;
}

}  // namespace delquad
