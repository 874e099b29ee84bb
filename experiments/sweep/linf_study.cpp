#include "experiments/sweep/linf_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "algorithms/insertion/linf_delaunay.h"
#include "delquad/error.h"
#include "experiments/console/interrupt.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

constexpr int kMostDrawn = 2000;  // points; beyond, a picture shows nothing

struct Distribution {
  const char* name;
  double jitter;  ///< of a grid's nodes, in grid steps; 0: no grid, uniform at random
};
constexpr Distribution kDistributions[] = {{"even", 0.6}, {"random", 0}};

/// n points of the unit square. Own scaling of the engine's bits: the same points on every platform.
std::vector<Vec2> make_points(int n, int seed, const Distribution& distribution) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(seed));
  const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  const int columns = static_cast<int>(std::ceil(std::sqrt(double(n))));
  std::vector<Vec2> points;
  for (int k = 0; k < n; ++k) {
    const double u = uniform(), v = uniform();
    if (distribution.jitter > 0)
      points.push_back({(k % columns + 0.5 + distribution.jitter * (u - 0.5)) / columns,
                        (k / columns + 0.5 + distribution.jitter * (v - 0.5)) / columns});
    else
      points.push_back({u, v});
  }
  return points;
}

void draw(const std::filesystem::path& path, const std::vector<Vec2>& points,
          const LinfDelaunayComparison& edges) {
  constexpr double kSide = 800, kMargin = 20;
  const auto path_of = [&](const std::vector<std::array<int, 2>>& list, const char* colour, double width) {
    std::string d;
    for (const auto& [a, b] : list)
      d += fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}", kMargin + kSide * points[a].x,
                       kMargin + kSide * (1 - points[a].y), kMargin + kSide * points[b].x,
                       kMargin + kSide * (1 - points[b].y));
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", d, colour,
                       width);
  };
  const double full = kSide + 2 * kMargin;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      full, full + kMargin);
  svg += path_of(edges.both, "#888888", 0.8) + path_of(edges.only_l2, "#1f6fb4", 2) +
         path_of(edges.only_linf, "#d1495b", 2);
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" font-family=\"sans-serif\" font-size=\"14\">{} edges in both (grey), {} in L2 "
      "alone "
      "(blue), {} in L-infinity alone (red)</text>\n</svg>\n",
      kMargin, full + 4, edges.both.size(), edges.only_l2.size(), edges.only_linf.size());
  write_text_file(path, svg);
}

TableRow compare(int n, int seed, const Distribution& distribution, const std::filesystem::path& folder) {
  const std::vector<Vec2> points = make_points(n, seed, distribution);
  const LinfDelaunayComparison edges = compare_linf_delaunay(points);
  const double both = static_cast<double>(edges.both.size()), l2 = static_cast<double>(edges.only_l2.size());
  TableRow row{fmt::format("{} {}", n, distribution.name), fmt::format("seed {}", seed), {}, {}, "", ""};
  if (n <= kMostDrawn) try {
      const Uninterrupted whole;
      draw(folder / fmt::format("{}-{}-{}.svg", n, distribution.name, seed), points, edges);
    } catch (const InputError& error) {
      row.failure = error.what();
    }
  row.values = {{"both", both},
                {"only_l2", l2},
                {"only_linf", static_cast<double>(edges.only_linf.size())},
                {"percent_common", 100 * both / std::max(1.0, both + l2)}};
  return row;
}

}  // namespace

int linf_study_steps(const LinfStudy& study) {
  return static_cast<int>(study.points.size() * study.seeds.size() * std::size(kDistributions));
}

Table run_linf_study(const LinfStudy& study, const std::string& title, const std::filesystem::path& folder,
                     Progress& progress) {
  Table table;
  table.title = title;
  table.group_title = "points";
  table.name_title = "seed";
  table.columns = {{"both", "edges in both", 0},
                   {"only_l2", "L2 alone", 0},
                   {"only_linf", "L-infinity alone", 0},
                   {"percent_common", "% of L2 in both", 1}};
  for (const Distribution& distribution : kDistributions)
    for (const int n : study.points)
      for (const int seed : study.seeds) {
        progress.step(fmt::format("{} {} points, seed {}", n, distribution.name, seed));
        table.rows.push_back(compare(n, seed, distribution, folder));
      }
  table.notes = {
      "'even': nodes of a square grid, each moved at random by up to 0.3 of the step; 'random': uniform.",
      "The paper reports five edge swaps between the two triangulations of its Figure 15, whose points it "
      "does not give.",
      "Edges between two points of the convex hull are left out."};
  return table;
}

}  // namespace delquad
