// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/triangulated_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/box.h"
#include "base/text.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/feature_noise.h"
#include "geometry/surface/model_report.h"
#include "geometry/surface/triangle_repair.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

/// Returns unit normals; a sliver has the normal of its neighbor across its longest side.
std::vector<Vec3> steady_normals(const Mesh& mesh, const std::vector<int>& twin) {
  constexpr double kSliver = 1e-6;  // of the diagonal: some units in the last place of single precision
  const double least_height = kSliver * diagonal(mesh.points);
  const int n = static_cast<int>(mesh.triangles.size());
  std::vector<Vec3> normal(n);
  std::vector<int> across(n, -1);
  for (int t = 0; t < n; ++t) {
    double length = 0;
    int longest = 3 * t;
    for (int side = 3 * t; side < 3 * t + 3; ++side) {
      const double l = norm(mesh.points[side_end(mesh, side)] - mesh.points[side_start(mesh, side)]);
      if (l > length) longest = side;
      length = std::max(length, l);
    }
    const auto& v = mesh.triangles[t];
    const Vec3 area = cross((1 / length) * (mesh.points[v[1]] - mesh.points[v[0]]),
                            mesh.points[v[2]] - mesh.points[v[0]]);  // vector as long as the height
    normal[t] = (1 / norm(area)) * area;
    if (norm(area) < least_height && twin[longest] >= 0) across[t] = twin[longest] / 3;
  }
  std::vector<Vec3> steady = normal;
  for (int t = 0; t < n; ++t) {
    constexpr int kFarthest = 16;  // most slivers side by side
    int at = t;
    for (int step = 0; step < kFarthest && across[at] >= 0; ++step) at = across[at];
    if (across[at] < 0) steady[t] = normal[at];
  }
  return steady;
}

/// Returns for each side the angle (radians) between the normals of its triangles; 0 without a twin.
std::vector<double> side_angles(const Mesh& mesh, const std::vector<int>& twin) {
  const std::vector<Vec3> normal = steady_normals(mesh, twin);
  std::vector<double> angles(twin.size(), 0.0);
  for (size_t s = 0; s < twin.size(); ++s) {
    if (twin[s] < 0) continue;
    const size_t t = s / 3, u = static_cast<size_t>(twin[s]) / 3;
    angles[s] = angle_between(normal[t], normal[u]);
  }
  return angles;
}

/// Returns the kind of cut along each side, the same for both sides of an edge.
std::vector<int> find_cuts(const Mesh& mesh, const std::vector<int>& twin, const std::vector<double>& angle,
                           double feature_angle) {
  std::vector<int> cut(twin.size(), kNoCut);
  for (size_t s = 0; s < twin.size(); ++s) {
    if (twin[s] < 0) {
      cut[s] = kNewCut;
      continue;
    }
    const size_t t = s / 3, u = static_cast<size_t>(twin[s]) / 3;
    if (angle[s] > feature_angle || mesh.triangle_region[t] != mesh.triangle_region[u]) cut[s] = kNewCut;
  }
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for (size_t i = 0; i < mesh.lines.size(); ++i) {
    for (const HalfEdge& half : sides_of_edge(sides, mesh.lines[i][0], mesh.lines[i][1])) {
      cut[side_number(mesh, half)] = mesh.line_curve[i];
    }
  }
  return cut;
}

/// Removes cuts from their loose ends on. Adds the sides of removed given lines, with their curves.
void drop_loose_ends(const Mesh& mesh, const std::vector<int>& twin, std::vector<int>& cut,
                     std::vector<std::pair<int, int>>& given) {
  std::vector<std::vector<int>> sides_at(mesh.points.size());  // one side of each cut edge
  for (int s = 0; s < static_cast<int>(cut.size()); ++s) {
    if (cut[s] == kNoCut || (twin[s] >= 0 && twin[s] < s)) continue;
    sides_at[side_start(mesh, s)].push_back(s);
    sides_at[side_end(mesh, s)].push_back(s);
  }
  for (int seed = 0; seed < static_cast<int>(sides_at.size()); ++seed) {
    for (int p = seed; sides_at[p].size() == 1;) {
      const int s = sides_at[p][0];
      if (cut[s] >= 0) given.emplace_back(s, cut[s]);
      cut[s] = cut[twin[s]] = kNoCut;  // a free edge has cuts at both ends, so this one has a twin
      const int q = side_start(mesh, s) == p ? side_end(mesh, s) : side_start(mesh, s);
      sides_at[p].clear();
      std::erase(sides_at[q], s);
      p = q;
    }
  }
}

