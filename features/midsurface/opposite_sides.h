// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/box_tree.h"
#include "geometry/mesh/nearest_on_regions.h"
#include "geometry/surface/surface_model.h"

// This header finds the two sides of thin bodies, and moves meshes of one side half-way to the other. The
// pipeline uses it for mid-surfaces.

namespace delquad {

/// Two sides of a body of sheet metal, by rays through the fine triangulation along its normals.
///
/// Rims and steps are narrow faces beside much thinner parts of the body. All other faces belong to a side:
/// the same as their neighbors, the other one than what they face. The side is meshed that has no step, and
/// of which every face has an opposite one; of two the smaller one.
class OppositeSides {
 public:
  /// Throws InputError, with faces and places, for models that are open, and for bodies without two sides.
  explicit OppositeSides(const SurfaceModel& model);

  /// Returns the faces that are meshed, ascending.
  const std::vector<int>& faces() const { return faces_; }
  /// Gives faces the names of what they face, and curves the names of rims beside. Adds lines where the
  /// thickness changes by a step of the other side, to be imprinted.
  void add_to(SurfaceModel& model) const;
  /// Moves all nodes of a mesh of these faces half-way to the other side, so that each quad lies half-way at
  /// its own thickness. Stores the thickness.
  void move_half_way(Mesh& mesh) const;

 private:
  struct Hit {
    int triangle = -1;  ///< -1: none
    double distance = 0;
  };
  struct Sample {
    Vec3 at;
    double area;
    int opposite;  ///< face; -1: none
    double distance;
  };
  static constexpr double kFacedPart = 0.5;  ///< of a face's area, at least, has an opposite side

  Vec3 normal(int triangle) const;
  /// Returns the first triangle at which the ray leaves the body.
  Hit leave(const Vec3& from, const Vec3& along) const;
  Sample look(const Vec3& from, const Vec3& inwards, double area) const;
  void sample();
  void measure_curves();
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
  std::string show(int face) const;
  Vec3 nearest(int face, const Vec3& x) const;

  std::string source_;
  Mesh fine_;
  std::shared_ptr<const SurfaceProjector> projector_;
  NearestOnRegions regions_;
  BoxTree<Vec3> tree_;
  double begin_ = 0;                           ///< least length of a ray
  double inwards_ = -1;                        ///< times a triangle's normal
  std::vector<std::vector<Sample>> samples_;   ///< by face
  std::vector<double> thickness_;              ///< by face, the median
  std::vector<std::map<int, double>> shared_;  ///< by two faces, the length of their common curves
  std::vector<char> is_narrow_;                ///< by face
  std::vector<int> side_;                      ///< by face, 0 or 1; -1: none
  std::vector<int> faces_;
};

}  // namespace delquad
