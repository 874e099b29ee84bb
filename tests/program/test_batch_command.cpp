#include <gtest/gtest.h>

#include "io/mesh_io.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

const std::string kSquareObj = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3\nf 1 3 4\n";
/// With a corner of 25 degrees.
const std::string kWedgeObj = "v 0 0 0\nv 6 0 0\nv 6 2.8 0\nf 1 2 3\n";

class Batch : public testing::Test {
 protected:
  Batch() { std::filesystem::create_directory(parts_); }
  ProgramResult run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"batch", parts_, "-o", results_, "--size", "0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return delquad(arguments);
  }

  TemporaryFolder folder_;
  std::filesystem::path parts_ = folder_ / "parts", results_ = folder_ / "results";
};

TEST_F(Batch, MakesATableAPageAndMeshes) {
  write_text(parts_ / "my plate.obj", kSquareObj);
  write_text(parts_ / "my_plate.off", "OFF\n3 1 0\n0 0 0\n4 0 0\n0 4 0\n3 0 1 2\n");
  write_text(parts_ / "notes.txt", "no model");
  const ProgramResult done = run({"--format", "inp"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  for (const char* part : {"| my_plate ", "| my_plate_2 ", "failing", "time step", "deviation",
                           "2 of 2 parts were meshed, 0 have"})
    EXPECT_TRUE(contains(done.out, part)) << part << " in " << done.out;
  EXPECT_TRUE(std::filesystem::exists(results_ / "index.html"));
  EXPECT_EQ(read_mesh(results_ / "meshes/my_plate.inp").quads.size(),
            read_mesh(results_ / "my_plate/DBCQO/mesh.msh").quads.size());

  // What is done stays.
  const auto written = std::filesystem::last_write_time(results_ / "my_plate/DBCQO/record.json");
  write_text(parts_ / "third.obj", kSquareObj);
  EXPECT_TRUE(contains(run().out, "| third "));
  EXPECT_EQ(std::filesystem::last_write_time(results_ / "my_plate/DBCQO/record.json"), written);
}

TEST_F(Batch, TellsWhatFailed) {
  write_text(parts_ / "wedge.obj", kWedgeObj);
  EXPECT_EQ(run().exit_code, 0);
  const ProgramResult strict = run({"--strict"});
  EXPECT_EQ(strict.exit_code, 5);
  EXPECT_TRUE(contains(strict.out, "1 of 1 parts were meshed, 1 have")) << strict.out;
  EXPECT_TRUE(std::filesystem::exists(results_ / "wedge/DBCQO/mesh.msh"));
  write_text(parts_ / "broken.obj", "v 0 0\nf 1 2 3\n");
  const ProgramResult broken = run();
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_TRUE(contains(broken.out, "| wedge ")) << broken.out;
  EXPECT_TRUE(contains(broken.out, "broken DBCQO failed: ")) << broken.out;
  EXPECT_TRUE(contains(broken.out, "1 of 2 parts were meshed, 1 have")) << broken.out;

  // A mesh of what a part was before does not stay.
  EXPECT_EQ(run({"--format", "inp"}).exit_code, 2);
  EXPECT_TRUE(std::filesystem::exists(results_ / "meshes/wedge.inp"));
  write_text(parts_ / "wedge.obj", "v 0 0\nf 1 2 3\n");
  EXPECT_EQ(run({"--format", "inp"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(results_ / "meshes/wedge.inp"));
}

TEST_F(Batch, TakesFurtherSettings) {
  write_text(parts_ / "wedge.obj", kWedgeObj);
  const auto settings = write_text(folder_ / "s.toml", "refine = 2\n[limits]\nmin_angle = 5\n");
  const ProgramResult coarse = run({"--quality", "fast"});
  const ProgramResult fine = run({"--quality", "fast", "--settings", settings});
  EXPECT_EQ(fine.exit_code, 0) << fine.err;
  EXPECT_NE(coarse.out, fine.out);
}

TEST_F(Batch, RefusesWhatIsNoBatch) {
  EXPECT_EQ(run().exit_code, 2);
  EXPECT_TRUE(contains(run().err, "no models: expected files .brep")) << run().err;
  write_text(parts_ / "wedge.obj", kWedgeObj);
  EXPECT_TRUE(contains(run({"--criteria", "btach"}).err, "btach"));
  EXPECT_TRUE(contains(run({"--format", "abc"}).err, "expected .msh"));
  EXPECT_TRUE(contains(run({"--quality", "bset"}).err, "expected one of fast, good, best, regular"));
  EXPECT_FALSE(std::filesystem::exists(results_ / "wedge"));
}

}  // namespace
}  // namespace delquad::testing_support
