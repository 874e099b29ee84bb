#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

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

/// n faces around one edge.
std::vector<TopoDS_Face> star_of_faces(int n);

/// A plate, and a face that touches it with one corner.
std::vector<TopoDS_Face> tip_on_a_plate();

/// Pairs that are nearer to each other than their triangulations are to them, or lie in one plane.
std::vector<std::vector<TopoDS_Face>> faces_apart();

/// All faces of one beside each other.
TopoDS_Shape compound_of(const std::vector<TopoDS_Face>& faces);

}  // namespace delquad::testing_support
