// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/layout/field_lines.h"
#include "algorithms/layout/layout_pieces.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "base/cancel.h"
#include "base/stopwatch.h"
#include "delquad/error.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"
#include "smoothing/optimisation/track_optimisation.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

namespace {

// Costs are in quads times eta.

/// Costs of a cut, of a corner one edge from its end, and of a cut with all of a piece on one side.
constexpr double kCut = 0.3, kCrowding = 1, kUneven = 0.5;
/// Cost of an edge of a cut that joins two rims; the shortest cut is best.
constexpr double kJoining = 0.05;
/// A piece up to this cost needs no better pieces.
constexpr double kGoodCost = 2;
/// The cost of an irregular vertex.
constexpr double kIrregular = 4;
/// Part of kIrregular that counts in the choice of cuts to try, since cuts with one more pair may be better.
constexpr double kEstimate = 0.25;
/// Cuts whose pieces are filled as a trial, followed cuts (one less at each level), and levels. Beyond these
/// levels only pieces without a pattern are cut, at most twice as deep.
constexpr std::size_t kMostTried = 10;
constexpr int kMostCuts = 3, kMostLevels = 3;
/// Corners of a piece for each level that it starts higher, since large patches take long.
constexpr int kCornersPerLevel = 12;
/// Least number of corners at which levels count.
constexpr int kFewCorners = 8;
/// Limit of places of a piece from which lines start; the places are spread evenly.
constexpr std::size_t kMostStarts = 160;
/// For a piece without a pattern: irregular vertices for each vertex of its rim, and loss of a quad.
constexpr double kMixedPerVertex = 0.1, kMixedLoss = 0.15;
/// Limits of examined pieces of a patch. With 2000 counted pieces a layout takes four times as long and
/// leaves as many irregular vertices.
constexpr int kMostCountedPieces = 40, kMostFreePieces = 200;
/// Cost of one more failing quad.
constexpr double kFailing = 0.4;
/// Sweeps of relocation, first without lengths, and the part of an edge that counts as no move.
constexpr int kSweeps = 60;
constexpr double kRelaxed = 0.02;

class LayoutSearch {
 public:
  LayoutSearch(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size,
               LayoutEdges edges = LayoutEdges::kCounted)
      : boundary_(boundary), cross_(cross), size_(size), edges_(edges) {}

  /// Returns the necessary number of irregular vertices, by Euler's formula.
  int necessary() {
    const std::vector<Rim> rims = rims_of_boundary();
    int turns = 0;
    for (const Rim& rim : rims) turns += corners_of(rim);
    return std::abs(4 * (2 - static_cast<int>(rims.size())) - turns);
  }

  std::optional<PatchLayout> find() {
    std::vector<Rim> rims = rims_of_boundary();
    while (rims.size() > 1)
      if (!join(rims)) return std::nullopt;
    if (rims.empty()) return std::nullopt;
    auto found = solve(rims[0], std::min(kMostLevels, std::abs(corners_of(rims[0])) / kCornersPerLevel));
    if (!found) return std::nullopt;
    return PatchLayout{vertices_, std::move(found->pieces)};
  }

  std::optional<QuadPatch> fill(const PatchLayout& layout) {
    vertices_ = layout.vertices;
    QuadPatch mesh;
    mesh.n_boundary = static_cast<int>(boundary_.points.size());
    mesh.points = boundary_.points;
    std::vector<int> number(vertices_.places.size(), -1);
    std::iota(number.begin(), number.begin() + mesh.n_boundary, 0);
    for (const Rim& rim : layout.pieces)
      for (const RimVertex& v : rim)
        if (number[v.vertex] < 0) {
          number[v.vertex] = static_cast<int>(mesh.points.size());
          mesh.points.push_back(vertices_.places[v.vertex]);
        }
    for (const Rim& rim : layout.pieces) {
      const auto piece = filled(rim);
      const PatternMesh filled =
          piece && piece->pattern ? mesh_pattern(outline_of(rim), *piece->pattern) : mesh_mixed(rim);
      const int n_rim = static_cast<int>(rim.size()), first = static_cast<int>(mesh.points.size());
      mesh.points.insert(mesh.points.end(), filled.inside.begin(), filled.inside.end());
      for (std::array<int, 4> quad : filled.quads) {
        for (int& v : quad) v = v < n_rim ? number[rim[v].vertex] : first + v - n_rim;
        std::array<int, 4> sorted = quad;
        std::ranges::sort(sorted);
        if (std::ranges::adjacent_find(sorted) != sorted.end()) return std::nullopt;
        mesh.quads.push_back(quad);
      }
    }
    return relaxed(mesh);
  }

