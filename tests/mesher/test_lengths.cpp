// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Polygon = std::vector<Vec2>;

/// A square plate with holes in rows of n, nothing of it narrow.
MeshProblem plate(int n, double size) {
  std::vector<Polygon> loops{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const double radius = 0.2 / n;
  const int sides = std::max(8, static_cast<int>(std::round(2 * std::numbers::pi * radius / size)));
  for (int i = 0; i < n * n; ++i) {
    Polygon& hole = loops.emplace_back();
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      hole.push_back({(i % n + 0.5) / n + radius * std::cos(angle),
                      (static_cast<double>(i / n) + 0.5) / n + radius * std::sin(angle)});
    }
  }
  return problem_of(polygons(loops), size);
}

/// How many quads have a side that is shorter or longer than engineers ask for: 0.33 to 1.75 of the size.
int beyond_lengths(const Mesh& mesh, double size) {
  return static_cast<int>(std::ranges::count_if(mesh.quads, [&](const auto& quad) {
    for (int k = 0; k < 4; ++k) {
      const double length = norm(mesh.points[quad[(k + 1) % 4]] - mesh.points[quad[k]]);
      if (length < 0.33 * size || length > 1.75 * size) return true;
    }
    return false;
  }));
}

/// Optimization gains angles without losing lengths.
TEST(Lengths, AreKeptByOptimisation) {
  constexpr double kLength = 0.02;
  for (const std::string word : {"DBO", "DBCO", "DBCQO", "PBO"}) {
    const Mesh quads = mesh(plate(4, kLength), word).mesh;
    EXPECT_LE(beyond_lengths(quads, kLength), 0.002 * static_cast<double>(quads.quads.size())) << word;
  }
}

}  // namespace
}  // namespace delquad
