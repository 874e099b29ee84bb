#pragma once

#include <optional>
#include <span>

namespace delquad {

double mean(std::span<const double> samples);
double median(std::span<const double> samples);  ///< NaN of none
/// Half the width of the 95 % confidence interval of the mean, by Student's t; NaN of fewer than two.
double confidence_half_width(std::span<const double> samples);
/// Two-sided p-value of Wilcoxon's signed-rank test: how likely differences are that lean so far to one side
/// when neither side is better. Zeros are left out, ties share their mean rank; exact up to 60 differences,
/// by the normal distribution beyond. 1 of none.
double wilcoxon_p(std::span<const double> differences);

/// y = factor * x^exponent.
struct PowerLaw {
  double factor, exponent;
};
/// The law that fits positive pairs best, by least squares of the logarithms; nothing where all x are alike.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace delquad
