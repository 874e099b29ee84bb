#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/planar/arc_measure.h"
#include "geometry/planar/arrangement.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/model_chain.h"

namespace delquad {

/// The part of a curve between two compulsory nodes.
struct CurvePiece {
  std::vector<int> curves;  ///< of the model; several where these lie on each other; none: a whisker
  std::array<int, 2> ends;  ///< nodes
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;
  std::optional<ArcMeasure> measure = {};
  int least = 1;                      ///< fewest edges
  int n = 1;                          ///< edges
  bool is_divided = false;            ///< its nodes were asked for: neither n nor they change
  std::vector<double> interior = {};  ///< parameters of its nodes
  int curve = -1;                     ///< of the mesh; -1: a whisker
  /// Index of the piece whose nodes it has the images of; -1: none. Then these count, in its direction.
  int master = -1;
  Motion motion = {};                    ///< that takes the master here, of periodic curves
  std::function<Vec2(Vec2)> image = {};  ///< that does, of symmetric ones
  bool runs_as_master = true;            ///< else the other way
  std::vector<Vec2> images = {};

  void set_edges(int edges) {
    n = edges;
    interior = measure->interior_nodes(n);
  }
  std::pair<int, int> sorted_ends() const { return std::minmax(ends[0], ends[1]); }
};

/// The curves cut at their compulsory nodes. Of pieces that lie on each other the first one stays. Throws
/// InputError for curves of different loops that touch without an angle between them.
std::vector<CurvePiece> cut_curves(const PlanarModel& model, const ModelChain& chain);

/// The loops that have each curve of the model.
std::vector<std::vector<int>> loops_of_model_curves(const PlanarModel& model, const ModelChain& chain);

/// Gives the curves of each division their nodes. Throws InputError for names that no curve has, for too few
/// edges, and where two divisions disagree.
void divide_pieces(const PlanarModel& model, std::span<const CurveDivision> divisions,
                   std::vector<CurvePiece>& pieces);

/// Pairs the pieces of periodic curves, and puts the ends of those that are images where these are. Throws
/// InputError where they do not match.
void pair_periodic(const PlanarModel& model, std::span<const PeriodicPair> periodic, ModelChain& chain,
                   std::vector<CurvePiece>& pieces);

/// Gives pieces with a master its images.
void follow_masters(const PlanarModel& model, std::vector<CurvePiece>& pieces);

/// Changes numbers of edges by one, where it costs least, until every region has an even number of them.
/// Throws InputError where what was divided forbids that.
void make_counts_even(const PlanarModel& model, const Arrangement& arrangement, const FaceRegions& regions,
                      bool loops_are_apart, std::vector<CurvePiece>& pieces);

/// Ends of pieces at each node.
std::vector<int> pieces_at_nodes(const std::vector<CurvePiece>& pieces, std::size_t n_nodes);

/// What begins messages on a model: its file.
std::string message_prefix(const PlanarModel& model);

}  // namespace delquad
