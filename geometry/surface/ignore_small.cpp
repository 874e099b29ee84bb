// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/ignore_small.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/segment.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/compound_projector.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {

namespace {

std::string title(const char* kind, const Entity& entity) {
  return entity.names.empty() ? fmt::format("{} {}", kind, entity.tag)
                              : fmt::format("{} {} ({})", kind, entity.tag, fmt::join(entity.names, ", "));
}

double length_of(const Mesh& mesh, const std::array<int, 2>& line) {
  return norm(mesh.points[line[1]] - mesh.points[line[0]]);
}

/// Returns the weight of a curve's length between two triangles: from 1/4, at 90 degrees and more, to 1.
double smoothness(const Mesh& mesh, const HalfEdge& one, const HalfEdge& other) {
  constexpr double kLeast = 0.25;
  const Vec3 m = area_vector(mesh, one.element), n = area_vector(mesh, other.element);
  const double both = norm(m) * norm(n);
  const double cosine = both > 0 ? (one.forward == other.forward ? -1 : 1) * dot(m, n) / both : 0;
  return kLeast + (1 - kLeast) * std::max(0.0, cosine);
}

/// Joins narrow faces with their neighbors, the narrowest first.
class FaceJoiner {
 public:
  /// `origin` has the former face of each face, see cut_narrow_parts().
  FaceJoiner(const Mesh& mesh, const std::vector<int>& origin, const NarrowOptions& narrow)
      : mesh_(mesh), origin_(origin), narrow_(narrow), sets_(mesh.regions.size()) {
    for (std::size_t face = 0; face < sets_.size(); ++face) sets_[face].members = {static_cast<int>(face)};
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      Set& set = sets_[mesh.triangle_region[t]];
      set.area += norm(area_vector(mesh, t)) / 2;
      set.is_kept |= is_kept(mesh, t, narrow);
    }
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      const double length = length_of(mesh, mesh.lines[l]);
      const auto edge = sides_of_edge(std::span(sides), mesh.lines[l][0], mesh.lines[l][1]);
      for (const HalfEdge& side : edge) sets_[mesh.triangle_region[side.element]].outline += length;
      if (edge.size() != 2) continue;
      const int f = mesh.triangle_region[edge[0].element], g = mesh.triangle_region[edge[1].element];
      if (f == g) {
        sets_[f].outline -= 2 * length;  // a seam
        continue;
      }
      const bool stays = narrow.keep.any_of(mesh.curves[mesh.line_curve[l]]);
      const double weight = stays ? 0 : smoothness(mesh, edge[0], edge[1]) * length;
      for (const auto& [one, other] : {std::array{f, g}, {g, f}}) {
        sets_[one].common[other].length += length;
        sets_[one].common[other].weight += weight;
      }
    }
  }

  /// Returns groups of faces, the one that keeps its name first, with warnings of faces that joined others.
  EntityGroups join(std::vector<Warning>& warnings) {
    while (const std::optional<int> narrow = narrowest()) {
      const Set& thin = sets_[*narrow];
      const int host = host_of(thin), face = thin.members[0];
      const bool whole = origin_[face] == face;
      warnings.push_back(
          {whole ? "narrow faces that became part of others"
                 : "narrow parts of faces that became part of others",
           1 / thin.width(),
           fmt::format("{}{}, {:.3g} wide, became part of {}, at {}", whole ? "" : "a part of ",
                       title("face", mesh_.regions[origin_[face]]), thin.width(),
                       title("face", mesh_.regions[origin_[sets_[host].members[0]]]),
                       show_point(place_of(face)))});
      unite(*narrow, host);
    }
    EntityGroups groups;
    for (Set& set : sets_)
      if (set.members.size() > 1) groups.push_back(std::move(set.members));
    return groups;
  }

 private:
  /// Curves that two sets share.
  struct Common {
    double length = 0, weight = 0;
  };
  struct Set {
    std::vector<int> members;  ///< faces; empty: it joined another set
    double area = 0, outline = 0;
    bool is_kept = false;
    std::map<int, Common> common;  ///< common curves with other sets
    double width() const {
      return outline > 0 ? 2 * area / outline : std::numeric_limits<double>::infinity();
    }
  };

  /// Returns the set that a set may join; -1: none.
  int host_of(const Set& set) const {
    int best = -1;
    double most = 0;
    for (const auto& [other, common] : set.common) {
      const int face = set.members[0], host = sets_[other].members[0];
      if (!(common.weight > most) || origin_[face] == origin_[host]) continue;
      if (!has_names_of(mesh_.regions[host], mesh_.regions[face], narrow_.keep)) continue;
      best = other, most = common.weight;
    }
    return best;
  }

  std::optional<int> narrowest() const {
    std::optional<int> best;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const Set& set = sets_[i];
      if (set.members.empty() || set.area == 0 || set.is_kept || !(set.width() < narrow_.length)) continue;
      if ((!best || set.width() < sets_[*best].width()) && host_of(set) >= 0) best = static_cast<int>(i);
    }
    return best;
  }

  void unite(int narrow, int host) {
    Set from = std::move(sets_[narrow]);
    sets_[narrow] = {};
    Set& to = sets_[host];
    to.members.insert(to.members.end(), from.members.begin(), from.members.end());
    to.area += from.area;
    to.outline += from.outline - 2 * from.common.at(host).length;
    for (const auto& [other, common] : from.common) {
      sets_[other].common.erase(narrow);
      if (other == host) continue;
      for (Common* sum : {&sets_[other].common[host], &to.common[other]})
        sum->length += common.length, sum->weight += common.weight;
    }
  }

  /// Returns a point of the face.
  Vec3 place_of(int face) const {
    const auto at = std::ranges::find(mesh_.triangle_region, face) - mesh_.triangle_region.begin();
    const auto& [a, b, c] = mesh_.triangles[at];
    return (1.0 / 3) * (mesh_.points[a] + mesh_.points[b] + mesh_.points[c]);
  }

  const Mesh& mesh_;
  const std::vector<int>& origin_;
  const NarrowOptions& narrow_;
  std::vector<Set> sets_;
};