 private:
  struct Solution {
    double cost = 0;
    std::vector<Rim> pieces = {};
    std::optional<Pattern> pattern = {};  ///< of a single piece; none: the piece is meshed as its own patch
  };
  /// Line with its number of edges.
  struct Cut {
    FieldLine line;
    int edges;
    double cost;
    std::vector<int> row = {};
  };

  bool is_free() const { return edges_ == LayoutEdges::kFree; }

  std::vector<Rim> rims_of_boundary() {
    const std::vector<Vec2>& points = boundary_.points;
    vertices_ = {points, {}};
    int hint = -1;
    for (const Vec2 p : points) vertices_.delta.push_back(size_.at(p, hint));
    std::vector<int> next(points.size(), -1), before(points.size(), -1);
    for (const auto& [a, b] : boundary_.edges) next[a] = b, before[b] = a;
    std::vector<char> met(points.size(), 0);
    std::vector<Rim> rims;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (met[i]) continue;
      Rim& rim = rims.emplace_back();
      for (int v = static_cast<int>(i); !met[v]; v = next[v]) {
        met[v] = 1;
        const Vec2 out = points[next[v]] - points[v], in = points[before[v]] - points[v];
        double angle = std::atan2(cross(out, in), dot(out, in));
        if (angle <= 0) angle += 2 * std::numbers::pi;
        rim.push_back({v, ideal_quads(angle * 2 / std::numbers::pi)});
      }
    }
    return rims;
  }

  /// Returns the vertices along a line, both ends included.
  std::vector<Vec2> row_along(const FieldLine& line, int edges) const {
    std::vector<Vec2> row{line.path.front()};
    std::size_t k = 1;
    for (int i = 1; i < edges; ++i) {
      const double at = line.edges.back() * i / edges;
      while (k + 1 < line.edges.size() && line.edges[k] < at) ++k;
      const double t = (at - line.edges[k - 1]) / std::max(line.edges[k] - line.edges[k - 1], kTinyLength);
      row.push_back(line.path[k - 1] + t * (line.path[k] - line.path[k - 1]));
    }
    row.push_back(line.path.back());
    return row;
  }
  /// Adds the inner vertices of a cut.
  std::vector<int> add_row(std::span<const Vec2> row) {
    std::vector<int> added;
    int hint = -1;
    for (const Vec2 p : row.subspan(1, row.size() - 2)) {
      added.push_back(static_cast<int>(vertices_.places.size()));
      vertices_.places.push_back(p);
      vertices_.delta.push_back(size_.at(p, hint));
    }
    return added;
  }

  static double strain(const FieldLine& line, int edges) {
    const double misfit = std::log(line.edges.back() / edges);
    return edges * misfit * misfit + line.misfit;
  }

  /// Returns the lines from places of some rims; with `concave` only from concave ones, if there are any.
  std::vector<FieldLine> lines_from(FieldLines& tracer, std::span<const Rim> rims, bool concave) const {
    std::vector<RimPlace> starts;
    for (const int least : {concave ? 3 : 2, 2}) {
      for (int r = 0; r < static_cast<int>(rims.size()); ++r)
        for (int i = 0; i < static_cast<int>(rims[r].size()); ++i)
          if (rims[r][i].quads >= least) starts.push_back({r, i});
      if (!starts.empty()) break;
    }
    std::vector<FieldLine> lines;
    const std::size_t stride = starts.size() / kMostStarts + 1;
    for (std::size_t i = 0; i < starts.size(); i += stride) tracer.trace(starts[i], lines);
    return lines;
  }

