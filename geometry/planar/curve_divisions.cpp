#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/nearest_name.h"
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

/// Where the edges of a division end, in parts of the curve's length: n + 1 numbers from 0 to 1.
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

std::vector<std::vector<double>> division_places(const CurveDivision& division,
                                                 const std::vector<double>& lengths,
                                                 const std::string& label) {
  const int n = division.edges, m = static_cast<int>(lengths.size());
  if (n < m)
    throw InputError(
        fmt::format("{}: {} edges for {}, which corners and other curves cut into {} pieces: "
                    "expected at least {}",
                    division.where, n, label, m, m));
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const std::vector<double> ends = division_ends(division);
  std::vector<std::vector<double>> places;
  double begin = 0;
  int first = 0;
  for (int i = 0; i < m; ++i) {
    const double end = i + 1 == m ? 1 : begin + lengths[i] / length;
    const double f0 = edges_before(ends, begin), f1 = edges_before(ends, end);
    // Each of the pieces that follow needs an edge, too.
    const int rest = m - 1 - i;
    const int last = rest == 0 ? n : std::clamp(static_cast<int>(std::lround(f1)), first + 1, n - rest);
    auto& own = places.emplace_back(1, 0.0);
    for (int k = 1; k < last - first; ++k)
      own.push_back((part_after(ends, f0 + (f1 - f0) * k / (last - first)) - begin) * length);
    own.push_back(lengths[i]);
    begin = end;
    first = last;
  }
  return places;
}

bool names_curve(const CurveDivision& division, const std::vector<std::string>& names, int tag) {
  return std::ranges::find(names, division.name) != names.end() ||
         fmt::format("curve_{}", tag) == division.name;
}

InputError no_such_curve(const CurveDivision& division, const std::vector<std::string>& known) {
  return InputError(fmt::format("{}: no curve is called '{}'{}", division.where, division.name,
                                suggestion_or_all(division.name, known)));
}

void divide_pieces(const PlanarModel& model, std::span<const CurveDivision> divisions,
                   std::vector<CurvePiece>& pieces) {
  for (const CurveDivision& division : divisions) {
    bool found = false;
    std::vector<std::string> known;
    for (std::size_t c = 0; c < model.curves.size(); ++c) {
      const std::string& name = model.curves[c].name;
      if (!name.empty()) known.push_back(name);
      if (!names_curve(division, {name}, static_cast<int>(c) + 1)) continue;
      found = true;
      std::vector<CurvePiece*> own;
      for (CurvePiece& p : pieces)
        if (std::ranges::find(p.curves, static_cast<int>(c)) != p.curves.end()) own.push_back(&p);
      if (std::ranges::any_of(own, &CurvePiece::is_divided))
        throw InputError(
            fmt::format("{}: {} is divided twice, perhaps as part of another curve that lies on it",
                        division.where, curve_label(model, static_cast<int>(c))));
      divide_curve(model, division, static_cast<int>(c), own);
    }
    if (!found) throw no_such_curve(division, known);
  }
}

}  // namespace delquad
