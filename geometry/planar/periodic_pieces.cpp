#include <fmt/format.h>

#include <algorithm>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {
namespace {

Vec2 image_of(const Motion& motion, Vec2 p) {
  const Vec3 x = motion({p.x, p.y, 0});
  return {x.x, x.y};
}

class Pairing {
 public:
  Pairing(const PlanarModel& model, ModelChain& chain, std::vector<CurvePiece>& pieces)
      : model_(model),
        chain_(chain),
        pieces_(pieces),
        tolerance_(kTouch * norm(Box<Vec2>::around(std::span(chain.nodes)).size())) {}

  void pair(const PeriodicPair& pair) {
    const std::vector<int> masters = pieces_of(pair, pair.from), others = pieces_of(pair, pair.to);
    for (const int m : masters) {
      const int i = image(pair, m, others);
      if (pieces_[i].master >= 0 || pieces_[i].is_divided)
        throw InputError(
            fmt::format("{}: {} gets its nodes twice: expected one division, or one curve of which "
                        "it is the image",
                        pair.where, label(i)));
      pieces_[i].master = m;
      pieces_[i].motion = pair.motion;
      paired_.push_back(i);
    }
    if (masters.size() != others.size())
      throw InputError(fmt::format("{}: '{}' is more than the image of '{}': {} pieces, and not {}",
                                   pair.where, pair.to, pair.from, others.size(), masters.size()));
  }

  /// Corners may be images of corners that are images.
  void finish() {
    for (std::size_t round = 0; round < 4; ++round)
      for (const int i : paired_) {
        CurvePiece& piece = pieces_[i];
        const CurvePiece& master = pieces_[piece.master];
        for (const int k : {0, 1})
          chain_.nodes[piece.ends[piece.runs_as_master ? k : 1 - k]] =
              image_of(piece.motion, chain_.nodes[master.ends[k]]);
      }
    for (const int i : paired_) {
      CurvePiece& piece = pieces_[i];
      CurvePiece& master = pieces_[piece.master];
      if (master.master >= 0)
        throw InputError(
            fmt::format("{}{} is the image of {}, and {} that of it: expected the first as 'from'",
                        message_prefix(model_), label(piece.master), label(master.master), label(i)));
      master.least = std::max(master.least, piece.least);
    }
  }

 private:
  std::string label(int piece) const { return curve_label(model_, pieces_[piece].curves.front()); }

  std::vector<int> pieces_of(const PeriodicPair& pair, const std::string& name) const {
    std::vector<int> found;
    std::vector<std::string> known;
    const auto is_meant = [&](int c) {
      return model_.curves[c].name == name || fmt::format("curve_{}", c + 1) == name;
    };
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      for (const int c : pieces_[i].curves) known.push_back(model_.curves[c].name);
      if (std::ranges::any_of(pieces_[i].curves, is_meant)) found.push_back(static_cast<int>(i));
    }
    const bool is_region = name.starts_with("region_") ||
                           std::ranges::find(model_.loops, name, &ModelLoop::region) != model_.loops.end();
    if (found.empty() && is_region)
      throw InputError(fmt::format(
          "{}: '{}' is a region of a planar model, whose sides are curves: expected a curve's name",
          pair.where, name));
    if (found.empty())
      throw InputError(
          fmt::format("{}: no curve is called '{}'{}", pair.where, name, suggestion_or_all(name, known)));
    return found;
  }

  /// The piece at the image of a master.
  int image(const PeriodicPair& pair, int master, const std::vector<int>& others) {
    const CurvePiece& m = pieces_[master];
    const Vec2 a = image_of(pair.motion, chain_.nodes[m.ends[0]]);
    const Vec2 b = image_of(pair.motion, chain_.nodes[m.ends[1]]);
    const Vec2 middle = image_of(pair.motion, m.shape->point((m.from + m.to) / 2));
    for (const int i : others) {
      CurvePiece& p = pieces_[i];
      const auto is_at = [&](int end, Vec2 x) { return norm(chain_.nodes[p.ends[end]] - x) <= tolerance_; };
      const bool forward = is_at(0, a) && is_at(1, b), backward = is_at(0, b) && is_at(1, a);
      if (!forward && !backward) continue;
      if (CurveSpan(*p.shape, p.from, p.to).nearest(middle).distance > tolerance_) continue;
      p.runs_as_master = forward;
      if (forward && backward) p.runs_as_master = runs_as(p, m, pair.motion);
      return i;
    }
    throw InputError(fmt::format(
        "{}: the sides do not match: {} of '{}' from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g}) has no image "
        "in "
        "'{}', which would run from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g})",
        pair.where, label(master), pair.from, chain_.nodes[m.ends[0]].x, chain_.nodes[m.ends[0]].y,
        chain_.nodes[m.ends[1]].x, chain_.nodes[m.ends[1]].y, pair.to, a.x, a.y, b.x, b.y));
  }

  /// Of closed curves, which begin and end at the same node.
  static bool runs_as(const CurvePiece& p, const CurvePiece& master, const Motion& motion) {
    const Vec2 early = image_of(motion, master.shape->point(master.from + 0.1 * (master.to - master.from)));
    const double middle = (p.from + p.to) / 2;
    return CurveSpan(*p.shape, p.from, middle).nearest(early).distance <=
           CurveSpan(*p.shape, middle, p.to).nearest(early).distance;
  }

  const PlanarModel& model_;
  ModelChain& chain_;
  std::vector<CurvePiece>& pieces_;
  double tolerance_;
  std::vector<int> paired_;
};

}  // namespace

void pair_periodic(const PlanarModel& model, std::span<const PeriodicPair> periodic, ModelChain& chain,
                   std::vector<CurvePiece>& pieces) {
  Pairing pairing(model, chain, pieces);
  for (const PeriodicPair& pair : periodic) pairing.pair(pair);
  pairing.finish();
}

void follow_masters(const PlanarModel& model, std::vector<CurvePiece>& pieces) {
  for (CurvePiece& piece : pieces) {
    if (piece.master < 0) continue;
    const CurvePiece& master = pieces[piece.master];
    piece.n = master.n;
    piece.images.clear();
    piece.interior.clear();
    if (piece.image) {
      piece.interior = master.interior;
      for (const double t : piece.interior) piece.images.push_back(piece.shape->point(t));
      continue;
    }
    const CurveSpan span(*piece.shape, piece.from, piece.to);
    const double tolerance = kTouch * norm(span.box().size());
    for (const double t : master.interior) {
      piece.images.push_back(image_of(piece.motion, master.shape->point(t)));
      const CurveSpan::Place place = span.nearest(piece.images.back());
      piece.interior.push_back(place.t);
      if (place.distance > tolerance)
        throw InputError(fmt::format(
            "{}the sides do not match: the image of {} is {:.3g} away from {} at ({:.10g}, {:.10g})",
            message_prefix(model), curve_label(model, master.curves.front()), place.distance,
            curve_label(model, piece.curves.front()), place.at.x, place.at.y));
    }
    if (piece.runs_as_master) continue;
    std::ranges::reverse(piece.images);
    std::ranges::reverse(piece.interior);
  }
}

}  // namespace delquad
