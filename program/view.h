// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "experiments/report/write_view.h"

// This header shows meshes as pages. `view` and `mesh --view` use it.

namespace delquad {

/// Returns the file of the page of a mesh: `page`, or beside the mesh if that is empty.
std::filesystem::path page_of(const std::filesystem::path& mesh, const std::filesystem::path& page = {});

/// Writes the page of a mesh, prints its name, and opens it in a browser if there is a display. Throws
/// InputError as write_view().
void view(const std::filesystem::path& page, const Mesh& mesh, const std::string& title,
          const ViewNotes& notes);

}  // namespace delquad
