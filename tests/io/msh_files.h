// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// The unit square as two triangles and four lines, in both versions of the format.
namespace delquad::msh_files {

inline std::string begin_file(const std::string& version) {
  return "$MeshFormat\n" + version + R"( 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "wall one"
1 2 "all walls"
2 1 "plate"
$EndPhysicalNames
)";
}

inline const std::string kSquare41 = begin_file("4.1") + R"($Entities
1 2 1 0
1 0 0 0 0
7 0 0 0 1 1 0 2 1 2 2 1 -1
8 0 0 0 1 1 0 1 -2 0
3 0 0 0 1 1 0 1 1 2 7 8
$EndEntities
$Nodes
3 5 1 10
1 7 0 2
1
2
0 0 0
1 0 0
1 8 1 2
10
4
1 1 0 0.5
0 1 0 0.75
2 3 0 1
5
0.5 0.5 0
$EndNodes
$Elements
4 7 1 7
0 1 15 1
1 1
1 7 1 2
2 1 2
3 2 10
1 8 1 2
4 10 4
5 4 1
2 3 2 2
6 1 2 10
7 1 10 4
$EndElements
)";

inline const std::string kSquare22 = begin_file("2.2") + R"($Nodes
4
1 0 0 0
2 1 0 0
10 1 1 0
4 0 1 0
$EndNodes
$Elements
9
1 15 2 0 1 1
2 1 2 1 7 1 2
3 1 2 1 7 2 10
4 1 2 2 7 1 2
5 1 2 2 7 2 10
6 1 2 2 8 10 4
7 1 2 2 8 4 1
8 2 2 1 3 1 2 10
9 2 3 1 3 0 1 10 4
$EndElements
)";

/// The text with the first occurrence of `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace delquad::msh_files
