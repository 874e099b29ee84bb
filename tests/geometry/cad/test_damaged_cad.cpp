// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cad/cad_files.h"
#include "tests/support/shared_data.h"

namespace delquad {
namespace {

class DamagedCad : public ::testing::Test {
 protected:
  std::string example(CadFormat format) {
    std::ostringstream text;
    write_example("thin_box", format, text);
    return text.str();
  }
  std::string iges_box() {
    return read_text(write_iges(folder_ / "box.igs", BRepPrimAPI_MakeBox(1, 2, 3).Shape()));
  }
  static std::string changed(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  /// Refused, naming `words`; what is left has `faces` where that is asked for.
  void expect_refused(const std::string& bytes, std::initializer_list<const char*> words, std::size_t faces) {
    const std::string last = std::data(words)[words.size() - 1];
    SCOPED_TRACE(last);
    const CadModel model{{}, bytes};
    expect_input_error([&] { read_cad(model); }, words);
    if (faces == 0) return;
    const SurfaceModel rest = read_cad(model, {.keep_going = true});
    EXPECT_EQ(rest.fine.regions.size(), faces);
    ASSERT_EQ(rest.left_out.size(), 1u);
    EXPECT_EQ(rest.left_out[0].face, -1);
    EXPECT_TRUE(holds(rest.left_out[0].reason, last));
  }

  TemporaryFolder folder_;
};

TEST_F(DamagedCad, StepFilesAreRefusedWithTheEntity) {
  const std::string text = example(CadFormat::kStep);
  const std::size_t faces = read_cad(CadModel{{}, text}).fine.regions.size();
  expect_refused(changed(text, "ADVANCED_FACE", "ADVANCED_FACX"), {"STEP file cannot be read", "ClosedShell"},
                 faces - 1);
  expect_refused(changed(text, "CLOSED_SHELL('',(#", "CLOSED_SHELL('',(#9"),
                 {"cannot be read", "ClosedShell", "AdvancedFace"}, faces - 1);
}

TEST_F(DamagedCad, TextOfADrawingMayBeUnreadable) {
  std::string text = read_text(write_step(folder_ / "box.step", BRepPrimAPI_MakeBox(1, 2, 3).Shape()));
  text = changed(std::move(text), "ADVANCED_BREP_SHAPE_REPRESENTATION('',(",
                 "ADVANCED_BREP_SHAPE_REPRESENTATION('',(#9000,");
  text.insert(text.rfind("ENDSEC;"),
              "#9000=TEXT_LITERAL('','note',#11,'baseline left',.RIGHT.,#9001);\n"
              "#9001=DRAUGHTING_PRE_DEFINED_TEXT_FONT('font');\n");
  EXPECT_EQ(read_cad(CadModel{{}, text}).fine.regions.size(), 6u);
}

TEST_F(DamagedCad, FilesOfPartsAreNamed) {
  expect_refused(
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'1');\nFILE_NAME('','',(''),(''),'','','');\n"
      "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n#1=DOCUMENT_TYPE('geometry');\n"
      "#2=DOCUMENT_FILE('wheel.stp','','',#1,'',$);\nENDSEC;\nEND-ISO-10303-21;\n",
      {"holds no shape", "other files (wheel.stp)"}, 0);
}

TEST_F(DamagedCad, MissingEntitiesAreNamed) {
  const std::string text = read_text(write_step(folder_ / "box.step", BRepPrimAPI_MakeBox(1, 2, 3).Shape()));
  // The number of faces that are left: shells alone do without faces.
  const std::pair<const char*, std::size_t> cases[] = {{"CARTESIAN_POINT", 0},
                                                       {"VECTOR", 0},
                                                       {"VERTEX_POINT", 0},
                                                       {"EDGE_CURVE", 0},
                                                       {"ORIENTED_EDGE", 0},
                                                       {"EDGE_LOOP", 0},
                                                       {"FACE_BOUND", 0},
                                                       {"PLANE", 0},

                                                       {"LINE", 0},
                                                       {"ADVANCED_FACE", 5},
                                                       {"CLOSED_SHELL", 0},
                                                       {"MANIFOLD_SOLID_BREP", 0}};
  for (const auto& [type, n_left] : cases) {
    const std::size_t at = text.find(std::string(" = ") + type + "("), begin = text.rfind('#', at);
    ASSERT_NE(at, std::string::npos) << type;
    const std::string number = "(Id." + text.substr(begin, at - begin) + ")";
    std::string damaged = text;
    damaged.erase(begin, text.find(';', at) + 1 - begin);
    expect_refused(damaged, {"STEP file cannot be read: #", number.c_str()}, n_left);
    if (n_left == 0)
      expect_input_error([&] { read_cad(CadModel{{}, damaged}, {.keep_going = true}); }, {number.c_str()});
  }
}

TEST_F(DamagedCad, StatementsWithoutEndsOrArgumentsAreNamed) {
  const std::string text = read_text(write_step(folder_ / "box.step", BRepPrimAPI_MakeBox(1, 2, 3).Shape()));
  const std::size_t at = text.find(" = PLANE(");
  for (const char* other : {" = PLANE,(", " = PLANE(("}) {
    std::string damaged = text;
    damaged.replace(at, 9, other);
    expect_refused(damaged, {"Line ", "export it again"}, 0);
  }
}

TEST_F(DamagedCad, NumbersThatCannotBeReadAreNamed) {
  const std::string text = read_text(write_step(folder_ / "box.step", BRepPrimAPI_MakeBox(1, 2, 3).Shape()));
  const std::size_t plane = text.find(" = PLANE("), axis = text.find("#", plane);
  const std::string placement = text.substr(axis, text.find(')', axis) - axis);
  const std::size_t at = text.find("(", text.find(placement + " = AXIS2_PLACEMENT_3D"));
  const std::size_t point = text.find('#', at);
  const std::string number = text.substr(point, text.find(',', point) - point);
  const std::string place = number + " = CARTESIAN_POINT('',(";
  expect_refused(changed(text, place, place + "2147483648-"), {number.c_str(), "not a Real"}, 0);
}

TEST_F(DamagedCad, FilesThatEndTooEarlyAreRefusedWithTheLine) {
  const std::string text = read_text(write_step(folder_ / "box.step", BRepPrimAPI_MakeBox(1, 2, 3).Shape()));
  const std::size_t last = text.rfind(" = ADVANCED_FACE(");
  for (const std::string& part : {text.substr(0, last + 4), text.substr(0, text.find("DATA;") + 9)})
    expect_refused(part, {"not a readable STEP file", "Line "}, 0);
}

TEST_F(DamagedCad, IgesFilesAreRefusedWithTheEntity) {
  const std::string text = iges_box();
  const std::size_t faces = read_cad(CadModel{{}, text}).fine.regions.size();
  ASSERT_EQ(faces, 6u);
  expect_refused(changed(text, "\n510,", "\n510,x"), {"IGES file cannot be read", "Face"}, 0);
  expect_refused(changed(text, "\n190,", "\n190,x"), {"IGES file cannot be read", "Face", "PlaneSurface"},
                 faces - 1);
}

TEST_F(DamagedCad, BrepFilesAreRefusedWithTheLine) {
  const std::string text = example(CadFormat::kBrep);
  expect_refused(changed(text, "\n1 0 0 1 0 ", "\n1 0 0 1..5 0 "),
                 {"BREP file cannot be read", "'1..5' is no number"}, 0);
  // The shell's first face stands for its last, too: the last is in the file, but part of nothing.
  const std::size_t shell = text.find("\nSh\n"), first = text.find_first_of("+-", shell);
  const std::size_t next = text.find_first_of("+-", first + 1);
  ASSERT_NE(next, std::string::npos);
  const std::string face = text.substr(first, text.find(' ', first) - first);
  std::string lost = text;
  lost.replace(next, text.find(' ', next) - next, face);
  expect_refused(lost, {"BREP file cannot be read", "faces belong to no shape"}, 0);
}

TEST_F(DamagedCad, WhatIsNoShapeMayBeMissing) {
  const std::string text = example(CadFormat::kStep);
  // No name at all.
  const SurfaceModel model = read_cad(CadModel{{}, changed(text, "ADVANCED_FACE('',", "ADVANCED_FACE($,")});
  EXPECT_TRUE(model.left_out.empty());
}

TEST_F(DamagedCad, NoTriangleIsLeft) {
  const std::filesystem::path file = shared_data("hard2/damaged_no_face.brep");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "data not found: " << file;
  expect_input_error([&] { read_cad(file, {.keep_going = true}); },
                     {file.c_str(), "nothing is left to mesh"});
}

}  // namespace
}  // namespace delquad
