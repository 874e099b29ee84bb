#include <gtest/gtest.h>

#include <fstream>

#include "mesher/runner.h"
#include "patches/prepared.h"
#include "tests/support/prepare_case.h"
#include "tests/support/surfaces.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

// Treatment and clean-up do not know that a cut is the same on both sides: what they leave must
// not be only two quads around.
TEST(ThinCone, AtLeastThreeQuadsStayAround) {
  const testing_support::TemporaryFolder folder;
  for (const double half_angle : {0.025, 0.05}) {
    const Mesh cone = testing_support::cone(24, 100, half_angle).fine;
    std::ofstream out(folder / "cone.off");
    out.precision(17);
    out << "OFF\n" << cone.points.size() << " " << cone.triangles.size() << " 0\n";
    for (const Vec3& p : cone.points) out << p.x << " " << p.y << " " << p.z << "\n";
    for (const auto& v : cone.triangles) out << "3 " << v[0] << " " << v[1] << " " << v[2] << "\n";
    out.close();
    for (const char* size : {"1/43", "1/60"}) {
      Case c;
      c.name = c.where = "cone.off";
      c.model = ModelFile{folder / "cone.off"};
      c.size.text = size;
      const PreparedProblem prepared = prepare_case(c);
      for (const char* word : {"DB", "DBC"}) {
        const MeshResult result = run_word(prepared, parse_word(word));
        EXPECT_TRUE(result.mesh.triangles.empty());
        EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
        EXPECT_EQ(result.surface->nonconforming_edges.count, 0) << half_angle << " " << size << " " << word;
      }
    }
  }
}

}  // namespace
}  // namespace delquad