/// Edges on boundaries and branches, with one triangle or more than two.
class OutlineLines {
 public:
  explicit OutlineLines(const Mesh& mesh) : sides_(sorted_half_edges(mesh)), at_(mesh.points.size(), 0) {
    for (const auto& [a, b] : mesh.lines)
      if (has(a, b)) at_[a] = at_[b] = 1;
  }
  bool has(int a, int b) const { return sides_of_edge(std::span(sides_), a, b).size() != 2; }
  bool touch(int node) const { return at_[node] != 0; }

 private:
  std::vector<HalfEdge> sides_;
  std::vector<char> at_;
};

/// Returns the third corners of the triangles on an edge.
std::vector<int> opposite_nodes(const Mesh& mesh, const SurfaceEditor& editor, int a, int b) {
  std::vector<int> nodes;
  for (const int t : editor.triangles_on(a, b))
    for (const int v : mesh.triangles[t])
      if (v != a && v != b) nodes.push_back(v);
  return nodes;
}

std::vector<int> neighbours(const Mesh& mesh, const SurfaceEditor& editor, int node) {
  std::vector<int> nodes;
  for (const int t : editor.triangles_at(node))
    for (const int v : mesh.triangles[t])
      if (v != node) nodes.push_back(v);
  sort_unique(nodes);
  return nodes;
}

