#include "geometry/surface/ignore_small.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "base/sort_unique.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/surface/compound_projector.h"
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

std::vector<double> curve_lengths(const Mesh& mesh) {
  std::vector<double> lengths(mesh.curves.size(), 0);
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
    lengths[mesh.line_curve[i]] += length_of(mesh, mesh.lines[i]);
  return lengths;
}

Vec3 area_vector(const Mesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
}

/// Joins narrow faces with their neighbours, the narrowest first.
class FaceJoiner {
 public:
  /// `origin`: of each face the one that it is a part of, see cut_narrow_parts().
  FaceJoiner(const Mesh& mesh, const std::vector<int>& origin)
      : mesh_(mesh), origin_(origin), sets_(mesh.regions.size()) {
    for (std::size_t face = 0; face < sets_.size(); ++face) sets_[face].members = {static_cast<int>(face)};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      sets_[mesh.triangle_region[t]].area +=
          norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a])) / 2;
    }
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
    for (const auto& line : mesh.lines) {
      const double length = length_of(mesh, line);
      const auto edge = sides_of_edge(std::span(sides), line[0], line[1]);
      for (const HalfEdge& side : edge) set_of(side).outline += length;
      if (edge.size() != 2) continue;
      const int f = mesh.triangle_region[edge[0].element], g = mesh.triangle_region[edge[1].element];
      if (f == g) {
        sets_[f].outline -= 2 * length;  // a seam
        continue;
      }
      const Vec3 m = area_vector(mesh, edge[0].element), n = area_vector(mesh, edge[1].element);
      const double smooth = dot(m, n) / (norm(m) * norm(n));
      const double weighed = smooth > 0 ? (0.25 + 0.75*smooth) * length : 0.25 * length;
      sets_[f].common[g] += weighed;
      sets_[g].common[f] += weighed;
    }
  }

  /// Groups of faces, the one that keeps its name first. Says which became part of which.
  EntityGroups join(double length, std::vector<Warning>& warnings) {
    while (const std::optional<int> narrow = narrowest(length)) {
      Set& thin = sets_[*narrow];
      const int host =
          std::ranges::max_element(thin.common, {}, [](const auto& c) { return c.second; })->first;
      const int is = thin.members[0], of = origin_[is];
      if (of != origin_[sets_[host].members[0]])
        warnings.push_back(
            {is == of ? "narrow faces that became part of others"
                      : "narrow parts of faces that became part of others",
             1 / thin.width(),
             fmt::format("{}{}{}, {:.3g} wide, became part of {}", is == of ? "" : "a part of ",
                         title("face", mesh_.regions[of]), is == of ? "" : " at " + show_point(place_of(is)),
                         thin.width(), title("face", mesh_.regions[origin_[sets_[host].members[0]]]))});
      unite(*narrow, host);
    }
    EntityGroups groups;
    for (Set& set : sets_)
      if (set.members.size() > 1) groups.push_back(std::move(set.members));
    return groups;
  }

 private:
  struct Set {
    std::vector<int> members;  ///< faces; none: has become part of another set
    double area = 0, outline = 0;
    std::map<int, double> common;  ///< lengths of curves shared with other sets
    double width() const {
      return outline > 0 ? 2 * area / outline : std::numeric_limits<double>::infinity();
    }
  };

  Set& set_of(const HalfEdge& side) { return sets_[mesh_.triangle_region[side.element]]; }

  std::optional<int> narrowest(double length) const {
    std::optional<int> best;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const Set& set = sets_[i];
      if (set.members.empty() || set.area == 0 || set.common.empty() || !(set.width() < length)) continue;
      if (!best || set.width() < sets_[*best].width()) best = static_cast<int>(i);
    }
    return best;
  }

  void unite(int narrow, int host) {
    Set from = std::move(sets_[narrow]);
    sets_[narrow] = {};
    Set& to = sets_[host];
    to.members.insert(to.members.end(), from.members.begin(), from.members.end());
    to.area += from.area;
    to.outline += from.outline - 2 * from.common.at(host);
    for (const auto& [other, length] : from.common) {
      sets_[other].common.erase(narrow);
      if (other == host) continue;
      sets_[other].common[host] += length;
      to.common[other] += length;
    }
  }

  /// A point of the face.
  Vec3 place_of(int face) const {
    const auto at = std::ranges::find(mesh_.triangle_region, face) - mesh_.triangle_region.begin();
    const auto& [a, b, c] = mesh_.triangles[at];
    return (1.0 / 3) * (mesh_.points[a] + mesh_.points[b] + mesh_.points[c]);
  }

  const Mesh& mesh_;
  const std::vector<int>& origin_;
  std::vector<Set> sets_;
};

