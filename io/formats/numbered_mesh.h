// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <climits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/mesh/drop_unused_points.h"
#include "io/entity_names.h"
#include "io/face_reader.h"

// This header has the common part of readers of SMS and SCHISM. Readers and writers use it.

namespace delquad {

/// Reads planar nodes and elements by number, in any order; depths are left out. All functions throw
/// InputError with file and line.
class NumberedMesh {
 public:
  void read_node(TextScanner& in) {
    const long long number = in.integer("a node's number", 0, LLONG_MAX);
    const double x = in.real("x"), y = in.real("y");
    in.real("a depth");
    if (!node_of_.emplace(number, static_cast<int>(mesh_.points.size())).second)
      in.fail("node {} is there twice", number);
    mesh_.points.push_back({x, y, 0});
  }
  void read_corners(TextScanner& in, long long corners) {
    elements_.push_back({in.line(), {}});
    for (; corners > 0; --corners)
      elements_.back().nodes.push_back(in.integer("a node's number", 0, LLONG_MAX));
  }
  /// Sets the material of the element that was read last.
  void set_material(long long material) { elements_.back().material = material; }
  /// Returns the mesh without unused points.
  Mesh finished(const TextScanner& in, NumberedEntities entities = {}) {
    for (const Element& element : elements_) {
      std::vector<int> corners;
      for (const long long number : element.nodes) {
        const auto node = node_of_.find(number);
        if (node == node_of_.end()) in.fail_at(element.line, "there is no node {}", number);
        corners.push_back(node->second);
      }
      const int region = entities.index(2, element.material, mesh_);
      add_element(mesh_, static_cast<int>(corners.size()), corners, region);
    }
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  struct Element {
    int line;
    std::vector<long long> nodes;
    long long material = 1;
  };
  Mesh mesh_;
  std::vector<Element> elements_;
  std::unordered_map<long long, int> node_of_;
};

}  // namespace delquad
