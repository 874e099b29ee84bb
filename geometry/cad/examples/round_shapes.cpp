#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

CadShape make_sphere() {
  CadShape cad;
  cad.shape = BRepPrimAPI_MakeSphere(10);
  return cad;
}

CadShape make_torus() {
  CadShape cad;
  cad.shape = BRepPrimAPI_MakeTorus(20, 8);
  return cad;
}

}  // namespace delquad::cad
