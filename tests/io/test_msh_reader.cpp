// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/io/msh_files.h"
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

using msh_files::kSquare22;
using msh_files::kSquare41;
using msh_files::with;

class MshReader : public testing_support::ReaderTest<> {
 protected:
  MshReader() : ReaderTest("case.msh") {}
  void expect_square(const Mesh& mesh) {
    EXPECT_EQ(check_invariants(mesh), Strings());
    EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}))
        << "by tag: 1, 2, 4, 10";
    EXPECT_EQ(mesh.lines, (Lines{{0, 1}, {1, 3}, {3, 2}, {2, 0}}));
    EXPECT_EQ(mesh.line_curve, (std::vector<int>{0, 0, 1, 1}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 3}, {0, 3, 2}}));
    ASSERT_EQ(mesh.curves.size(), 2u);
    ASSERT_EQ(mesh.regions.size(), 1u);
    EXPECT_EQ(mesh.curves[0].tag, 7);
    EXPECT_EQ(mesh.curves[0].names, (Strings{"wall one", "all walls"}));
    EXPECT_EQ(mesh.curves[1].tag, 8);
    EXPECT_EQ(mesh.curves[1].names, (Strings{"all walls"}));
    EXPECT_EQ(mesh.regions[0].tag, 3);
    EXPECT_EQ(mesh.regions[0].names, (Strings{"plate"}));
  }
};

TEST_F(MshReader, Reads41) { expect_square(read(kSquare41)); }

TEST_F(MshReader, Reads22AndMergesElementsListedOncePerGroup) { expect_square(read(kSquare22)); }

TEST_F(MshReader, SkipsUnknownSectionsAndTakesAnyLineEnds) {
  const std::string comment = "$Comments\n$Nodes is not a section here\n$EndComments\n";
  expect_square(read(comment + with(kSquare41, "$Nodes", comment + "$Nodes") + comment));
  std::string windows;
  for (const char c : kSquare41) windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_square(read(windows));
  expect_square(read(kSquare22.substr(0, kSquare22.size() - 1)));
}

TEST_F(MshReader, TakesSectionsInOtherOrders) {
  const size_t names = kSquare22.find("$PhysicalNames"), nodes = kSquare22.find("$Nodes"),
               elements = kSquare22.find("$Elements");
  expect_square(read(kSquare22.substr(0, names) + kSquare22.substr(elements) +
                     kSquare22.substr(nodes, elements - nodes) + kSquare22.substr(names, nodes - names)));
}

TEST_F(MshReader, GroupsWithoutNamesGoByTheirNumber) {
  const std::string text =
      kSquare22.substr(0, kSquare22.find("$PhysicalNames")) + kSquare22.substr(kSquare22.find("$Nodes"));
  const Mesh mesh = read(text);
  EXPECT_EQ(mesh.curves[0].names, (Strings{"1", "2"}));
  EXPECT_EQ(mesh.regions[0].names, (Strings{"1"}));
}

