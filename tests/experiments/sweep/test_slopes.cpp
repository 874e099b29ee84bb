#include "metrics/tables/slopes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace delquad {
namespace {

/// y = c n^power on meshes of n vertices, of two seeds that are off by 1 % to either side.
void add_runs(const std::string& domain, const std::string& word, double c, double power,
              std::vector<CellRecord>& records) {
  for (const int quads : {100, 200, 400, 800})
    for (const int seed : {1, 2}) {
      CellRecord& r = records.emplace_back();
      r.name = domain;
      r.variant = {{"kind", "x"}, {"quads", std::to_string(quads)}, {"seed", std::to_string(seed)}};
      r.pipeline = word;
      const double n = quads + 10;
      r.values = {{"n_vertices", n}, {"y", c * std::pow(n, power) * (seed == 1 ? 0.99 : 1 / 0.99)}};
    }
}

TEST(Slopes, ArePowersAlongAnAxis) {
  std::vector<CellRecord> records;
  add_runs("a", "DB", 3, -1, records);
  add_runs("b", "DB", 1, -0.8, records);
  add_runs("a", "FB", 1, 0, records);
  records.push_back(records.back());
  records.back().reason = "failed";
  const Table table = slope_table("t", {{"y"}, "quads"}, records);
  ASSERT_EQ(table.rows.size(), 5);
  const TableRow &a = table.rows[0], &flat = table.rows[2], &all = table.rows[3];
  EXPECT_EQ(a.group, "a");
  EXPECT_EQ(a.name, "DB, kind=x");
  EXPECT_NEAR(a.values.at("slope.y"), -1, 1e-12);
  double middle = 1;
  for (const int quads : {100, 200, 400, 800}) middle *= std::pow(quads + 10, 0.25);
  EXPECT_NEAR(a.values.at("at.y"), 3 / middle, 1e-12);
  EXPECT_EQ(a.values.at("rises.y"), 0);
  // Student's quantile of 8 - 2 degrees of freedom times the deviation of the power.
  double squares = 0;
  for (const int quads : {100, 200, 400, 800}) squares += 2 * std::pow(std::log((quads + 10) / middle), 2);
  const double off = std::log(0.99) * std::sqrt(8.0 / 6);
  EXPECT_NEAR(a.half_widths.at("slope.y"), 2.446912 * std::abs(off) / std::sqrt(squares), 1e-6);
  EXPECT_EQ(flat.values.at("rises.y"), 3);
  EXPECT_EQ(all.group, "all cases");
  EXPECT_NEAR(all.values.at("slope.y"), -0.9, 1e-12);
  EXPECT_NEAR(all.half_widths.at("slope.y"), 12.7062 * 0.1, 1e-4);
}

TEST(Slopes, NeedTheAxisAndValuesAboveZero) {
  std::vector<CellRecord> records;
  add_runs("a", "DB", 0, -1, records);
  EXPECT_TRUE(slope_table("t", {{"y"}, "quads"}, records).rows.empty());
  add_runs("a", "DB", 1, -1, records);
  EXPECT_TRUE(slope_table("t", {{"y"}, "size"}, records).rows.empty());
}

}  // namespace
}  // namespace delquad
