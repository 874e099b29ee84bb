// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "metrics/judgement/element_values.h"

// This header has helpers for criteria and their tables. The pipeline, the program and the bench use it.

namespace delquad {

/// Returns the kind of a key. Throws InputError, with all known keys, for an unknown one.
CriterionKind criterion_kind(const std::string& key);

inline constexpr std::size_t kMostLimits = 64;

/// Throws InputError, with all known names, for an unknown one.
StepLength step_length_named(const std::string& name);
inline constexpr const char* kStepLengths[] = {"ls-dyna", "radioss", "abaqus"};  ///< in the order of
                                                                                 ///< StepLength

/// Returns the speed of membrane waves in a shell: sqrt(E / (rho (1 - nu^2))); 1 without a material.
double speed_of_sound(const Criteria& criteria);

/// Returns "0.33 size" or "40 degrees".
std::string text_of(const CriterionLimit& limit);

/// Returns the factor by which a value exceeds a limit; above 1 if it does.
double times_beyond(CriterionKind kind, double value, double limit);
/// Returns a function for quads with a size. It adds up the excesses over all limits without a name, as
/// logarithms; 0: the quad keeps them with a margin of 2 %. Own method.
std::function<double(const std::array<Vec3, 4>& corners, double size)> excess_of(const Criteria& criteria);
/// Returns the least length of all elements; null: none.
const CriterionLimit* least_length(const Criteria& criteria);
/// Returns the limits that stages keep: the usual ones, or stricter ones of the criteria. Lengths are
/// converted to sizes at the largest size of `points`.
QuadLimits limits_of(const Criteria& criteria, const SizeField& size, std::span<const Vec3> points);

/// Returns the requested size with its curvature, before short curves or repairs reduced it.
inline const SizeField& requested_size(const Preparation& prepared) {
  const PreparedSize& size = prepared.size;
  return size.curved ? *size.curved : size.asked ? *size.asked : *size.field;
}
/// Throws InputError for names that no curve or region of the mesh has. Also throws if the wanted size is
/// everywhere below the least length, or above the largest.
void check_criteria(const Criteria& criteria, const Mesh& mesh, const SizeField& size);

/// Returns the measures of meshes by criteria in tables: "failing", "failing_min_length", ..., "time_step".
const std::vector<Metric>& criteria_metrics();
/// Returns these measures for a report.
std::map<std::string, double> values_of(const CriteriaReport& report);

}  // namespace delquad
