#include "mesher/curved_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/activity.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "curved/bernstein.h"
#include "curved/raise_order.h"
#include "curved/untangle_curved.h"
#include "mesh/element_nodes.h"
#include "mesher/curved_geometry.h"

namespace delquad {
namespace {

/// Nodes of periodic lines are images, too.
void pair_curved_lines(Mesh& mesh) {
  for (PeriodicNodes& pair : mesh.periodic) {
    std::map<int, int> master_of;
    for (const auto& [image, master] : pair.nodes) master_of.emplace(image, master);
    std::map<std::array<int, 2>, std::size_t> masters;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      if (mesh.line_curve[l] == pair.master) masters.emplace(mesh.lines[l], l);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      const auto a = master_of.find(mesh.lines[l][0]), b = master_of.find(mesh.lines[l][1]);
      if (mesh.line_curve[l] != pair.curve || a == master_of.end() || b == master_of.end()) continue;
      auto found = masters.find({a->second, b->second});
      const bool forward = found != masters.end();
      if (!forward) found = masters.find({b->second, a->second});
      if (found == masters.end()) continue;
      const std::vector<int> own = nodes_of_line(mesh, l), of = nodes_of_line(mesh, found->second);
      for (std::size_t k = 1; k + 1 < own.size(); ++k) {
        const int master = of[forward ? k : own.size() - 1 - k];
        mesh.points[own[k]] = pair.motion(mesh.points[master]);
        pair.nodes.push_back({own[k], master});
      }
    }
  }
}

/// From places halfway between nodes, where elements are furthest off.
double distance_to_model(const Mesh& mesh, const ModelGeometry& geometry) {
  std::vector<double> of_quads(mesh.quads.size(), 0);
  parallel_ranges(of_quads.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::vector<Vec3> places;
      for (const int v : nodes_of_quad(mesh, q)) places.push_back(mesh.points[v]);
      const Bernstein<Vec3> map = bernstein_of(places, mesh.order);
      for (int j = 0; j < mesh.order; ++j)
        for (int i = 0; i < mesh.order; ++i) {
          const Vec3 x = value_at(map, (i + 0.5) / mesh.order, (j + 0.5) / mesh.order);
          of_quads[q] = std::max(of_quads[q], norm(x - geometry.on_face(mesh.quad_region[q], x)));
        }
    }
  });
  std::vector<double> of_lines(mesh.lines.size(), 0);
  parallel_ranges(of_lines.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l) {
      std::vector<Vec3> places;
      for (const int v : nodes_of_line(mesh, l)) places.push_back(mesh.points[v]);
      std::vector<double> parts;
      for (int i = 0; i < mesh.order; ++i) parts.push_back((i + 0.5) / mesh.order);
      const std::vector<Vec3> wanted = geometry.on_line(static_cast<int>(l), parts);
      for (int i = 0; i < mesh.order; ++i)
        of_lines[l] = std::max(of_lines[l], norm(value_on_line(places, parts[i]) - wanted[i]));
    }
  });
  double most = 0;
  for (const auto* distances : {&of_quads, &of_lines})
    for (const double d : *distances) most = std::max(most, d);
  return most / diagonal(mesh);
}

void tell_unproven(const Mesh& mesh, const std::vector<JacobianBounds>& bounds, Soundness& soundness) {
  Places places;
  std::string text;
  for (std::size_t q = 0; q < bounds.size(); ++q) {
    if (bounds[q].positive()) continue;
    Vec3 centre;
    for (const int v : mesh.quads[q]) centre = centre + 0.25 * mesh.points[v];
    constexpr int kShown = 3;
    if (places.count < kShown)
      text += fmt::format("{} ({:.6g}, {:.6g}, {:.6g}) in {} {}", places.count > 0 ? "," : "", centre.x,
                          centre.y, centre.z, "region", mesh.regions[mesh.quad_region[q]].tag);
    places.add({centre, mesh.quad_region[q]});
  }
  if (places.count == 0) return;
  soundness.reasons.push_back(fmt::format("{} curved element{} not proven to be positive, at{}", places.count,
                                          places.count == 1 ? " is" : "s are", text));
  soundness.places.insert(soundness.places.end(), places.first.begin(), places.first.end());
}

}  // namespace

void curve_mesh(const PreparedProblem& prepared, const SurfaceNodes& nodes, RunResult& result) {
  Mesh& mesh = result.mesh;
  if (prepared.order == 1 || !result.soundness.sound()) return;
  if (!mesh.triangles.empty())
    throw InputError(fmt::format("{}: elements of order {} need a mesh of quads alone: {} triangles are left",
                                 prepared.where, prepared.order, mesh.triangles.size()));
  const Stopwatch watch;
  const DoingStage curving("curving");
  CurvingSummary summary;
  summary.order = prepared.order;
  const Mesh straight = mesh;
  const auto geometry = geometry_behind(prepared, nodes, straight);
  summary.distance_straight = distance_to_model(straight, *geometry);
  raise_order(mesh, prepared.order, *geometry);
  pair_curved_lines(mesh);
  std::vector<JacobianBounds> bounds = jacobian_bounds(mesh);
  const UntanglingSummary untangled = untangle_curved(mesh, *geometry, bounds);
  summary.poor = untangled.poor;
  summary.improved = untangled.improved;
  const ProvenJacobians proven = proven_jacobians(bounds);
  summary.unproven = proven.unproven;
  summary.least_jacobian = proven.least;
  summary.mean_jacobian = proven.mean;
  summary.distance = distance_to_model(mesh, *geometry);
  tell_unproven(mesh, bounds, result.soundness);
  summary.seconds = watch.work_seconds();
  add_summary(result.log, summary);
  result.log.add_time("curving", watch.time());
}

}  // namespace delquad
