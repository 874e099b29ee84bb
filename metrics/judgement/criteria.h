// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "metrics/judgement/element_values.h"

// This header has helpers for criteria and their tables. The pipeline, the program and the bench use it.

namespace delquad {

/// Returns the kind of a key. Throws InputError, with all known keys, for an unknown one.
CriterionKind criterion_kind(const std::string& key);

inline constexpr std::size_t kMostLimits = 64;

StepLength step_length_named(const std::string& name);
inline constexpr const char* kStepLengths[] = {"ls-dyna", "radioss", "abaqus"};  ///< in the order of
                                                                                 ///< StepLength

/// Returns the speed of membrane waves in a shell: sqrt(E / (rho (1 - nu^2))); 1 without a material.
double speed_of_sound(const Criteria& criteria);

/// Returns "0.33 size" or "40 degrees".
std::string text_of(const CriterionLimit& limit);

/// Returns the requested size, before it was reduced.
inline const SizeField& requested_size(const Preparation& prepared) {
  return prepared.size.asked ? *prepared.size.asked : *prepared.size.field;
}
/// Throws InputError for names that no curve or region of the mesh has. Also throws if the wanted size is
/// everywhere below the least length, or above the largest.
void check_criteria(const Criteria& criteria, const Mesh& mesh, const SizeField& size);

/// Returns the measures of meshes by criteria in tables: "failing", "failing_min_length", ..., "time_step".
const std::vector<Metric>& criteria_metrics();
/// Returns these measures for a report.
std::map<std::string, double> values_of(const CriteriaReport& report);

}  // namespace delquad
