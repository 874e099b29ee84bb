// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/tessellate.h"

#include <fmt/format.h>

#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopoDS.hxx>
#include <utility>

#include "geometry/mesh/triangle_measures.h"

namespace delquad::cad {

namespace {

/// Area of a face that counts as none, over the square of the diagonal.
constexpr double kNoArea = 1e-14;

FaceMesh take_triangulation(const TopoDS_Face& face) {
  FaceMesh mesh;
  mesh.face = face;
  TopLoc_Location place;
  const Handle(Poly_Triangulation)& triangulation = BRep_Tool::Triangulation(face, place);
  if (triangulation.IsNull() || !triangulation->HasUVNodes()) return mesh;
  const gp_Trsf placed = place.Transformation();
  for (int i = 1; i <= triangulation->NbNodes(); ++i) {
    const gp_Pnt2d uv = triangulation->UVNode(i);
    mesh.points.push_back(vec_of(triangulation->Node(i).Transformed(placed)));
    mesh.uv.push_back({uv.X(), uv.Y()});
  }
  mesh.is_reversed = (face.Orientation() == TopAbs_REVERSED) != placed.IsNegative();
  for (int t = 1; t <= triangulation->NbTriangles(); ++t) {
    int a, b, c;
    triangulation->Triangle(t).Get(a, b, c);
    if (mesh.is_reversed) std::swap(b, c);
    mesh.triangles.push_back({a - 1, b - 1, c - 1});
  }
  return mesh;
}

double area(const FaceMesh& mesh) {
  double sum = 0;
  for (const auto& v : mesh.triangles) sum += norm(area_vector(mesh.points, v)) / 2;
  return sum;
}

}  // namespace

std::string face_title(int number, const std::vector<std::string>& names) {
  return names.empty() ? fmt::format("face {}", number) : fmt::format("face {} ({})", number, names.front());
}

std::vector<FaceMesh> face_meshes(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                                  std::vector<std::string>& why_not) {
  std::vector<FaceMesh> meshes;
  why_not.assign(static_cast<std::size_t>(faces.Extent()), "");
  for (int f = 1; f <= faces.Extent(); ++f) {
    FaceMesh mesh = take_triangulation(TopoDS::Face(faces(f)));
    std::string& reason = why_not[static_cast<std::size_t>(f) - 1];
    if (mesh.triangles.empty())
      reason = "cannot be triangulated";
    else if (!(area(mesh) > kNoArea * cad.diagonal * cad.diagonal))
      reason = "without area";
    if (!reason.empty() && !cad.why_not.empty() && !cad.why_not[static_cast<std::size_t>(f) - 1].empty())
      reason += ": " + cad.why_not[static_cast<std::size_t>(f) - 1];
    if (!reason.empty()) mesh.triangles.clear();
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace delquad::cad
