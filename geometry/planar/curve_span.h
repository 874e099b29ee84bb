// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/box.h"
#include "delquad/model.h"

// This header finds the nearest places on curves. Features and geometry use it.

namespace delquad {

/// A part of a curve without compulsory nodes, as chords from which it hardly strays.
class CurveSpan {
 public:
  CurveSpan(const Curve& shape, double t0, double t1);

  const Box<Vec2>& box() const { return box_; }
  double begin() const { return chords_.front().t0; }
  double end() const { return chords_.back().t1; }

  struct Place {
    double t;
    Vec2 at;
    double distance;
  };
  /// Returns the place next to x.
  Place nearest(Vec2 x) const;

  struct Crossing {
    double mine, other;  ///< parameters
    Vec2 at;
  };
  /// Returns the places where the two go through each other; touching is none.
  std::vector<Crossing> crossings(const CurveSpan& other) const;

 private:
  struct Chord {
    double t0, t1;
    Vec2 a, b;
  };

  void add(double t0, double t1, Vec2 a, Vec2 b, int halvings);

  const Curve* shape_;
  std::vector<Chord> chords_;
  Box<Vec2> box_;
};

}  // namespace delquad