/// Returns given lines that end inside faces, joined by curve.
std::vector<LooseLine> join_loose_lines(const Mesh& mesh, std::vector<std::pair<int, int>> sides,
                                        const std::string& source) {
  std::ranges::sort(sides);
  SurfaceModel lines;
  lines.fine.points = mesh.points;
  std::vector<int> given;
  for (const auto& [side, curve] : sides) {
    lines.fine.lines.push_back({side_start(mesh, side), side_end(mesh, side)});
    given.push_back(curve);
  }
  std::vector<LooseLine> loose;
  std::size_t line = 0;
  for (const auto& chain : chain_lines(lines, given, std::vector<char>(mesh.points.size(), 0))) {
    const Entity& curve = mesh.curves[given[chain[0]]];
    loose.push_back({{mesh.points[lines.fine.lines[line][0]]},
                     curve.names,
                     fmt::format("{}: curve {}", source, curve.tag)});
    for (std::size_t i = 0; i < chain.size(); ++i)
      loose.back().points.push_back(mesh.points[lines.fine.lines[line++][1]]);
  }
  return loose;
}

/// Makes edges features again if they are sharp enough and have their middle in a ball.
void keep_features(const Mesh& mesh, const std::vector<FeatureBall>& balls, const std::vector<double>& angle,
                   std::vector<int>& cut) {
  constexpr double kSharp = std::numbers::pi / 3;
  for (int s = 0; s < static_cast<int>(cut.size()); ++s) {
    if (cut[s] != kNoCut || angle[s] < kSharp) continue;
    const Vec3 middle = 0.5 * (mesh.points[side_start(mesh, s)] + mesh.points[side_end(mesh, s)]);
    if (std::ranges::any_of(balls, [&](const FeatureBall& b) { return norm(middle - b.at) < b.reach; }))
      cut[s] = kNewCut;
  }
}

/// Numbers the parts between cuts in the order of their first triangles. Returns the region of each.
std::vector<int> number_faces(Mesh& mesh, const std::vector<int>& twin, const std::vector<int>& cut) {
  std::vector<int> face = parts_between_cuts(twin, cut), region_of_face;
  for (std::size_t t = 0; t < face.size(); ++t)
    if (face[t] == std::ssize(region_of_face)) region_of_face.push_back(mesh.triangle_region[t]);
  mesh.triangle_region = std::move(face);
  return region_of_face;
}

/// Convert a given curve (kNewCut: none) to the kind of an embedded line, beyond the kinds of cuts, and back.
int standing_kind(int n_curves, int curve) { return n_curves + 1 + curve; }
bool is_standing_kind(int n_curves, int kind) { return kind >= n_curves; }
int given_curve_of(int n_curves, int kind) {
  return is_standing_kind(n_curves, kind) ? kind - n_curves - 1 : kind;
}

