// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/example_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/nearest_name.h"
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
      {"blended_tee", "two pipes with walls and a fillet where they meet, 120 x 40 x 80"},
      {"cone_tip", "a cone with its tip on a drilled shaft, 40 x 40 x 80"},
      {"cross_drilled", "a block with three bores that meet, and a corner taken off by a ball, 60 x 50 x 40"},
      {"elbow", "a pipe with a wall and a bend, 65 x 55 x 20"},
      {"fins", "a tube with nine fins, 1.2 thick, 71 x 71 x 50"},
      {"free_form", "a wavy patch with three holes and a corner cut off, 100 x 100, open"},
      {"loft", "a solid through four ellipses that turn, 48 x 36 x 80"},
      {"sheet", "a bent sheet with holes, a narrow web, a step and a pinhole, 106 x 60 x 40, open"},
      {"thin_box", "an open box of four chambers with walls 1.5 thick, drilled through, 80 x 60 x 30"},
      {"variable_fillet", "a block with four fillets whose radii vary, and a hole, 80 x 50 x 30"},
  };
  return kAll;
}

void check_example(const std::string& name) {
  std::vector<std::string> names;
  for (const Example& example : example_models()) names.push_back(example.name);
  if (std::ranges::find(names, name) != names.end()) return;
  throw InputError(fmt::format("unknown example '{}'; known: {}{}", name, fmt::join(names, ", "),
                               suggestion(name, names)));
}

}  // namespace delquad