/// Splits edges at `a` whose other ends would lie on edges of `b` after a moves there.
void split_common_edges(SurfaceModel& model, int a, int b) {
  SurfaceEditor editor(model);
  const std::vector<int> opposite = opposite_nodes(model.fine, editor, a, b);
  const std::vector<int> at_b = neighbours(model.fine, editor, b);
  for (const int c : neighbours(model.fine, editor, a)) {
    if (c == b || !std::ranges::binary_search(at_b, c)) continue;
    const bool is_opposite = std::ranges::find(opposite, c) != opposite.end();
    if (is_opposite && (editor.line_on(a, c) < 0 || editor.line_on(b, c) < 0)) continue;
    editor.split_edge(a, c, 0.5 * (model.fine.points[a] + model.fine.points[c]));
  }
  editor.finish();
}

/// Returns whether no triangle at `a` flips if a moves to `b`.
bool keeps_sides(const Mesh& mesh, int a, int b) {
  return std::ranges::all_of(mesh.triangles, [&](std::array<int, 3> triangle) {
    if (std::ranges::find(triangle, a) == triangle.end()) return true;
    if (std::ranges::find(triangle, b) != triangle.end()) return true;
    const Vec3 before = area_vector(mesh.points, triangle);
    std::ranges::replace(triangle, a, b);
    return dot(before, area_vector(mesh.points, triangle)) > 0;
  });
}

/// Moves the end `a` of a line to its other end `b`. Returns false if the topology would change.
bool contract_line(SurfaceModel& model, int a, int b) {
  Mesh& mesh = model.fine;
  const OutlineLines outline(mesh);
  if (outline.touch(a) && outline.touch(b) && !outline.has(a, b)) return false;
  split_common_edges(model, a, b);
  if (!keeps_sides(mesh, a, b)) return false;
  keep_triangles(mesh, [&](std::size_t t) {
    auto& triangle = mesh.triangles[t];
    const bool has_b = std::ranges::find(triangle, b) != triangle.end();
    if (has_b && std::ranges::find(triangle, a) != triangle.end()) return false;
    std::ranges::replace(triangle, a, b);
    return true;
  });
  keep_lines(mesh, [&](std::size_t i) {
    std::ranges::replace(mesh.lines[i], a, b);
    return mesh.lines[i][0] != mesh.lines[i][1];
  });
  return true;
}

/// Largest move of the points that were merged into each point; 0 for later points.
using Moved = std::vector<double>;

/// Returns the model with the curve's nodes merged into the last one. Nothing if this is impossible, or a
/// point moves farther than `most`.
std::optional<SurfaceModel> contracted(SurfaceModel model, const std::vector<int>& nodes, double most,
                                       Moved& moved) {
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const int a = nodes[i], b = nodes[i + 1];
    moved.resize(model.fine.points.size(), 0);
    moved[b] = std::max(moved[b], moved[a] + length_of(model.fine, {a, b}));
    if (moved[b] > most || !contract_line(model, a, b)) return std::nullopt;
  }
  return model;
}

/// Contracts a curve. Returns whether it succeeded.
bool contract_curve(SurfaceModel& model, int curve, double most, Moved& moved) {
  std::vector<int> nodes = points_of_curves(model.fine)[curve];
  if (nodes.front() == nodes.back()) return false;
  for (const bool reversed : {false, true}) {
    if (reversed) std::ranges::reverse(nodes);
    Moved then = moved;
    if (std::optional<SurfaceModel> result = contracted(model, nodes, most, then)) {
      model = std::move(*result);
      moved = std::move(then);
      return true;
    }
  }
  return false;
}

