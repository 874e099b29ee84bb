// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/flatten.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "base/activity.h"
#include "base/cancel.h"
#include "base/parallel.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/flatten_chart.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {

namespace {

/// Distance from a plane, over the model's diagonal, within which a face counts as plane.
constexpr double kPlane = 1e-9;
/// Limits of triangles mapped in all rounds: the least limit, and a number for each triangle of the model. A
/// model of a cow took 14.
constexpr std::size_t kLeastMapped = 100'000, kMappedPerTriangle = 15;

}  // namespace

double double_area(const FlatPatch& patch, const Mesh& fine, std::size_t triangle) {
  std::array<Vec3, 3> at;
  for (int k = 0; k < 3; ++k) at[k] = fine.points[patch.fine_node[patch.flat.triangles[triangle][k]]];
  if (!patch.sides.empty()) at = corners_at(patch.sides[triangle]);
  return norm(cross(at[1] - at[0], at[2] - at[0]));
}

namespace {

FlatPatch to_patch(const Chart& chart, ConformalMap map) {
  FlatPatch patch;
  patch.face = chart.face;
  patch.flat = {std::move(map.flat), chart.triangles, chart.neighbours, chart.n_boundary};
  patch.fine_node = chart.fine_node;
  patch.fine_triangle = chart.fine_triangle;
  patch.loops = chart.loops;
  patch.quality = map.quality;
  patch.method = std::move(map.method);
  patch.sides = chart.sides;
  return patch;
}

/// Lengths by which corners of an outline that meets itself are moved apart, over the shorter side there.
/// They are far above rounding, far below any edge, and smaller for thin triangles.
constexpr double kOpenings[] = {1e-6, 1e-7, 1e-8, 1e-9};

/// Returns the places of a part of a chart in the chart's map. If the part's boundary meets itself at
/// embedded curves, its points are moved apart into their corners (see build_domain()). Nothing if this is
/// impossible.
std::optional<std::vector<Vec2>> opened_map(const Chart& chart, const std::vector<Vec2>& map,
                                            const Chart& part) {
  std::map<int, std::size_t> place_of;  // places of fine triangles in the chart
  for (std::size_t t = 0; t < chart.fine_triangle.size(); ++t) place_of[chart.fine_triangle[t]] = t;
  std::vector<int> vertex(part.points.size());
  for (std::size_t t = 0; t < part.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      vertex[part.triangles[t][k]] = chart.triangles[place_of.at(part.fine_triangle[t])][k];
  std::vector<int> visits(map.size(), 0);
  for (int v = 0; v < part.n_boundary; ++v) ++visits[vertex[v]];
  std::vector<Vec2> closed;
  for (const int v : vertex) closed.push_back(map[v]);
  for (const double opening : kOpenings) {
    std::vector<Vec2> flat = closed;
    for (const auto& loop : part.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        if (visits[vertex[loop[i]]] < 2) continue;
        flat[loop[i]] += into_corner(closed[loop[(i + loop.size() - 1) % loop.size()]], closed[loop[i]],
                                     closed[loop[(i + 1) % loop.size()]], opening);
      }
    if (is_one_to_one(part, flat)) return flat;
  }
  return std::nullopt;
}

/// Flattens a model in rounds: maps charts without a map, then cuts charts that failed.
class Flattener {
 public:
  Flattener(SurfaceModel& model, const FlattenOptions& options)
      : model_(model),
        mesh_(model.fine),
        options_(options),
        tolerance_(kPlane * diagonal(mesh_)),
        to_be_mapped_(kLeastMapped + kMappedPerTriangle * mesh_.triangles.size()),
        open_(mesh_.triangles.size(), 1),
        tries_(mesh_.triangles.size(), 0),
        stuck_(mesh_.triangles.size(), 0),
        is_embedded_(mesh_.curves.size(), 0) {
    for (const EmbeddedCurve& c : model.embedded) is_embedded_[c.curve] = 1;
    if (options.left_out.empty()) return;
    for (std::size_t t = 0; t < open_.size(); ++t)
      if (options.left_out[mesh_.triangle_region[t]]) open_[t] = 0;
  }

  Flattening run() {
    for (int round = 0; std::ranges::find(open_, 1) != open_.end(); ++round) flatten_open(round);
    std::erase_if(patches_, [&](const FlatPatch& p) { return failed_.contains(p.face); });
    std::ranges::sort(patches_, {},
                      [](const FlatPatch& p) { return std::pair(p.face, p.fine_triangle.front()); });
    Flattening result;
    result.patches = std::move(patches_);
    result.cuts = std::move(cuts_);
    for (const auto& [face, piece] : failed_) {
      result.failed.push_back(face);
      result.failed_at.push_back(piece.second);
    }
    report(result);
    return result;
  }

 private:
  struct Planned {
    Chart chart;
    ChartOutcome outcome;
  };

  std::vector<Chart> charts_of(const std::vector<char>& wanted, const std::vector<char>& open) const {
    std::vector<Chart> charts = extract_charts(mesh_, wanted, open);
    for (Chart& chart : charts) {
      if (!options_.length) break;
      for (const int t : chart.fine_triangle) {
        const auto& v = mesh_.triangles[t];
        auto& sides = chart.sides.emplace_back();
        for (int k = 0; k < 3; ++k) sides[k] = options_.length(chart.face, v[(k + 1) % 3], v[(k + 2) % 3]);
      }
    }
    return charts;
  }

  void flatten_open(int round) {
    const std::vector<CutEnd> ends = cut_ends();
    const std::vector<char> on_cut = nodes_on_cuts();
    std::vector<Planned> mapped, planned;
    std::vector<Chart> charts = charts_of(open_, standing_lines());
    std::vector<ChartOutcome> outcomes(charts.size());
    parallel_for(
        charts.size(),
        [&](std::size_t i) {
          const FaceScope face(mesh_.regions[charts[i].face].tag);
          int tries = 0;
          bool stuck = round >= kMaxRounds;
          for (const int t : charts[i].fine_triangle) {
            tries = std::max(tries, tries_[t]);
            stuck = stuck || stuck_[t] != 0;
          }
          outcomes[i] = flatten_chart(charts[i], ends, on_cut, options_, tolerance_, tries, stuck);
        },
        [&](std::size_t i) { return static_cast<double>(charts[i].triangles.size()); });
    for (std::size_t i = 0; i < charts.size(); ++i) {
      check_cancelled();
      Chart& chart = charts[i];
      ChartOutcome& outcome = outcomes[i];
      to_be_mapped_ -= std::min(to_be_mapped_, chart.triangles.size());
      if (to_be_mapped_ > 0 && (outcome.cut || !outcome.parts.empty())) {
        planned.push_back({std::move(chart), std::move(outcome)});
        continue;
      }
      for (int t : chart.fine_triangle) open_[t] = 0;
      if (outcome.map)
        mapped.push_back({std::move(chart), std::move(outcome)});
      else
        fail(chart);
    }
    add_patches(std::move(mapped), planned);
    if (!planned.empty()) cut(planned);
  }

  void fail(const Chart& chart) {
    const std::size_t n = chart.triangles.size();
    if (const auto at = failed_.find(chart.face); at != failed_.end() && at->second.first <= n) return;
    failed_[chart.face] = {n, Box<Vec3>::around(chart.points)};
  }

  /// The lines that maps take no notice of; empty: none.
  std::vector<char> standing_lines() const {
    if (model_.embedded.empty()) return {};
    std::vector<char> standing;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) standing.push_back(is_standing(static_cast<int>(l)));
    return standing;
  }
  bool is_embedded(int curve) const {
    return curve < static_cast<int>(is_embedded_.size()) && is_embedded_[curve] != 0;
  }
  bool is_standing(int line) const {
    const auto& [a, b] = mesh_.lines[line];
    return is_embedded(mesh_.line_curve[line]) && !on_cut_.contains(std::minmax(a, b));
  }

  /// Adds a patch for each chart, or for each of its parts between embedded curves, cut open along these.
  /// Charts for which this fails are divided in another way.
  void add_patches(std::vector<Planned> mapped, std::vector<Planned>& planned) {
    if (model_.embedded.empty()) {
      for (Planned& p : mapped) patches_.push_back(to_patch(p.chart, *std::move(p.outcome.map)));
      return;
    }
    std::vector<char> wanted(mesh_.triangles.size(), 0);
    std::vector<std::size_t> chart_of(mesh_.triangles.size());
    for (std::size_t i = 0; i < mapped.size(); ++i)
      for (const int t : mapped[i].chart.fine_triangle) {
        wanted[t] = 1;
        chart_of[t] = i;
      }
    std::vector<std::vector<FlatPatch>> opened(mapped.size());
    std::vector<char> is_stuck(mapped.size(), 0);
    for (const Chart& part : charts_of(wanted, {})) {
      const std::size_t i = chart_of[part.fine_triangle.front()];
      const ConformalMap& map = *mapped[i].outcome.map;
      if (auto flat = opened_map(mapped[i].chart, map.flat, part)) {
        const FlatQuality quality = measure_flat(part, *flat);
        opened[i].push_back(to_patch(part, {*std::move(flat), quality, map.method}));
      } else {
        is_stuck[i] = 1;
      }
    }
    for (std::size_t i = 0; i < mapped.size(); ++i) {
      if (!is_stuck[i]) {
        std::ranges::move(opened[i], std::back_inserter(patches_));
        continue;
      }
      Chart& chart = mapped[i].chart;
      std::vector<char> parts = split_chart(chart, options_);
      if (parts.empty()) {
        fail(chart);
        continue;
      }
      for (const int t : chart.fine_triangle) open_[t] = 1;
      planned.push_back({std::move(chart), {std::nullopt, std::nullopt, true, std::move(parts)}});
    }
  }

  std::vector<CutEnd> cut_ends() const {
    std::vector<CutEnd> ends(mesh_.points.size(), CutEnd::kAnywhere);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      if (l == 0 || mesh_.line_curve[l] != mesh_.line_curve[l - 1])
        ends[mesh_.lines[l][0]] = CutEnd::kCurveStart;
    for (int v : model_.corners) ends[v] = CutEnd::kCorner;
    return ends;
  }

  std::vector<char> nodes_on_cuts() const {
    std::vector<char> on_cut(mesh_.points.size(), 0);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      if (is_cut_curve(mesh_.line_curve[l]))
        for (const int p : mesh_.lines[l]) on_cut[p] = 1;
    return on_cut;
  }

  void cut(const std::vector<Planned>& planned) {
    SurfaceEditor editor(model_);
    std::vector<CutEndOnCurve> ends;  // ends of cuts of this round
    for (const auto& [chart, outcome] : planned) {
      check_cancelled();
      if (outcome.cut) {
        const auto own = ends_on_curves(editor, chart, *outcome.cut);
        if (std::ranges::any_of(own, [&](const CutEndOnCurve& a) {
              return std::ranges::any_of(ends, [&](const CutEndOnCurve& b) { return are_close(a, b); });
            }))
          continue;
        ends.insert(ends.end(), own.begin(), own.end());
      }
      const bool made = outcome.cut ? apply(editor, chart, outcome) : part(editor, chart, outcome.parts);
      stuck_[chart.fine_triangle.front()] = made ? 0 : 1;
      if (outcome.map)
        for (const int t : chart.fine_triangle) ++tries_[t];
    }
    editor.finish();
    open_stale(editor.splits());
    sort_unique(model_.corners);
    if (options_.after_cuts) open_stale(options_.after_cuts());
  }

  bool is_cut_curve(int curve) const {
    return std::ranges::any_of(cuts_, [&](const SurfaceCut& c) { return c.curve == curve; });
  }

  /// Place on a curve of the model where the end of a cut makes a corner.
  struct CutEndOnCurve {
    int curve;
    Vec3 at;
  };

  std::vector<CutEndOnCurve> ends_on_curves(const SurfaceEditor& editor, const Chart& chart,
                                            const CutPath& path) const {
    std::vector<CutEndOnCurve> ends;
    if (path.closed) return ends;
    for (const EdgePoint& p : {path.points.front(), path.points.back()}) {
      int line = -1;
      if (p.b >= 0) line = editor.line_on(chart.fine_node[p.a], chart.fine_node[p.b]);
      for (const auto& loop : chart.loops) {
        const auto at = std::ranges::find(loop, p.a);
        if (p.b >= 0 || at == loop.end()) continue;
        line = editor.line_on(chart.fine_node[p.a],
                              chart.fine_node[at + 1 == loop.end() ? loop.front() : at[1]]);
      }
      if (line >= 0 && !is_cut_curve(mesh_.line_curve[line]))
        ends.push_back({mesh_.line_curve[line], position(chart, p)});
    }
    return ends;
  }

  /// Returns whether both ends would leave a short piece of a curve. Then the later cut waits for the next
  /// round, and may end at the first one's corner.
  bool are_close(const CutEndOnCurve& a, const CutEndOnCurve& b) const {
    constexpr double kShortPiece = 0.1;  // over the length of the curve
    if (a.curve != b.curve || a.at == b.at) return false;
    double length = 0;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      if (mesh_.line_curve[l] == a.curve)
        length += norm(mesh_.points[mesh_.lines[l][1]] - mesh_.points[mesh_.lines[l][0]]);
    return norm(a.at - b.at) < kShortPiece * length;
  }

  /// Reopens patches with triangles that cuts of neighbors split.
  void open_stale(const std::vector<std::pair<int, int>>& splits) {
    stuck_.resize(mesh_.triangles.size(), 0);
    tries_.resize(mesh_.triangles.size(), 0);
    open_.resize(mesh_.triangles.size(), 0);
    std::set<int> stale;
    for (const auto& [t, half] : splits) {
      open_[half] = open_[t];
      stale.insert(t);
    }
    std::erase_if(patches_, [&](const FlatPatch& p) {
      if (std::ranges::none_of(p.fine_triangle, [&](int t) { return stale.contains(t); })) return false;
      for (int t : p.fine_triangle) open_[t] = 1;
      return true;
    });
    for (const auto& [t, half] : splits) open_[half] = open_[t];
  }

  /// Makes a cut or a division. Returns whether it succeeded.
  bool apply(SurfaceEditor& editor, const Chart& chart, const ChartOutcome& outcome) {
    std::vector<int> chain;
    const CutPath& path = *outcome.cut;
    for (const EdgePoint& p : path.points) {
      if (p.b < 0) {
        chain.push_back(chart.fine_node[p.a]);
        continue;
      }
      const int a = chart.fine_node[p.a], b = chart.fine_node[p.b];
      // A neighbor's cut split this edge; the next round plans again.
      if (editor.triangles_on(a, b).empty()) return true;
      const bool was_on_cut = on_cut_.contains(std::minmax(a, b));
      chain.push_back(editor.split_edge(a, b, on_surface(editor, chart, p, a, b)));
      if (was_on_cut)
        for (const int end : {a, b}) on_cut_.insert(std::minmax(end, chain.back()));
    }
    if (path.closed) chain.push_back(chain.front());
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const int line = editor.line_on(chain[i], chain[i + 1]);
      if (editor.triangles_on(chain[i], chain[i + 1]).empty() || (line >= 0 && !is_standing(line)))
        return false;
    }
    add_cut(editor, chart, chain, outcome.divides);
    return true;
  }

