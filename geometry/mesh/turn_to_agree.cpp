// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/turn_to_agree.h"

namespace delquad {

Turned turn_to_agree(std::size_t n, std::span<const Neighbours> neighbours) {
  std::vector<std::vector<int>> at(n);
  for (int i = 0; i < static_cast<int>(neighbours.size()); ++i)
    for (const int of : {neighbours[i].a, neighbours[i].b}) at[of].push_back(i);
  Turned result{std::vector<char>(n, 0), {}};
  std::vector<char> known(n, 0);
  for (std::size_t first = 0; first < n; ++first) {
    if (known[first]) continue;
    known[first] = 1;
    std::vector<int>& piece = result.pieces.emplace_back(1, static_cast<int>(first));
    for (std::size_t k = 0; k < piece.size(); ++k)
      for (const int i : at[piece[k]]) {
        const auto& [a, b, agree] = neighbours[i];
        const int other = a == piece[k] ? b : a;
        const char wanted = (result.is_turned[piece[k]] != 0) == agree;
        if (known[other] && result.is_turned[other] != wanted) result.clash = i;
        if (known[other]) continue;
        known[other] = 1;
        result.is_turned[other] = wanted;
        piece.push_back(other);
      }
  }
  return result;
}

}  // namespace delquad
