// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Two quads and two triangles on a bent surface, in two regions, with names that Abaqus cannot hold.
Mesh bent() {
  Mesh mesh = quad_grid(3, 1, 0.1, 1.0 / 3);
  mesh.points[0].z = 0.7;
  const auto quad = mesh.quads[2];
  mesh.quads.pop_back();
  mesh.quad_region = {0, 0};
  mesh.triangles = {{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}};
  mesh.triangle_region = {1, 1};
  mesh.regions = {{1, {"Blech", "all parts"}}, {7, {"all parts", "blech"}}};
  mesh.curves[0].names = {"3 côtés"};
  mesh.curves[2].names = {};
  return mesh;
}

const char* const kGridInp = R"(*HEADING
Quad mesh by Delquad
*NODE, NSET=Nall
1, 0, 0, 0
2, 0.5, 0, 0
3, 0, 2, 0
4, 0.5, 2, 0
*ELEMENT, TYPE=CPS4, ELSET=Eall
1, 1, 2, 4, 3
*ELSET, ELSET=inside
1
*ELSET, ELSET=region_1
1
*ELSET, ELSET=_curve_1_S1
1
*ELSET, ELSET=_curve_2_S2
1
*ELSET, ELSET=_curve_3_S3
1
*ELSET, ELSET=_curve_4_S4
1
*ELSET, ELSET=_east_S2
1
*ELSET, ELSET=_north_S3
1
*ELSET, ELSET=_south_S1
1
*ELSET, ELSET=_west_S4
1
*NSET, NSET=curve_1
1, 2
*NSET, NSET=curve_2
2, 4
*NSET, NSET=curve_3
3, 4
*NSET, NSET=curve_4
1, 3
*NSET, NSET=east
2, 4
*NSET, NSET=inside
1, 2, 3, 4
*NSET, NSET=north
3, 4
*NSET, NSET=region_1
1, 2, 3, 4
*NSET, NSET=south
1, 2
*NSET, NSET=west
1, 3
*SURFACE, NAME=curve_1, TYPE=ELEMENT
_curve_1_S1, S1
*SURFACE, NAME=curve_2, TYPE=ELEMENT
_curve_2_S2, S2
*SURFACE, NAME=curve_3, TYPE=ELEMENT
_curve_3_S3, S3
*SURFACE, NAME=curve_4, TYPE=ELEMENT
_curve_4_S4, S4
*SURFACE, NAME=east, TYPE=ELEMENT
_east_S2, S2
*SURFACE, NAME=north, TYPE=ELEMENT
_north_S3, S3
*SURFACE, NAME=south, TYPE=ELEMENT
_south_S1, S1
*SURFACE, NAME=west, TYPE=ELEMENT
_west_S4, S4
)";

TEST(AbaqusInp, IsTheDocumentedFormat) {
  const Folder folder;
  write_mesh(folder / "a.inp", quad_grid(1, 1, 0.5, 2));
  EXPECT_EQ(read_text(folder / "a.inp"), kGridInp);
}

TEST(AbaqusInp, NamesBecomeLabels) {
  const Folder folder;
  write_mesh(folder / "a.inp", bent());
  const std::string text = read_text(folder / "a.inp");
  EXPECT_TRUE(holds(text, "TYPE=S3, ELSET=Eall\n1, ", "TYPE=S4, ELSET=Eall\n3, ", "ELSET=Blech\n3, 4\n",
                    "ELSET=all_parts\n1, 2, 3, 4\n", "ELSET=blech_2\n1, 2\n", "NSET=SET_3_c__t__s\n",
                    "NSET=curve_3\n", "ELSET=region_7\n1, 2\n", "** region \"blech\" is blech_2\n",
                    "** curve \"3 côtés\" is SET_3_c__t__s\n",
                    "*SURFACE, NAME=SET_3_c__t__s, TYPE=NODE\n1\n2\n3\n4\n", "ELSET=_curve_1_E1\n"));
}

