#pragma once

#include "delquad/model.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Reads, heals and triangulates a shape in a worker process: on damaged files the kernel follows broken
/// references or runs in circles. Throws InputError and Cancelled.
CadShape prepare_shape(const CadModel& model, const CadOptions& options);

/// The same for a shape as it was made.
CadShape prepare_shape(const CadShape& shape, const CadOptions& options);

}  // namespace delquad::cad
