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
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/element_nodes.h"
#include "io/text_scanner.h"

// This header has the common part of readers of points and faces. Readers and writers use it.

namespace delquad {

/// Throws InputError for the first stray point of a mesh, unless strays are kept. `place` returns the place
/// of a point in the file.
void check_strays(const Mesh& mesh, Strays strays, const std::function<std::string(int)>& place);

/// Returns Mesh::curves, regions or volumes.
std::vector<Entity>& entities_of(Mesh& mesh, int dim);
/// Adds an element by its nodes: its corners first, then the nodes that `places` of its order has beside
/// them. Cells of volumes keep their corners alone. Returns the problem if its order differs from the order
/// of the mesh; empty: it was added.
std::string add_element(Mesh& mesh, CellShape shape, std::span<const int> nodes, int entity,
                        std::vector<int> (*places)(int order) = gmsh_places);
/// Does the same for a line, triangle or quad by the number of its corners.
inline std::string add_element(Mesh& mesh, int corners, std::span<const int> nodes, int entity) {
  return add_element(mesh, static_cast<CellShape>(corners - 1), nodes, entity);
}
/// Returns whether a cell of a volume has further nodes, which is noted.
inline bool has_further(CellShape shape, std::size_t n_nodes) {
  return dimension_of(shape) == 3 && n_nodes > static_cast<std::size_t>(corners_of(shape));
}
inline constexpr const char* kCornersOfCells = "cells of order 2 are read as their corners";

/// Adds named points while a mesh is read.
class NamedPoints {
 public:
  void add(Mesh& mesh, int point, const std::string& name);

 private:
  std::map<int, std::size_t> index_;
};

/// Common part of readers of text files with points and faces.
class FaceReader {
 protected:
  FaceReader(const std::filesystem::path& path, const char* kind, Strays strays);
  /// Returns the next coordinate of the point on this line. Throws InputError with the line.
  double coordinate();
  /// Adds the point that was read last.
  void add_point(const Vec3& p);
  /// Adds a face with these vertices as a quad or triangles. Throws InputError, with the line, for faces that
  /// cannot be split.
  void add_face(const std::vector<int>& corners, int region);
  /// Returns the mesh without unused points, and notes the number of split faces.
  Mesh finished(ReadNotes* notes);

  TextScanner in_;
  Mesh mesh_;
  Strays strays_;

 private:
  std::vector<size_t> places_;                  ///< of the points in the file
  long long n_polygons_ = 0, n_triangles_ = 0;  ///< split polygons, and their triangles
  long long n_odd_ = 0;                         ///< split polygons that cross themselves or have no area
};

/// Regions of faces by color, which marks parts in scans and prints.
class FaceColours {
 public:
  static constexpr std::size_t kMost = 64;  ///< more colors are a picture and divide nothing

  /// Returns the index of the region for a color ("rrggbb"; empty: none) in a part called `name`.
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

  /// Gives the mesh its regions; for too many colors only the regions of parts, and a note.
  void finish(Mesh& mesh, ReadNotes* notes) const;

 private:
  std::map<std::pair<std::string, std::string>, int> index_;
  std::vector<Entity> regions_;
};

/// Returns "rrggbb" for values from 0 to 255.
std::string colour_text(const std::array<int, 3>& rgb);

}  // namespace delquad
