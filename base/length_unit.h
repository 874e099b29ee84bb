// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

// This header has units of length. Readers of CAD use it.

namespace delquad {

struct LengthUnit {
  const char* name;       ///< "mm"
  double metres;          ///< length in meters
  const char* kernel;     ///< name in OpenCASCADE
  const char* long_name;  ///< name in STEP files, in capitals
};

/// Returns the unit of a name: um, mm, cm, m, km, in or ft. Throws InputError, with these names, for another
/// one.
const LengthUnit& length_unit(const std::string& name);

}  // namespace delquad
