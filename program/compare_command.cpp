#include <fmt/format.h>

#include <cstdio>

#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "metrics/tables/comparison.h"
#include "metrics/tables/times.h"
#include "program/commands.h"

namespace delquad {
namespace {

/// The results in a folder, or the metrics of a mesh.
std::vector<CellRecord> records_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) {
    std::vector<CellRecord> records = read_records(path);
    for (const std::string& problem : attach_times(records)) fmt::print(stderr, "warning: {}\n", problem);
    return records;
  }
  CellRecord record;
  record.group = "mesh";
  record.values = evaluate_metrics(read_mesh(path), nullptr).values;
  return {record};
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
  const Comparison comparison = compare_records(records_of(arguments.before), records_of(arguments.after),
                                                arguments.metrics, arguments.tolerance);
  fmt::print("{}", to_text(comparison));
  return comparison.regressed() ? kRegression : kDone;
}

}  // namespace delquad
