#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "metrics/judgement/element_values.h"

namespace delquad {

/// Throws InputError, naming those known.
CriterionKind criterion_kind(const std::string& key);

inline constexpr std::size_t kMostLimits = 64;

StepLength step_length_named(const std::string& name);
inline constexpr const char* kStepLengths[] = {"ls-dyna", "radioss", "abaqus"};  ///< as StepLength

/// Of membrane waves in a shell: sqrt(E / (rho (1 - nu^2))); 1 without a material.
double speed_of_sound(const Criteria& criteria);

/// "0.33 size" or "40 degrees".
std::string text_of(const CriterionLimit& limit);

/// The size that was wanted, before it was made less.
inline const SizeField& asked_size(const Preparation& prepared) {
  return prepared.size.asked ? *prepared.size.asked : *prepared.size.field;
}
/// Throws InputError for names that neither a curve nor a region of the mesh has, and where the wanted size
/// is at no point as large as the least length, or as small as the largest.
void check_criteria(const Criteria& criteria, const Mesh& mesh, const SizeField& size);

/// "failing", "failing_min_length", ..., "time_step": what meshes are compared by in tables.
const std::vector<Metric>& criteria_metrics();
/// These of a report.
std::map<std::string, double> values_of(const CriteriaReport& report);

}  // namespace delquad
