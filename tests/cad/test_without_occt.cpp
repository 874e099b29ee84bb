#include <gtest/gtest.h>

#include "cad/cad_reader.h"
#include "tests/support/expect_input_error.h"

namespace delquad {
namespace {

TEST(WithoutOpenCascade, SaysSo) {
  expect_input_error([] { read_cad("part.step"); },
                     {"part.step", "built without OpenCASCADE: cannot read STEP or BREP"});
}

}  // namespace
}  // namespace delquad
