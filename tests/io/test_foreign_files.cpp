// SPDX-License-Identifier: GPL-3.0-or-later
#include <zlib.h>

#include "geometry/mesh/split_polygon.h"
#include "io/formats/vtu.h"
#include "tests/io/msh_files.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

namespace delquad {
namespace {

fs::path write_gzip(const fs::path& path, const std::string& text) {
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  return path;
}

template <class T>
void put(std::string& text, T value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// One quad and two lines of 2.2, as bytes.
std::string binary_22() {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  put(text, 1);
  text += "\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"plate\"\n$EndPhysicalNames\n$Nodes\n4\n";
  const double at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 4; ++i) {
    put(text, 10 * (i + 1));
    for (const double x : {at[i][0], at[i][1], 0.5}) put(text, x);
  }
  text += "\n$EndNodes\n$Elements\n3\n";
  for (const int n : {1, 2, 2, 1, 0, 5, 10, 20, 2, 0, 6, 20, 30}) put(text, n);
  for (const int n : {3, 1, 2, 3, 7, 1, 10, 20, 30, 40}) put(text, n);
  return text + "\n$EndElements\n$Other\n\1\2\n$EndOther\n";
}

TEST(BinaryMsh, ReadsLegacyFiles) {
  const Folder folder;
  const Mesh mesh = read_mesh(write_text(folder / "a.msh", binary_22()));
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}}));
  EXPECT_EQ(mesh.quads, (Quads{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.lines, (Lines{{0, 1}, {1, 2}}));
  EXPECT_EQ(mesh.regions[0].names, (Strings{"plate"}));
}

TEST(PeriodicMsh, SaysThatPairsAreNotRead) {
  const Folder folder;
  Mesh mesh = quad_grid(2, 2);
  ReadNotes notes;
  write_mesh(folder / "a.msh", mesh);
  read_mesh(folder / "a.msh", &notes);
  EXPECT_TRUE(notes.empty());
  mesh.periodic = {{0, 1, {}, {{0, 1}}}};
  write_mesh(folder / "a.msh", mesh);
  read_mesh(folder / "a.msh", &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(holds(notes[0], "$Periodic"));
}

TEST(BinaryMsh, DamagedFilesGiveOneMessage) {
  const Folder folder;
  Mesh mesh = quad_grid(3, 2);
  write_mesh(folder / "a.msh", mesh, {true, MshCurves::kAll});
  for (const std::string& whole : {read_text(folder / "a.msh"), binary_22()}) {
    const size_t needed = whole.find("$EndElements");
    for (size_t n = 0; n < needed; ++n)
      EXPECT_THROW(read_mesh(write_text(folder / "cut.msh", whole.substr(0, n))), InputError) << n;
    for (size_t n = 0; n < whole.size(); ++n) {
      std::string damaged = whole;
      damaged[n] = static_cast<char>(damaged[n] ^ 0x81);
      try {
        read_mesh(write_text(folder / "damaged.msh", damaged));
      } catch (const InputError&) {
      }
    }
  }
  expect_input_error([&] { read_mesh(write_text(folder / "cut.msh", binary_22().substr(0, 150))); },
                     {"cut.msh: byte ", "the file ends too early"});
}

TEST(Gzip, IsUnpacked) {
  const Folder folder;
  write_mesh(folder / "a.msh", quad_grid(5, 4), {true, MshCurves::kAll});
  const std::string text = read_text(folder / "a.msh");
  EXPECT_EQ(read_mesh(write_gzip(folder / "B.MSH.GZ", text)).quads, quad_grid(5, 4).quads);
  const std::string packed = read_text(folder / "B.MSH.GZ");
  expect_input_error([&] { read_mesh(write_text(folder / "c.msh.gz", packed.substr(0, packed.size() / 2))); },
                     {"c.msh.gz", "gzip", "damaged"});
  EXPECT_EQ(read_mesh(write_text(folder / "d.msh", packed)).quads.size(), 20u) << "by content";
}

TEST(MisnamedFiles, AreCalledByTheirFormat) {
  const Folder folder;
  const auto refuses = [&](const std::string& name, const std::string& text, const char* kind) {
    expect_input_error([&] { read_mesh(write_text(folder / name, text)); }, {name.c_str(), kind, "expected"});
  };
  const std::string step = "ISO-10303-21;\nHEADER;\n" + std::string(200, 'x');
  refuses("part.stl", step, "holds a STEP file");
  refuses("part.STL", step, "holds a STEP file");
  refuses("part.obj", step, "holds a STEP file");
  refuses("mesh.off", msh_files::kSquare41, "holds an MSH file");
  refuses("mesh.msh", "OFF\n3 1 0\n", "holds an OFF file");
  refuses("mesh.inp", "MeshVersionFormatted 2\n", "holds a Medit file");
  refuses("mesh.mesh", "*HEADING\n*NODE\n", "holds an INP file");
  refuses("mesh.stl", "PK\x03\x04 and so on", "holds a ZIP archive");
}

/// Indices of triangles that turn as the polygon does; nothing for polygons that cannot be split.
void expect_split(const std::vector<Vec3>& corners, double area) {
  const auto triangles = split_polygon(corners);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), corners.size() - 2);
  double sum = 0;
  for (const auto& [a, b, c] : *triangles) {
    const double twice = cross(corners[b] - corners[a], corners[c] - corners[a]).z;
    EXPECT_GT(twice, 0);
    sum += twice / 2;
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

TEST(Polygons, AreSplitWithoutInvertedTriangles) {
  expect_split({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}}, 10);
  expect_split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}, 4);
  // A square with a square hole, which a bridge reaches.
  expect_split({{0, 0, 0},
                {4, 0, 0},
                {4, 4, 0},
                {0, 4, 0},
                {0, 0, 0},
                {1, 1, 0},
                {1, 3, 0},
                {3, 3, 0},
                {3, 1, 0},
                {1, 1, 0}},
               12);
  std::mt19937_64 random(3);
  for (int n = 5; n < 60; ++n) {
    std::vector<Vec3> star;  // seen from the origin
    double area = 0;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * M_PI * k / n, radius = 0.05 + shapes::uniform(random);
      star.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    for (int k = 0; k < n; ++k) area += cross(star[k], star[(k + 1) % n]).z / 2;
    expect_split(star, area);
  }
  EXPECT_FALSE(split_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}})) << "no area";
}

