#include "geometry/cad/face_mesher.h"

#include <BRepMesh_Context.hxx>
#include <BRepMesh_FaceDiscret.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepMesh_MeshAlgoFactory.hxx>
#include <IMeshData_Face.hxx>
#include <IMeshTools_MeshAlgo.hxx>
#include <algorithm>

#include "base/activity.h"
#include "base/context.h"

namespace delquad::cad {

namespace {

/// The kernel's own algorithm for a face, with what is said and left out around it.
class ToldAlgo : public IMeshTools_MeshAlgo {
 public:
  ToldAlgo(Handle(IMeshTools_MeshAlgo) own, const TopTools_IndexedMapOfShape& faces,
           const std::vector<int>& skipped, Run* run)
      : own_(own), faces_(faces), skipped_(skipped), run_(run) {}

  void Perform(const IMeshData::IFaceHandle& face, const IMeshTools_Parameters& parameters,
               const Message_ProgressRange& range) override {
    const int number = faces_.FindIndex(face->GetFace());
    if (std::ranges::binary_search(skipped_, number)) {
      face->SetStatus(IMeshData_Failure);
      return;
    }
    const WorksFor works(run_);
    const DoingFace told(number);
    own_->Perform(face, parameters, range);
  }

 private:
  Handle(IMeshTools_MeshAlgo) own_;
  const TopTools_IndexedMapOfShape& faces_;
  const std::vector<int>& skipped_;
  Run* run_;
};

class ToldAlgos : public IMeshTools_MeshAlgoFactory {
 public:
  ToldAlgos(const TopTools_IndexedMapOfShape& faces, const std::vector<int>& skipped)
      : faces_(faces), skipped_(skipped) {}

  Handle(IMeshTools_MeshAlgo)
      GetAlgo(const GeomAbs_SurfaceType type, const IMeshTools_Parameters& parameters) const override {
    const Handle(IMeshTools_MeshAlgo) own = kernel_.GetAlgo(type, parameters);
    return own.IsNull() ? own : Handle(IMeshTools_MeshAlgo)(new ToldAlgo(own, faces_, skipped_, run_));
  }

 private:
  BRepMesh_MeshAlgoFactory kernel_;
  const TopTools_IndexedMapOfShape& faces_;
  const std::vector<int>& skipped_;
  Run* run_ = current_run();  ///< the kernel's own threads, which ask for algorithms, know of none
};

}  // namespace

void mesh_faces(const TopoDS_Shape& shape, const TopTools_IndexedMapOfShape& faces,
                const IMeshTools_Parameters& parameters, const std::vector<int>& skipped) {
  const Handle(IMeshTools_Context) context = new BRepMesh_Context();
  context->SetFaceDiscret(new BRepMesh_FaceDiscret(new ToldAlgos(faces, skipped)));
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(shape);
  mesher.ChangeParameters() = parameters;
  mesher.Perform(context);
}

}  // namespace delquad::cad
