// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/length_unit.h"

#include <algorithm>
#include <array>

#include "delquad/error.h"

namespace delquad {

const LengthUnit& length_unit(const std::string& name) {
  static constexpr std::array<LengthUnit, 7> kUnits = {{{"um", 1e-6, "UM", "MICROMETRE"},
                                                        {"mm", 1e-3, "MM", "MILLIMETRE"},
                                                        {"cm", 1e-2, "CM", "CENTIMETRE"},
                                                        {"m", 1, "M", "METRE"},
                                                        {"km", 1e3, "KM", "KILOMETRE"},
                                                        {"in", 0.0254, "INCH", "INCH"},
                                                        {"ft", 0.3048, "FT", "FOOT"}}};
  const auto at = std::ranges::find_if(kUnits, [&](const LengthUnit& unit) { return name == unit.name; });
  if (at != kUnits.end()) return *at;
  throw InputError("unit '" + name + "': expected um, mm, cm, m, km, in or ft");
}

}  // namespace delquad