  /// Returns the cost of corners near a place, on both sides of it.
  static double crowding(const Rim& rim, int at) {
    const int n = static_cast<int>(rim.size());
    double cost = 0;
    for (const int step : {1, n - 1}) {
      int i = (at + step) % n, edges = 1;
      while (edges < n && rim[i].quads == 2) i = (i + step) % n, ++edges;
      if (rim[i].quads == 1) cost += kCrowding / (edges * edges);
    }
    return cost;
  }

  /// Joins the two rims with the cheapest cut.
  bool join(std::vector<Rim>& rims) {
    check_cancelled();
    FieldLines tracer(cross_, size_, vertices_, rims);
    std::vector<Cut> cuts;
    for (FieldLine& line : lines_from(tracer, rims, false)) {
      if (line.from.rim == line.to.rim) continue;
      const int edges = std::max(1, static_cast<int>(std::lround(line.edges.back())));
      const double cost = strain(line, edges) + kJoining * edges;
      cuts.push_back({std::move(line), edges, cost});
    }
    std::ranges::stable_sort(cuts, {}, &Cut::cost);
    for (const Cut& cut : cuts) {
      const auto row = row_along(cut.line, cut.edges);
      if (!tracer.is_free(cut.line.from, cut.line.to, row)) continue;
      std::vector<Rim> all = cut_along(rims, cut.line, add_row(row));
      for (int r = 0; r < static_cast<int>(rims.size()); ++r)
        if (r != cut.line.from.rim && r != cut.line.to.rim) all.push_back(std::move(rims[r]));
      rims = std::move(all);
      return true;
    }
    return false;
  }

  Outline outline_of(const Rim& rim) const {
    Outline outline;
    for (const RimVertex& v : rim) {
      outline.places.push_back(vertices_.places[v.vertex]);
      outline.delta.push_back(vertices_.delta[v.vertex]);
      outline.turn.push_back(2 - v.quads);
    }
    return outline;
  }

  double estimate_of(const Rim& rim) const {
    const double weight = kEstimate * kIrregular;
    return is_free() ? cost_of_closed(rim, weight) : cost_of(rim, weight);
  }

  /// Returns the polygon with the nearest numbers of edges that allow a grid or a star.
  static Outline closed(const Outline& outline) {
    const auto sides = sides_of(outline.turn);
    const int n = sides ? static_cast<int>(sides->edges.size()) : 0;
    if (n < 3 || n > 5) return outline;
    const std::vector<int>& s = sides->edges;
    std::array<int, 5> wanted{};
    for (int i = 0; i < n; ++i) {
      const auto foot = [&](int side) { return std::max(1, foot_of(s, side) / 2); };
      wanted[i] = n == 4 ? (s[i] + s[(i + 2) % 4]) / 2 : foot(i) + foot((i + 2) % n);
    }
    Outline other;
    const int m = static_cast<int>(outline.places.size());
    for (int i = 0, first = sides->start; i < n; first += s[i++])
      for (int k = 0; k < wanted[i]; ++k) {
        const double at = static_cast<double>(k) * s[i] / wanted[i];
        const int j = static_cast<int>(at), a = (first + j) % m, b = (first + j + 1) % m;
        const double t = at - j;
        other.places.push_back(outline.places[a] + t * (outline.places[b] - outline.places[a]));
        other.delta.push_back(outline.delta[a] + t * (outline.delta[b] - outline.delta[a]));
        other.turn.push_back(k == 0 ? 1 : 0);
      }
    return other;
  }

  std::optional<Solution> by_pattern(const Rim& rim) const {
    const Outline outline = is_free() ? closed(outline_of(rim)) : outline_of(rim);
    auto pattern = best_pattern(outline, std::abs(4 - corners_of(rim)) + 4);
    if (!pattern) return std::nullopt;
    const double cost = kIrregular * irregular_vertices(*pattern) + loss_of(outline, *pattern);
    return Solution{cost, {rim}, std::move(pattern)};
  }