  /// Adds a cut along edges; embedded curves on its way become parts of it.
  void add_cut(SurfaceEditor& editor, const Chart& chart, const std::vector<int>& chain, bool divides) {
    std::vector<std::vector<int>> pieces = {{chain.front()}};
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      if (editor.line_on(chain[i], chain[i + 1]) < 0) {
        pieces.back().push_back(chain[i + 1]);
        continue;
      }
      on_cut_.insert(std::minmax(chain[i], chain[i + 1]));
      pieces.push_back({chain[i + 1]});
    }
    for (const auto& piece : pieces)
      if (piece.size() > 1) add_new_cut(editor, chart, piece, divides);
  }

  void add_new_cut(SurfaceEditor& editor, const Chart& chart, const std::vector<int>& chain, bool divides) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      length += norm(mesh_.points[chain[i + 1]] - mesh_.points[chain[i]]);
    const bool closed = chain.front() == chain.back();
    for (const int v : chain)
      if (editor.is_on_line(v) || (!closed && (v == chain.front() || v == chain.back())))
        model_.corners.push_back(v);
    cuts_.push_back({editor.add_curve(chain), chart.face, length, divides});
  }

  /// Makes the edges between both parts cuts. Returns whether there are any.
  bool part(SurfaceEditor& editor, const Chart& chart, const std::vector<char>& parts) {
    std::vector<std::array<int, 2>> edges;
    for (std::size_t t = 0; t < parts.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int u = chart.neighbours[t][k];
        if (u >= 0 && parts[t] == 0 && parts[u] != 0)
          edges.push_back({chart.fine_node[chart.triangles[t][(k + 1) % 3]],
                           chart.fine_node[chart.triangles[t][(k + 2) % 3]]});
      }
    std::set<int> on_boundary;
    for (const auto& loop : chart.loops)
      for (int v : loop) on_boundary.insert(chart.fine_node[v]);
    for (const EdgeChain& chain : chain_edges(edges, [&](int v) { return on_boundary.contains(v); }))
      add_cut(editor, chart, chain.points, true);
    return true;
  }

  Vec3 on_surface(const SurfaceEditor& editor, const Chart& chart, const EdgePoint& p, int a, int b) const {
    const Vec3 x = position(chart, p);
    if (!model_.projector) return x;
    const int line = editor.line_on(a, b);
    const int curve = line < 0 ? -1 : mesh_.line_curve[line];
    const Vec3 y = curve < 0 || is_cut_curve(curve) ? model_.projector->to_face(chart.face, x)
                                                    : model_.projector->to_curve(curve, x);
    // Largest move by the projection over the edge; farther ones are wrong.
    constexpr double kMaxMove = 0.1;
    return norm(y - x) <= kMaxMove * norm(mesh_.points[b] - mesh_.points[a]) ? y : x;
  }

  /// Adds warnings of cuts and failures; cuts beside given elements do not matter.
  void report(const Flattening& result) {
    if (options_.element.empty()) report_cuts(result);
    for (int f : result.failed)
      model_.warnings.push_back(
          {"faces that could not be flattened", 0,
           fmt::format("face {}: could not be flattened [not-flattened]", mesh_.regions[f].tag)});
  }

  void report_cuts(const Flattening& result) {
    for (const SurfaceCut& c : result.cuts)
      model_.warnings.push_back(
          {"new curves that divide faces or cut them open", c.length,
           fmt::format("face {}: {} along a new curve {} of length {:.4g}", mesh_.regions[c.face].tag,
                       c.divides ? "divided" : "cut open", mesh_.curves[c.curve].tag, c.length)});
    for (const FlatPatch& p : result.patches)
      if (p.quality.area_ratio > options_.max_area_ratio || p.quality.sigma_95 > options_.max_sigma)
        model_.warnings.push_back(
            {"maps of faces that distort", p.quality.area_ratio * p.quality.sigma_95,
             fmt::format("face {}: its map distorts: area scale varies {:.3g} times, angles by {:.3g} "
                         "[distorted-map]",
                         mesh_.regions[p.face].tag, p.quality.area_ratio, p.quality.sigma_95)});
  }

  SurfaceModel& model_;
  Mesh& mesh_;
  const FlattenOptions& options_;
  double tolerance_;
  std::size_t to_be_mapped_;  ///< limit of triangles to map
  std::vector<char> open_;    ///< triangles that are in no finished patch
  std::vector<int> tries_;    ///< cuts through the chart of each triangle although it had a map
  std::vector<char> stuck_;   ///< first triangles of charts whose last cut could not be made
  std::map<int, std::pair<std::size_t, Box<Vec3>>> failed_;  ///< by face: triangles of a piece, its box
  std::vector<char> is_embedded_;                            ///< of the curves that the model had
  std::set<std::pair<int, int>>
      on_cut_;  ///< lines of embedded curves that cuts run along, as (lower, higher)
  std::vector<FlatPatch> patches_;
  std::vector<SurfaceCut> cuts_;
};

}  // namespace

Flattening flatten(SurfaceModel& model, const FlattenOptions& options) {
  assert(options.left_out.empty() || options.left_out.size() == model.fine.regions.size());
  assert(options.element.empty() || options.element.size() == model.fine.triangles.size());
  assert(options.avoided.empty() || options.avoided.size() == model.fine.points.size());
  return Flattener(model, options).run();
}

}  // namespace delquad
