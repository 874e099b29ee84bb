#include "delquad/model.h"

#include <fmt/format.h>

#include <cmath>

#include "delquad/error.h"

namespace delquad {
namespace {

constexpr int kMostLayers = 10000;
constexpr double kLargestFan = 120;  // degrees; beyond it, quads without a fan would be nearly flat

void check(const LayerSpec& spec) {
  const auto refuse = [&](const char* what, double value, const char* expected) {
    throw InputError(fmt::format("{}: {} {}: expected {}", spec.where, what, value, expected));
  };
  const auto is_positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (spec.on.empty()) throw InputError(spec.where + ": the layer is on nothing: expected names of curves");
  if (!is_positive(spec.first)) refuse("first height", spec.first, "a finite number above 0");
  if (!(spec.growth >= 1) || !std::isfinite(spec.growth)) refuse("growth", spec.growth, "at least 1");
  if (spec.number < 0 || spec.number > kMostLayers) refuse("number", spec.number, "1 to 10000 layers");
  if (spec.thickness != 0 && !is_positive(spec.thickness))
    refuse("thickness", spec.thickness, "a finite number above 0");
  if ((spec.number == 0) == (spec.thickness == 0))
    throw InputError(fmt::format("{}: {} of 'number' and 'thickness': expected one", spec.where,
                                 spec.number == 0 ? "none" : "both"));
  if (spec.number == 0 && spec.thickness < spec.first)
    throw InputError(fmt::format("{}: thickness {} is less than the first height, {}", spec.where,
                                 spec.thickness, spec.first));
  if (!(spec.fan > 0 && spec.fan <= kLargestFan)) refuse("fan", spec.fan, "above 0 and at most 120 degrees");
}

}  // namespace

std::vector<double> layer_heights(const LayerSpec& spec) {
  check(spec);
  // What rounding of the sums may take or add.
  const double enough = spec.thickness * (1 - 1e-9);
  std::vector<double> heights;
  double height = spec.first, sum = 0;
  while (spec.number > 0 ? static_cast<int>(heights.size()) < spec.number : sum < enough) {
    if (heights.size() == static_cast<std::size_t>(kMostLayers))
      throw InputError(fmt::format("{}: the thickness needs more than {} layers", spec.where, kMostLayers));
    heights.push_back(sum += height);
    height *= spec.growth;
  }
  if (!std::isfinite(sum)) throw InputError(spec.where + ": the layers have no finite thickness");
  return heights;
}

}  // namespace delquad
