// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/box_tree.h"
#include "geometry/mesh/nearest_on_regions.h"
#include "geometry/surface/surface_model.h"

// This header measures thin bodies by rays through their fine triangulation. Mid-surfaces use it.

namespace delquad {

/// Adds names that are no colors, and that `others` do not have.
void add_names(const std::vector<std::string>& from, const std::vector<std::string>& others,
               std::vector<std::string>& to);

/// Closed bodies, with rays along the inward normals at samples of their faces (own method). Faces that glued
/// bodies have in common are left out.
struct BodyRays {
  /// Least cosine between the normals of faces that are parallel.
  static constexpr double kParallel = 0.95;

  struct Hit {
    int triangle = -1;  ///< -1: none
    double distance = 0;
  };
  struct Sample {
    Vec3 at;
    double area;
    int opposite;  ///< face; -1: none
    double distance;
    double facing = 0;  ///< cosine between the ray and the normal at the opposite face
  };

  /// Throws InputError, with the place, for models that are open or branch.
  explicit BodyRays(const SurfaceModel& model);

  /// Returns the normal of a triangle, of length 1.
  Vec3 normal(int triangle) const;
  /// Returns the first triangle at which the ray leaves the body.
  Hit leave(const Vec3& from, const Vec3& along) const;
  Sample look(const Vec3& from, const Vec3& inwards, double area) const;
  /// Returns a face with its number and place, for messages.
  std::string show(int face) const;
  Vec3 nearest(int face, const Vec3& x) const;

  std::string source;
  Mesh fine;
  std::shared_ptr<const SurfaceProjector> projector;
  NearestOnRegions regions;
  BoxTree<Vec3> tree;
  double begin = 0;  ///< least length of a ray
  double volume = 0;
  double inward_sign = -1;                    ///< times a triangle's normal
  std::vector<std::vector<Sample>> samples;   ///< by face
  std::vector<double> median_thickness;       ///< by face, the median
  std::vector<std::map<int, double>> shared;  ///< by two faces, the length of their common curves

 private:
  void measure_curves();
  void sample();
};

}  // namespace delquad
