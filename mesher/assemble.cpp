// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <functional>

#include "base/activity.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "features/curved/curved_mesh.h"
#include "features/layers/add_layers.h"
#include "features/metric/metric_surface.h"
#include "features/periodic/periodic.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "mesher/cross_in_space.h"
#include "mesher/runner.h"
#include "metrics/anisotropic_measures.h"

namespace delquad {
namespace {

/// Returns the mesh node of each point of a patch, and adds nodes for the points inside.
std::vector<int> add_points(const std::vector<Vec3>& inside, const PatchSetup& patch, Mesh& mesh) {
  std::vector<int> node = patch.boundary.point_node;
  for (const Vec3& x : inside) {
    node.push_back(static_cast<int>(mesh.points.size()));
    mesh.points.push_back(x);
  }
  return node;
}

template <std::size_t N>
void add_elements(const std::vector<std::array<int, N>>& elements, const std::vector<int>& node, int region,
                  std::vector<std::array<int, N>>& target, std::vector<int>& target_region) {
  target.reserve(target.size() + elements.size());
  for (std::array<int, N> element : elements) {
    for (int& v : element) v = node[v];
    target.push_back(element);
    target_region.push_back(region);
  }
}

/// Adds the quads of caps; before recombination each is two triangles.
void add_caps(const SurfaceDomain& domain, const std::vector<PatchMesh>& patches,
              const std::vector<char>& left_out, Mesh& mesh) {
  for (const auto& [patch, cap] : domain.caps) {
    const int region = domain.patches[patch].map.face;
    if (left_out[region]) continue;
    for (const auto& [a, b, c, d] : cap.quads) {
      if (patches[patch].form == PatchForm::kTriangles) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        mesh.triangle_region.insert(mesh.triangle_region.end(), 2, region);
      } else {
        mesh.quads.push_back({a, b, c, d});
        mesh.quad_region.push_back(region);
      }
    }
  }
}

}  // namespace

Mesh assemble(const MeshingSetup& prepared, const std::vector<Vec3>& nodes,
              const std::vector<PatchMesh>& patches, const std::vector<char>& left_out, StageLog* log) {
  const Stopwatch projection;
  const StageScope projecting("projection");
  std::vector<std::vector<Vec3>> inside(patches.size());
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        if (left_out[prepared.patches[i].region]) return;
        const FaceScope face = patch_scope(prepared, i);
        inside[i] =
            patches[i].inside.empty() ? places_inside(prepared, i, patches[i], nodes) : patches[i].inside;
      },
      [&](std::size_t i) { return static_cast<double>(points_of(patches[i]).size()); });
  Mesh mesh = prepared.boundary;
  mesh.points = nodes;
  keep_elements(mesh.quads, mesh.quad_region, [&](std::size_t q) { return !left_out[mesh.quad_region[q]]; });
  const std::size_t n_in_layers = mesh.quads.size();
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const PatchMesh& patch = patches[i];
    const int region = prepared.patches[i].region;
    if (left_out[region]) continue;
    const auto node = add_points(inside[i], prepared.patches[i], mesh);
    if (patch.form == PatchForm::kTriangles) {
      add_elements(patch.triangles.triangles, node, region, mesh.triangles, mesh.triangle_region);
    } else {
      add_elements(patch.quads.triangles, node, region, mesh.triangles, mesh.triangle_region);
      add_elements(patch.quads.quads, node, region, mesh.quads, mesh.quad_region);
    }
  }
  if (prepared.surface) {
    const SurfaceDomain& domain = prepared.surface->domain;
    add_caps(domain, patches, left_out, mesh);
    add_face_images(left_out, mesh);
    if (prepared.surface->mirrored)
      mesh = mirror_mesh(*prepared.surface->mirrored, std::move(mesh), n_in_layers);
    if (!domain.caps.empty() || prepared.layers) drop_unused_points(mesh);
  }
  if (std::ranges::find(left_out, 1) != left_out.end()) {
    drop_stray_lines(mesh, sorted_half_edges(mesh));
    drop_unused_points(mesh);
  }
  if (log != nullptr) log->add_time("projection", projection.time());
  return mesh;
}

