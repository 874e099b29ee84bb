// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/arc_measure.h"
#include "geometry/planar/arrangement.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/model_chain.h"

// This header cuts curves at their compulsory nodes. Features and geometry use it.

namespace delquad {

/// The part of a curve between two compulsory nodes.
struct CurvePiece {
  std::vector<int> curves;  ///< curves of the model, several if they coincide; none: a dangling curve
  std::array<int, 2> ends;  ///< nodes
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;
  std::optional<ArcMeasure> measure = {};
  int least = 1;                      ///< least number of edges
  int n = 1;                          ///< number of edges
  bool is_divided = false;            ///< its nodes were requested: neither n nor they change
  std::vector<double> interior = {};  ///< parameters of its nodes
  int curve = -1;                     ///< curve of the mesh; -1: a dangling curve
  int master = -1;                    ///< piece whose nodes have their images here; -1: none
  std::vector<Vec2> images = {};      ///< its nodes, if they are images by a motion

  /// Divides the piece into n >= 1 edges of equal integral; it must have a measure.
  void set_edges(int edges) {
    n = edges;
    interior = measure->interior_nodes(n);
  }
  /// Returns the place of the k-th inner node.
  Vec2 node(std::size_t k) const { return images.empty() ? shape->point(interior[k]) : images[k]; }
  /// Returns the vector from its first or last end a thousandth of the way along it.
  Vec2 leaving(bool from_last) const {
    const double from_end = from_last ? to : from, step = 1e-3 * (from_last ? from - to : to - from);
    return shape->point(from_end + step) - shape->point(from_end);
  }
  /// Returns whether its number of edges may change.
  bool is_free() const { return measure && !is_divided && master < 0; }
  std::pair<int, int> sorted_ends() const { return std::minmax(ends[0], ends[1]); }
};

/// Returns the curves cut at their compulsory nodes. If pieces coincide, the first one stays. Throws
/// InputError for curves of different loops that meet at an angle below 1e-4 radians.
std::vector<CurvePiece> cut_curves(const PlanarModel& model, const ModelChain& chain);

/// Divides a piece at `interior` into chords, at least `least`. They are at most as long as 1/4 of the size.
/// They stray from the curve by 1/50 of their length and 1/100 of the size, both times `fineness`, 0 to 1.
void divide_by_chords(const SizeField& size, double fineness, CurvePiece& piece);

/// Returns for each curve of the model the loops (indices) with it.
std::vector<std::vector<int>> loops_of_model_curves(const PlanarModel& model, const ModelChain& chain);

/// Returns the number of ends of pieces at each node.
std::vector<int> pieces_at_nodes(const std::vector<CurvePiece>& pieces, std::size_t n_nodes);

/// Returns the model's curves with their names and numbers.
std::vector<Entity> curve_entities(const PlanarModel& model);

/// Returns the beginning of messages on a model: its file, or an empty text.
std::string message_prefix(const PlanarModel& model);

}  // namespace delquad
