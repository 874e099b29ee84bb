// SPDX-License-Identifier: GPL-3.0-or-later
// Figure 15 of the paper: the L-infinity and the L2 Delaunay triangulation of the same points. It writes a
// table to the folder that it is given, and pictures of the smaller sets.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "algorithms/insertion/linf_delaunay.h"
#include "io/mesh_io.h"

namespace {

using delquad::Vec2;

/// Points of the unit square: uniform at random, or near the nodes of a grid. Own scaling of the engine's
/// bits makes the same points on every platform.
std::vector<Vec2> make_points(int n, int seed, bool is_even) {
  constexpr double kJitter = 0.6;  // grid steps
  std::mt19937_64 engine(static_cast<std::uint64_t>(seed));
  const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  const int columns = static_cast<int>(std::ceil(std::sqrt(double(n))));
  std::vector<Vec2> points;
  for (int k = 0; k < n; ++k) {
    const double u = uniform(), v = uniform();
    if (is_even)
      points.push_back({(k % columns + 0.5 + kJitter * (u - 0.5)) / columns,
                        (k / columns + 0.5 + kJitter * (v - 0.5)) / columns});
    else
      points.push_back({u, v});
  }
  return points;
}

/// Edges in both are gray, in L2 alone blue, in L-infinity alone red.
void draw(const std::filesystem::path& file, const std::vector<Vec2>& points,
          const delquad::LinfDelaunayComparison& edges) {
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-20 -20 840 840\">\n";
  const auto add = [&](const std::vector<std::array<int, 2>>& list, const char* color, double width) {
    svg += fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" d=\"", color, width);
    for (const auto& [a, b] : list)
      svg += fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}", 800 * points[a].x, 800 - 800 * points[a].y,
                         800 * points[b].x, 800 - 800 * points[b].y);
    svg += "\"/>\n";
  };
  add(edges.both, "#888888", 0.8);
  add(edges.only_l2, "#1f6fb4", 2);
  add(edges.only_linf, "#d1495b", 2);
  delquad::write_text_file(file, svg + "</svg>\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return fmt::print(stderr, "error: expected a folder\n"), 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  std::string table =
      "# Figure 15: L-infinity against L2 Delaunay triangulations\n\n"
      "| points | seed | edges in both | L2 alone | L-infinity alone | % of L2 in both |\n"
      "|---|---:|---:|---:|---:|---:|\n";
  for (const bool is_even : {true, false})
    for (const int n : {100, 1000, 10000})
      for (const int seed : {1, 2, 3}) {
        const std::vector<Vec2> points = make_points(n, seed, is_even);
        const delquad::LinfDelaunayComparison edges = delquad::compare_linf_delaunay(points);
        const std::string kind = is_even ? "even" : "random";
        const auto both = static_cast<double>(edges.both.size());
        table += fmt::format("| {} {} | {} | {} | {} | {} | {:.1f} |\n", n, kind, seed, both,
                             edges.only_l2.size(), edges.only_linf.size(),
                             100 * both / (both + static_cast<double>(edges.only_l2.size())));
        if (n <= 1000) draw(folder / fmt::format("{}-{}-{}.svg", n, kind, seed), points, edges);
      }
  for (const char* note :
       {"The even points are nodes of a square grid. Each is moved at random by up to 0.3 of the step.",
        "The paper reports five edge swaps in its Figure 15, whose points it does not give.",
        "Edges between two points of the convex hull are left out."})
    table += fmt::format("\n{}\n", note);
  delquad::write_text_file(folder / "table.md", table);
}
