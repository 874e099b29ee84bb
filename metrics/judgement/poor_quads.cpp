// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/judgement/poor_quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "base/box.h"
#include "base/option_table.h"
#include "base/text.h"
#include "features/layers/add_layers.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/judgement/failing_elements.h"
#include "metrics/judgement/soundness.h"
#include "metrics/solve/solve.h"

namespace delquad {
namespace {

const OptionTable<LimitOptions>& limit_table() {
  static const auto all =
      OptionTable<LimitOptions>("limits", "beyond which an element is an error")
          .add({.name = "min_angle", .help = "degrees: a smaller angle is an error", .least = 0, .most = 90},
               &LimitOptions::min_angle)
          .add({.name = "max_aspect",
                .help = "longest over shortest side: more is an error",
                .least = 1,
                .absent = "any"},
               &LimitOptions::max_aspect);
  return all;
}

/// Properties that make a quad poor, in this order.
enum PoorLimit { kPoorByEta, kPoorByAspect, kPoorBySide };
const Criteria& poor_criteria() {
  static const Criteria poor{.limits = {{.key = "min_eta", .value = kBadEta},
                                        {.key = "max_aspect", .value = kPoorAspect},
                                        {.key = "min_length", .value = kPoorEdge, .in_sizes = true}}};
  return poor;
}

/// Returns the limits requested by options.
Criteria option_criteria(const Options& options) {
  Criteria criteria;
  const LimitOptions limits = limit_table().read(options);
  if (limits.min_angle > 0) criteria.limits.push_back({.key = "min_angle", .value = limits.min_angle});
  if (limits.max_aspect > 0) criteria.limits.push_back({.key = "max_aspect", .value = limits.max_aspect});
  return criteria;
}

void warn_of_poor_quads(const std::string& label, const FailingElements& poor, const JudgedMesh& judged,
                        std::vector<Warning>& warnings) {
  if (poor.elements.empty()) return;
  constexpr const char* kKinds[] = {"an angle below 10 or above 170 degrees", "an aspect above 20",
                                    "a side below a tenth of the size"};
  std::string what;
  for (std::size_t k = 0; k < poor.tallies.size(); ++k)
    if (const std::size_t n = poor.tallies[k].failing.size(); n > 0)
      what += fmt::format("{}{} with {}", what.empty() ? "" : ", ", n, kKinds[k]);
  const Mesh& mesh = judged.mesh;
  const int worst = poor.elements[0].element - static_cast<int>(mesh.triangles.size());
  std::string text = fmt::format(
      "{}: {} of {} quads {} poor ({}), the worst in {} (eta {:.2g}, aspect {:.3g})", label,
      poor.elements.size(), mesh.quads.size(), poor.elements.size() == 1 ? "is" : "are", what,
      show_place(mesh, middle_of_quad(mesh, worst)), eta_of(quad_shape(mesh, worst, judged.sides).angle),
      quad_aspect(corners_of(mesh, mesh.quads[worst])));
  const bool advised = judged.prepared->settings.criteria.empty();  // else their cures are told
  for (int cause = 0; cause < kFailingCauses; ++cause)
    if (const std::string why = poor.text_of(static_cast<FailingCause>(cause), false, advised); !why.empty())
      text += "; " + why;
  warnings.emplace_back(text + " [poor-quads]");
}

/// Warns of quads that are sound, but not after rounding.
void warn_of_single_precision(const std::string& label, const Mesh& mesh, const ElementSides& sides,
                              std::vector<Warning>& warnings) {
  Places spoilt;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto corners = corners_of(mesh, mesh.quads[q]);
    const double shortest = least_and_most_side(corners).first;
    if (shortest < kSingleHolds * single_rounding(corners) &&
        !(single_jacobian(corners, sides.of_quad(static_cast<int>(q))) > kLeastJacobian))
      spoilt.add(middle_of_quad(mesh, static_cast<int>(q)));
  }
  if (spoilt.count == 0) return;
  const auto box = Box<Vec3>::around(mesh.points);
  const Vec3 centre = 0.5 * (box.low + box.high);
  const bool is_far = norm(centre) > norm(box.size());
  const std::string help = is_far ? fmt::format("move the model's origin near to {}", show_point(centre))
                                  : "read the mesh in double precision";
  warnings.emplace_back(fmt::format(
      "{}: rounded to single precision, as many programs read coordinates, {}; {} [single-precision]", label,
      describe(mesh, spoilt, "1 quad is inverted or flat", "quads are inverted or flat"), help));
}

/// Names the parts of the model that cause inverted or flat quads.
void explain_flat_quads(const JudgedMesh& judged, Soundness& soundness) {
  static const Criteria flat{.limits = {{.key = "min_jacobian", .value = kLeastJacobian}}};
  FailingElements failing(judged, flat, false);
  failing.explain();
  for (const FailingCause cause : {kAtCorner, kAtFineCurve, kAtGap})
    if (const std::string why = failing.text_of(cause, true); !why.empty())
      soundness.reasons.back() += fmt::format("; {}", why);
}

void hold_to(const FailingElements& failing, std::vector<std::string>& beyond) {
  for (std::size_t k = 0; k < failing.tallies.size(); ++k)
    if (std::string text = failing.text_of(k); !text.empty()) beyond.push_back(std::move(text));
}

/// Returns, by quad, whether its sides and aspect are requested.
std::vector<char> requested_quads(const MeshingSetup& prepared, const Mesh& mesh) {
  std::vector<char> is_grid(mesh.regions.size(), 0);
  for (const PatchSetup& patch : prepared.patches)
    if (patch.grid && patch.grid_stays) is_grid[patch.region] = 1;
  std::vector<char> on_purpose = quads_in_layers(prepared, mesh);
  for (std::size_t q = 0; q < on_purpose.size(); ++q)
    if (is_grid[mesh.quad_region[q]]) on_purpose[q] = 1;
  return on_purpose;
}

/// Returns the least time step of all elements by the length of a program.
double estimated_step(const JudgedMesh& judged, Criteria criteria, const char* program) {
  criteria.limits = {{.key = "min_time_step"}};
  criteria.time_step_by = program;
  return FailingElements(judged, criteria, true).tallies[0].worst;
}

double least_size(const JudgedMesh& judged) {
  double least = std::numeric_limits<double>::infinity();
  int hint = -1;
  for_each_element(judged.mesh,
                   [&](int, const auto& v) { least = std::min(least, judged.size_at(v, hint)); });
  return least;
}

CriteriaReport report_on(const JudgedMesh& judged, const Criteria& criteria) {
  CriteriaReport report;
  report.name = criteria.name;
  report.elements = static_cast<long long>(judged.mesh.triangles.size() + judged.mesh.quads.size());
  FailingElements failing(judged, criteria, true);
  failing.explain();
  report.failing = static_cast<long long>(failing.elements.size());
  std::map<int, FailingCause> cause_of;
  for (const FailingElement& element : failing.elements) {
    ++report.causes[kCauseNames[element.cause]];
    cause_of[element.element] = element.cause;
  }
  for (std::size_t k = 0; k < criteria.limits.size(); ++k) {
    LimitTally& tally = failing.tallies[k];
    CriterionResult result{.limit = criteria.limits[k], .worst = tally.worst, .text = failing.text_of(k)};
    if (tally.worst_element >= 0) result.at = failing.place_of(tally.worst_element);
    if (!tally.failing.empty()) result.cause = kCauseNames[cause_of.at(tally.worst_element)];
    result.failing = std::move(tally.failing);
    report.results.push_back(std::move(result));
  }
  for (int k = 0; k < kFailingCauses; ++k) {
    const auto cause = static_cast<FailingCause>(k);
    if (std::string why = failing.text_of(cause, true, false); !why.empty())
      report.why.push_back(std::move(why));
    std::ranges::move(failing.cures_of(cause), std::back_inserter(report.cures));
  }
  for (const char* program : kStepLengths)
    report.estimated_step[program] = estimated_step(judged, criteria, program);
  report.critical_step = critical_step(judged.mesh) / speed_of_sound(criteria);
  report.step_of_squares = least_size(judged) / speed_of_sound(criteria);
  return report;
}

/// Returns the mean length of sides.
double mean_side(const Mesh& mesh) {
  double sum = 0, n = 0;
  for_each_element(mesh, [&](int, const auto& v) {
    for (std::size_t k = 0; k < v.size(); ++k, ++n)
      sum += norm(mesh.points[v[(k + 1) % v.size()]] - mesh.points[v[k]]);
  });
  return sum / n;
}

ElementSides sides_of(const MeshingSetup& prepared, const Mesh& mesh) {
  return prepared.surface ? ElementSides(mesh) : ElementSides(mesh, {0, 0, 1});
}

}  // namespace

