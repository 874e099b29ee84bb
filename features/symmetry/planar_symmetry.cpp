// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/planar_symmetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"
#include "features/curves/flat_model.h"
#include "features/divisions/divisions.h"
#include "features/symmetry/mirror_match.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {
namespace {

/// Curves are seen by so many points.
constexpr int kSamplesOfCurve = 32;

/// The parameters of the corners of a curve, and of its ends.
std::vector<double> corner_parameters(const Curve& shape) {
  std::vector<double> corners{0};
  const std::vector<double> inside = shape.fixed_parameters();
  corners.insert(corners.end(), inside.begin(), inside.end());
  corners.push_back(1);
  return corners;
}

}  // namespace

Symmetry::Symmetry(std::vector<SymmetryPlane> planes, const PlanarModel& model)
    : SymmetryPlanes(std::move(planes)), tolerance_(kTouch * norm(box_of(model, kSamplesOfCurve).size())) {}

Vec2 Symmetry::reflect(int folds, Vec2 x) const {
  const Vec3 image = reflect_all(folds, {x.x, x.y, 0});
  return {image.x, image.y};
}

Vec2 Symmetry::put_on(int plane, Vec2 x) const {
  const Vec3 on = SymmetryPlanes::put_on(plane, {x.x, x.y, 0});
  return {on.x, on.y};
}

std::array<Vec2, 2> Symmetry::axis(int plane, const Box<Vec2>& box) const {
  const Vec2 along = perp({normal(plane).x, normal(plane).y}),
             middle = put_on(plane, 0.5 * (box.low + box.high));
  const double reach = norm(box.size());
  return {middle - reach * along, middle + reach * along};
}

std::vector<SymmetryPlane> find_symmetry(const PlanarModel& model, const PlanarDomain& domain,
                                         SymmetrySpec spec, std::vector<Warning>& warnings) {
  for (SymmetryPlane& p : spec.planes) p.point.z = p.normal.z = 0;
  std::vector<char> in_loop(model.curves.size(), 0);
  for (const ModelLoop& loop : model.loops)
    for (const int c : loop.curves) in_loop[c] = 1;
  SurfaceModel flat = flat_model(domain, model.source);
  flat.projector = flat_projector(domain, flat.fine);
  for (std::size_t c = 0; c < domain.model_curves.size(); ++c)
    if (std::ranges::none_of(domain.model_curves[c], [&](int m) { return in_loop[m] != 0; }))
      flat.embedded.push_back({static_cast<int>(c), 0});
  return find_symmetry_planes(spec, flat, true, warnings).planes;
}

namespace {

/// Where a curve that a plane cuts has nodes, their images need them, too. A closed curve that lies on one
/// side may begin anywhere.
void add_images_of_nodes(const ModelCurve& curve, const Symmetry& symmetry, PlanarModel& model) {
  const Vec2 begin = curve.shape->point(0);
  const int side = symmetry.folds_of(begin);
  bool is_cut = norm(curve.shape->point(1) - begin) > symmetry.tolerance();
  for (int k = 1; k < kSamplesOfCurve; ++k)
    is_cut |= symmetry.folds_of(curve.shape->point(static_cast<double>(k) / kSamplesOfCurve)) != side;
  if (!is_cut) return;
  for (const double t : corner_parameters(*curve.shape))
    for (int folds = 1; folds < 1 << symmetry.count(); ++folds) {
      const Vec2 image = symmetry.reflect(folds, curve.shape->point(t));
      if (std::ranges::none_of(
              model.points, [&](const ModelPoint& p) { return norm(p.at - image) <= symmetry.tolerance(); }))
        model.points.push_back({image, {}, {}});
    }
}

}  // namespace

PlanarModel with_axes(const PlanarModel& model, const Symmetry& symmetry) {
  PlanarModel result = model;
  for (const ModelCurve& curve : model.curves) add_images_of_nodes(curve, symmetry, result);
  const Box<Vec2> box = box_of(model, kSamplesOfCurve);
  for (int k = 0; k < symmetry.count(); ++k) {
    const auto [a, b] = symmetry.axis(k, box);
    result.curves.push_back({make_segment(a, b), {}, {}});
  }
  return result;
}

namespace {

/// The mirror image of a curve.
class ImageCurve final : public Curve {
 public:
  ImageCurve(std::shared_ptr<const Curve> shape, std::function<Vec2(Vec2)> image)
      : shape_(std::move(shape)), image_(std::move(image)) {}
  Vec2 point(double t) const override { return image_(shape_->point(t)); }
  std::vector<double> fixed_parameters() const override { return shape_->fixed_parameters(); }