TEST(AbaqusInp, NumbersComeBack) {
  const Folder folder;
  const auto numbers = [](const std::vector<Entity>& entities) {
    std::set<int> all;
    for (const Entity& entity : entities) {
      all.insert(entity.tag);
      for (const std::string& name : entity.names)
        EXPECT_FALSE(name.starts_with("curve_") || name.starts_with("region_")) << name;
    }
    return all;
  };
  // Surfaces of plane elements have sides, surfaces of shells sets.
  for (const Mesh& mesh : {quad_grid(2, 2, 0.5, 0.5), bent()}) {
    write_mesh(folder / "a.inp", mesh);
    const Mesh read = read_mesh(folder / "a.inp");
    EXPECT_EQ(read.lines.size(), mesh.lines.size());
    EXPECT_EQ(numbers(read.curves), numbers(mesh.curves));
    EXPECT_EQ(numbers(read.regions), numbers(mesh.regions));
  }
}

TEST(AbaqusInp, SetsOfEverythingGiveWayToNames) {
  const Folder folder;
  Mesh mesh = quad_grid(2, 2);
  mesh.regions[0].names = {"EALL"};
  write_mesh(folder / "a.inp", mesh);
  const std::string text = read_text(folder / "a.inp");
  EXPECT_TRUE(holds(text, "TYPE=CPS4, ELSET=Eall_2\n", "*NODE, NSET=Nall\n", "** set \"Eall\" is Eall_2\n"));
}

TEST(AbaqusInp, AFaceThatLooksDownIsAShell) {
  const Folder folder;
  Mesh mesh = quad_grid(2, 2);
  for (auto& quad : mesh.quads) std::swap(quad[1], quad[3]);
  write_mesh(folder / "a.inp", mesh);
  EXPECT_TRUE(holds(read_text(folder / "a.inp"), "TYPE=S4,"));
}

TEST(AbaqusInp, NumbersFitCalculix) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1, 100, 100);
  mesh.points[1].z = 6.467675661368277e-05;
  mesh.points[2].z = -1.2345678901234567e-05;
  mesh.points[3].z = 1.7763568394002505e-15;
  write_mesh(folder / "a.inp", mesh);
  const std::string text = read_text(folder / "a.inp");
  EXPECT_TRUE(holds(text, "\n2, 100, 0, 6.46767566136828e-05\n", "\n3, 0, 100, -1.2345678901235e-05\n",
                    "\n4, 100, 100, 0\n"));
  EXPECT_EQ(read_mesh(folder / "a.inp").points[1].z, 6.46767566136828e-05);
}

const std::string kPython = "/usr/bin/python3";

ProgramResult run_python(Strings arguments) {
  ProgramOptions options;
  options.arguments = std::move(arguments);
  return run_program(kPython, options);
}

// Read back by an independent program, which compares with the MSH file of the same mesh.
TEST(SolverFormats, MeshioReadsTheSameMesh) {
  if (run_python({"-c", "import meshio"}).exit_code != 0)
    GTEST_SKIP() << "meshio is not installed for " << kPython;
  const Folder folder;
  const auto script = write_text(folder / "compare.py", R"(
import sys, meshio, numpy as np
msh, other = meshio.read(sys.argv[1]), meshio.read(sys.argv[2])
for kind in ('triangle', 'quad'):
    a, b = (m.points[np.vstack([c.data for c in m.cells if c.type == kind])].tolist() for m in (msh, other))
    assert a == b, (kind, a, b)
if sys.argv[2].endswith('.mesh'):
    for kind in ('line', 'triangle', 'quad'):
        a = np.concatenate([r for c, r in zip(msh.cells, msh.cell_data['gmsh:geometrical']) if c.type == kind])
        b = np.concatenate([r for c, r in zip(other.cells, other.cell_data['medit:ref']) if c.type == kind])
        assert a.tolist() == b.tolist(), (kind, a, b)
else:
    sizes = {k: sum(len(x) for x in v) for k, v in other.cell_sets.items()}
    wanted = {'Blech': 2, 'all_parts': 4, 'blech_2': 2, 'region_1': 2, 'region_7': 2, 'Eall': 4}
    assert {k: n for k, n in sizes.items() if k[0] != '_'} == wanted, sizes
    sizes = {k: len(v) for k, v in other.point_sets.items()}
    assert sizes['SET_3_c__t__s'] == 4 and sizes['curve_3'] == 4 and sizes['east'] == 2, sizes
)");
  write_mesh(folder / "a.msh", bent());
  for (const char* name : {"a.inp", "a.mesh"}) {
    write_mesh(folder / name, bent());
    const auto result = run_python({script, folder / "a.msh", folder / name});
    EXPECT_EQ(result.exit_code, 0) << name << ": " << result.err;
  }
}

}  // namespace
}  // namespace delquad
