#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace delquad::testing_support {

inline ProgramResult delquad(std::vector<std::string> arguments) {
  return run_program(DELQUAD_PROGRAM, {std::move(arguments), 0, {}});
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A unit square whose sides are called bottom, right, top and left.
inline const std::string kSquare =
    "loop = { rectangle = [[0, 0], [1, 1]], boundary = [\"bottom\", \"right\", \"top\", \"left\"], region = "
    "\"square\" }\n";

/// The same, with more loops to follow.
inline const std::string kSquareLoop =
    "[[loop]]\nrectangle = [[0, 0], [1, 1]]\nboundary = [\"bottom\", \"right\", \"top\", \"left\"]\n"
    "region = \"square\"\n";

/// MSH 2.2 of one closed polygon of lines through these nodes, all on a curve of this name.
inline std::string line_mesh(const std::vector<std::pair<double, double>>& nodes, const std::string& name) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"" + name +
                     "\"\n$EndPhysicalNames\n$Nodes\n" + std::to_string(nodes.size()) + "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    text += std::to_string(i + 1) + " " + std::to_string(nodes[i].first) + " " +
            std::to_string(nodes[i].second) + " 0\n";
  text += "$EndNodes\n$Elements\n" + std::to_string(nodes.size()) + "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    text += std::to_string(i + 1) + " 1 2 7 3 " + std::to_string(i + 1) + " " +
            std::to_string((i + 1) % nodes.size() + 1) + "\n";
  return text + "$EndElements\n";
}

}  // namespace delquad::testing_support
