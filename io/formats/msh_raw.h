// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "io/face_reader.h"
#include "io/text_scanner.h"

// This header has the contents of MSH files before tags become indices. Readers and writers use it.

namespace delquad::msh {

/// A node of an MSH file, before tags become indices.
struct Node {
  long long tag;
  Vec3 at;
  int line;  ///< of the file
};

struct Element {
  long long tag;
  CellShape shape;
  int entity;                      ///< elementary tag
  int physical;                    ///< physical tag (2.2 only), 0: none
  std::array<long long, 8> nodes;  ///< tags of corners
  int line;                        ///< of the file
  int n_further = 0;               ///< further nodes of a curved element
  std::size_t first_further = 0;   ///< index into Contents::further_nodes
  int dim() const { return dimension_of(shape); }
  int n_nodes() const { return corners_of(shape); }
};

/// A point element.
struct Point {
  int entity;      ///< elementary tag
  int physical;    ///< physical tag (2.2 only), 0: none
  long long node;  ///< node tag
  int line;        ///< of the file
};

/// One step of a view.
struct View {
  std::string name;
  bool is_of_nodes;
  int n_components;
  std::vector<std::pair<long long, double>> values;  ///< by tag; the first component
  std::vector<double> further;                       ///< other components of each value
};

using DimTag = std::pair<int, int>;

struct Contents {
  std::vector<Node> nodes;
  std::vector<Element> elements;
  std::vector<long long> further_nodes;  ///< tags
  std::vector<Point> points;
  std::map<DimTag, std::vector<int>> entity_physicals;
  std::map<int, std::vector<int>> surface_curves;  ///< tags, ascending (4.1 only)
  std::map<DimTag, std::string> physical_names;
  std::map<DimTag, std::vector<std::string>> more_names;  ///< of entities, besides their groups
  std::string unit;                                       ///< of lengths
  std::vector<View> views;
  bool has_periodic = false;  ///< it has a section $Periodic, which is not read
};

/// Tags of the points and elements of a mesh.
struct MeshTags {
  std::vector<long long> points;
  std::array<std::vector<long long>, kCellShapes> elements;  ///< by shape
};

/// Returns the sections of a file [Gmsh reference manual, "MSH file format" and "Legacy formats"]; views only
/// on request. Throws InputError with file and line, or byte.
Contents read_contents(TextScanner& scanner, bool with_views = false);

/// Fills entity_physicals from the physical tags of elements, as in 2.2. An element in several groups is
/// repeated there and becomes one. Elements of one entity in different groups become separate entities.
void settle_physicals(Contents& contents);

/// Returns the names of the groups of an entity, or the number of a group without a name, and its further
/// names.
std::vector<std::string> names_of(const Contents& contents, DimTag entity);

/// Returns the mesh with indices: nodes in the order of their tags, without unused ones. `tags.points` lacks
/// the middles of quads of 8 nodes. Throws InputError for elements of several orders, unknown tags and an
/// empty file.
Mesh to_mesh(Contents contents, const TextScanner& scanner, MeshTags* tags = nullptr);

}  // namespace delquad::msh
