// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_experiment.h"
#include "geometry/cad/cad_reader.h"
#include "metrics/tables/result_records.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// "case pipeline" -> digest of the mesh
using Digests = std::map<std::string, std::string>;

Digests expected_digests(const fs::path& file, bool with_cad) {
  Digests digests;
  std::ifstream in(file);
  for (std::string name, word, digest; in >> name >> word >> digest;)
    if (with_cad || (name != "sphere" && name != "bracket" && name != "torus"))
      digests[name + " " + word] = digest;
  return digests;
}

bool has_fma() {
#ifdef __x86_64__
  return __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

/// The meshes do not depend on compiler, optimization or sanitizers: this test is the same in every build.
/// They do on the mathematical functions of the C library (glibc has others for processors without FMA) and,
/// where CAD is read, on OpenCASCADE.
TEST(SameBytes, InEveryBuild) {
  if (!has_fma()) GTEST_SKIP() << "the digests are of a processor (x86-64) with FMA";
  const Folder folder;
  const fs::path files = fs::path(DELQUAD_SAME_BYTES);
  SweepOptions options;
  options.pictures = false;
  run_experiment(Experiment::read(files / "same_bytes.toml"), folder / "out", options);
  Digests made;
  for (const CellRecord& record : read_records(folder / "out")) {
    if (!record.reason.empty()) continue;  // is missing below
    const auto json = Json::parse(std::ifstream(record.folder / "record.json"));
    made[record.group + " " + record.pipeline] = json.at("digests").at("mesh");
  }
  const Digests expected = expected_digests(files / "digests.txt", !cad_program().empty());
  ASSERT_GE(expected.size(), 10u);
  EXPECT_EQ(made, expected);
}

}  // namespace
}  // namespace delquad
