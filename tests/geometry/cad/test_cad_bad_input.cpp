// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAlgoAPI_Fuse.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

class CadBadInput : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(CadBadInput, NoFileOrNoneOfItsKind) {
  expect_input_error([&] { read_cad(folder_ / "none.step"); }, {"none.step", "cannot be read: No such file"});
  expect_input_error([&] { read_cad(folder_.path()); }, {"a folder"});
  expect_input_error([&] { read_cad(write_text(folder_ / "a.step", "")); }, {"a.step", "neither STEP"});
  expect_input_error([&] { read_cad(write_text(folder_ / "a.brep", "solid cube\n")); }, {"nor BREP"});
}

TEST_F(CadBadInput, GarbageBehindTheFirstLine) {
  const std::string garbage = "\n\x01\xff 17 #= (;\n";
  expect_input_error([&] { read_cad(write_text(folder_ / "a.step", "ISO-10303-21;" + garbage)); },
                     {"a.step", "not a readable STEP file", "Line 3"});
  expect_input_error(
      [&] {
        read_cad(write_text(folder_ / "a.brep", "CASCADE Topology V1, (c) Matra-Datavision" + garbage));
      },
      {"a.brep", "not a readable BREP file"});
}

using CadBadInputLong = CadBadInput;

TEST_F(CadBadInputLong, FilesCutOffAnywhere) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeTorus(5, 2);
  for (const auto& path : {write_step(folder_ / "a.step", shape), write_brep(folder_ / "a.brep", shape)}) {
    const std::string text = read_text(path);
    constexpr std::size_t kCuts = 40;
    for (std::size_t i = 1; i < kCuts; ++i) {
      SCOPED_TRACE(i);
      write_text(path, text.substr(0, text.size() * i / kCuts));
      expect_input_error([&] { read_cad(path); }, {path.c_str()});
    }
  }
}

/// A file with a few characters changed is read or refused; it never brings the program down.
TEST_F(CadBadInput, DamagedFilesAreReadOrRefused) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeBox(2, 3, 4);
  for (const auto& path : {write_step(folder_ / "a.step", shape), write_brep(folder_ / "a.brep", shape)}) {
    const std::string text = read_text(path);
    int refused = 0;
    constexpr unsigned kFiles = 60;
    for (unsigned seed = 0; seed < kFiles; ++seed) {
      std::mt19937 random(seed);
      const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
      std::string damaged = text;
      if (seed % 3 == 0) damaged[below(text.size())] = static_cast<char>('0' + below(10));
      if (seed % 3 == 1) damaged.erase(below(text.size()), below(100));
      if (seed % 3 == 2) damaged.insert(below(text.size()), text.substr(below(text.size()), below(100)));
      try {
        read_cad(write_text(path, damaged));
      } catch (const InputError& error) {
        ++refused;
        EXPECT_EQ(std::string(error.what()).rfind(path.string(), 0), 0u) << error.what();
      }
    }
    EXPECT_GT(refused, 0);
  }
}

TEST_F(CadBadInput, NoFace) {
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0));
  expect_input_error([&] { read_shape(edge); }, {"a.brep", "the model holds no face"});
}

TEST_F(CadBadInput, EndlessFace) {
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln());
  expect_input_error([&] { read_shape(face); }, {"face 1 has no boundary and its surface is infinite"});
}

TEST_F(CadBadInput, FaceWithoutArea) {
  BRepBuilderAPI_MakePolygon wire(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0), gp_Pnt(2, 1e-13, 0), true);
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(), wire.Wire());
  expect_input_error([&] { read_shape(face); }, {"a.brep", "face 1"});
}

TEST_F(CadBadInput, BoundaryThatCrossesItselfIsCutAtTheCrossing) {
  BRepBuilderAPI_MakePolygon wire(gp_Pnt(0, 0, 0), gp_Pnt(1, 1, 0), gp_Pnt(1, 0, 0), gp_Pnt(0, 1, 0), true);
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(), wire.Wire());
  const SurfaceModel model = read_shape(face);
  EXPECT_EQ(model.fine.regions.size(), 2u);
  EXPECT_NEAR(count(model.fine).area, 0.5, 1e-12);
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_EQ(model.warnings[0].text, "the shape was invalid and has been healed [healed-shape]");
}

TEST_F(CadBadInput, FaceThatNoFinenessHelps) {
  // The torus touches the bottom of the box where its side cuts it: edges of that side lie on each other. The
  // torus would have half a million triangles were they made finer and finer for its sake.
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-1, -1, -0.5), 2, 2, 1);
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(gp_Ax2({-0.75, 0.75, -0.25}, {0, 0, 1}), 0.75, 0.25);
  const auto file = write_brep(folder_ / "a.brep", BRepAlgoAPI_Fuse(box, torus).Shape());
  expect_input_error(
      [&] { read_cad(file); },
      {"a.brep", "cannot be triangulated: its boundary crosses or touches itself near (", "): face"});
  const SurfaceModel others = read_cad(file, {.keep_going = true});
  ASSERT_FALSE(others.left_out.empty());
  for (const auto& [face, reason] : others.left_out) {
    EXPECT_EQ(std::ranges::count(others.fine.triangle_region, face), 0);
    EXPECT_TRUE(holds(reason, std::to_string(face + 1)));
  }
}

}  // namespace
}  // namespace delquad
