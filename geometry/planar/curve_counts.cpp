#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/matching/t_join.h"
#include "delquad/error.h"
#include "geometry/planar/curve_pieces.h"

namespace delquad {
namespace {

/// The cheapest way to an edge more or less, and its cost.
std::pair<int, double> cheapest_change(const CurvePiece& p) {
  int best = p.n + 1;
  double least_cost = std::numeric_limits<double>::infinity();
  for (int n : {p.n + 1, p.n - 1}) {
    if (n < p.least) continue;
    const double cost = std::abs(std::log(n / p.measure->integral()));
    if (cost >= least_cost) continue;
    best = n;
    least_cost = cost;
  }
  return {best, least_cost};
}

/// Makes the numbers of edges even.
class EvenCounts {
 public:
  EvenCounts(const PlanarModel& model, const Arrangement& arrangement, const FaceRegions& regions,
             std::vector<CurvePiece>& pieces)
      : model_(model), arrangement_(arrangement), regions_(regions), pieces_(pieces) {
    for (const CurvePiece& p : pieces_) {
      first_line_.push_back(n_lines_);
      n_lines_ += static_cast<std::size_t>(p.n);
    }
  }

  void of_groups() {
    for (const std::vector<int>& group : groups()) {
      int total = 0;
      for (int i : group) total += pieces_[i].n;
      if (total % 2 != 0) change_by_one(group);
    }
  }

  /// Every face with a region gets an even number of sides at the least cost; the others do not matter, and
  /// are one node of the graph.
  void by_t_join() {
    const int rest = static_cast<int>(regions_.region.size());
    // Mirror images have the numbers of their masters.
    std::vector<char> is_image(regions_.region.size(), 0);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (const int side : {0, 1})
        if (pieces_[i].image && is_filled(face_beside(i, side))) is_image[face_beside(i, side)] = 1;
    const auto node_of = [&](int face) { return is_filled(face) && !is_image[face] ? face : rest; };
    WeightedGraph graph{rest + 1, {}};
    std::vector<std::size_t> piece_of;
    std::vector<int> sides(graph.n_nodes, 0);
    std::vector<std::set<int>> odd_beside(pieces_.size());  // of each with those that follow it
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].image) continue;
      const auto leader = pieces_[i].master < 0 ? i : static_cast<std::size_t>(pieces_[i].master);
      for (const int side : {0, 1}) {
        const int face = node_of(face_beside(i, side));
        sides[face] += pieces_[i].n;
        if (const auto [at, is_new] = odd_beside[leader].insert(face); !is_new) odd_beside[leader].erase(at);
      }
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].is_divided || odd_beside[i].size() != 2) continue;
      const int a = *odd_beside[i].begin(), b = *odd_beside[i].rbegin();
      const bool as_they_lie = node_of(face_beside(i, 0)) == a;
      graph.edges.push_back({as_they_lie ? a : b, as_they_lie ? b : a, cheapest_change(pieces_[i]).second});
      piece_of.push_back(i);
    }
    std::vector<int> odd;
    for (int face = 0; face < rest; ++face)
      if (sides[face] % 2 != 0) odd.push_back(face);
    if (odd.size() % 2 != 0) odd.push_back(rest);
    const TJoin join = minimum_t_join(graph, odd, *matching_solver(matching_solver_names().front()));
    for (const int face : join.unmatched)
      if (face < rest) throw odd_error(face);
    for (const int e : join.edges) {
      CurvePiece& piece = pieces_[piece_of[e]];
      piece.set_edges(cheapest_change(piece).first);
    }
  }

 private:
  bool is_filled(int face) const { return face >= 0 && regions_.region[face] >= 0; }
  /// Of the first line of a piece, on its left (0) or right.
  int face_beside(std::size_t piece, int side) const {
    return arrangement_.face_of[2 * first_line_[piece] + side];
  }

  /// Pieces whose edges must be even in number, each group by itself, where all loops are apart: components,
  /// and interfaces.
  std::vector<std::vector<int>> groups() const {
    // The plain holes of a region are counted with its outer loop, unless that is an interface, even by
    // itself.
    const std::size_t n = arrangement_.faces.size();
    std::vector<std::vector<int>> outlines(n), holes(n);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const int left = face_beside(i, 0), right = face_beside(i, 1);
      const int inner = left >= 0 && arrangement_.faces[left].around == right ? left : right;
      const int around = arrangement_.faces[inner].around;
      if (is_filled(inner))
        outlines[inner].push_back(static_cast<int>(i));
      else
        (is_filled(around) && is_filled(arrangement_.faces[around].around) ? holes : outlines)[around]
            .push_back(static_cast<int>(i));
    }
    outlines.insert(outlines.end(), holes.begin(), holes.end());
    return outlines;
  }

  void change_by_one(const std::vector<int>& group) {
    const auto cost = [&](int i) {
      return pieces_[i].is_divided ? std::numeric_limits<double>::infinity()
                                   : cheapest_change(pieces_[i]).second;
    };
    const int best = *std::ranges::min_element(group, {}, cost);
    if (pieces_[best].is_divided)
      throw odd_error(is_filled(face_beside(best, 0)) ? face_beside(best, 0) : face_beside(best, 1));
    pieces_[best].set_edges(cheapest_change(pieces_[best]).first);
  }

  /// What was divided leaves no way to an even number around that face.
  InputError odd_error(int face) const {
    std::set<std::string> names;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if ((pieces_[i].is_divided || pieces_[i].master >= 0) &&
          (face_beside(i, 0) == face || face_beside(i, 1) == face))
        names.insert(curve_label(model_, pieces_[i].curves[0]));
    const Entity& region = regions_.regions[regions_.region[face]];
    return InputError(fmt::format(
        "{}the numbers of edges that are given leave {} with an odd number around it, and quads need an even "
        "one: change that of one of {}",
        message_prefix(model_),
        region.names.empty() ? fmt::format("region {}", region.tag) : "'" + region.names[0] + "'",
        fmt::join(names, ", ")));
  }

  const PlanarModel& model_;
  const Arrangement& arrangement_;
  const FaceRegions& regions_;
  std::vector<CurvePiece>& pieces_;
  std::vector<std::size_t> first_line_;  ///< of each piece
  std::size_t n_lines_ = 0;
};

}  // namespace

void make_counts_even(const PlanarModel& model, const Arrangement& arrangement, const FaceRegions& regions,
                      bool loops_are_apart, std::vector<CurvePiece>& pieces) {
  EvenCounts counts(model, arrangement, regions, pieces);
  const bool are_free = std::ranges::all_of(pieces, [](const CurvePiece& p) { return p.master < 0; });
  loops_are_apart&& are_free ? counts.of_groups() : counts.by_t_join();
}

}  // namespace delquad
