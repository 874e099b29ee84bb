#include "patches/tube_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "fields/surface/surface_size.h"

namespace delquad {

namespace {

/// Edges around a tube; growth of sizes away from the cut; the least size at a tip, as a part of the size.
constexpr double kAroundTube = 4, kGrowth = 0.2, kTipPart = 1.0 / 8;
/// Below this angle around a tip (radians) the surface is a cone there, as for sharp_tips().
constexpr double kPointed = 2 * std::numbers::pi - 0.5;
constexpr double kNone = std::numeric_limits<double>::max();

/// The two sides of one line of a cut.
struct Seam {
  const CurveSide *forward = nullptr, *backward = nullptr;
};

class TubePatch {
 public:
  TubePatch(const Mesh& fine, const FlatPatch& map, const SizeField& size)
      : fine_(fine), map_(map), size_(size), limit_(map.flat.points.size(), kNone) {}

  /// The lines of one curve that both have the patch on either side.
  void add_cut(const std::vector<Seam>& lines) {
    bool has_tip = false, is_pointed = false;
    double widest = 0, tip_size = kNone;
    std::vector<std::pair<int, double>> found;
    int hint = -1;
    for (const Seam& s : lines) {
      for (const auto& [v, w] :
           {std::pair(s.forward->from, s.backward->to), std::pair(s.forward->to, s.backward->from)}) {
        if (v == w) {
          has_tip = true, tip_size = kTipPart * size_.at(space(v), hint);
          is_pointed = is_pointed || angle_around(v) < kPointed;
        }
        if (!faces(*s.forward, v, w) || !faces(*s.backward, w, v)) continue;
        const double width = norm(flat(w) - flat(v)) / stretch(s) / kAroundTube;
        widest = std::max(widest, width);
        found.emplace_back(v, width);
        found.emplace_back(w, width);
      }
    }
    // Without a way around but at the tip the cut closes no tube: a slit does not even make a cone.
    if (widest == 0 && !is_pointed) return;
    const double least = widest == 0 ? tip_size : has_tip ? std::min(tip_size, widest) : 0;
    for (const auto& [v, width] : found) limit_[v] = std::min(limit_[v], std::max(width, least));
  }

  /// Spread from the cuts over the patch; empty where it is nowhere below the size.
  std::vector<double> sizes() {
    int hint = -1;
    bool asks = false;
    for (size_t v = 0; v < limit_.size() && !asks; ++v)
      asks = limit_[v] < kNone && limit_[v] < size_.at(space(static_cast<int>(v)), hint);
    if (!asks) return {};
    Mesh surface;
    for (size_t v = 0; v < limit_.size(); ++v) surface.points.push_back(space(static_cast<int>(v)));
    surface.triangles = map_.flat.triangles;
    limit_slope(surface, kGrowth, limit_);
    return std::move(limit_);
  }

 private:
  Vec2 flat(int v) const { return map_.flat.points[v]; }
  Vec3 space(int v) const { return fine_.points[map_.fine_node[v]]; }

  /// In space (radians).
  double angle_around(int v) const {
    double sum = 0;
    for (const auto& t : map_.flat.triangles)
      for (int k = 0; k < 3; ++k) {
        if (t[k] != v) continue;
        const Vec3 a = space(t[(k + 1) % 3]) - space(v), b = space(t[(k + 2) % 3]) - space(v);
        sum += std::atan2(norm(cross(a, b)), dot(a, b));
      }
    return sum;
  }

  /// Does the straight way from v, an end of the side, to w lead into the patch?
  bool faces(const CurveSide& side, int v, int w) const {
    return v == w || dot(perp(flat(side.to) - flat(side.from)), flat(w) - flat(v)) > 0;
  }

  /// Parameter length over length in space.
  double stretch(const Seam& s) const {
    const auto in_plane = [&](const CurveSide& side) { return norm(flat(side.to) - flat(side.from)); };
    const double in_space = norm(space(s.forward->to) - space(s.forward->from));
    return in_space > 0 ? (in_plane(*s.forward) + in_plane(*s.backward)) / 2 / in_space : 1;
  }

  const Mesh& fine_;
  const FlatPatch& map_;
  const SizeField& size_;
  std::vector<double> limit_;
};

}  // namespace

std::vector<std::vector<double>> tube_sizes(const Mesh& fine, const std::vector<CurveChain>& chains,
                                            const std::vector<FlatPatch>& maps,
                                            const std::vector<PatchOutline>& outlines,
                                            const SizeField& size) {
  std::vector<std::vector<double>> sizes(maps.size());
  for (size_t p = 0; p < maps.size(); ++p) {
    std::map<int, std::vector<Seam>> sides_of;  // by curve
    for (const auto& loop : outlines[p])
      for (const CurveSide& side : loop) {
        auto& lines = sides_of[side.chain];
        lines.resize(chains[side.chain].points.size() - 1);
        (side.forward ? lines[side.line].forward : lines[side.line].backward) = &side;
      }
    TubePatch patch(fine, maps[p], size);
    for (auto& [chain, lines] : sides_of) {
      // A cut that ends at this one may leave another patch beside a part of it.
      std::erase_if(lines, [](const Seam& s) { return s.forward == nullptr || s.backward == nullptr; });
      if (!lines.empty()) patch.add_cut(lines);
    }
    sizes[p] = patch.sizes();
  }
  return sizes;
}

}  // namespace delquad
