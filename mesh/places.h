#pragma once

#include <cstddef>
#include <vector>

#include "mesh/vec.h"

namespace delquad {

/// A place on a model or a mesh.
struct Place {
  Vec3 at;
  int face = -1;  ///< index into Mesh::regions; -1: of none
};

/// Places of one kind: how many there are, and the first few.
struct Places {
  static constexpr std::size_t kMostKept = 3;
  int count = 0;
  std::vector<Place> first;
  void add(const Place& place) {
    ++count;
    if (first.size() < kMostKept) first.push_back(place);
  }
};

}  // namespace delquad
