// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sort_unique.h"
#include "features/periodic/paired_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/segment.h"
#include "delquad/error.h"

namespace delquad {
namespace {

/// The pieces that begin with one of the lines.
std::vector<int> chains_on(const Mesh& fine, const std::vector<CurveChain>& chains,
                           const std::vector<int>& lines) {
  std::set<std::array<int, 2>> sides;
  for (const int l : lines) sides.insert(side_of(fine.lines[l][0], fine.lines[l][1]));
  std::vector<int> found;
  for (std::size_t c = 0; c < chains.size(); ++c)
    if (sides.contains(side_of(chains[c].points[0], chains[c].points[1])))
      found.push_back(static_cast<int>(c));
  return found;
}

/// The place on the chain next to x, and how far it is.
std::pair<double, double> nearest_place(const Mesh& fine, const CurveChain& chain, const Vec3& x) {
  std::pair<double, double> best{0, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
    const Vec3 &a = fine.points[chain.points[i]], &b = fine.points[chain.points[i + 1]];
    const double t = nearest_part(x, a, b), distance = norm(a + t * (b - a) - x);
    if (distance < best.second) best = {static_cast<double>(i) + t, distance};
  }
  return best;
}

Vec3 middle_of(const Mesh& fine, const CurveChain& chain) {
  return fine_point_at(fine, chain, 0.5 * static_cast<double>(chain.points.size() - 1));
}

/// Finds images of pieces.
class ChainImages {
 public:
  ChainImages(const Mesh& fine, const std::vector<CurveChain>& chains)
      : fine_(fine), chains_(chains), tolerance_(kPeriodicTolerance * diagonal(fine)) {}

  /// Pairs each master with one of the others, or with itself where it stays.
  std::vector<ChainPair> pair(const PeriodicPair& pair, const std::vector<int>& masters,
                              const std::vector<int>& others) const {
    std::vector<ChainPair> pairs;
    std::set<int> taken;
    for (const int m : masters) {
      const auto found = stays(m, pair.motion) ? ChainPair{m, m, true, pair.motion} : image(pair, m, others);
      if (!taken.insert(found.chain).second)
        throw InputError(
            fmt::format("{}: the sides do not match: curve {} is the image of two curves [periodic-mismatch]",
                        pair.where, fine_.curves[chains_[found.chain].curve].tag));
      pairs.push_back(found);
    }
    for (const int i : others)
      if (!taken.contains(i))
        throw InputError(fmt::format(
            "{}: the sides do not match: {} of '{}' is the image of no curve of '{}' [periodic-mismatch]",
            pair.where, label(i), pair.to, pair.from));
    return pairs;
  }

  std::string label(int chain) const {
    const CurveChain& c = chains_[chain];
    const Vec3 &a = fine_.points[c.points.front()], &b = fine_.points[c.points.back()];
    return fmt::format("curve {} from ({:.10g}, {:.10g}, {:.10g}) to ({:.10g}, {:.10g}, {:.10g})",
                       fine_.curves[c.curve].tag, a.x, a.y, a.z, b.x, b.y, b.z);
  }
  bool are_near(const Vec3& p, const Vec3& q) const { return norm(p - q) <= tolerance_; }
  /// The beginning, a place after it, the end.
  std::array<Vec3, 3> marks(int chain) const {
    const auto& p = chains_[chain].points;
    return {fine_.points[p.front()], fine_point_at(fine_, chains_[chain], 0.5), fine_.points[p.back()]};
  }

 private:
  bool stays(int chain, const Motion& motion) const {
    return std::ranges::all_of(chains_[chain].points,
                               [&](int v) { return are_near(motion(fine_.points[v]), fine_.points[v]); });
  }

  ChainPair image(const PeriodicPair& pair, int master, const std::vector<int>& others) const {
    const CurveChain& m = chains_[master];
    const Vec3 a = pair.motion(fine_.points[m.points.front()]);
    const Vec3 b = pair.motion(fine_.points[m.points.back()]), middle = pair.motion(middle_of(fine_, m));
    std::optional<ChainPair> best;
    double least = std::numeric_limits<double>::infinity();
    for (const int i : others) {
      if (chains_[i].closed() != m.closed() || i == master) continue;
      const CurveChain& c = chains_[i];
      const Vec3 &first = fine_.points[c.points.front()], &last = fine_.points[c.points.back()];
      bool forward = are_near(first, a) && are_near(last, b);
      if (!forward && !(are_near(first, b) && are_near(last, a))) continue;
      if (m.closed()) {
        const Vec3 early = pair.motion(fine_.points[m.points[1]]);
        forward = nearest_place(fine_, c, early).first < static_cast<double>(c.points.size() - 1) / 2;
      }
      const double distance = nearest_place(fine_, c, middle).second;
      if (distance < least) best = {i, master, forward, pair.motion};
      least = std::min(least, distance);
    }
    if (!best)
      throw InputError(
          fmt::format("{}: the sides do not match: {} of '{}' has no image in '{}' [periodic-mismatch]",
                      pair.where, label(master), pair.from, pair.to));
    return *best;
  }

