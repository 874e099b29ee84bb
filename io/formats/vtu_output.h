#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// What files of VTK XML have in common, whatever cells they hold.

namespace delquad {

struct VtuCells {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;

  template <class Nodes>
  void add(const Nodes& nodes, std::uint8_t type) {
    connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

using NumbersOfNames = std::map<std::string, std::vector<std::int32_t>>;
NumbersOfNames tags_of_names(const std::vector<Entity>& entities);

struct VtuContent {
  const std::vector<Vec3>& points;
  std::string unit;  ///< empty: not known
  VtuCells cells;
  /// Kind of entity -> numbers of each name, which become arrays "KIND NAME".
  std::vector<std::pair<std::string, NumbersOfNames>> names;
  std::vector<std::pair<std::string, std::vector<std::int32_t>>> tags;  ///< of cells; 0: none
  std::map<std::string, std::vector<double>> values;                    ///< of cells
};

/// As one file, its numbers in base64.
void write_vtu_content(const std::filesystem::path& path, const VtuContent& content);

}  // namespace delquad