/// Returns the model after contraction of shorter curves, the shortest first.
SurfaceModel contract_short_curves(SurfaceModel model, const NarrowOptions& narrow) {
  const Mesh& mesh = model.fine;
  const std::vector<double> lengths = lengths_of_curves(mesh);
  std::vector<char> stays(lengths.size(), 0);
  for (std::size_t c = 0; c < lengths.size(); ++c) stays[c] = narrow.keep.any_of(mesh.curves[c]);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    stays[mesh.line_curve[l]] |= std::ranges::any_of(narrow.kept, [&](const FeatureBall& ball) {
      const auto& [a, b] = mesh.lines[l];
      return distance_to_segment(ball.at, mesh.points[a], mesh.points[b]) < ball.reach;
    });
  std::vector<int> order;
  for (std::size_t c = 0; c < lengths.size(); ++c)
    if (lengths[c] < narrow.length && !stays[c]) order.push_back(static_cast<int>(c));
  if (order.empty()) return model;
  std::ranges::stable_sort(order, {}, [&](int c) { return lengths[c]; });
  const Mesh former = model.fine;
  Moved moved;
  for (const int curve : order) {
    const std::string name =
        fmt::format("{}, {:.3g} long,", title("curve", former.curves[curve]), lengths[curve]);
    const std::string place =
        show_point(former.points[former.lines[std::ranges::find(former.line_curve, curve) -
                                              former.line_curve.begin()][0]]);
    const bool gone = contract_curve(model, curve, narrow.length, moved);
    model.warnings.push_back(
        {gone ? "short curves that became points" : "short curves that stay", 1 / lengths[curve],
         fmt::format(
             "{} {} at {}", name,
             gone ? "became a point"
                  : "stays: it is closed, or the surface would fold or tear without it, or move too far,",
             place)});
  }
  tidy_model(model, former);
  return model;
}

/// Warns of names that no entity has any more.
void report_lost_names(const char* kind, const std::vector<Entity>& before, const std::vector<Entity>& after,
                       std::vector<Warning>& warnings) {
  std::set<std::string> there;
  for (const Entity& entity : after) there.insert(entity.names.begin(), entity.names.end());
  for (const Entity& entity : before)
    for (const std::string& name : entity.names)
      if (there.insert(name).second)
        warnings.push_back({"names of small parts that are left out", 1,
                            fmt::format("no {} has the name '{}' any more: {} {} was too small "
                                        "(--keep, or surface.keep, keeps it) [lost-names]",
                                        kind, name, kind, entity.tag)});
}

}  // namespace

bool is_kept(const Mesh& mesh, int triangle, const NarrowOptions& narrow) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const std::vector<Vec3>& p = mesh.points;
  return std::ranges::any_of(narrow.kept, [&](const FeatureBall& ball) {
    const auto w = nearest_weights(p[a], p[b], p[c], ball.at);
    return norm(w[0] * p[a] + w[1] * p[b] + w[2] * p[c] - ball.at) < ball.reach;
  });
}

bool has_names_of(const Entity& host, const Entity& other, const KeptNames& keep) {
  return std::ranges::all_of(keep.of(other), [&](const std::string& name) {
    return std::ranges::find(host.names, name) != host.names.end();
  });
}

bool may_join(const Mesh& mesh, int curve, int face, int host, const NarrowOptions& narrow) {
  return face != host && !narrow.keep.any_of(mesh.curves[curve]) &&
         has_names_of(mesh.regions[host], mesh.regions[face], narrow.keep);
}

SurfaceModel ignore_small(SurfaceModel model, const NarrowOptions& narrow, const CompoundOptions& options) {
  const double length = narrow.length;
  if (const double size = diagonal(model.fine); !(length < size))
    throw InputError(
        fmt::format("{}: faces and curves below {:.6g} are to be ignored: expected a length far below the "
                    "diagonal, {:.3g}",
                    model.source, length, size));
  model.before = std::make_shared<const Mesh>(model.fine);
  model = close_small_holes(std::move(model), narrow);
  const std::vector<int> origin = cut_narrow_parts(model, narrow);
  const EntityGroups groups = FaceJoiner(model.fine, origin, narrow).join(model.warnings);
  for (const auto& group : groups)
    for (const int face : group) model.fine.regions[face] = model.fine.regions[group[0]];
  model = make_compound(std::move(model), groups, options);
  model = contract_short_curves(merge_short_curves(std::move(model), length, options), narrow);
  report_lost_names("face", model.before->regions, model.fine.regions, model.warnings);
  report_lost_names("curve", model.before->curves, model.fine.curves, model.warnings);
  return model;
}

}  // namespace delquad
