#include "metrics/tables/cell_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delquad {
namespace {

/// The most decimal places of values whose exact ones have `digits`: what is less is of no use to anybody.
int most_decimals(int digits) { return std::max(6, digits + 3); }

/// Whether half of the last place is the rest, exactly.
bool is_tie(double value, int decimals) {
  return std::fmod(std::ldexp(std::abs(value), decimals + 1), 2) == 1;
}

}  // namespace

std::string number_text(double value, int decimals) {
  if (is_tie(value, decimals)) value = std::nextafter(value, std::copysign(HUGE_VAL, value));
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text[0] == '-' ? text.substr(1) : text;
}

int decimals_of(double half_width, int digits) {
  const int most = most_decimals(digits);
  if (!(half_width >= std::pow(10.0, -most) / 2) || std::isinf(half_width)) return digits;
  const double order = std::floor(std::log10(half_width));
  return std::clamp(static_cast<int>(1 - order), 0, most);
}

std::string half_width_text(double half_width, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  if (half_width > 0 && half_width < unit / 2) return fmt::format("< {:.{}f}", unit, decimals);
  return number_text(half_width, decimals);
}

std::string ends_text(const Interval& interval, int decimals) {
  return fmt::format("[{}, {}]", number_text(interval.low, decimals), number_text(interval.high, decimals));
}

std::string interval_text(double value, const Interval& interval, int digits) {
  const int decimals = decimals_of((interval.high - interval.low) / 2, digits);
  return number_text(value, decimals) + " " + ends_text(interval, decimals);
}

std::string p_text(double p) {
  constexpr double kLeastShown = 0.0001;
  return p < kLeastShown ? "< 0.0001" : fmt::format("{:.4f}", p);
}

std::string seconds_text(double seconds) {
  constexpr double kTwoDecimals = 1;
  return seconds < kTwoDecimals ? fmt::format("{:.3g}", seconds) : number_text(seconds, 2);
}

}  // namespace delquad