 private:
  std::shared_ptr<const Curve> shape_;
  std::function<Vec2(Vec2)> image_;
};

/// Finds the piece that another is the image of, and makes it that.
class SymmetricPairs {
 public:
  SymmetricPairs(const Symmetry& symmetry, ModelChain& chain, std::vector<CurvePiece>& pieces)
      : symmetry_(symmetry),
        chain_(chain),
        pieces_(pieces),
        valence_(pieces_at_nodes(pieces, chain.nodes.size())) {}

  /// Whether there is one.
  bool pair(CurvePiece& piece, int folds) {
    const auto folded = [&](double s) {
      return symmetry_.reflect(folds, piece.shape->point(piece.from + s * (piece.to - piece.from)));
    };
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const CurvePiece& master = pieces_[i];
      const bool closed = piece.ends[0] == piece.ends[1];
      if (closed != (master.ends[0] == master.ends[1])) continue;
      const auto is_at = [&](int end, int node) {
        const Vec2 x = symmetry_.reflect(folds, chain_.nodes[piece.ends[end]]);
        return norm(chain_.nodes[master.ends[node]] - x) <= symmetry_.tolerance();
      };
      const bool forward = is_at(0, 0) && is_at(1, 1), backward = is_at(0, 1) && is_at(1, 0);
      const bool may_turn = closed && valence_[piece.ends[0]] == 2 && valence_[master.ends[0]] == 2;
      if (!forward && !backward && !may_turn) continue;
      const CurveSpan span(*master.shape, master.from, master.to);
      if (std::ranges::any_of(std::array{0.21, 0.5, 0.83}, [&](double s) {
            return span.nearest(folded(s)).distance > symmetry_.tolerance();
          }))
        continue;
      if (!forward && backward) std::swap(piece.ends[0], piece.ends[1]);
      replace_by_image(piece, static_cast<int>(i), folds);
      return true;
    }
    return false;
  }

 private:
  void replace_by_image(CurvePiece& piece, int index, int folds) {
    CurvePiece& master = pieces_[index];
    piece.master = index;
    piece.is_mirrored = true;
    const auto image = [folds, symmetry = symmetry_](Vec2 x) { return symmetry.reflect(folds, x); };
    piece.shape = std::make_shared<ImageCurve>(master.shape, image);
    piece.from = master.from;
    piece.to = master.to;
    master.least = std::max(master.least, piece.least);
    for (const int k : {0, 1})
      if (piece.ends[k] != master.ends[k]) chain_.nodes[piece.ends[k]] = image(chain_.nodes[master.ends[k]]);
  }

  const Symmetry& symmetry_;
  ModelChain& chain_;
  std::vector<CurvePiece>& pieces_;
  std::vector<int> valence_;
};

/// The number of edges nearest to n, below or above it, that divides a curve as symmetrically as its pieces
/// are; 0: none is near.
int symmetric_number(const std::vector<CurvePiece>& pieces, const std::vector<int>& own, int n, int step) {
  std::vector<double> lengths;
  for (const int i : own) {
    double length = 0;
    Vec2 last = pieces[i].shape->point(pieces[i].from);
    for (int k = 1; k <= kSamplesOfCurve; ++k) {
      const double part = static_cast<double>(k) / kSamplesOfCurve;
      const Vec2 next = pieces[i].shape->point((1 - part) * pieces[i].from + part * pieces[i].to);
      length += norm(next - last);
      last = next;
    }
    lengths.push_back(length);
  }
  constexpr int kFarthest = 64;
  for (int tries = 0; tries < kFarthest; ++tries) {
    n += step;
    if (n < static_cast<int>(own.size())) return 0;
    const auto places = division_places({.name = {}, .edges = n}, lengths, {});
    bool is_symmetric = true;
    for (std::size_t i = 0; i < own.size(); ++i)
      if (const auto master = std::ranges::find(own, pieces[own[i]].master); master != own.end())
        is_symmetric &= places[i].size() == places[master - own.begin()].size();
    if (is_symmetric) return n;
  }
  return 0;
}