  const Mesh& fine_;
  const std::vector<CurveChain>& chains_;
  double tolerance_;
};

/// Sorts the pairs so that masters come before their images, each of which stays once. Throws where the
/// others say something else.
class PairForest {
 public:
  struct RequestedPair {
    ChainPair pair;
    const PeriodicPair* of;
  };
  PairForest(const ChainImages& images, const std::vector<CurveChain>& chains,
             std::vector<RequestedPair> asked)
      : images_(images), asked_(std::move(asked)), root_(chains.size(), -1), of_root_(chains.size()) {}

  std::vector<ChainPair> sorted() {
    std::vector<char> is_image(root_.size(), 0);
    for (const RequestedPair& a : asked_) is_image[a.pair.chain] = 1;
    std::vector<int> reached;
    for (std::size_t c = 0; c < root_.size(); ++c)
      if (!is_image[c]) {
        root_[c] = static_cast<int>(c);
        of_root_[c] = images_.marks(static_cast<int>(c));
        reached.push_back(static_cast<int>(c));
      }
    std::vector<ChainPair> pairs;
    for (std::size_t next = 0; next < reached.size(); ++next)
      for (const RequestedPair& a : asked_) {
        if (a.pair.master != reached[next]) continue;
        if (add(a)) {
          pairs.push_back(a.pair);
          reached.push_back(a.pair.chain);
        }
      }
    for (const RequestedPair& a : asked_)
      if (root_[a.pair.chain] < 0)
        throw InputError(fmt::format("{}: {} is an image of its own image: expected one of the two as 'from'",
                                     a.of->where, images_.label(a.pair.chain)));
    return pairs;
  }

 private:
  /// False where the image is known already, by other pairs.
  bool add(const RequestedPair& a) {
    const int chain = a.pair.chain, master = a.pair.master;
    std::array<Vec3, 3> marks = of_root_[master];
    for (Vec3& x : marks) x = a.pair.motion(x);
    const bool is_new = root_[chain] < 0;
    if (is_new) {
      root_[chain] = root_[master];
      of_root_[chain] = marks;
      return true;
    }
    if (root_[chain] != root_[master])
      throw InputError(fmt::format(
          "{}: {} would be the image of two curves that are not images of each other: expected one of them",
          a.of->where, images_.label(chain)));
    for (std::size_t k = 0; k < marks.size(); ++k)
      if (!images_.are_near(marks[k], of_root_[chain][k]))
        throw InputError(
            fmt::format("{}: the motions of periodic sides do not fit together: two ways to {} differ by "
                        "{:.3g}",
                        a.of->where, images_.label(chain), norm(marks[k] - of_root_[chain][k])));
    return false;
  }

  const ChainImages& images_;
  std::vector<RequestedPair> asked_;
  std::vector<int> root_;                     ///< of each piece that has been reached
  std::vector<std::array<Vec3, 3>> of_root_;  ///< the images of its root's marks
};

}  // namespace

ChainPairs pair_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                       const std::vector<PairedChains>& sides) {
  const ChainImages images(fine, chains);
  ChainPairs result;
  std::vector<PairForest::RequestedPair> asked;
  for (const PairedChains& side : sides) {
    const std::vector<ChainPair>& found =
        result.of_sides.emplace_back(images.pair(side.of, side.from, side.to));
    for (const ChainPair& pair : found)
      if (pair.chain != pair.master) asked.push_back({pair, &side.of});
  }
  result.pairs = PairForest(images, chains, std::move(asked)).sorted();
  return result;
}

ChainPairs pair_chains(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                       const std::vector<int>& cut_face, const PeriodicSides& periodic) {
  const auto first_cut = std::ranges::find_if(cut_face, [](int f) { return f >= 0; });
  const auto n_curves = static_cast<std::size_t>(first_cut - cut_face.begin());
  std::vector<PairedChains> sides;
  for (std::size_t i = 0; i < n_pairs(periodic); ++i) {
    const PairedLines lines = paired_lines(model.fine, periodic, i, n_curves);
    sides.push_back(
        {chains_on(model.fine, chains, lines.from), chains_on(model.fine, chains, lines.to), lines.of});
  }
  return pair_chains(model.fine, chains, sides);
}

void place_as_masters(const Mesh& fine, const SurfaceCurves& curves,
                      const std::vector<SizeIntegral>& integrals, CurvePlaces& places) {
  assert(integrals.size() == curves.chains.size() && places.size() == curves.chains.size());
  for (const ChainPair& pair : curves.images) {
    const SizeIntegral &own = integrals[pair.chain], &of = integrals[pair.master];
    const CurveChain &chain = curves.chains[pair.chain], &master = curves.chains[pair.master];
    const double n = static_cast<double>(places[pair.master].size() - 1);
    std::vector<double> at;
    for (const double place : places[pair.master])
      at.push_back(
          nearest_place(fine, chain, pair.motion(fine_point_at(fine, master, of.s_at(place / n)))).first);
    if (!pair.forward) std::ranges::reverse(at);
    at.front() = 0;
    at.back() = static_cast<double>(chain.points.size() - 1);
    for (double& s : at) s = n * own.part_at(s);
    places[pair.chain] = std::move(at);
  }
}

