// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/tessellate.h"

#include <fmt/format.h>

#include <BRepMesh_Context.hxx>
#include <BRepMesh_FaceDiscret.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepMesh_MeshAlgoFactory.hxx>
#include <BRep_Tool.hxx>
#include <IMeshData_Face.hxx>
#include <IMeshTools_MeshAlgo.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_Triangulation.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>

#include <algorithm>
#include <utility>

#include "base/activity.h"
#include "base/context.h"
#include "base/parallel.h"
#include "geometry/cad/cad_request.h"
#include "geometry/mesh/triangle_measures.h"

namespace delquad::cad {

namespace {

/// The kernel's own algorithm for a face, which also reports the face to the run.
class WatchedAlgo : public IMeshTools_MeshAlgo {
 public:
  WatchedAlgo(Handle(IMeshTools_MeshAlgo) own, const TopTools_IndexedMapOfShape& faces, Run* run)
      : own_(own), faces_(faces), run_(run) {}

  void Perform(const IMeshData::IFaceHandle& face, const IMeshTools_Parameters& parameters,
               const Message_ProgressRange& range) override {
    const WorkerScope works(run_);
    const FaceScope face_scope(faces_.FindIndex(face->GetFace()));
    own_->Perform(face, parameters, range);
  }

 private:
  Handle(IMeshTools_MeshAlgo) own_;
  const TopTools_IndexedMapOfShape& faces_;
  Run* run_;
};

class WatchedAlgos : public IMeshTools_MeshAlgoFactory {
 public:
  explicit WatchedAlgos(const TopTools_IndexedMapOfShape& faces) : faces_(faces) {}

  Handle(IMeshTools_MeshAlgo)
      GetAlgo(const GeomAbs_SurfaceType type, const IMeshTools_Parameters& parameters) const override {
    const Handle(IMeshTools_MeshAlgo) own = kernel_.GetAlgo(type, parameters);
    return own.IsNull() ? own : Handle(IMeshTools_MeshAlgo)(new WatchedAlgo(own, faces_, run_));
  }

 private:
  BRepMesh_MeshAlgoFactory kernel_;
  const TopTools_IndexedMapOfShape& faces_;
  Run* run_ = current_run();  ///< stored, since the kernel's own threads have no run
};

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

void triangulate(const CadShape& cad, const TopTools_IndexedMapOfShape& faces, double deflection,
                 double angle) {
  const StageScope stage(kTriangulation);
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(cad.shape);
  IMeshTools_Parameters& parameters = mesher.ChangeParameters();
  parameters.Deflection = deflection;
  parameters.Angle = angle;
  // The smallest sides follow the deflection, or a small edge's own length.
  parameters.AdjustMinSize = true;
  parameters.InParallel = thread_count() > 1;
  const Handle(IMeshTools_Context) context = new BRepMesh_Context();
  context->SetFaceDiscret(new BRepMesh_FaceDiscret(new WatchedAlgos(faces)));
  mesher.Perform(context);
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
