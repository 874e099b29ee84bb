#include "boundaries/periodic_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "base/nearest_name.h"
#include "boundaries/divided_chains.h"
#include "delquad/error.h"

namespace delquad {
namespace {

/// Images may lie so far from their curves, in diagonals of the model.
constexpr double kPeriodicTolerance = 1e-6;
/// Corners are images of corners that are images, of which a third may be one.
constexpr int kImageRounds = 3;

std::vector<int> chains_named(const Mesh& fine, const std::vector<CurveChain>& chains,
                              const PeriodicPair& pair, const std::string& name) {
  std::vector<int> found;
  std::vector<std::string> known;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const Entity& curve = fine.curves[chains[c].curve];
    known.insert(known.end(), curve.names.begin(), curve.names.end());
    if (std::ranges::find(curve.names, name) != curve.names.end() ||
        fmt::format("curve_{}", curve.tag) == name)
      found.push_back(static_cast<int>(c));
  }
  if (found.empty())
    throw InputError(fmt::format("{}: no curve is called '{}'{}", pair.where, name, suggestion(name, known)));
  return found;
}

/// The place on the chain next to x, and how far it is.
std::pair<double, double> nearest_place(const Mesh& fine, const CurveChain& chain, const Vec3& x) {
  std::pair<double, double> best{0, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
    const Vec3 &a = fine.points[chain.points[i]], &b = fine.points[chain.points[i + 1]];
    const Vec3 d = b - a;
    const double length2 = dot(d, d);
    const double t = length2 > 0 ? std::clamp(dot(x - a, d) / length2, 0.0, 1.0) : 0;
    const double distance = norm(a + t * d - x);
    if (distance < best.second) best = {static_cast<double>(i) + t, distance};
  }
  return best;
}

Vec3 middle_of(const Mesh& fine, const CurveChain& chain) {
  return fine.points[chain.points[chain.points.size() / 2]];
}

/// A closed chain begins at the point nearest to x.
void turn_to(const Mesh& fine, CurveChain& chain, const Vec3& x) {
  chain.points.pop_back();
  const auto first =
      std::ranges::min_element(chain.points, {}, [&](int v) { return norm(fine.points[v] - x); });
  std::rotate(chain.points.begin(), first, chain.points.end());
  chain.points.push_back(chain.points.front());
}

std::optional<ChainPair> image_of(const Mesh& fine, std::vector<CurveChain>& chains, const PeriodicPair& pair,
                                  int master, const std::vector<int>& others, double tolerance) {
  const CurveChain& m = chains[master];
  const Vec3 a = pair.motion(fine.points[m.points.front()]), b = pair.motion(fine.points[m.points.back()]);
  const Vec3 middle = pair.motion(middle_of(fine, m));
  std::optional<ChainPair> best;
  double least = std::numeric_limits<double>::infinity();
  for (const int i : others) {
    if (chains[i].closed() != m.closed() || i == master) continue;
    if (m.closed()) turn_to(fine, chains[i], a);
    const CurveChain& c = chains[i];
    const Vec3 &first = fine.points[c.points.front()], &last = fine.points[c.points.back()];
    const auto near = [&](const Vec3& p, const Vec3& q) { return norm(p - q) <= tolerance; };
    bool forward = near(first, a) && near(last, b);
    if (!forward && !(near(first, b) && near(last, a))) continue;
    if (m.closed()) {
      const Vec3 early = pair.motion(fine.points[m.points[1]]);
      forward = nearest_place(fine, c, early).first < static_cast<double>(c.points.size() - 1) / 2;
    }
    const double distance = nearest_place(fine, c, middle).second;
    if (distance < least) best = {i, master, forward, pair.motion};
    least = std::min(least, distance);
  }
  return best;
}

}  // namespace