/// Makes lines of the model from cuts and from `standing` lines (sides with their curves), joined to curves.
/// Returns the kind of each curve, see standing_kind().
std::vector<int> make_curves(SurfaceModel& model, const std::vector<int>& twin, const std::vector<int>& cut,
                             double angle, const std::vector<std::pair<int, int>>& standing = {}) {
  Mesh& mesh = model.fine;
  mesh.lines.clear();
  std::vector<int> given;
  std::set<std::pair<int, int>> seen;  // sides have no twin where the surface branches
  for (int s = 0; s < static_cast<int>(cut.size()); ++s) {
    if (cut[s] == kNoCut || (twin[s] >= 0 && twin[s] < s)) continue;
    if (twin[s] < 0 && !seen.insert(std::minmax({side_start(mesh, s), side_end(mesh, s)})).second) continue;
    mesh.lines.push_back({side_start(mesh, s), side_end(mesh, s)});
    given.push_back(cut[s]);
  }
  const int n_curves = static_cast<int>(mesh.curves.size());
  for (const auto& [side, curve] : standing) {
    mesh.lines.push_back({side_start(mesh, side), side_end(mesh, side)});
    given.push_back(standing_kind(n_curves, curve));
  }
  std::vector<char> corner(mesh.points.size(), 0);
  mark_turns(mesh, angle, std::vector<char>(mesh.points.size(), 1), corner);
  for (const NamedPoint& named : mesh.named_points) corner[named.point] = 1;
  std::vector<int> given_of_curve, kinds;
  for (const auto& chain : chain_lines(model, given, std::move(corner))) {
    kinds.push_back(given[chain[0]]);
    given_of_curve.push_back(given_curve_of(n_curves, kinds.back()));
  }
  mesh.curves = entities_of_pieces(mesh.curves, given_of_curve);
  return kinds;
}

/// Embedded lines: given lines that end inside faces, continued by an edge, and two edges at named points on
/// no line. A single edge would enclose nothing.
class StandingLines {
 public:
  StandingLines(const Mesh& mesh, const std::vector<int>& twin, const std::vector<int>& element,
                const std::vector<int>& cut, std::vector<std::pair<int, int>> given)
      : mesh_(mesh), lines_(std::move(given)), sides_at_(mesh.points.size()), count_(mesh.points.size(), 0) {
    for (int s = 0; s < static_cast<int>(twin.size()); ++s) {
      if (twin[s] >= 0 && element[s / 3] == element[twin[s] / 3]) continue;
      for (const int v : {side_start(mesh, s), side_end(mesh, s)}) {
        if (twin[s] < 0 || s < twin[s]) sides_at_[v].push_back(s);
        count_[v] += cut[s] != kNoCut;
      }
    }
    for (const auto& [side, curve] : lines_) count(side);
    const std::size_t n_given = lines_.size();
    for (std::size_t i = 0; i < n_given; ++i) {
      const int side = lines_[i].first, a = side_start(mesh, side), b = side_end(mesh, side);
      if (count_[a] == 1 && count_[b] == 1) extend(b, a);
    }
    for (const NamedPoint& named : mesh.named_points) {
      const int v = named.point;
      if (count_[v] > 0) continue;
      const int side = sides_at_[v].front();
      add(side);
      extend(v, other_end(side, v));
    }
  }
  std::vector<std::pair<int, int>> take() && { return std::move(lines_); }

 private:
  int other_end(int side, int v) const {
    return side_start(mesh_, side) == v ? side_end(mesh_, side) : side_start(mesh_, side);
  }
  void count(int side) {
    ++count_[side_start(mesh_, side)];
    ++count_[side_end(mesh_, side)];
  }
  void add(int side) {
    lines_.emplace_back(side, kNewCut);
    count(side);
  }
  /// Extends a line from v, away from `from`.
  void extend(int v, int from) {
    const auto ahead = [&](int side) {
      const int w = other_end(side, v);
      const Vec3 in = mesh_.points[v] - mesh_.points[from], out = mesh_.points[w] - mesh_.points[v];
      return w == from ? -2 : dot(in, out) / (norm(in) * norm(out));
    };
    add(*std::ranges::max_element(sides_at_[v], {}, ahead));
  }

  const Mesh& mesh_;
  std::vector<std::pair<int, int>> lines_;
  std::vector<std::vector<int>> sides_at_;  ///< sides that are no diagonals, one for each edge
  std::vector<int> count_;                  ///< number of cuts and lines at each point
};

double checked_angle(const TriangulatedOptions& options) {
  if (!(options.feature_angle > 0 && options.feature_angle <= 180))
    throw std::invalid_argument("feature angle: expected above 0 to 180 degrees");
  return options.feature_angle * std::numbers::pi / 180;
}

