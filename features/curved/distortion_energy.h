#pragma once

#include <ceres/first_order_function.h>

#include <array>
#include <cstddef>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Derivatives of an order's shape functions at the places where elements' distortion is measured.
struct SampleTable {
  std::vector<std::vector<double>> du, dv;  ///< by sample and node
};
SampleTable make_sample_table(int order);

/// An element, and the parallelogram that it should be like.
struct DistortionTarget {
  std::vector<int> nodes;           ///< as nodes_of_quad() orders them
  Vec3 e1, e2;                      ///< of its plane
  std::array<double, 4> inverse{};  ///< of the parallelogram's sides in that plane, by rows
};

/// What an element should be like.
enum class Likeness {
  kStraight,     ///< the parallelogram in the middle of its straight form
  kRightAngled,  ///< a rectangle with sides as long as those of its straight form are in the mean
};

/// False where the straight quad is flat.
bool make_target(const Mesh& mesh, std::size_t quad, Likeness likeness, DistortionTarget& target);

/// What counts in a distortion.
struct DistortionWeights {
  double shape;  ///< w below: that of shapes against scaled Jacobians, 0 to 1
  int power;     ///< k below: how much more the worst count
};

/// A node that moves: along two axes, or one, the other being zero.
struct FreeNode {
  int node;
  int region = -1, curve = -1;  ///< that it slides on: one of these
  std::array<Vec3, 2> axes = {};
};

/// The distortion of elements by where their free nodes are, two parameters each: the sum over places of all
/// of (w |T|^2 / (2 det T) + (1 - w) |p| |q| / det T)^k, T being the element's map by that of its target
/// [Knupp 2001], p and q its columns, and det T regularised where it is not positive [Escobar et al. 2003].
/// Of targets that are rectangles the second term is one over the scaled Jacobian.
class DistortionEnergy final : public ceres::FirstOrderFunction {
 public:
  /// All but the weights outlive it.
  DistortionEnergy(const std::vector<Vec3>& points, const std::vector<DistortionTarget>& targets,
                   const std::vector<FreeNode>& free, const SampleTable& table, DistortionWeights weights);
  int NumParameters() const override { return 2 * static_cast<int>(free_.size()); }
  bool Evaluate(const double* x, double* cost, double* gradient) const override;

 private:
  static constexpr std::size_t kMostNodes = (kMostOrder + 1) * (kMostOrder + 1);
  /// An element's nodes in its plane, or what goes with them.
  struct Flat {
    std::array<double, kMostNodes> x, y;
  };
  Flat nodes_in_plane(std::size_t target, const double* x) const;
  std::array<Vec2, 2> columns(const DistortionTarget& t, const Flat& flat, std::size_t sample) const;
  void add(std::size_t target, const double* x, double& cost, double* gradient) const;

  const std::vector<Vec3>& points_;
  const std::vector<DistortionTarget>& targets_;
  const std::vector<FreeNode>& free_;
  const SampleTable& table_;
  const DistortionWeights weights_;
  double softness_ = 0;
  std::vector<std::vector<int>> free_of_;  ///< of each target's nodes: index into `free`; -1: it stays
};

}  // namespace delquad