std::vector<ChainPair> pair_chains(const Mesh& fine, std::vector<CurveChain>& chains,
                                   const std::vector<PeriodicPair>& periodic) {
  std::vector<ChainPair> pairs;
  const double tolerance = kPeriodicTolerance * diagonal(fine);
  for (const PeriodicPair& pair : periodic) {
    const std::vector<int> others = chains_named(fine, chains, pair, pair.to);
    for (const int m : chains_named(fine, chains, pair, pair.from)) {
      const auto found = image_of(fine, chains, pair, m, others, tolerance);
      const Vec3 &a = fine.points[chains[m].points.front()], &b = fine.points[chains[m].points.back()];
      if (!found)
        throw InputError(fmt::format(
            "{}: the sides do not match: curve {} of '{}' from ({:.10g}, {:.10g}, {:.10g}) to ({:.10g}, "
            "{:.10g}, "
            "{:.10g}) has no image in '{}'",
            pair.where, fine.curves[chains[m].curve].tag, pair.from, a.x, a.y, a.z, b.x, b.y, b.z, pair.to));
      for (const ChainPair& known : pairs)
        if (known.chain == found->chain || known.chain == m || known.master == found->chain)
          throw InputError(fmt::format("{}: curve {} would be an image twice, or an image and have one",
                                       pair.where, fine.curves[chains[known.chain].curve].tag));
      pairs.push_back(*found);
    }
  }
  return pairs;
}

std::vector<CurveDemand> joined_demands(std::vector<CurveDemand> demands,
                                        const std::vector<ChainPair>& pairs) {
  for (const ChainPair& pair : pairs) {
    CurveDemand &master = demands[pair.master], &image = demands[pair.chain];
    master.patches.insert(master.patches.end(), image.patches.begin(), image.patches.end());
    master.minimum = std::max(master.minimum, image.minimum);
    image.patches.clear();
  }
  return demands;
}

std::vector<double> image_places(const Mesh& fine, const std::vector<CurveChain>& chains,
                                 const ChainPair& pair, const std::vector<double>& master_places) {
  std::vector<double> places;
  for (const double s : master_places)
    places.push_back(
        nearest_place(fine, chains[pair.chain], pair.motion(fine_point_at(fine, chains[pair.master], s)))
            .first);
  if (!pair.forward) std::ranges::reverse(places);
  places.front() = 0;
  places.back() = static_cast<double>(chains[pair.chain].points.size() - 1);
  return places;
}

void place_images(const Mesh& fine, const std::vector<CurveChain>& chains,
                  const std::vector<ChainPair>& pairs, SurfaceNodes& nodes) {
  const double tolerance = kPeriodicTolerance * diagonal(fine);
  for (int round = 0; round < kImageRounds; ++round)
    for (const ChainPair& pair : pairs) {
      const auto &own = nodes.on_curve[pair.chain], &of = nodes.on_curve[pair.master];
      for (std::size_t k = 0; k < own.size(); ++k) {
        Vec3& x = nodes.points[own[pair.forward ? k : own.size() - 1 - k].node];
        const Vec3 image = pair.motion(nodes.points[of[k].node]);
        if (norm(x - image) > tolerance)
          throw InputError(fmt::format(
              "periodic sides do not match: the image of curve {} is {:.3g} away from curve {} at ({:.10g}, "
              "{:.10g}, {:.10g})",
              fine.curves[chains[pair.master].curve].tag, norm(x - image),
              fine.curves[chains[pair.chain].curve].tag, x.x, x.y, x.z));
        x = image;
      }
    }
}

std::vector<PeriodicNodes> periodic_nodes(const std::vector<CurveChain>& chains,
                                          const std::vector<ChainPair>& pairs, const SurfaceNodes& nodes) {
  std::vector<PeriodicNodes> all;
  std::map<std::pair<int, int>, std::size_t> known;
  for (const ChainPair& pair : pairs) {
    const auto &own = nodes.on_curve[pair.chain], &of = nodes.on_curve[pair.master];
    if (own.size() != of.size()) continue;  // corners were capped
    const int curve = chains[pair.chain].curve, master = chains[pair.master].curve;
    const auto [at, is_new] = known.try_emplace({curve, master}, all.size());
    if (is_new) all.push_back({curve, master, pair.motion, {}});
    auto& linked = all[at->second].nodes;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::array<int, 2> two{own[pair.forward ? k : own.size() - 1 - k].node, of[k].node};
      if (std::ranges::find(linked, two) == linked.end()) linked.push_back(two);
    }
  }
  return all;
}

}  // namespace delquad
