// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/divisions/divisions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "delquad/error.h"
#include "features/sizes/fine_spots.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// Curves that face a divided one want as many edges, if this is within such a factor of the number that they
/// want, either way.
constexpr double kMostChange = 1.45;

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
        throw InputError(fmt::format("{}: {} is divided twice: expected once", division.where, label));
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
      if (const double change = std::log(at->second / wanted.integrals[c].total());
          wanted.demands[c].exact > 0 || std::abs(change) <= std::log(kMostChange))
        wanted.demands[c].integral = at->second;
}

void check_divisions_even(const std::string& prefix, const Mesh& fine, const SurfaceCurves& curves,
                          const CurveDemands& wanted, const std::vector<int>& odd_patches) {
  for (const int p : odd_patches) {
    std::set<std::string> names;
    for (std::size_t c = 0; c < curves.chains.size(); ++c)
      if (wanted.demands[c].exact > 0 && std::ranges::count(wanted.demands[c].patches, p) > 0)
        names.insert(curve_title(fine.curves[curves.chains[c].curve]));
    if (names.empty()) continue;
    const Entity& face = fine.regions[curves.maps[p].face];
    throw InputError(
        fmt::format("{}the given numbers of edges leave {} with an odd number around it, and quads need an "
                    "even one. Change the number on {} [odd-numbers]",
                    prefix, face.names.empty() ? face_name(fine, curves.maps[p]) : "'" + face.names[0] + "'",
                    fmt::join(names, " or ")));
  }
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

namespace {

/// The pieces of one curve, in their order, get its nodes.
void divide_curve(const PlanarModel& model, const CurveDivision& division, int curve,
                  const std::vector<CurvePiece*>& pieces) {
  const auto unit = make_constant_size(1);
  const std::string label = curve_label(model, curve);
  std::vector<ArcMeasure> arcs;
  std::vector<double> lengths;
  for (const CurvePiece* p : pieces) {
    arcs.emplace_back(*p->shape, p->from, p->to, *unit, message_prefix(model) + label, 1);
    lengths.push_back(arcs.back().integral());
  }
  const auto places = division_places(division, lengths, label);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    CurvePiece& piece = *pieces[i];
    piece.n = static_cast<int>(places[i].size()) - 1;
    piece.is_divided = true;
    piece.interior = arcs[i].nodes_at({places[i].begin() + 1, places[i].end() - 1});
    if (piece.n < piece.least)
      throw InputError(fmt::format("{}: {} edge(s) for {}: expected at least {}, for it would fold up",
                                   division.where, division.edges, label,
                                   division.edges - piece.n + piece.least));
  }
}

}  // namespace

void divide_pieces(const PlanarModel& model, const std::vector<CurveDivision>& divisions,
                   std::vector<CurvePiece>& pieces) {
  for (const CurveDivision& division : divisions)
    for (const int c : find_entities(curve_entities(model), "curve", division.name, division.where)) {
      std::vector<CurvePiece*> own;
      for (CurvePiece& p : pieces)
        if (std::ranges::find(p.curves, c) != p.curves.end()) own.push_back(&p);
      if (std::ranges::any_of(own, &CurvePiece::is_divided))
        throw InputError(
            fmt::format("{}: {} is divided twice, perhaps as part of another curve that lies on it",
                        division.where, curve_label(model, c)));
      divide_curve(model, division, c, own);
    }
}

namespace {

LocalSize spot_of_edge(const Vec3& a, const Vec3& b) { return {a, b, norm(b - a), 0}; }

}  // namespace

std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const PlanarModel& model,
                                            const PlanarDomain& domain,
                                            const std::vector<CurveDivision>& divisions) {
  std::set<int> divided;
  for (const CurveDivision& division : divisions)
    for (const int c : entities_named(curve_entities(model), "curve", division.name)) divided.insert(c);
  std::vector<LocalSize> spots;
  const Mesh& mesh = domain.boundary;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (std::ranges::any_of(domain.model_curves[mesh.line_curve[l]],
                            [&](int c) { return divided.contains(c); }))
      spots.push_back(spot_of_edge(mesh.points[mesh.lines[l][0]], mesh.points[mesh.lines[l][1]]));
  return as_near(std::move(size), spots);
}

std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const SurfaceModel& model,
                                            const std::vector<CurveDivision>& divisions) {
  const std::vector<CurveChain> chains = curve_chains(model);
  const auto divided = divide_chains(model.fine, chains, divisions);
  std::vector<LocalSize> spots;
  for (std::size_t c = 0; c < chains.size(); ++c)
    for (std::size_t k = 1; k < divided[c].size(); ++k)
      spots.push_back(spot_of_edge(fine_point_at(model.fine, chains[c], divided[c][k - 1]),
                                   fine_point_at(model.fine, chains[c], divided[c][k])));
  return as_near(std::move(size), spots);
}

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
                    "expected at least {} [too-few-edges]",
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
