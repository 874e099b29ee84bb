#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Regions of faces by their colour, as scans and prints have their parts.
class FaceColours {
 public:
  static constexpr std::size_t kMost = 64;  ///< more than these paint a picture and divide nothing

  /// Index of the region of faces with this colour ("rrggbb"; empty: none) in a part that goes by `name`.
  int region(const std::string& name, const std::string& colour) {
    const auto [at, is_new] = index_.try_emplace({name, colour}, static_cast<int>(regions_.size()));
    if (is_new) {
      Entity entity{static_cast<int>(regions_.size()) + 1, {}};
      if (!name.empty()) entity.names.push_back(name);
      if (!colour.empty()) entity.names.push_back(std::string(kColourName) + colour);
      regions_.push_back(std::move(entity));
    }
    return at->second;
  }

  /// Gives the mesh its regions; where there are too many colours, those of the parts alone, and a note.
  void finish(Mesh& mesh, ReadNotes* notes) const;

 private:
  std::map<std::pair<std::string, std::string>, int> index_;
  std::vector<Entity> regions_;
};

/// "rrggbb" of parts of 255.
std::string colour_text(const std::array<int, 3>& rgb);

}  // namespace delquad