TEST_F(MshReader, LinesWithoutGroupKeepTheirElementaryTag) {
  const Mesh mesh = read(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
      "$Elements\n3\n1 1 2 0 12 1 2\n2 1 2 0 13 2 3\n3 1 2 0 12 3 1\n$EndElements\n");
  EXPECT_EQ(mesh.line_curve, (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(mesh.curves[0].tag, 12);
  EXPECT_EQ(mesh.curves[1].tag, 13);
  EXPECT_TRUE(mesh.curves[0].names.empty());
}

TEST_F(MshReader, GroupsThatShareAnElementaryTagStayApart) {
  // As some programs write: every line has elementary tag 1 or none at all.
  for (const char* elementary : {"1", "0"}) {
    const std::string e(elementary);
    const Mesh mesh = read(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
        "$Elements\n3\n1 1 2 5 " +
        e + " 1 2\n2 1 2 6 " + e + " 2 3\n3 1 2 5 " + e + " 3 1\n$EndElements\n");
    EXPECT_EQ(mesh.line_curve, (std::vector<int>{0, 1, 0})) << e;
    EXPECT_EQ(mesh.curves[0].names, (Strings{"5"})) << e;
    EXPECT_EQ(mesh.curves[1].names, (Strings{"6"})) << e;
    EXPECT_NE(mesh.curves[0].tag, mesh.curves[1].tag) << e;
  }
}

TEST_F(MshReader, ElementsNeedNoEntity) {
  const Mesh mesh = read(with(kSquare41, "2 3 2 2\n", "2 0 2 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.regions.size(), 1u);
  EXPECT_GT(mesh.regions[0].tag, 8);
}

TEST_F(MshReader, KeepsTrueTwinsForOthersToReport) {
  const Mesh mesh = read(with(kSquare22, "4 1 2 2 7 1 2", "4 1 2 1 7 1 2"));
  EXPECT_EQ(mesh.lines.size(), 5u);
  EXPECT_FALSE(check_invariants(mesh).empty());
}

TEST_F(MshReader, NamesTheLineOfWhatIsWrong) {
  expect_error(with(kSquare41, "1 0 0\n1 8", "1 nan 0\n1 8"), {"case.msh:23: ", "coordinate y", "'nan'"});
  expect_error(with(kSquare41, "1 0 0\n1 8", "1 1e999 0\n1 8"), {"case.msh:23: ", "finite"});
  expect_error(with(kSquare41, "1 0 0\n1 8", "1 zero 0\n1 8"), {"case.msh:23: ", "'zero'"});
  expect_error(with(kSquare41, "6 1 2 10", "6 1 2 11"), {"case.msh:44: ", "no node with tag 11"});
  expect_error(with(kSquare41, "10\n4\n", "10\n1\n"),
               {"case.msh:26: ", "node tag 1 is used twice", "line 20"});
  expect_error(with(kSquare41, "2 3 2 2\n", "2 3 4 2\n"),
               {"case.msh:43: ", "4 corners in a block of dimension 2"});
  expect_error(with(kSquare41, "2 3 2 2\n", "2 3 20 2\n"), {"case.msh:43: ", "third-order triangle"});
  expect_error(with(kSquare41, "2 3 2 2\n", "2 3 99 2\n"), {"case.msh:43: ", "element type 99"});
  expect_error(with(kSquare41, "2 3 2 2\n", "1 3 2 2\n"), {"case.msh:43: ", "dimension 1"});
  expect_error(with(kSquare22, "8 2 2 1 3", "8 39 2 1 3"), {"case.msh:26: ", "third-order quad without"});
  expect_error(with(kSquare22, "3 1 2 1 7 2 10", "3 1 2 1 7 2 -3"), {"case.msh:21: ", "from 1 to", "'-3'"});
  expect_error(with(kSquare41, "1 1 \"wall one\"", "1 1 wall"), {"case.msh:6: ", "double quotes"});
}

TEST_F(MshReader, ChecksWhatIsAnnounced) {
  expect_error(with(kSquare41, "3 5 1 10", "3 6 1 10"), {"case.msh:", "5 nodes, but 6"});
  expect_error(with(kSquare41, "3 5 1 10", "3 4 1 10"), {"case.msh:", "more nodes than the 4"});
  expect_error(with(kSquare41, "4 7 1 7", "4 8 1 7"), {"case.msh:", "7 elements, but 8"});
  expect_error(with(kSquare41, "4 7 1 7", "4 6 1 7"), {"case.msh:", "more elements"});
  expect_error(with(kSquare22, "\n4\n1 0", "\n3\n1 0"), {"case.msh:", "$EndNodes"});
  expect_error(with(kSquare22, "\n9\n1 15", "\n10\n1 15"), {"case.msh:28: ", "'$EndElements'"});
  const std::string second = "$Nodes\n0\n$EndNodes\n";
  expect_error(kSquare22 + second, {"case.msh:29: ", "second $Nodes"});
}

TEST_F(MshReader, AllocatesNoMoreThanTheFileCanHold) {
  expect_error(with(kSquare41, "3 5 1 10", "3 1000000000000 1 10"), {"case.msh:18: ", "number of nodes"});
  expect_error(with(kSquare41, "3 5 1 10", "3 2000000000 1 10"), {"case.msh:", "2000000000"});
  expect_error(with(kSquare22, "\n4\n1 0", "\n2000000000\n1 0"), {"case.msh:"});
  expect_error(with(kSquare41, "1 2 1 0\n", "1 2000000000 1 0\n"), {"case.msh:"});
}

TEST_F(MshReader, SaysWhichFilesItReads) {
  expect_error(with(kSquare41, "4.1 0 8", "4 0 8"), {"case.msh:2: ", "'4'", "2.2 or 4.1"});
  expect_error(with(kSquare41, "4.1 0 8", "4.1 1 8"), {"case.msh: byte ", "expected the number 1"});
  expect_error("", {"case.msh:1: ", "empty"});
  expect_error(std::string("\x7f"
                           "ELF\0\0garbage",
                           12),
               {"case.msh:1: ", "not an MSH file"});
  expect_error("$Nodes\n1\n", {"case.msh:1: ", "expected $MeshFormat"});
  expect_error("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", {"without a $Nodes section"});
  expect_error("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n", {"case.msh:4: ", "$EndComments"});
  expect_error(with(kSquare41, "$Entities", "$PartitionedEntities"), {"case.msh:10: ", "partitioned"});
  expect_input_error([&] { read_mesh(folder_ / "missing.msh"); }, {"missing.msh: ", "No such file"});
  expect_input_error([&] { read_mesh(folder_.path()); }, {"folder"});
}

TEST_F(MshReader, NeedsElements) {
  expect_error(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 15 0 "
      "1\n$EndElements\n",
      {"no lines, triangles, quads or cells"});
}

}  // namespace
}  // namespace delquad
