#pragma once

#include <string>

#include "metrics/tables/statistics.h"

namespace delquad {

/// With that many decimal places; halves are rounded away from 0, as on the page of results, and 0 has no
/// sign.
std::string number_text(double value, int decimals);
/// Decimal places with which a value and half the width of its interval are shown: two significant digits of
/// the half-width, so that rounding hides neither, but no more than 6, or 3 more than `digits`. `digits`: of
/// values that are exact; used where the half-width is 0, not known, or nothing in so many places.
int decimals_of(double half_width, int digits);
/// "0.43"; "< 0.001" where it would be rounded to nothing.
std::string half_width_text(double half_width, int decimals);
/// "[0.010, 0.015]".
std::string ends_text(const Interval& interval, int decimals);
/// "0.012 [0.010, 0.015]", with two significant digits of half the interval's width.
std::string interval_text(double value, const Interval& interval, int digits);

/// "0.0123"; "< 0.0001" below that.
std::string p_text(double p);
/// Seconds, with three significant digits or two decimals.
std::string seconds_text(double seconds);

}  // namespace delquad
