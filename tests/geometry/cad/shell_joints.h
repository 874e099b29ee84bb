// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad::testing_support {

/// Shells that touch or cross and share nothing: T, X and L joints.
struct ShellJoint {
  std::string name;
  std::vector<TopoDS_Face> faces;
  double area;   ///< of all that is there after gluing
  int n_glued;   ///< faces after gluing
  bool is_flat;  ///< all faces are plane
};

std::vector<ShellJoint> shell_joints();

/// Bodies or faces that touch at one point alone.
struct PointContact {
  std::string name;
  std::vector<TopoDS_Shape> bodies;
  Vec3 at;
};

std::vector<PointContact> point_contacts();

/// Faces some of which lie on others, up to their edges.
struct DoubleFaces {
  std::string name;
  std::vector<TopoDS_Face> faces;
  int n_others;  ///< faces without those that lie on others
  double area;   ///< of these
};

std::vector<DoubleFaces> double_faces();

/// n faces around one edge.
std::vector<TopoDS_Face> star_of_faces(int n);

/// A plate, and a face that touches it with one corner.
std::vector<TopoDS_Face> tip_on_a_plate();

/// An angle of two plates, and a gusset that hangs on one of them. It stands on the other with an edge that
/// begins at a corner of all three.
std::vector<TopoDS_Face> gusset_from_a_corner();

/// Pairs that are nearer to each other than their triangulations are to them, or lie in one plane.
std::vector<std::vector<TopoDS_Face>> faces_apart();

}  // namespace delquad::testing_support
