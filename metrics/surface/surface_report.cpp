// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/surface/surface_report.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/nearest_triangle.h"
#include "metrics/shape.h"
#include "metrics/surface/surface_search.h"

namespace delquad {

namespace {

/// A quad with a vertex less than this many quads away from a cut is near it.
constexpr int kRings = 3;

enum class Where : char { kOff, kNear, kOnCurve };

void put(const Mesh& mesh, const std::vector<char>& is_cut, bool cuts, Where here,
         std::vector<Where>& where) {
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if ((is_cut[mesh.line_curve[l]] != 0) == cuts)
      for (const int v : mesh.lines[l]) where[v] = here;
}

/// Returns the place of each vertex.
std::vector<Where> places(const Mesh& mesh, const std::vector<char>& is_cut) {
  std::vector<Where> where(mesh.points.size(), Where::kOff);
  put(mesh, is_cut, true, Where::kNear, where);
  for (int ring = 1; ring < kRings; ++ring) {
    const std::vector<Where> before = where;
    for (const auto& quad : mesh.quads)
      if (std::ranges::any_of(quad, [&](int v) { return before[v] == Where::kNear; }))
        for (const int v : quad) where[v] = Where::kNear;
  }
  put(mesh, is_cut, false, Where::kOnCurve, where);
  return where;
}

}  // namespace

void measure_near_cuts(const Mesh& mesh, const std::vector<char>& is_cut, QuadShare& near, QuadShare& off) {
  if (std::ranges::find(is_cut, 1) == is_cut.end()) return;
  const std::vector<Where> where = places(mesh, is_cut);
  std::vector<int> valence(mesh.points.size(), 0);
  for (const auto& quad : mesh.quads) {
    for (const int v : quad) ++valence[v];
    const bool is_near = std::ranges::any_of(quad, [&](int v) { return where[v] == Where::kNear; });
    QuadShare& share = is_near ? near : off;
    const std::array<Vec3, 4> corners = corners_of(mesh, quad);
    share.eta += std::max(0.0, eta_of(element_shape(corners, area_vector(corners)).angle));
    ++share.quads;
  }
  for (std::size_t v = 0; v < where.size(); ++v) {
    if (where[v] == Where::kOnCurve || valence[v] == 0) continue;
    QuadShare& share = where[v] == Where::kNear ? near : off;
    share.d4 += valence[v] == 4 ? 100 : 0;
    ++share.vertices;
  }
  for (QuadShare* share : {&near, &off}) {
    share->eta /= std::max(1, share->quads);
    share->d4 /= std::max(1, share->vertices);
  }
}

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

using Edge = std::array<int, 2>;

Edge sorted_edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Lines of a mesh by their ends.
class LineIndex {
 public:
  explicit LineIndex(const Mesh& mesh) {
    lines_.reserve(mesh.lines.size());
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      lines_.push_back({sorted_edge(mesh.lines[l][0], mesh.lines[l][1]), mesh.line_curve[l]});
    std::ranges::sort(lines_);
  }
  /// Returns the curve of an edge; -1: none.
  int curve_of(int a, int b) const {
    const Edge edge = sorted_edge(a, b);
    const auto at = std::ranges::lower_bound(lines_, std::pair(edge, -1));
    return at != lines_.end() && at->first == edge ? at->second : -1;
  }

 private:
  std::vector<std::pair<Edge, int>> lines_;
};

/// Calls visit(curve, sides) for each edge on a curve.
template <class Visit>
void for_each_edge_on_curve(const Mesh& mesh, Visit visit) {
  const LineIndex lines(mesh);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    const int curve = lines.curve_of(edge[0].lo, edge[0].hi);
    if (curve >= 0) visit(curve, edge);
  });
}

/// Returns the model without the faces that were left out.
Mesh without(const Mesh& fine, const std::vector<char>& left_out) {
  Mesh kept;
  kept.points = fine.points;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    if (left_out[fine.triangle_region[t]]) continue;
    kept.triangles.push_back(fine.triangles[t]);
    kept.triangle_region.push_back(fine.triangle_region[t]);
  }
  kept.lines = fine.lines;
  kept.line_curve = fine.line_curve;
  kept.curves = fine.curves;
  kept.regions = fine.regions;
  return kept;
}

/// Returns the number of elements at an edge of each curve.
std::vector<int> elements_on_curves(const Mesh& mesh) {
  std::vector<int> elements(mesh.curves.size(), 0);
  for_each_edge_on_curve(mesh, [&](int curve, std::span<const HalfEdge> edge) {
    elements[curve] = static_cast<int>(edge.size());
  });
  return elements;
}

