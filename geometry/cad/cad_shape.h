// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <BRep_Builder.hxx>
#include <NCollection_DataMap.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <string>
#include <vector>

#include "base/warning.h"
#include "geometry/surface/surface_model.h"

// This header has CAD shapes with the names of their parts. Geometry uses it.

namespace delquad::cad {

/// Returns a shape without its placement, which all its instances share.
inline TopoDS_Shape unplaced(const TopoDS_Shape& shape) { return shape.Located(TopLoc_Location()); }

inline Vec3 vec_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// Returns whether an edge bounds its face; other edges lie inside, or belong to the face by name only.
inline bool is_boundary(const TopoDS_Shape& edge) {
  return edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
}

/// Names of faces and edges, which all placed instances of a part share.
class PartNames {
 public:
  void add(const TopoDS_Shape& part, const std::string& name) {
    std::vector<std::string>* names = map_.ChangeSeek(unplaced(part));
    if (names == nullptr) names = map_.Bound(unplaced(part), {});
    if (std::ranges::find(*names, name) == names->end()) names->push_back(name);
  }
  void add(const TopoDS_Shape& part, const std::vector<std::string>& names) {
    for (const std::string& name : names) add(part, name);
  }
  std::vector<std::string> of(const TopoDS_Shape& part) const {
    const std::vector<std::string>* names = map_.Seek(unplaced(part));
    return names == nullptr ? std::vector<std::string>{} : *names;
  }

 private:
  NCollection_DataMap<TopoDS_Shape, std::vector<std::string>, TopTools_ShapeMapHasher> map_;
};

/// The contents of a CAD file.
struct CadShape {
  TopoDS_Shape shape;
  PartNames names = {};
  double diagonal = 0;    ///< diagonal of the bounding box
  std::string unit = {};  ///< unit of lengths; empty: unknown
  std::vector<Warning> warnings = {};
  std::vector<std::string> missing = {};  ///< parts of the file that cannot be read and are left out
  std::vector<LooseLine> loose = {};      ///< edges and vertices of the file that bound no face
  std::vector<std::string> why_not = {};  ///< reason why each face has no triangulation; usually empty
};

inline TopoDS_Compound empty_compound() {
  TopoDS_Compound compound;
  BRep_Builder().MakeCompound(compound);
  return compound;
}

/// Returns the faces, edges, vertices or solids of a shape, each once, in the kernel's order.
inline TopTools_IndexedMapOfShape parts(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map;
}

}  // namespace delquad::cad
