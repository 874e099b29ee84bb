// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/seed/perturb.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

#include "algorithms/fields/size_by.h"

namespace delquad {
namespace {

constexpr int kWaves = 6;
constexpr double kAmplitude = 0.03, kWavelengths = 10;  // a wave's length: about a tenth of the diagonal

/// Uniform in [0, 1), the same on every machine (the standard's distributions are not).
class Random {
 public:
  explicit Random(long long seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  double operator()() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }

 private:
  std::mt19937_64 engine_;
};

/// Rotates a field by an angle.
template <class Base>
class Rotated : public Base {
 public:
  Rotated(std::shared_ptr<const Base> base, const Rotation& rotation)
      : base_(std::move(base)), rotation_(rotation) {}

 protected:
  std::shared_ptr<const Base> base_;
  Rotation rotation_;
};

class RotatedCurve final : public Rotated<Curve> {
 public:
  using Rotated::Rotated;
  Vec2 point(double t) const override { return rotation_(base_->point(t)); }
};

class RotatedCross final : public Rotated<CrossField> {
 public:
  RotatedCross(std::shared_ptr<const CrossField> base, const Rotation& rotation)
      : Rotated(std::move(base), rotation), turn_(Cross::along({rotation.c, rotation.s})) {}
  Cross at(Vec2 u, int& hint) const override {
    const Cross cross = base_->at(rotation_.back(u), hint);
    return {cross.c * turn_.c - cross.s * turn_.s, cross.s * turn_.c + cross.c * turn_.s};
  }

 private:
  Cross turn_;
};

}  // namespace

std::shared_ptr<const SizeField> jittered(std::shared_ptr<const SizeField> size, long long seed,
                                          double diagonal) {
  struct Wave {
    Vec3 k;
    double phase;
  };
  std::array<Wave, kWaves> waves;
  Random random(seed);
  const double most = 2 * std::numbers::pi * kWavelengths / diagonal;
  for (Wave& wave : waves) {
    wave.k = {most * (2 * random() - 1), most * (2 * random() - 1), most * (2 * random() - 1)};
    wave.phase = 2 * std::numbers::pi * random();
  }
  return size_by([size = std::move(size), waves](const Vec3& x, int& hint) {
    double sum = 0;
    for (const Wave& wave : waves) sum += std::sin(dot(wave.k, x) + wave.phase);
    return size->at(x, hint) * (1 + kAmplitude / kWaves * sum);
  });
}

Rotation Rotation::by_seed(long long seed) {
  const double angle = 2 * std::numbers::pi * Random(seed)();
  return {std::cos(angle), std::sin(angle)};
}

void rotate(const Rotation& rotation, PlanarDomain& domain) {
  for (Vec3& p : domain.boundary.points) {
    const Vec2 q = rotation({p.x, p.y});
    p = {q.x, q.y, p.z};
  }
  for (PeriodicNodes& pair : domain.boundary.periodic)
    for (Vec3* v : {&pair.motion.shift, &pair.motion.centre}) {
      const Vec2 q = rotation({v->x, v->y});
      *v = {q.x, q.y, v->z};
    }
  for (PatchBoundary& patch : domain.patches)
    for (Vec2& p : patch.points) p = rotation(p);
  for (auto& shapes : domain.curve_shapes)
    for (auto& shape : shapes) shape = std::make_shared<RotatedCurve>(std::move(shape), rotation);
  for (CurvePlace& place : domain.places)
    if (place.curve) place.curve = std::make_shared<RotatedCurve>(std::move(place.curve), rotation);
  for (DomainPiece& piece : domain.pieces)
    piece.shape = std::make_shared<RotatedCurve>(std::move(piece.shape), rotation);
}

std::shared_ptr<const SizeField> rotated(std::shared_ptr<const SizeField> size, const Rotation& rotation) {
  return size_by([size = std::move(size), rotation](const Vec3& x, int& hint) {
    const Vec2 p = rotation.back({x.x, x.y});
    return size->at({p.x, p.y, x.z}, hint);
  });
}

std::shared_ptr<const CrossField> rotated(std::shared_ptr<const CrossField> cross, const Rotation& rotation) {
  return std::make_shared<RotatedCross>(std::move(cross), rotation);
}

}  // namespace delquad
