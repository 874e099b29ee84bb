// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/fields/fields.h"
#include "base/activity.h"
#include "base/warning.h"
#include "delquad/mesher.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/planar/planar_model.h"

// This header has a prepared problem: patches with fields, and their model. The pipeline, repairs and
// criteria use it.

namespace delquad {

struct LayerReport;
struct MirroredSurface;
class OppositeSides;

/// A patch, ready for the stages: its boundary and fields in the parameter plane, and the way back to space.
struct PatchSetup {
  PatchBoundary boundary;
  int region = 0;  ///< index into MeshingSetup::boundary.regions
  std::shared_ptr<const CrossField> cross;
  std::shared_ptr<const ParametricSize> size;
  std::function<Vec3(Vec2, int& hint)> lift;
  std::optional<QuadPatch> grid = {};  ///< quads of a mapped face
  bool grid_stays = false;             ///< whether no stage changes the grid, as it was requested
  QuadPatch given = {};  ///< elements from which a pipeline may begin; none unless the model is a GivenMesh
  std::vector<Vec3> given_inside = {};  ///< places in space of its points inside, on a surface
  bool given_stays = false;             ///< whether no stage changes the given elements
};

/// The curves and regions of a given mesh in space, which stages divide.
struct GivenEntities {
  std::vector<Entity> curves, regions;
  std::vector<int> curve_of, region_of;  ///< by entity of the setup's boundary; -1: none
};

/// A symmetric surface, of which one part is meshed, with its cuts.
struct WholeSurface {
  SurfaceModel model;
  std::vector<SurfaceCut> cuts;
};

/// The model and maps that the patches of a surface were made from.
struct SurfaceSetup {
  SurfaceModel model;
  SurfaceDomain domain;
  std::vector<SurfaceCut> cuts;
  std::shared_ptr<const SurfaceSize> size;
  std::shared_ptr<const SurfaceMetric> metric;      ///< in place of a size; null: none
  std::shared_ptr<const MirroredSurface> mirrored;  ///< of symmetric ones, of which `model` is a part
  std::shared_ptr<const WholeSurface> full_model;   ///< that; null: `model` is the whole
  std::optional<GivenEntities> given;               ///< of a GivenMesh
  std::shared_ptr<const SurfaceModel> cad;          ///< as it was read; null of other models
  std::shared_ptr<const OppositeSides> opposite;    ///< of thin bodies with a mid-surface; null: none

  const SurfaceModel& whole() const { return full_model ? full_model->model : model; }
  const std::vector<SurfaceCut>& all_cuts() const { return full_model ? full_model->cuts : cuts; }
};

/// Returns the maps of all patches.
std::vector<const FlatPatch*> maps_of(const SurfaceSetup& surface);

/// The model and curves that the patches of a planar domain were made from.
struct PlaneSetup {
  bool ignores_small = false;  ///< whether small details of outlines were removed
  /// For each curve, the model's curves on it; empty if the lines are kept.
  std::vector<std::vector<std::shared_ptr<const Curve>>> curve_shapes;
  std::vector<CurvePlace> curve_places;  ///< places of the curves' nodes; empty if the lines are kept
  std::vector<DomainPiece> pieces;       ///< pieces of its curves; empty also in the plane of a metric
  std::vector<PatchBoundary> outlines;   ///< see PlanarDomain
  std::shared_ptr<const BackgroundMesh> background;  ///< background mesh of all patches; null on surfaces
};

/// The worst values of a given mesh of quads, which stages may not exceed.
struct GivenWorst {
  double eta = 1;        ///< least eta of all quads; 0 if some are inverted
  double side = 0;       ///< shortest edge, in sizes
  double aspect = 1;     ///< largest aspect of the sound quads (is_sound_quad())
  double sound_eta = 1;  ///< least eta of the sound quads
  bool is_sound = true;  ///< whether all quads are sound
};

/// The settings of a problem beside its model and fields; the members are as in MeshProblem.
struct ProblemSettings {
  std::string name, where;
  Options options;
  long long max_elements = 0;
  bool keep_going = false;
  int order = 1;
  Criteria criteria = {};
  QuadLimits limits = {};  ///< limits by the criteria
};

/// The prepared problem, from which every pipeline starts.
struct MeshingSetup : Preparation {
  ProblemSettings settings;
  std::vector<PatchSetup> patches;
  PlaneSetup plane;
  std::shared_ptr<const SurfaceSetup> surface;  ///< null on planar domains
  std::shared_ptr<const LayerReport> layers;    ///< null: none
  std::shared_ptr<const MetricPlane>
      metric_plane;                       ///< in which all of this lies; null: it is the domain's own
  std::optional<GivenWorst> given_worst;  ///< of a GivenMesh with quads
  /// By region, faces beside those that SurfaceSpec::faces selects; empty: all are selected.
  std::vector<char> unselected = {};

  /// Returns whether the model is a GivenMesh in space.
  bool is_given_surface() const { return surface && surface->given; }
  /// Returns the corners of a surface at which no quad can have an eta of kBadEta.
  std::vector<SharpCorner> sharp_corners() const {
    return surface ? surface->domain.sharp_corners : std::vector<SharpCorner>();
  }
};

/// Returns the scope in which this thread works on a patch.
inline FaceScope patch_scope(const MeshingSetup& prepared, std::size_t patch) {
  return FaceScope(prepared.boundary.regions[static_cast<std::size_t>(prepared.patches[patch].region)].tag,
                   prepared.surface ? "face" : "region");
}

}  // namespace delquad
