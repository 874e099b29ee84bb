#pragma once

#include <vector>

#include "smoothing/optimisation/quad_energy.h"

namespace delquad {

struct EnergyDescent {
  std::vector<double> x;  ///< where the energy is least
  int iterations = 0, evaluations = 0;
  double energy_before = 0, energy_after = 0;
};

/// Lowers the energy from x = 0, where it must be finite, by L-BFGS (Ceres).
template <class Vec>
EnergyDescent minimise(const QuadEnergy<Vec>& energy, int max_iterations);

}  // namespace delquad
