#include "features/curves/even_pieces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "delquad/error.h"
#include "patches/even_counts.h"

namespace delquad {
namespace {

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

  /// Every face with a region gets an even number of sides at the least cost; the others do not matter.
  void by_t_join() {
    // Mirror images have the numbers of their masters.
    std::vector<char> counts_not(regions_.region.size(), 0);
    for (std::size_t f = 0; f < counts_not.size(); ++f) counts_not[f] = regions_.region[f] < 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (const int side : {0, 1})
        if (const int face = face_beside(i, side); pieces_[i].image && face >= 0) counts_not[face] = 1;
    std::vector<std::set<int>> odd_beside(pieces_.size());  // of each with those that follow it
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].image) continue;
      auto& odd = odd_beside[pieces_[i].master < 0 ? i : static_cast<std::size_t>(pieces_[i].master)];
      for (const int side : {0, 1})
        if (const int face = face_beside(i, side); face >= 0 && !counts_not[face])
          if (const auto [at, is_new] = odd.insert(face); !is_new) odd.erase(at);
    }
    std::vector<CurveDemand> demands;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      demands.push_back(demand_of(pieces_[i], {odd_beside[i].begin(), odd_beside[i].end()}));
    std::vector<int> odd_faces;
    const std::vector<int> counts = even_counts(
        demands, static_cast<int>(counts_not.size()), *matching_solver(matching_solver_names().front()),
        odd_faces,
        [](int n, const CurveDemand& d) { return std::abs(std::log(changed_by_one(n, d) / d.integral)); });
    if (!odd_faces.empty()) throw odd_error(odd_faces.back());
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (counts[i] != pieces_[i].n) pieces_[i].set_edges(counts[i]);
  }

 private:
  bool is_filled(int face) const { return face >= 0 && regions_.region[face] >= 0; }
  static CurveDemand demand_of(const CurvePiece& p, std::vector<int> faces) {
    const bool is_free = !p.is_divided && p.master < 0 && p.measure;
    return {p.measure ? p.measure->integral() : 1, p.least, std::move(faces), is_free ? 0 : p.n};
  }
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
    const auto changed = [&](int i) { return changed_by_one(pieces_[i].n, demand_of(pieces_[i], {})); };
    const auto cost = [&](int i) {
      return pieces_[i].is_divided ? std::numeric_limits<double>::infinity()
                                   : std::abs(std::log(changed(i) / pieces_[i].measure->integral()));
    };
    const int best = *std::ranges::min_element(group, {}, cost);
    if (pieces_[best].is_divided)
      throw odd_error(is_filled(face_beside(best, 0)) ? face_beside(best, 0) : face_beside(best, 1));
    pieces_[best].set_edges(changed(best));
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
