// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "delquad/model.h"

// This header reads drawings. Readers of models use it.

namespace delquad {

/// Reads a drawing, a DXF file in text [AutoCAD's DXF reference, "ENTITIES section"]. LINE, ARC, CIRCLE,
/// ELLIPSE, LWPOLYLINE with bulges, POLYLINE and SPLINE become curves of the same shape, POINT points; layers
/// other than 0 are their names. Blocks stand where they are inserted. join_outlines() makes the outlines.
/// If no curves close up, the outlines of HATCH, SOLID and TRACE count. 3D faces make a surface, whose
/// regions are the layers. Notes tell of curves outside of all outlines and of other entities, which are left
/// out. `unit` is the unit of lengths in the model, as Mesh::unit. If it is empty, it becomes the unit of the
/// drawing ($INSUNITS). Throws InputError with the line, and for a drawing without outlines. If a unit is
/// asked for, a drawing without a unit is an InputError, too.
Model read_dxf(const std::filesystem::path& path, std::string& unit);

}  // namespace delquad
