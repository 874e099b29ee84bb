#pragma once

#include <string>
#include <vector>

namespace delquad {

/// A planar model of the suite: the text of a model file (docs/experiments.md) without a size.
/// Coordinates have nine digits after the point.
struct PlanarSuiteModel {
  const char* name;
  std::string (*make)();
};
const std::vector<PlanarSuiteModel>& planar_suite_models();

// The models by what they are made of, one file each.
std::string make_fractures();
std::string make_fracture_network();
std::string make_circles();
std::string make_polygons();
std::string make_porous();
std::string make_porous_fine();
std::string make_naca_sharp();
std::string make_naca_blunt();
std::string make_high_lift();
std::string make_gear();
std::string make_ring_gear();
std::string make_slits();
std::string make_serpentine();
std::string make_graded();

}  // namespace delquad
