// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/model.h"

// This header divides curves into edges of the wanted size. Geometry uses it.

namespace delquad {

/// The integral of ds/delta along a piece of a curve: the number of edges of size delta on it. Adaptive
/// Simpson rules on chords (own method) need no derivative and no regular parametrization.
class ArcMeasure {
 public:
  /// The piece t0 <= t <= t1 of the curve, which messages call `label`. Once the integral is known and is not
  /// above `most`, the size is sampled more often than once an edge. So no variation that the edges can show
  /// is missed. Throws InputError where the point is not finite, the size is not finite and positive, or the
  /// curve jumps.
  ArcMeasure(const Curve& curve, double t0, double t1, const SizeField& size, const std::string& label,
             double most);

  /// Returns the integral, with a relative error of kIntegralTolerance.
  double integral() const { return cells_.back().end; }

  /// Returns the parameters of the n - 1 nodes, without ends, that divide the piece in n >= 1 parts of equal
  /// integral, in order.
  std::vector<double> interior_nodes(int n) const;
  /// Returns the parameters at which the integral from the beginning has these values, in ascending order.
  std::vector<double> nodes_at(const std::vector<double>& targets) const;

  static constexpr double kIntegralTolerance = 1e-7;

 private:
  struct Sample {
    double t;
    Vec2 p;
    double density;  ///< 1/delta
  };
  /// Five samples at quarters, with the difference between Simpson's rule and its halves as error.
  struct Panel {
    Sample s[5];
    double value, error;
    bool minimal;  ///< too narrow to be split
  };
  /// Half a panel, for the search of a node.
  struct Cell {
    Sample first, last;
    double end;  ///< integral from the curve's start to `last`
  };

  static double trapezium(const Sample& a, const Sample& b);
  static double simpson(const Sample& a, const Sample& m, const Sample& b);
  Sample sample(double t) const;
  Panel make_panel(const Sample& a, const Sample& m, const Sample& b) const;
  std::vector<Panel> first_panels(int count) const;
  void refine(std::vector<Panel>& panels, double most) const;
  void finish(const std::vector<Panel>& panels);
  double find(const Cell& cell, double begin, double target) const;

  const Curve& curve_;
  double t0_, t1_;
  const SizeField& size_;
  mutable int hint_ = -1;
  std::string label_;
  std::vector<Cell> cells_;
};

}  // namespace delquad
