#include "sweep/cell_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delquad {
namespace {

constexpr int kMostDecimals = 9;

/// Without the sign of what is rounded to 0.
std::string fixed(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text[0] == '-' ? text.substr(1) : text;
}

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
  return fmt::format("{} [{}, {}]", fixed(value, decimals), fixed(interval.low, decimals),
                     fixed(interval.high, decimals));
}

std::string p_text(double p) {
  constexpr double kLeastShown = 0.0001;
  return p < kLeastShown ? "< 0.0001" : fmt::format("{:.4f}", p);
}

std::string seconds_text(double seconds) {
  constexpr double kTwoDecimals = 1;
  return seconds < kTwoDecimals ? fmt::format("{:.3g}", seconds) : fmt::format("{:.2f}", seconds);
}

}  // namespace delquad
