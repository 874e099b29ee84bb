// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "delquad/model.h"

// This header reads drawings. Readers of models use it.

namespace delquad {

/// Reads a DXF file in text [AutoCAD DXF reference, section ENTITIES]. LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE
/// with bulges, POLYLINE and SPLINE become curves of the same shape, POINT becomes a point. Layers other than
/// 0 are their names. Inserted blocks are resolved. join_outlines() makes the outlines. 3D faces make a
/// surface whose regions are the layers. Notes name curves outside of all outlines, and other entities, which
/// are left out. Throws InputError with the line, and for a drawing without outlines.
Model read_dxf(const std::filesystem::path& path);

}  // namespace delquad
