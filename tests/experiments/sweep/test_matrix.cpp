// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/experiment.h"
#include "geometry/patches/meshing_setup.h"
#include "tests/support/files.h"
#include "tests/support/prepare_case.h"

namespace delquad {
namespace {

const std::string kSquare = "[[case]]\nname = 'a'\nloop = { rectangle = [[0, 0], [1, 1]] }\n";

class Matrix : public testing::Test {
 protected:
  Experiment read(const std::string& matrix, const std::string& rest = kSquare + "size = 0.1\n") {
    return Experiment::read(write_text(folder_ / "e.toml", matrix + rest));
  }
  Folder folder_;
};

TEST_F(Matrix, EveryCombinationIsAVariant) {
  const Experiment e = read("[matrix]\nsize = [0.1, \"0.1 + x\"]\ninsertion.h_max = [1.3, 1.4, 1.5]\n");
  ASSERT_EQ(e.n_variants(), 6u);
  EXPECT_EQ(e.n_cells(), 24u);
  const Case first = e.read_variant(0, 0), last = e.read_variant(0, 5);
  EXPECT_EQ(first.options.number("insertion.h_max"), 1.3);
  EXPECT_EQ(first.size.text, "0.1");
  EXPECT_EQ(first.folder, "a@h_max=1.3,size=0.1");
  EXPECT_EQ(last.options.number("insertion.h_max"), 1.5);
  EXPECT_EQ(last.size.text, "0.1 + x");
  EXPECT_EQ(last.folder, "a@h_max=1.5,size=0.1_+_x");
  EXPECT_EQ(last.name, "a");
  EXPECT_EQ(e.read_variant(0, 1).folder, "a@h_max=1.3,size=0.1_+_x");
}

TEST_F(Matrix, KeysMayBeQuoted) {
  const Experiment e = read("[matrix]\n\"insertion.h_max\" = [1.3, 1.4]\n\"curves\".agreement = [2]\n");
  ASSERT_EQ(e.n_variants(), 2u);
  EXPECT_EQ(e.read_variant(0, 1).options.number("insertion.h_max"), 1.4);
  EXPECT_EQ(e.read_variant(0, 1).folder, "a@agreement=2,h_max=1.4");
}

TEST_F(Matrix, OtherKeysOfATableStay) {
  const Experiment e = read("[matrix]\ninsertion.h_max = [1.3]\n",
                            kSquare + "size = 0.1\ninsertion = { rejection = 0.5, h_max = 1.2 }\n");
  EXPECT_EQ(e.read_variant(0).options.number("insertion.h_max"), 1.3);
  EXPECT_EQ(e.read_variant(0).options.number("insertion.rejection"), 0.5);
}

TEST_F(Matrix, VariantsAreSetsOfKeysUnderAName) {
  const std::string variants =
      "[[variant]]\nname = 'all'\n[[variant]]\nname = 'none'\ncross = 'size-aware'\n"
      "insertion.h_max = 1.4\nrepair = { part_twins = false }\n[matrix]\nseed = [1, 2]\n";
  const Experiment e = read(variants, kSquare + "size = 0.1\ninsertion = { rejection = 0.5 }\n");
  ASSERT_EQ(e.n_variants(), 4u);
  const Case all = e.read_variant(0, 0), none = e.read_variant(0, 3);
  EXPECT_EQ(all.folder, "a@variant=all,seed=1");
  EXPECT_EQ(none.folder, "a@variant=none,seed=2");
  EXPECT_EQ(none.seed, 2);
  EXPECT_EQ(none.cross.text, "size-aware");
  EXPECT_EQ(none.options.number("insertion.h_max"), 1.4);
  EXPECT_EQ(none.options.number("insertion.rejection"), 0.5);
  EXPECT_FALSE(none.options.flag("repair.part_twins"));
  EXPECT_TRUE(all.cross.text.empty() && all.options.flag("repair.part_twins"));
}

TEST_F(Matrix, LikeNamedAxesAndLongValuesAreToldApart) {
  const std::string value(60, '1');
  const Experiment e =
      read("[matrix]\noptimisation.size = [1]\nseed = [2]\nsize = [\"1/" + value + "\", \"1\"]\n");
  const std::string folder = e.read_variant(0).folder, begin = "a@optimisation.size=1,seed=2,size=value-";
  EXPECT_EQ(folder.substr(0, begin.size()), begin);
  const Experiment more =
      read("[matrix]\noptimisation.size = [1]\nseed = [2]\nsize = [\"2\", \"1/" + value + "\", \"1\"]\n");
  EXPECT_EQ(more.read_variant(0, 1).folder, folder) << "another value beside it changes nothing";
}

/// Another place for every node, but the same domain.
TEST_F(Matrix, SeedsTurnAndShiftADomain) {
  const auto prepared = [&](const std::string& seed) {
    return prepare_case(read("", kSquare + "size = '0.05 + 0.05*x'\ncross = 'x'\n" + seed).read_variant(0));
  };
  const MeshingSetup plain = prepared(""), same = prepared("seed = 0\n"), other = prepared("seed = 5\n"),
                     again = prepared("seed = 5\n");
  EXPECT_EQ(plain.patches[0].boundary.points, same.patches[0].boundary.points);
  EXPECT_EQ(other.patches[0].boundary.points, again.patches[0].boundary.points);
  EXPECT_NE(plain.patches[0].boundary.points, other.patches[0].boundary.points);
  EXPECT_NEAR(plain.size.expected_quads, other.size.expected_quads, 0.02 * plain.size.expected_quads);
  // Corners are where the corners were, turned about the origin; fields turn with them.
  const Vec2 far = other.patches[0].boundary.points.back();
  EXPECT_LE(norm(far), std::sqrt(2.0) + 1e-12);
  int hint = -1;
  double least = 1, most = 0;
  for (const Vec2 p : other.patches[0].boundary.points) {
    const double size = other.size.field->at({p.x, p.y, 0}, hint);
    least = std::min(least, size);
    most = std::max(most, size);
  }
  EXPECT_NEAR(least, 0.05, 1e-12);
  EXPECT_NEAR(most, 0.1, 1e-12);
}

}  // namespace
}  // namespace delquad
