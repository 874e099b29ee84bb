#pragma once

#include <memory>
#include <string>
#include <utility>

#include "base/located.h"
#include "delquad/fields.h"

namespace delquad {

/// A size field whose errors say where it was written.
class LocatedSize final : public SizeField {
 public:
  LocatedSize(std::shared_ptr<const SizeField> base, std::string where)
      : base_(std::move(base)), where_(std::move(where)) {}
  double at(const Vec3& x, int& hint) const override {
    return located(where_, [&] { return base_->at(x, hint); });
  }

 private:
  std::shared_ptr<const SizeField> base_;
  std::string where_;
};

/// A cross field whose errors say where it was written.
class LocatedCross final : public CrossField {
 public:
  LocatedCross(std::shared_ptr<const CrossField> base, std::string where)
      : base_(std::move(base)), where_(std::move(where)) {}
  Cross at(Vec2 u, int& hint) const override {
    return located(where_, [&] { return base_->at(u, hint); });
  }

 private:
  std::shared_ptr<const CrossField> base_;
  std::string where_;
};

}  // namespace delquad