  /// Returns kLoss times the sum of 1 - eta + 1.5 * (size deviation) over the quads of a pattern, before
  /// relocation.
  double loss_of(const Outline& outline, const Pattern& pattern) const {
    const PatternMesh filled = mesh_pattern(outline, pattern);
    std::vector<Vec2> points = outline.places;
    std::vector<double> delta = outline.delta;
    int hint = -1;
    for (const Vec2 p : filled.inside) points.push_back(p), delta.push_back(size_.at(p, hint));
    double loss = 0;
    for (const auto& q : filled.quads) {
      const std::array<Vec2, 4> at{points[q[0]], points[q[1]], points[q[2]], points[q[3]]};
      double deviation = 0;
      for (int k = 0; k < 4; ++k) {
        const int a = q[k], b = q[(k + 1) % 4];
        const double l = std::max(2 * norm(points[b] - points[a]) / (delta[a] + delta[b]), kTinyLength);
        deviation += (1 - std::min(l, 1 / l)) / 4;
      }
      loss += 1 - eta_of_sine(std::ranges::min(corner_sines(at))) + kDeviation * deviation;
    }
    return kLoss * loss;
  }

  std::vector<Cut> cuts_of(FieldLines& tracer, const Rim& rim, bool concave) const {
    std::vector<Cut> cuts;
    for (const FieldLine& line : lines_from(tracer, {&rim, 1}, concave)) {
      const int n = static_cast<int>(rim.size());
      const int between = (line.to.at - line.from.at + n) % n;
      const int nearest = std::max(1, static_cast<int>(std::lround(line.edges.back())));
      for (int edges = std::max(1, nearest - 1); edges <= nearest + 1; ++edges) {
        if ((between + edges) % 2 != 0) continue;
        double cost = strain(line, edges) + kCut + crowding(rim, line.from.at) + crowding(rim, line.to.at);
        const std::vector<int> row(edges - 1, -1);
        bool grids = false;
        cost += kUneven * std::abs(n - 2.0 * between) / n;
        for (const Rim& part : cut_along({&rim, 1}, line, row)) {
          cost += estimate_of(part);
          grids = grids || corners_of(part) <= 4;
        }
        if (grids && rim[line.from.at].quads == 2 && rim[line.to.at].quads == 2) cost += kIrregular / 2;
        if (cost < kNever) cuts.push_back({line, edges, cost});
      }
    }
    std::ranges::stable_sort(cuts, {}, &Cut::cost);
    return cuts;
  }