class Comparison {
 public:
  Comparison(const SurfaceModel& model, std::span<const SurfaceCut> cuts, const std::vector<char>& left_out,
             const Mesh& mesh, std::span<const HalfEdge> sides, const SizeField* size)
      : projector_(model.projector.get()),
        size_(size),
        fine_(without(model.fine, left_out)),
        mesh_(mesh),
        diagonal_(diagonal(model.fine)),
        lines_(mesh),
        sides_(sides),
        is_cut_(model.fine.curves.size(), 0) {
    for (const SurfaceCut& cut : cuts) is_cut_[cut.curve] = 1;
    if (projector_ != nullptr) return;
    const bool is_whole = std::ranges::find(left_out, 1) == left_out.end();
    const Mesh& surface = model.before && is_whole ? *model.before : fine_;
    triangles_.emplace_back(surface.points, surface.triangles);
  }

  SurfaceReport run() {
    report_.model = topology_of(fine_);
    report_.mesh = topology_of(mesh_, sides_);
    std::optional<NearestElement> elements;
    const std::function<void()> parts[] = {
        [&] { elements.emplace(mesh_); }, [&] { measure_elements(); }, [&] { measure_nodes(); },
        [&] { find_turned_elements(); },
        [&] { measure_near_cuts(mesh_, is_cut_, report_.near_cuts, report_.off_cuts); }};
    parallel_for(std::size(parts), [&](std::size_t i) { parts[i](); });
    measure_surface(*elements);
    return report_;
  }

 private:
  /// A place on the mesh with its curve or, if that is -1, its face.
  struct Sample {
    Vec3 x;
    int face, curve = -1;
  };

  /// Returns the distance to the true surface near a face, in diagonals. `near` is the distance of a nearby
  /// place, in its unit.
  double to_face(int face, const Vec3& x, double& near) const {
    return (projector_ ? norm(projector_->to_face(face, x) - x) : to_triangles(x, near)) / diagonal_;
  }
  /// Returns the distance to the triangles. Most places lie about as far away as the previous one.
  double to_triangles(const Vec3& x, double& near) const {
    constexpr double kOnIt = 1e-9;
    NearestTriangle::Found found = triangles_[0].find(x, 2 * near + kOnIt * diagonal_);
    if (found.triangle < 0) found = triangles_[0].find(x);
    return near = found.distance;
  }
  double to_curve(int curve, const Vec3& x) const {
    return norm(projector_->to_curve(curve, x) - x) / diagonal_;
  }

  /// Returns the size in diagonals.
  double size_at(const Vec3& x, int& hint) const { return size_ ? size_->at(x, hint) / diagonal_ : kInf; }

