// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/table.h"

// This header makes the data of pages. The report uses it.

namespace delquad {

using Json = nlohmann::ordered_json;

/// Returns a table for the page, with its files; null for an empty one.
Json table_json(const Table& table);

/// y = factor * x^exponent.
struct PowerLaw {
  double factor, exponent;
};
/// Returns the best law for positive pairs, by least squares of the logarithms; nothing if all x are equal.
std::optional<PowerLaw> fit_power_law(const std::vector<double>& x, const std::vector<double>& y);

/// Returns for each pipeline and case: elements and seconds of the case's variants, and the power law that
/// they follow. The law needs three sizes or more, the largest at least four times the smallest.
Json growth_json(const std::vector<CellRecord>& records);

/// Returns the meaning of stages and measures, and colors by eta.
Json glossary_json();

/// Scripts and styles of all pages, then of pages of results, then of pages of one mesh. They come from
/// experiments/report/page/ and experiments/report/three/.
extern const std::string_view kPageStyle, kPageScript, kThreeScript;
extern const std::string_view kPageBody, kReportScript;
extern const std::string_view kViewStyle, kViewBody, kViewScript;

/// Returns the seed; empty: none.
std::string seed_of(const CellRecord& record);

/// Returns, for each pipeline of a sheet with several seeds, the number of done cells, and means by column
/// key. With them comes half the width of their 95 % confidence intervals. Empty if no pipeline has two
/// seeds.
Json means_json(std::span<const CellRecord* const> cells, const std::vector<TableColumn>& columns);

/// Returns the values of finished cells in each column, for charts of their spread. `sheets` have `cases`,
/// `words` and `keys`. `cells` have the places of their sheet and pipeline, then a value or null for each
/// key.
Json samples_json(const std::vector<CellRecord>& records, const std::vector<TableColumn>& columns);

/// Returns a number with five digits, more than a chart shows; null for NaN.
Json brief_number(double value);

/// A bad quad and its surroundings, seen from its front.
struct Closeup {
  double eta;
  double size;  ///< mean edge
  Vec3 normal;
  Vec3 at;                                 ///< its center
  std::vector<Vec2> points;                ///< in units of the quad's mean edge, its center at the origin
  std::vector<std::vector<int>> elements;  ///< triangles and quads, the bad quad first
  std::vector<double> etas;                ///< of the elements; triangles have 1
};

/// Returns the `count` worst quads without common vertices, worst first. With them come the elements at most
/// three steps from element to element away.
std::vector<Closeup> worst_quads(const Mesh& mesh, std::size_t count);
Json closeups_json(const Mesh& mesh, std::size_t count);

using Json = nlohmann::ordered_json;

/// Returns the data of a page on one cell, from its record, and from its mesh if there is one.
Json cell_json(const Json& record, const std::optional<Mesh>& mesh);

/// Returns facts of a variant of a case, by the record of one of its cells: pairs of texts.
Json facts_json(const Json& record);

}  // namespace delquad
