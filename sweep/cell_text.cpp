#include "sweep/cell_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delquad {
namespace {

constexpr int kMostDecimals = 9;

}  // namespace

int decimals_of(double half_width, int digits) {
  if (!(half_width > 0) || std::isinf(half_width)) return digits;
  const double order = std::floor(std::log10(half_width));
  return std::clamp(static_cast<int>(1 - order), 0, kMostDecimals);
}

std::string half_width_text(double half_width, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  if (half_width > 0 && half_width < unit / 2) return fmt::format("< {:.{}f}", unit, decimals);
  return fmt::format("{:.{}f}", half_width, decimals);
}

std::string interval_text(double value, const Interval& interval, int digits) {
  const int decimals = decimals_of((interval.high - interval.low) / 2, digits);
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", value, decimals, interval.low, decimals, interval.high,
                     decimals);
}

}  // namespace delquad
