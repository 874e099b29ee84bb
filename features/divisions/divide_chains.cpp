#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "delquad/error.h"
#include "features/divisions/divisions.h"
#include "geometry/mesh/entity_names.h"

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
  for (const CurveDivision& division : divisions)
    for (const int curve : find_entities(fine.curves, "curve", division.name, division.where)) {
      std::vector<std::size_t> own;
      std::vector<std::vector<double>> along;
      std::vector<double> lengths;
      for (std::size_t c = 0; c < chains.size(); ++c) {
        if (chains[c].curve != curve) continue;
        own.push_back(c);
        along.push_back(lengths_along(fine, chains[c]));
        lengths.push_back(along.back().back());
      }
      const std::string label = fmt::format("curve {}", fine.curves[curve].tag);
      if (std::ranges::any_of(own, [&](std::size_t c) { return !divided[c].empty(); }))
        throw InputError(fmt::format("{}: {} is divided twice", division.where, label));
      const auto places = division_places(division, lengths, label);
      for (std::size_t i = 0; i < own.size(); ++i)
        for (const double length : places[i]) divided[own[i]].push_back(s_at_length(along[i], length));
    }
  return divided;
}

void divide_curves(const Mesh& fine, const SurfaceCurves& curves, const std::vector<CurveDivision>& divisions,
                   CurveDemands& wanted) {
  wanted.divided = divide_chains(fine, curves.chains, divisions);
  for (const ChainPair& pair : curves.images)
    if (!wanted.divided[pair.chain].empty())
      throw InputError(
          fmt::format("curve {} is divided and gets the nodes of curve {}: expected the latter to be divided",
                      fine.curves[curves.chains[pair.chain].curve].tag,
                      fine.curves[curves.chains[pair.master].curve].tag));
  std::map<int, int> of_group;
  for (std::size_t c = 0; c < wanted.divided.size(); ++c) {
    if (wanted.divided[c].empty()) continue;
    wanted.demands[c].exact = static_cast<int>(wanted.divided[c].size()) - 1;
    of_group.try_emplace(wanted.group[c], wanted.demands[c].exact);
  }
  for (std::size_t c = 0; c < wanted.demands.size(); ++c)
    if (const auto at = of_group.find(wanted.group[c]); at != of_group.end())
      wanted.demands[c].integral = at->second;
}

void check_divisions_even(const Mesh& fine, const SurfaceCurves& curves, const CurveDemands& wanted,
                          const std::vector<int>& odd_patches, const std::vector<CurveDivision>& divisions) {
  for (const int p : odd_patches)
    for (std::size_t c = 0; c < curves.chains.size(); ++c)
      if (wanted.demands[c].exact > 0 && std::ranges::count(wanted.demands[c].patches, p) > 0)
        throw InputError(
            fmt::format("{}: the numbers of edges that are given leave {} with an odd number around it, and "
                        "quads need an "
                        "even one: change that of curve {}",
                        divisions.front().where, face_name(fine, curves.maps[static_cast<std::size_t>(p)]),
                        fine.curves[curves.chains[c].curve].tag));
}

void warn_of_lost_nodes(const Mesh& fine, const SurfaceCurves& curves, const CurveDemands& wanted,
                        const std::vector<CurveDivision>& divisions, SurfaceDomain& domain) {
  for (std::size_t c = 0; c < curves.chains.size(); ++c) {
    const int exact = wanted.demands[c].exact, left = static_cast<int>(domain.nodes.on_curve[c].size()) - 1;
    if (exact == 0 || left == exact) continue;
    domain.warnings.push_back(
        {"divided curves with fewer edges than asked for", static_cast<double>(exact - left),
         fmt::format(
             "{}: curve {} gets {} edges, not {}: it ends at a sharp tip, around which two quads take "
             "the place of its last nodes",
             divisions.front().where, fine.curves[curves.chains[c].curve].tag, left, exact)});
  }
}

}  // namespace delquad
