// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/turn_to_agree.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Pieces = std::vector<std::vector<int>>;

TEST(TurnToAgree, EachPieceGoesByItsFirst) {
  const std::vector<Neighbours> neighbours = {{0, 2, false}, {2, 4, true}, {4, 0, false}, {3, 1, false}};
  const Turned turned = turn_to_agree(6, neighbours);
  EXPECT_EQ(turned.is_turned, (std::vector<char>{0, 0, 1, 1, 1, 0}));
  EXPECT_EQ(turned.pieces, (Pieces{{0, 2, 4}, {1, 3}, {5}}));
  EXPECT_EQ(turned.clash, -1);
}

TEST(TurnToAgree, NamesNeighboursThatCannot) {
  const std::vector<Neighbours> strip = {{0, 1, true}, {1, 2, true}, {2, 0, false}};
  EXPECT_GE(turn_to_agree(3, strip).clash, 0);
  const std::vector<Neighbours> itself = {{0, 1, true}, {1, 1, false}};
  EXPECT_EQ(turn_to_agree(2, itself).clash, 1);
}

}  // namespace
}  // namespace delquad
