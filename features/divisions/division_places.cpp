#include "features/divisions/divisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "delquad/error.h"

namespace delquad {
namespace {

/// The part of the way along the curve after `f` edges, of which there need not be a whole number.
double part_after(const std::vector<double>& ends, double f) {
  const double k = std::clamp(std::floor(f), 0.0, static_cast<double>(ends.size() - 2));
  const auto i = static_cast<std::size_t>(k);
  return ends[i] + (f - k) * (ends[i + 1] - ends[i]);
}

/// How many edges lie before that part of the way.
double edges_before(const std::vector<double>& ends, double part) {
  const auto after = std::upper_bound(ends.begin() + 1, ends.end() - 1, part);
  const auto i = static_cast<std::size_t>(after - ends.begin()) - 1;
  return static_cast<double>(i) + (part - ends[i]) / (ends[i + 1] - ends[i]);
}

/// Where the edges of a division end, in parts of the curve's length: n + 1 numbers from 0 to 1.
std::vector<double> division_ends(const CurveDivision& division) {
  const int n = division.edges;
  std::vector<double> ends{0};
  for (int k = 0; k < n; ++k) {
    const double from_middle = n > 1 ? std::abs(2.0 * k - (n - 1)) / (n - 1) : 0;
    ends.push_back(ends.back() + std::pow(division.progression, k) * std::pow(division.bump, from_middle));
  }
  const double sum = ends.back();
  for (double& end : ends) end /= sum;
  return ends;
}

}  // namespace

std::vector<std::vector<double>> division_places(const CurveDivision& division,
                                                 const std::vector<double>& lengths,
                                                 const std::string& label) {
  const int n = division.edges, m = static_cast<int>(lengths.size());
  if (n < m)
    throw InputError(
        fmt::format("{}: {} edges for {}, which corners and other curves cut into {} pieces: "
                    "expected at least {}",
                    division.where, n, label, m, m));
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const std::vector<double> ends = division_ends(division);
  std::vector<std::vector<double>> places;
  double begin = 0;
  int first = 0;
  for (int i = 0; i < m; ++i) {
    const double end = i + 1 == m ? 1 : begin + lengths[i] / length;
    const double f0 = edges_before(ends, begin), f1 = edges_before(ends, end);
    // Each of the pieces that follow needs an edge, too.
    const int rest = m - 1 - i;
    const int last = rest == 0 ? n : std::clamp(static_cast<int>(std::lround(f1)), first + 1, n - rest);
    auto& own = places.emplace_back(1, 0.0);
    for (int k = 1; k < last - first; ++k)
      own.push_back((part_after(ends, f0 + (f1 - f0) * k / (last - first)) - begin) * length);
    own.push_back(lengths[i]);
    begin = end;
    first = last;
  }
  return places;
}

}  // namespace delquad
