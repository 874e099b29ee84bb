#include "metrics/tables/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace delquad {
namespace {

double tested_value(const CellRecord& record, const std::string& key, ValueKind kind) {
  if (kind == ValueKind::kMeasure) return value_of(record, key);
  const auto at = record.times.find(key);
  return at == record.times.end() ? std::nan("") : median(at->second);
}

struct Difference {
  const CellRecord* record;
  double value;
};

/// The row of a cell, but for the value along the axis.
std::string row_across(const CellRecord& record, const std::string& along) {
  return row_group(record, along) + (along.empty() ? "" : " " + record.pipeline);
}

/// What two cells that are compared have in common.
std::string partner_key(const CellRecord& record, const std::string& along) {
  return along.empty() ? record.group : row_across(record, along) + " " + value_along(record, kSeedAxis);
}

/// a - b wherever both have a value, in the order of a.
std::vector<Difference> differences(std::span<const CellRecord* const> a,
                                    std::span<const CellRecord* const> b, const std::string& key,
                                    ValueKind kind, const std::string& along = "") {
  std::map<std::string, double> others;
  for (const CellRecord* record : b) others[partner_key(*record, along)] = tested_value(*record, key, kind);
  std::vector<Difference> result;
  for (const CellRecord* record : a)
    if (const auto at = others.find(partner_key(*record, along)); at != others.end())
      if (const double d = tested_value(*record, key, kind) - at->second; !std::isnan(d))
        result.push_back({record, d});
  return result;
}

}  // namespace

double value_of(const CellRecord& record, const std::string& key) {
  const auto at = record.values.find(key);
  return at == record.values.end() ? std::nan("") : at->second;
}

bool makes_quads(const CellRecord& record) { return value_of(record, "n_quads") > 0; }

bool leaves_triangles(const CellRecord& record) {
  return makes_quads(record) && value_of(record, "n_triangles") > 0;
}

bool is_of_quads(const std::string& key) {
  if (key.starts_with("eta_")) return true;
  static const std::vector<std::string> others = {"d4",
                                                  "d_min",
                                                  "d_max",
                                                  "n_irregular",
                                                  "n_irregular_on_curves",
                                                  "n_inverted",
                                                  "n_folded",
                                                  "angle_min",
                                                  "angle_max",
                                                  "warp_max",
                                                  "warp_mean",
                                                  "aspect_max",
                                                  "aspect_mean",
                                                  "n_thin",
                                                  "scaled_jacobian_min",
                                                  "scaled_jacobian_mean"};
  return std::ranges::find(others, key) != others.end();
}

const std::string& value_along(const CellRecord& record, const std::string& along) {
  static const std::string none;
  if (along.empty()) return record.pipeline;
  const auto at = std::ranges::find(record.variant, along, &std::pair<std::string, std::string>::first);
  return at == record.variant.end() ? none : at->second;
}

std::string row_group(const CellRecord& record, const std::string& along) {
  std::string group = record.name;
  for (const auto& [title, value] : record.variant)
    if (title != kSeedAxis && title != along) group += fmt::format(", {}={}", title, value);
  return group;
}

std::vector<double> Samples::of(const std::string& key) const {
  std::vector<double> values;
  for (const CellRecord* record : done)
    if (const double v = value_of(*record, key); !std::isnan(v)) values.push_back(v);
  return values;
}

std::vector<double> Samples::times(const std::string& key) const {
  std::vector<double> values;
  for (const CellRecord* record : done)
    if (const auto at = record->times.find(key); at != record->times.end())
      values.insert(values.end(), at->second.begin(), at->second.end());
  return values;
}

std::vector<Samples> group_samples(const std::vector<CellRecord>& records) {
  std::vector<Samples> rows;
  std::map<std::pair<std::string, std::string>, std::size_t> known;
  for (const CellRecord& record : records) {
    const std::string group = row_group(record);
    const auto [at, is_new] = known.try_emplace({group, record.pipeline}, rows.size());
    if (is_new) rows.push_back({group, record.pipeline, {}, {}, {}});
    Samples& row = rows[at->second];
    (record.reason.empty() ? row.done : record.skipped ? row.skipped : row.failed).push_back(&record);
  }
  // Groups stay together: by the first of their cells.
  std::map<std::string, std::size_t> order;
  for (const Samples& row : rows) order.try_emplace(row.group, order.size());
  std::ranges::stable_sort(rows, {}, [&](const Samples& row) { return order.at(row.group); });
  return rows;
}

std::vector<double> PairedDomains::means() const {
  std::vector<double> result;
  for (const DomainSamples& domain : differences) result.push_back(domain_mean(domain));
  return result;
}

namespace {

PairedDomains grouped_by_domain(const std::vector<Difference>& differences_of_runs,
                                const std::string& along) {
  std::map<std::string, std::map<std::string, std::vector<double>>> by_domain;  // then by variant
  PairedDomains result;
  for (const Difference& d : differences_of_runs) {
    const std::string& domain = domain_of(*d.record);
    if (!by_domain.contains(domain)) result.names.push_back(domain);
    by_domain[domain][row_across(*d.record, along)].push_back(d.value);
    ++result.runs;
  }
  for (const std::string& name : result.names) {
    DomainSamples& domain = result.differences.emplace_back();
    for (auto& [variant, seeds] : by_domain[name]) domain.push_back(std::move(seeds));
  }
  return result;
}

}  // namespace

PairedDomains pair_by_domain(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                             const std::string& key, ValueKind kind, const std::string& along) {
  return grouped_by_domain(differences(a, b, key, kind, along), along);
}

std::vector<double> means_by_domain(std::span<const CellRecord* const> runs, const std::string& key,
                                    ValueKind kind) {
  std::vector<Difference> values;  // from 0
  for (const CellRecord* record : runs)
    if (const double v = tested_value(*record, key, kind); !std::isnan(v)) values.push_back({record, v});
  return grouped_by_domain(values, "").means();
}

std::vector<double> pair_by_run(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                                const std::string& key) {
  std::vector<double> result;
  for (const Difference& d : differences(a, b, key, ValueKind::kMeasure)) result.push_back(d.value);
  return result;
}

}  // namespace delquad
