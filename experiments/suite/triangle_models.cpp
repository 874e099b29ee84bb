#include "experiments/suite/triangle_models.h"

namespace delquad {

const std::vector<TriangleSuiteModel>& triangle_suite_models() {
  static const std::vector<TriangleSuiteModel> kAll = {
      {"sphere_noisy", make_sphere_noisy},
      {"sphere_graded", make_sphere_graded},
      {"torus_noisy", make_torus_noisy},
      {"torus_holes", make_torus_holes},
      {"knot", make_knot},
      {"washer", make_washer},
      {"star_prism", make_star_prism},
      {"genus3", make_genus3},
      {"genus3_noisy", make_genus3_noisy},
      {"blobs", make_blobs},
      {"terrain", make_terrain},
      {"terrain_holes", make_terrain_holes},
  };
  return kAll;
}

}  // namespace delquad
