#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace delquad {

using Json = nlohmann::ordered_json;

/// The SVG files of a folder of results that a page shows as they are: those in `figures/`, and for results
/// without cells those of the folder itself; by name.
std::vector<std::filesystem::path> list_drawings(const std::filesystem::path& folder, bool has_cells);

/// Puts drawings on a page while there is room.
class DrawingShelf {
 public:
  /// A drawing: its name, and its text, or under `left_out` where it lies, when it is too large.
  Json put(const std::filesystem::path& file);

 private:
  std::uintmax_t written_ = 0;
};

}  // namespace delquad