TEST(Polygons, LastTwoTrianglesAreGood) {
  // The best ear would leave a triangle that is nearly flat.
  const auto triangles = split_polygon({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0.95, 1.05, 0}});
  ASSERT_TRUE(triangles);
  for (const auto& t : *triangles) EXPECT_TRUE(std::ranges::count(t, 1) && std::ranges::count(t, 3));
}

TEST(Polygons, AreSaidWithTheirNumber) {
  const Folder folder;
  const std::string points = "v 0 0 7\nv 2 0 7\nv 2 2 7\nv 1 3 7\nv 0 2 7\n";
  ReadNotes notes;
  const Mesh obj = read_mesh(write_text(folder / "a.OBJ", points + "g roof\nf 1 2 3 4 5\nf 1 3 2\n"), &notes);
  EXPECT_EQ(obj.triangles.size(), 4u);
  EXPECT_EQ(obj.triangle_region.size(), 4u);
  EXPECT_EQ(obj.regions[0].names, (Strings{"roof"}));
  EXPECT_EQ(notes, (ReadNotes{"1 face of more than four vertices was split into 3 triangles"}));
  const Mesh off = read_mesh(
      write_text(folder / "a.off", "OFF\n5 1 0\n0 0 1\n0 2 1\n0 2 2\n0 1 3\n0 0 2\n5 0 1 2 3 4\n"), &notes);
  EXPECT_EQ(off.triangles.size(), 3u);
  EXPECT_EQ(notes.size(), 2u);
  const Mesh bow = read_mesh(
      write_text(folder / "b.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nv 1 3 0\nf 1 2 3 4 5\n"), &notes);
  EXPECT_EQ(bow.triangles.size(), 3u);
  EXPECT_NE(notes.back().find("cross themselves or have no area (1)"), std::string::npos);
}

