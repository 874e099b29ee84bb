// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/curve_span.h"

#include <algorithm>
#include <limits>

#include "base/predicates.h"
#include "base/segment.h"

namespace delquad {

namespace {

/// A curve strays from a chord by less than this part of the chord's length.
constexpr double kStray = 0.02;
constexpr int kMostHalvings = 12;
/// Steps of the searches that make a place exact: both converge to rounding in less.
constexpr int kSteps = 80, kNewtonSteps = 30;

double to_chord(Vec2 p, Vec2 a, Vec2 b, double& part) {
  part = nearest_part(p, a, b);
  return norm(p - (a + part * (b - a)));
}

Vec2 derivative(const Curve& shape, double t, double h) {
  const double from = std::max(t - h, 0.0), to = std::min(t + h, 1.0);
  return 1 / (to - from) * (shape.point(to) - shape.point(from));
}

}  // namespace

CurveSpan::CurveSpan(const Curve& shape, double t0, double t1) : shape_(&shape) {
  const Vec2 a = shape.point(t0), b = shape.point(t1);
  box_ = Box<Vec2>::around({a, b});
  add(t0, t1, a, b, 0);
}

void CurveSpan::add(double t0, double t1, Vec2 a, Vec2 b, int halvings) {
  double stray = 0, part = 0;
  for (const double s : {0.25, 0.5, 0.75}) {
    const Vec2 p = shape_->point(t0 + s * (t1 - t0));
    box_.add(p);
    stray = std::max(stray, to_chord(p, a, b, part));
  }
  if (stray <= kStray * norm(b - a) || halvings == kMostHalvings) {
    chords_.push_back({t0, t1, a, b});
    const Vec2 margin{2 * stray, 2 * stray};
    box_.add(lower(a, b) - margin);
    box_.add(upper(a, b) + margin);
    return;
  }
  const double t = (t0 + t1) / 2;
  const Vec2 m = shape_->point(t);
  add(t0, t, a, m, halvings + 1);
  add(t, t1, m, b, halvings + 1);
}

CurveSpan::Place CurveSpan::nearest(Vec2 x) const {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity(), part = 0;
  for (std::size_t i = 0; i < chords_.size(); ++i)
    if (const double d = to_chord(x, chords_[i].a, chords_[i].b, part); d < least) {
      least = d;
      best = i;
    }
  to_chord(x, chords_[best].a, chords_[best].b, part);
  const Chord& chord = chords_[best];
  // The parameter need not run evenly along the chord, and the place may be on the next one.
  const double reach = chord.t1 - chord.t0, guess = chord.t0 + part * reach;
  double low = std::max(begin(), guess - reach), high = std::min(end(), guess + reach);
  for (int i = 0; i < kSteps; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (norm(shape_->point(a) - x) < norm(shape_->point(b) - x))
      high = b;
    else
      low = a;
  }
  Place place{guess, shape_->point(guess), 0};
  place.distance = norm(place.at - x);
  for (const double t : {(low + high) / 2, begin(), end()})
    if (const Vec2 at = shape_->point(t); norm(at - x) < place.distance) place = {t, at, norm(at - x)};
  return place;
}

std::vector<CurveSpan::Crossing> CurveSpan::crossings(const CurveSpan& other) const {
  std::vector<Crossing> found;
  for (const Chord& p : chords_) {
    const Box<Vec2> box = Box<Vec2>::around({p.a, p.b});
    for (const Chord& q : other.chords_) {
      if (!box.overlaps(Box<Vec2>::around({q.a, q.b}))) continue;
      if (orient2d(p.a, p.b, q.a) * orient2d(p.a, p.b, q.b) > 0 ||
          orient2d(q.a, q.b, p.a) * orient2d(q.a, q.b, p.b) > 0)
        continue;
      const Vec2 u = p.b - p.a, w = q.b - q.a;
      const double area = cross(u, w);
      if (area == 0) continue;
      double s = p.t0 + cross(q.a - p.a, w) / area * (p.t1 - p.t0);
      double t = q.t0 + cross(q.a - p.a, u) / area * (q.t1 - q.t0);
      for (int i = 0; i < kNewtonSteps; ++i) {
        const double hs = 1e-6 * (p.t1 - p.t0), ht = 1e-6 * (q.t1 - q.t0);
        const Vec2 gap = other.shape_->point(t) - shape_->point(s);
        const Vec2 ds = derivative(*shape_, s, hs), dt = derivative(*other.shape_, t, ht);
        const double jacobian = cross(ds, dt);
        if (jacobian == 0) break;
        s = std::clamp(s + cross(gap, dt) / jacobian, begin(), end());
        t = std::clamp(t + cross(gap, ds) / jacobian, other.begin(), other.end());
      }
      found.push_back({s, t, shape_->point(s)});
    }
  }
  return found;
}

}  // namespace delquad