void place_images(const SurfaceModel& model, const SurfaceCurves& curves, SurfaceNodes& nodes) {
  const Mesh& fine = model.fine;
  const double tolerance = kPeriodicTolerance * diagonal(fine);
  // Corners may be images of corners that are images by a later pair.
  for (int round = 0; round < kRoundsOfChains; ++round)
    for (const ChainPair& pair : curves.images) {
      const auto &own = nodes.on_curve[pair.chain], &of = nodes.on_curve[pair.master];
      assert(own.size() == of.size());
      for (std::size_t k = 0; k < own.size(); ++k) {
        Vec3& x = nodes.points[own[pair.forward ? k : own.size() - 1 - k].node];
        const Vec3 image = pair.motion(nodes.points[of[k].node]);
        double off = norm(x - image);
        if (off > tolerance && model.projector)
          off = norm(model.projector->to_curve(curves.chains[pair.chain].curve, image) - image);
        if (off > tolerance)
          throw InputError(fmt::format(
              "periodic sides do not match: the image of curve {} is {:.3g} away from curve {} at ({:.10g}, "
              "{:.10g}, {:.10g}), and {:.3g} is the most there may be [periodic-mismatch]",
              fine.curves[curves.chains[pair.master].curve].tag, off,
              fine.curves[curves.chains[pair.chain].curve].tag, x.x, x.y, x.z, tolerance));
        x = image;
      }
    }
}

namespace {

/// An image of a face has the sharp corners of that.
void add_image_corners(const SurfaceCurves& curves, const std::vector<ChainPair>& chains,
                       const PeriodicFaces& face, std::vector<SharpCorner>& corners) {
  for (std::size_t i = 0, n = corners.size(); i < n; ++i) {
    SharpCorner corner = corners[i];
    if (corner.face != face.master) continue;
    corner.face = face.face;
    for (const auto& [node, of] : face.nodes)
      if (of == corners[i].node) corner.node = node;
    for (int& curve : corner.curves) {
      const auto at = std::ranges::find(
          chains, curve, [&](const ChainPair& pair) { return curves.chains[pair.master].curve; });
      if (at != chains.end()) curve = curves.chains[at->chain].curve;
    }
    corners.push_back(corner);
  }
}

/// The nodes of an image, each beside its master. `nodes`: the nodes of all chains.
std::vector<std::array<int, 2>> node_pairs(const std::vector<CurveChain>& nodes, const ChainPair& pair) {
  std::vector<int> images = nodes[pair.chain].points;
  const std::vector<int>& masters = nodes[pair.master].points;
  if (images.size() != masters.size()) throw std::logic_error("a periodic curve has lost nodes");
  if (!pair.forward) std::ranges::reverse(images);
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t k = 0; k < images.size(); ++k) pairs.push_back({images[k], masters[k]});
  return pairs;
}

}  // namespace

void add_pairs_of_chains(const std::vector<CurveChain>& nodes, const std::vector<ChainPair>& pairs,
                         std::vector<PeriodicNodes>& all) {
  for (const ChainPair& pair : pairs) {
    const int curve = nodes[pair.chain].curve, master = nodes[pair.master].curve;
    auto at = std::ranges::find_if(
        all, [&](const PeriodicNodes& p) { return p.curve == curve && p.master == master; });
    if (at == all.end()) at = all.insert(all.end(), {curve, master, pair.motion, {}});
    for (const std::array<int, 2>& two : node_pairs(nodes, pair))
      if (std::ranges::find(at->nodes, two) == at->nodes.end()) at->nodes.push_back(two);
  }
}

void add_pairs(const SurfaceCurves& curves, const PeriodicSides& periodic,
               const std::vector<std::vector<ChainPair>>& of_sides, SurfaceDomain& domain) {
  std::vector<CurveChain> nodes;
  for (std::size_t c = 0; c < curves.chains.size(); ++c) {
    nodes.push_back({curves.chains[c].curve, {}});
    for (const CurveNode& n : domain.nodes.on_curve[c]) nodes[c].points.push_back(n.node);
  }
  add_pairs_of_chains(nodes, curves.images, domain.boundary.periodic);
  for (std::size_t i = 0; i < periodic.faces.size(); ++i) {
    const FacePair& pair = periodic.faces[i];
    const std::vector<ChainPair>& chains = of_sides[periodic.curves.size() + i];
    PeriodicFaces face{pair.face, pair.master, pair.of.motion, pair.is_reversed, {}};
    for (const ChainPair& both : chains)
      for (const std::array<int, 2>& two : node_pairs(nodes, both)) face.nodes.push_back(two);
    sort_unique(face.nodes);
    add_image_corners(curves, chains, face, domain.sharp_corners);
    domain.boundary.periodic_faces.push_back(std::move(face));
  }
}

}  // namespace delquad
