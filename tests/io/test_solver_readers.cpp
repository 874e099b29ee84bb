// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_mesh.h"
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

class MfemReader : public testing_support::ReaderTest<> {
 protected:
  MfemReader() : ReaderTest("case.mfem") {}
};

/// The square [0, 2] x [0, 1] as two quads, of which the second begins at vertex 4, so that sides run both
/// ways.
const std::string kMfem =
    "MFEM mesh v1.0\r\n# by hand\n\ndimension\n2\n\nelements\n2\n1 3 0 1 4 3\n2 3 4 1 2 5\n\nboundary\n1\n3 "
    "1 2 1\n\n"
    "vertices\n6\n";
const std::string kMfemPlaces = "2\n0 0\n1 0\n2 0\n0 1\n1 1\n2 1\n";

TEST_F(MfemReader, ReadsFilesOfOthers) {
  const Mesh mesh = read(kMfem + kMfemPlaces);
  EXPECT_EQ(mesh.quads, (Quads{{0, 1, 4, 3}, {4, 1, 2, 5}}));
  EXPECT_EQ(mesh.lines, (Lines{{2, 1}}));
  EXPECT_EQ(mesh.curves[0].tag, 3);
  EXPECT_EQ(mesh.regions[1].tag, 2);
  write_text(folder_ / "a.mesh", kMfem + kMfemPlaces);
  EXPECT_EQ(read_mesh(folder_ / "a.mesh").quads.size(), 2u) << "as MFEM calls its files";
}

/// Nodes that elements share, all at the points of Gauss and Lobatto. Vertices come first, then sides in the
/// order in which elements have them, from the lower vertex to the higher one, then the inside.
TEST_F(MfemReader, ReadsSharedNodes) {
  const std::vector<std::vector<double>> points = {
      {0, 0.5, 1}, {0, 0.5 - 0.5 / std::sqrt(5.0), 0.5 + 0.5 / std::sqrt(5.0), 1}};
  for (const int order : {2, 3}) {
    const std::vector<double>& t = points[order - 2];
    const auto bent = [](double x, double y) { return Vec3{x + 0.1 * y * y, y + 0.1 * x * x, 0}; };
    std::vector<Vec3> nodes;
    const double places[][2] = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
    for (const auto& [x, y] : places) nodes.push_back(bent(x, y));
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 4}, {3, 4}, {0, 3}, {1, 2}, {2, 5}, {4, 5}})
      for (int k = 1; k < order; ++k)
        nodes.push_back(bent(places[a][0] + t[k] * (places[b][0] - places[a][0]),
                             places[a][1] + t[k] * (places[b][1] - places[a][1])));
    for (int j = 1; j < order; ++j)
      for (int i = 1; i < order; ++i) nodes.push_back(bent(t[i], t[j]));
    for (int j = 1; j < order; ++j)  // of the second quad, which begins at (1, 1) and goes down first
      for (int i = 1; i < order; ++i) nodes.push_back(bent(1 + t[j], 1 - t[i]));
    std::string by_nodes, by_axes[2];
    for (const Vec3& p : nodes) {
      char text[80];
      std::snprintf(text, sizeof text, "%.17g %.17g\n", p.x, p.y);
      by_nodes += text;
      std::snprintf(text, sizeof text, "%.17g\n", p.x);
      by_axes[0] += text;
      std::snprintf(text, sizeof text, "%.17g\n", p.y);
      by_axes[1] += text;
    }
    for (const bool ordering : {false, true}) {
      const Mesh mesh = read(
          kMfem + "\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1_2D_P" + std::to_string(order) +
          "\nVDim: 2\nOrdering: " + (ordering ? "1\n\n" + by_nodes : "0\n\n" + by_axes[0] + by_axes[1]));
      require_readable(mesh, "read");
      EXPECT_EQ(check_invariants(mesh), Strings());
      ASSERT_EQ(mesh.order, order);
      const double p = order;
      for (int j = 0; j <= order; ++j)
        for (int i = 0; i <= order; ++i) {
          const int place = j * (order + 1) + i;
          EXPECT_LE(norm(mesh.points[nodes_of_quad(mesh, 0)[place]] - bent(i / p, j / p)), 1e-12);
          EXPECT_LE(norm(mesh.points[nodes_of_quad(mesh, 1)[place]] - bent(1 + j / p, 1 - i / p)), 1e-12);
        }
      for (int k = 0; k <= order; ++k)
        EXPECT_LE(norm(mesh.points[nodes_of_line(mesh, 0)[k]] - bent(2 - k / p, 0)), 1e-12);
    }
  }
}

