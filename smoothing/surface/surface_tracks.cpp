// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/surface_tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/parallel.h"

namespace delquad {

namespace {

/// Returns the place of the patch's map nearest to u.
Vec2 place_within(const SurfacePatch& patch, Vec2 u, int& hint) {
  const auto [t, weights] = patch.background->locate(u, hint);
  Vec2 place;
  for (int k = 0; k < 3; ++k) place += weights[k] * patch.map.flat.points[patch.map.flat.triangles[t][k]];
  return place;
}

/// Returns the sum of triangle normals at each vertex of a patch's map, weighted by area.
std::vector<Vec3> vertex_normals(const SurfacePatch& patch, const Mesh& fine) {
  std::vector<Vec3> normals(patch.map.flat.points.size());
  for (const auto& v : patch.map.flat.triangles) {
    const auto x = [&](int k) { return fine.points[patch.map.fine_node[v[k]]]; };
    const Vec3 normal = cross(x(1) - x(0), x(2) - x(0));
    for (const int i : v) normals[i] = normals[i] + normal;
  }
  return normals;
}

}  // namespace

SurfaceTracks::SurfaceTracks(const SurfaceModel& model, const SizeField& size, const SurfaceDomain& domain,
                             SurfaceNodes& nodes, std::vector<Patch> patches)
    : model_(model),
      size_(size),
      domain_(domain),
      nodes_(nodes),
      patches_(std::move(patches)),
      on_curve_(nodes.points.size()),
      points_(nodes.points),
      position_(nodes.points.size()),
      stays_(nodes.points.size(), 0),
      vertex_patch_(nodes.points.size(), -1) {
  add_curves();
  for (const PatchCap& c : domain.caps)
    for (const auto& quad : c.cap.quads)
      for (const int node : quad) on_curve_[node] = {};
  for (const Patch& patch : patches_) add_patch(patch);
  hint_.assign(points_.size(), -1);
}

void SurfaceTracks::add_curves() {
  for (std::size_t c = 0; c < domain_.chains.size(); ++c) {
    const auto& points = domain_.chains[c].points;
    auto& length = lengths_.emplace_back(1, 0.0);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      length.push_back(length.back() +
                       norm(model_.fine.points[points[i + 1]] - model_.fine.points[points[i]]));
    if (domain_.chain_stays[c]) continue;
    const auto& on_curve = nodes_.on_curve[c];
    for (std::size_t k = 1; k + 1 < on_curve.size(); ++k) {
      const auto line = std::min(static_cast<std::size_t>(on_curve[k].s), points.size() - 2);
      const double t = on_curve[k].s - static_cast<double>(line);
      on_curve_[on_curve[k].node] = {static_cast<int>(c), k};
      position_[on_curve[k].node] = {length[line] + t * (length[line + 1] - length[line]), 0};
    }
  }
}

void SurfaceTracks::add_patch(const Patch& patch) {
  const int p = static_cast<int>(&patch - patches_.data());
  first_quad_.push_back(static_cast<int>(quads_.size()));
  normals_.push_back(vertex_normals(*patch.patch, model_.fine));
  std::vector<int> vertex = patch.patch->boundary.point_node;
  for (std::size_t i = 0; i < patch.inside->size(); ++i) {
    vertex.push_back(static_cast<int>(points_.size()));
    points_.push_back((*patch.inside)[i]);
    position_.push_back(patch.mesh->points[patch.mesh->n_boundary + i]);
    vertex_patch_.push_back(p);
  }
  for (std::array<int, 4> quad : patch.mesh->quads) {
    for (int& v : quad) v = vertex[v];
    quads_.push_back(quad);
    quad_patch_.push_back(p);
  }
  stays_.resize(points_.size(), 0);
  for (const auto& triangle : patch.mesh->triangles)
    for (const int v : triangle) stays_[vertex[v]] = 1;
}

double SurfaceTracks::s_at(int chain, double length) const {
  const auto& lengths = lengths_[chain];
  const auto after = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, length);
  const double before = *(after - 1);
  const double t = *after > before ? (length - before) / (*after - before) : 0;
  return static_cast<double>(after - lengths.begin() - 1) + std::clamp(t, 0.0, 1.0);
}

Vec3 SurfaceTracks::direction(int chain, double length) const {
  const auto& points = domain_.chains[chain].points;
  const auto line = std::min(static_cast<std::size_t>(s_at(chain, length)), points.size() - 2);
  const Vec3 along = model_.fine.points[points[line + 1]] - model_.fine.points[points[line]];
  const double n = norm(along);
  return n > 0 ? (1 / n) * along : Vec3{};
}

Vec3 SurfaceTracks::put(int v, Vec2 position) {
  if (vertex_patch_[v] >= 0) {
    position_[v] = position;
    return lift(*patches_[vertex_patch_[v]].patch, model_, position, hint_[v]);
  }
  const auto [chain, k] = on_curve_[v];
  position_[v] = {std::clamp(position.x, 0.0, lengths_[chain].back()), 0};
  nodes_.on_curve[chain][k].s = s_at(chain, position_[v].x);
  return place_on_curve(model_, domain_.chains[chain], domain_.cut_face, nodes_.on_curve[chain][k].s);
}

