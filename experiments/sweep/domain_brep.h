// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "delquad/mesher.h"

// This header writes planar domains as CAD files. Peers that read CAD use it.

namespace delquad {

/// Writes the regions of a planar domain as a BREP file. Each domain_curves() is one edge: a line, an arc of
/// a circle, or cubics within 1e-9 of its extent. Curves and points inside of a region lie in its face.
/// Throws InputError if the file cannot be written.
void write_domain_brep(const std::filesystem::path& file, const Prepared& prepared);

}  // namespace delquad
