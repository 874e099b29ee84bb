// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>

#include "geometry/cad/cad_reader.h"
#include "geometry/cad/example_models.h"
#include "tests/geometry/cad/surface_counts.h"

namespace delquad::testing_support {

template <class Shape = TopoDS_Shape>
TopoDS_Shape compound_of(const std::vector<Shape>& some) {
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  for (const Shape& shape : some) builder.Add(all, shape);
  return all;
}

/// Straight edges from corner to corner, closed.
inline TopoDS_Wire wire_of(const std::vector<gp_Pnt>& corners) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& p : corners) wire.Add(p);
  wire.Close();
  return wire.Wire();
}

inline std::vector<TopoDS_Shape> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) faces.push_back(face.Current());
  return faces;
}

/// Writes a shape (STEP: in millimeters; IGES: in inches); all return the path.
std::filesystem::path write_brep(const std::filesystem::path& path, const TopoDS_Shape& shape);
std::filesystem::path write_step(const std::filesystem::path& path, const TopoDS_Shape& shape);

std::filesystem::path write_iges(const std::filesystem::path& path, const TopoDS_Shape& shape);

/// The shape as it is read from a file "a.brep".
inline SurfaceModel read_shape(const TopoDS_Shape& shape, const CadOptions& options = {}) {
  const TemporaryFolder folder;
  return read_cad(write_brep(folder / "a.brep", shape), options);
}

}  // namespace delquad::testing_support
