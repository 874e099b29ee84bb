#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "geometry/planar/curve_divisions.h"
#include "geometry/planar/curve_pieces.h"

namespace delquad {
namespace {

/// The part of the way along the curve after `f` edges, of which there need not be a whole number.
double part_after(const std::vector<double>& ends, double f) {
  const double k = std::clamp(std::floor(f), 0.0, static_cast<double>(ends.size() - 2));
  const auto i = static_cast<std::size_t>(k);
  return ends[i] + (f - k) * (ends[i + 1] - ends[i]);
}

/// How many edges lie before that part of the way.
double edges_before(const std::vector<double>& ends, double part) {
  const auto after = std::upper_bound(ends.begin() + 1, ends.end() - 1, part);
  const auto i = static_cast<std::size_t>(after - ends.begin()) - 1;
  return static_cast<double>(i) + (part - ends[i]) / (ends[i + 1] - ends[i]);
}

/// The pieces of one curve, in their order, get its nodes: those between them are there already, and count as
/// the nearest of the wanted ones.
void divide_curve(const PlanarModel& model, const CurveDivision& division, int curve,
                  const std::vector<CurvePiece*>& pieces) {
  const PointSize unit = [](const Vec3&) { return 1.0; };
  std::vector<ArcMeasure> arcs;
  double length = 0;
  for (const CurvePiece* p : pieces) {
    arcs.emplace_back(*p->shape, p->from, p->to, unit, message_prefix(model) + curve_label(model, curve), 1);
    length += arcs.back().integral();
  }
  const int n = division.edges, m = static_cast<int>(pieces.size());
  const std::vector<double> ends = division_ends(division);
  double begin = 0;
  int first = 0;
  for (int i = 0; i < m; ++i) {
    const double end = i + 1 == m ? 1 : begin + arcs[i].integral() / length;
    const double f0 = edges_before(ends, begin), f1 = edges_before(ends, end);
    // Each of the pieces that follow needs an edge, too.
    const int last =
        i + 1 == m ? n : std::clamp(static_cast<int>(std::lround(f1)), first + 1, n - (m - 1 - i));
    CurvePiece& piece = *pieces[i];
    piece.n = last - first;
    if (piece.n < piece.least)
      throw InputError(fmt::format("{}: {} edge(s) for {}: expected at least {}, for it would fold up",
                                   division.where, n, curve_label(model, curve), n - piece.n + piece.least));
    piece.is_divided = true;
    std::vector<double> targets;
    for (int k = 1; k < piece.n; ++k)
      targets.push_back((part_after(ends, f0 + (f1 - f0) * k / piece.n) - begin) * length);
    piece.interior = arcs[i].nodes_at(targets);
    begin = end;
    first = last;
  }
}

std::vector<int> curves_named(const PlanarModel& model, const CurveDivision& division) {
  std::vector<int> curves;
  std::vector<std::string> known;
  for (std::size_t c = 0; c < model.curves.size(); ++c) {
    const std::string& name = model.curves[c].name;
    if (!name.empty()) known.push_back(name);
    if (name == division.name || fmt::format("curve_{}", c + 1) == division.name)
      curves.push_back(static_cast<int>(c));
  }
  if (curves.empty())
    throw InputError(fmt::format("{}: no curve is called '{}'{}", division.where, division.name,
                                 suggestion(division.name, known)));
  return curves;
}

}  // namespace

std::vector<double> division_ends(const CurveDivision& division) {
  const int n = division.edges;
  std::vector<double> ends{0};
  for (int k = 0; k < n; ++k) {
    const double from_middle = n > 1 ? std::abs(2.0 * k - (n - 1)) / (n - 1) : 0;
    ends.push_back(ends.back() + std::pow(division.progression, k) * std::pow(division.bump, from_middle));
  }
  const double sum = ends.back();
  for (double& end : ends) end /= sum;
  return ends;
}

void divide_pieces(const PlanarModel& model, std::span<const CurveDivision> divisions,
                   std::vector<CurvePiece>& pieces) {
  for (const CurveDivision& division : divisions) {
    for (const int curve : curves_named(model, division)) {
      std::vector<CurvePiece*> own;
      for (CurvePiece& p : pieces)
        if (std::ranges::find(p.curves, curve) != p.curves.end()) own.push_back(&p);
      if (std::ranges::any_of(own, &CurvePiece::is_divided))
        throw InputError(
            fmt::format("{}: {} is divided twice, perhaps as part of another curve that lies on it",
                        division.where, curve_label(model, curve)));
      if (division.edges < static_cast<int>(own.size()))
        throw InputError(
            fmt::format("{}: {} edges for {}, which corners and other curves cut into {} pieces: "
                        "expected at least {}",
                        division.where, division.edges, curve_label(model, curve), own.size(), own.size()));
      divide_curve(model, division, curve, own);
    }
  }
}

}  // namespace delquad
