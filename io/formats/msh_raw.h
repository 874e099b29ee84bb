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

/// A node as an MSH file has it, before tags become indices.
struct Node {
  long long tag;
  Vec3 at;
  int line;  ///< of the file
};

struct Element {
  long long tag;
  int n_nodes;                     ///< corners: 2 line, 3 triangle, 4 quad, 8 hexahedron
  int entity;                      ///< elementary tag
  int physical;                    ///< physical tag (2.2 only), 0: none
  std::array<long long, 8> nodes;  ///< tags of corners
  int line;                        ///< of the file
  int n_further = 0;               ///< nodes of a curved element besides
  std::size_t first_further = 0;   ///< index into Contents::further_nodes
  int dim() const { return dimension_of(n_nodes); }
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
  std::vector<std::pair<long long, double>> values;  ///< by tag; of several components the first
  std::vector<double> further;                       ///< the others of each
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
  bool has_periodic = false;  ///< a $Periodic section, which is not read
};

/// The tags of what a mesh was made of.
struct MeshTags {
  std::vector<long long> points, triangles, quads, hexahedra;
};

/// Reads the sections. [Gmsh reference manual, "MSH file format" and "Legacy formats"]
/// Views are skipped unless they are asked for.
Contents read_contents(TextScanner& scanner, bool with_views = false);

/// Fills entity_physicals from the elements' own physical tags, as 2.2 keeps them. An element in several
/// groups is listed once for each and becomes one. Elements of one entity in different groups become entities
/// of their own.
void settle_physicals(Contents& contents);

/// Returns the groups of an entity by name, of which one without a name goes by its number, and its further
/// names.
std::vector<std::string> names_of(const Contents& contents, DimTag entity);

/// Tags become indices: nodes in the order of their tags, without those that no element uses. Elements must
/// be of one order. `tags.points`: without the middles that quads of 8 nodes get.
Mesh to_mesh(Contents contents, const TextScanner& scanner, MeshTags* tags = nullptr);

}  // namespace delquad::msh
