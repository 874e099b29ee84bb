// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "geometry/planar/planar_model.h"
#include "smoothing/optimisation/track_optimisation.h"

// This header moves vertices of planar meshes, nodes along curves. Stage O and grids use it.

namespace delquad {

/// The vertices of all patches of a planar domain as one mesh. Nodes inside curves slide along them, other
/// nodes stay, and vertices inside a patch move freely. Vertices of leftover triangles stay.
///
/// The nodes come first, then the vertices inside each patch. All arguments must outlive this object.
class PlanarTracks final : public VertexTracks<Vec2> {
 public:
  struct Patch {
    QuadPatch* mesh;
    std::vector<int> point_node;  ///< node of each boundary point
    const CrossField* cross;
  };
  /// `places` are the places of nodes on curves; if empty, all nodes stay.
  PlanarTracks(std::vector<Vec2> nodes, const std::vector<CurvePlace>& places, std::vector<Patch> patches,
               const ParametricSize& size);

  const std::vector<Vec2>& points() const { return points_; }
  const std::vector<std::array<int, 4>>& quads() const { return quads_; }
  /// Writes the places of all vertices to the patches' meshes.
  void store(const std::vector<Vec2>& points);

  Vec2 position(int v) const override { return slides(v) ? Vec2{places_[v].t, 0} : points_[v]; }
  Vec2 put(int v, Vec2 position) override;
  std::array<Vec2, 2> axes(int v) const override;
  double delta(const Vec2& place, TrackHint& hint) const override { return size_.at(place, hint.size); }
  Vec2 arm(int quad, int side, TrackHint& hint) const override;

 private:
  bool slides(int v) const { return v < static_cast<int>(places_.size()) && !places_[v].is_free; }

  std::vector<CurvePlace> places_;  ///< by node
  std::vector<Patch> patches_;
  const ParametricSize& size_;
  std::vector<Vec2> points_;
  std::vector<std::array<int, 4>> quads_;
  std::vector<int> quad_patch_;
  std::vector<char> stays_;
};

}  // namespace delquad
