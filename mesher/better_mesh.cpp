#include "mesher/finish_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/mesh/half_edges.h"
#include "metrics/judgement/poor_quads.h"
#include "metrics/shape.h"
#include "metrics/size_efficiency.h"

namespace delquad {
namespace {

/// Differences that count, as a part of the value.
constexpr double kChange = 1e-9;
/// The number of quads may differ by this part.
constexpr double kOtherNumber = 0.1;
/// Edges are near enough to their size with this tau, in percent.
constexpr double kGoodTau = 91;

double value(const MeshResult& run, const char* key) { return run.metrics.values.at(key); }

/// Not below both what is good and what there was.
bool is_kept(const char* key, double good, const MeshResult& after, const MeshResult& before) {
  constexpr double kRounding = 1e-9;
  return value(after, key) > std::min(good, value(before, key)) - kRounding;
}

double score(const MeshResult& run) {
  return value(run, "eta_mean") + value(run, "eta_worst") + value(run, "d4") / 100;
}

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

bool is_beyond_given(const PreparedProblem& prepared, const std::array<Vec3, 4>& corners) {
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

Harm harm_of(const MeshResult& after, const MeshResult& before) {
  const double number = value(after, "n_quads") / value(before, "n_quads");
  return {times_worse(value(before, "eta_worst"), value(after, "eta_worst")),
          times_worse(value(before, "edge_min"), value(after, "edge_min")),
          times_worse(value(after, "aspect_max"), value(before, "aspect_max")),
          times_worse(number, 1 + kOtherNumber) + times_worse(1 - kOtherNumber, number)};
}

bool is_worse(const MeshResult& after, const MeshResult& before) {
  if (before.soundness.sound() && !after.soundness.sound()) return true;
  if (harm_of(after, before).sum() > 0) return true;
  if (after.soundness.sound() && !before.soundness.sound()) return false;
  bool worse = false;
  for (const char* key : {"eta_mean", "eta_worst", "d4"}) {
    const double was = value(before, key), is = value(after, key);
    if (std::abs(is - was) <= kChange * std::abs(was)) continue;
    if (is > was) return false;
    worse = true;
  }
  return worse;
}

bool is_better(const PreparedProblem& prepared, const MeshResult& after, const MeshResult& before) {
  const double is = failing_part(prepared, after.mesh), was = failing_part(prepared, before.mesh);
  return (is == was ? score(after) > score(before) : is < was) && !is_worse(after, before);
}

bool is_more_regular(const PreparedProblem& prepared, const MeshResult& after, const MeshResult& before) {
  return failing_part(prepared, after.mesh) <= failing_part(prepared, before.mesh) &&
         value(after, "n_irregular") < value(before, "n_irregular") &&
         is_kept("tau", kGoodTau, after, before);
}

bool keeps_worst_eta(double eta, const MeshResult& after, const MeshResult& before) {
  return is_kept("eta_worst", eta, after, before);
}

void take_mesh(MeshResult&& from, MeshResult& result) {
  result.mesh = std::move(from.mesh);
  result.metrics = std::move(from.metrics);
  result.soundness = std::move(from.soundness);
  result.surface = std::move(from.surface);
}

}  // namespace delquad
