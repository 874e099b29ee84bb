#include "surfaces/surface_report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "mesh/half_edges.h"
#include "mesh/nearest_triangle.h"

namespace delquad {

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

using Edge = std::array<int, 2>;

Edge sorted_edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The lines of a mesh by their ends.
class LineIndex {
 public:
  explicit LineIndex(const Mesh& mesh) {
    lines_.reserve(mesh.lines.size());
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      lines_.push_back({sorted_edge(mesh.lines[l][0], mesh.lines[l][1]), mesh.line_curve[l]});
    std::ranges::sort(lines_);
  }
  /// The curve of the edge, -1: none.
  int curve_of(int a, int b) const {
    const Edge edge = sorted_edge(a, b);
    const auto at = std::ranges::lower_bound(lines_, std::pair(edge, -1));
    return at != lines_.end() && at->first == edge ? at->second : -1;
  }

 private:
  std::vector<std::pair<Edge, int>> lines_;
};

int region_of(const Mesh& mesh, int element) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  return element < n_triangles ? mesh.triangle_region[element] : mesh.quad_region[element - n_triangles];
}

/// The triangles of a mesh, each quad as four around its centre.
NearestTriangle make_searcher(const Mesh& mesh) {
  std::vector<Vec3> points = mesh.points;
  std::vector<std::array<int, 3>> triangles = mesh.triangles;
  for (const auto& [a, b, c, d] : mesh.quads) {
    const int centre = static_cast<int>(points.size());
    points.push_back(0.25 * (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]));
    triangles.insert(triangles.end(), {{a, b, centre}, {b, c, centre}, {c, d, centre}, {d, a, centre}});
  }
  return NearestTriangle(std::move(points), std::move(triangles));
}

/// The model without the faces that were left out.
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

class Comparison {
 public:
  Comparison(const SurfaceModel& model, std::span<const SurfaceCut> cuts, const std::vector<char>& left_out,
             const Mesh& mesh)
      : projector_(model.projector.get()),
        fine_(without(model.fine, left_out)),
        mesh_(mesh),
        diagonal_(diagonal(model.fine)),
        lines_(mesh),
        is_cut_(model.fine.curves.size(), 0) {
    for (const SurfaceCut& cut : cuts) is_cut_[cut.curve] = 1;
    if (projector_ == nullptr) triangles_.emplace_back(fine_.points, fine_.triangles);
  }

  SurfaceReport run() {
    const auto start = std::chrono::steady_clock::now();
    report_.model = topology_of(fine_);
    report_.mesh = topology_of(mesh_);
    measure_edges();
    measure_elements();
    measure_nodes();
    measure_surface();
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report_;
  }

 private:
  /// Distance to the true surface near a face, in diagonals.
  double to_face(int face, const Vec3& x) const {
    return (projector_ ? norm(projector_->to_face(face, x) - x) : triangles_[0].find(x).distance) / diagonal_;
  }
  double to_curve(int curve, const Vec3& x) const {
    return norm(projector_->to_curve(curve, x) - x) / diagonal_;
  }

