#include "report/closeup.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/metrics.h"

namespace delquad {
namespace {

constexpr int kRings = 3;

std::vector<int> vertices_of(const Mesh& mesh, int element) {
  const int n = static_cast<int>(mesh.triangles.size());
  if (element >= n) return {mesh.quads[element - n].begin(), mesh.quads[element - n].end()};
  return {mesh.triangles[element].begin(), mesh.triangles[element].end()};
}

/// The quads in question, worst first.
std::vector<int> pick(const Mesh& mesh, const std::vector<double>& eta, std::size_t count) {
  std::vector<int> order(mesh.quads.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int q) { return eta[q]; });
  std::vector<int> picked;
  std::set<int> taken;
  for (const int q : order) {
    if (picked.size() == count) break;
    if (std::ranges::any_of(mesh.quads[q], [&](int v) { return taken.contains(v); })) continue;
    taken.insert(mesh.quads[q].begin(), mesh.quads[q].end());
    picked.push_back(q);
  }
  return picked;
}

/// Elements within kRings of an element, itself first.
class Surroundings {
 public:
  explicit Surroundings(const Mesh& mesh) : mesh_(mesh), start_(mesh.points.size() + 1, 0) {
    for_each_element(mesh, [&](int, const auto& v) {
      for (const int i : v) ++start_[i + 1];
    });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    around_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<int> next = start_;
    for_each_element(mesh, [&](int element, const auto& v) {
      for (const int i : v) around_[next[i]++] = element;
    });
  }

  std::vector<int> of(int element) const {
    std::vector<int> found = {element};
    std::set<int> known = {element};
    std::size_t first = 0;
    for (int ring = 0; ring < kRings; ++ring) {
      const std::size_t end = found.size();
      for (; first < end; ++first)
        for (const int v : vertices_of(mesh_, found[first]))
          for (int k = start_[v]; k < start_[v + 1]; ++k)
            if (known.insert(around_[k]).second) found.push_back(around_[k]);
    }
    return found;
  }

 private:
  const Mesh& mesh_;
  std::vector<int> start_, around_;  // elements by vertex
};

/// Maps space to the plane of a quad, in units of its mean edge.
struct View {
  Vec3 centre{0, 0, 0}, right, up, normal;
  double unit;
  explicit View(const Mesh& mesh, const std::array<int, 4>& v) {
    const auto& p = mesh.points;
    double edges = 0;
    for (int k = 0; k < 4; ++k) {
      centre = centre + 0.25 * p[v[k]];
      edges += norm(p[v[(k + 1) % 4]] - p[v[k]]);
    }
    unit = edges > 0 ? 4 / edges : 1;
    normal = cross(p[v[2]] - p[v[0]], p[v[3]] - p[v[1]]);
    if (!(norm(normal) > 0)) normal = {0, 0, 1};
    normal = (1 / norm(normal)) * normal;
    const bool is_flat = std::abs(normal.z) > 1 - 1e-9;  // then as the mesh lies
    right = is_flat ? Vec3{1, 0, 0} : cross(Vec3{0, 0, 1}, normal);
    right = (unit / norm(right)) * right;
    up = is_flat ? Vec3{0, unit, 0} : cross(normal, right);
  }
  Vec2 operator()(const Vec3& p) const { return {dot(p - centre, right), dot(p - centre, up)}; }
};

Closeup look_at(const Mesh& mesh, const std::vector<double>& eta, const Surroundings& surroundings,
                int quad) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  const View view(mesh, mesh.quads[quad]);
  Closeup closeup{eta[quad], 1 / view.unit, view.normal, view.centre, {}, {}, {}};
  std::map<int, int> number;
  for (const int element : surroundings.of(n_triangles + quad)) {
    std::vector<int> corners = element < n_triangles
                                   ? vertices_of(mesh, element)
                                   : nodes_around(mesh, static_cast<std::size_t>(element - n_triangles));
    for (int& v : corners) {
      const auto [at, is_new] = number.try_emplace(v, static_cast<int>(number.size()));
      if (is_new) closeup.points.push_back(view(mesh.points[v]));
      v = at->second;
    }
    closeup.elements.push_back(std::move(corners));
    closeup.etas.push_back(element < n_triangles ? 1 : eta[element - n_triangles]);
  }
  return closeup;
}

}  // namespace

std::vector<Closeup> worst_quads(const Mesh& mesh, std::size_t count) {
  const std::vector<double> eta = quad_etas(mesh);
  const Surroundings surroundings(mesh);
  std::vector<Closeup> closeups;
  for (const int q : pick(mesh, eta, count)) closeups.push_back(look_at(mesh, eta, surroundings, q));
  return closeups;
}

}  // namespace delquad