OptionGroup limit_group() { return limit_table().group(); }

std::vector<std::string> CriteriaReport::beyond() const {
  std::vector<std::string> texts;
  for (const CriterionResult& result : results)
    if (!result.text.empty()) texts.push_back(result.text);
  return texts;
}

CriteriaReport judge(const Mesh& mesh, const Criteria& criteria, const SizeField* size) {
  require_readable(mesh, "the mesh");
  check_criteria(criteria);
  const ElementSides sides(mesh);
  std::unique_ptr<SizeField> mean;
  if (size == nullptr) size = (mean = make_constant_size(mean_side(mesh))).get();
  check_criteria(criteria, mesh, *size);
  return report_on({mesh, sides, size}, criteria);
}

void judge_by_criteria(const MeshingSetup& prepared, bool is_others, MeshResult& result) {
  const Criteria& criteria = prepared.settings.criteria;
  if (criteria.empty()) return;
  const ElementSides sides = sides_of(prepared, result.mesh);
  JudgedMesh judged{result.mesh, sides, &requested_size(prepared), is_others ? nullptr : &prepared};
  if (!is_others) judged.on_purpose = requested_quads(prepared, result.mesh);
  result.criteria = report_on(judged, criteria);
  result.metrics.values.merge(values_of(*result.criteria));
  if (criteria.strict)
    std::ranges::copy(result.criteria->beyond(), std::back_inserter(result.soundness.beyond));
}

