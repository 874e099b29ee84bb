#include "metrics/tables/correlation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/samples.h"

namespace delquad {
namespace {

/// The value of a measure as far as it does not come from the number of vertices.
double cleared_value(const CellRecord& record, const std::string& key) {
  const double power = power_of_vertices(key);
  const double value = value_of(record, key);
  return power == 0 ? value : value * std::pow(value_of(record, "n_vertices"), -power);
}

/// Of fewer, percentiles of a bootstrap are little but the least and the greatest of them.
constexpr std::size_t kLeastDomains = 6;

/// Pairs of values of the runs of one variant of a domain.
struct Pairs {
  std::vector<double> a, b;
};

/// The mean of a domain's variants; nothing where none has a correlation. Adds the runs that it is from.
std::optional<double> of_domain(const std::map<std::string, Pairs>& variants, std::size_t& runs) {
  std::vector<double> found;
  for (const auto& [variant, pairs] : variants)
    if (const auto rho = spearman(pairs.a, pairs.b)) {
      found.push_back(*rho);
      runs += pairs.a.size();
    }
  return found.empty() ? std::nullopt : std::optional(mean(found));
}

Correlation correlate_pair(const std::string& of, const std::string& with,
                           const std::vector<CellRecord>& records) {
  std::vector<std::string> names;
  std::map<std::string, std::map<std::string, Pairs>> domains;
  for (const CellRecord& record : records) {
    if (!record.reason.empty()) continue;
    const std::string& domain = domain_of(record);
    if (!domains.contains(domain)) names.push_back(domain);
    Pairs& pairs = domains[domain][row_group(record)];
    const double a = cleared_value(record, of), b = cleared_value(record, with);
    if (std::isnan(a) || std::isnan(b)) continue;
    pairs.a.push_back(a);
    pairs.b.push_back(b);
  }
  Correlation result{of, with, {}, names.size()};
  for (const std::string& name : names)
    if (const auto rho = of_domain(domains[name], result.runs)) {
      result.by_domain.push_back(*rho);
    }
  result.mean = result.by_domain.empty() ? std::numeric_limits<double>::quiet_NaN() : mean(result.by_domain);
  if (result.by_domain.size() >= kLeastDomains) result.interval = interval_of_mean(result.by_domain);
  return result;
}

TableRow row_of(const Correlation& c) {
  TableRow row{c.of, c.with, {}, {}, "", ""};
  row.values = {{"rho", c.mean},
                {"domains", static_cast<double>(c.by_domain.size())},
                {"runs", static_cast<double>(c.runs)}};
  if (c.interval) {
    row.values["low"] = c.interval->low;
    row.values["high"] = c.interval->high;
  }
  if (!c.by_domain.empty()) {
    row.values["least"] = *std::ranges::min_element(c.by_domain);
    row.values["most"] = *std::ranges::max_element(c.by_domain);
  }
  return row;
}

}  // namespace

std::vector<double> ranks(std::span<const double> values) {
  std::vector<double> result;
  for (const int twice : double_ranks(values)) result.push_back(twice / 2.0);
  return result;
}

std::optional<double> spearman(std::span<const double> a, std::span<const double> b) {
  constexpr std::size_t kLeast = 3;
  if (a.size() != b.size() || a.size() < kLeast) return std::nullopt;
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double centre = static_cast<double>(a.size() + 1) / 2;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - centre) * (x[i] - centre);
    yy += (y[i] - centre) * (y[i] - centre);
    xy += (x[i] - centre) * (y[i] - centre);
  }
  return xx > 0 && yy > 0 ? std::optional(xy / std::sqrt(xx * yy)) : std::nullopt;
}

std::vector<Correlation> correlate(const CorrelationRequest& request,
                                   const std::vector<CellRecord>& records) {
  std::vector<Correlation> result;
  for (const std::string& of : request.of)
    for (const std::string& with : request.with) result.push_back(correlate_pair(of, with, records));
  return result;
}

Table correlation_table(const std::string& title, const std::vector<Correlation>& correlations) {
  Table table;
  table.title = title + ": rank correlations within domains";
  table.group_title = "measure";
  table.name_title = "with";
  table.columns = {{"rho", "rho", 2},     {"low", "95 % from", 2}, {"high", "to", 2},
                   {"least", "least", 2}, {"most", "greatest", 2}, {"domains", "domains", 0},
                   {"runs", "runs", 0}};
  for (const Correlation& c : correlations) {
    table.rows.push_back(row_of(c));
    if (c.by_domain.size() < c.domains)
      table.notes.push_back(fmt::format(
          "{} with {}: {} of {} domains are left out: one of the two is not defined or the same in all runs",
          c.of, c.with, c.domains - c.by_domain.size(), c.domains));
  }
  table.notes.push_back(
      "rho: Spearman's coefficient over the words and seeds of each domain, the mean over domains; its 95 % "
      "interval "
      "by the bootstrap over domains, each row by itself. Least and greatest: of a single domain.");
  table.notes.push_back(
      "Measures of solvers go in times the power of the number of vertices that makes them independent of "
      "it: "
      "errors in H1 times its root, in L2 times the number itself.");
  return table;
}

}  // namespace delquad
