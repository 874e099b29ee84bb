#include "metrics/tables/figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "io/svg_to_pdf.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/table.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFewestCases = 3;
/// Costs below this count as it: nobody sees a difference of eta, tau or time beyond.
constexpr double kLeastCost = 1e-6;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
const std::vector<const char*> kNames = {"time_quality", "irregular_tau", "profile_eta", "profile_tau",
                                         "profile_time"};
constexpr const char* kEffects = "effects_";

/// Whether a file has the name of a figure of ours.
bool is_own(const std::string& name) {
  return std::ranges::find(kNames, name) != kNames.end() || name.starts_with(kEffects);
}

bool is_sound(const CellRecord& record) {
  return record.reason.empty() && record.unsound.empty() && value_of(record, "n_quads") > 0;
}

/// The variants that every pipeline has a record of, and the pipelines.
struct CommonCells {
  std::vector<std::string> pipelines, variants;
  std::map<std::pair<std::string, std::string>, const CellRecord*> cells;  // by variant and pipeline

  const CellRecord& cell(const std::string& variant, const std::string& pipeline) const {
    return *cells.at({variant, pipeline});
  }
};

template <class T>
void add_once(std::vector<T>& list, const T& item) {
  if (std::ranges::find(list, item) == list.end()) list.push_back(item);
}

CommonCells comparison_of(const std::vector<CellRecord>& records) {
  CommonCells c;
  std::set<std::string> triangles_only, quads, absent;
  for (const CellRecord& record : records) {
    if (record.reason.empty())
      (value_of(record, "n_quads") > 0 ? quads : triangles_only).insert(record.pipeline);
    if (record.skipped && record.kind != kNotApplicable) absent.insert(record.group);
  }
  std::vector<std::string> variants;
  for (const CellRecord& record : records) {
    if (triangles_only.contains(record.pipeline) && !quads.contains(record.pipeline)) continue;
    add_once(c.pipelines, record.pipeline);
    add_once(variants, record.group);
    c.cells[{record.group, record.pipeline}] = &record;
  }
  for (const std::string& variant : variants)
    if (!absent.contains(variant) && std::ranges::all_of(c.pipelines, [&](const std::string& p) {
          return c.cells.contains({variant, p});
        }))
      c.variants.push_back(variant);
  return c;
}

/// What pipelines have no value for, in words: "gmsh: 1 failed, 2 not applicable".
std::vector<std::string> notes_on_missing(const CommonCells& c) {
  std::vector<std::string> notes;
  for (const std::string& pipeline : c.pipelines) {
    int failed = 0, inapplicable = 0, unsound = 0;
    for (const std::string& variant : c.variants) {
      const CellRecord& cell = c.cell(variant, pipeline);
      if (is_sound(cell)) continue;
      ++(cell.kind == kNotApplicable ? inapplicable : cell.reason.empty() ? unsound : failed);
    }
    std::vector<std::string> parts;
    for (const auto& [n, what] :
         {std::pair(failed, "failed"), {inapplicable, "not applicable"}, {unsound, "not sound"}})
      if (n > 0) parts.push_back(fmt::format("{} {}", n, what));
    if (!parts.empty())
      notes.push_back(fmt::format("{}: {} of {}", pipeline, fmt::join(parts, ", "), c.variants.size()));
  }
  return notes;
}

template <class X, class Y>
Figure scatter(const CommonCells& c, const char* name, const Diagram& frame, X x, Y y) {
  Figure figure{name, frame, "case,pipeline,x,y\n"};
  for (const std::string& pipeline : c.pipelines) {
    DiagramSeries series{pipeline, {}};
    for (const std::string& variant : c.variants) {
      const CellRecord& cell = c.cell(variant, pipeline);
      if (!is_sound(cell)) continue;
      series.points.push_back({x(cell), y(cell)});
      figure.csv += fmt::format("\"{}\",{},{},{}\n", variant, pipeline, x(cell), y(cell));
    }
    figure.diagram.series.push_back(std::move(series));
  }
  figure.diagram.notes = notes_on_missing(c);
  return figure;
}

