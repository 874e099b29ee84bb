#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <string>
#include <vector>

namespace delquad::testing_support {

/// Shells that touch or cross and share nothing, each a T, X or L joint.
struct ShellJoint {
  std::string name;
  std::vector<TopoDS_Face> faces;
  /// Pairs of faces (numbers from 1) that are joined, by one of each joint's pairs.
  std::vector<std::array<int, 2>> joined;
  double area;         ///< of all faces
  int n_glued;         ///< faces after gluing
  bool is_flat = true;  ///< all faces are plane
};

std::vector<ShellJoint> shell_joints();

/// All faces of one beside each other.
TopoDS_Shape compound_of(const std::vector<TopoDS_Face>& faces);

}  // namespace delquad::testing_support
