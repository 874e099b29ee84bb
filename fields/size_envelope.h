#pragma once

#include <vector>

#include "base/box_tree.h"
#include "delquad/mesh.h"

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
  void build();
  /// Whether a smaller sample gives as little there: it is no part of the envelope.
  bool is_explained(const Sample& s) const;
  double bound(const BoxTree<Vec2>::Node& node, Vec2 x) const;

  double slope_;
  std::vector<Sample> samples_;
  BoxTree<Vec2> tree_;
  std::vector<double> least_;  ///< of the samples in each node of the tree
};

}  // namespace delquad
