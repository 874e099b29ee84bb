#include "features/symmetry/symmetry_planes.h"

#include <algorithm>
#include <utility>

namespace delquad {
namespace {

/// Sizes that differ by a smaller part are the same: places of images have rounding.
constexpr double kSameSize = 1e-9;

class LeastOfImages final : public SizeField {
 public:
  LeastOfImages(std::shared_ptr<const SizeField> size, SymmetryPlanes planes)
      : size_(std::move(size)), planes_(std::move(planes)) {}
  double at(const Vec3& x, int& hint) const override {
    const double own = size_->at(x, hint);
    double least = own;
    for (int mask = 1; mask < 1 << planes_.count(); ++mask) {
      int far_hint = -1;
      least = std::min(least, size_->at(planes_.reflect_all(mask, x), far_hint));
    }
    return least < (1 - kSameSize) * own ? least : own;
  }

 private:
  std::shared_ptr<const SizeField> size_;
  SymmetryPlanes planes_;
};

class FoldedSize final : public SizeField {
 public:
  FoldedSize(std::shared_ptr<const SizeField> size, SymmetryPlanes planes)
      : size_(std::move(size)), planes_(std::move(planes)) {}
  double at(const Vec3& x, int& hint) const override { return size_->at(planes_.fold(x), hint); }

 private:
  std::shared_ptr<const SizeField> size_;
  SymmetryPlanes planes_;
};

}  // namespace

std::shared_ptr<const SizeField> least_of_images(std::shared_ptr<const SizeField> size,
                                                 const SymmetryPlanes& planes) {
  return std::make_shared<LeastOfImages>(std::move(size), planes);
}

std::shared_ptr<const SizeField> folded_size(std::shared_ptr<const SizeField> size,
                                             const SymmetryPlanes& planes) {
  return std::make_shared<FoldedSize>(std::move(size), planes);
}

}  // namespace delquad
