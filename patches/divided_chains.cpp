#include "patches/divided_chains.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/planar/curve_divisions.h"

namespace delquad {
namespace {

/// Length from a chain's beginning to each of its points.
std::vector<double> lengths_along(const Mesh& fine, const CurveChain& chain) {
  std::vector<double> length{0};
  for (std::size_t i = 0; i + 1 < chain.points.size(); ++i)
    length.push_back(length.back() + norm(fine.points[chain.points[i + 1]] - fine.points[chain.points[i]]));
  return length;
}

/// Where on the chain that length is.
double s_at_length(const std::vector<double>& lengths, double length) {
  const auto after = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, length);
  const double before = *(after - 1);
  const double t = *after > before ? std::clamp((length - before) / (*after - before), 0.0, 1.0) : 0;
  return static_cast<double>(after - lengths.begin() - 1) + t;
}

}  // namespace

std::vector<std::vector<double>> divide_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                                               const std::vector<CurveDivision>& divisions) {
  std::vector<std::vector<double>> divided(chains.size());
  for (const CurveDivision& division : divisions) {
    bool found = false;
    std::vector<std::string> known;
    for (std::size_t curve = 0; curve < fine.curves.size(); ++curve) {
      const Entity& entity = fine.curves[curve];
      known.insert(known.end(), entity.names.begin(), entity.names.end());
      if (!names_curve(division, entity.names, entity.tag)) continue;
      std::vector<std::size_t> own;
      std::vector<std::vector<double>> along;
      std::vector<double> lengths;
      for (std::size_t c = 0; c < chains.size(); ++c) {
        if (chains[c].curve != static_cast<int>(curve)) continue;
        own.push_back(c);
        along.push_back(lengths_along(fine, chains[c]));
        lengths.push_back(along.back().back());
      }
      if (own.empty()) continue;
      found = true;
      const std::string label = fmt::format("curve {}", entity.tag);
      if (std::ranges::any_of(own, [&](std::size_t c) { return !divided[c].empty(); }))
        throw InputError(fmt::format("{}: {} is divided twice", division.where, label));
      const auto places = division_places(division, lengths, label);
      for (std::size_t i = 0; i < own.size(); ++i)
        for (const double length : places[i]) divided[own[i]].push_back(s_at_length(along[i], length));
    }
    if (!found) throw no_such_curve(division, known);
  }
  return divided;
}

Vec3 fine_point_at(const Mesh& fine, const CurveChain& chain, double s) {
  const std::size_t line = std::min(static_cast<std::size_t>(s), chain.points.size() - 2);
  const Vec3 a = fine.points[chain.points[line]], b = fine.points[chain.points[line + 1]];
  return a + (s - static_cast<double>(line)) * (b - a);
}

}  // namespace delquad
