// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

struct Example {
  const char *name, *size;
  int euler;
};

void PrintTo(const Example& example, std::ostream* out) { *out << example.name; }

class Examples : public ::testing::TestWithParam<Example> {};

TEST_P(Examples, AreWrittenAndMeshedWithQuadsOnly) {
  const Example& example = GetParam();
  const Folder folder;
  for (const char* extension : {".step", ".brep"}) {
    const auto file = folder / (std::string(example.name) + extension);
    const auto written = delquad({"example", example.name, "-o", file});
    ASSERT_EQ(written.exit_code, 0) << written.err;
    EXPECT_EQ(written.out, file.string() + "\n");
    const auto meshed = delquad({"mesh", file, "-o", folder / "out.msh", "--size", example.size});
    ASSERT_EQ(meshed.exit_code, 0) << meshed.err;
    const Mesh mesh = read_mesh(folder / "out.msh");
    EXPECT_EQ(check_invariants(mesh), Strings{});
    EXPECT_TRUE(mesh.triangles.empty());
    std::set<std::pair<int, int>> edges;
    for (const auto& quad : mesh.quads)
      for (std::size_t k = 0; k < 4; ++k) edges.insert(std::minmax(quad[k], quad[(k + 1) % 4]));
    EXPECT_EQ(static_cast<int>(mesh.points.size() + mesh.quads.size()) - static_cast<int>(edges.size()),
              example.euler);
  }
}

const auto name_of_example = [](const auto& param) { return param.param.name; };
INSTANTIATE_TEST_SUITE_P(Shapes, Examples,
                         ::testing::Values(Example{"bracket", "3", -8}, Example{"hood", "60", 1},
                                           Example{"sphere", "2", 2}, Example{"torus", "3", 0},
                                           Example{"sheet", "4", -5}),
                         name_of_example);
INSTANTIATE_TEST_SUITE_P(OthersLong, Examples,
                         ::testing::Values(Example{"pipe_tee", "5", -1}, Example{"wing_body", "3", 2},
                                           Example{"blended_tee", "5", -2}, Example{"cone_tip", "4", 0},
                                           Example{"cross_drilled", "4", -6}, Example{"elbow", "4", 0},
                                           Example{"fins", "4", 0}, Example{"free_form", "4", -2},
                                           Example{"loft", "4", 2}, Example{"thin_box", "4", -10},
                                           Example{"variable_fillet", "4", 0}),
                         name_of_example);

}  // namespace
}  // namespace delquad::testing_support
