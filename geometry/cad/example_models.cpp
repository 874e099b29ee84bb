#include "geometry/cad/example_models.h"

#include <algorithm>

#include "delquad/error.h"

namespace delquad {

const std::vector<Example>& example_models() {
  static const std::vector<Example> kAll = {
      {"bracket", "a solid with holes, a boss and fillets, 80 x 60 x 66"},
      {"hood", "the hood of a car, 18 Bezier patches with a common tangent plane, 1040 x 1400, open"},
      {"pipe_tee", "two pipes that meet at a sharp curve, their ends open, 120 x 40 x 80"},
      {"sphere", "radius 10"},
      {"torus", "radii 20 and 8"},
      {"wing_body", "a solid: a fuselage 100 long and a tapered wing with a sharp trailing edge, span 100"},
  };
  return kAll;
}

void check_example(const std::string& name) {
  std::string known;
  for (const Example& example : example_models()) {
    if (example.name == name) return;
    known += (known.empty() ? "" : ", ") + example.name;
  }
  throw InputError("unknown example '" + name + "'; known: " + known);
}

}  // namespace delquad
