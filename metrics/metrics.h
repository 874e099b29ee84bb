#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "fields/size_field.h"
#include "mesh/mesh.h"

namespace delquad {

enum class Better { kHigher, kLower, kNeither };

struct Metric {
  std::string key;    ///< in records and options: "eta_mean"
  std::string title;  ///< in tables: "eta mean"
  std::string unit;   ///< "", "%", "deg", "s"
  Better better;
  double worst;        ///< value of the worst possible mesh (NaN where neither is better)
  std::string source;  ///< paper section and equation, or where else it is defined
};

/// Every measure, in table order.
std::span<const Metric> metric_registry();

struct Histogram {
  double low = 0, high = 1;
  std::vector<long long> counts;
};

struct MeshMetrics {
  /// By key; NaN where a measure is not defined (eta of a mesh without quads; tau without a size field).
  std::map<std::string, double> values;
  Histogram eta;                      ///< [0, 1], 20 bins
  Histogram angle;                    ///< degrees, [0, 360], 36 bins
  std::map<int, long long> valences;  ///< interior vertices by number of incident elements
};

/// Measures of a mesh in space [paper, section 6]. `size` may be null: then tau and what else is measured
/// against it are NaN. `given`: the size as it was asked for, where `size` is what was made of it; null: they
/// are the same.
/// Works on triangle meshes, quad meshes and mixtures; eta is over quads only, percent quads says what that
/// leaves out.
MeshMetrics evaluate_metrics(const Mesh& mesh, const SizeField* size, const SizeField* given = nullptr);

/// eta of one quad in space, equation (4): 1 for a square, 0 with an angle <= 0 or >= 180 degrees. `normal`
/// is the side from which the quad must run counterclockwise; a reflex or inverted corner gives 0.
double quad_eta(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& normal);
/// eta of each quad of the mesh.
std::vector<double> quad_etas(const Mesh& mesh);
/// eta of a quad of the plane.
double quad_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

}  // namespace delquad