SurfaceTracks::TrackPlace SurfaceTracks::track_place_near(int v, const TrackPlace& from,
                                                          const Vec3& x) const {
  const Vec3 d = x - from.place;
  if (is_on_curve(v)) {
    const int chain = on_curve_[v].chain;
    const double length =
        std::clamp(from.position.x + dot(d, direction(chain, from.position.x)), 0.0, lengths_[chain].back());
    return {{length, 0},
            place_on_curve(model_, domain_.chains[chain], domain_.cut_face, s_at(chain, length))};
  }
  const SurfacePatch& patch = *patches_[vertex_patch_[v]].patch;
  int hint = hint_[v];
  const auto [a, b] = tangents(patch, model_.fine, patch.background->locate(from.position, hint).triangle);
  const Vec2 u =
      place_within(patch, from.position + Vec2{dot(a, d) / dot(a, a), dot(b, d) / dot(b, b)}, hint);
  return {u, model_.projector ? model_.projector->to_face(patch.map.face, x) : lift(patch, model_, u, hint)};
}

void SurfaceTracks::put(int v, const TrackPlace& spot) {
  position_[v] = spot.position;
  if (!is_on_curve(v)) return;
  const auto [chain, k] = on_curve_[v];
  nodes_.on_curve[chain][k].s = s_at(chain, spot.position.x);
}

std::vector<Vec3> SurfaceTracks::normals() const {
  std::vector<Vec3> normals(quads_.size());
  parallel_for(
      patches_.size(),
      [&](std::size_t p) {
        const SurfacePatch& patch = *patches_[p].patch;
        const QuadPatch& mesh = *patches_[p].mesh;
        std::vector<Vec3> at;
        int hint = -1;
        for (const Vec2 u : mesh.points) {
          const auto [t, weights] = patch.background->locate(u, hint);
          Vec3& sum = at.emplace_back();
          for (int i = 0; i < 3; ++i) sum = sum + weights[i] * normals_[p][patch.map.flat.triangles[t][i]];
        }
        for (std::size_t q = 0; q < mesh.quads.size(); ++q)
          for (const int v : mesh.quads[q]) normals[first_quad_[p] + q] = normals[first_quad_[p] + q] + at[v];
      },
      [&](std::size_t p) { return static_cast<double>(patches_[p].mesh->points.size()); });
  return normals;
}

std::array<Vec3, 2> SurfaceTracks::axes(int v) const {
  if (stays_[v]) return {};
  if (vertex_patch_[v] >= 0) {
    const SurfacePatch& patch = *patches_[vertex_patch_[v]].patch;
    return tangents(patch, model_.fine, patch.background->locate(position_[v], hint_[v]).triangle);
  }
  if (on_curve_[v].chain < 0) return {};
  return {direction(on_curve_[v].chain, position_[v].x), Vec3{}};
}

Vec3 SurfaceTracks::arm(int quad, int side, TrackHint& hint) const {
  const Patch& patch = patches_[quad_patch_[quad]];
  const int a = quads_[quad][side], b = quads_[quad][(side + 1) % 4];
  // Parameters of nodes on curves may be stale; the inner end is enough.
  const int inside = vertex_patch_[a] >= 0 ? a : b;
  if (vertex_patch_[inside] < 0) return {};
  Vec2 u = position_[inside];
  if (vertex_patch_[a] >= 0 && vertex_patch_[b] >= 0) u = 0.5 * (position_[a] + position_[b]);
  int map_hint = hint_[inside];
  const auto axis =
      tangents(*patch.patch, model_.fine, patch.patch->background->locate(u, map_hint).triangle);
  const Cross c = patch.cross->at(u, hint.cross_of(quad_patch_[quad]));
  if (c.c == 0 && c.s == 0) return {};
  const double angle = c.angle();
  const Vec3 arm = std::cos(angle) * axis[0] + std::sin(angle) * axis[1];
  return (1 / norm(arm)) * arm;
}

void SurfaceTracks::store(const std::vector<Vec3>& points) {
  std::copy_n(points.begin(), nodes_.points.size(), nodes_.points.begin());
  std::size_t v = nodes_.points.size();
  for (const Patch& patch : patches_) {
    const PatchBoundary boundary =
        place_boundary(patch.patch->map, patch.patch->outline, domain_.chains, nodes_);
    std::map<std::pair<int, int>, std::array<int, 2>> edges;  // by nodes
    for (const auto& [a, b] : boundary.edges)
      edges[{boundary.point_node[a], boundary.point_node[b]}] = {a, b};
    // Caps and layers have other edges.
    const PatchBoundary& own = patch.patch->boundary;
    for (const auto& edge : own.edges) {
      const auto found = edges.find({own.point_node[edge[0]], own.point_node[edge[1]]});
      for (const int end : {0, 1})
        if (found != edges.end() && is_on_curve(own.point_node[edge[end]]))
          patch.mesh->points[edge[end]] = boundary.points[found->second[end]];
    }
    for (std::size_t i = 0; i < patch.inside->size(); ++i, ++v) {
      patch.mesh->points[patch.mesh->n_boundary + i] = position_[v];
      (*patch.inside)[i] = points[v];
    }
  }
}

}  // namespace delquad
