// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <filesystem>

#include "io/cases/case_file.h"
#include "io/cases/expression.h"
#include "io/cases/read_problem.h"
#include "mesher/prepare.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace delquad::fuzz {

namespace {

/// A model file is read, and its curves and fields are made, but few elements.
bool try_model(std::string_view bytes) {
  static InputFile file("input.toml");
  const std::filesystem::path& path = file.hold(bytes);
  return result_or_input_error(path.string(), [&] {
    Case c = read_model_case(path);
    c.max_elements = 200;
    const MeshProblem problem = read_files(c);
    if (planar_model(c) != nullptr) prepare_problem(problem);
  });
}

bool try_formula(std::string_view bytes) {
  return result_or_input_error("expression", [&] {
    const Expression formula(std::string(bytes), {"x", "y", "z"});
    const Expression copy = formula;
    for (const std::array<double, 3>& at :
         {std::array{0., 0., 0.}, {1., -2., 0.5}, {1e300, NAN, -INFINITY}}) {
      const double value = formula(at), again = copy(at);
      require(value == again || (std::isnan(value) && std::isnan(again)), "a copy has another value");
    }
  });
}

std::vector<std::string> model_seeds() {
  return {
      R"toml(loop = [
  { circle = { centre = [0, 0], radius = 1 }, boundary = "outer", region = "ring" },
  { circle = { centre = [0, 0], radius = 0.4 }, boundary = "inner", hole = true },
]
size = 0.5
)toml",
      R"toml(size = { base = "0.2 + x*x", gradation = 0.3, max = 1.0, source = [{ at = [0, 0], near = 0.2, far = 0.4, radius_near = 0.1, radius_far = 1 }] }
cross = "atan2(y, x)"
seed = 3
[[curve]]
name = "a"
polyline = [[0, 0], [2, 0], [2, 1.5]]
[[curve]]
name = "b"
boundary = "bow"
expression = { x = "2*cos(t)", y = "1.5 + sin(t)", from = 0, to = 3.141592653589793 }
[[curve]]
name = "c"
segment = [[-2, 1.5], [0, 0]]
[[loop]]
curves = ["a", "b", "c"]
)toml",
      R"toml(size = 0.4
[[loop]]
rectangle = [[0, 0], [4, 3]]
region = "plate"
[[pattern]]
circle = { centre = [1, 1], radius = 0.3 }
count = [2, 1]
step = [2, 1]
[[curve]]
name = "arc"
arc = { centre = [9, 0], radius = 1, from = 0, to = 180 }
[[curve]]
name = "chord"
segment = [[8, 0], [10, 0]]
[[loop]]
curves = ["arc", "chord"]
[insertion]
h_max = 1.5
[recombination]
treatment = "none"
)toml",
      R"toml(example = "bracket"
size = "boundary"
[surface]
feature_angle = 30
weld_tolerance = 1e-6
compound = "tangent"
mirror = { point = [0, 0, 0], normal = [1, 0, 0], join = false }
)toml",
  };
}

std::vector<std::string> formula_seeds() {
  return {"0.1 + 0.5*sqrt((x-1)^2 + y^2)", "x < 0.5 && y >= 2 ? min(x, y, 1e-3) : max(abs(z), pi)",
          "-sin(e*x)/atan2(y, -1) == 0 || 1 != 2", "rint(x)*log10(2) + sum(1,2,3)"};
}

}  // namespace

std::vector<Target> case_targets() {
  return {{"model", try_model, model_seeds}, {"formula", try_formula, formula_seeds}};
}

}  // namespace delquad::fuzz
