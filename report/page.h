#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"
#include "report/page_json.h"

// What pages have in common: each is one HTML file, which needs no other and no network.

namespace delquad {

/// Of all pictures of a page together.
inline constexpr double kPictureBytes = 17e6;

void begin_page(std::ostream& out, std::string_view title, std::string_view style, std::string_view body);
/// `data`: what the script shows; the page adds which program wrote it.
void end_page(std::ostream& out, Json data, bool in_space, std::string_view script);

struct PictureOptions {
  std::vector<std::size_t> failing = {};  ///< quads with a colour of their own
  bool with_entities = false;             ///< what belongs to which region and curve, too
};
/// Writes a packed mesh, some of its elements where all take more than `most` bytes, as the text of the node
/// `id`; returns what `unpackMesh` of page/packed_mesh.js wants to know, and the text's `bytes`.
Json add_picture(std::ostream& out, const std::string& id, const Mesh& mesh, double most,
                 const PictureOptions& options = {});

}  // namespace delquad
