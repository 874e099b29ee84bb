// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include "tests/geometry/cad/cad_files.h"
#include "tests/geometry/cad/shell_joints.h"

using namespace delquad::testing_support;

/// write_shell_joints FOLDER: each as STEP, IGES and BREP; prints name, area and whether all is plane.
int main(int argc, char** argv) {
  if (argc != 2) return 1;
  const std::filesystem::path folder = argv[1];
  for (const ShellJoint& joint : shell_joints()) {
    const TopoDS_Shape shape = compound_of(joint.faces);
    write_step(folder / (joint.name + ".step"), shape);
    write_iges(folder / (joint.name + ".iges"), shape);
    write_brep(folder / (joint.name + ".brep"), shape);
    std::cout.precision(17);
    std::cout << joint.name << ' ' << joint.area << ' ' << joint.is_flat << '\n';
  }
}
