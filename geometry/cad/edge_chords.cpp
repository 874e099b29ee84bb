// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/edge_chords.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

namespace {

/// Number of chords of a degenerate edge, in the parameter plane only. Number of points of a closed edge,
/// which must enclose an area.
constexpr int kDegenerateChords = 12, kClosedPoints = 5;

/// Returns the parameters of the edge in an existing triangulation; empty: none.
std::vector<double> known_parameters(const TopoDS_Edge& edge) {
  Handle(Poly_PolygonOnTriangulation) polygon;
  Handle(Poly_Triangulation) triangulation;
  TopLoc_Location place;
  BRep_Tool::PolygonOnTriangulation(edge, polygon, triangulation, place);
  std::vector<double> parameters;
  if (polygon.IsNull() || !polygon->HasParameters()) return parameters;
  for (int k = 1; k <= polygon->NbNodes(); ++k) parameters.push_back(polygon->Parameters()->Value(k));
  return parameters;
}

std::vector<double> evenly(double first, double last, int n_chords) {
  std::vector<double> parameters;
  for (int k = 0; k <= n_chords; ++k) parameters.push_back(first + (last - first) * k / n_chords);
  return parameters;
}

std::vector<double> new_parameters(const TopoDS_Edge& edge, double deflection, double angle) {
  double first, last;
  BRep_Tool::Range(edge, first, last);
  if (BRep_Tool::Degenerated(edge)) return evenly(first, last, kDegenerateChords);
  const bool is_closed = TopExp::FirstVertex(edge).IsSame(TopExp::LastVertex(edge));
  const GCPnts_TangentialDeflection points(BRepAdaptor_Curve(edge), first, last, angle, deflection,
                                           is_closed ? kClosedPoints : 2);
  std::vector<double> parameters;
  for (int k = 1; k <= points.NbPoints(); ++k) parameters.push_back(points.Parameter(k));
  if (parameters.size() < 2) return evenly(first, last, is_closed ? kClosedPoints - 1 : 1);
  parameters.front() = first;
  parameters.back() = last;
  return parameters;
}

bool is_at_end(const TopoDS_Edge& edge, double t) {
  const gp_Pnt at = BRepAdaptor_Curve(edge).Value(t);
  for (const TopoDS_Vertex& end : {TopExp::FirstVertex(edge), TopExp::LastVertex(edge)})
    if (at.Distance(BRep_Tool::Pnt(end)) <= BRep_Tool::Tolerance(end) + BRep_Tool::Tolerance(edge))
      return true;
  return false;
}

}  // namespace

EdgeChords::EdgeChords(const TopoDS_Shape& shape, double deflection, double angle)
    : deflection_(deflection), angle_(angle) {
  TopTools_IndexedMapOfShape faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    faces.Add(unplaced(face.Current()).Oriented(TopAbs_FORWARD));
  for (int f = 1; f <= faces.Extent(); ++f) {
    const TopTools_IndexedMapOfShape edges = parts(faces(f), TopAbs_EDGE);
    for (int e = 1; e <= edges.Extent(); ++e) {
      const TopoDS_Shape edge = unplaced(edges(e));
      if (!faces_of_.Contains(edge)) faces_of_.Add(edge, {});
      faces_of_.ChangeFromKey(edge).Append(faces(f));
    }
  }
  parameters_.resize(static_cast<std::size_t>(faces_of_.Extent()));
  keeps_off_.resize(parameters_.size(), 0);
}

int EdgeChords::number(const TopoDS_Edge& edge) const { return faces_of_.FindIndex(unplaced(edge)) - 1; }

const TopTools_ListOfShape& EdgeChords::faces_of(const TopoDS_Edge& edge) const {
  return faces_of_(number(edge) + 1);
}

const std::vector<double>& EdgeChords::of(const TopoDS_Edge& edge) {
  std::vector<double>& parameters = parameters_[number(edge)];
  const TopoDS_Edge plain = TopoDS::Edge(unplaced(edge).Oriented(TopAbs_FORWARD));
  if (parameters.empty()) parameters = known_parameters(plain);
  if (parameters.size() < 2) parameters = new_parameters(plain, deflection_, angle_);
  return parameters;
}

bool EdgeChords::halve(const TopoDS_Edge& edge, int k) {
  std::vector<double>& parameters = parameters_[number(edge)];
  const double middle = 0.5 * (parameters[k] + parameters[k + 1]);
  if (!(parameters[k] < middle && middle < parameters[k + 1])) return false;
  if (keeps_off_[number(edge)] != 0 && is_at_end(edge, middle)) return false;
  parameters.insert(parameters.begin() + k + 1, middle);
  return true;
}

void EdgeChords::keep_off_ends(const TopoDS_Edge& edge) {
  if (BRep_Tool::Degenerated(edge)) return;
  std::vector<double> left = of(edge);
  const auto is_dropped = [&](double t) {
    return t != left.front() && t != left.back() && is_at_end(edge, t);
  };
  left.erase(std::remove_if(left.begin() + 1, left.end() - 1, is_dropped), left.end() - 1);
  const bool is_closed = TopExp::FirstVertex(edge).IsSame(TopExp::LastVertex(edge));
  if (is_closed && std::ssize(left) < kClosedPoints) return;
  keeps_off_[number(edge)] = 1;
  parameters_[number(edge)] = std::move(left);
}

}  // namespace delquad::cad
