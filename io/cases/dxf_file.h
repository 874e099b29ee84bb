#pragma once

#include <filesystem>

#include "delquad/model.h"

namespace delquad {

/// The drawing of a DXF file in text [AutoCAD's DXF reference, "ENTITIES section"]: LINE, ARC, CIRCLE,
/// ELLIPSE, LWPOLYLINE with bulges, POLYLINE and SPLINE become curves of the same shape, POINT points; what
/// lies on a layer has its name, but on layer 0. Ends nearer than a hundred-thousandth of the drawing's
/// diagonal are joined. Curves that close up are loops, others stand in the regions. Texts, dimensions and
/// hatches are left out. Throws InputError with the line for blocks that were not exploded, and where more
/// than two outlines meet.
PlanarModel read_dxf(const std::filesystem::path& path);

}  // namespace delquad
