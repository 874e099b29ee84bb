// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/sampled_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/box.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// Degree of the polynomials at Chebyshev's points, which are nearly optimal.
constexpr int kDegree = 12;
/// Number of first pieces: a prime, so that no periodic formula hides.
constexpr int kFirstPieces = 7;
/// Limit of halvings of a first piece, at a kink.
constexpr int kMostHalvingsOfPieces = 20;
/// Limit of pieces; a curve with more has no tangents.
constexpr std::size_t kMostPieces = 20'000;

/// Points on a piece, from begin to end, and weights of the barycentric formula.
struct ChebyshevPoints {
  std::array<double, kDegree + 1> at, weight;
  ChebyshevPoints() {
    for (int k = 0; k <= kDegree; ++k) {
      at[k] = k == 0 ? 0 : k == kDegree ? 1 : 0.5 * (1 - std::cos(k * std::numbers::pi / kDegree));
      weight[k] = (k % 2 == 0 ? 1.0 : -1.0) * (k == 0 || k == kDegree ? 0.5 : 1.0);
    }
  }
};

const ChebyshevPoints& chebyshev() {
  static const ChebyshevPoints points;
  return points;
}

struct SampledPiece {
  double begin, end;  ///< in [0, 1]
  std::array<Vec2, kDegree + 1> points;

  Vec2 point(double s) const {
    const ChebyshevPoints& c = chebyshev();
    const double u = (s - begin) / (end - begin);
    Vec2 sum{0, 0};
    double total = 0;
    for (int k = 0; k <= kDegree; ++k) {
      if (u == c.at[k]) return points[k];
      const double w = c.weight[k] / (u - c.at[k]);
      sum += w * points[k];
      total += w;
    }
    return (1 / total) * sum;
  }
};

class SampledCurve final : public Curve {
 public:
  explicit SampledCurve(std::vector<SampledPiece> pieces) : pieces_(std::move(pieces)) {}
  Vec2 point(double s) const override {
    const auto after =
        std::upper_bound(pieces_.begin() + 1, pieces_.end(), s,
                         [](double value, const SampledPiece& piece) { return value < piece.begin; });
    return (after - 1)->point(std::clamp(s, 0.0, 1.0));
  }

 private:
  std::vector<SampledPiece> pieces_;
};

/// Calls the function for all parameters of a generation of pieces at once.
class Sampler {
 public:
  Sampler(const CurveFunction& function, double t0, double t1) : function_(function), t0_(t0), t1_(t1) {}

  std::vector<Vec2> at(const std::vector<double>& parts) const {
    std::vector<double> t;
    for (const double s : parts) t.push_back(s < 1 ? t0_ + s * (t1_ - t0_) : t1_);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec2> points(t.size(), {kNone, kNone});
    function_(t, points);
    for (std::size_t i = 0; i < t.size(); ++i)
      if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y))
        throw InputError(fmt::format("the curve is ({}, {}) at t = {}: expected finite coordinates",
                                     points[i].x, points[i].y, t[i]));
    return points;
  }

 private:
  const CurveFunction& function_;
  double t0_, t1_;
};

/// Returns the places in a piece where its polynomial is compared with the function: halfway between
/// Chebyshev's points.
std::vector<double> test_places(const SampledPiece& piece) {
  std::vector<double> places;
  for (int k = 0; k < kDegree; ++k)
    places.push_back(piece.begin +
                     (chebyshev().at[k] + chebyshev().at[k + 1]) / 2 * (piece.end - piece.begin));
  return places;
}

void sample(const Sampler& sampler, std::vector<SampledPiece>& pieces) {
  std::vector<double> parts;
  for (const SampledPiece& piece : pieces)
    for (const double u : chebyshev().at)
      parts.push_back(u < 1 ? piece.begin + u * (piece.end - piece.begin) : piece.end);
  const std::vector<Vec2> points = sampler.at(parts);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(i * (kDegree + 1)), kDegree + 1,
                pieces[i].points.begin());
}

/// Returns the largest extent of the points along an axis.
double extent(const std::vector<SampledPiece>& pieces) {
  Box<Vec2> box = Box<Vec2>::around({pieces[0].points[0]});
  for (const SampledPiece& piece : pieces)
    for (const Vec2 p : piece.points) box.add(p);
  return std::max(box.size().x, box.size().y);
}

}  // namespace

std::shared_ptr<const Curve> make_sampled_curve(const CurveFunction& function, double t0, double t1) {
  if (!std::isfinite(t0) || !std::isfinite(t1) || t0 == t1)
    throw InputError(fmt::format(
        "the curve's parameter runs from {} to {}: expected two different, finite numbers", t0, t1));
  const Sampler sampler(function, t0, t1);
  std::vector<SampledPiece> open, done;
  for (int k = 0; k < kFirstPieces; ++k)
    open.push_back({static_cast<double>(k) / kFirstPieces, static_cast<double>(k + 1) / kFirstPieces, {}});
  double most = 0;
  for (int halvings = 0; !open.empty(); ++halvings) {
    sample(sampler, open);
    if (halvings == 0) most = kSampledCurveError * extent(open);
    std::vector<double> places;
    for (const SampledPiece& piece : open) std::ranges::copy(test_places(piece), std::back_inserter(places));
    const std::vector<Vec2> wanted = sampler.at(places);
    std::vector<SampledPiece> next;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const SampledPiece& piece = open[i];
      bool is_missed = false;
      for (std::size_t k = i * kDegree; k < (i + 1) * kDegree; ++k)
        is_missed = is_missed || norm(piece.point(places[k]) - wanted[k]) > most;
      const double middle = (piece.begin + piece.end) / 2;
      if (is_missed && halvings < kMostHalvingsOfPieces)
        next.insert(next.end(), {{piece.begin, middle, {}}, {middle, piece.end, {}}});
      else
        done.push_back(piece);
    }
    open = std::move(next);
    if (open.size() + done.size() > kMostPieces)
      throw InputError(
          fmt::format("the curve cannot be followed: {} pieces do not show its course", kMostPieces));
  }
  std::ranges::sort(done, {}, &SampledPiece::begin);
  return std::make_shared<SampledCurve>(std::move(done));
}

}  // namespace delquad
