#pragma once

#include <string>

#include "delquad/mesh.h"

namespace delquad {

/// What messages call a region.
std::string region_label(const Entity& region);

/// Whether a region has that name, or number as in files: "region_2".
bool has_name(const Entity& region, const std::string& name);

/// What messages call a curve: its first name, or its number.
std::string curve_title(const Entity& curve);

}  // namespace delquad
