// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "features/midsurface/joined_plates.h"

// This header finds the two sides of thin bodies, and moves meshes of one side half-way to the other. The
// pipeline uses it for mid-surfaces.

namespace delquad {

/// Two sides of a body of sheet metal, by rays through the fine triangulation along its normals.
///
/// Rims and steps are narrow faces beside much thinner parts of the body. So are fillets and chamfers at
/// rims. All other faces belong to a side: the same as their neighbors, the other one than what they face.
/// The side is meshed that has no step, and of which every face has an opposite one; of two the smaller one.
/// If plates join, there are no two sides, and join_plates() makes the mid-surface before.
class OppositeSides : private BodyRays {
 public:
  /// Throws InputError, with faces and places, for models that are open, and for bodies without two sides.
  explicit OppositeSides(const SurfaceModel& model);

  /// Returns the faces that are meshed, ascending; none if plates join.
  const std::vector<int>& faces() const { return faces_; }
  /// Gives faces the names of what they face, and curves the names of rims beside. Adds lines where the
  /// thickness changes by a step of the other side, to be imprinted. If plates join, the model becomes their
  /// mid-surface.
  void add_to(SurfaceModel& model) const;
  /// Moves all nodes of a mesh of these faces half-way to the other side, so that each quad lies half-way at
  /// its own thickness. Where plates join, it lies there already. Stores the thickness.
  void move_half_way(Mesh& mesh) const;

 private:
  static constexpr double kFacedPart = 0.5;  ///< of a face's area, at least, has an opposite side

  /// Returns, by face, the parts of its area that face each of the others.
  std::map<int, double> parts_facing(int face) const;
  void find_narrow();
  void find_sides();
  void choose(const std::vector<int>& component);
  /// Returns the part of a face's area that faces a face of the other side.
  double faced_part(int face) const;
  /// Returns the side on which a narrow face is a step between thicknesses; -1: it is a rim.
  int side_of_step(int face) const;
  bool is_faced(int face, const Sample& sample) const;
  /// Returns what the nearest sample of a meshed face faces on the other side.
  int opposite_near(const Vec3& x) const;

  std::vector<char> is_narrow_;  ///< by face
  std::vector<int> side_;        ///< by face, 0 or 1; -1: none
  std::vector<int> faces_;
  std::optional<Mesh> joined_;  ///< the mid-surface of plates that join, with its thickness
};

}  // namespace delquad
