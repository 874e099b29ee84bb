// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// Four shells in a row. The first two are in the set WEB, the others in FLANGE.
const std::string kRowOfQuads =
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 2, 0, 0\n4, 3, 0, 1\n5, 4, 0, 1\n"
    "11, 0, 1, 0\n12, 1, 1, 0\n13, 2, 1, 0\n14, 3, 1, 1\n15, 4, 1, 1\n"
    "*ELEMENT, TYPE=S4, ELSET=WEB\n1, 1, 2, 12, 11\n2, 2, 3, 13, 12\n"
    "*ELEMENT, TYPE=S4, ELSET=FLANGE\n3, 3, 4, 14, 13\n4, 4, 5, 15, 14\n";
const std::string kMaterials =
    "*MATERIAL, NAME=Steel\n*ELASTIC, TYPE=ISO\n** in MPa\n 210000., 0.3\n*DENSITY\n7.85E-9\n"
    "*MATERIAL, NAME=ALU\n*ELASTIC\n70000, .33\n*EXPANSION\n2.3E-5\n";

/// The lines of a text that begin with a word, in their order.
Strings lines_with(const std::string& text, const std::string& word) {
  Strings found;
  std::stringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(word)) found.push_back(line);
  return found;
}

TEST(CarriedSections, FromInpToBdfAndBack) {
  const Workplace folder;
  write_text(folder / "a.inp", kRowOfQuads + kMaterials +
                                   "*SHELL SECTION, ELSET=WEB, MATERIAL=STEEL\n0.8, 5\n"
                                   "*SHELL SECTION, ELSET=FLANGE, MATERIAL=ALU\n2.5\n");
  const auto there = folder.run("convert a.inp b.bdf");
  ASSERT_EQ(there.exit_code, 0) << there.err;
  EXPECT_EQ(there.err, "lost: keywords and how many: *EXPANSION (1)\n");
  const std::string bulk = read_text(folder / "b.bdf");
  EXPECT_EQ(lines_with(bulk, "$ material"), (Strings{"$ material 1: Steel", "$ material 2: ALU"}));
  EXPECT_EQ(lines_with(bulk, "MAT1"), (Strings{"MAT1,1,210000.,,0.3,7.85e-09", "MAT1,2,70000.,,0.33"}));
  EXPECT_EQ(lines_with(bulk, "$ property"), (Strings{"$ property 1: WEB", "$ property 2: FLANGE"}));
  EXPECT_EQ(lines_with(bulk, "PSHELL"), (Strings{"PSHELL,1,1,0.8,1,,1", "PSHELL,2,2,2.5,2,,2"}));
  EXPECT_EQ(lines_with(bulk, "CQUAD4  3"),
            (Strings{"CQUAD4  3       2       3       4       9       8       "}));
  EXPECT_TRUE(bulk.ends_with("ENDDATA\n"));

  const auto improved = folder.run("improve a.inp -o d.bdf");
  ASSERT_EQ(improved.exit_code, 0) << improved.err;
  EXPECT_TRUE(holds(improved.err, "d.bdf loses keywords and how many: *EXPANSION (1)\n")) << improved.err;
  for (const char* cards : {"$ material", "MAT1", "$ property", "PSHELL"})
    EXPECT_EQ(lines_with(read_text(folder / "d.bdf"), cards), lines_with(bulk, cards));

  const auto back = folder.run("convert b.bdf c.inp");
  ASSERT_EQ(back.exit_code, 0) << back.err;
  EXPECT_EQ(back.err, "");
  EXPECT_TRUE(holds(read_text(folder / "c.inp"),
                    "*MATERIAL, NAME=Steel\n*ELASTIC\n210000, 0.3\n*DENSITY\n7.85e-09\n"
                    "*MATERIAL, NAME=ALU\n*ELASTIC\n70000, 0.33\n"
                    "*SHELL SECTION, ELSET=region_1, MATERIAL=Steel\n0.8\n"
                    "*SHELL SECTION, ELSET=region_2, MATERIAL=ALU\n2.5\n",
                    "*ELSET, ELSET=region_1\n1, 2\n", "*ELSET, ELSET=region_2\n3, 4\n"));
}

TEST(CarriedSections, TellsWhatAKeywordCannotCarry) {
  const Workplace folder;
  const std::pair<std::string, const char*> sections[] = {
      {"*SHELL SECTION, ELSET=WEB, COMPOSITE\n0.5, 3, ALU\n", "it has the parameter COMPOSITE"},
      {"*SHELL SECTION, ELSET=WEB, MATERIAL=WOOD\n1.\n", "its *MATERIAL is not there"},
      {"*SHELL SECTION, ELSET=WEB, MATERIAL=ALU\n1.\n2.\n", "its data are not one line with a thickness"},
      {"*MATERIAL, NAME=HOT\n*ELASTIC\n1., .3, 20.\n.9, .3, 90.\n*SHELL SECTION, ELSET=WEB, "
       "MATERIAL=HOT\n1.\n",
       "its *ELASTIC is no single line of numbers"},
      {"*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=LAMINA\n1., 1., .3, 1., 1., 1.\n"
       "*SHELL SECTION, ELSET=WEB, MATERIAL=PLY\n1.\n",
       "its *ELASTIC is of type LAMINA"}};
  for (const auto& [section, why] : sections) {
    write_text(folder / "a.inp", kRowOfQuads + kMaterials + section);
    const auto result = folder.run("convert a.inp b.bdf");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, std::string("lost: *SHELL SECTION of WEB: ") + why, "*SHELL SECTION (1)"))
        << result.err;
    EXPECT_EQ(lines_with(read_text(folder / "b.bdf"), "PSHELL"), Strings());
  }
}

TEST(CarriedSections, TellsWhichCardsStay) {
  const Workplace folder;
  const std::string grid =
      "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n"
      "GRID,5,,2.,0.,1.\nGRID,6,,2.,1.,1.\nCQUAD4,1,7,1,2,3,4\nCQUAD4,2,9,2,5,6,3,,.25\n"
      "MAT1,4,2.1+5,80769.23,,7.85-9,1.2-5\nMAT1,5,,1.,.25\n";
  write_text(folder / "a.bdf", grid + "PSHELL,7,4,.8,4,,4\n,.4,-.4\nPSHELL,9,5,1.5\nENDDATA\n");
  const auto result = folder.run("convert a.bdf b.inp");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(
      result.err,
      "lost: Z1, Z2 of PSHELL 7\nlost: A of MAT1 4\n"
      "lost: PSHELL 9: its material for bending (MID2) is not that for membranes (MID1)\n"
      "lost: keywords and how many: MAT1 (1), PSHELL (1), angles, offsets or thicknesses of CQUAD4 (1)\n");
  const std::string deck = read_text(folder / "b.inp");
  EXPECT_TRUE(holds(deck, "*MATERIAL, NAME=material_4\n*ELASTIC\n210000, 0.3000000",
                    "*SHELL SECTION, ELSET=region_7, MATERIAL=material_4\n0.8\n"));
  EXPECT_EQ(lines_with(deck, "*SHELL SECTION").size(), 1u);
}

}  // namespace
}  // namespace delquad::testing_support
