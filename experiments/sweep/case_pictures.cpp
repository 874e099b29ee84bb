#include "experiments/sweep/case_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/box.h"
#include "io/curve_plot.h"
#include "io/picture.h"
#include "metrics/metrics.h"

namespace delquad {
namespace {

constexpr int kFewestAcross = 44, kMostAcross = 160;  // crosses along the longer side of the domain
constexpr int kSamplesAcross = 120;

/// The field at the nodes of a regular grid that lie inside the domain.
std::vector<CrossGlyph> sample_crosses(const Prepared& p) {
  const Box<Vec3> box = Box<Vec3>::around(std::span(p->boundary.points));
  const Vec2 low{box.low.x, box.low.y}, high{box.high.x, box.high.y};
  const double detail = std::sqrt(static_cast<double>(p->boundary.points.size()));
  const int across = std::clamp(static_cast<int>(detail), kFewestAcross, kMostAcross);
  const double step = std::max(high.x - low.x, high.y - low.y) / across;
  std::vector<CrossGlyph> glyphs;
  int where = -1;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const Vec2 u = low + Vec2{(i + 0.5) * step, (j + 0.5) * step};
      if (u.x > high.x || u.y > high.y) continue;
      if (const auto cross = p.cross_at(u, where)) glyphs.push_back({u, cross->angle(), 0.8 * step});
    }
  return glyphs;
}

/// Cuts each edge that is longer than `step` in the middle, until there are none; the mesh stays conforming.
void refine(std::vector<Vec2>& points, std::vector<std::array<int, 3>>& triangles, double step) {
  for (bool changed = true; changed;) {
    changed = false;
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      if (norm(points[b] - points[a]) <= step) return -1;
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) points.push_back(0.5 * (points[a] + points[b]));
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& t : triangles) {
      const int m[3] = {middle(t[1], t[2]), middle(t[2], t[0]),
                        middle(t[0], t[1])};  // opposite to each vertex
      const int cuts = (m[0] >= 0) + (m[1] >= 0) + (m[2] >= 0);
      changed = changed || cuts > 0;
      // With one cut or two, k is the vertex opposite to the side that differs from the others.
      int k = 0;
      while (k < 2 && (m[k] >= 0) != (cuts == 1)) ++k;
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = m[(k + 2) % 3], ca = m[(k + 1) % 3];
      if (cuts == 0) {
        finer.push_back(t);
      } else if (cuts == 1) {
        finer.insert(finer.end(), {{a, b, m[k]}, {a, m[k], c}});
      } else if (cuts == 2) {
        finer.insert(finer.end(), {{a, ab, ca}, {ab, b, c}, {ab, c, ca}});
      } else {
        finer.insert(finer.end(),
                     {{t[0], m[2], m[1]}, {m[2], t[1], m[0]}, {m[1], m[0], t[2]}, {m[0], m[1], m[2]}});
      }
    }
    triangles = std::move(finer);
  }
}

}  // namespace

void draw_case(const Prepared& prepared, const std::string& name, const std::filesystem::path& folder) {
  if (prepared.is_surface()) return;  // fields of surfaces live in the parameter planes of their patches
  std::vector<SingularityMark> marks;
  for (const PlacedSingularity& s : prepared->crosses.singularities)
    marks.push_back({{s.at.x, s.at.y}, s.index});
  draw_crosses(folder / "cross.svg", prepared->boundary, sample_crosses(prepared), marks,
               name + ": cross field");
  TriPatch tri = *prepared.background();
  refine(tri.points, tri.triangles, diagonal(prepared->boundary) / kSamplesAcross);
  Mesh samples;
  samples.triangles = std::move(tri.triangles);
  samples.triangle_region.assign(samples.triangles.size(), 0);
  samples.regions = {{1, {}}};
  std::vector<double> sizes;
  int hint = -1;
  for (const Vec2& u : tri.points) {
    samples.points.push_back({u.x, u.y, 0});
    sizes.push_back(prepared->size.field->at(samples.points.back(), hint));
  }
  if (std::ranges::all_of(sizes, [&](double size) { return size == sizes[0]; }))
    draw_crosses(folder / "size.svg", prepared->boundary, {}, {},
                 fmt::format("{}: size {:.4g} everywhere", name, sizes[0]));
  else
    draw_scalar(folder / "size.svg", samples, sizes, name + ": size field");
}

void draw_convergence(const std::filesystem::path& path, const Summaries& summaries,
                      const std::string& title) {
  using Lists = std::vector<std::vector<double>>;
  const Lists& energies = summaries.get<Lists>("smoothing", "energy_by_evaluation");
  const Lists& firsts = summaries.get<Lists>("smoothing", "first_of_frames");
  const Lists& accepted = summaries.get<Lists>("smoothing", "accepted_evaluations");
  const auto has = [](const std::vector<double>& list, std::size_t i) {
    return std::ranges::binary_search(list, static_cast<double>(i));
  };
  std::vector<PlotCurve> curves;
  for (std::size_t patch = 0; patch < energies.size(); ++patch)
    for (std::size_t i = 0; i < energies[patch].size(); ++i) {
      if (has(firsts[patch], i)) curves.emplace_back();
      curves.back().push_back({static_cast<double>(i + 1), energies[patch][i], has(accepted[patch], i)});
    }
  draw_curves(path, curves, title, "evaluation", "energy (1: squares of the wanted size)");
}

std::vector<double> cell_etas(const Mesh& mesh) {
  std::vector<double> etas(mesh.lines.size() + mesh.triangles.size(), 0.0);
  const std::vector<double> quads = quad_etas(mesh);
  etas.insert(etas.end(), quads.begin(), quads.end());
  return etas;
}

}  // namespace delquad
