#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "patches/surface_domain.h"
#include "smoothing/optimisation/track_optimisation.h"

namespace delquad {

/// The vertices of all patches of a surface as one mesh, each on its track: nodes inside curves slide along
/// these, ends of curves stay, vertices inside a patch move in its parameter plane. Vertices of leftover
/// triangles stay.
///
/// Vertices: the nodes of the curves, then those inside each patch, patch by patch. All arguments outlive
/// this object.
class SurfaceTracks final : public VertexTracks<Vec3> {
 public:
  /// A patch that takes part. `inside`: places in space of its points inside.
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
  /// Writes places and positions back to the patches and the nodes.
  void store(const std::vector<Vec3>& points);

  Vec2 position(int v) const override { return position_[v]; }
  Vec3 put(int v, Vec2 position) override;
  std::array<Vec3, 2> axes(int v) const override;
  double delta(const Vec3& place, TrackHint& hint) const override { return size_.at(place, hint.size); }
  Vec3 arm(int quad, int side, TrackHint& hint) const override;

  /// A place on a vertex's track.
  struct Spot {
    Vec2 position;
    Vec3 place;
  };
  /// The spot next to x, `from` being one not far away. On a CAD face that is its point nearest to x, even
  /// outside the fine triangles; its position is then a guess.
  Spot spot_near(int v, const Spot& from, const Vec3& x) const;
  void put(int v, const Spot& spot);
  bool is_on_cad() const { return model_.projector != nullptr; }
  bool is_on_curve(int v) const { return vertex_patch_[v] < 0; }
  /// Of each quad, the outward normal of the fine triangles around its corners, where these were when the
  /// tracks were made; any length.
  std::vector<Vec3> normals() const;

 private:
  struct OnCurve {
    int chain = -1;  ///< -1: an end of curves
    std::size_t k;   ///< its place in SurfaceNodes::on_curve
  };

  void add_curves();
  void add_patch(const Patch& patch);
  /// How many fixed points a patch's boundary has instead of a node that a cap cut off; -1: none did.
  int points_at(const SurfacePatch& patch, int node) const;
  /// Index of the line and the fraction along it, at a length along the chain.
  double s_at(int chain, double length) const;
  Vec3 direction(int chain, double length) const;

  const SurfaceModel& model_;
  const SizeField& size_;
  const SurfaceDomain& domain_;
  SurfaceNodes& nodes_;
  std::vector<Patch> patches_;
  std::vector<std::vector<double>> lengths_;  ///< of each chain, at its points
  std::vector<OnCurve> on_curve_;             ///< of each node
  std::vector<Vec3> points_;
  std::vector<Vec2> position_;
  std::vector<std::array<int, 4>> quads_;
  std::vector<int> quad_patch_;
  std::vector<int> first_quad_;             ///< of each patch
  std::vector<std::vector<Vec3>> normals_;  ///< at the vertices of each patch's map, by area
  std::vector<char> stays_;
  std::vector<int> vertex_patch_;  ///< of the vertices inside patches; -1: a node
  mutable std::vector<int> hint_;  ///< into the maps, by vertex
};

}  // namespace delquad
