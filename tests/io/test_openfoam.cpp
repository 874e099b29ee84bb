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

/// n x 2 x m bricks, warped inside, with named faces at x = 0 and 1, and the ends of a sweep along z.
Mesh bricks(int n, int m) {
  Mesh mesh;
  const auto at = [&](int i, int j, int k) { return (k * 3 + j) * (n + 1) + i; };
  for (int k = 0; k <= m; ++k)
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i <= n; ++i)
        mesh.points.push_back({i + 0.1 * (i % n > 1 && j == 1), j + 0.2 * (i % n > 1 && j == 1), 1.0 * k});
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < n; ++i) {
        const auto end = [&](int l) {
          return std::array{at(i, j, l), at(i + 1, j, l), at(i + 1, j + 1, l), at(i, j + 1, l)};
        };
        const auto below = end(k), above = end(k + 1);
        mesh.hexahedra.push_back(
            {below[0], below[1], below[2], below[3], above[0], above[1], above[2], above[3]});
        mesh.hex_volume.push_back(i < 1);
        if (i < 2)
          mesh.quads.push_back({below[0], above[0], above[3], below[3]}), mesh.quad_region.push_back(i);
        if (k == 0)
          mesh.quads.push_back({below[0], below[3], below[2], below[1]}), mesh.quad_region.push_back(2);
        if (k == m - 1) mesh.quads.push_back(above), mesh.quad_region.push_back(3);
      }
  mesh.volumes = {{1, {"water"}}, {2, {"steel"}}};
  mesh.regions = {{1, {"inner wall"}}, {2, {"screen"}}, {3, {"water start"}}, {4, {"water end"}}};
  return mesh;
}

/// Writes the mesh and tests the lists that OpenFOAM reads. Returns the text of the patches and zones.
std::string check_foam(const Mesh& mesh) {
  const Folder folder;
  write_mesh(folder / "a.foam", mesh);
  const auto home = folder / "constant/polyMesh";
  const auto list = [&](const char* name) {
    std::istringstream text(read_text(home / name));
    std::vector<int> numbers;
    for (std::string line; std::getline(text, line);)
      if (!line.empty() && std::isdigit(line[0])) numbers.push_back(std::stoi(line));
    numbers.erase(numbers.begin());  // how many follow
    return numbers;
  };
  const auto points = rows_of(read_text(home / "points")), faces = rows_of(read_text(home / "faces"));
  const std::vector<int> owner = list("owner"), neighbour = list("neighbour");
  EXPECT_EQ(owner.size(), faces.size());
  std::vector<Vec3> area(mesh.hexahedra.size());
  std::vector<double> volume(mesh.hexahedra.size(), 0);
  std::vector<int> n_faces(mesh.hexahedra.size(), 0);
  std::array<int, 2> last = {-1, -1};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corner = [&](std::size_t k) {
      const auto& p = points[static_cast<std::size_t>(faces[f][k])];
      return Vec3{p[0], p[1], p[2]};
    };
    const Vec3 outward = 0.5 * cross(corner(2) - corner(0), corner(3) - corner(1));
    const double part = dot(corner(0) + corner(1) + corner(2) + corner(3), outward) / 12;
    const auto add = [&](int cell, double sign) {
      area[cell] = area[cell] + sign * outward, volume[cell] += sign * part, ++n_faces[cell];
    };
    add(owner[f], 1);
    if (f >= neighbour.size()) continue;
    add(neighbour[f], -1);
    EXPECT_LT(owner[f], neighbour[f]);
    EXPECT_LT(last, (std::array{owner[f], neighbour[f]}));
    last = {owner[f], neighbour[f]};
  }
  for (std::size_t c = 0; c < area.size(); ++c) {
    EXPECT_EQ(n_faces[c], 6);
    EXPECT_LT(norm(area[c]), 1e-12);
    EXPECT_GT(volume[c], 0.5);
  }
  return read_text(home / "boundary") + read_text(home / "faceZones") + read_text(home / "cellZones");
}

TEST(OpenFoam, HexahedraHavePatchesAndZonesByTheirNames) {
  const std::string text = check_foam(bricks(4, 3));
  EXPECT_TRUE(holds(text, "inner_wall\n{\n    type wall;\n    nFaces 6;", "water_end\n{\n    type patch;",
                    "defaultFaces\n{\n    type patch;\n    nFaces 30;",
                    "screen\n{\n    type faceZone;\n    faceLabels List<label> 6\n",
                    "steel\n{\n    type cellZone;\n    cellLabels List<label> 6\n"));
}

TEST(OpenFoam, OneFlatLayerIsTwoDimensional) {
  const std::string text = check_foam(bricks(4, 1));
  EXPECT_TRUE(holds(text, "water_start\n{\n    type empty;", "water_end\n{\n    type empty;", "type wall;"));
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
