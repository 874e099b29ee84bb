// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <vector>

// This header divides CAD edges into chords. Triangulations of faces use it.

namespace delquad::cad {

/// The parameters at which edges are cut into chords. They are from existing triangulations of faces, or else
/// by `deflection` (a length) and `angle` (radians), both > 0. All faces and instances of an edge share them.
class EdgeChords {
 public:
  EdgeChords(const TopoDS_Shape& shape, double deflection, double angle);

  /// Returns the parameters of an edge, ascending, at least two.
  const std::vector<double>& of(const TopoDS_Edge& edge);
  /// Halves the chord between the parameters k and k + 1. Returns false if no number lies between them, or no
  /// point is allowed there.
  bool halve(const TopoDS_Edge& edge, int k);
  /// Moves points of an edge, so that none between its ends lies within the tolerances of both edge and end.
  /// The kernel does not tell such points from the end. Small closed edges stay.
  void keep_off_ends(const TopoDS_Edge& edge);
  /// Returns the faces, without placement, that an edge bounds.
  const TopTools_ListOfShape& faces_of(const TopoDS_Edge& edge) const;

 private:
  int number(const TopoDS_Edge& edge) const;

  TopTools_IndexedDataMapOfShapeListOfShape faces_of_;  ///< by edge, neither placed
  std::vector<std::vector<double>> parameters_;         ///< parameters by edge; empty: not computed yet
  std::vector<char> keeps_off_;                         ///< edges with no points near their ends
  double deflection_, angle_;
};

}  // namespace delquad::cad