/// Divided as its image is not.
InputError unlike_division(const PlanarModel& model, const std::string& where,
                           const std::vector<CurvePiece>& pieces, const CurvePiece& piece) {
  const CurvePiece& master = pieces[piece.master];
  const std::string label = curve_label(model, piece.curves.front());
  if (piece.curves.front() != master.curves.front())
    return InputError(fmt::format("{}: {} is divided, and not as {}, of which it is the mirror image", where,
                                  label, curve_label(model, master.curves.front())));
  std::vector<int> own;
  int n = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (std::ranges::find(pieces[i].curves, piece.curves.front()) != pieces[i].curves.end()) {
      own.push_back(static_cast<int>(i));
      n += pieces[i].n;
    }
  std::string expected;
  for (const int step : {-1, 1})
    if (const int good = symmetric_number(pieces, own, n, step); good > 0)
      expected += (expected.empty() ? ": expected " : " or ") + std::to_string(good);
  return InputError(
      fmt::format("{}: {} edges cannot divide {} symmetrically, which is cut into {} pieces at planes of "
                  "symmetry and images of its nodes{}",
                  where, n, label, own.size(), expected));
}

}  // namespace

std::vector<ChainPair> pair_symmetric(const PlanarModel& model, const Symmetry& symmetry,
                                      const std::string& where, ModelChain& chain,
                                      std::vector<CurvePiece>& pieces) {
  for (Vec2& x : chain.nodes)
    for (int k = 0; k < symmetry.count(); ++k)
      if (symmetry.is_on(k, x)) x = symmetry.put_on(k, x);
  SymmetricPairs pairs(symmetry, chain, pieces);
  for (CurvePiece& piece : pieces) {
    const Vec2 middle = piece.shape->point((piece.from + piece.to) / 2);
    const int folds = symmetry.folds_of(middle);
    if (folds == 0) continue;
    if (!pairs.pair(piece, folds))
      throw InputError(fmt::format(
          "{}: the model is not symmetric: {} has no mirror image at ({:.10g}, {:.10g}) [not-symmetric]",
          where, curve_label(model, piece.curves.front()), symmetry.reflect(folds, middle).x,
          symmetry.reflect(folds, middle).y));
  }
  for (const CurvePiece& piece : pieces)
    if (piece.master >= 0 && piece.is_divided &&
        (!pieces[piece.master].is_divided || pieces[piece.master].n != piece.n))
      throw unlike_division(model, where, pieces, piece);
  std::vector<ChainPair> images;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].master < 0) continue;
    pieces[i].is_divided = false;
    images.push_back({static_cast<int>(i), pieces[i].master, true, {}});
  }
  return images;
}

std::vector<PatchImage> patch_images(const std::vector<PatchBoundary>& patches, const Symmetry& symmetry,
                                     const std::string& where) {
  // The middle of the longest edge's ear would do; the mean of the points tells the side, for no patch
  // crosses a plane.
  const auto mean = [](const PatchBoundary& patch) {
    Vec2 sum;
    for (const Vec2 p : patch.points) sum = sum + p;
    return (1.0 / static_cast<double>(patch.points.size())) * sum;
  };
  std::vector<PatchImage> images;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const int folds = symmetry.folds_of(mean(patches[p]));
    if (folds == 0) continue;
    const std::vector<Vec2>& own = patches[p].points;
    std::vector<int> by_x(own.size());
    for (std::size_t i = 0; i < own.size(); ++i) by_x[i] = static_cast<int>(i);
    std::ranges::sort(by_x, {}, [&](int i) { return own[i].x; });
    const auto nearest = [&](Vec2 x) {
      int best = -1;
      double least = symmetry.tolerance();
      auto at = std::ranges::lower_bound(by_x, x.x - least, {}, [&](int i) { return own[i].x; });
      for (; at != by_x.end() && own[*at].x <= x.x + symmetry.tolerance(); ++at)
        if (const double d = norm(own[*at] - x); d < least) best = *at, least = d;
      return best;
    };
    PatchImage image{static_cast<int>(p),
                     -1,
                     {},
                     [folds, symmetry](Vec2 x) { return symmetry.reflect(folds, x); },
                     std::popcount(static_cast<unsigned>(folds)) % 2 == 1};
    for (std::size_t m = 0; m < patches.size() && image.master < 0; ++m) {
      if (patches[m].points.size() != own.size() || symmetry.folds_of(mean(patches[m])) != 0) continue;
      image.point.clear();
      for (const Vec2 x : patches[m].points) {
        const int found = nearest(image.motion(x));
        if (found < 0) break;
        image.point.push_back(found);
      }
      if (image.point.size() == own.size()) image.master = static_cast<int>(m);
    }
    if (image.master < 0)
      throw InputError(
          fmt::format("{}: the model is not symmetric: the region at ({:.4g}, {:.4g}) has no mirror image "
                      "[not-symmetric]",
                      where, mean(patches[p]).x, mean(patches[p]).y));
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace delquad
