#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/patch.h"

namespace delquad {

/// Extends values harmonically by finite elements linear on each triangle. dofs[t][k] numbers the unknown of
/// triangle t at its vertex k (continuous elements) or at the middle of its side opposite to vertex k
/// (Crouzeix-Raviart elements): both have the same matrix, up to a factor. Each column holds a value per
/// unknown: given where `fixed`, result elsewhere. One factorisation serves all columns.
void solve_laplace(const TriPatch& tri, const std::vector<std::array<int, 3>>& dofs,
                   const std::vector<char>& fixed, std::span<std::vector<double>> columns);

}  // namespace delquad
