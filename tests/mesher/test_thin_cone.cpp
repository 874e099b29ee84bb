#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "mesher/runner.h"
#include "patches/prepared.h"
#include "tests/support/prepare_case.h"
#include "tests/support/surfaces.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

void write_off(const Mesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "OFF\n" << mesh.points.size() << " " << mesh.triangles.size() << " 0\n";
  for (const Vec3& p : mesh.points) out << p.x << " " << p.y << " " << p.z << "\n";
  for (const auto& v : mesh.triangles) out << "3 " << v[0] << " " << v[1] << " " << v[2] << "\n";
}

PreparedProblem prepare_off(const std::filesystem::path& file, const char* size) {
  Case c;
  c.name = c.where = file.filename().string();
  c.model = ModelFile{file};
  c.size.text = size;
  return prepare_case(c);
}

// Treatment and clean-up do not know that a cut is the same on both sides: what they leave must
// not be only two quads around.
TEST(ThinCone, AtLeastThreeQuadsStayAround) {
  const testing_support::TemporaryFolder folder;
  for (const double half_angle : {0.025, 0.05}) {
    write_off(testing_support::cone(24, 100, half_angle).fine, folder / "cone.off");
    for (const char* size : {"1/43", "1/60"}) {
      const PreparedProblem prepared = prepare_off(folder / "cone.off", size);
      for (const char* word : {"DB", "DBC"}) {
        const MeshResult result = run_word(prepared, parse_word(word));
        EXPECT_TRUE(result.mesh.triangles.empty());
        EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
        EXPECT_EQ(result.surface->nonconforming_edges.count, 0) << half_angle << " " << size << " " << word;
      }
    }
  }
}

// The wall of a drilled hole and its tip, of 118 degrees, of which the rim of the wall has no more edges than
// the size asks for: 14 irregular vertices once, at a tau of 65.
TEST(ThinCone, ADrilledTipAsksForNoSmallSizes) {
  const testing_support::TemporaryFolder folder;
  const double slant = 1 / std::sin(59 * std::numbers::pi / 180);
  const Mesh hole = testing_support::grid_surface({36, 30, true, false, true}, [&](double u, double v) {
                      const double phi = 2 * std::numbers::pi * u, r = std::min(1.0, 5 * v);
                      const double z = v < .2 ? -r * std::sqrt(slant * slant - 1)
                                              : 10 * (0.2 - v) - std::sqrt(slant * slant - 1);
                      return Vec3{r * std::cos(phi), r * std::sin(phi), z};
                    }).fine;
  write_off(hole, folder / "hole.off");
  for (const char* size : {"1", "0.7", "0.5"}) {
    const MeshResult result = run_word(prepare_off(folder / "hole.off", size), parse_word("DBCQO"));
    EXPECT_LE(result.metrics.values.at("n_irregular"), 6) << size;
    EXPECT_GT(result.metrics.values.at("tau"), 90) << size;
  }
}

}  // namespace
}  // namespace delquad
