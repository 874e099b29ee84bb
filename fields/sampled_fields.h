#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/warning.h"
#include "fields/fields.h"
#include "fields/sample_tree.h"

namespace delquad {

/// How far an interpolated size is off, as a part of the size: far below the spread of edge lengths in any
/// mesh.
inline constexpr double kSampledSizeError = 0.005;
/// How far cos 4 theta and sin 4 theta are off: a third of a degree.
inline constexpr double kSampledCrossError = 0.02;
/// Samples of a function lie no closer than this part of the size there: a mesh would not show more.
inline constexpr double kClosestSamples = 0.25;

/// A function as a field: it is called here, on points in and beside the domain, and linear along the axes
/// between them. Where values change within kClosestSamples of the size, and where there would be too many
/// samples (of which `warnings` then tells), it is further off than kSampledSizeError. Throws InputError when
/// none of its values is a size; a value that is none, next to the domain, does not count while others are
/// nearer. Messages call the function by `name`.
std::shared_ptr<const SizeField> sample_size(const SizeFunction& function, const SampleDomain& domain,
                                             const std::string& name, std::vector<Warning>& warnings);

/// The same of an angle, on the plane of a flat domain. `size` says how close samples lie.
std::shared_ptr<const CrossField> sample_cross(const CrossFunction& function, const SampleDomain& domain,
                                               const SizeField& size, const std::string& name,
                                               std::vector<Warning>& warnings);

}  // namespace delquad