void measure(const MeshingSetup& prepared, const std::vector<char>& left_out, MeshResult& result) {
  const StageScope measuring("report");
  TimeSpent metrics_time, report_time, soundness_time;
  // A point that is not finite has no distance to a surface.
  const bool has_report = prepared.surface && has_finite_points(result.mesh);
  const Stopwatch sorting;
  const std::vector<HalfEdge> sides = sorted_half_edges(result.mesh);
  const TimeSpent sorted = sorting.time();
  const std::function<void()> parts[] = {
      [&] {
        const Stopwatch watch;
        result.metrics = metrics_of(prepared, result.mesh, sides);
        metrics_time = watch.time();
      },
      [&] {
        const Stopwatch watch;
        if (has_report) {
          const SurfaceSetup& surface = *prepared.surface;
          result.surface = report_surface(
              surface.whole(), surface.all_cuts(),
              surface.mirrored ? with_images(*surface.mirrored, left_out) : left_out, result.mesh, sides,
              surface.mirrored ? prepared.size.field.get() : surface.size.get());
          report_time = watch.time();
        }
        const Stopwatch checking;
        result.soundness =
            check_soundness(prepared, result.mesh, result.surface ? &*result.surface : nullptr, sides);
        soundness_time = checking.time();
      }};
  parallel_for(std::size(parts), [&](std::size_t i) { parts[i](); });
  result.log.add_time("metrics", sorted + metrics_time);
  if (has_report) result.log.add_time("surface report", report_time);
  result.log.add_time("soundness", soundness_time);
}

void add_misalignment(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides,
                      MeshMetrics& metrics) {
  if (mesh.quads.empty() || !has_finite_points(mesh)) return;
  if (const CrossInSpace cross_at = cross_in_space(prepared))
    metrics.values["misalignment"] = mean_misalignment(mesh, sides, cross_at);
}

MeshMetrics metrics_of(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides) {
  const MetricAt metric = metric_of(prepared);
  if (!metric) {
    MeshMetrics metrics = measure_builtin(mesh, prepared.size.field.get(), prepared.size.asked.get(), sides,
                                          quads_in_layers(prepared, mesh));
    add_misalignment(prepared, mesh, sides, metrics);
    return metrics;
  }
  MeshMetrics metrics = measure_builtin(mesh, nullptr, nullptr, sides);
  metrics.values.merge(measure_anisotropic(mesh, sides, metric));
  return metrics;
}

void measure_added_metrics(const MeshingSetup& prepared, const Mesh& mesh, const std::string& pipeline,
                           MeshMetrics& metrics) {
  const StageScope measuring("metrics");
  const bool by_size = !metric_of(prepared);
  measure_added_metrics(
      {mesh, by_size ? prepared.size.field.get() : nullptr, by_size ? prepared.size.asked.get() : nullptr,
       prepared.settings.options, prepared.settings.name, pipeline,
       prepared.surface ? &prepared.surface->whole().fine : nullptr},
      metrics);
}

void measure_straight_form(const MeshingSetup& prepared, const std::vector<char>& left_out,
                           MeshResult& result) {
  MeshResult straight;
  straight.mesh = straight_form(result.mesh);
  measure(prepared, left_out, straight);
  result.log.add(straight.log);
  result.metrics = std::move(straight.metrics);
  result.surface = std::move(straight.surface);
  for (std::string& reason : straight.soundness.reasons)
    result.soundness.reasons.push_back(std::move(reason));
  result.soundness.places.insert(result.soundness.places.end(), straight.soundness.places.begin(),
                                 straight.soundness.places.end());
}

void put_back_entities(const GivenEntities& given, Mesh& mesh) {
  for (int& curve : mesh.line_curve) curve = given.curve_of[curve];
  keep_lines(mesh, [&](std::size_t l) { return mesh.line_curve[l] >= 0; });
  for (auto* regions : {&mesh.triangle_region, &mesh.quad_region})
    for (int& region : *regions) region = given.region_of[region];
  mesh.curves = given.curves;
  mesh.regions = given.regions;
}

}  // namespace delquad
