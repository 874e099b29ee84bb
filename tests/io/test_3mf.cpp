// SPDX-License-Identifier: GPL-3.0-or-later
#include <zip.h>

#include "tests/io/reader_test.h"

namespace delquad {
namespace {

const std::string kTetrahedron =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" "
    "y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" "
    "v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\" pid=\"7\" "
    "p1=\"1\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh>";

std::string model(const std::string& inside, const std::string& unit = "inch") {
  return "<?xml version=\"1.0\"?>\n<model unit=\"" + unit +
         "\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n" + inside + "</model>\n";
}

class ThreeMf : public testing::Test {
 protected:
  fs::path write(const std::string& text, const char* name = "3D/3dmodel.model") {
    return write({{name, text}});
  }
  fs::path write(const std::map<std::string, std::string>& files) {
    const fs::path path = folder_ / "case.3mf";
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    for (const auto& [name, text] : files) {
      zip_source_t* source = zip_source_buffer(archive, text.data(), text.size(), 0);
      EXPECT_GE(zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE), 0);
    }
    EXPECT_EQ(zip_close(archive), 0);
    return path;
  }
  void expect_error(const std::string& text, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read_mesh(write(text)); }, parts);
  }

  Folder folder_;
};

/// One placed as it is, one mirrored and moved as a part of another: triangles keep looking outwards.
TEST_F(ThreeMf, ReadsObjectsWherePlaced) {
  const Mesh mesh = read_mesh(
      write(model("<resources><basematerials id=\"7\"><base name=\"a\" displaycolor=\"#000000\"/><base "
                  "name=\"b\" displaycolor=\"#FF8000FF\"/></basematerials><object id=\"1\" name=\"tip\">" +
                  kTetrahedron +
                  "</object><object id=\"2\" name=\"pair\"><components><component objectid=\"1\" "
                  "transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/></components></object><object id=\"3\">" +
                  kTetrahedron +
                  "</object></resources><build><item objectid=\"1\"/><item objectid=\"2\" transform=\"2 0 0 "
                  "0 2 0 0 0 2 10 20 30\"/></build>")));
  EXPECT_EQ(mesh.unit, "in");
  ASSERT_EQ(mesh.points.size(), 8u) << "objects outside of the build are left out";
  EXPECT_EQ(mesh.points[3], (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh.points[5], (Vec3{8, 20, 30}));
  EXPECT_EQ(mesh.points[7], (Vec3{10, 20, 32}));
  EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{0, 2, 1}));
  EXPECT_EQ(mesh.triangles[4], (std::array<int, 3>{4, 5, 6}));
  ASSERT_EQ(mesh.regions.size(), 2u);
  EXPECT_EQ(mesh.regions[0].names, Strings{"tip"});
  EXPECT_EQ(mesh.regions[1].names, (Strings{"tip", "colour #ff8000"}));
  EXPECT_EQ(mesh.triangle_region, (std::vector<int>{0, 0, 1, 0, 0, 0, 1, 0}));
}

