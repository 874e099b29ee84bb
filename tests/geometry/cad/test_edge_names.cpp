// SPDX-License-Identifier: GPL-3.0-or-later
#include <gp_Pnt.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// The text of a STEP file in which the edges with these numbers (in the file's order, from 0) have names.
std::string with_names(const std::string& text, const std::map<int, std::string>& names) {
  const std::string edge = "EDGE_CURVE('";
  std::string result;
  std::size_t from = 0;
  for (int n = 0;; ++n) {
    const std::size_t at = text.find(edge, from);
    if (at == std::string::npos) return result + text.substr(from);
    const std::size_t begin = at + edge.size(), end = text.find('\'', begin);
    const auto name = names.find(n);
    result += text.substr(from, begin - from) + (name == names.end() ? "" : name->second);
    from = end;
  }
}

std::map<std::string, int> curve_names(const Mesh& mesh) {
  std::map<std::string, int> count;
  for (const Entity& curve : mesh.curves)
    for (const std::string& name : curve.names) ++count[name];
  return count;
}

TEST(EdgeNames, OfStepFilesAreNamesOfCurves) {
  const TemporaryFolder folder;
  const std::string text = read_text(write_step(folder / "box.step", BRepPrimAPI_MakeBox(2, 3, 4).Shape()));
  write_text(folder / "named.step",
             with_names(text, {{0, "rim"}, {3, "rim"}, {5, "slot edge"}, {6, "NONE"}}));
  const SurfaceModel model = read_cad(folder / "named.step");
  EXPECT_EQ(model.fine.curves.size(), 12u);
  EXPECT_EQ(curve_names(model.fine), (std::map<std::string, int>{{"rim", 2}, {"slot edge", 1}}));
  EXPECT_TRUE(curve_names(read_cad(folder / "box.step").fine).empty());
}

TEST(EdgeNames, GoWithTheEdgesOfBodiesThatAreGlued) {
  const TemporaryFolder folder;
  const TopoDS_Shape both =
      compound_of({BRepPrimAPI_MakeBox(2, 3, 4), BRepPrimAPI_MakeBox(gp_Pnt(2, 0, 0), 2, 3, 4)});
  std::map<int, std::string> all;
  for (int e = 0; e < 24; ++e) all[e] = "edge " + std::to_string(e);
  write_text(folder / "named.step", with_names(read_text(write_step(folder / "boxes.step", both)), all));
  CadOptions options;
  options.glue = true;
  const SurfaceModel model = read_cad(folder / "named.step", options);
  EXPECT_EQ(model.fine.curves.size(), 20u);
  const auto names = curve_names(model.fine);
  EXPECT_EQ(names.size(), 24u);
  EXPECT_TRUE(std::ranges::all_of(names, [](const auto& name) { return name.second == 1; }));
}

}  // namespace
}  // namespace delquad
