// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/example_models.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(WithoutOpenCascade, ExamplesAreListedButNotMade) {
  EXPECT_FALSE(example_models().empty());
  std::ostringstream out;
  expect_input_error([&] { write_example("torus", CadFormat::kStep, out); },
                     {"built without OpenCASCADE: cannot make the example 'torus'"});
  expect_input_error([] { read_example("torus"); },
                     {"built without OpenCASCADE: cannot make the example 'torus'"});
  expect_input_error([] { read_example("tours"); }, {"unknown example 'tours'", "torus"});
  EXPECT_TRUE(out.str().empty());
}

TEST(WithoutOpenCascade, SaysSo) {
  expect_input_error([] { read_cad("part.step"); },
                     {"part.step", "built without OpenCASCADE: cannot read STEP or BREP"});
}

}  // namespace
}  // namespace delquad
