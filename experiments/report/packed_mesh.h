// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"
#include "experiments/report/page_json.h"

// This header packs meshes for pages. The report and the viewer use it.

namespace delquad {

/// A mesh for `unpackMesh` of page/packed_mesh.js.
///
/// packed_text() makes the text, from numbers of 32 bits. The first are x, y and z of the points as float,
/// less the `origin`. Integers follow: vertices of triangles and quads, and eta of quads in 128ths (128: it
/// fails). Then come the ends of lines, irregular vertices (number and valence), and pairs of them. With
/// entities the last are the regions of triangles and quads and the curves of lines, by index. A curved quad
/// is a polygon: `order` nodes for each side. A curved line has `order` pieces.
/// With entities a mesh of cells has the faces between them, too, in a further region. The cells of each face
/// follow, two numbers, where the number of all cells stands for none. At the end are place, shape (0:
/// hexahedron to 3: tetrahedron) and scaled Jacobian, in 128ths, of all cells.
struct PackedMesh {
  Json info;  ///< numbers of each item
  std::string text;
};

/// Returns a packed mesh; quads in `failing` get another color.
PackedMesh pack_mesh(const Mesh& mesh, const std::vector<std::size_t>& failing = {},
                     bool with_entities = false);

/// Returns base64 of the zlib-compressed bytes, for `inflate` of page/packed_mesh.js.
std::string packed_text(std::string_view bytes);

}  // namespace delquad