  /// Returns the solution of a piece without a pattern.
  std::optional<Solution> mixed(const Rim& rim) {
    std::vector<int> vertices;
    for (const RimVertex& v : rim) vertices.push_back(v.vertex);
    std::ranges::sort(vertices);
    if (std::ranges::adjacent_find(vertices) != vertices.end()) return std::nullopt;
    const double n = static_cast<double>(rim.size());
    double area = 0, delta = 0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      area += cross(vertices_.places[rim[i].vertex], vertices_.places[rim[(i + 1) % rim.size()].vertex]) / 2;
      delta += vertices_.delta[rim[i].vertex] / n;
    }
    const double irregular = std::abs(4 - corners_of(rim)) + kMixed + kMixedPerVertex * n;
    return Solution{kIrregular * irregular + kLoss * kMixedLoss * area / (delta * delta), {rim}};
  }

  /// Returns the mesh of such a piece, numbered like the mesh of a pattern.
  PatternMesh mesh_mixed(const Rim& rim) {
    PatchBoundary boundary;
    const int n = static_cast<int>(rim.size());
    for (int i = 0; i < n; ++i) {
      boundary.points.push_back(vertices_.places[rim[i].vertex]);
      boundary.edges.push_back({i, (i + 1) % n});
    }
    const TriPatch triangles = mesh_delquad(boundary, *make_linf_delquad(), cross_, size_);
    QuadPatch mesh = recombine(triangles, *make_primal_dual_solver());
    mesh = make_regular(treat_paper(mesh, size_), size_);
    if (!mesh.triangles.empty()) throw InputError("a piece of a layout has triangles");
    return {{mesh.points.begin() + n, mesh.points.end()}, std::move(mesh.quads)};
  }

  /// Returns the cuts with the best pieces, by the cost of pieces that patterns fill at once.
  std::vector<Cut> promising(const FieldLines& tracer, const Rim& rim, std::vector<Cut> cuts) {
    std::vector<Cut> best;
    for (Cut& cut : cuts) {
      if (best.size() == kMostTried) break;
      const std::vector<Vec2> places = row_along(cut.line, cut.edges);
      if (!tracer.is_free(cut.line.from, cut.line.to, places)) continue;
      const std::size_t n = vertices_.places.size();
      cut.row = add_row(places);
      for (const Rim& part : cut_along({&rim, 1}, cut.line, cut.row)) {
        if (!is_polygon(part)) continue;
        const auto filled = by_pattern(part);
        if (filled) cut.cost += filled->cost - estimate_of(part);
      }
      vertices_.places.resize(n), vertices_.delta.resize(n);
      best.push_back(std::move(cut));
    }
    std::ranges::stable_sort(best, {}, &Cut::cost);
    return best;
  }

  std::optional<Solution> solve(const Rim& rim, int level) {
    check_cancelled();
    if (++looks_ > (is_free() ? kMostFreePieces : kMostCountedPieces)) return mixed(rim);
    const int corners = corners_of(rim);
    std::optional<Solution> best;
    if (is_polygon(rim)) best = by_pattern(rim);
    if (best && best->cost < kIrregular * std::abs(4 - corners) + kGoodCost) return best;
    if (level > (best ? kMostLevels : 2 * kMostLevels) && (best || !is_free()))
      return is_free() ? best : filled(rim);
    const bool convex = is_convex(rim);
    FieldLines tracer(cross_, size_, vertices_, {&rim, 1});
    for (const bool concave : {true, false}) {
      if ((concave && convex) || (!concave && best && !convex)) continue;
      int solved = 0;
      for (const Cut& cut : promising(tracer, rim, cuts_of(tracer, rim, concave))) {
        const int most = corners <= kFewCorners ? std::max(1, kMostCuts - level) : 1;
        if (best && (solved >= most || cut.cost >= best->cost)) break;
        Solution all{strain(cut.line, cut.edges) + kCut, {}};
        bool is_solved = true;
        const std::vector<int> row = add_row(row_along(cut.line, cut.edges));
        for (const Rim& part : cut_along({&rim, 1}, cut.line, row)) {
          auto found = solve(part, corners <= kFewCorners ? level + 1 : level);
          is_solved = found.has_value();
          if (!is_solved) break;
          all.cost += found->cost;
          std::ranges::move(found->pieces, std::back_inserter(all.pieces));
        }
        solved += is_solved ? 1 : 0;
        if (is_solved && (!best || all.cost < best->cost)) best = std::move(all);
      }
    }
    if (!best || (corners >= 2 && corners <= 6 && !is_free())) {
      auto other = mixed(rim);
      if (other && (!best || other->cost < best->cost)) best = std::move(other);
    }
    return best;
  }

  /// Fills by a pattern, or as a mixed piece if that costs less.
  std::optional<Solution> filled(const Rim& rim) {
    std::optional<Solution> best;
    if (is_polygon(rim)) best = by_pattern(rim);
    if (best && best->cost < kIrregular * std::abs(4 - corners_of(rim)) + kGoodCost) return best;
    auto other = mixed(rim);
    return other && (!best || other->cost < best->cost) ? other : best;
  }

  std::optional<QuadPatch> relaxed(const QuadPatch& raw) const {
    QuadTopology topology(raw);
    QuadRelocation relocation(topology, size_);
    relocation.activate_all();
    relocation.relax(kRelaxed, kSweeps);
    relocation.keep_convex_corners();
    relocation.hold_lengths();
    relocation.activate_all();
    relocation.relax(kRelaxed, kSweeps);
    relocation.lift_worst(kFloorEta, 10);
    QuadPatch mesh = topology.to_patch();
    if (worst_sine(mesh) <= 0) untangle_flat(mesh, size_);
    if (worst_sine(mesh) <= 0) return std::nullopt;
    return mesh;
  }
  static double worst_sine(const QuadPatch& mesh) {
    double least = 1;
    for (const auto& q : mesh.quads)
      for (const double s :
           corner_sines<Vec2>({mesh.points[q[0]], mesh.points[q[1]], mesh.points[q[2]], mesh.points[q[3]]}))
        least = std::min(least, s);
    return least;
  }

  const PatchBoundary& boundary_;
  const CrossField& cross_;
  const ParametricSize& size_;
  LayoutEdges edges_;
  int looks_ = 0;  ///< examined pieces
  LayoutVertices vertices_;
};

}  // namespace