/// The lines of boundaries and branches: edges with one triangle, or with more than two.
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

/// The third corners of the triangles on an edge.
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

/// Parts edges at `a` whose other ends would come onto edges of `b` when a moves there.
void part_common_edges(SurfaceModel& model, int a, int b) {
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

Vec3 area_vector(const std::array<Vec3, 3>& x) { return cross(x[1] - x[0], x[2] - x[0]); }

/// Whether no triangle at `a` turns over when a moves to `b`.
bool keeps_sides(const Mesh& mesh, int a, int b) {
  for (const auto& triangle : mesh.triangles) {
    if (std::ranges::find(triangle, a) == triangle.end()) continue;
    if (std::ranges::find(triangle, b) != triangle.end()) continue;
    std::array<Vec3, 3> before, after;
    for (int k = 0; k < 3; ++k) {
      before[k] = mesh.points[triangle[k]];
      after[k] = triangle[k] == a ? mesh.points[b] : before[k];
    }
    if (!(dot(area_vector(before), area_vector(after)) > 0)) return false;
  }
  return true;
}

/// Moves the end `a` of a line to its other end `b`; false: the surface would not be what it was.
bool contract_line(SurfaceModel& model, int a, int b) {
  Mesh& mesh = model.fine;
  const OutlineLines outline(mesh);
  if (outline.touch(a) && outline.touch(b) && !outline.has(a, b)) return false;
  part_common_edges(model, a, b);
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

/// The nodes of a curve from end to end.
std::vector<int> nodes_of_curve(const Mesh& mesh, int curve) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < mesh.lines.size(); ++i) {
    if (mesh.line_curve[i] != curve) continue;
    if (nodes.empty()) nodes.push_back(mesh.lines[i][0]);
    nodes.push_back(mesh.lines[i][1]);
  }
  return nodes;
}

/// The model with the curve's nodes in the last of `nodes`; nothing where that cannot be.
std::optional<SurfaceModel> contracted(SurfaceModel model, const std::vector<int>& nodes) {
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    if (!contract_line(model, nodes[i], nodes[i + 1])) return std::nullopt;
  return model;
}

/// Whether something became of a curve.
bool contract_curve(SurfaceModel& model, int curve) {
  std::vector<int> nodes = nodes_of_curve(model.fine, curve);
  if (nodes.front() == nodes.back()) return false;
  for (const bool reversed : {false, true}) {
    if (reversed) std::ranges::reverse(nodes);
    if (std::optional<SurfaceModel> result = contracted(model, nodes)) {
      model = std::move(*result);
      return true;
    }
  }
  return false;
}

/// Contracts curves shorter than `length`, the shortest first.
SurfaceModel contract_short_curves(SurfaceModel model, double length) {
  const std::vector<double> lengths = curve_lengths(model.fine);
  std::vector<int> order;
  for (std::size_t c = 0; c < lengths.size(); ++c)
    if (lengths[c] < length) order.push_back(static_cast<int>(c));
  if (order.empty()) return model;
  std::ranges::stable_sort(order, {}, [&](int c) { return lengths[c]; });
  const Mesh former = model.fine;
  for (const int curve : order) {
    const std::string name =
        fmt::format("{}, {:.3g} long,", title("curve", former.curves[curve]), lengths[curve]);
    const bool gone = contract_curve(model, curve);
    model.warnings.push_back(
        {gone ? "short curves that became points" : "short curves that stay", 1 / lengths[curve],
         gone ? name + " became a point"
              : name + " stays: it is closed, or the surface would fold or tear without it"});
  }
  TidyGroups kept = tidy_model(model);
  regroup(model, former, kept.faces, std::move(kept.curves));
  return model;
}

}  // namespace

SurfaceModel ignore_small(SurfaceModel model, double length, const CompoundOptions& options) {
  if (const double size = diagonal(model.fine); !(length < size))
    throw InputError(
        fmt::format("{}: faces and curves below {:.6g} are to be ignored: expected a length far below the "
                    "diagonal, {:.3g}",
                    model.source, length, size));
  model = close_small_holes(std::move(model), length);
  const std::vector<int> origin = cut_narrow_parts(model, length);
  const EntityGroups groups = FaceJoiner(model.fine, origin).join(length, model.warnings);
  for (const auto& group : groups)
    for (const int face : group) model.fine.regions[face] = model.fine.regions[group[0]];
  model = make_compound(std::move(model), groups, options);
  return contract_short_curves(merge_short_curves(std::move(model), length, options, ShortRest::kSilent),
                               length);
}

}  // namespace delquad