  void measure(const std::vector<Sample>& samples, Distances& distances) const {
    std::vector<double> found(samples.size()), sizes(samples.size());
    parallel_ranges(samples.size(), [&](std::size_t begin, std::size_t end) {
      double near = 0;
      int hint = -1;
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [x, face, curve] = samples[i];
        found[i] = curve >= 0 ? to_curve(curve, x) : to_face(face, x, near);
        sizes[i] = size_at(x, hint);
      }
    });
    for (std::size_t i = 0; i < samples.size(); ++i)
      distances.add(found[i], sizes[i], {samples[i].x, samples[i].face});
  }

  void find_turned_elements() {
    const FaceNormals normals(fine_);
    std::vector<Place> centres;
    std::vector<char> turned;
    for_each_element(mesh_, [&](int element, const auto& v) {
      Vec3 centre;
      for (const int i : v) centre = centre + (1.0 / static_cast<double>(v.size())) * mesh_.points[i];
      centres.push_back({centre, region_of(mesh_, element)});
    });
    turned.resize(centres.size(), 0);
    const std::size_t n_triangles = mesh_.triangles.size();
    const auto is_turned = [&](const Place& centre, const auto& v) {
      double reach = 0;
      for (const int i : v) reach = std::max(reach, norm(mesh_.points[i] - centre.at));
      const auto& p = mesh_.points;
      const Vec3 normal = v.size() == 3 ? cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]])
                                        : cross(p[v[2]] - p[v[0]], p[v.back()] - p[v[1]]);
      return normals.all_point_away(centre, normal, reach);
    };
    parallel_ranges(centres.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e)
        turned[e] = e < n_triangles ? is_turned(centres[e], mesh_.triangles[e])
                                    : is_turned(centres[e], mesh_.quads[e - n_triangles]);
    });
    for (std::size_t e = 0; e < centres.size(); ++e)
      if (turned[e]) report_.turned_elements.add(centres[e]);
  }

  void measure_elements() {
    std::vector<Sample> samples;
    const std::vector<int> elements_on_curve = elements_on_curves(fine_);
    for_each_edge(std::span<const HalfEdge>(sides_), [&](std::span<const HalfEdge> edge) {
      const auto& [lo, hi, element, forward] = edge[0];
      const int curve = lines_.curve_of(lo, hi);
      const int wanted = curve < 0 || is_cut_[curve] ? 2 : elements_on_curve[curve];
      if (static_cast<int>(edge.size()) != wanted)
        report_.nonconforming_edges.add(
            {0.5 * (mesh_.points[lo] + mesh_.points[hi]), region_of(mesh_, element)});
      const bool on_true_curve = projector_ && curve >= 0 && !is_cut_[curve];
      samples.push_back({0.5 * (mesh_.points[lo] + mesh_.points[hi]), region_of(mesh_, element),
                         on_true_curve ? curve : -1});
    });
    for_each_element(mesh_, [&](int element, const auto& v) {
      Vec3 centre;
      for (const int i : v) centre = centre + (1.0 / static_cast<double>(v.size())) * mesh_.points[i];
      samples.push_back({centre, region_of(mesh_, element)});
    });
    measure(samples, report_.mesh_to_surface);
  }

  struct Node {
    std::vector<int> curves, faces;
    int lines = 0;
  };

  void measure_nodes() {
    std::vector<Node> on_lines(mesh_.points.size());
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      for (const int v : mesh_.lines[l]) {
        Node& node = on_lines[v];
        ++node.lines;
        if (std::ranges::find(node.curves, mesh_.line_curve[l]) == node.curves.end())
          node.curves.push_back(mesh_.line_curve[l]);
      }
    std::vector<Sample> inside;
    std::vector<char> seen(mesh_.points.size(), 0);
    for_each_element(mesh_, [&](int element, const auto& vertices) {
      const int face = region_of(mesh_, element);
      for (const int v : vertices) {
        if (auto& faces = on_lines[v].faces; on_lines[v].lines > 0) {
          if (std::ranges::find(faces, face) == faces.end()) faces.push_back(face);
        } else if (!std::exchange(seen[v], 1)) {
          inside.push_back({mesh_.points[v], face});
        }
      }
    });
    measure(inside, report_.nodes_in_faces);
    measure_nodes_on_lines(on_lines);
  }

  void measure_nodes_on_lines(const std::vector<Node>& nodes) {
    std::vector<double> distances(nodes.size(), kInf), sizes(nodes.size());
    parallel_ranges(nodes.size(), [&](std::size_t begin, std::size_t end) {
      double near = 0;
      int hint = -1;
      for (std::size_t v = begin; v < end; ++v) {
        if (nodes[v].lines > 0) sizes[v] = size_at(mesh_.points[v], hint);
        for (const int c : nodes[v].curves)
          if (projector_ && !is_cut_[c]) distances[v] = std::min(distances[v], to_curve(c, mesh_.points[v]));
        for (const int f : nodes[v].faces)
          distances[v] = std::min(distances[v], to_face(f, mesh_.points[v], near));
      }
    });
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      if (nodes[v].lines == 0 || !std::isfinite(distances[v])) continue;
      const bool corner = nodes[v].curves.size() > 1 || nodes[v].lines != 2;
      const int face = nodes[v].faces.empty() ? -1 : nodes[v].faces[0];
      (corner ? report_.nodes_at_corners : report_.nodes_on_curves)
          .add(distances[v], sizes[v], {mesh_.points[v], face});
    }
  }

  std::vector<Place> places_on_surface() const {
    constexpr double kSpacing = 1.0 / 50;  // part of the diagonal
    std::vector<Place> places;
    std::vector<char> seen(fine_.points.size(), 0);
    for (std::size_t t = 0; t < fine_.triangles.size(); ++t) {
      const auto& v = fine_.triangles[t];
      const int face = fine_.triangle_region[t];
      for (const int i : v)
        if (!std::exchange(seen[i], 1)) places.push_back({fine_.points[i], face});
      const Vec3 a = fine_.points[v[0]], ab = fine_.points[v[1]] - a, ac = fine_.points[v[2]] - a;
      const int n = static_cast<int>(std::sqrt(norm(cross(ab, ac))) / (kSpacing * diagonal_));
      if (n < 2) continue;
      for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j)
          places.push_back({a + ((i + 1.0 / 3) / n) * ab + ((j + 1.0 / 3) / n) * ac, face});
    }
    return places;
  }

  void measure_surface(const NearestElement& elements) {
    const std::vector<Place> places = places_on_surface();
    std::vector<double> distances(places.size()), sizes(places.size());
    parallel_ranges(places.size(), [&](std::size_t begin, std::size_t end) {
      double reach = kInf;
      int hint = -1;
      for (std::size_t i = begin; i < end; ++i) {
        distances[i] = elements.distance(places[i].at, reach);
        sizes[i] = size_at(places[i].at, hint);
        if (i + 1 == end) break;
        // The distance changes by at most the step between places.
        constexpr double kRounding = 1 + 1e-9;
        reach = kRounding * (distances[i] + norm(places[i + 1].at - places[i].at)) +
                kRounding * 1e-12 * diagonal_;
      }
    });
    for (std::size_t i = 0; i < places.size(); ++i)
      report_.surface_to_mesh.add(distances[i] / diagonal_, sizes[i], places[i]);
  }

  const SurfaceProjector* projector_;
  const SizeField* size_;
  Mesh fine_;
  const Mesh& mesh_;
  double diagonal_;
  LineIndex lines_;
  std::span<const HalfEdge> sides_;  ///< of the mesh
  std::vector<char> is_cut_;
  std::vector<NearestTriangle> triangles_;  ///< one, for a model without a projector
  SurfaceReport report_;
};

}  // namespace