TEST(ObjNames, StayDifferent) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 2);
  mesh.regions = {{1, {"a b"}}, {2, {"a_b"}}};
  mesh.quad_region = {0, 1};
  write_mesh(folder / "a.obj", mesh);
  EXPECT_TRUE(holds(read_text(folder / "a.obj"), "# group a_b_2 is \"a b\"\n"));
  const Mesh back = read_mesh(folder / "a.obj");
  ASSERT_EQ(back.regions.size(), 2u);
  EXPECT_EQ(back.regions[0].names, (Strings{"a_b_2"}));
  EXPECT_EQ(back.regions[1].names, (Strings{"a_b"}));
}

TEST(Inp, ReadsWhatProgramsWrite) {
  const Folder folder;
  const Mesh mesh = read_mesh(write_text(folder / "a.inp", R"(** a comment
*Node, nset=all
 7, 0., 0.
 8, 1., 0., 0.
 9, 1., +1.
 10, 0., 1.
 11, 2., 0.
*Element, type=S4R, elset=Left
 1, 7, 8,
 9, 10
*ELEMENT,TYPE=S3
 5, 8, 11, 9
*Elset, elset=both, generate
 1, 5, 4
*Elset, elset=again
 Left, 5
*Surface, name=side, type=ELEMENT
 5, E2
*Material, name=steel
*Elastic
 2e5, .3
)"));
  EXPECT_EQ(mesh.quads, (Quads{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{1, 4, 2}}));
  ASSERT_EQ(mesh.regions.size(), 2u);
  EXPECT_EQ(mesh.regions[0].names, (Strings{"Left", "again", "both"}));
  EXPECT_EQ(mesh.regions[1].names, (Strings{"again", "both"}));
  EXPECT_EQ(mesh.lines, (Lines{{4, 2}}));
  EXPECT_EQ(mesh.curves[0].names, (Strings{"side"}));
  const auto refuses = [&](const std::string& text, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read_mesh(write_text(folder / "b.inp", text)); }, parts);
  };
  refuses("*NODE\n1, 0, x\n", {"b.inp:2: ", "'x'"});
  refuses("*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D5\n", {"b.inp:3: ", "C3D5", "S4"});
  refuses("*NODE\n1, 0, 0\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n", {"b.inp:4: ", "no node 2"});
  refuses("*NODE\n1, 0, 0\n1, 0, 0\n", {"b.inp:3: ", "node 1 is there twice"});
  refuses("*NODE\n1, 0, 0\n", {"b.inp:", "no *ELEMENT"});
  refuses("*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n2, 1, 2,\n",
          {"b.inp:", "within an element"});
}

TEST(Medit, NamesTheLineOfWhatIsWrong) {
  const Folder folder;
  const auto refuses = [&](const std::string& text, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read_mesh(write_text(folder / "b.mesh", text)); }, parts);
  };
  const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\n";
  refuses(head + "Triangles\n1\n1 1 2 0\n", {"b.mesh:8: ", "from 1 to 1"});
  refuses(head + "Tetrahedra\n1\n", {"b.mesh:6: ", "Tetrahedra"});
  refuses(head, {"b.mesh:", "no edges, triangles or quadrilaterals"});
  refuses("hello\n", {"b.mesh:1: ", "MeshVersionFormatted"});
}

TEST(Vtu, RefusesWhatIsDamaged) {
  const Folder folder;
  write_vtu(folder / "a.vtu", quad_grid(2, 2));
  const std::string whole = read_text(folder / "a.vtu");
  for (size_t n = 0; n < whole.size() - 12; n += 7)
    EXPECT_THROW(read_mesh(write_text(folder / "cut.vtu", whole.substr(0, n))), InputError) << n;
  for (size_t n = 0; n < whole.size(); n += 3) {
    std::string damaged = whole;
    damaged[n] = static_cast<char>(damaged[n] ^ 3);
    try {
      read_mesh(write_text(folder / "damaged.vtu", damaged));
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace delquad
