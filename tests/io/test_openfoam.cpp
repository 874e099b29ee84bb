// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_formats.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// The lists of numbers in brackets, one a line.
std::vector<std::vector<double>> rows_of(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t open = line.find('(');
    if (open == std::string::npos || line.back() != ')' || line.size() < 3) continue;
    std::istringstream numbers(line.substr(open + 1));
    std::vector<double>& row = rows.emplace_back();
    for (double value = 0; numbers >> value;) row.push_back(value);
  }
  return rows;
}

/// Four by two cells whose east side is the image of the west side, with a line inside.
Mesh channel() {
  Mesh mesh = quad_grid(4, 2, 4, 2);
  mesh.curves.push_back({5, {"steel-copper"}});
  for (const auto& line : {std::array{2, 7}, {7, 12}})
    mesh.lines.push_back(line), mesh.line_curve.push_back(4);
  mesh.periodic = {{1, 3, {{4, 0, 0}}, {{4, 0}, {9, 5}, {14, 10}}}};
  return mesh;
}

TEST(OpenFoam, PeriodicSidesAreCyclicPatches) {
  const Folder folder;
  write_mesh(folder / "a.foam", channel());
  const auto home = folder / "constant/polyMesh";
  const std::string boundary = read_text(home / "boundary");
  const auto patch = [&](const std::string& name, const std::string& neighbour) {
    const std::size_t at = boundary.find("\n" + name + "\n");
    EXPECT_NE(at, std::string::npos) << boundary;
    const std::string part = boundary.substr(at, boundary.find('}', at) - at);
    EXPECT_TRUE(holds(part, "type cyclic;", "neighbourPatch " + neighbour + ";", "nFaces 2;"));
    return std::stoul(part.substr(part.find("startFace") + 9));
  };
  const std::size_t west = patch("west", "east"), east = patch("east", "west");
  EXPECT_TRUE(holds(boundary, "type patch"));  // south and north
  const auto points = rows_of(read_text(home / "points")), faces = rows_of(read_text(home / "faces"));
  // OpenFOAM: both faces begin at the same node, and run round in opposite ways.
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& here = points[static_cast<std::size_t>(faces[west + f][k])];
      const auto& there = points[static_cast<std::size_t>(faces[east + f][(4 - k) % 4])];
      EXPECT_EQ(there, (std::vector{here[0] + 4, here[1], here[2]}));
    }
}

TEST(OpenFoam, NamedCurvesInsideAreFaceZones) {
  const Folder folder;
  write_mesh(folder / "a.foam", channel());
  const std::string zones = read_text(folder / "constant/polyMesh/faceZones");
  EXPECT_TRUE(holds(zones, "steel_copper\n{\n    type faceZone;\n    faceLabels List<label> 2\n(\n",
                    "flipMap List<bool> 2{0};"));
  const auto points = rows_of(read_text(folder / "constant/polyMesh/points")),
             faces = rows_of(read_text(folder / "constant/polyMesh/faces"));
  std::istringstream labels(zones.substr(zones.find("(\n", zones.find("faceLabels")) + 2));
  for (std::size_t face = 0, n = 0; n < 2; ++n) {
    labels >> face;
    for (const double v : faces[face]) EXPECT_EQ(points[static_cast<std::size_t>(v)][0], 2);
  }
}

TEST(Su2, TellsSettingsOfPeriodicMarkers) {
  const Folder folder;
  write_mesh(folder / "a.su2", channel());
  const std::string text = read_text(folder / "a.su2");
  EXPECT_TRUE(holds(text, "% MARKER_PERIODIC= ( west, east, 0, 0, 0, 0, 0, 0, 4, 0, 0 )\n"));
  EXPECT_FALSE(holds(text, "steel"));
}

TEST(LostInFile, NoFurtherNameThatAnotherCurveHas) {
  Mesh mesh = channel();
  mesh.curves[0].names = {"outline", "inlet"};
  mesh.curves[1].names = {"outline"};
  EXPECT_EQ(unsupported_in_file("a.foam", mesh).size(), 0u);
  mesh.curves[1].names = {"wall"};
  EXPECT_EQ(unsupported_in_file("a.foam", mesh).size(), 1u);
}

TEST(LostInFile, NamesAndPairsThatTheFormatDoesNotHold) {
  const auto lost = [](const char* file) { return unsupported_in_file(file, channel()); };
  EXPECT_EQ(lost("a.msh").size(), 0u);
  EXPECT_EQ(lost("a.foam").size(), 0u);
  EXPECT_EQ(lost("a.su2"), (Strings{"names of regions, which '.su2' does not hold: inside",
                                    "names of curves inside, which '.su2' does not hold: steel-copper"}));
  EXPECT_EQ(lost("a.vtu"), Strings{"which nodes are images of others, which '.vtu' does not hold"});
}

}  // namespace
}  // namespace delquad
