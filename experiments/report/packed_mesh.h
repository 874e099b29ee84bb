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

/// A mesh as `unpackMesh` of page/packed_mesh.js takes it apart.
///
/// packed_text() makes the text, from numbers of 32 bits. The first are x, y and z of the points as float,
/// less the `origin`. Whole numbers follow: vertices of triangles and quads, and eta of quads, or the
/// scaled Jacobian of hexahedra at them, in 128ths (128: it fails). Then come the ends of lines, irregular
/// vertices (number and valence), and pairs of them. With entities the last are the regions of triangles and
/// quads and the curves of lines, by index. A curved quad is a polygon: `order` nodes for each side. A curved
/// line has as many pieces.
struct PackedMesh {
  Json info;  ///< how many there are of each
  std::string text;
};

/// Packs a mesh. `failing`: quads that get a color of their own.
PackedMesh pack_mesh(const Mesh& mesh, const std::vector<std::size_t>& failing = {},
                     bool with_entities = false);

/// Returns base64 of the zlib-compressed bytes, as `inflate` of page/packed_mesh.js takes it apart.
std::string packed_text(std::string_view bytes);

}  // namespace delquad