TEST_F(MfemReader, NamesTheLineOfWhatIsWrong) {
  const std::string whole = kMfem + kMfemPlaces;
  const auto with = [](std::string text, const char* what, const char* other) {
    return text.replace(text.find(what), std::string_view(what).size(), other);
  };
  expect_error("MFEM NC mesh v1.0\n", {"case.mfem:1: ", "expected MFEM mesh v1.0"});
  expect_error(with(whole, "dimension\n2", "dimension\n3"), {"case.mfem:5: ", "dimension 2"});
  expect_error(with(whole, "1 3 0 1 4 3", "1 5 0 1 4 3"), {"case.mfem:9: ", "geometry 5"});
  expect_error(with(whole, "1 3 0 1 4 3", "1 3 0 1 9 3"), {"case.mfem:9: ", "no vertex 9", "there are 6"});
  expect_error(with(whole, "3 1 2 1", "3 2 2 1 0"), {"case.mfem:14: ", "segments"});
  expect_error(with(whole, "2 0\n", "2 zero\n"), {"case.mfem:21: ", "'zero'"});
  expect_error(kMfem, {"case.mfem:17: ", "6 do not fit"});
  expect_error(kMfem + "# and nothing else\n", {"case.mfem:", "no coordinates"});
  expect_error(with(whole, "vertices", "knots"), {"case.mfem:16: ", "'knots'"});
  const std::string space = "nodes\nFiniteElementSpace\nFiniteElementCollection: ";
  expect_error(kMfem + space + "NURBS2\nVDim: 2\nOrdering: 1\n", {"case.mfem:20: ", "'NURBS2'", "H1_2D_P1"});
  expect_error(kMfem + space + "H1_2D_P5\nVDim: 2\nOrdering: 1\n", {"case.mfem:20: ", "up to P4"});
  expect_error(kMfem + space + "H1_2D_P2\nVDim: 2\nOrdering: 1\n0 0 1 1\n",
               {"case.mfem:", "4 numbers for 15 nodes of 2 coordinates"});
  std::string apart = kMfem + space + "L2_T4_2D_P1\nVDim: 2\nOrdering: 1\n";
  apart += "0 0\n1 0\n0 1\n1 1\n1 1\n1 0.1\n2 1\n2 0\n";
  expect_error(apart, {"case.mfem:10: ", "element 1", "(1, 0.1, 0)", "hang together"});
}

class NastranReader : public testing_support::ReaderTest<> {
 protected:
  NastranReader() : ReaderTest("case.bdf") {}
};