  void measure_edges() {
    const std::vector<int> elements_on_curve = elements_on_curves(fine_);
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh_);
    for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
      const auto& [lo, hi, element, forward] = edge[0];
      const int curve = lines_.curve_of(lo, hi);
      const int wanted = curve < 0 ? 2 : elements_on_curve[curve];
      if (static_cast<int>(edge.size()) != wanted) ++report_.nonconforming_edges;
      const Vec3 middle = 0.5 * (mesh_.points[lo] + mesh_.points[hi]);
      report_.mesh_to_surface.add(projector_ && curve >= 0 && !is_cut_[curve]
                                      ? to_curve(curve, middle)
                                      : to_face(region_of(mesh_, element), middle));
    });
  }

  void measure_elements() {
    for_each_element(mesh_, [&](int element, const auto& v) {
      Vec3 centre;
      for (const int i : v) centre = centre + (1.0 / static_cast<double>(v.size())) * mesh_.points[i];
      report_.mesh_to_surface.add(to_face(region_of(mesh_, element), centre));
    });
  }

  void measure_nodes() {
    struct Node {
      std::vector<int> curves, faces;
      int lines = 0;
    };
    std::map<int, Node> on_lines;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      for (const int v : mesh_.lines[l]) {
        Node& node = on_lines[v];
        ++node.lines;
        if (std::ranges::find(node.curves, mesh_.line_curve[l]) == node.curves.end())
          node.curves.push_back(mesh_.line_curve[l]);
      }
    std::vector<char> seen(mesh_.points.size(), 0);
    for_each_element(mesh_, [&](int element, const auto& vertices) {
      const int face = region_of(mesh_, element);
      for (const int v : vertices) {
        if (const auto at = on_lines.find(v); at != on_lines.end()) {
          auto& faces = at->second.faces;
          if (std::ranges::find(faces, face) == faces.end()) faces.push_back(face);
        } else if (!seen[v]) {
          seen[v] = 1;
          report_.nodes_in_faces.add(to_face(face, mesh_.points[v]));
        }
      }
    });
    for (const auto& [v, node] : on_lines) {
      double distance = kInf;
      for (const int c : node.curves)
        if (projector_ && !is_cut_[c]) distance = std::min(distance, to_curve(c, mesh_.points[v]));
      for (const int f : node.faces) distance = std::min(distance, to_face(f, mesh_.points[v]));
      const bool corner = node.curves.size() > 1 || node.lines != 2;
      if (std::isfinite(distance))
        (corner ? report_.nodes_at_corners : report_.nodes_on_curves).add(distance);
    }
  }

  void measure_surface() {
    constexpr double kSpacing = 1.0 / 50;  // of the diagonal
    const NearestTriangle elements = make_searcher(mesh_);
    Vec3 last;
    double distance = kInf;
    const auto add = [&](const Vec3& x) {
      // The distance changes by no more than the point moves.
      constexpr double kRounding = 1 + 1e-9;
      const double reach = kRounding * (distance + norm(x - last)) + kRounding * 1e-12 * diagonal_;
      distance = elements.find(x, reach).distance;
      last = x;
      report_.surface_to_mesh.add(distance / diagonal_);
    };
    std::vector<char> seen(fine_.points.size(), 0);
    for (const auto& v : fine_.triangles) {
      for (const int i : v)
        if (!std::exchange(seen[i], 1)) add(fine_.points[i]);
      const Vec3 a = fine_.points[v[0]], ab = fine_.points[v[1]] - a, ac = fine_.points[v[2]] - a;
      const int n = static_cast<int>(std::sqrt(norm(cross(ab, ac))) / (kSpacing * diagonal_));
      if (n < 2) continue;
      for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) add(a + ((i + 1.0 / 3) / n) * ab + ((j + 1.0 / 3) / n) * ac);
    }
  }

  const SurfaceProjector* projector_;
  Mesh fine_;
  const Mesh& mesh_;
  double diagonal_;
  LineIndex lines_;
  std::vector<char> is_cut_;
  std::vector<NearestTriangle> triangles_;  ///< one, of a model without a projector
  SurfaceReport report_;
};

}  // namespace

void Distances::add(double distance) {
  ++samples;
  max = std::max(max, distance);
  mean += (distance - mean) / samples;
}

Topology topology_of(const Mesh& mesh) {
  Topology topology;
  std::vector<char> used(mesh.points.size(), 0);
  for_each_element(mesh, [&](int, const auto& v) {
    ++topology.euler_characteristic;
    for (const int i : v)
      if (!std::exchange(used[i], 1)) ++topology.euler_characteristic;
  });
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    --topology.euler_characteristic;
    topology.free_edges += edge.size() == 1;
    topology.branching_edges += edge.size() > 2;
    topology.disagreeing_edges += edge.size() == 2 && edge[0].forward == edge[1].forward;
  });
  return topology;
}

std::vector<int> elements_on_curves(const Mesh& mesh) {
  std::vector<int> elements(mesh.curves.size(), 0);
  const LineIndex lines(mesh);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    const int curve = lines.curve_of(edge[0].lo, edge[0].hi);
    if (curve >= 0) elements[curve] = static_cast<int>(edge.size());
  });
  return elements;
}

MapReport report_maps(std::span<const FlatPatch* const> maps) {
  MapReport report;
  report.patches = static_cast<int>(maps.size());
  double area = 0, sum = 0;
  for (const FlatPatch* patch : maps) {
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
                             const std::vector<char>& left_out, const Mesh& mesh) {
  return Comparison(model, cuts, left_out, mesh).run();
}

}  // namespace delquad
