#include "geometry/planar/curve_search.h"
#include "base/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace delquad {

namespace {

constexpr int kSamplesOfCurve = 64, kSamplesOfEdge = 8;
/// Chords along which the length of a span is measured.
constexpr int kSpanChords = 64;
constexpr int kGoldenSteps = 60;

std::pair<double, double> nearest_on_chord(Vec2 a, Vec2 b, Vec2 x) {
  const double s = nearest_part(x, a, b);
  const Vec2 off = a + s * (b - a) - x;
  return {s, dot(off, off)};
}

}  // namespace

CurveSearch::CurveSearch(std::shared_ptr<const Curve> curve, int edges) : curve_(std::move(curve)) {
  const int n = kSamplesOfCurve + kSamplesOfEdge * edges;
  for (int i = 0; i <= n; ++i) t_.push_back(static_cast<double>(i) / n);
  const std::vector<double> fixed = curve_->fixed_parameters();
  t_.insert(t_.end(), fixed.begin(), fixed.end());
  std::ranges::sort(t_);
  t_.erase(std::unique(t_.begin(), t_.end()), t_.end());
  for (const double t : t_) samples_.push_back(curve_->point(t));
  std::vector<Box<Vec2>> boxes;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i)
    boxes.push_back(Box<Vec2>::around({samples_[i], samples_[i + 1]}));
  chords_ = BoxTree<Vec2>(boxes);
  closed_ = samples_.front() == samples_.back();
}

Vec2 CurveSearch::point(double t) const {
  if (closed_) t -= std::floor(t);
  return curve_->point(std::clamp(t, 0.0, 1.0));
}

CurveSearch::Found CurveSearch::nearest(Vec2 x) const {
  double best = std::numeric_limits<double>::infinity();
  int chord = 0;
  chords_.nearest(x, best, [&](int i) {
    const double d2 = nearest_on_chord(samples_[i], samples_[i + 1], x).second;
    if (d2 < best) best = d2, chord = i;
  });
  // Golden section; near the least the distance itself is too flat to tell places apart.
  const auto d2 = [&](double t) {
    const Vec2 d = point(t) - x;
    return dot(d, d);
  };
  const int last = static_cast<int>(t_.size()) - 1;
  double low = t_[std::max(chord - 1, 0)], high = t_[std::min(chord + 2, last)];
  constexpr double kGolden = 0.6180339887498949;
  double p = high - kGolden * (high - low), q = low + kGolden * (high - low);
  double at_p = d2(p), at_q = d2(q);
  for (int i = 0; i < kGoldenSteps; ++i) {
    if (at_p < at_q) {
      high = q, q = p, at_q = at_p;
      p = high - kGolden * (high - low), at_p = d2(p);
    } else {
      low = p, p = q, at_p = at_q;
      q = low + kGolden * (high - low), at_q = d2(q);
    }
  }
  Found found{(low + high) / 2, std::sqrt(d2((low + high) / 2))};
  for (const double t : {t_[chord], t_[chord + 1]})
    if (const double d = std::sqrt(d2(t)); d <= found.distance) found = {t, d};
  return found;
}

CurveSearch::Span CurveSearch::between(Vec2 a, Vec2 b) const {
  const Found from = nearest(a), to = nearest(b);
  Span span{from.t, to.t, std::max(from.distance, to.distance)};
  constexpr double kHalf = 0.5;
  if (closed_ && span.to - span.from > kHalf) span.to -= 1;
  if (closed_ && span.to - span.from < -kHalf) span.to += 1;
  return span;
}

std::vector<Vec2> CurveSearch::at_parts(const Span& span, std::span<const double> parts) const {
  std::vector<double> length{0};
  const auto t_of = [&](double s) { return span.from + s / kSpanChords * (span.to - span.from); };
  Vec2 before = point(span.from);
  for (int i = 1; i <= kSpanChords; ++i) {
    const Vec2 next = point(t_of(i));
    length.push_back(length.back() + norm(next - before));
    before = next;
  }
  std::vector<Vec2> points;
  for (const double part : parts) {
    const double wanted = part * length.back();
    const auto after = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
    const auto i = static_cast<double>(after - length.begin()) - 1;
    const double step = *after - *(after - 1);
    points.push_back(point(t_of(i + (step > 0 ? (wanted - *(after - 1)) / step : 0.5))));
  }
  return points;
}

}  // namespace delquad