/// The same cards in fields of every kind.
TEST_F(NastranReader, ReadsFieldsOfEveryKind) {
  const std::string head = "SOL 101\nCEND\nTITLE = GRID,1,2\nBEGIN BULK\n$ by hand\n",
                    tail = "ENDDATA\nnothing\n";
  const std::string small =
      "GRID    1               0.      0.      0.\n"
      "GRID    2               1.5-1   0.      0.      0               +A\n"
      "GRID    3               .15     1.D-1\n"
      "grid    4               0.      +1.E-01 -0.5+1\n"
      "CQUAD4  10      7       1       2       3       4\n"
      "PLOTEL  11      1       2\n"
      "CBAR    12      9       2       3       0.      0.      1.\n"
      "CTRIA3  13              1       2       3\n"
      "PSHELL  7       1       0.1\n";
  const std::string large =
      "GRID*   1                               0.              0.\n*       0.\n"
      "GRID*   2                               .15             0.              +B\n+B      0.\n"
      "GRID*   3                               1.5E-1          0.1\n*\n"
      "GRID*   4                               0.              .1\n*       -5.\n"
      "CQUAD4* 10              7               1               2\n*       3               4\n"
      "PLOTEL* 11              1               2\n"
      "CBAR*   12              9               2               3\n*       0.              0.              "
      "1.\n"
      "CTRIA3* 13                              1               2\n*       3\n";
  const std::string free =
      "GRID,1,,0.,0.,0.\nGRID,2,0,.15,0.,0.,,,,+C\n+C\nGRID*,3,,.15,.1\n*\nGRID,4,,0.,.1,\n,\n"
      "GRID, 99 ,, 8., 8.,8.\nCQUAD4,10,7,1,2, 3 "
      ",4\nPLOTEL,11,1,2\nCBAR,12,9,2,3,0.,0.,1.\nCTRIA3,13,,1,2,3\n";
  std::string tabs;  // in the place of blanks behind fields
  for (std::size_t at = 0, column = 0; at < small.size(); ++at) {
    const std::size_t next = small.find_first_not_of(' ', at);
    if (small[at] == ' ' && next >= at + 8 - column % 8) {
      tabs += '\t';
      at += 7 - column % 8;
      column += 8 - column % 8;
    } else {
      tabs += small[at];
      column = small[at] == '\n' ? 0 : column + 1;
    }
  }
  std::string free_deep = free;
  free_deep.replace(free_deep.find(",0.,.1,\n"), 8, ",0.,.1,-5.\n");
  for (const std::string& text : {small, large, free_deep, tabs}) {
    for (const std::string& whole : {head + text + tail, text}) {
      const Mesh mesh = read(whole);
      EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {0.15, 0, 0}, {0.15, 0.1, 0}, {0, 0.1, -5}}))
          << whole;
      EXPECT_EQ(mesh.quads, (Quads{{0, 1, 2, 3}}));
      EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
      EXPECT_EQ(mesh.lines, (Lines{{0, 1}, {1, 2}}));
      EXPECT_EQ(mesh.regions[0].tag, 7);
      EXPECT_EQ(mesh.regions[1].tag, 13) << "the element's own number";
      EXPECT_EQ(mesh.curves[1].tag, 9);
    }
  }
}

TEST_F(NastranReader, NamesTheLineOfWhatIsWrong) {
  const std::string points = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n";
  expect_error("", {"case.bdf:1: ", "no lines, triangles or quads"});
  expect_error(points + "CQUAD4,1,1,1,2,3,5\nCTRIA3,2,1,1,2,3\n", {"case.bdf:5: ", "no node 5"});
  expect_error(points + "CQUAD4,1,1,1,2,3\n", {"case.bdf:5: ", "a node's number", "''"});
  expect_error(points + "CQUAD4,1,x,1,2,3,4\n", {"case.bdf:5: ", "a property's number", "'x'"});
  expect_error(points + "GRID,4,,2.,2.,2.\n", {"case.bdf:5: ", "node 4 is there twice"});
  expect_error("GRID,1,,0.,a,0.\n", {"case.bdf:1: ", "coordinate", "'a'"});
  expect_error("GRID,1,,0.,1.e999,0.\n", {"case.bdf:1: ", "finite"});
  expect_error("GRID,1,5,0.,1.,0.\n", {"case.bdf:1: ", "coordinate system '5'"});
  expect_error("+A,1,5,0.,1.,0.\n", {"case.bdf:1: ", "before the first card"});
  expect_error("INCLUDE 'nodes.bdf'\n", {"case.bdf:1: ", "INCLUDE"});
  expect_error(points + "CTETRA,1,1,1,2,3,4\n", {"case.bdf:5: ", "CTETRA", "CQUAD4"});
  expect_error(points + "CTRIA6,1,1,1,2,3,4,4,4\n", {"case.bdf:5: ", "CTRIA6"});
  expect_error(points + "CQUAD4,1,1,1,2,3,4\nCQUAD8,2,1,1,2,3,4,1,2\n,3,4\n",
               {"case.bdf:6: ", "order 2 beside"});
  expect_error("$ set 1, nodes of point tip\nSET 1 = 3, x\nBEGIN BULK\n", {"case.bdf:2: ", "'X'"});
}

}  // namespace
}  // namespace delquad
