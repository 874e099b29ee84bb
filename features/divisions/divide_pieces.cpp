#include <fmt/format.h>

#include <algorithm>

#include "delquad/error.h"
#include "features/divisions/divisions.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// The pieces of one curve, in their order, get its nodes.
void divide_curve(const PlanarModel& model, const CurveDivision& division, int curve,
                  const std::vector<CurvePiece*>& pieces) {
  const PointSize unit = [](const Vec3&) { return 1.0; };
  const std::string label = curve_label(model, curve);
  std::vector<ArcMeasure> arcs;
  std::vector<double> lengths;
  for (const CurvePiece* p : pieces) {
    arcs.emplace_back(*p->shape, p->from, p->to, unit, message_prefix(model) + label, 1);
    lengths.push_back(arcs.back().integral());
  }
  const auto places = division_places(division, lengths, label);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    CurvePiece& piece = *pieces[i];
    piece.n = static_cast<int>(places[i].size()) - 1;
    piece.is_divided = true;
    piece.interior = arcs[i].nodes_at({places[i].begin() + 1, places[i].end() - 1});
    if (piece.n < piece.least)
      throw InputError(fmt::format("{}: {} edge(s) for {}: expected at least {}, for it would fold up",
                                   division.where, division.edges, label,
                                   division.edges - piece.n + piece.least));
  }
}

}  // namespace

void divide_pieces(const PlanarModel& model, const std::vector<CurveDivision>& divisions,
                   std::vector<CurvePiece>& pieces) {
  for (const CurveDivision& division : divisions)
    for (const int c : find_entities(curve_entities(model), "curve", division.name, division.where)) {
      std::vector<CurvePiece*> own;
      for (CurvePiece& p : pieces)
        if (std::ranges::find(p.curves, c) != p.curves.end()) own.push_back(&p);
      if (std::ranges::any_of(own, &CurvePiece::is_divided))
        throw InputError(
            fmt::format("{}: {} is divided twice, perhaps as part of another curve that lies on it",
                        division.where, curve_label(model, c)));
      divide_curve(model, division, c, own);
    }
}

}  // namespace delquad
