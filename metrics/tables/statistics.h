#pragma once

#include <optional>
#include <span>
#include <vector>

namespace delquad {

double mean(std::span<const double> samples);
double median(std::span<const double> samples);  ///< NaN of none
/// Half the width of the 95 % confidence interval of the mean, by Student's t; NaN of fewer than two.
double confidence_half_width(std::span<const double> samples);

/// Twice the rank of each value, from 1: whole numbers also where ties share a mean rank.
std::vector<int> double_ranks(std::span<const double> values);

/// A two-sided test by ranks of the hypothesis that there is no difference.
struct RankTest {
  double p = 1;        ///< how likely it is that samples lean so far to one side when nothing does
  double least_p = 1;  ///< the least that so many samples can give, however they come out
  double lean = 0;     ///< above 0: the first is larger
};
/// Wilcoxon's signed-rank test of differences, first minus second. Zeros are left out, ties share their mean
/// rank; exact up to 60 differences, by the normal distribution beyond. p = 1 of none.
RankTest wilcoxon(std::span<const double> differences);
/// The Mann-Whitney U test of two samples that are not paired. Ties share their mean rank; exact up to 60
/// values together, by the normal distribution (corrected for ties and continuity) beyond. p = 1 where one
/// sample is empty.
RankTest mann_whitney(std::span<const double> first, std::span<const double> second);
/// Holm's step-down adjustment [holm1979]: a hypothesis may be rejected at a level when its adjusted p-value
/// is at most that level; then the probability of any false rejection is at most the level, however the tests
/// depend on each other.
std::vector<double> holm(std::span<const double> p);

/// y = factor * x^exponent.
struct PowerLaw {
  double factor, exponent;
};
/// The law that fits positive pairs best, by least squares of the logarithms; nothing where all x are alike.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace delquad
