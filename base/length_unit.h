#pragma once

#include <string>

namespace delquad {

struct LengthUnit {
  const char* name;       ///< "mm"
  double metres;          ///< how long it is
  const char* kernel;     ///< what OpenCASCADE calls it
  const char* long_name;  ///< what STEP files call it, in capitals
};

/// Throws InputError that names those known.
const LengthUnit& length_unit(const std::string& name);

}  // namespace delquad
