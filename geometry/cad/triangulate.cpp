// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepMesh_Context.hxx>
#include <BRepMesh_FaceDiscret.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepMesh_MeshAlgoFactory.hxx>
#include <IMeshData_Face.hxx>
#include <IMeshTools_MeshAlgo.hxx>
#include <IMeshTools_Parameters.hxx>

#include "base/activity.h"
#include "base/context.h"
#include "base/parallel.h"
#include "geometry/cad/cad_request.h"
#include "geometry/cad/tessellate.h"

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

}  // namespace

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

}  // namespace delquad::cad