/// Removes cuts from noise, with a warning, and loose ends; `loose` is as in drop_loose_ends().
void drop_noise_and_ends(SurfaceModel& model, const std::vector<int>& twin, const std::vector<double>& angles,
                         std::vector<int>& cut, std::vector<std::pair<int, int>>& loose) {
  drop_loose_ends(model.fine, twin, cut, loose);
  const DroppedFeatures noise = drop_noise(model.fine, twin, angles, cut);
  drop_loose_ends(model.fine, twin, cut, loose);
  if (noise.islands > 0)
    model.warnings.push_back(fmt::format("ignored {} of sharp edges as noise ({} edges, the first at {})",
                                         counted(static_cast<int>(noise.islands), "island"), noise.edges,
                                         show_point(noise.at)));
}

}  // namespace

SurfaceModel make_surface_model(Mesh triangles, const TriangulatedOptions& options) {
  const double angle = checked_angle(options);
  SurfaceModel model;
  model.source = options.source;
  if (!(options.weld_tolerance >= 0)) throw std::invalid_argument("weld tolerance: expected 0 or more");
  const double weld_tolerance = options.weld_tolerance * diagonal(triangles.points);
  model.fine = repair_triangles(std::move(triangles), weld_tolerance, options.source, model.warnings);
  const std::vector<int> twin = agreeing_twins(model.fine);
  const std::vector<double> angles = side_angles(model.fine, twin);
  std::vector<int> cut = find_cuts(model.fine, twin, angles, angle);
  std::vector<std::pair<int, int>> loose;
  drop_noise_and_ends(model, twin, angles, cut, loose);
  keep_features(model.fine, options.kept_features, angles, cut);
  model.loose = join_loose_lines(model.fine, std::move(loose), options.source);
  model.fine.regions = entities_of_pieces(model.fine.regions, number_faces(model.fine, twin, cut));
  make_curves(model, twin, cut, angle);
  report_edges(model);
  return model;
}

KeptModel make_kept_model(Mesh triangles, const std::vector<int>& element,
                          const TriangulatedOptions& options) {
  const double angle = checked_angle(options);
  KeptModel kept;
  SurfaceModel& model = kept.model;
  model.source = options.source;
  settle_triangles(triangles, options.source, model.warnings);
  model.fine = std::move(triangles);
  Mesh& fine = model.fine;
  const std::vector<int> twin = agreeing_twins(fine);
  std::vector<double> angles = side_angles(fine, twin);
  for (std::size_t s = 0; s < twin.size(); ++s)
    if (twin[s] >= 0 && element[s / 3] == element[twin[s] / 3]) angles[s] = 0;
  std::vector<int> cut = find_cuts(fine, twin, angles, angle);
  std::vector<std::pair<int, int>> loose;
  drop_noise_and_ends(model, twin, angles, cut, loose);
  loose = StandingLines(fine, twin, element, cut, std::move(loose)).take();
  kept.given_region = number_faces(fine, twin, cut);
  fine.regions = entities_of_pieces(fine.regions, kept.given_region);
  const int n_curves = static_cast<int>(fine.curves.size());
  const std::vector<int> kinds = make_curves(model, twin, cut, angle, loose);
  std::map<std::pair<int, int>, int> side_of;
  for (const auto& [side, curve] : loose)
    side_of[std::minmax({side_start(fine, side), side_end(fine, side)})] = side;
  for (const int kind : kinds) kept.given_curve.push_back(given_curve_of(n_curves, kind));
  for (std::size_t l = 0; l < fine.lines.size(); ++l) {
    const int curve = fine.line_curve[l];
    if (l > 0 && fine.line_curve[l - 1] == curve) continue;
    if (!is_standing_kind(n_curves, kinds[curve])) continue;
    const int side = side_of.at(std::minmax({fine.lines[l][0], fine.lines[l][1]}));
    model.embedded.push_back({curve, fine.triangle_region[side / 3]});
  }
  return kept;
}

}  // namespace delquad
