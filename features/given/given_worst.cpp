// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/given/given_worst.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "geometry/mesh/half_edges.h"
#include "metrics/judgement/poor_quads.h"
#include "metrics/judgement/soundness.h"
#include "metrics/shape.h"
#include "metrics/size_efficiency.h"

namespace delquad {
namespace {

/// Differences that count, as a part of the value.
constexpr double kChange = 1e-9;
/// The number of quads may differ by this part.
constexpr double kOtherNumber = 0.1;

/// How many times worse, as a logarithm; 0: it is not.
double times_worse(double is, double was) { return is > was * (1 + kChange) ? std::log(is / was) : 0; }

}  // namespace

GivenWorst worst_of_given(const Mesh& mesh, bool is_in_plane, const SizeField& size) {
  GivenWorst worst;
  double aspect = 0;
  for (const auto& quad : mesh.quads) {
    const auto corners = corners_of(mesh, quad);
    const Vec3 side = is_in_plane ? Vec3{0, 0, 1} : area_vector(corners);
    const ElementShape<4> shape = element_shape(corners, side);
    const double eta = eta_of(shape.angle);
    worst.eta = std::min(worst.eta, eta);
    if (!is_sound_quad(corners, side, shape)) {
      worst.is_sound = false;
      continue;
    }
    worst.sound_eta = std::min(worst.sound_eta, eta);
    aspect = std::max(aspect, quad_aspect(corners));
  }
  worst.aspect = aspect > 0 ? aspect : std::numeric_limits<double>::infinity();
  worst.side = fit_to_size(mesh, sorted_half_edges(mesh), size).shortest;
  return worst;
}

bool is_beyond_given(const MeshingSetup& prepared, const std::array<Vec3, 4>& corners) {
  constexpr double kPoorEta = 0.2;
  const GivenWorst& worst = *prepared.given_worst;
  const Vec3 normal = prepared.surface ? area_vector(corners) : Vec3{0, 0, 1};
  if (eta_of(element_shape(corners, normal).angle) <
          std::max(worst.eta, std::min(worst.sound_eta, kPoorEta)) ||
      quad_aspect(corners) > worst.aspect)
    return true;
  for (int k = 0; k < 4; ++k)
    if (adimensional_length(corners[k], corners[(k + 1) % 4], *prepared.size.field) < worst.side) return true;
  return false;
}

Degradation degradation_of(const MeshResult& after, const MeshResult& before) {
  const double number = after.metrics.values.at("n_quads") / before.metrics.values.at("n_quads");
  return {times_worse(before.metrics.values.at("eta_worst"), after.metrics.values.at("eta_worst")),
          times_worse(before.metrics.values.at("edge_min"), after.metrics.values.at("edge_min")),
          times_worse(after.metrics.values.at("aspect_max"), before.metrics.values.at("aspect_max")),
          times_worse(number, 1 + kOtherNumber) + times_worse(1 - kOtherNumber, number)};
}

bool costs_too_much(const MeshResult& after, const MeshResult& before) {
  const Degradation degradation = degradation_of(after, before);
  const auto& values = after.metrics.values;
  return degradation.number > 0 || (degradation.eta > 0 && values.at("eta_worst") < kBadEta) ||
         (degradation.side > 0 && values.at("edge_min") < kPoorEdge) ||
         (degradation.aspect > 0 && values.at("aspect_max") > kPoorAspect);
}

MeshResult as_it_was(MeshResult given, const GivenWorst& worst) {
  given.metrics.values["eta_worst"] = worst.eta;
  given.metrics.values["edge_min"] = worst.side;
  given.metrics.values["aspect_max"] = worst.aspect;
  if (!worst.is_sound && given.soundness.sound()) given.soundness.reasons.emplace_back("given quads are not");
  return given;
}

std::string text_of_price(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before) {
  const Mesh& mesh = after.mesh;
  const auto at_least = [&](const std::function<double(const std::array<Vec3, 4>&)>& quality) {
    std::vector<double> of;
    for (const auto& quad : mesh.quads) of.push_back(quality(corners_of(mesh, quad)));
    return show_place(mesh,
                      middle_of_quad(mesh, static_cast<int>(std::ranges::min_element(of) - of.begin())));
  };
  const auto eta = [&](const std::array<Vec3, 4>& x) {
    return eta_of(element_shape(x, prepared.surface ? area_vector(x) : Vec3{0, 0, 1}).angle);
  };
  const auto side = [&](const std::array<Vec3, 4>& x) {
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4; ++k)
      least = std::min(least, adimensional_length(x[k], x[(k + 1) % 4], *prepared.size.field));
    return least;
  };
  const auto was_is = [&](const char* key) {
    return fmt::format("from {:.3g} to {:.3g}", before.metrics.values.at(key), after.metrics.values.at(key));
  };
  const Degradation degradation = degradation_of(after, before);
  std::vector<std::string> prices;
  if (degradation.eta > 0)
    prices.push_back(fmt::format("the worst eta goes {}, {}", was_is("eta_worst"), at_least(eta)));
  if (degradation.side > 0)
    prices.push_back(fmt::format("the shortest edge goes {} sizes, {}", was_is("edge_min"), at_least(side)));
  if (degradation.aspect > 0)
    prices.push_back(fmt::format("the largest aspect of sound quads goes {}, {}", was_is("aspect_max"),
                                 at_least([](const auto& x) { return -quad_aspect(x); })));
  if (degradation.number > 0) prices.push_back(fmt::format("the number of quads goes {}", was_is("n_quads")));
  return fmt::format("{}", fmt::join(prices, "; "));
}

}  // namespace delquad