double failing_part(const MeshingSetup& prepared, const Mesh& mesh) {
  const Criteria& criteria = prepared.settings.criteria;
  if (criteria.empty()) return 0;
  const ElementSides sides = sides_of(prepared, mesh);
  const FailingElements failing(
      {mesh, sides, &requested_size(prepared), &prepared, requested_quads(prepared, mesh)}, criteria, false);
  return static_cast<double>(failing.elements.size()) / static_cast<double>(mesh.quads.size());
}

BadQuads judge_quads(const MeshingSetup& prepared, const std::string& label, const Mesh& mesh,
                     const MeshMetrics& metrics, std::vector<Warning>& warnings, Soundness& soundness) {
  const auto& values = metrics.values;
  const ElementSides sides = sides_of(prepared, mesh);
  const JudgedMesh judged{mesh, sides, prepared.size.field.get(), &prepared, requested_quads(prepared, mesh)};
  BadQuads bad;
  // Most meshes have no such quads.
  const bool by_size = !prepared.metric_plane && !(prepared.surface && prepared.surface->metric);
  if (by_size && (values.at("eta_worst") < kBadEta || values.at("aspect_max") > kPoorAspect ||
                  values.at("edge_min") < kPoorEdge)) {
    FailingElements poor(judged, poor_criteria(), false);
    poor.explain();
    for (const FailingElement& quad : poor.elements)
      if ((quad.beyond >> kPoorByEta & 1) != 0) ++(quad.cause == kAtCorner ? bad.in_corners : bad.elsewhere);
    warn_of_poor_quads(label, poor, judged, warnings);
    if (!soundness.reasons.empty()) explain_flat_quads(judged, soundness);
  }
  warn_of_single_precision(label, mesh, sides, warnings);
  const Criteria limits = option_criteria(prepared.settings.options);
  if (!limits.empty()) hold_to(FailingElements(judged, limits, true), soundness.beyond);
  return bad;
}

}  // namespace delquad
