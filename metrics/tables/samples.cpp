// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace delquad {
namespace {

/// Returns the row of a cell without its value on the axis.
std::string row_across(const CellRecord& record, const std::string& along) {
  return row_group(record, along) + (along.empty() ? "" : " " + record.pipeline);
}

/// Returns the common key of two cells that are compared.
std::string partner_key(const CellRecord& record, const std::string& along) {
  return along.empty() ? record.group : row_across(record, along) + " " + value_along(record, kSeedAxis);
}

/// Values of a domain by variant.
using ByVariant = std::map<std::string, std::vector<double>>;

double domain_mean_of(ByVariant variants) {
  DomainSamples domain;
  for (auto& [variant, seeds] : variants) domain.push_back(std::move(seeds));
  return domain_mean(domain);
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
                                                  "misalignment",
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
  // Groups stay together, in the order of their first cells.
  std::map<std::string, std::size_t> order;
  for (const Samples& row : rows) order.try_emplace(row.group, order.size());
  std::ranges::stable_sort(rows, {}, [&](const Samples& row) { return order.at(row.group); });
  return rows;
}

std::vector<double> PairedDomains::finite() const {
  std::vector<double> result;
  std::ranges::copy_if(differences, std::back_inserter(result), [](double d) { return std::isfinite(d); });
  return result;
}

PairedDomains pair_by_domain(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                             const Metric& metric, const std::string& along, bool of_quads) {
  struct Domain {
    ByVariant differences;
    bool failed[2] = {false, false};
  };
  std::map<std::string, const CellRecord*> partners;
  for (const CellRecord* record : b) partners[partner_key(*record, along)] = record;
  std::map<std::string, Domain> domains;
  std::vector<std::string> names;
  PairedDomains result;
  for (const CellRecord* record : a) {
    const auto partner = partners.find(partner_key(*record, along));
    if (partner == partners.end()) continue;
    const CellRecord* sides[2] = {record, partner->second};
    double values[2];
    bool has_mesh[2], none[2];
    for (const int side : {0, 1}) {
      values[side] = value_of(*sides[side], metric.key);
      has_mesh[side] = sides[side]->reason.empty() && (!of_quads || makes_quads(*sides[side]));
      none[side] = !has_mesh[side] || std::isnan(values[side]);
    }
    // The measure may be undefined for an existing mesh.
    if (none[0] && none[1] && (has_mesh[0] || has_mesh[1])) continue;
    const auto [at, is_new] = domains.try_emplace(domain_of(*record));
    if (is_new) names.push_back(at->first);
    for (const int side : {0, 1}) at->second.failed[side] |= none[side];
    if (none[0] || none[1]) continue;
    at->second.differences[row_across(*record, along)].push_back(values[0] - values[1]);
    ++result.runs;
  }
  const double best = metric.better == Better::kHigher ? HUGE_VAL : -HUGE_VAL;
  for (const std::string& name : names) {
    const Domain& domain = domains[name];
    if (domain.failed[0] && domain.failed[1]) {
      result.left_out.push_back(name);
      continue;
    }
    for (const int side : {0, 1}) result.failed[side] += domain.failed[side];
    result.names.push_back(name);
    result.differences.push_back(domain.failed[0]   ? -best
                                 : domain.failed[1] ? best
                                                    : domain_mean_of(domain.differences));
  }
  return result;
}

std::vector<double> means_by_domain(std::span<const CellRecord* const> runs, const std::string& key) {
  std::map<std::string, ByVariant> domains;
  std::vector<std::string> names;
  for (const CellRecord* record : runs) {
    const double value = value_of(*record, key);
    if (std::isnan(value)) continue;
    const auto [at, is_new] = domains.try_emplace(domain_of(*record));
    if (is_new) names.push_back(at->first);
    at->second[row_group(*record)].push_back(value);
  }
  std::vector<double> means;
  for (const std::string& name : names) means.push_back(domain_mean_of(domains[name]));
  return means;
}

}  // namespace delquad
