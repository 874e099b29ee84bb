#pragma once

#include <string>
#include <vector>

#include "metrics/tables/table.h"

namespace delquad {

/// How a format shows marks, and texts that mean something to it.
struct TableStyle {
  const char *best_begin, *best_end, *as_good, *plus_minus;
  std::string (*escape)(const std::string&);
};

/// A table as texts, ready to be set.
struct RenderedTable {
  struct Line {
    std::vector<std::string> names;   ///< group and name
    std::vector<std::string> values;  ///< by column
    std::string
        missing;  ///< in place of values: "failed", "skipped" or kNotApplicable; empty: they are there
  };
  Line head;
  std::vector<Line> lines;
  std::vector<std::string> notes;  ///< not escaped
};

/// The columns that are to be shown. `notes` say why rows failed, what the marks and brackets mean, and where
/// published values stand.
RenderedTable render(const Table& table, const TableStyle& style);

double value_or_nan(const std::map<std::string, double>& values, const std::string& key);
std::string replace_all(std::string text, const std::string& from, const std::string& to);

}  // namespace delquad
