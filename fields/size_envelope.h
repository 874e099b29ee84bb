#pragma once

#include <vector>

#include "mesh/vec.h"

namespace delquad {

/// Sizes known at points, each growing with the distance from its point at the same slope: their lower
/// envelope.
class SizeEnvelope {
 public:
  struct Sample {
    Vec2 at;
    double delta;
  };
  SizeEnvelope(std::vector<Sample> samples, double slope);

  /// The smaller of delta and the envelope at x.
  double limit(Vec2 x, double delta) const;

 private:
  struct Node {
    Vec2 low, high;
    double least;    ///< of the samples in the box
    int begin, end;  ///< range of samples_
    int right;       ///< second child, the first being the next node; -1: a leaf
  };
  void build();
  int build(int begin, int end);
  double bound(const Node& node, Vec2 x) const;

  double slope_;
  std::vector<Sample> samples_;
  std::vector<Node> nodes_;
};

}  // namespace delquad
