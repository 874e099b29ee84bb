#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

constexpr double kPipeLength = 120, kRadius = 20;         // of the pipe along x
constexpr double kBranchHeight = 60, kBranchRadius = 15;  // of the branch along z

}  // namespace

CadShape make_pipe_tee() {
  // The third direction puts each pipe's seam away from the curve where they meet.
  const gp_Ax2 along({-kPipeLength / 2, 0, 0}, {1, 0, 0}, {0, 0, -1}), up({0, 0, 0}, {0, 0, 1}, {0, 1, 0});
  const TopoDS_Shape solid = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(along, kRadius, kPipeLength),
                                              BRepPrimAPI_MakeCylinder(up, kBranchRadius, kBranchHeight));
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  CadShape cad;
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next()) {
    const BRepAdaptor_Surface surface(TopoDS::Face(face.Current()));
    if (surface.GetType() != GeomAbs_Cylinder) continue;  // the lid of an end
    builder.Add(shell, face.Current());
    cad.names.add(face.Current(), surface.Cylinder().Radius() < kRadius ? "branch" : "pipe");
  }
  cad.shape = shell;
  return cad;
}

}  // namespace delquad::cad