/// The production extension: the build and components name objects of other files, with the same numbers.
TEST_F(ThreeMf, ObjectsMayLieInOtherFiles) {
  const auto part = [&](const char* name, const char* unit = "inch") {
    return model("<resources><object id=\"1\" name=\"" + std::string(name) + "\">" + kTetrahedron +
                     "</object><object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 "
                     "0 0 0 1 0 0 5\"/></components></object></resources><build/>",
                 unit);
  };
  const std::string main = model(
      "<resources><object id=\"1\"><components><component p:path=\"/3D/b.model\" objectid=\"1\" "
      "transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/></components></object></resources><build><item objectid=\"1\" "
      "transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/><item q:path=\"/3D/Objects/A.model\" objectid=\"2\"/></build>");
  const std::string main_name = "3D/3dmodel.model";
  const Mesh mesh =
      read_mesh(write({{main_name, main}, {"3D/b.model", part("b")}, {"3D/objects/a.model", part("a")}}));
  ASSERT_EQ(mesh.points.size(), 8u);
  EXPECT_EQ(mesh.points[0], (Vec3{20, 0, 0}));
  EXPECT_EQ(mesh.points[3], (Vec3{20, 0, 2}));
  EXPECT_EQ(mesh.points[7], (Vec3{0, 0, 6}));
  ASSERT_EQ(mesh.regions.size(), 2u);
  EXPECT_EQ(mesh.regions[0].names, Strings{"b"});
  EXPECT_EQ(mesh.regions[1].names, Strings{"a"});

  const auto refuse = [&](const std::map<std::string, std::string>& files,
                          std::initializer_list<const char*> parts) {
    expect_input_error([&] { read_mesh(write(files)); }, parts);
  };
  refuse({{main_name, main}, {"3D/b.model", part("b")}},
         {"its model, line 3", "no file '/3D/Objects/A.model'"});
  refuse({{main_name, main}, {"3D/b.model", model("<build/>")}},
         {"its model", "objectid 1", "in 3D/b.model"});
  refuse({{main_name, main}, {"3D/b.model", part("b", "foot")}},
         {"3D/b.model, line 2: ", "in ft", "one unit"});
  refuse({{main_name, main},
          {"3D/b.model", model("<build><item p:path=\"/3D/c.model\" objectid=\"1\"/></build>")}},
         {"3D/b.model, line 3: ", "main model alone"});
  refuse({{main_name, main}, {"3D/b.model", model("<mesh>")}}, {"3D/b.model, line ", "mismatched"});
}

TEST_F(ThreeMf, NamesThePlaceOfWhatIsWrong) {
  const std::string build = "<build><item objectid=\"1\"/></build>";
  const auto object = [&](const std::string& mesh) {
    return model("<resources>\n<object id=\"1\">\n" + mesh + "</object></resources>" + build);
  };
  EXPECT_EQ(read_mesh(write(object(kTetrahedron))).triangles.size(), 4u);
  expect_error(object("<mesh>"), {"case.3mf: its model, line 5", "mismatched"});
  expect_error(model(build), {"line 3: ", "objectid 1", "no such object"});
  expect_error(model("", "parsec"), {"line 2: ", "unit 'parsec'"});
  expect_error(model("<resources><object id=\"1\"/></resources>" + build), {"no triangles"});
  expect_error(object("<components><component objectid=\"1\"/></components>"), {"line 5", "holds itself"});
  expect_error(object("<mesh><vertices><vertex x=\"1\" y=\"2\"/></vertices></mesh>"), {"line 5", "'z'"});
  expect_error(object("<mesh><vertices><vertex x=\"1\" y=\"2\" z=\"inf\"/></vertices></mesh>"),
               {"z: ", "'inf'"});
  expect_error(object("<mesh><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>"),
               {"v1: expected a vertex below 0"});
  expect_input_error([&] { read_mesh(write("text", "notes.txt")); }, {"case.3mf: ", "without a model"});
  expect_input_error([&] { read_mesh(write_text(folder_ / "case.3mf", "solid x")); },
                     {"case.3mf: ", "ZIP archive"});
}

/// Thirty objects of which each holds the one before twice ask for a thousand million.
TEST_F(ThreeMf, ObjectsThatMultiplyAreRefused) {
  std::string text = "<resources><object id=\"0\">" + kTetrahedron + "</object>";
  for (int i = 1; i <= 30; ++i) {
    const std::string part = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    text += "<object id=\"" + std::to_string(i) + "\"><components>" + part + part + "</components></object>";
  }
  expect_error(model(text + "</resources><build><item objectid=\"30\"/></build>"),
               {"case.3mf: ", "more than"});
}

TEST_F(ThreeMf, DamageIsReadOrRefused) {
  const std::string whole =
      read_text(write(model("<resources><object id=\"1\">" + kTetrahedron +
                            "</object></resources><build><item objectid=\"1\"/></build>")));
  std::mt19937 random(7);
  int refused = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::string text = whole.substr(0, trial % 5 == 0 ? random() % whole.size() : whole.size());
    if (!text.empty()) text[random() % text.size()] ^= static_cast<char>(1u << random() % 8);
    try {
      read_mesh(write_text(folder_ / "damaged.3mf", text));
    } catch (const InputError& error) {
      EXPECT_TRUE(holds(error.what(), "damaged.3mf:"));
      ++refused;
    }
  }
  EXPECT_GT(refused, 250);
}

}  // namespace
}  // namespace delquad
