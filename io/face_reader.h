// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/element_nodes.h"
#include "io/text_scanner.h"

// This header has the common part of readers of points and faces. Readers and writers use it.

namespace delquad {

/// Throws InputError for the first stray point of a mesh, unless they are kept. `place`: where the file has a
/// point.
void check_strays(const Mesh& mesh, Strays strays, const std::function<std::string(int)>& place);

/// Adds a line, triangle, quad or hexahedron by its nodes: its corners first, then the nodes that `places` of
/// its order has beside them. Hexahedra keep their corners alone. Returns the problem if its order differs
/// from the order of the mesh; empty: it was added.
inline constexpr int kHexCorners = 8;
inline constexpr const char* kCornersOfHexahedra = "hexahedra of order 2 are read as their corners";
/// Returns the dimension of elements with so many corners.
constexpr int dimension_of(int corners) { return corners == kHexCorners ? 3 : corners > 2 ? 2 : corners - 1; }
/// Returns Mesh::curves, regions or volumes.
std::vector<Entity>& entities_of(Mesh& mesh, int dim);
std::string add_element(Mesh& mesh, int corners, std::span<const int> nodes, int entity,
                        std::vector<int> (*places)(int order) = gmsh_places);

/// The named points of a mesh that is read.
class NamedPoints {
 public:
  void add(Mesh& mesh, int point, const std::string& name);

 private:
  std::map<int, std::size_t> index_;
};

/// The common part of readers of text files with points and faces.
class FaceReader {
 protected:
  FaceReader(const std::filesystem::path& path, const char* kind, Strays strays);
  /// Reads one more coordinate of the point on this line.
  double coordinate();
  /// Adds a point that was read just now.
  void add_point(const Vec3& p);
  /// Adds a face of these vertices to the mesh, as a quad or triangles. Throws InputError with the line for
  /// one that cannot be split.
  void add_face(const std::vector<int>& corners, int region);
  /// Returns the mesh without points that nothing uses. Notes how many faces were split, if any.
  Mesh finished(ReadNotes* notes);

  TextScanner in_;
  Mesh mesh_;
  Strays strays_;

 private:
  std::vector<size_t> places_;                  ///< of the points in the file
  long long n_polygons_ = 0, n_triangles_ = 0;  ///< that were split, and what they became
  long long n_odd_ = 0;                         ///< of them, those that cross themselves or have no area
};

/// Regions of faces by their color, as scans and prints have their parts.
class FaceColours {
 public:
  static constexpr std::size_t kMost = 64;  ///< more than these paint a picture and divide nothing

  /// Returns the index of the region of faces with this color ("rrggbb"; empty: none) in a part that goes by
  /// `name`.
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

  /// Gives the mesh its regions; where there are too many colors, only the regions of parts, and a note.
  void finish(Mesh& mesh, ReadNotes* notes) const;

 private:
  std::map<std::pair<std::string, std::string>, int> index_;
  std::vector<Entity> regions_;
};

/// Returns "rrggbb" of parts of 255.
std::string colour_text(const std::array<int, 3>& rgb);

}  // namespace delquad