/// The part of the variants (in percent) on which a pipeline's cost is at most so many times the least.
template <class Cost>
Figure profile(const CommonCells& c, const char* name, const std::string& title, Cost cost) {
  Figure figure{name,
                {title, {"times the least", true}, {"% of the cells", false}, DiagramKind::kSteps, {}},
                "pipeline,factor,percent\n"};
  std::map<std::string, std::vector<double>> factors;
  for (const std::string& variant : c.variants) {
    const auto cost_of = [&](const std::string& pipeline) {
      const CellRecord& cell = c.cell(variant, pipeline);
      const double value = is_sound(cell) ? cost(cell) : kInfinite;
      return std::isnan(value) ? kInfinite : std::max(value, kLeastCost);
    };
    double least = kInfinite;
    for (const std::string& pipeline : c.pipelines) least = std::min(least, cost_of(pipeline));
    for (const std::string& pipeline : c.pipelines)
      factors[pipeline].push_back(least < kInfinite ? cost_of(pipeline) / least : kInfinite);
  }
  for (const std::string& pipeline : c.pipelines) {
    std::vector<double>& sorted = factors[pipeline];
    std::ranges::sort(sorted);
    DiagramSeries series{pipeline, {{1, 0}}};
    for (std::size_t k = 0; k < sorted.size() && sorted[k] < kInfinite; ++k) {
      const double percent = 100 * static_cast<double>(k + 1) / static_cast<double>(sorted.size());
      series.points.push_back({sorted[k], percent});
      figure.csv += fmt::format("{},{},{}\n", pipeline, sorted[k], percent);
    }
    figure.diagram.series.push_back(std::move(series));
  }
  figure.diagram.notes = notes_on_missing(c);
  return figure;
}

}  // namespace

std::vector<Figure> make_figures(const std::vector<CellRecord>& records) {
  const CommonCells c = comparison_of(records);
  std::set<std::string> cases;
  for (const std::string& variant : c.variants) cases.insert(c.cell(variant, c.pipelines[0]).name);
  if (c.pipelines.size() < 2 || cases.size() < kFewestCases) return {};
  const auto of = [](const char* key) {
    return [key](const CellRecord& cell) { return value_of(cell, key); };
  };
  const auto below = [](double most, const char* key) {
    return [most, key](const CellRecord& cell) { return most - value_of(cell, key); };
  };
  const Diagram time{
      "Quality against time", {"seconds, from the model to the mesh", true}, {"mean eta"}, {}, {}};
  const Diagram irregular{
      "tau against irregular vertices", {"interior vertices without just four quads, %"}, {"tau, %"}, {}, {}};
  return {
      scatter(c, kNames[0], time, of("seconds_total"), of("eta_mean")),
      scatter(c, kNames[1], irregular, below(100, "d4"), of("tau")),
      profile(c, kNames[2], "Performance profile: 1 - mean eta", below(1, "eta_mean")),
      profile(c, kNames[3], "Performance profile: 100 - tau", below(100, "tau")),
      profile(c, kNames[4], "Performance profile: seconds from the model to the mesh", of("seconds_total"))};
}

std::vector<Figure> figures_of_effects(const Inference& inference) {
  std::vector<Figure> figures;
  for (const PairComparison& pair : inference.pairs()) {
    const auto& interval = pair.interval;
    if (!interval) continue;
    const std::string name = kEffects + pair.metric.key;
    auto at = std::ranges::find(figures, name, &Figure::name);
    if (at == figures.end()) {
      Diagram frame{"Differences of " + pair.metric.title,
                    {"first minus second, mean over domains, with 95 % interval"},
                    {},
                    DiagramKind::kIntervals,
                    {}};
      frame.notes = {
          fmt::format("{} 0: the first is better. Full: proven at 5 %, without a failure{}.",
                      pair.metric.better == Better::kHigher ? "Above" : "Below",
                      inference.family().is_exploratory() ? "; empty: not planned, or not proven" : "")};
      at = figures.insert(at, {name, std::move(frame), "pair,low,effect,high,proven\n"});
    }
    const double effect = mean(pair.domains.finite());
    const bool proven = inference.first_is_better(pair).has_value();
    const std::string failures = pair.failures();
    DiagramSeries series{pair.first + " - " + pair.second + (failures.empty() ? "" : " (" + failures + ")"),
                         {{interval->low, 0}, {effect, 0}, {interval->high, 0}}};
    if (proven && failures.empty()) series.marked = {{effect, 0}};
    at->csv += fmt::format("{},{},{},{},{}\n", csv_quoted(series.name), interval->low, effect, interval->high,
                           proven ? "yes" : "no");
    at->diagram.series.push_back(std::move(series));
  }
  return figures;
}

std::vector<std::string> write_figures(const fs::path& folder, const std::vector<Figure>& figures) {
  const fs::path at = folder / kFigures;
  std::error_code status;
  for (fs::directory_iterator file(at, status), end; !status && file != end; file.increment(status)) {
    const std::string name = file->path().stem().string();
    if (is_own(name) && std::ranges::find(figures, name, &Figure::name) == figures.end())
      fs::remove(file->path(), status);
  }
  if (figures.empty()) {
    fs::remove(at, status);  // where nothing else is in it
    return {};
  }
  fs::create_directories(at, status);
  std::vector<std::string> errors;
  for (const Figure& figure : figures) try {
      const std::string svg = drawn_diagram(figure.diagram);
      write_text_file(at / (figure.name + ".svg"), svg);
      write_text_file(at / (figure.name + ".pdf"), svg_to_pdf(svg));
      write_text_file(at / (figure.name + ".csv"), figure.csv);
    } catch (const InputError& error) {
      errors.push_back(error.what());
    }
  return errors;
}

}  // namespace delquad