void Distances::add(double distance) {
  ++samples;
  max = std::max(max, distance);
  mean += (distance - mean) / samples;
  mean_square += (distance * distance - mean_square) / samples;
}

void Distances::add(double distance, double size, const Place& place) {
  add(distance);
  max_in_sizes = std::max(max_in_sizes, distance / size);
  if (distance > kExplainedSizes * size) unexplained.add(place);
}

Topology topology_of(const Mesh& mesh, std::span<const HalfEdge> sides) {
  Topology topology;
  std::vector<char> used(mesh.points.size(), 0);
  for_each_element(mesh, [&](int, const auto& v) {
    ++topology.euler_characteristic;
    for (const int i : v)
      if (!std::exchange(used[i], 1)) ++topology.euler_characteristic;
  });
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    --topology.euler_characteristic;
    topology.free_edges += edge.size() == 1;
    topology.branching_edges += edge.size() > 2;
    topology.disagreeing_edges += edge.size() == 2 && edge[0].forward == edge[1].forward;
  });
  return topology;
}

Topology topology_of(const Mesh& mesh) { return topology_of(mesh, sorted_half_edges(mesh)); }

std::vector<char> irregular_curves(const Mesh& fine) {
  std::vector<char> irregular(fine.curves.size(), 0);
  for_each_edge_on_curve(fine, [&](int curve, std::span<const HalfEdge> edge) {
    if (edge.size() > 2 || (edge.size() == 2 && edge[0].forward == edge[1].forward)) irregular[curve] = 1;
  });
  return irregular;
}

MapReport report_maps(std::span<const FlatPatch* const> maps) {
  MapReport report;
  double area = 0, sum = 0;
  for (const FlatPatch* patch : maps) {
    report.patches.push_back({patch->face, patch->method, patch->quality});
    double own = 0;
    for (const auto& [a, b, c] : patch->flat.triangles) {
      const auto& p = patch->flat.points;
      own += cross(p[b] - p[a], p[c] - p[a]) / 2;
    }
    area += own;
    sum += own * patch->quality.sigma_mean;
    if (report.worst_face < 0 || patch->quality.sigma_95 > report.sigma_95) report.worst_face = patch->face;
    report.sigma_95 = std::max(report.sigma_95, patch->quality.sigma_95);
    report.sigma_max = std::max(report.sigma_max, patch->quality.sigma_max);
    report.area_ratio = std::max(report.area_ratio, patch->quality.area_ratio);
  }
  if (area > 0) report.sigma_mean = sum / area;
  return report;
}

SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh, const SizeField* size) {
  return report_surface(model, cuts, left_out, mesh, sorted_half_edges(mesh), size);
}

SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             std::span<const HalfEdge> sides, const SizeField* size) {
  assert(left_out.size() == model.fine.regions.size());
  assert(has_finite_points(mesh));
  return Comparison(model, cuts, left_out, mesh, sides, size).run();
}

}  // namespace delquad
