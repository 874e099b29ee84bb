#include "experiments/suite/planar_models.h"

namespace delquad {

const std::vector<PlanarSuiteModel>& planar_suite_models() {
  static const std::vector<PlanarSuiteModel> kAll = {
      {"fractures", make_fractures},   {"fracture_network", make_fracture_network},
      {"circles", make_circles},       {"polygons", make_polygons},
      {"porous", make_porous},         {"porous_fine", make_porous_fine},
      {"naca_sharp", make_naca_sharp}, {"naca_blunt", make_naca_blunt},
      {"high_lift", make_high_lift},   {"gear", make_gear},
      {"ring_gear", make_ring_gear},   {"slits", make_slits},
      {"serpentine", make_serpentine}, {"graded", make_graded},
  };
  return kAll;
}

}  // namespace delquad