PatchScore PatchScore::of(const QuadPatch& mesh, const ParametricSize& size) {
  QuadTopology topology(mesh);
  const QuadRelocation relocation(topology, size);
  PatchScore score{{}, count_irregular(mesh), mesh.quads.size()};
  for (int e = 0; e < topology.element_slots(); ++e)
    score.quality.add(element_quality(topology, relocation, e));
  return score;
}

double PatchScore::loss(const PatchScore& now) const {
  const double times = static_cast<double>(quads) / static_cast<double>(now.quads);
  return quality.value - now.quality.value * times +
         kFailing * (now.quality.failing - quality.failing + now.quality.thin - quality.thin);
}

bool PatchScore::keeps_worst(const PatchScore& now, double eta) const {
  return now.quality.crowding <= quality.crowding &&
         now.quality.least_sine >= std::min(quality.least_sine, sine_of_eta(eta));
}

std::optional<PatchLayout> find_layout(const PatchBoundary& boundary, const CrossField& cross,
                                       const ParametricSize& size, LayoutEdges edges) {
  return LayoutSearch(boundary, cross, size, edges).find();
}

std::optional<QuadPatch> fill_layout(const PatchLayout& layout, const PatchBoundary& boundary,
                                     const CrossField& cross, const ParametricSize& size) {
  try {
    return LayoutSearch(boundary, cross, size).fill(layout);
  } catch (const InputError&) {
    // A piece is no polygon in the plane, so there is no such layout.
  } catch (const std::invalid_argument&) {
    // Pieces do not fit together.
  }
  return std::nullopt;
}

std::optional<QuadPatch> more_regular(const QuadPatch& mesh, const PatchBoundary& boundary,
                                      const CrossField& cross, const ParametricSize& size, double price,
                                      LayoutSummary* summary) {
  const Stopwatch watch;
  LayoutSummary own{.patches = 1, .irregular = count_irregular(mesh)};
  std::optional<QuadPatch> found;
  if (own.irregular > LayoutSearch(boundary, cross, size).necessary()) {
    if (const auto layout = find_layout(boundary, cross, size, LayoutEdges::kCounted))
      found = fill_layout(*layout, boundary, cross, size);
    own.without = found ? 0 : 1;
  }
  if (found) {
    found = make_regular(*found, size);
    const PatchScore before = PatchScore::of(mesh, size), now = PatchScore::of(*found, size);
    const int fewer = before.irregular - now.irregular;
    if (fewer <= 0 || before.loss(now) >= price * fewer || !before.keeps_worst(now, kFloorEta)) found.reset();
  }
  if (found) own.irregular = count_irregular(*found);
  own.worse = found || own.without == 1 ? 0 : 1;
  own.seconds = watch.seconds();
  if (summary != nullptr) *summary = own;
  return found;
}

}  // namespace delquad
