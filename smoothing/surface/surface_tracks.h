// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "geometry/patches/surface_domain.h"
#include "smoothing/optimisation/track_optimisation.h"

// This header moves vertices of surface meshes, nodes along curves. Stage O and the last repairs use it.

namespace delquad {

/// The vertices of all patches of a surface as one mesh in space. Nodes inside curves slide along them, ends
/// of curves stay, and vertices inside a patch move in its parameter plane. Vertices of leftover triangles
/// stay.
///
/// The nodes of curves come first, then the vertices inside each patch. All arguments must outlive this
/// object.
class SurfaceTracks final : public VertexTracks<Vec3> {
 public:
  /// A patch in use; `inside` has the places in space of its points inside.
  struct Patch {
    const SurfacePatch* patch;
    const CrossField* cross;
    QuadPatch* mesh;
    std::vector<Vec3>* inside;
  };
  SurfaceTracks(const SurfaceModel& model, const SizeField& size, const SurfaceDomain& domain,
                SurfaceNodes& nodes, std::vector<Patch> patches);

  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<std::array<int, 4>>& quads() const { return quads_; }
  /// Writes places in space and positions to the patches and nodes.
  void store(const std::vector<Vec3>& points);

  Vec2 position(int v) const override { return position_[v]; }
  Vec3 put(int v, Vec2 position) override;
  std::array<Vec3, 2> axes(int v) const override;
  double delta(const Vec3& place, TrackHint& hint) const override { return size_.at(place, hint.size); }
  Vec3 arm(int quad, int side, TrackHint& hint) const override;

  /// Place on a vertex's track: its parameters and its point in space.
  struct TrackPlace {
    Vec2 position;
    Vec3 place;
  };
  /// Returns the place of the track next to x, searched from the nearby place `from`. On a CAD face it is the
  /// face's nearest point to x, even outside the fine triangles; its position is then a guess.
  TrackPlace track_place_near(int v, const TrackPlace& from, const Vec3& x) const;
  /// Moves v to such a place, without a projection.
  void put(int v, const TrackPlace& spot);
  /// Returns whether the model knows its true surfaces.
  bool is_on_cad() const { return model_.projector != nullptr; }
  bool is_on_curve(int v) const { return vertex_patch_[v] < 0; }
  /// Returns the outward normal (of any length) of the fine triangles around each quad's initial corners.
  std::vector<Vec3> normals() const;

 private:
  struct OnCurve {
    int chain = -1;  ///< -1: end of curves
    std::size_t k;   ///< index into SurfaceNodes::on_curve
  };

  void add_curves();
  void add_patch(const Patch& patch);
  /// Returns the index of the line plus the fraction along it, at a length along the chain.
  double s_at(int chain, double length) const;
  Vec3 direction(int chain, double length) const;

  const SurfaceModel& model_;
  const SizeField& size_;
  const SurfaceDomain& domain_;
  SurfaceNodes& nodes_;
  std::vector<Patch> patches_;
  std::vector<std::vector<double>> lengths_;  ///< length of each chain at its points
  std::vector<OnCurve> on_curve_;             ///< by node
  std::vector<Vec3> points_;
  std::vector<Vec2> position_;
  std::vector<std::array<int, 4>> quads_;
  std::vector<int> quad_patch_;
  std::vector<int> first_quad_;             ///< by patch
  std::vector<std::vector<Vec3>> normals_;  ///< at the vertices of each patch's map, weighted by area
  std::vector<char> stays_;
  std::vector<int> vertex_patch_;  ///< for vertices inside patches; -1: a node
  mutable std::vector<int> hint_;  ///< hints into the maps, by vertex
};

}  // namespace delquad
