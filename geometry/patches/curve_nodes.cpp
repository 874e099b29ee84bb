// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/curve_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <ranges>
#include <unordered_map>

#include "delquad/error.h"

namespace delquad {

std::vector<CurveChain> curve_chains(const SurfaceModel& model) {
  const Mesh& fine = model.fine;
  std::vector<std::vector<int>> whole(fine.curves.size());
  for (size_t i = 0; i < fine.lines.size(); ++i) {
    auto& points = whole[fine.line_curve[i]];
    const auto& [a, b] = fine.lines[i];
    if (points.empty()) points.push_back(a);
    if (points.back() != a) {
      if (model.lips.empty() || !(fine.points[points.back()] == fine.points[a]))
        throw InputError(
            fmt::format("curve {}: its lines do not form one chain", fine.curves[fine.line_curve[i]].tag));
      points.push_back(a);  // a crack opens it
    }
    points.push_back(b);
  }
  std::vector<CurveChain> chains;
  for (size_t c = 0; c < whole.size(); ++c) {
    auto& points = whole[c];
    if (points.empty()) throw InputError(fmt::format("curve {} has no lines", fine.curves[c].tag));
    const auto is_corner = [&](int p) {
      return std::binary_search(model.corners.begin(), model.corners.end(), p);
    };
    const auto first = std::find_if(points.begin(), points.end(), is_corner);
    if (points.front() == points.back() && first != points.end() && first != points.begin()) {
      points.pop_back();  // a closed curve begins at a corner, if it has one
      std::rotate(points.begin(), first, points.end());
      points.push_back(points.front());
    }
    CurveChain chain{static_cast<int>(c), {points.front()}};
    for (size_t i = 1; i < points.size(); ++i) {
      chain.points.push_back(points[i]);
      if (i + 1 == points.size() || !is_corner(points[i])) continue;
      chains.push_back(std::move(chain));
      chain = {static_cast<int>(c), {points[i]}};
    }
    chains.push_back(std::move(chain));
  }
  if (!model.lips.empty())
    std::erase_if(chains, [&](const CurveChain& c) {
      return c.points.size() == 2 && fine.points[c.points[0]] == fine.points[c.points[1]];
    });
  return chains;
}

std::vector<CurveDemand> joined_demands(std::vector<CurveDemand> demands,
                                        const std::vector<ChainPair>& pairs) {
  for (const ChainPair& pair : std::views::reverse(pairs)) {
    CurveDemand &master = demands[pair.master], &image = demands[pair.chain];
    master.patches.insert(master.patches.end(), image.patches.begin(), image.patches.end());
    master.minimum = std::max(master.minimum, image.minimum);
    master.most = std::min(master.most, image.most);
    image.patches.clear();
  }
  return demands;
}

namespace {

/// Largest piece of a fine line in the integral, over the size there, and limit of pieces of a line.
constexpr double kPiece = 0.25;
constexpr int kMostPieces = 4096;

}  // namespace

SizeIntegral size_integral(const Mesh& fine, const CurveChain& chain, const SizeOnLine& size,
                           std::span<const double> limits) {
  assert(chain.points.size() >= 2);
  assert(limits.empty() || limits.size() == chain.points.size());
  constexpr double kGauss = 0.21132486540518713;  // (1 - 1/sqrt 3) / 2
  SizeIntegral table;
  int hint = -1;
  table.entries.push_back({0, 0});
  for (size_t i = 0; i + 1 < chain.points.size(); ++i) {
    const Vec3 a = fine.points[chain.points[i]], d = fine.points[chain.points[i + 1]] - a;
    const double length = norm(d), shortest = 1.0 / kMostPieces;
    const auto size_at = [&](double t) {
      const double wanted = size(chain.points[i], chain.points[i + 1], t, a + t * d, hint);
      return limits.empty() ? wanted : std::min(wanted, (1 - t) * limits[i] + t * limits[i + 1]);
    };
    for (double t = 0; t < 1;) {
      // The size at the piece's middle may be far smaller than at its beginning: halved until it fits.
      double step = std::clamp(kPiece * size_at(t) / length, shortest, 1.0);
      while (step > shortest && step * length > 2 * kPiece * size_at(std::min(t + step, 1.0))) step /= 2;
      if (t + 1.5 * step > 1) step = 1 - t;
      double sum = 0;
      for (const double g : {kGauss, 1 - kGauss}) sum += 1 / size_at(t + g * step);
      t = t + step < 1 ? t + step : 1;
      table.entries.push_back({static_cast<double>(i) + t, table.total() + step * length * sum / 2});
    }
  }
  // A curve without length is divided evenly.
  if (!(table.total() > 0 && std::isfinite(table.total())))
    table.entries = {{0, 0}, {table.entries.back().s, std::numeric_limits<double>::min()}};
  return table;
}

double SizeIntegral::interpolated(double at, double Entry::*from, double Entry::*to) const {
  assert(entries.size() >= 2);
  const auto after = std::upper_bound(entries.begin() + 1, entries.end() - 1, at,
                                      [from](double x, const Entry& e) { return x < e.*from; });
  const Entry &low = *(after - 1), &high = *after;
  const double t = std::clamp((at - low.*from) / (high.*from - low.*from), 0.0, 1.0);
  return low.*to + t * (high.*to - low.*to);
}

CurvePlaces equal_places(const std::vector<int>& counts) {
  assert(std::ranges::all_of(counts, [](int n) { return n >= 1; }));
  CurvePlaces places;
  for (const int n : counts) {
    places.emplace_back();
    for (int k = 0; k <= n; ++k) places.back().push_back(k);
  }
  return places;
}

Vec3 fine_point_at(const Mesh& fine, const CurveChain& chain, double s) {
  assert(s >= 0 && s <= static_cast<double>(chain.points.size() - 1));
  const std::size_t line = std::min(static_cast<std::size_t>(s), chain.points.size() - 2);
  const Vec3 a = fine.points[chain.points[line]], b = fine.points[chain.points[line + 1]];
  return a + (s - static_cast<double>(line)) * (b - a);
}

Vec3 place_on_curve(const SurfaceModel& model, const CurveChain& chain, const std::vector<int>& cut_face,
                    double s) {
  const Vec3 x = fine_point_at(model.fine, chain, s);
  if (!model.projector) return x;
  const int face = cut_face[chain.curve];
  return face >= 0 ? model.projector->to_face(face, x) : model.projector->to_curve(chain.curve, x);
}

SurfaceNodes place_nodes(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                         const std::vector<int>& cut_face, const std::vector<SizeIntegral>& integrals,
                         const CurvePlaces& places) {
  assert(integrals.size() == chains.size() && places.size() == chains.size());
  assert(std::ranges::all_of(places,
                             [](const auto& at) { return at.size() >= 2 && std::ranges::is_sorted(at); }));
  const Mesh& fine = model.fine;
  SurfaceNodes nodes;
  std::unordered_map<int, int> node_of_point;  // only looked up, never iterated
  const auto end_node = [&](int point) {
    const auto [it, added] = node_of_point.try_emplace(point, static_cast<int>(nodes.points.size()));
    if (added) nodes.points.push_back(fine.points[point]);
    return it->second;
  };
  for (size_t c = 0; c < chains.size(); ++c) {
    const auto& points = chains[c].points;
    auto& on_curve = nodes.on_curve.emplace_back();
    on_curve.push_back({0, end_node(points.front())});
    const size_t n = places[c].size() - 1;
    for (size_t k = 1; k < n; ++k) {
      const double s = integrals[c].s_at(places[c][k] / static_cast<double>(n));
      on_curve.push_back({s, static_cast<int>(nodes.points.size())});
      nodes.points.push_back(place_on_curve(model, chains[c], cut_face, s));
    }
    on_curve.push_back({static_cast<double>(points.size() - 1), end_node(points.back())});
  }
  return nodes;
}

}  // namespace delquad
