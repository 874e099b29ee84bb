#include "features/periodic/paired_lines.h"

#include <fmt/format.h>

#include <cassert>

#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {
namespace {

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
              moved(piece.motion, chain_.nodes[master.ends[k]]);
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
    const bool is_region = name.starts_with("region_") ||
                           std::ranges::find(model_.loops, name, &ModelLoop::region) != model_.loops.end();
    const std::vector<Entity> curves = curve_entities(model_);
    if (is_region && entities_named(curves, "curve", name).empty())
      throw InputError(fmt::format(
          "{}: '{}' is a region of a planar model, whose sides are curves: expected a curve's name",
          pair.where, name));
    const std::vector<int> meant = find_entities(curves, "curve", name, pair.where);
    std::vector<int> found;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (std::ranges::find_first_of(pieces_[i].curves, meant) != pieces_[i].curves.end())
        found.push_back(static_cast<int>(i));
    return found;
  }

  /// The piece at the image of a master.
  int image(const PeriodicPair& pair, int master, const std::vector<int>& others) {
    const CurvePiece& m = pieces_[master];
    const Vec2 a = moved(pair.motion, chain_.nodes[m.ends[0]]);
    const Vec2 b = moved(pair.motion, chain_.nodes[m.ends[1]]);
    const Vec2 middle = moved(pair.motion, m.shape->point((m.from + m.to) / 2));
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
        "'{}', which would run from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g}) [periodic-mismatch]",
        pair.where, label(master), pair.from, chain_.nodes[m.ends[0]].x, chain_.nodes[m.ends[0]].y,
        chain_.nodes[m.ends[1]].x, chain_.nodes[m.ends[1]].y, pair.to, a.x, a.y, b.x, b.y));
  }

  /// Of closed curves, which begin and end at the same node.
  static bool runs_as(const CurvePiece& p, const CurvePiece& master, const Motion& motion) {
    const Vec2 early = moved(motion, master.shape->point(master.from + 0.1 * (master.to - master.from)));
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

void pair_pieces(const PlanarModel& model, const std::vector<PeriodicPair>& periodic, ModelChain& chain,
                 std::vector<CurvePiece>& pieces) {
  Pairing pairing(model, chain, pieces);
  for (const PeriodicPair& pair : periodic) pairing.pair(pair);
  pairing.finish();
}

void add_node_pairs(int curve, int master, const Motion& motion, const std::vector<int>& images,
                    const std::vector<int>& masters, std::vector<PeriodicNodes>& all) {
  assert(images.size() == masters.size());
  auto at = std::ranges::find_if(
      all, [&](const PeriodicNodes& p) { return p.curve == curve && p.master == master; });
  if (at == all.end()) at = all.insert(all.end(), {curve, master, motion, {}});
  for (std::size_t k = 0; k < images.size(); ++k) {
    const std::array two{images[k], masters[k]};
    if (std::ranges::find(at->nodes, two) == at->nodes.end()) at->nodes.push_back(two);
  }
}

void add_pairs_of_pieces(const std::vector<CurvePiece>& pieces, std::size_t n_ends, Mesh& mesh) {
  std::vector<std::vector<int>> nodes;
  int next = static_cast<int>(n_ends);
  for (const CurvePiece& piece : pieces) {
    auto& own = nodes.emplace_back(1, piece.ends[0]);
    for (std::size_t k = 0; k < piece.interior.size(); ++k) own.push_back(next++);
    own.push_back(piece.ends[1]);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const CurvePiece& piece = pieces[i];
    if (piece.master < 0 || piece.image) continue;
    if (!piece.runs_as_master) std::ranges::reverse(nodes[i]);
    add_node_pairs(piece.curve, pieces[piece.master].curve, piece.motion, nodes[i], nodes[piece.master],
                   mesh.periodic);
  }
}

}  // namespace delquad
