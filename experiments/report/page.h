// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "experiments/report/packed_mesh.h"
#include "experiments/report/page_json.h"

// This header has the common parts of pages. Reports and views use it. Each page is one HTML file, which
// needs no other file and no network.

namespace delquad {

void begin_page(std::ostream& out, std::string_view title, std::string_view style, std::string_view body);
/// Ends a page. `data` has the content for the script; the page adds the program that wrote it.
void end_page(std::ostream& out, Json data, bool in_space, std::string_view script);

/// Writes a packed mesh as the text of the node `id`; returns its description for `unpackMesh` of
/// page/packed_mesh.js.
Json add_picture(std::ostream& out, const std::string& id, PackedMesh packed);

}  // namespace delquad
